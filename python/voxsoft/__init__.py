"""VoxSoft: describe, mesh, simulate, calibrate and optimize soft robots.

What a user types, in one place; names are loaded when first used, so that ``import voxsoft`` stays
light.

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
    from voxsoft.calibration import Calibration, Experiment, Measurement, calibrate
    from voxsoft.comparison import Comparison, compare
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
        Traction,
    )
    from voxsoft.design.discretize import mesh_of, voxels_of
    from voxsoft.errors import VoxSoftError
    from voxsoft.files import load, save
    from voxsoft.materials import (
        Card,
        CompliantLattice,
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
    from voxsoft.shapes import *
    from voxsoft.simulation import (
        Observation,
        Result,
        Simulator,
        check,
        gradient,
        simulate,
        simulate_many,
    )
    from voxsoft.study import Study
    from voxsoft.voxels import Voxels

_HOMES = {
    "voxsoft.calibration": ("Calibration", "Experiment", "Measurement", "calibrate"),
    "voxsoft.comparison": ("Comparison", "compare"),
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
        "Traction",
    ),
    "voxsoft.design.discretize": ("mesh_of", "voxels_of"),
    "voxsoft.errors": ("VoxSoftError",),
    "voxsoft.files": ("load", "save"),
    "voxsoft.materials": (
        "Card",
        "CompliantLattice",
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
        "IWP",
        "AnyShape",
        "Array",
        "Bcc",
        "Bend",
        "Blend",
        "Box",
        "Capsule",
        "Cone",
        "Cubic",
        "Cylinder",
        "Difference",
        "Ellipsoid",
        "Expression",
        "Fcc",
        "Function",
        "Grade",
        "Gyroid",
        "HalfSpace",
        "Intersection",
        "Mirror",
        "Neovius",
        "Octet",
        "Offset",
        "PolarArray",
        "Prism",
        "Revolve",
        "Rotate",
        "RoundedBox",
        "Scale",
        "SchwarzD",
        "SchwarzP",
        "Shape",
        "Shell",
        "Sphere",
        "Taper",
        "Torus",
        "Translate",
        "TriangleMesh",
        "Tube",
        "Twist",
        "Union",
        "atan2",
        "cos",
        "exp",
        "grid_bounds",
        "inside",
        "log",
        "maximum",
        "minimum",
        "random_shape",
        "sin",
        "sqrt",
        "tan",
        "voxelize",
        "x",
        "y",
        "z",
    ),
    "voxsoft.simulation": (
        "Observation",
        "Result",
        "Simulator",
        "check",
        "gradient",
        "simulate",
        "simulate_many",
    ),
    "voxsoft.study": ("Study",),
    "voxsoft.voxels": ("Voxels",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}
_get, __dir__ = lazy_names(__name__, _HOME_OF)

__all__ = sorted(_HOME_OF)


def __getattr__(name: str) -> object:
    if name == "__version__":
        from importlib.metadata import version  # as slow to load as all else here together

        return version("voxsoft")
    return _get(name)
