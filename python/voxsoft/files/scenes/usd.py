"""USD, the scenes of Blender, Houdini and Omniverse: bodies, parts, objects and their motion.

A body is a tetrahedral mesh with the masses of its vertices, parts and regions as subsets, and
beside it the surface that is drawn. Lengths are in m, masses in kg, z is up; states are time
samples, 24 time codes in a second. Physics beyond mass, density, friction, gravity and rigid bodies
has no schema in USD: the list of losses, which the file has as its comment, names it.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np

from voxsoft.errors import ErrorDetail, MissingPackageError
from voxsoft.files.atomic import replace_whole
from voxsoft.files.scenes.scene import SceneSource

if TYPE_CHECKING:
    from pxr import Usd

    from voxsoft.files.scenes.scene import Scene

#: Time codes in a second, as films and viewers have them.
RATE: Final = 24.0

_ELASTIC: Final = "is not held: USD has no schema for it"
_LOAD: Final = "is not held: USD has no loads but gravity"
#: Reason for each feature of a design that USD does not hold; it holds those in `COMMON`.
SENTENCES: Final[Mapping[str, str]] = MappingProxyType(
    {
        "pressure": _LOAD,
        "force": _LOAD,
        "traction": _LOAD,
        "magnetic field": _LOAD,
        "immersion": _LOAD,
        "drag": _LOAD,
        "force field": _LOAD,
        "load over time": "is not held: the file has its final value",
        "objects that turn": "is held as the poses of its states alone",
        "bonds": "is a bond and is not held",
        "adhesion": "is not held: USD has friction alone",
        "tendons": "is held as a curve, without its pull",
        "springs and the like": _ELASTIC,
        "supplies": "is not held: USD has no gas or liquid in a chamber",
        "layers": _ELASTIC,
        "fibers": _ELASTIC,
        "activations": _ELASTIC,
        "softening": _ELASTIC,
        "viscosity": _ELASTIC,
        "local refinement": "is written with small voxels everywhere that the mesh has them",
        "cut voxels": "has whole voxels as tetrahedra; masses and surface are those of cut ones",
    }
)


def write(path: Path, source: SceneSource) -> list[ErrorDetail]:
    """Write a scene as USD: text, binary or an archive, by the suffix.

    Parameters
    ----------
    path
        The file: ``.usda``, ``.usdc``, ``.usdz`` or ``.usd``, which is binary.
    source
        Source of the scene.

    Returns
    -------
    list of ErrorDetail
        Entries of the design that the file does not hold, or holds in another form.

    Raises
    ------
    MissingPackageError
        The package usd-core is not installed.
    OutputError
        The file cannot be written.
    """
    try:
        import pxr  # noqa: F401 - whether it is there
    except ImportError:
        what = "is not installed, and writes the file"
        raise MissingPackageError("usd-core", what, "pip install 'voxsoft[usd]'") from None
    scene = source.scene()
    lost = scene.lost(SENTENCES)
    for index, material in enumerate(scene.setup.materials):
        what = f'"{material.model}" is held as density and, in attributes of VoxSoft, its moduli'
        lost.append(ErrorDetail(f"parts[{index}].material", what))
    lost += _lost_motions(scene)
    stage = stage_of(scene)
    lines = ["Written by VoxSoft.", *(["Not held, or in another form:"] if lost else [])]
    stage.GetRootLayer().comment = "\n".join([*lines, *(f"- {each}" for each in lost)])
    replace_whole(path, lambda beside: _export(stage, beside))
    return lost


def _lost_motions(scene: Scene) -> list[ErrorDetail]:
    """List the motions that only the states of a result have."""
    design = scene.design
    moved = [f"clamps[{i}].motion" for i, each in enumerate(design.clamps) if each.motion]
    moved += [f"objects[{i}].motion" for i, each in enumerate(design.objects) if each.way]
    what = "is held as the states of a result alone" if scene.states else "is not held"
    return [ErrorDetail(where, what, "export a result") for where in moved]


def _export(stage: Usd.Stage, path: Path) -> None:
    from pxr import Sdf, UsdUtils

    if path.suffix.lower() != ".usdz":
        stage.GetRootLayer().Export(str(path))
        return
    with tempfile.TemporaryDirectory(prefix="voxsoft-usd-") as folder:
        inner = Path(folder) / "scene.usdc"
        stage.GetRootLayer().Export(str(inner))
        UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(str(inner)), str(path))


def stage_of(scene: Scene) -> Usd.Stage:
    """Build the stage of a scene in memory."""
    from pxr import Gf, Usd, UsdGeom, UsdPhysics

    from voxsoft.files.scenes.usd_bodies import add_bodies, add_tendons
    from voxsoft.files.scenes.usd_objects import add_objects
    from voxsoft.files.scenes.usd_stage import Names, named

    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdPhysics.SetStageKilogramsPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    stage.SetTimeCodesPerSecond(RATE)
    stage.SetFramesPerSecond(RATE)
    if scene.states:
        times = [state.time * RATE for state in scene.states]
        stage.SetStartTimeCode(min(times))
        stage.SetEndTimeCode(max(times))
    names = Names()
    root = named(UsdGeom.Xform.Define(stage, names.path("", scene.design.name)), scene.design.name)
    Usd.ModelAPI(root).SetKind("component")
    stage.SetDefaultPrim(root)
    top = str(root.GetPath())
    gravity = scene.gravity
    physics = UsdPhysics.Scene.Define(stage, names.path(top, "physics"))
    size = float(np.linalg.norm(gravity))
    physics.CreateGravityMagnitudeAttr(size)
    if size:
        physics.CreateGravityDirectionAttr(Gf.Vec3f(*(gravity / size).tolist()))
    add_bodies(stage, scene, names, top)
    add_tendons(stage, scene, names, top)
    add_objects(stage, scene, names, top)
    return stage
