"""The paper's three beams with one modulus each, and what it says of the paper's actuator.

A neo-Hookean beam hangs under its weight, solved with elements of 5 and 2.5 mm and extrapolated.
One Young's modulus is fitted to nine points of its lower edge; then one modulus and one scale of
the photograph, whose marks are 5 to 11 % too far apart (`examples/data/paper_beams/README.md`).
Nothing else is free. The modulus of EcoFlex 00-30 then predicts the rise of the paper's cylinder,
a body of another shape under another load.

On the scoreboard the modulus and the scale are those of the tip's mark alone, and marks between it
and the clamp are predicted; so is the cylinder.

``python examples/validation/paper_beams.py [--picture FILE]``
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BarycentricInterpolator
from scipy.optimize import minimize_scalar

import voxsoft as vs
from voxsoft.calibration import Experiment, Measurement
from voxsoft.calibration.misfit import best_scale
from voxsoft.design import families
from voxsoft.materials import load_card
from voxsoft.plot.style import BLACK, SERIES, empty_figure, plain_axes, plain_legend
from voxsoft.scoreboard import Prediction
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

Floats = NDArray[np.float64]

DATA = Path(__file__).parents[1] / "data" / "paper_beams"
NAMES = ("00-20", "00-30", "00-50")
#: Where Young's modulus is looked for.
RANGE = (15 * kPa, 300 * kPa)
#: Mean error in mm of the paper's own calibration, from its logged fitness.
PAPER = {"00-20": 9.9, "00-30": 5.7, "00-50": 3.7}
#: The paper's cylinder in mm: radius, height, wall; its pressure; what was measured and predicted.
CYLINDER = (25.0, 35.0, 15.0)
PRESSURE = 4 * kPa
MEASURED_RISE, PAPER_RISE = 2.3, 1.63
#: The marks that are predicted from the last, by their number from the clamp, and the free length.
PREDICTED, LENGTH = (3, 5, 7), 90 * mm
#: Standard deviations of the middle 90 % of a normal distribution.
NINETY = 1.645
#: EcoFlex 00-30 in three laboratories: two tensile tests and a cantilever.
CARDS = ("ecoflex-00-30-epfl", "ecoflex-00-30-tensile", "ecoflex-00-30-bending")


@dataclass(frozen=True)
class Fit:
    """A beam's modulus in Pa, the scale of its photograph, and both shapes, (9, 2), m."""

    young: float
    scale: float
    simulated: Floats
    measured: Floats

    @property
    def error(self) -> float:
        """Mean length of the error vectors in m."""
        return float(np.linalg.norm(self.scale * self.simulated - self.measured, axis=1).mean())


@cache
def _experiment(name: str, refine: int) -> tuple[Experiment, Setup]:
    beam = families.paper_beam().with_values(f"parts.0.material=ecoflex-{name}-lattice")
    experiment = Experiment(beam, Measurement.read(DATA / f"ecoflex-{name}.csv"))
    return experiment, Setup.of(beam, refine=refine)


@cache
def shape(name: str, young: float, refine: int = 1) -> Floats:
    """The nine points of a beam of some modulus as a photograph would show them, (9, 2), m."""
    experiment, setup = _experiment(name, refine)
    material = vs.NeoHookean(young=young, poisson=0.499)
    part = setup.design.parts[0].replace(material=material)
    design = setup.design.replace(parts=(part,))
    result = vs.simulate(Setup(design, setup.mesh))
    assert result.status == "ok", result.message
    # The corners of whole voxels come first or last; find them by where they are.
    rows = {tuple(row): index for index, row in enumerate(_keys(result.mesh.vertices))}
    coarse = [rows[tuple(row)] for row in _keys(experiment.setup.mesh.vertices)]
    return experiment.seen_at(result.positions[coarse])


def _keys(points: Floats) -> list[list[int]]:
    keys: list[list[int]] = np.rint(points / 1e-6).astype(int).tolist()
    return keys


def converged(name: str, young: float) -> Floats:
    """The same extrapolated from elements of 5 and 2.5 mm, (9, 2), m.

    The clamp is a singular edge, whose error falls like the size of the elements
    (`docs/method/elements.md`).
    """
    return 2.0 * shape(name, young, 2) - shape(name, young, 1)


def fit(name: str, *, free_scale: bool, extrapolate: bool = True) -> Fit:
    """Fit one modulus, or one modulus and one scale, to a beam.

    The whole range is searched with elements of 5 mm. Around what they say, extrapolated shapes at
    five moduli are enough for a polynomial in the logarithm of the modulus.
    """
    measured = _experiment(name, 1)[0].measurement.values
    coarse = _coarse(name, measured, free_scale)
    if not extrapolate:
        return coarse
    curve, bounds = _curve(name, coarse.young)
    return _best(curve, measured, free_scale, bounds)


def _coarse(name: str, measured: Floats, free_scale: bool, marks: slice = slice(None)) -> Fit:
    """The fit of some marks with elements of 5 mm."""

    def simulate(log_young: float) -> Floats:
        return shape(name, float(np.exp(log_young)))

    return _best(simulate, measured, free_scale, marks=marks)


