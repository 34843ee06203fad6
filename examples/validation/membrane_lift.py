"""Seven membranes of EcoFlex 00-30 that lift weights: pressure for a height, nothing fitted.

Rings of rubber around a rigid disc, as `membrane.toml` has them. The silicone's constants come from
tensile tests of another laboratory, and the modulus of the fabric from the authors' theory. The
disc is put at a height, and the pressure found at which the membrane lifts the weight there: some
measured curves fall in between, so that one pressure has several heights
(`examples/data/membrane_lift/README.md`).

At rest the disc lies on a plate, which carries what the membrane does not. It leaves the plate at
the pressure at which the membrane lifts all of the weight at no height: the force that a disc at a
given height needs and that of a plate below it are the same reaction.

``python examples/validation/membrane_lift.py [--fine]``: a quarter of an hour on one core; `--fine`
prints what two voxels through the membrane change, another five minutes.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

import voxsoft as vs
from voxsoft.materials import load_card
from voxsoft.scoreboard import Prediction
from voxsoft.units import MPa, kPa, mm

Floats = NDArray[np.float64]

DESIGN = Path(__file__).parent / "membrane.toml"
DATA = Path(__file__).parents[1] / "data" / "membrane_lift" / "pressure.csv"
#: Radius of the clamp [m].
RIM = 70 * mm
#: The heights [m] and the weight [N] on the scoreboard.
HEIGHTS = (10 * mm, 30 * mm, 50 * mm)
WEIGHT = 14.72
#: Where a path of pressures begins, in parts of one that is expected, and how it goes on. The force
#: is smooth: a cubic spline through such steps is within 0.3 %, less than pressures scatter.
FIRST, STEP = 0.85, 1.1
#: The next pressures where the rubber is softer than the one expected: its membrane is sooner a
#: balloon.
SMALLER = 1.06
#: How near the force is to the weight before one more secant is the pressure, which leaves 0.3 %.
NEAR = 0.05
#: Standard deviations of the middle 90 % of a normal distribution.
NINETY = 1.645
#: What may be of other thickness: a cast sheet of 2 mm, within 0.1 mm. An assumption.
THICKNESS = 0.05
#: What two voxels through the membrane change of the pressure at each height, rounded up: 0 to 2 %
#: without rings (`docs/validation.md`). That rings change it no more is assumed; see `--fine`.
FINE = {10 * mm: 0.01, 30 * mm: 0.02, 50 * mm: 0.02}


@dataclass(frozen=True)
class Membrane:
    """One of those measured: its values in the design, and whether it has rings."""

    name: str
    disc: float
    thickness: float = 2 * mm
    rings: dict[str, float] = field(default_factory=dict)

    def values(self) -> dict[str, float]:
        """The values of the design's parameters."""
        return {"disc": self.disc, "thickness": self.thickness, **self.rings}


MEMBRANES = (
    Membrane("plain", 25.4 * mm),
    Membrane("rings", 25.4 * mm, rings={"ring1": 49 * mm, "ring2": 62 * mm}),
    Membrane("thick", 29.63 * mm, 2.33 * mm, {"ring1": 37.63 * mm, "ring2": 62 * mm}),
    Membrane(
        "wide-outer",
        27.98 * mm,
        rings={"ring1": 45.58 * mm, "ring2": 60.29 * mm, "half2": 6.71 * mm},
    ),
    Membrane(
        "large-disc",
        38.1 * mm,
        rings={"ring1": 47.55 * mm, "half1": 6.45 * mm, "ring2": 62 * mm},
    ),
    Membrane("inner-rings", 25.4 * mm, rings={"ring1": 33.4 * mm, "ring2": 46.4 * mm}),
    Membrane("middle-rings", 31.92 * mm, rings={"ring1": 46 * mm, "ring2": 59 * mm}),
)


