"""Files that are dropped on the page: stored under a safe name, and read as data only."""

from __future__ import annotations

import io
import json
import zipfile
import zlib
from pathlib import Path
from typing import Final

import numpy as np

from voxsoft._folders import folder_name
from voxsoft.errors import FileError
from voxsoft.files import write_mesh
from voxsoft.files.atomic import write_atomically
from voxsoft.files.run_folder import make_folder
from voxsoft.shapes import TriangleMesh
from voxsoft.shapes.cad_files import HINT, WHAT, is_cad_file
from voxsoft.units import format_quantity
from voxsoft.voxels import Voxels

#: What the files of an archive may take together when unpacked [bytes].
LARGEST_ARCHIVE: Final = 512 * 1024 * 1024
#: Files in an archive.
MOST_FILES: Final = 2_000
MESHES: Final = (".stl", ".obj", ".ply", ".off", ".mesh", ".msh", ".vtk", ".vtu")
KINDS: Final = (".toml", *MESHES, ".npy", ".csv", ".zip")
#: Cells along the longest side of a mesh that is dropped on the page.
_FIRST_CELLS: Final = 32


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
    stem, _, suffix = plain.rpartition(".")
    suffix = f".{suffix.lower()}"
    if is_cad_file(plain):
        raise FileError(plain[:80], WHAT, HINT)
    if suffix not in KINDS:
        raise FileError(
            plain[:80] or "upload", "is no kind of file that is read here", f"use {' '.join(KINDS)}"
        )
    return f"{folder_name(stem, 'upload')}{suffix}"


def design_of_mesh(file: Path, unit: str = "mm") -> str:
    """Write a design file whose body is a mesh that was dropped on the page.

    Parameters
    ----------
    file
        The mesh.
    unit
        Unit of its numbers; most programs write mm.

    Raises
    ------
    ShapeError
        The mesh cannot be read, or encloses nothing.
    """
    low, high = TriangleMesh(path=str(file), unit=unit).build().bounds()
    size = max(b - a for a, b in zip(low, high, strict=True)) / _FIRST_CELLS
    voxel = format_quantity(float(f"{size:.2g}"), "length")
    return _standing(file, unit, voxel, low[2])


def design_of_array(file: Path) -> str:
    """Write a design file whose body is an array of voxels, and the mesh of it beside the array.

    Cells that are not zero are full; a voxel is 1 mm wide.

    Raises
    ------
    FileError
        It is no array of numbers with three axes.
    VoxelError
        No cell is full.
    """
    try:
        array = np.load(io.BytesIO(file.read_bytes()), allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        raise FileError(file.name, f"is no array of NumPy: {error}") from None
    if array.ndim != 3 or array.dtype.kind not in "biuf":
        what = f"holds {array.dtype} of shape {array.shape}; expected three axes of numbers"
        raise FileError(file.name, what)
    surface = file.with_suffix(".stl")
    write_mesh(surface, Voxels.from_array(array != 0, 1e-3).mesh())
    return _standing(surface, "m", "1 mm", 0.0)


def _standing(file: Path, unit: str, voxel: str, lowest: float) -> str:
    bottom = format_quantity(float(f"{lowest:.6g}"), "length")
    return "\n".join(
        (
            f"# A body from {file.name}. Its numbers were taken as {unit}: change `unit` if that",
            "# is wrong. It stands on its lowest layer and carries its own weight.",
            "",
            'schema = "voxsoft/1"',
            f"name = {json.dumps(file.stem)}",
            f'voxel_size = "{voxel}"',
            "",
            "[shapes]",
            f'body = {{ kind = "mesh", path = {json.dumps(str(file))}, unit = "{unit}" }}',
            "",
            "[[parts]]",
            'shape = "body"',
            'material = "ecoflex-00-30"',
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
