"""Reading of contents from a path, by the reader for the name's suffix."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Final

from voxsoft.errors import FileError
from voxsoft.formats import by_meshio, registry, vtk_xml
from voxsoft.formats.contents import Contents

#: Files of VTK that list other files: their reader names those.
_LISTS: Final = (".vtm", ".vtmb", ".pvd", ".pvtu", ".pvtp", ".pvti", ".pvts", ".pvtr")
#: Advice for formats that are not read: programs that convert them.
_WAYS: Final = (
    ((".amf",), "open it in a slicer such as PrusaSlicer and export it as 3MF or STL"),
    ((".unv",), "open it in Gmsh and save it as .msh"),
    (
        (".gltf", ".dae", ".fbx", ".x3d", ".blend", ".usd", ".usda", ".usdc", ".usdz"),
        "open it in Blender and export it as STL or as glTF binary, .glb",
    ),
    (
        (".mha", ".mhd", ".dcm"),
        "open its labels, whole numbers with 0 outside, in 3D Slicer and save them as .nrrd",
    ),
    ((".vtkhdf", ".hdf", ".vthb"), "open it in ParaView and save it as .vtu"),
    ((".npz",), "save its array by numpy.save, as .npy"),
)

#: Formats of meshio that are drawings.
_DRAWINGS: Final = {".svg", ".wkt"}


@cache
def known_suffixes() -> tuple[str, ...]:
    """Return the suffixes of the files that can be read: own readers and those of meshio.

    Examples
    --------
    >>> {".stl", ".obj", ".ply", ".off", ".mesh", ".msh", ".vtu"} <= set(known_suffixes())
    True
    """
    import meshio

    return tuple(sorted({*registry.READ, *meshio.extension_to_filetypes} - _DRAWINGS))


def read_contents(path: Path) -> Contents:
    """Return all contents of a mesh file.

    Raises
    ------
    FileError
        If the file is missing, of an unknown suffix, cut short, or invalid in its format.

    Examples
    --------
    >>> read_contents(Path("no-such-file.msh"))
    Traceback (most recent call last):
        ...
    voxsoft.errors.FileError: no-such-file.msh: no such file
    """
    suffix = ".nii.gz" if path.name.lower().endswith(".nii.gz") else path.suffix.lower()
    if suffix not in known_suffixes() and suffix not in _LISTS:
        ways = (way for suffixes, way in _WAYS if suffix in suffixes)
        what = f"unknown format {path.suffix!r}; known are {', '.join(known_suffixes())}"
        raise FileError(str(path), what, next(ways, "export it as STL, OBJ or .vtu"))
    if not path.is_file():
        raise FileError(str(path), "no such file")
    if not path.stat().st_size:
        raise FileError(str(path), "holds nothing: it has 0 bytes", "save or copy it again")
    if suffix in _LISTS:
        return vtk_xml.read(path)
    form = registry.READ.get(suffix)
    if form is None or form.reader is None:
        return by_meshio.read(path)
    contents: Contents = registry.function(form.reader)(path)
    return contents