@dataclass(frozen=True)
class Model:
    """What a membrane is taken for: its rubber, the modulus of its rings [Pa], its voxels."""

    rubber: str | vs.Ogden | vs.Gent = "ecoflex-00-30-epfl"
    fabric: float = 3 * MPa
    refine: int = 1


#: Chosen before any pressure was computed: the card of the bending actuator, and the rings of the
#: authors' theory.
DESCRIBED = Model()
#: The same silicone in two other laboratories: a tensile test and a cantilever.
ELSEWHERE = (Model("ecoflex-00-30-tensile"), Model("ecoflex-00-30-bending"))
#: Rings that hardly stretch.
STIFF = Model(fabric=30 * MPa)


class _Enough(Exception):
    """A path has reached the force it was followed for."""


class Lost(ArithmeticError):
    """A path of pressures ends before the weight is lifted.

    `last` is its last pressure in Pa, and `further` where its last slope would lift the weight.
    """

    def __init__(self, message: str, last: float, further: float) -> None:
        super().__init__(message)
        self.last, self.further = last, further


class Lifted:
    """One membrane with its disc at a height: the force on the disc over the pressure."""

    def __init__(self, membrane: Membrane, model: Model, height: float) -> None:
        self.membrane, self.model, self.height = membrane, model, height
        self.seen: dict[float, float] = {}

    def force(self, pressure: float) -> float:
        """What it lifts at a pressure in Pa, in N; NaN where there is no equilibrium."""
        if pressure not in self.seen:
            result = vs.simulate(self._design(pressure), refine=self.model.refine)
            if result.status != "ok":
                where = f"{self.height / mm:g} mm, {pressure:.0f} Pa"
                print(f"{where}: {result.message}", file=sys.stderr)
            self.seen[pressure] = self._force(result) if result.status == "ok" else float("nan")
        return self.seen[pressure]

    def forces(self, pressures: Sequence[float], enough: float = np.inf) -> Floats:
        """What it lifts along a path of pressures in Pa, in N, (n,), each from the one before.

        The path ends above a force that is enough, and where there is no equilibrium.
        """
        found: list[float] = []

        def look(path: vs.LoadPath) -> None:
            found.append(self._force(path.results[-1]))
            if found[-1] > enough:
                raise _Enough

        with suppress(_Enough):
            vs.follow(
                self._design(pressures[0]),
                "pressure",
                pressures,
                step=look,
                refine=self.model.refine,
            )
        return np.array(found)

    def lifting(self, weight: float, first: float, step: float) -> tuple[float, float]:
        """The pressure in Pa at which it lifts a weight in N, and the slope of the force in N/Pa.

        By a path of pressures from a first one, each so many times the one before: quicker than
        secants that each begin at rest, and it does not go far beyond what the membrane can carry.
        Where the first lifts the weight already, the path begins lower.

        Raises
        ------
        Lost
            The path ends before the weight is lifted.
        """
        pressures = [first * step**number for number in range(40)]
        forces = self.forces(pressures, enough=weight)
        if len(forces) == 1 and forces[0] > weight:
            return self.lifting(weight, FIRST * first, step)
        if len(forces) < 2 or not forces[-1] > weight:
            name = f"{self.membrane.name} at {self.height / mm:g} mm, {self.model}"
            what = f"no path of pressures lifts {weight} N: {forces.round(2)}"
            last = further = pressures[max(len(forces), 1) - 1]
            if len(forces) > 1 and forces[-1] > forces[-2]:
                before = pressures[len(forces) - 2]
                rise = (weight - forces[-1]) / (forces[-1] - forces[-2])
                further = last + float(rise) * (last - before)
            raise Lost(f"{name}: {what}", last, further)
        curve = CubicSpline(pressures[: len(forces)], forces)
        at = float(brentq(lambda p: curve(p) - weight, *pressures[len(forces) - 2 : len(forces)]))
        return at, float(curve(at, 1))

    def pressure(self, weight: float, start: float) -> float:
        """The pressure in Pa at which it lifts a weight in N, NaN if none is found.

        Secants from a pressure near it; the force grows steadily with the pressure.
        """
        here, force, slope = start, self.force(start), 0.0
        for _ in range(8):
            left = weight - force
            if slope > 0.0 and abs(left) <= NEAR * weight:
                return here + left / slope
            # A step of a quarter at most: far beyond, the membrane is a balloon without end. And of
            # a hundredth at least, for the slope.
            size = np.clip(abs(left) / (slope or force / here), 0.01 * here, 0.25 * here)
            then, before = here, force
            here += float(np.copysign(size, left))
            force = self.force(here)
            slope = (force - before) / (here - then)
        return float("nan")

    def _design(self, pressure: float) -> vs.Design:
        values = {**self.membrane.values(), "fabric": self.model.fabric}
        design = vs.load(DESIGN, height=self.height, pressure=pressure, **values)
        (part,) = design.parts
        part = part.model_copy(update={"material": self.model.rubber})
        layers = design.layers if self.membrane.rings else []
        return design.model_copy(update={"parts": [part], "layers": layers})

    def _force(self, result: vs.Result) -> float:
        x, y, _ = result.mesh.vertices.T
        half = self.membrane.thickness / self.model.refine / 2
        on_disc = np.hypot(x, y) <= self.membrane.disc + half
        return -4.0 * float(result.reactions[on_disc, 2].sum())


