"""Images of scanners by their libraries: NRRD, NIfTI and stacks of TIFF, as cells with labels.

Coordinates are those of the file's space, right, anterior and superior where it says how it lies:
left and posterior ones change their sign.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError, MissingPackageError
from voxsoft.formats.contents import Contents
from voxsoft.formats.vtk_data import contents_of
from voxsoft.formats.vtk_grids import Image, cells_of_image

Floats = NDArray[np.float64]

#: Meters in units as the formats write them.
_UNITS: Final[Mapping[str, float]] = {
    "m": 1.0,
    "meter": 1.0,
    "cm": 1e-2,
    "mm": 1e-3,
    "millimeter": 1e-3,
    "um": 1e-6,
    "\N{MICRO SIGN}m": 1e-6,
    "\\u00B5m": 1e-6,
    "micron": 1e-6,
    "inch": 0.0254,
}
#: Signs of the axes of a space of NRRD toward right, anterior and superior.
_SPACES: Final = {
    "right-anterior-superior": (1.0, 1.0, 1.0),
    "ras": (1.0, 1.0, 1.0),
    "left-anterior-superior": (-1.0, 1.0, 1.0),
    "las": (-1.0, 1.0, 1.0),
    "left-posterior-superior": (-1.0, -1.0, 1.0),
    "lps": (-1.0, -1.0, 1.0),
}


def read_nifti(path: Path) -> Contents:
    """Read the labels of a NIfTI file, whole numbers as they are stored.

    Raises
    ------
    FileError
        It is damaged, has another number of axes than three, or no labels.
    MissingPackageError
        nibabel is not installed.
    """
    try:
        import nibabel
    except ImportError:
        raise _missing("nibabel", "NIfTI") from None
    try:
        image: Any = nibabel.load(path)
        values = np.asarray(image.dataobj.get_unscaled())
    # nibabel raises errors of many kinds for damaged files.
    except Exception as error:
        raise _damaged(path, "NIfTI", error) from error
    notes = []
    slope, shift = image.dataobj.slope, image.dataobj.inter
    if (slope, shift) != (1.0, 0.0):
        notes.append(
            f"Numbers are scaled by {slope:g} and shifted by {shift:g} in the file: those that are "
            "stored are the labels"
        )
    affine = np.asarray(image.affine, dtype=np.float64)
    unit = _UNITS.get(image.header.get_xyzt_units()[0])
    return _labeled(path, "NIfTI", values, affine[:3, 3], affine[:3, :3].T, unit, notes)


def read_nrrd(path: Path) -> Contents:
    """Read the labels of an NRRD file.

    Raises
    ------
    FileError
        It is damaged, has another number of axes than three, no spacing, or no labels.
    MissingPackageError
        pynrrd is not installed.
    """
    try:
        import nrrd
    except ImportError:
        raise _missing("pynrrd", "NRRD") from None
    try:
        values, header = nrrd.read(str(path), index_order="F")
    # pynrrd raises errors of many kinds for damaged files.
    except Exception as error:
        raise _damaged(path, "NRRD", error) from error
    notes: list[str] = []
    steps = header.get("space directions")
    if steps is None and header.get("spacings") is not None:
        steps = np.diag(np.asarray(header["spacings"], dtype=np.float64))
    if steps is None:
        what = "does not say how large its voxels are: it has neither space directions nor spacings"
        raise FileError(str(path), what, "save it with them, as 3D Slicer does")
    rows = np.asarray(steps, dtype=np.float64)
    origin = np.asarray(header.get("space origin", np.zeros(3)), dtype=np.float64)
    space = str(header.get("space", "")).lower()
    if rows.shape == (3, 3) and origin.shape == (3,) and space in _SPACES:
        rows, origin = rows * _SPACES[space], origin * _SPACES[space]
        if min(_SPACES[space]) < 0.0:
            notes.append(f"Coordinates {space} are turned to right, anterior, superior")
    units = header.get("space units") or header.get("units") or []
    return _labeled(path, "NRRD", values, origin, rows, _unit_of(units), notes)


def read_tiff(path: Path) -> Contents:
    """Read the labels of a stack of TIFF whose spacing ImageJ wrote.

    Raises
    ------
    FileError
        It is damaged, no stack of single numbers, says no spacing, or has no labels.
    MissingPackageError
        tifffile is not installed.
    """
    try:
        import tifffile
    except ImportError:
        raise _missing("tifffile", "TIFF") from None
    try:
        with tifffile.TiffFile(path) as file:
            series = file.series[0]
            axes, values = series.axes, series.asarray()
            known: dict[str, Any] = dict(file.imagej_metadata or {})
            page: Any = file.pages[0]
            resolution = {axis: page.tags.valueof(f"{axis}Resolution") for axis in ("X", "Y")}
    # tifffile raises errors of many kinds for damaged files.
    except Exception as error:
        raise _damaged(path, "TIFF", error) from error
    if "S" in axes:
        what = f"holds colors, {values.shape} along {axes}, or three slices that were saved as such"
        raise FileError(str(path), what, 'save labels; in tifffile with photometric="minisblack"')
    if len(axes) != 3 or axes[1:] != "YX":
        what = f"is no stack of images: it has {values.shape} numbers along {axes}"
        raise FileError(str(path), what, "save one image for each layer, from the lowest up")
    unit = _UNITS.get(str(known.get("unit", "")))
    if unit is None or "spacing" not in known or not all(resolution.values()):
        what = "does not say how large its voxels are: spacing and unit, as ImageJ writes them"
        hint = "set them in ImageJ by Image > Properties, or save it as NRRD or NIfTI"
        raise FileError(str(path), what, hint)
    sizes = [below / above for above, below in (resolution["X"], resolution["Y"])]
    steps = np.diag([*sizes, float(known["spacing"])])
    notes = ["Rows of an image are y, from above: y of the body points down there"]
    turned = values.transpose(2, 1, 0)
    return _labeled(path, "TIFF", turned, np.zeros(3), steps, unit, notes)


def _labeled(
    path: Path,
    called: str,
    values: NDArray[Any],
    origin: Floats,
    steps: Floats,
    unit: float | None,
    notes: list[str],
) -> Contents:
    """Return cells of labels, (nx, ny, nz), with the step along each axis as a row, (3, 3)."""
    where = str(path)
    while values.ndim > 3 and values.shape[-1] == 1:
        values = values[..., 0]
    if values.ndim != 3 or values.dtype.names is not None:
        what = f"holds {values.dtype} of shape {values.shape}; a body has three axes of numbers"
        raise FileError(where, what, "save labels alone: no colors, times or vectors")
    sound = steps.shape == (3, 3) and origin.shape == (3,) and np.isfinite(steps).all()
    size = float(np.linalg.det(steps)) if sound else 0.0
    if not math.isfinite(size) or size == 0.0 or not np.isfinite(origin).all():
        what = "is damaged: its voxels have no size or place"
        raise FileError(where, what, "save it with the spacing of its voxels")
    if size < 0.0:
        # The first axis runs backward, so that cells are right-handed.
        values, origin = values[::-1], origin + (values.shape[0] - 1) * steps[0]
        steps = steps * np.array([[-1.0], [1.0], [1.0]])
    x, y, z = values.shape
    image = Image((x, y, z), origin, steps, {}, {"label": values.ravel(order="F")})
    cells = cells_of_image(where, image)
    found = contents_of(where, [cells], called, unit)
    kept = found.notes + tuple(notes)
    return Contents(
        found.points,
        found.blocks,
        found.cell_sets,
        found.point_sets,
        found.arrays,
        unit,
        kept,
        called,
    )


def _unit_of(units: Sequence[str]) -> float | None:
    """Return meters in units that are the same along all axes; None where they say none."""
    known = {_UNITS.get(str(each).strip()) for each in units if str(each).strip()}
    return known.pop() if len(known) == 1 else None


def _missing(package: str, called: str) -> MissingPackageError:
    what = f"is not installed, and reads {called}"
    return MissingPackageError(package, what, "pip install 'voxsoft[images]'")


def _damaged(path: Path, called: str, error: Exception) -> FileError:
    shown = str(error).partition("\n")[0][:200] or type(error).__name__
    return FileError(str(path), f"cannot be read as {called}: {shown}", "save or copy it again")
