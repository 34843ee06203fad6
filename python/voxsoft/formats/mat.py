"""MAT files of MATLAB up to version 7, read by SciPy: variables, and voxels among them."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.formats.contents import Contents
from voxsoft.formats.voxel_arrays import labeled_voxels

#: First bytes of version 7.3, which is HDF5.
_HDF5: Final = b"MATLAB 7.3"
#: Largest label.
_MOST: Final = 255


def variables_of(path: Path) -> dict[str, Any]:
    """Return the variables of a file by name, without axes of one number.

    Raises
    ------
    FileError
        It is damaged, or of version 7.3.
    """
    from scipy.io import loadmat

    with path.open("rb") as file:
        if file.read(len(_HDF5)) == _HDF5:
            what = "is a MAT file of version 7.3, which is HDF5"
            raise FileError(str(path), what, "save it by save(name, '-v7') in MATLAB")
    try:
        found = loadmat(str(path), squeeze_me=True, struct_as_record=False)
    # SciPy raises errors of many kinds for damaged files.
    except Exception as error:
        shown = str(error).partition("\n")[0][:200] or type(error).__name__
        what = f"cannot be read as MAT: {shown}"
        raise FileError(str(path), what, "save or copy it again") from error
    return {name: value for name, value in found.items() if not name.startswith("__")}


def read_voxels(path: Path) -> Contents:
    """Read the labels of the one array with three axes, whole numbers from 0 to 255.

    Whole numbers that are stored as doubles are labels too: MATLAB calculates in doubles.

    Raises
    ------
    FileError
        It is damaged, has no such array or several, or one with other numbers.
    """
    where, found = str(path), variables_of(path)
    solid = {n: v for n, v in found.items() if isinstance(v, np.ndarray) and v.ndim == 3}
    if len(solid) != 1:
        named = ", ".join(solid) or ", ".join(found) or "nothing"
        what = "several arrays with three axes" if solid else "no array with three axes"
        hint = "save the labels of the voxels alone, in an array along x, y, z"
        raise FileError(where, f"holds {what}: {named}", hint)
    ((name, values),) = solid.items()
    if values.dtype.kind not in "buif":
        raise FileError(where, f"{name} holds {values.dtype}; parts are whole numbers")
    whole: NDArray[Any] = np.asarray(values)
    if not (np.isfinite(whole).all() and (whole == np.round(whole)).all()):
        hint = "compare with a threshold to get the body, or round the labels"
        raise FileError(where, f"{name} holds fractions; parts are whole numbers", hint)
    if not (whole.min() >= 0 and whole.max() <= _MOST):
        what = f"{name} holds {whole.min():g} to {whole.max():g}"
        what += f"; parts are numbered 0 (empty) to {_MOST}"
        raise FileError(where, what, "number the parts from 1, with 0 outside")
    notes = [
        f"{name}: its axes are x, y and z in this order; images of MATLAB have rows first, which "
        "are y: permute(a, [2 1 3]) turns them"
    ]
    return labeled_voxels(where, whole.astype(np.uint8), "MAT", notes=notes)