def rows() -> list[dict[str, str]]:
    """The rows of the data."""
    with DATA.open() as file:
        return list(csv.DictReader(file))


def measured() -> dict[tuple[str, float, float], float]:
    """Pressure in Pa by membrane, weight in N and height in m."""
    return {_key(row): float(row["pressure_Pa"]) for row in rows()}


def scatter() -> dict[tuple[str, float, float], float]:
    """How far the lowest and highest pressures are from the median, in Pa, by the same keys.

    The farthest at the height itself and the two next to it on either side, 1 mm apart: at some
    heights there is a single sample.
    """
    own = {
        _key(row): max(
            float(row["highest_Pa"]) - float(row["pressure_Pa"]),
            float(row["pressure_Pa"]) - float(row["lowest_Pa"]),
        )
        for row in rows()
    }
    return {
        (name, weight, height): max(
            own.get((name, weight, _millimeters(height / mm + step)), 0.0)
            for step in (-2, -1, 0, 1, 2)
        )
        for name, weight, height in own
    }


def _key(row: dict[str, str]) -> tuple[str, float, float]:
    return row["membrane"], float(row["force_N"]), _millimeters(float(row["height_mm"]))


def _millimeters(number: float) -> float:
    """A whole number of millimeters in m, the same number for the same height."""
    return round(number) * mm


def expected(membrane: Membrane, weight: float) -> float:
    """About the pressure in Pa for a weight in N at a low height: that of a slack cone."""
    return weight / (np.pi / 3.0 * (RIM**2 + RIM * membrane.disc + membrane.disc**2))