def _curve(name: str, young: float) -> tuple[Callable[[float], Floats], tuple[float, float]]:
    """Extrapolated shapes over the logarithm of the modulus, and between which they hold."""
    low, high = np.log([0.92 * young, 1.25 * young])
    points = (low + high) / 2 + (high - low) / 2 * np.cos(np.pi * (np.arange(5) + 0.5) / 5)
    shapes = np.array([converged(name, float(np.exp(point))).ravel() for point in points])
    curve = BarycentricInterpolator(points, shapes)
    return (lambda at: curve(at).reshape(-1, 2)), (float(low), float(high))


def _best(
    simulate: Callable[[float], Floats],
    measured: Floats,
    free_scale: bool,
    bounds: tuple[float, float] = (float(np.log(RANGE[0])), float(np.log(RANGE[1]))),
    marks: slice = slice(None),
) -> Fit:
    """The fit of some marks."""

    def candidate(log_young: float) -> Fit:
        simulated = simulate(log_young)
        scale = best_scale(simulated[marks], measured[marks]) if free_scale else 1.0
        return Fit(float(np.exp(log_young)), scale, simulated, measured)

    def misfit(log_young: float) -> float:
        found = candidate(log_young)
        off = (found.scale * found.simulated - measured)[marks]
        return float(np.linalg.norm(off, axis=1).mean())

    found = minimize_scalar(misfit, bounds=bounds, method="bounded", options={"xatol": 1e-3})
    return candidate(float(found.x))


def cylinder(young: float, *, rigid_caps: bool, voxel: float = 5 * mm) -> float:
    """Rise in mm of the paper's cylinder: of the middle of its soft cap, or of a rigid one.

    A cap that is printed and bonded on moves as one: it is held in the plane of the top, here by a
    cap a thousand times as stiff as the wall, as is the one below, which stands on the table.
    """
    radius, height, wall = (size * mm for size in CYLINDER)
    soft = vs.NeoHookean(young=young, poisson=0.499)
    design = families.paper_cylinder(radius=radius, height=height, wall=wall)
    parts = [vs.Part(shape="body", material=soft)]
    shapes = dict(design.shapes)
    if rigid_caps:
        stiff = vs.NeoHookean(young=1000 * young, poisson=0.3)
        cap = vs.Box(size=(4 * radius, 4 * radius, 5 * mm))
        low = vs.Translate(of=cap, by=(-2 * radius, -2 * radius, 0))
        high = vs.Translate(of=cap, by=(-2 * radius, -2 * radius, height - 5 * mm))
        shapes["caps"] = vs.Intersection(of=("body", vs.Union(of=(low, high))))
        parts.insert(0, vs.Part(name="caps", shape="caps", material=stiff))
    changes = {
        "shapes": shapes,
        "parts": tuple(parts),
        "voxel_size": voxel,
        "loads": (vs.Pressure(value=PRESSURE),),
        "probes": {"top": vs.Probe(point=(0, 0, height))},
        "objectives": {},
    }
    result = vs.simulate(design.replace(**changes))
    assert result.status == "ok", result.message
    return float(result.probes["top"][2]) / mm


def predictions() -> list[Prediction]:
    """Marks of the three beams, from the tip's alone, and the rise of the paper's cylinder.

    Modulus and scale are those that put the last mark where it was seen; the third, the fifth and
    the seventh are predicted, in both directions, and the widths compared with the length of the
    beam. Repeatability: how well a mark was read. Neighboring marks are 10 mm apart on the beam, so
    that what their distances scatter by, over the root of two, is that, times 1.645; the first is
    left out. Material: the same of the last mark in both directions, which modulus and scale
    follow. Geometry: where the clamp is in the picture. The first mark, which is not predicted, is
    nearer to it than marks are to each other, and the whole picture may be off by the difference.
    Numerics: what the extrapolation adds to elements of 2.5 mm.

    The cylinder is that of the paper's description, with rigid caps that are bonded on. Material:
    one modulus from the beam of the same silicone, and its scatter between three laboratories, as
    nobody says that it was the same batch. Geometry, assumed: walls within 0.5 mm of 15 mm, which
    the rise follows as the ratio of the areas of cavity and wall does. Numerics: what halving the
    voxels changes. Repeatability: unknown, the mean of ten is published without its scatter.
    """
    found = [each for name in NAMES for each in _marks(name)]
    young = _from_tip("00-30").young
    rises = [cylinder(young, rigid_caps=True, voxel=size) for size in (5 * mm, 2.5 * mm)]
    logs = np.log([_young(card) for card in CARDS])
    radius, _, wall = CYLINDER
    thin, thick = (
        (radius - each) ** 2 / (radius**2 - (radius - each) ** 2)
        for each in (wall - 0.5, wall + 0.5)
    )
    rise = rises[-1] * mm
    found.append(
        Prediction(
            "paper's cylinder",
            "rise at 4 kPa, rigid caps",
            "length",
            MEASURED_RISE * mm,
            rise,
            material=NINETY * float(np.std(logs, ddof=1)) * rise,
            geometry=0.5 * float(np.log(thin / thick)) * rise,
            numerics=abs(rises[1] - rises[0]) * mm,
        )
    )
    return found


