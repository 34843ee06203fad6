"""A tentacle pulled by a tendon: its modulus from two of eight cases, the other six predicted.

Measured are four markers on stems, for four tensions of each of two tendons. One number, Young's
modulus, is fitted to two cases of the first tendon (least squares over all their markers); density
and Poisson's ratio are those of silicones, and the tendons slide without friction. Measured:
soromox, TU Delft (`examples/data/tentacle/README.md`).

``python examples/validation/tentacle.py [--voxel MM] [--picture FILE]``: 4 mm, which takes a
minute or two.
"""

from __future__ import annotations

import argparse
import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

import voxsoft as vs
from voxsoft.geometry import mean_displacement, mean_rotation_vector
from voxsoft.plot.style import SERIES, empty_figure, plain_axes, plain_legend
from voxsoft.units import kPa, mm

Floats = NDArray[np.float64]

DESIGN = Path(__file__).parent / "tentacle.toml"
DATA = Path(__file__).parents[1] / "data" / "tentacle" / "markers.csv"
#: The probes whose sections carry the markers, and where the markers are from their middles [m].
STEMS = {
    "m1": (25 * mm, 0, 0),
    "m2": (-21 * mm, 0, 0),
    "m3": (20 * mm, 0, 0),
    "end": (0, 0, -8 * mm - 2.5 * mm),  # the middle of the last section is 2.5 mm before the tip
}
#: Tensions [N] of the cases that the modulus is fitted to, of the first tendon.
FITTED = (3.077, 6.154)
#: Values of the path to the largest tension: Newton's method needs no more.
STEPS = 10


@dataclass(frozen=True)
class Case:
    """One measured state: which tendon pulls how hard [N], and where markers are [m], (4, 3)."""

    motor: int
    tension: float
    markers: Floats


def measured() -> list[Case]:
    """The eight cases."""
    with DATA.open() as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return [
            Case(
                int(row["motor"]),
                float(row["tension_N"]),
                np.array([[float(row[f"p{i}{a}"]) for a in "xyz"] for i in range(1, 5)]) * mm,
            )
            for row in rows
        ]


def markers(result: vs.Result) -> Floats:
    """Where the markers are, which move rigidly with their sections, (4, 3), m."""
    rest, positions = result.mesh.vertices, result.positions
    found = []
    for name, stem in STEMS.items():
        place = result.places[name]
        middle = place.weights @ rest[place.vertices]
        moved = mean_displacement(rest, positions, place.vertices, place.weights)
        turn = mean_rotation_vector(rest, positions, place.vertices)
        found.append(middle + moved + rotated(np.array(stem), turn))
    return np.array(found)


def rotated(vector: Floats, turn: Floats) -> Floats:
    """A vector turned by a rotation vector (Rodrigues)."""
    angle = float(np.linalg.norm(turn))
    if angle == 0.0:
        return vector
    axis = turn / angle
    along = axis * (axis @ vector)
    return along + np.cos(angle) * (vector - along) + np.sin(angle) * np.cross(axis, vector)


def predicted(young: float, motor: int, tensions: list[float], voxel: float = 4 * mm) -> Floats:
    """The markers at each tension of one tendon, (tensions, 4, 3), m."""
    design = vs.load(DESIGN, young=young, tension1="0 N", tension2="0 N")
    path = np.linspace(0.0, max(tensions), STEPS + 1)
    values = sorted({*map(float, path), *tensions})
    run = vs.follow(design.replace(voxel_size=voxel), f"tension{motor}", values)
    if run.status != "ok":
        raise SystemExit(f"the path was lost: {run.message}")
    at = dict(zip(values, run.results, strict=True))
    return np.array([markers(at[tension]) for tension in tensions])


def fitted(cases: list[Case], voxel: float) -> float:
    """Young's modulus [Pa] that fits some cases of the first tendon best."""
    tensions = [case.tension for case in cases]
    seen = np.array([case.markers for case in cases])

    def misfit(log: Floats) -> Floats:
        found = predicted(float(np.exp(log[0])), 1, tensions, voxel)
        return (found - seen).ravel() / mm

    return float(np.exp(least_squares(misfit, [np.log(300 * kPa)], diff_step=0.01, xtol=1e-3).x[0]))


def main() -> None:
    """Fit, predict, print and draw."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--voxel", type=float, default=4.0, help="in mm")
    parser.add_argument("--picture", type=Path)
    options = parser.parse_args()
    voxel, cases = options.voxel * mm, measured()
    young = fitted([c for c in cases if c.motor == 1 and c.tension in FITTED], voxel)
    print(f"fitted: E = {young / kPa:.0f} kPa, voxels of {voxel / mm:g} mm")
    errors, shown = [], []
    for motor in (1, 2):
        own = [case for case in cases if case.motor == motor]
        found = predicted(young, motor, [case.tension for case in own], voxel)
        for case, place in zip(own, found, strict=True):
            off = np.linalg.norm(place - case.markers, axis=1)
            known = motor == 1 and case.tension in FITTED
            words = "fitted   " if known else "predicted"
            each = ", ".join(f"{value / mm:5.1f}" for value in off)
            print(f"tendon {motor}, {case.tension:.3f} N, {words}: markers off by {each} mm")
            if not known:
                errors.append(off)
            shown.append((case, place, known))
    root = np.sqrt(np.mean(np.square(errors), axis=0)) / mm
    print("predicted, root of the mean square by marker: " + ", ".join(f"{v:.1f}" for v in root))
    if options.picture:
        draw(shown, options.picture)


def draw(shown: list[tuple[Case, Floats, bool]], target: Path) -> None:
    """The markers in the plane in which the tentacle bends, for each case."""
    figure = empty_figure(9.0, 4.5)
    panels = figure.subplots(1, 2, sharey=True)
    for case, place, known in shown:
        axes, color = panels[case.motor - 1], SERIES[round(case.tension / 1.5385) - 2]
        aside = np.array([0.5, np.sqrt(0.75) * (1 if case.motor == 1 else -1), 0])
        label = f"{case.tension:.1f} N{', fitted' if known else ''}"
        axes.plot(place @ aside / mm, place[:, 2] / mm, "-", color=color, label=label)
        axes.plot(case.markers @ aside / mm, case.markers[:, 2] / mm, "o", color=color)
    for number, axes in enumerate(panels, start=1):
        plain_axes(axes, x="toward the tendon (mm)", y="z (mm)", title=f"tendon {number}")
        axes.set_aspect("equal")
        plain_legend(axes)
    figure.savefig(target)


if __name__ == "__main__":
    main()