def predictions() -> Iterator[Prediction]:
    """The pressures at which each membrane lifts 14.72 N to 10, 30 and 50 mm.

    Material: the same silicone in three laboratories. Pressures by the card of one tensile test, of
    another, and of a cantilever scatter, and the half-width is 1.645 times the standard deviation
    of their logarithms; where the path of a softer card is lost, its last slope goes on. And the
    whole of what rings ten times as stiff change, as they are cloth that does not stretch, or what
    is known of it where their path is lost. Geometry, assumed: the thickness within 5 %. Without
    its weight the force is of first degree in pressure and stiffness together, so that the pressure
    p for a force F goes with the logarithm of the thickness like p − F / (dF/dp) (Euler). Numerics:
    what two voxels through the membrane without rings change. Repeatability: the lowest and highest
    pressures that were recorded within 2 mm of the height.

    Where the path of the membrane itself is lost, its last pressure counts as the prediction, with
    voxels and repeatability alone: a number that the model does not have is not left out.
    """
    real, scattered = measured(), scatter()
    for membrane in MEMBRANES:
        near = expected(membrane, WEIGHT)
        for height in HEIGHTS:
            key = membrane.name, WEIGHT, height
            try:
                main = Lifted(membrane, DESCRIBED, height).lifting(WEIGHT, FIRST * near, STEP)
            except Lost as lost:
                print(lost, file=sys.stderr)
                here, material, geometry = lost.last, 0.0, 0.0
            else:
                here, slope = main
                stiffness = here - WEIGHT / slope
                rubber = NINETY * float(np.std(_elsewhere(membrane, height, main), ddof=1))
                material = float(np.hypot(rubber * here, _stiffer(membrane, height, here)))
                geometry = THICKNESS * abs(stiffness)
            near = here
            yield Prediction(
                "membranes",
                f"{membrane.name}, {WEIGHT:g} N to {height / mm:g} mm",
                "pressure",
                real[key],
                here,
                material=material,
                geometry=geometry,
                numerics=FINE[height] * here,
                repeatability=scattered[key],
            )


def _elsewhere(membrane: Membrane, height: float, main: tuple[float, float]) -> list[float]:
    """Logarithms of the pressure by the cards of the three laboratories."""
    here, slope = main
    logs = [float(np.log(here))]
    for model in ELSEWHERE:
        # To first order by Euler's theorem, as if the rings were of the same rubber.
        softer = np.log(_young(model) / _young(DESCRIBED)) * (1.0 - WEIGHT / slope / here)
        first = FIRST * here * float(np.exp(np.clip(softer, -0.4, 0.0)))
        try:
            logs.append(float(np.log(_lifting(membrane, model, height, first, SMALLER))))
        except Lost as lost:
            print(lost, file=sys.stderr)
            logs.append(float(np.log(lost.further)))
    return logs


def _stiffer(membrane: Membrane, height: float, here: float) -> float:
    """What rings ten times as stiff add to a pressure in Pa."""
    if not membrane.rings:
        return 0.0
    try:
        return _lifting(membrane, STIFF, height, FIRST * here, STEP) - here
    except Lost as lost:
        print(lost, file=sys.stderr)
        return max(lost.last - here, 0.0)


def _lifting(membrane: Membrane, model: Model, height: float, first: float, step: float) -> float:
    return Lifted(membrane, model, height).lifting(WEIGHT, first, step)[0]


def _young(model: Model) -> float:
    """Young's modulus of a model's card at small strain in Pa."""
    assert isinstance(model.rubber, str)
    return float(load_card(model.rubber).material.young())


def fine(height: float, membrane: Membrane) -> float:
    """What two voxels through a membrane change of the pressure, over it: to first order."""
    first = FIRST * expected(membrane, WEIGHT)
    here, slope = Lifted(membrane, DESCRIBED, height).lifting(WEIGHT, first, STEP)
    force = Lifted(membrane, Model(refine=2), height).force(here)
    return (WEIGHT - force) / slope / here


def main() -> None:
    """Print pressures beside those measured, and what smaller voxels change if asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fine", action="store_true", help="two voxels through the membrane")
    if parser.parse_args().fine:
        for membrane in MEMBRANES[:2]:
            for height in HEIGHTS:
                change = 100 * fine(height, membrane)
                print(f"{membrane.name}, {height / mm:g} mm: two voxels change {change:+.1f} %")
        return
    off = []
    for each in predictions():
        off.append(abs(each.predicted / each.measured - 1.0))
        print(
            f"{each.name}: {each.predicted / kPa:.2f} ± {each.half_width / kPa:.2f} kPa, "
            f"measured {each.measured / kPa:.2f}"
        )
    print(f"median error {100 * np.median(off):.1f} %")


if __name__ == "__main__":
    main()
