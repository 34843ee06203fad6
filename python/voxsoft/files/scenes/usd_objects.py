"""Rigid objects and the floor in USD."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdPhysics, Vt
from scipy.spatial.transform import Rotation

from voxsoft.files.scenes.usd_stage import Floats, Names, extent, named, points, vector

if TYPE_CHECKING:
    from voxsoft.files.scenes.scene import Scene
    from voxsoft.simulation.setup.rigid_objects import Solid


def add_objects(stage: Usd.Stage, scene: Scene, names: Names, top: str) -> None:
    """Add each object with its surface, mass and motion, and the floor as a plane."""
    from voxsoft.files.scenes.usd import RATE

    design, touching = scene.design, scene.setup.touching
    if touching is not None:
        rows = zip(design.objects, touching.surfaces, touching.solids, strict=True)
        for each, surface, solid in rows:
            path = names.path(top, each.name)
            frame = UsdGeom.Xform.Define(stage, path)
            prim = named(frame, each.name)
            place, turn = frame.AddTranslateOp(), frame.AddOrientOp(UsdGeom.XformOp.PrecisionDouble)
            place.Set(Gf.Vec3d(*surface.middle.tolist()))
            turn.Set(Gf.Quatd(1.0))
            for state in scene.states:
                if (pose := state.objects.get(each.name)) is not None:
                    place.Set(Gf.Vec3d(*pose.position), state.time * RATE)
                    turn.Set(_quaternion(np.array(pose.rotation)), state.time * RATE)
            corners = surface.vertices - surface.middle
            mesh = UsdGeom.Mesh.Define(stage, names.path(path, "surface"))
            mesh.CreatePointsAttr(points(corners))
            mesh.CreateExtentAttr(extent(corners))
            mesh.CreateFaceVertexCountsAttr(Vt.IntArray(len(surface.triangles), 3))
            indices = np.ascontiguousarray(surface.triangles.ravel(), dtype=np.int32)
            mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(indices))
            mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
            UsdPhysics.CollisionAPI.Apply(mesh.GetPrim())
            UsdPhysics.MeshCollisionAPI.Apply(mesh.GetPrim()).CreateApproximationAttr(
                UsdPhysics.Tokens.none
            )
            if solid is not None:
                UsdPhysics.RigidBodyAPI.Apply(prim)
                _add_mass(prim, solid, surface.middle)
            elif each.way is not None:
                UsdPhysics.RigidBodyAPI.Apply(prim).CreateKinematicEnabledAttr(True)
    if design.floor is not None:
        floor = UsdGeom.Plane.Define(stage, names.path(top, "floor"))
        named(floor, "floor")
        size = 4.0 * float(np.ptp(scene.setup.mesh.vertices, axis=0).max())
        floor.CreateAxisAttr(UsdGeom.Tokens.z)
        floor.CreateWidthAttr(size)
        floor.CreateLengthAttr(size)
        floor.CreateExtentAttr(
            points(np.array([[-size / 2, -size / 2, 0.0], [size / 2, size / 2, 0.0]]))
        )
        floor.AddTranslateOp().Set(Gf.Vec3d(0.0, 0.0, design.floor.z))
        UsdPhysics.CollisionAPI.Apply(floor.GetPrim())


def _add_mass(prim: Usd.Prim, solid: Solid, middle: Floats) -> None:
    axes = np.array(solid.axes)
    if np.linalg.det(axes) < 0.0:
        axes[2] = -axes[2]
    squares = np.square(solid.radii)
    mass = UsdPhysics.MassAPI.Apply(prim)
    mass.CreateMassAttr(solid.mass)
    mass.CreateCenterOfMassAttr(vector(np.array(solid.center) - middle))
    mass.CreateDiagonalInertiaAttr(vector(solid.mass * (squares.sum() - squares)))
    mass.CreatePrincipalAxesAttr(Gf.Quatf(_quaternion(axes.T)))


def _quaternion(matrix: Floats) -> Gf.Quatd:
    x, y, z, w = Rotation.from_matrix(matrix).as_quat().tolist()
    return Gf.Quatd(w, x, y, z)
