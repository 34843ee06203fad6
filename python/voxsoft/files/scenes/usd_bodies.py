"""Bodies in USD: tetrahedra with masses, the drawn surface, parts, regions, materials, tendons."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom, UsdPhysics, UsdShade, Vt

from voxsoft.design import Contact
from voxsoft.files.scenes.scene import Scene
from voxsoft.files.scenes.usd_stage import Floats, Names, extent, named, points
from voxsoft.mesh import BodyMesh
from voxsoft.simulation import named_regions
from voxsoft.simulation.setup.places import on_the_surface

Ints = NDArray[np.integer[Any]]

#: Corners of the faces of a tetrahedron, outward.
_FACES: Final = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))


def add_bodies(stage: Usd.Stage, scene: Scene, names: Names, top: str) -> None:
    """Add the bodies of a scene."""
    materials = _materials(stage, scene, names, top)
    mesh = scene.setup.mesh
    drawn = on_the_surface(scene.design, mesh) - mesh.vertices
    regions = named_regions(scene.design, mesh)
    for name, body in scene.bodies:
        path = names.path(top, name)
        prim = named(UsdGeom.Xform.Define(stage, path), name)
        own = scene.masses[body.vertices]
        UsdPhysics.MassAPI.Apply(prim).CreateMassAttr(float(own.sum()))
        solid = _solid(stage, scene, body, names.path(path, "volume"))
        masses = UsdGeom.PrimvarsAPI(solid).CreatePrimvar(
            "voxsoft:mass", Sdf.ValueTypeNames.DoubleArray, UsdGeom.Tokens.vertex
        )
        masses.Set(Vt.DoubleArray.FromNumpy(np.ascontiguousarray(own)))
        tet_part = mesh.tet_part[body.first_tet : body.first_tet + len(body.mesh.tets)]
        _add_parts(scene, names, solid, "tetrahedron", tet_part, materials)
        for region, vertices in regions.items():
            inside = vertices[(vertices >= body.vertices.start) & (vertices < body.vertices.stop)]
            if len(inside):
                _subset(names, solid, region, "point", inside - body.first_vertex, "region")
        surface = _surface(stage, scene, body, drawn, names.path(path, "surface"))
        _add_parts(scene, names, surface, "face", _parts_of_faces(body, tet_part), materials)


def _solid(stage: Usd.Stage, scene: Scene, body: BodyMesh, path: str) -> UsdGeom.TetMesh:
    solid = UsdGeom.TetMesh.Define(stage, path)
    tets = np.ascontiguousarray(body.mesh.tets, dtype=np.int32)
    solid.CreateTetVertexIndicesAttr(Vt.Vec4iArray.FromNumpy(tets))
    faces = np.ascontiguousarray(body.mesh.triangles, dtype=np.int32)
    solid.CreateSurfaceFaceVertexIndicesAttr(Vt.Vec3iArray.FromNumpy(faces))
    # Drawn where guides are asked for: else it would lie in the surface.
    solid.CreatePurposeAttr(UsdGeom.Tokens.guide)
    rest = scene.setup.mesh.vertices[body.vertices]
    _set_points(solid, scene, rest, body.vertices)
    return solid


def _surface(
    stage: Usd.Stage, scene: Scene, body: BodyMesh, drawn: Floats, path: str
) -> UsdGeom.Mesh:
    surface = UsdGeom.Mesh.Define(stage, path)
    used, triangles = np.unique(body.mesh.triangles, return_inverse=True)
    used = used + body.first_vertex
    surface.CreateFaceVertexCountsAttr(Vt.IntArray(len(body.mesh.triangles), 3))
    indices = np.ascontiguousarray(triangles.ravel(), dtype=np.int32)
    surface.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(indices))
    surface.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    _set_points(surface, scene, scene.setup.mesh.vertices[used] + drawn[used], used, drawn[used])
    return surface


def _set_points(
    shape: UsdGeom.PointBased,
    scene: Scene,
    rest: Floats,
    vertices: Ints | slice,
    shift: Floats | float = 0.0,
) -> None:
    """Set the points of the unloaded body, and those of each state at its time."""
    from voxsoft.files.scenes.usd import RATE

    at, bounds = shape.CreatePointsAttr(points(rest)), shape.CreateExtentAttr(extent(rest))
    for state in scene.states:
        moved = state.positions[vertices] + shift
        at.Set(points(moved), state.time * RATE)
        bounds.Set(extent(moved), state.time * RATE)


def _parts_of_faces(body: BodyMesh, tet_part: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Find the part of each triangle of the surface of a body."""
    count = len(body.mesh.vertices)
    faces = np.sort(body.mesh.tets[:, _FACES].astype(np.int64), axis=2)
    keys = (faces[..., 0] * count + faces[..., 1]) * count + faces[..., 2]
    order = np.argsort(keys, axis=None)
    corners = np.sort(body.mesh.triangles.astype(np.int64), axis=1)
    wanted = (corners[:, 0] * count + corners[:, 1]) * count + corners[:, 2]
    found = order[np.searchsorted(keys.ravel(), wanted, sorter=order)]
    return tet_part[found // len(_FACES)]


def _add_parts(
    scene: Scene,
    names: Names,
    shape: UsdGeom.Imageable,
    kind: str,
    parts: NDArray[np.uint8],
    materials: list[UsdShade.Material],
) -> None:
    for part in np.unique(parts).tolist():
        members = np.flatnonzero(parts == part)
        subset = _subset(names, shape, scene.part_names[part - 1], kind, members, "materialBind")
        UsdShade.MaterialBindingAPI.Apply(subset.GetPrim()).Bind(materials[part - 1])
    family = UsdGeom.Tokens.partition
    UsdGeom.Subset.SetFamilyType(shape, "materialBind", family)


def _subset(
    names: Names, shape: UsdGeom.Imageable, name: str, kind: str, members: Ints, family: str
) -> UsdGeom.Subset:
    path = Sdf.Path(names.path(str(shape.GetPath()), name))
    indices = Vt.IntArray.FromNumpy(np.ascontiguousarray(members, dtype=np.int32))
    subset = UsdGeom.Subset.CreateGeomSubset(shape, path.name, kind, indices, family)
    named(subset, name)
    return subset


def _materials(stage: Usd.Stage, scene: Scene, names: Names, top: str) -> list[UsdShade.Material]:
    folder = names.path(top, "materials")
    UsdGeom.Scope.Define(stage, folder)
    contact = scene.design.contact or Contact()
    found = []
    for index, material in enumerate(scene.setup.materials):
        name = scene.part_names[index]
        shade = UsdShade.Material.Define(stage, names.path(folder, name))
        prim = named(shade, name)
        physics = UsdPhysics.MaterialAPI.Apply(prim)
        physics.CreateDensityAttr(material.density)
        physics.CreateStaticFrictionAttr(contact.friction)
        physics.CreateDynamicFrictionAttr(contact.friction)
        young, poisson = scene.moduli(index)
        for key, value in (("young", young), ("poisson", poisson)):
            prim.CreateAttribute(f"voxsoft:{key}", Sdf.ValueTypeNames.Double).Set(float(value))
        kind = Sdf.ValueTypeNames.String
        prim.CreateAttribute("voxsoft:model", kind).Set(str(material.model))
        found.append(shade)
    return found


def add_tendons(stage: Usd.Stage, scene: Scene, names: Names, top: str) -> None:
    """Add each tendon as a curve along its path in the unloaded body."""
    for tendon in scene.setup.tendons:
        curve = UsdGeom.BasisCurves.Define(stage, names.path(top, tendon.name))
        named(curve, tendon.name)
        curve.CreateTypeAttr(UsdGeom.Tokens.linear)
        curve.CreateCurveVertexCountsAttr([len(tendon.points)])
        curve.CreateWidthsAttr([scene.design.voxel_size / 10.0])
        curve.SetWidthsInterpolation(UsdGeom.Tokens.constant)
        for time, path in _paths(scene, tendon.places, tendon.points):
            curve.CreatePointsAttr().Set(points(path), time)
            curve.CreateExtentAttr().Set(extent(path), time)


def _paths(
    scene: Scene, places: tuple[Any, ...], rest: Floats
) -> Iterator[tuple[Usd.TimeCode, Floats]]:
    """Yield the path of a tendon, unloaded and in each state; points of objects stay."""
    from voxsoft.files.scenes.usd import RATE

    yield Usd.TimeCode.Default(), rest
    for state in scene.states:
        moved = rest.copy()
        for index, place in enumerate(places):
            if place.get("vertices"):
                moved[index] = np.array(place["weights"]) @ state.positions[place["vertices"]]
        yield Usd.TimeCode(state.time * RATE), moved
