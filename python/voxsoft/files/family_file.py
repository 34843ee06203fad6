"""Design files to start from: the commented text of a family under a user's name for it."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

from voxsoft.design import Design, families
from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import FilePath
from voxsoft.files.run_folder import make_folder


def write_family(family: str, path: FilePath, *, name: str) -> None:
    """Write a family as a design file, comments included.

    Parameters
    ----------
    family
        Name in :data:`voxsoft.design.families.FAMILIES`.
    path
        Path of the file; its folder is made if it does not exist.
    name
        Name of the new design.

    Raises
    ------
    DesignError
        No such family, or a name that no design can have.
    FileError
        The file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "finger-2.toml")
    ...     write_family("finger", file, name="finger-2")
    ...     'name = "finger-2"' in file.read_text()
    True
    """
    # JSON's quoting of text is also TOML's. A function replaces, as a name may hold a backslash.
    line = f"name = {json.dumps(name, ensure_ascii=False)}"
    text = re.sub(
        r"^name = .*$", lambda _: line, families.family_text(family), count=1, flags=re.MULTILINE
    )
    Design.from_document(tomllib.loads(text))
    make_folder(Path(path).parent)
    write_atomically(path, text)
