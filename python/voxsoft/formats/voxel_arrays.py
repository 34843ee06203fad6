"""Arrays of voxels as cells with labels: NumPy's ``.npy``, and the files of VoxCAD.

Coordinates count voxels from the corner of the first one, so that a unit of them is the size of a
voxel: that which the file gives, or that a caller is asked for.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.formats.contents import Contents
from voxsoft.formats.vtk_data import contents_of
from voxsoft.formats.vtk_grids import Image, cells_of_image

#: Largest label.
_MOST: Final = 255
#: Coding of the layers of VoxCAD that is read.
_ASCII: Final = "ASCII_READABLE"
_AXES: Final = ("X", "Y", "Z")


def read_npy(path: Path) -> Contents:
    """Read the labels of an array of NumPy, whole numbers from 0 to 255 or booleans.

    Raises
    ------
    FileError
        It is no such array, has another number of axes than three, other numbers, or is empty.
    """
    where = str(path)
    hint = "save one array of numbers by numpy.save"
    try:
        with path.open("rb") as file:
            values = np.lib.format.read_array(file, allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        has_objects = "Object arrays" in str(error)
        reason = "it holds objects of Python" if has_objects else str(error).partition("\n")[0]
        raise FileError(where, f"is no array of NumPy: {reason}", hint) from None
    if values.ndim != 3:
        what = f"holds {values.dtype} of shape {values.shape}; expected three axes, x, y and z"
        raise FileError(where, what, "save the labels of voxels alone")
    if not values.size:
        raise FileError(where, f"is empty: its shape is {values.shape}", "save a part of the body")
    if values.dtype.kind not in "bui":
        what = f"holds {values.dtype}; parts are whole numbers"
        hint = "compare with a threshold to get booleans, or cast to numpy.uint8"
        raise FileError(where, what, hint)
    if not (values.min() >= 0 and values.max() <= _MOST):
        what = f"holds {values.min()} to {values.max()}; parts are numbered 0 (empty) to {_MOST}"
        raise FileError(where, what, "number the parts from 1, with 0 outside")
    return labeled_voxels(where, values.astype(np.uint8), "NumPy array")


def read_voxcad(path: Path) -> Contents:
    """Read the voxels of VoxCAD, Voxelyze or voxcraft-sim: digits, each a material of the palette.

    Raises
    ------
    FileError
        It is damaged, has no structure, one that is coded in another way, or a lattice whose lines
        are shifted.
    """
    where, data = str(path), path.read_bytes()
    try:
        # Entities are safe: expat bounds the text that they expand to.
        root = ET.fromstring(data)
    except (ET.ParseError, ValueError, LookupError) as error:
        raise FileError(where, f"is no XML: {error}", "save or copy it again") from None
    structure = next(root.iter("Structure"), None)
    if structure is None:
        raise FileError(where, "holds no voxels: it has no element <Structure>")
    coding = structure.get("Compression", "")
    if coding != _ASCII:
        what = f'has voxels that are coded as "{coding}"; {_ASCII} is read'
        raise FileError(where, what, "write their layers as digits, or give them as .npy")
    counts = [_number(where, structure, f"{axis}_Voxels", None) for axis in _AXES]
    nx, ny, nz = (int(count) for count in counts)
    if [nx, ny, nz] != counts or min(nx, ny, nz) < 1:
        raise FileError(where, f"is damaged: it has {counts} voxels along x, y, z")
    layers = ["".join((each.text or "").split()) for each in structure.findall("Data/Layer")]
    if len(layers) != nz or any(len(layer) != nx * ny for layer in layers):
        lengths = ", ".join(map(str, dict.fromkeys(map(len, layers))))
        what = f"is damaged: {len(layers)} layers of {lengths or 0} voxels, for {nx} × {ny} × {nz}"
        raise FileError(where, what, "save it again")
    text = "".join(layers)
    if not (text.isascii() and text.isdigit()):
        found = next(each for each in text if each not in "0123456789")
        what = f"has {found!r} among its voxels; digits are read, of up to nine materials"
        raise FileError(where, what, "write fewer materials, or give the voxels as .npy")
    values = np.frombuffer(text.encode(), np.uint8) - ord("0")
    lattice = next(root.iter("Lattice"), None)
    steps, unit = _steps(where, lattice)
    labels = values.reshape(nz, ny, nx).transpose(2, 1, 0)
    return labeled_voxels(
        where, labels, "VoxCAD", steps, unit, list(_names(root, np.unique(values)))
    )


def _steps(where: str, lattice: ET.Element | None) -> tuple[NDArray[np.float64], float | None]:
    """Return the sizes of a voxel in the file's unit, (3,), and that unit in m, if it says it."""
    if lattice is None:
        return np.ones(3), None
    shifts = ("X_Line_Offset", "Y_Line_Offset", "X_Layer_Offset", "Y_Layer_Offset")
    if any(_number(where, lattice, name, 0.0) for name in shifts):
        what = "has a lattice whose lines or layers are shifted, which voxels are not"
        raise FileError(where, what, "set its offsets to 0")
    steps = np.array([_number(where, lattice, f"{axis}_Dim_Adj", 1.0) for axis in _AXES])
    size = _number(where, lattice, "Lattice_Dim", 0.0)
    if min(steps) <= 0.0 or size < 0.0:
        raise FileError(where, "is damaged: its voxels have no size", "set <Lattice_Dim>")
    return steps, size or None


def _number(where: str, parent: ET.Element, name: str, default: float | None) -> float:
    text = parent.findtext(name)
    if text is None and default is not None:
        return default
    try:
        found = float(text or "")
    except ValueError:
        found = math.nan
    if not math.isfinite(found):
        raise FileError(where, f"is damaged: <{name}> is {text!r}; expected a number")
    return found


def _names(root: ET.Element, labels: Sequence[int] | NDArray[np.uint8]) -> Iterator[str]:
    """Yield a sentence on the material of each label that the palette names."""
    for each in root.iter("Material"):
        label, name = each.get("ID", ""), (each.findtext("Name") or "").strip()
        if name and label.isdigit() and int(label) in labels:
            yield f'Label {label} is the material "{name}" of the palette; its numbers are not read'


def labeled_voxels(
    where: str,
    values: NDArray[np.uint8],
    called: str,
    steps: NDArray[np.float64] | None = None,
    unit: float | None = None,
    notes: Sequence[str] = (),
) -> Contents:
    """Return cells of labels, (nx, ny, nz), of voxels with sizes in a unit that is known or not."""
    x, y, z = values.shape
    arrays: dict[str, NDArray[Any]] = {"label": values.ravel(order="F")}
    sizes = np.diag(np.ones(3) if steps is None else steps)
    image = Image((x + 1, y + 1, z + 1), np.zeros(3), sizes, arrays, {}, notes=tuple(notes))
    return contents_of(where, [cells_of_image(where, image)], called, unit)
