"""VoxSoft: describe, mesh, simulate, calibrate and optimise soft robots.

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

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from voxsoft.calibration import Calibration, Experiment, Measurement, calibrate
    from voxsoft.comparison import Comparison, compare
    from voxsoft.design import (
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
    from voxsoft.shapes import *
    from voxsoft.simulation import Result, check, gradient, simulate, simulate_many
    from voxsoft.study import Study
    from voxsoft.voxels import Voxels

_HOMES: Final = {
    "voxsoft.calibration": ("Calibration", "Experiment", "Measurement", "calibrate"),
    "voxsoft.comparison": ("Comparison", "compare"),
    "voxsoft.design": (
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
    "voxsoft.simulation": ("Result", "check", "gradient", "simulate", "simulate_many"),
    "voxsoft.study": ("Study",),
    "voxsoft.voxels": ("Voxels",),
}
_HOME_OF: Final = {name: home for home, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> Any:  # noqa: ANN401 - any public object
    if name == "__version__":
        from importlib.metadata import version  # as slow to load as all else here together

        return version("voxsoft")
    if name.startswith("_"):
        raise AttributeError(name)
    home = import_module(_HOME_OF.get(name, "voxsoft.shapes"))
    if not hasattr(home, name):
        raise AttributeError(f"module 'voxsoft' has no attribute '{name}'")
    value = getattr(home, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOME_OF, *import_module("voxsoft.shapes").__all__})
