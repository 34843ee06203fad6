"""Copies of the meshes, cards and designs that a design names, so that a folder can be moved."""

from __future__ import annotations

import hashlib
import tomllib
from pathlib import Path
from typing import Final, TypeVar

from voxsoft._folders import folder_name
from voxsoft.design.document.documents import file_references, with_path
from voxsoft.design.document.included import refuse_outside
from voxsoft.design.document.resolution import is_inner_design
from voxsoft.files.atomic import write_atomically
from voxsoft.files.run_folder import make_folder
from voxsoft.files.toml_text import write_toml
from voxsoft.jobs.spec import JobSpec

#: Name of the folder of the copies in a job's folder.
INPUTS: Final = "inputs"
#: Digits of the content's hash in the name of a copy.
_DIGITS: Final = 8

AnySpec = TypeVar("AnySpec", bound=JobSpec)


def design_file(kind: str) -> str:
    """Return the path of a job's design in its folder: a run leaves its resolved one at the top.

    Examples
    --------
    >>> design_file("run"), design_file("study")
    ('inputs/design.toml', 'design.toml')
    """
    return f"{INPUTS}/design.toml" if kind == "run" else "design.toml"


def with_copies(spec: AnySpec, folder: Path) -> AnySpec:
    """Copy the files that the design of a spec names to a folder; return the spec of the copies.

    A copy has the hash of its content in its name, so that no other copy is ever replaced. A file
    that cannot be read is left to the job, whose error names its purpose.

    Raises
    ------
    FileError
        A copy cannot be written.
    """
    copies = {}
    for steps, file in spec.design.files().items():
        copy = _copy_of(file, folder / INPUTS, is_inner_design(steps))
        if copy is not None:
            copies[steps] = copy
    place = (folder / design_file(spec.kind)).parent
    return spec.replace(design=spec.design.with_files(copies, place))


def _copy_of(file: Path, inputs: Path, is_design: bool = False) -> Path | None:
    """Copy a file, and the files that a design names with it; return None if it cannot be read."""
    try:
        content = file.read_bytes()
        document = tomllib.loads(content.decode("utf-8-sig")) if is_design else {}
    except (OSError, ValueError, RecursionError):
        return None
    refuse_outside(document, file.parent)
    for steps, path in file_references(document):
        inner = _copy_of(Path(file.parent, path), inputs, is_inner_design(steps))
        if inner is not None:
            document = with_path(document, steps, inner.name)
            content = write_toml(document).encode()
    return _copied(content, file, inputs)


def _copied(content: bytes, file: Path, inputs: Path) -> Path:
    digest = hashlib.sha256(content).hexdigest()[:_DIGITS]
    stem = file.stem.removesuffix(f"-{digest}")
    target = inputs / f"{folder_name(stem, 'file')}-{digest}{file.suffix}"
    if not target.is_file() or target.read_bytes() != content:
        make_folder(inputs)
        write_atomically(target, content)
    return target