def _marks(name: str) -> list[Prediction]:
    """The marks of one beam between clamp and tip."""
    seen = _experiment(name, 1)[0].measurement.values
    apart = np.linalg.norm(np.diff(seen, axis=0), axis=1)
    read = NINETY * float(np.std(apart, ddof=1)) / np.sqrt(2.0)
    best = _from_tip(name)
    at = best.scale * best.simulated

    def moved(by: tuple[float, float]) -> Floats:
        """What changes where the tip is read elsewhere."""
        other = _from_tip(name, by)
        return other.scale * other.simulated - at

    material = np.hypot(moved((read, 0.0)), moved((0.0, read)))
    short = float(apart.mean() - np.linalg.norm(seen[0]))
    geometry = np.abs(moved((short, 0.0)) - [short, 0.0])
    numerics = np.abs(best.scale * shape(name, best.young, 2) - at)
    found = []
    for number in PREDICTED:
        for axis, way in enumerate(("from the clamp", "height")):
            place = number - 1, axis
            found.append(
                Prediction(
                    f"paper's beam, EcoFlex {name}",
                    f"mark {number}, {way}",
                    "length",
                    float(seen[place]),
                    float(at[place]),
                    material=float(material[place]),
                    geometry=float(geometry[place]),
                    numerics=float(numerics[place]),
                    repeatability=float(read),
                    scale=LENGTH,
                )
            )
    return found


def _from_tip(name: str, by: tuple[float, float] = (0.0, 0.0)) -> Fit:
    """Modulus and scale that put the last mark where it was seen, or by so many m elsewhere."""
    seen = _experiment(name, 1)[0].measurement.values + by
    last = slice(-1, None)
    curve, bounds = _extrapolated(name)
    return _best(curve, seen, True, bounds, last)


@cache
def _extrapolated(name: str) -> tuple[Callable[[float], Floats], tuple[float, float]]:
    """Shapes around the modulus that the last mark asks for with elements of 5 mm."""
    seen = _experiment(name, 1)[0].measurement.values
    return _curve(name, _coarse(name, seen, True, slice(-1, None)).young)


def _young(card: str) -> float:
    """Young's modulus of a card at small strain in Pa."""
    return float(load_card(card).material.young())


def main() -> None:
    """Print the fits and the predictions, and draw them if asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picture", type=Path, help="where to save a picture")
    options = parser.parse_args()
    fits = {}
    print("EcoFlex  modulus alone            modulus and scale              paper's calibration")
    for name in NAMES:
        alone, scaled = (fit(name, free_scale=free) for free in (False, True))
        fits[name] = alone, scaled
        print(
            f"{name}    {alone.young / kPa:6.1f} kPa {alone.error / mm:5.2f} mm      "
            f"{scaled.young / kPa:6.1f} kPa, x {scaled.scale:.3f} {scaled.error / mm:5.2f} mm      "
            f"{PAPER[name]:.1f} mm"
        )
    moduli = sorted(found.young for found in fits["00-30"])
    print(f"rise of the paper's cylinder at 4 kPa; measured {MEASURED_RISE}, paper's {PAPER_RISE}")
    for rigid in (False, True):
        for voxel in (5 * mm, 2.5 * mm):
            rises = [cylinder(young, rigid_caps=rigid, voxel=voxel) for young in moduli]
            print(
                f"  {'rigid' if rigid else 'soft'} caps, {voxel / mm:g} mm voxels: "
                f"{', '.join(f'{rise:.2f} mm' for rise in rises)} for "
                f"{', '.join(f'{young / kPa:.1f} kPa' for young in moduli)}"
            )
    if options.picture:
        draw(fits, options.picture)


def draw(fits: dict[str, tuple[Fit, Fit]], path: Path) -> None:
    """The three beams, measured and simulated."""
    figure = empty_figure(11.0, 5.0)
    for axes, name in zip(figure.subplots(1, 3), NAMES, strict=True):
        alone, scaled = fits[name]
        axes.plot(*(alone.measured / mm).T, "o", color=BLACK, markersize=4, label="measured")
        for found, color, label in (
            (alone, SERIES[0], "one modulus"),
            (scaled, SERIES[1], "one modulus, one scale"),
        ):
            words = f"{label}: {found.error / mm:.1f} mm"
            axes.plot(*(found.scale * found.simulated / mm).T, color=color, label=words)
        axes.set_xlim(0, 70)
        axes.set_ylim(-125, 3)
        plain_axes(axes, x="x (mm)", y="height (mm)", title=f"EcoFlex {name}")
        plain_legend(axes, loc="lower left")
    figure.savefig(path)


if __name__ == "__main__":
    main()
