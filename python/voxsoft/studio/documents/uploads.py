"""Files that are dropped on the page: stored under a safe name, and read as data only."""

from __future__ import annotations

import json
import re
import zipfile
import zlib
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final, NamedTuple

from voxsoft._folders import folder_name
from voxsoft.errors import FileError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.run_folder import make_folder
from voxsoft.formats.read import read_contents
from voxsoft.formats.registry import READ, counts_voxels
from voxsoft.formats.unit import guess, length_of, name_of
from voxsoft.shapes import TriangleMesh
from voxsoft.shapes.cad_files import HINT, WHAT, is_cad_file
from voxsoft.shapes.mesh_bodies import sizes_in_units
from voxsoft.shapes.surface_files import labels_in, parts_in
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.commands import MeshImport
from voxsoft.studio.protocol.message import Triple
from voxsoft.units import format_quantity

#: Largest size of all unpacked files of an archive [bytes].
LARGEST_ARCHIVE: Final = 512 * 1024 * 1024
#: Files in an archive.
MOST_FILES: Final = 2_000
MESHES: Final = tuple(READ)
KINDS: Final = (".toml", *MESHES, ".csv", ".zip")
#: Cells along the longest side of a mesh that is dropped on the page.
_FIRST_CELLS: Final = 32
#: The material of a body that says none.
_SOFT: Final = "ecoflex-00-30"


def safe_name(name: str) -> str:
    """Make a file name of any text: no folders, no hidden file.

    Raises
    ------
    FileError
        A kind of file that the studio does not read.

    Examples
    --------
    >>> safe_name("../../etc/My arm.TOML")
    'My-arm.toml'
    """
    plain = name.replace("\\", "/").rpartition("/")[2]
    double = next(
        (kind for kind in KINDS if kind.count(".") > 1 and plain.lower().endswith(kind)), ""
    )
    stem, _, suffix = plain.rpartition(".")
    stem, suffix = (plain[: -len(double)], double) if double else (stem, f".{suffix.lower()}")
    if is_cad_file(plain):
        raise FileError(plain[:80], WHAT, HINT)
    if suffix not in KINDS:
        raise FileError(
            plain[:80] or "upload", "is no kind of file that is read here", f"use {' '.join(KINDS)}"
        )
    return f"{folder_name(stem, 'upload')}{suffix}"


def facts_of_mesh(file: Path) -> events.MeshFacts:
    """Measure a mesh or an array of voxels in its own numbers, and tell or guess its unit.

    Raises
    ------
    FileError, ShapeError
        The file cannot be read, encloses nothing, or is an array of other numbers than labels.
    """
    contents = read_contents(file)
    low, high = TriangleMesh(path=str(file), unit="1 m").build().bounds()
    voxels = counts_voxels(file.name)
    unit = "1 mm" if voxels else guess(max(b - a for a, b in zip(low, high, strict=True)))
    if contents.unit is not None:
        unit = format_quantity(contents.unit, "length") if voxels else name_of(contents.unit)
    return events.MeshFacts(
        name=file.name,
        low=low,
        high=high,
        unit=unit,
        stated=contents.unit is not None,
        voxels=voxels,
        parts=list(parts_in(contents) or labels_in(contents)),
        cells=_FIRST_CELLS,
    )


def design_of_mesh(file: Path, how: MeshImport | None = None) -> str:
    """Write a design file whose body is a mesh or an array of voxels, dropped on the page.

    Parameters
    ----------
    file
        The file. Its objects, or its labels, are parts.
    how
        Reading of its numbers; default: in the unit that it says, else in the likeliest one. Voxels
        of an array are 1 mm wide where it does not say it.

    Raises
    ------
    FileError, ShapeError
        The file cannot be read, encloses nothing, or is an array of other numbers than labels.
    """
    facts = facts_of_mesh(file)
    chosen = how or MeshImport(unit=facts.unit)
    meter = length_of(chosen.unit) * chosen.scale
    low, high = _turned(facts.low, facts.high, chosen.up)
    pieces = [_Piece(file, chosen, part) for part in facts.parts or (None,)]
    longest = meter * max(b - a for a, b in zip(low, high, strict=True))
    voxel = format_quantity(float(f"{longest / _FIRST_CELLS:.2g}"), "length")
    if how is not None:
        about = [f"# A body from {file.name}, imported in the unit {chosen.unit}."]
    elif facts.voxels:
        why = "are, as it says," if facts.stated else "are taken as"
        wide = f"{why} {chosen.unit}"
        about = [
            f"# A body from {file.name}, each label of which is a part. Its voxels {wide}",
            "# wide: change `unit`, `voxel_size` and the lengths below, if that is wrong.",
        ]
    else:
        why = "are, as it says, in" if facts.stated else "are taken as"
        sizes = sizes_in_units(longest / length_of(chosen.unit))
        about = [
            f"# A body from {file.name}. Its numbers {why} {chosen.unit}: change `unit`, and",
            f"# the lengths below, if that is wrong. It would be, {sizes}.",
        ]
    if facts.voxels:
        voxel = format_quantity(meter, "length")
    return _standing(about, pieces, voxel, meter * low[2], file.stem)


