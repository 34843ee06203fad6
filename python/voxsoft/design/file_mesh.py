"""Bodies that are the tetrahedra of a mesh file, with the parts and regions that it names."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, BeforeValidator, ConfigDict

from voxsoft.design.references import places_in
from voxsoft.design.region import Region
from voxsoft.errors import DesignError, ErrorDetail, FileError, VoxSoftError
from voxsoft.formats.registry import counts_voxels
from voxsoft.formats.unit import doubt, length_of, sizes
from voxsoft.materials import Hyperelastic
from voxsoft.records import Record, closest, place
from voxsoft.shapes.mesh_bodies import MeshBody, read_body, sizes_in_units

if TYPE_CHECKING:
    from voxsoft.design.model import Design
    from voxsoft.mesh import Mesh

#: Name by which a part takes all elements that no part before it names.
REST: Final = "all"
#: Entries of a design that are about voxels, each with a hint for a mesh from a file.
_OF_VOXELS: Final[Mapping[str, str]] = {
    "voxel_size": "leave it out: the elements are those of the file",
    "fill": "leave it out: tetrahedra are full",
    "refine": "refine the mesh where it was made",
    "symmetry": "hold the plane by a clamp along one axis, on a mesh of the half",
    "layers": "mesh the layer as a part of its own",
    "bodies": "join the meshes in one file, or make the bodies of shapes",
}


def _whole_path(path: object) -> object:
    """Complete a path, so that it leads to the file from everywhere."""
    if isinstance(path, (str, os.PathLike)) and os.fspath(path):
        return os.path.abspath(path)  # noqa: PTH100 - as text, and without asking the disk
    return path


def _is_unit(unit: str) -> str:
    length_of(unit)
    return unit


class FileMesh(Record):
    """The body of a design: all tetrahedra of a mesh file.

    Parameters
    ----------
    path
        A file that :func:`voxsoft.files.read_mesh` reads, such as ``.msh``, ``.inp``, ``.vtu`` and
        ``.vtk``; a relative path is meant from the folder of the design file, in Python from the
        working directory.
    unit
        Length unit of its numbers, such as ``"mm"``: mesh files do not say it. Of an array of
        voxels the side of one, such as ``"0.5 mm"``.

    Notes
    -----
    `shape` of a part is then the name of a part of the file, or ``"all"`` for all that no part
    before it names; `name` of a region is that of a region of the file. Vertices, elements and
    cavities are those of the file: there are no voxels, and nothing that needs them.

    Examples
    --------
    >>> FileMesh(path="bar.msh", unit="mm").unit
    'mm'
    >>> FileMesh(path="bar.msh", unit="kPa")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: unit: "1 kPa" is a pressure; expected a length. Try: give it in ...
    """

    model_config = ConfigDict(json_schema_extra={"examples": [{"path": "bar.msh", "unit": "mm"}]})

    path: Annotated[str, BeforeValidator(_whole_path)]
    unit: Annotated[str, AfterValidator(_is_unit)] | None = None

    @property
    def label(self) -> str:
        """Name in messages."""
        return Path(self.path).name

    def read(self) -> ReadMesh:
        """Read the file, once for as long as it does not change.

        Raises
        ------
        DesignError
            The file cannot be read, holds no valid tetrahedra, or does not say its unit.
        """
        try:
            body = read_body(Path(self.path))
        except FileError as error:
            problems = [ErrorDetail("mesh.path", each.what, each.hint) for each in error.problems]
            raise DesignError.listing(problems) from None
        return _scaled(body, self.label, self.unit)


@dataclass(frozen=True, eq=False)
class ReadMesh:
    """Data that a design takes from a mesh file.

    Attributes
    ----------
    mesh
        Its tetrahedra [m], with its regions; parts are counted from 1.
    parts
        Names of its parts and their numbers in the mesh.
    """

    mesh: Mesh
    parts: Mapping[str, int]

    @property
    def element_size(self) -> float:
        """The edge [m] of a cube that holds five tetrahedra of mean size, as a voxel does."""
        return float(np.cbrt(5.0 * self.mesh.volume / len(self.mesh.tets)))


@lru_cache(maxsize=8)
def _scaled(body: MeshBody, name: str, unit: str | None) -> ReadMesh:
    """The tetrahedra of a file in m, as elements of their own."""
    mesh = body.mesh
    if unit is None:
        raise DesignError("mesh.unit", *_sizes(mesh.vertices, name))
    if mesh.fractions is not None:
        what = f"{name} holds voxels that are partly filled, which tetrahedra are not"
        raise DesignError("mesh.path", what, "solve the design that they are of")
    meter = length_of(unit)
    cavities = tuple(
        replace(each, volume=each.volume * meter**3, area=each.area * meter**2)
        for each in mesh.cavities
    )
    caution = doubt(np.ptp(mesh.vertices, axis=0), meter)
    report = mesh.report and replace(
        mesh.report, meter=meter, cautions=(caution,) if caution else ()
    )
    scaled = replace(
        mesh,
        vertices=mesh.vertices * meter,
        cavities=cavities,
        tet_voxel=None,
        voxel_size=None,
        regions=body.regions,
        report=report,
    )
    return ReadMesh(scaled, body.parts)


def _sizes(vertices: NDArray[np.float64], name: str) -> tuple[str, str]:
    """Text and hint of the error about a missing unit."""
    extents = np.ptp(vertices, axis=0)
    if counts_voxels(name):
        what, hint = sizes(extents, "unit", name)
        return f"is missing: {what}", hint
    shown = " × ".join(f"{extent:.4g}" for extent in extents)
    return (
        f"is missing: the file does not say its unit; its numbers span {shown}",
        f'write unit = "mm", or another; the body would be, {sizes_in_units(extents.max())}',
    )


def with_element_size(document: Mapping[str, Any]) -> tuple[dict[str, Any], list[ErrorDetail]]:
    """Complete the document of a design whose body is a mesh by the size of its elements.

    Returns
    -------
    document : dict
        With the mean size of the elements as ``voxel_size``: other entries sized by the voxels,
        such as rigid objects, use it. Without change where there is no mesh.
    problems : list of ErrorDetail
        The file cannot be read, or entries that need voxels.
    """
    table = document.get("mesh")
    if table is None:
        return dict(document), []
    completed = {**document, "voxel_size": "1 m"}  # any, where the file cannot be read
    problems = [
        ErrorDetail(key, "needs voxels, and the body is the mesh of a file", hint)
        for key, hint in _OF_VOXELS.items()
        if document.get(key)
    ]
    try:
        source = table if isinstance(table, FileMesh) else FileMesh.model_validate(table)
        completed["voxel_size"] = f"{source.read().element_size!r} m"
    except VoxSoftError as error:
        problems += error.problems if error.where.startswith("mesh") else []
    except ValueError:
        pass  # reading the table reports it
    return completed, problems


def mesh_problems(design: Design) -> Iterator[ErrorDetail]:
    """Find names of parts and regions that the file of the mesh does not have."""
    regions: Mapping[str, object] = {}
    if design.mesh is not None:
        found = design.mesh.read()
        regions = found.mesh.regions
        yield from _part_problems(design, design.mesh, found)
    for path, region in places_in(dict(design)):
        if not isinstance(region, Region) or region.name is None:
            continue
        where = place((*path, "name"))
        if design.mesh is None:
            what = "is for regions of a mesh's file, and this design has none"
            yield ErrorDetail(where, what, "give x, y or z ranges, or write [mesh]")
        elif region.name not in regions:
            hint = closest(region.name, regions) or "give x, y or z ranges: the file has no regions"
            what = f'{design.mesh.label} has no region "{region.name}"'
            yield ErrorDetail(where, what, hint)


def _part_problems(design: Design, source: FileMesh, found: ReadMesh) -> Iterator[ErrorDetail]:
    known = ", ".join(f'"{name}"' for name in found.parts)
    named: list[str] = []
    for index, part in enumerate(design.parts):
        where, name = f"parts[{index}].shape", part.shape
        if not isinstance(name, str):
            what = "is a shape, and the body is the mesh of a file"
            yield ErrorDetail(where, what, f'name a part of it ({known}), or "{REST}"')
        elif name in named or (REST in named):
            yield ErrorDetail(where, "nothing is left of it: parts before have all", "leave it out")
        elif name not in (*found.parts, REST):
            hint = closest(name, [*found.parts, REST])
            yield ErrorDetail(where, f'{source.label} has no part "{name}"', hint)
        named.append(name if isinstance(name, str) else "")
        yield from _material_problems(design, index)
    left = [name for name in found.parts if name not in named]
    if left and REST not in named:
        names = ", ".join(f'"{name}"' for name in left)
        plural = "s" if len(left) > 1 else ""
        what = (
            f"the part{plural} {names} of {source.label} {'have' if plural else 'has'} no material"
        )
        yield ErrorDetail("parts", what, f'add [[parts]] with shape = "{left[0]}", or "{REST}"')
    elif REST in named and not left:
        where = f"parts[{named.index(REST)}].shape"
        yield ErrorDetail(where, "nothing is left of it: parts before have all", "leave it out")


def _material_problems(design: Design, index: int) -> Iterator[ErrorDetail]:
    part = design.parts[index]
    try:
        material = design.material_of(part)
    except VoxSoftError:
        return  # no such material: reported with the names
    if isinstance(material, Hyperelastic):
        yield ErrorDetail(
            f"parts[{index}].material",
            "is rubber, which is solved on voxels, and the body is tetrahedra of a file",
            'take a spring material, such as "ecoflex-00-30-lattice"; or give voxel_size and '
            'make shapes of the file: { kind = "mesh", path = "...", unit = "mm", part = "..." }',
        )


def tets_of(design: Design, source: FileMesh) -> Mesh:
    """Return the mesh of a design's file, each tetrahedron of the first part that names it.

    Examples
    --------
    >>> import tempfile
    >>> from voxsoft.design import Design
    >>> from voxsoft.files import write_mesh
    >>> from voxsoft.mesh import Mesh
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "one.msh")
    ...     write_mesh(file, Mesh.from_tets(corners, [[0, 1, 2, 3]]))
    ...     mesh = FileMesh(path=file, unit="cm")
    ...     soft = {"shape": "all", "material": "ecoflex-00-30-lattice"}
    ...     print(tets_of(Design(name="one", mesh=mesh, parts=[soft]), mesh).vertices.max())
    0.01
    """
    found = source.read()
    numbers = np.zeros(256, dtype=np.uint8)
    for index, part in enumerate(design.parts, start=1):
        own = found.parts.values() if part.shape == REST else [found.parts[str(part.shape)]]
        for number in own:
            numbers[number] = numbers[number] or index
    return replace(found.mesh, tet_part=numbers[found.mesh.tet_part])
