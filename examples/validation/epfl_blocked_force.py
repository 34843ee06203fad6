"""The blocked force of a bending actuator of EcoFlex 00-30, nothing fitted.

The actuator is that of `epfl_bender.toml`, five chambers in walls of 10 mm, with its tip held.
Measured: Reconfigurable Robotics Lab, EPFL (`examples/data/epfl_bender/README.md`).

In the experiment the root sits in a cup on a slider, free along the actuator, and the end of the
film is pinned to a load cell. Seen from the slider the root is fixed and the tip free along the
actuator: its lower edge is held upright and across, and the force is what holds it there. Weight
was removed from the measurement as its baseline, and is left out.

``python examples/validation/epfl_blocked_force.py``: some minutes. `evidence/blocked_force.py`
has what else the experiment may have been.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from epfl_bender import GEOMETRY, VOXELS, stiffness_open
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

import voxsoft as vs
from voxsoft.scoreboard import Prediction
from voxsoft.units import MPa, kPa, mm

Floats = NDArray[np.float64]

DESIGN = Path(__file__).parent / "epfl_bender.toml"
DATA = Path(__file__).parents[1] / "data" / "epfl_bender" / "blocked_force.csv"
LENGTH, HEIGHT = 70 * mm, 18 * mm
#: The pressures on the scoreboard [Pa]. Below them the force is that of a few grams.
PRESSURES = (20 * kPa, 30 * kPa, 40 * kPa, 50 * kPa, 60 * kPa)
#: Repeats are within so much of their median.
REPEATS = 0.15


@dataclass(frozen=True, kw_only=True)
class Model:
    """What the experiment is taken for.

    `held` are the axes of the tip's edge. `root` is the wall in the cup, which is held behind and
    above, and without which the root's face is held.
    """

    film: float = 41 * MPa
    tunnel: float = 4 * mm
    rubber: str = "ecoflex-00-30-epfl"
    held: str = "yz"
    voxel: float = 2 * mm
    beside: float = 0.0
    root: float = 0.0

    def design(self, pressure: float) -> vs.Design:
        """The actuator with its tip held, under a pressure in Pa."""
        names = ("film", "tunnel", "beside", "root")
        values = {name: getattr(self, name) for name in names}
        design = vs.load(DESIGN, **values, pressure=pressure)
        clamps = [vs.Clamp(region=vs.Region(x=(LENGTH, LENGTH), z=(0, 0)), axes=self.held)]
        if self.root:
            clamps.append(vs.Clamp(region=vs.Region(x=(-self.root, 0), z=(HEIGHT, HEIGHT))))
        (part,) = design.parts
        return design.model_copy(
            update={
                "parts": [part.model_copy(update={"material": self.rubber})],
                "voxel_size": self.voxel,
                "clamps": [*design.clamps, *clamps],
                "solver": vs.Solver(method="statics", tolerance=1e-6),
            }
        )


#: The film of the model whose angles were compared first: with the tip held, load control loses
#: that of silk, a hundred times as stiff, before the first pressure.
DESCRIBED = Model()
#: Half-way to silk.
STIFFER = Model(film=410 * MPa)


def measured() -> dict[float, float]:
    """Force in N by pressure in Pa."""
    with DATA.open() as file:
        rows = list(csv.DictReader(file))
    return {float(row["pressure_kPa"]) * kPa: float(row["force_N"]) for row in rows}


def predicted(pressure: float, model: Model) -> float:
    """The force in N on the load cell under a pressure in Pa, NaN where there is no equilibrium."""
    result = vs.simulate(model.design(pressure))
    if result.status != "ok":
        print(f"{model}, {pressure / kPa:g} kPa: {result.message}", file=sys.stderr)
        return float("nan")
    return _force(result)


def along(pressures: Sequence[float], model: Model) -> Floats:
    """The forces in N along a path of pressures in Pa, (n,).

    The film gives way near 50 kPa: steps of 10 kPa lose the equilibrium there, those of 5 kPa keep
    it.
    """
    between = (np.array(pressures[:-1]) + np.array(pressures[1:])) / 2
    steps = np.sort([*pressures, *between])
    path = vs.follow(model.design(pressures[0]), "pressure", steps)
    if len(path.results) < len(steps):
        raise ArithmeticError(f"{model}: {path.message}")
    return np.array([_force(result) for result in path.results[::2]])


def _force(result: vs.Result) -> float:
    x, _, z = result.mesh.vertices.T
    on_edge = np.isclose(x, LENGTH) & np.isclose(z, 0.0)
    return float(result.reactions[on_edge, 2].sum())


def predictions() -> list[Prediction]:
    """The force of the tip at 20 to 60 kPa.

    Material: as for the bender's angles the stiffness of the rubber is open by a tenth. The force F
    is of first degree in pressure p and stiffness together, so that it goes with the logarithm of
    the stiffness like F − p dF/dp (Euler): about three times as much as the stiffness does. And
    what a film ten times as stiff changes, of 410 MPa: silk has 4.1 GPa. Geometry: what the
    tunnel's true width beside the middle changes, and 6 mm of root in the cup; and, assumed, the
    5 % of the pressure of the bender. Numerics, assumed: its 5 % too. Repeatability: repeats are
    within 15 %.
    """
    here = along(PRESSURES, DESCRIBED)
    slope = CubicSpline(PRESSURES, here)(PRESSURES, 1) * PRESSURES
    film = along(PRESSURES, STIFFER) - here
    tunnel = along(PRESSURES, replace(DESCRIBED, tunnel=2 * mm, beside=1 * mm)) - here
    root = along(PRESSURES, replace(DESCRIBED, root=6 * mm)) - here
    real = measured()
    return [
        Prediction(
            "EPFL bender, tip held",
            f"force at {pressure / kPa:g} kPa",
            "force",
            real[pressure],
            float(force),
            material=float(np.hypot(stiffness_open() * (force - steep), stiff)),
            geometry=float(np.linalg.norm([wide, cup, GEOMETRY * steep])),
            numerics=VOXELS * float(steep),
            repeatability=REPEATS * float(force),
        )
        for pressure, force, steep, stiff, wide, cup in zip(
            PRESSURES, here, slope, film, tunnel, root, strict=True
        )
    ]


def main() -> None:
    """Print forces beside those measured."""
    for each in predictions():
        print(
            f"{each.name}: {each.predicted:.3f} ± {each.half_width:.3f} N, "
            f"measured {each.measured:.3f}"
        )


if __name__ == "__main__":
    main()
