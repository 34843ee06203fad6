"""VoxSoft: describe, mesh, simulate, calibrate and optimize soft robots.

Names for everyday use, in one place; the rest is in ``vs.shapes``, ``vs.materials``,
``vs.metrics`` and so on. Names and modules are loaded when first used, so that ``import voxsoft``
stays light.

Examples
--------
>>> import voxsoft as vs
>>> from voxsoft.units import kPa, mm
>>> ball = vs.Sphere(radius=15 * mm) - vs.Sphere(radius=10 * mm)
>>> design = vs.Design(
...     name="ball",
...     voxel_size=2.5 * mm,
...     parts=[vs.Part(shape=ball, material="ecoflex-00-30")],
...     clamps=[vs.Clamp(region=vs.Region(z=("-inf", -10 * mm)))],
...     loads=[vs.Pressure(value=1 * kPa)],
...     probes={"top": vs.Probe(z=(15 * mm, 15 * mm))},
... )
>>> result = vs.simulate(design)
>>> result.status
'ok'
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxsoft._lazy import lazy_names

if TYPE_CHECKING:
    from voxsoft import (
        calibration,
        comparison,
        control,
        design,
        environments,
        errors,
        fabrication,
        fields,
        files,
        instruments,
        jobs,
        materials,
        mesh,
        metrics,
        plot,
        search,
        shapes,
        simulation,
        study,
        units,
        voxels,
    )
    from voxsoft.calibration import Experiment, Measurement, calibrate
    from voxsoft.comparison import compare, error_bars
    from voxsoft.design import (
        Chamber,
        Clamp,
        Constraint,
        Design,
        Floor,
        Force,
        Gravity,
        History,
        Layer,
        Motion,
        Objective,
        Parameter,
        Part,
        Pressure,
        Probe,
        Region,
        Rotation,
        Solver,
        Spring,
        Symmetry,
        Tendon,
        Traction,
    )
    from voxsoft.design.discretization.discretize import mesh_of, voxels_of
    from voxsoft.errors import VoxSoftError
    from voxsoft.files import load, save
    from voxsoft.instruments import Measured, measured
    from voxsoft.materials import (
        Fiber,
        Gent,
        Lattice,
        MooneyRivlin,
        NeoHookean,
        Ogden,
        Rigid,
        Yeoh,
        load_card,
    )
    from voxsoft.mesh import Mesh
    from voxsoft.metrics.own import metric
    from voxsoft.shapes import (
        Box,
        Capsule,
        Cone,
        Cylinder,
        Difference,
        Ellipsoid,
        Function,
        Gyroid,
        HalfSpace,
        Intersection,
        Prism,
        Rotate,
        RoundedBox,
        Sphere,
        Torus,
        Translate,
        TriangleMesh,
        Tube,
        Union,
        voxelize,
    )
    from voxsoft.simulation import (
        Result,
        Rollout,
        Sensor,
        Simulator,
        follow,
        modes,
        rollout,
        simulate,
        simulate_many,
        workspace,
    )
    from voxsoft.simulation.checks.check import check
    from voxsoft.simulation.derivatives.gradient import gradient
    from voxsoft.simulation.derivatives.voxel_gradient import gradient_by_voxel
    from voxsoft.study import Study
    from voxsoft.voxels import Voxels

_HOMES = {
    "voxsoft.calibration": ("Experiment", "Measurement", "calibrate"),
    "voxsoft.comparison": ("compare", "error_bars"),
    "voxsoft.design": (
        "Chamber",
        "Clamp",
        "Constraint",
        "Design",
        "Floor",
        "Force",
        "Gravity",
        "History",
        "Layer",
        "Motion",
        "Objective",
        "Parameter",
        "Part",
        "Pressure",
        "Probe",
        "Region",
        "Rotation",
        "Solver",
        "Spring",
        "Symmetry",
        "Tendon",
        "Traction",
    ),
    "voxsoft.design.discretization.discretize": ("mesh_of", "voxels_of"),
    "voxsoft.errors": ("VoxSoftError",),
    "voxsoft.files": ("load", "save"),
    "voxsoft.instruments": ("Measured", "measured"),
    "voxsoft.materials": (
        "Fiber",
        "Gent",
        "Lattice",
        "MooneyRivlin",
        "NeoHookean",
        "Ogden",
        "Rigid",
        "Yeoh",
        "load_card",
    ),
    "voxsoft.mesh": ("Mesh",),
    "voxsoft.metrics": ("metric",),
    "voxsoft.shapes": (
        "Box",
        "Capsule",
        "Cone",
        "Cylinder",
        "Difference",
        "Ellipsoid",
        "Function",
        "Gyroid",
        "HalfSpace",
        "Intersection",
        "Prism",
        "Rotate",
        "RoundedBox",
        "Sphere",
        "Torus",
        "Translate",
        "TriangleMesh",
        "Tube",
        "Union",
        "voxelize",
    ),
    "voxsoft.simulation": (
        "Result",
        "Rollout",
        "Sensor",
        "Simulator",
        "check",
        "follow",
        "gradient",
        "gradient_by_voxel",
        "modes",
        "rollout",
        "simulate",
        "simulate_many",
        "workspace",
    ),
    "voxsoft.study": ("Study",),
    "voxsoft.voxels": ("Voxels",),
}
#: Modules that ``vs`` has as attributes.
_MODULES = (
    "calibration",
    "comparison",
    "control",
    "design",
    "environments",
    "errors",
    "fabrication",
    "fields",
    "files",
    "instruments",
    "jobs",
    "materials",
    "mesh",
    "metrics",
    "plot",
    "search",
    "shapes",
    "simulation",
    "study",
    "units",
    "voxels",
)
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}
_get, _names = lazy_names(__name__, _HOME_OF, _MODULES)

__all__ = sorted(_HOME_OF)


def __dir__() -> list[str]:
    return _names()


def __getattr__(name: str) -> object:
    if name == "__version__":
        from importlib.metadata import version  # as slow to load as all else here together

        return version("voxsoft")
    return _get(name)