#: Turns about an axis that bring an axis of a file up.
_TURNS: Final = {
    "x": ("y", -90),
    "-x": ("y", 90),
    "y": ("x", 90),
    "-y": ("x", -90),
    "-z": ("x", 180),
}


def _turned(low: Triple, high: Triple, up: str) -> tuple[Triple, Triple]:
    """Turn a box so that an axis points up.

    Examples
    --------
    >>> _turned((0, 0, 0), (1, 2, 3), "y")
    ((0, -3, 0), (1, 0, 2))
    """
    ends = [_upward(corner, up) for corner in (low, high)]
    return tuple(map(min, *ends)), tuple(map(max, *ends))


def _upward(point: Triple, up: str) -> Triple:
    x, y, z = point
    turns = {"x": (-z, y, x), "-x": (z, y, -x), "y": (x, -z, y), "-y": (x, z, -y)}
    return turns.get(up, (x, -y, -z) if up == "-z" else point)


class _Piece(NamedTuple):
    """A file of a body, or a part of it."""

    file: Path
    how: MeshImport
    part: str | None = None

    @property
    def name(self) -> str:
        return self.part or "body"

    @property
    def shape(self) -> str:
        part = "" if self.part is None else f", part = {json.dumps(self.part)}"
        path = json.dumps(str(self.file))
        shape = f'{{ kind = "mesh", path = {path}, unit = "{self.how.unit}"{part} }}'
        if self.how.scale != 1.0:
            shape = f'{{ kind = "scale", of = {shape}, factor = {self.how.scale!r} }}'
        if self.how.up in _TURNS:
            axis, angle = _TURNS[self.how.up]
            shape = f'{{ kind = "rotate", of = {shape}, axis = "{axis}", angle = "{angle} deg" }}'
        return shape


def _key(name: str) -> str:
    """Write a name as a key of TOML: bare where that is allowed."""
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else json.dumps(name)


def _standing(
    about: Iterable[str], pieces: Sequence[_Piece], voxel: str, lowest: float, name: str
) -> str:
    bottom = format_quantity(float(f"{lowest:.6g}"), "length")
    made = [
        ("", "[[parts]]", f"shape = {json.dumps(each.name)}", f'material = "{_SOFT}"')
        for each in pieces
    ]
    return "\n".join(
        (
            *about,
            "# It stands on its lowest layer and carries its own weight.",
            "",
            'schema = "voxsoft/1"',
            f"name = {json.dumps(name)}",
            f'voxel_size = "{voxel}"',
            "",
            "[shapes]",
            *(f"{_key(each.name)} = {each.shape}" for each in pieces),
            *(line for lines in made for line in lines),
            "",
            "[[clamps]]",
            f'region = {{ z = ["{bottom}", "{bottom}"] }}',
            "",
            "[[loads]]",
            'kind = "gravity"',
            "",
        )
    )


def unpack_folder(archive: Path, target: Path) -> Path:
    """Unpack an archived run folder; nothing of it may leave the target.

    Returns
    -------
    Path
        The folder that holds the run: the target, or the only folder in it.

    Raises
    ------
    FileError
        No archive, too many or too large files, or names that lead elsewhere.
    """
    try:
        with zipfile.ZipFile(archive) as packed:
            entries = [entry for entry in packed.infolist() if not entry.is_dir()]
            if len(entries) > MOST_FILES or sum(e.file_size for e in entries) > LARGEST_ARCHIVE:
                raise FileError(archive.name, "is too large when unpacked; up to 512 MB are read")
            for entry in entries:
                whole = (target / entry.filename).resolve()
                if not whole.is_relative_to(target.resolve()) or entry.filename.startswith("/"):
                    raise FileError(archive.name, f"holds a file outside itself: {entry.filename}")
            for entry in entries:
                make_folder((target / entry.filename).parent)
                write_atomically(target / entry.filename, packed.read(entry))
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError, RuntimeError) as error:
        raise FileError(archive.name, f"is no archive that can be unpacked: {error}") from None
    found = list(target.iterdir())
    return found[0] if len(found) == 1 and found[0].is_dir() else target
