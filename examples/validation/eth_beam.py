"""A beam of Dragon Skin 10: fit one modulus to self weight, predict a weight and the swinging.

Young's modulus is fitted to the sag under self weight alone. With it the sag under 52 g on the
tip's upper edge is predicted, and the frequency of the swinging about both states: the lowest mode
of the tangent there. Measured: SRL, ETH Zürich (`examples/data/eth_beam/README.md`).

``python examples/validation/eth_beam.py [--fine] [--picture FILE]``; `--fine` takes elements of
2.5 mm.
"""

from __future__ import annotations

import argparse
import csv
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import curve_fit

import voxsoft as vs
from voxsoft import _core
from voxsoft.plot.style import SERIES, empty_figure, plain_axes, plain_legend
from voxsoft.scoreboard import Prediction
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

Floats = NDArray[np.float64]

DESIGN = Path(__file__).parent / "eth_beam.toml"
DATA = Path(__file__).parents[1] / "data" / "eth_beam"
#: A tensile test of the same silicone in another laboratory, and the strains that are read of it:
#: up to three times the largest of the beam, as single points scatter by 1 kPa.
COUPON, READ = Path(__file__).parents[1] / "data" / "tensile" / "dragon-skin-10.csv", 0.25
MASSES = {"gravity": 0.0, "load52": 0.05202}
GRAVITY = 9.81
#: Where the search for the modulus starts.
START = 250 * kPa
MARKERS = ("Tip1_top", "Tip2_left", "Tip3_right")
#: Frequency and decay are read between these times after release: before, the support still
#: touches; after, what is left is small.
WINDOW = (0.3, 1.5)


@dataclass(frozen=True)
class Swing:
    """A decaying oscillation: frequency in Hz, decay rate in 1/s."""

    frequency: float
    decay: float


@cache
def measured(case: str) -> Floats:
    """Where the tip's markers are before release and how far they move: (2 runs, 3, 2, 3), m."""
    with (DATA / "static.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["case"] == case]
    found = {(row["run"], row["marker"]): row for row in rows}
    return np.array(
        [
            [
                [[float(found[run, m][f"{k}{a}_m"]) for a in "xyz"] for k in ("rest_", "d")]
                for m in MARKERS
            ]
            for run in "ab"
        ]
    )


def sag(moved: Floats) -> float:
    """Mean sag of the three markers in m, (..., 3, 3) → number."""
    return -float(moved[..., 2].mean())


def swings(case: str) -> list[Swing]:
    """Frequency and decay of the upper marker, one for each run: a decaying cosine, fitted."""
    return [oscillation(*trace(case, run)) for run in "ab"]


def trace(case: str, run: str) -> tuple[Floats, Floats]:
    """Times in s after release and heights of the upper marker in mm."""
    with (DATA / "timeseries.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if (row["case"], row["run"]) == (case, run)]
    time, height = np.array([[float(row["t_s"]), float(row["tip1_z_m"]) / mm] for row in rows]).T
    return time, height


def oscillation(time: Floats, height: Floats) -> Swing:
    """Frequency and decay of a height in mm over time in s, at steps of 0.01 s."""
    inside = (time >= WINDOW[0]) & (time <= WINDOW[1])
    time, height = time[inside], height[inside] - height[inside].mean()

    def cosine(t: Floats, a: float, b: float, rate: float, omega: float, middle: float) -> Floats:
        fade = np.exp(-rate * (t - WINDOW[0]))
        shape: Floats = fade * (a * np.cos(omega * t) + b * np.sin(omega * t)) + middle
        return shape

    # The largest line of the spectrum, padded to 0.05 Hz, is near enough to start from.
    spectrum = np.abs(np.fft.rfft(height, 2000))
    start = 2 * np.pi * np.fft.rfftfreq(2000, 0.01)[int(np.argmax(spectrum))]
    best = curve_fit(cosine, time, height, p0=(3.0, 3.0, 2.0, start, 0.0))[0]
    return Swing(float(best[3]) / (2 * np.pi), float(best[2]))


def setup(case: str, refine: int) -> Setup:
    """The beam with or without its weight."""
    return Setup.of(vs.load(DESIGN, weight=MASSES[case] * GRAVITY), refine=refine)


def solve(beam: Setup, young: float) -> vs.Result:
    """The beam at rest with one modulus."""
    part = beam.design.parts[0].replace(material=vs.NeoHookean(young=young, poisson=0.499))
    changed = Setup(beam.design.replace(parts=(part,)), beam.mesh)
    result = vs.simulate(changed)
    assert result.status == "ok", result.message
    return result


def markers(result: vs.Result, case: str) -> Floats:
    """Displacements of the markers in m, (2 runs, 3, 3).

    A stem stands on the nearest point of the surface and turns with the body around it: with the
    best rotation of the vertices within 8 mm (Kabsch 1976).
    """
    rest, now = result.mesh.vertices, result.positions
    places = measured(case)[:, :, 0]
    moved = np.empty_like(places)
    for index in np.ndindex(2, 3):
        marker = places[index]
        foot = np.clip(marker, [-0.1, 0, 0], [0, 30 * mm, 30 * mm])
        near = np.linalg.norm(rest - foot, axis=1) < 8 * mm
        before, after = rest[near], now[near]
        u, _, v = np.linalg.svd((before - before.mean(0)).T @ (after - after.mean(0)))
        turn = (u @ np.diag([1, 1, np.sign(np.linalg.det(u @ v))]) @ v).T
        moved[index] = after.mean(0) + turn @ (marker - before.mean(0)) - marker
    return moved


def fit(refine: int) -> float:
    """Young's modulus in Pa at which the markers sag under self weight as measured."""
    beam, target = setup("gravity", refine), sag(measured("gravity")[:, :, 1])
    young, ratio = START, 0.0
    while abs(ratio - 1.0) > 1e-4:  # sag is nearly proportional to 1/E: two or three rounds
        ratio = sag(markers(solve(beam, young), "gravity")) / target
        young *= ratio
    return young


def frequency(beam: Setup, result: vs.Result, mass: float) -> float:
    """Lowest frequency in Hz at which the beam swings up and down about its state at rest.

    Inverse iteration with the tangent there, from the direction of gravity. The body and its loads
    are symmetric, so sideways modes do not mix in. The weight swings along on the edge.
    """
    problem = Setup(beam.design.replace(parts=result.design.parts), beam.mesh).problem
    rest = result.mesh.vertices
    masses = problem.masses.copy()
    edge = (rest[:, 0] > -1e-6) & (rest[:, 2] > 30 * mm - 1e-6)
    masses[edge] += mass / max(int(edge.sum()), 1)
    shape = np.zeros_like(rest)
    shape[:, 2] = 1.0
    squares = [0.0]
    while True:
        pulled = masses[:, None] * shape
        bent = _core.adjoint(problem, result.positions, pulled[None])[0]
        # Rayleigh's quotient of the bent shape, whose elastic force is the pull.
        squares.append(float((bent * pulled).sum() / (masses[:, None] * bent**2).sum()))
        if abs(squares[-1] / squares[-2] - 1 if squares[-2] else 1) < 1e-6:
            return float(np.sqrt(squares[-1]) / (2 * np.pi))
        shape = bent / np.abs(bent).max()


@dataclass(frozen=True)
class Outcome:
    """The fitted modulus in Pa; sags in m and swings, predicted and measured, by case."""

    young: float
    sags: dict[str, tuple[float, float]]
    frequencies: dict[str, tuple[float, list[Swing]]]
    shapes: dict[str, Floats]


def outcome(refine: int = 1) -> Outcome:
    """Fit on self weight and predict everything else."""
    young = fit(refine)
    sags, frequencies, shapes = {}, {}, {}
    for case, mass in MASSES.items():
        beam = setup(case, refine)
        result = solve(beam, young)
        shapes[case] = markers(result, case)
        sags[case] = sag(shapes[case]), sag(measured(case)[:, :, 1])
        frequencies[case] = frequency(beam, result, mass), swings(case)
    return Outcome(young, sags, frequencies, shapes)


def softening() -> float:
    """By which part the coupon's modulus falls for a strain of 1, from its start on.

    Its stress over the stretch l is read as G (l − 1/l²) (1 − a (l − 1)) and a constant, as the
    load cell's zero is off; a neo-Hookean material has a = 0.
    """
    with COUPON.open() as file:
        rows = [
            (float(row["eng_strain"]), float(row["eng_stress_Pa"])) for row in csv.DictReader(file)
        ]
    strain, stress = np.array([row for row in rows if row[0] <= READ]).T
    pull = (1.0 + strain) - (1.0 + strain) ** -2
    columns = np.column_stack((np.ones_like(pull), pull, -pull * strain))
    _, shear, falling = np.linalg.lstsq(columns, stress)[0]
    return float(falling / shear)


def strains(sags: dict[str, float]) -> dict[str, float]:
    """The strain that stands for each state of a beam which softens by it, from its sag in m.

    The beam theory of Euler and Bernoulli: its own weight, whose sag is known, bends it like
    (1 − s)², a weight at the end like 1 − s, where s goes from the clamp to the tip. The modulus
    counts where the energy is, so that it is the mean of the strain, weighted by its square.
    """
    length, half = 100 * mm, 15 * mm
    s = (np.arange(1000) + 0.5) / 1000
    alone = 4.0 * sags["gravity"] / length**2 * (1.0 - s) ** 2
    found = {}
    for case, sagged in sags.items():
        bent = alone + 3.0 * (sagged - sags["gravity"]) / length**2 * (1.0 - s)
        # Across the height the strain is linear: the mean of its cube is 1/4, of its square 1/3.
        found[case] = 0.75 * half * float((bent**3).mean() / (bent**2).mean())
    return found


def predictions() -> list[Prediction]:
    """The sag under 52 g and the frequencies of the swinging about both states.

    Material, three things. The modulus follows the sag under self weight, which repeats within
    0.1 mm, as do the two runs. It is taken to be the same at all strains: a coupon of the same
    silicone, not of the same batch, says by how much it falls from the state that it is fitted to
    (secant) to that under 52 g (secant) and to the swinging about both (tangent). And it is that of
    rest, where the swinging has some Hz: a material whose motion loses a part of its energy is
    stiffer than at rest by as large a part, if one relaxation near that frequency loses it. The
    loss is that of the measured decay. Geometry, assumed: half a millimeter of where the weight
    sits on the edge, and a tenth of the stems' mass, which nobody weighed: 2 %. Numerics: elements
    of 2.5 mm instead of 5 mm. Repeatability: 0.2 mm with the weight, and the two runs of each
    swinging.
    """
    coarse, fine = outcome(1), outcome(2)
    alone = coarse.sags["gravity"][1]
    share = 0.1 * mm / alone
    falls, at = softening(), strains({case: sags[0] for case, sags in coarse.sags.items()})
    here, there = coarse.sags["load52"]
    found = [
        Prediction(
            "ETH beam",
            "sag under 52 g",
            "length",
            there,
            here,
            material=here * float(np.hypot(share, falls * (at["load52"] - at["gravity"]))),
            geometry=0.02 * here,
            numerics=abs(fine.sags["load52"][0] - here),
            repeatability=0.2 * mm,
        )
    ]
    for case, words in (("gravity", "alone"), ("load52", "with 52 g")):
        predicted, seen = coarse.frequencies[case]
        runs = [swing.frequency for swing in seen]
        loss = float(np.mean([swing.decay / (np.pi * swing.frequency) for swing in seen]))
        # Stress E e (1 − a e): the secant falls by a e, the tangent by 2 a e.
        softer = falls * (2.0 * at[case] - at["gravity"])
        found.append(
            Prediction(
                "ETH beam",
                f"frequency {words}",
                "rate",
                float(np.mean(runs)),
                predicted,
                material=0.5 * predicted * float(np.linalg.norm([share, softer, loss])),
                geometry=0.02 * predicted,
                numerics=abs(fine.frequencies[case][0] - predicted),
                repeatability=float(np.ptp(runs)),
            )
        )
    return found


def main() -> None:
    """Print the comparison, and draw it if asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fine", action="store_true", help="elements of 2.5 mm instead of 5 mm")
    parser.add_argument("--picture", type=Path, help="where to save a picture")
    options = parser.parse_args()
    found = outcome(2 if options.fine else 1)
    print(f"Young's modulus from self weight: {found.young / kPa:.1f} kPa")
    for case in MASSES:
        here, there = (1e3 * value for value in found.sags[case])
        simulated, seen = found.frequencies[case]
        print(
            f"{case}: sag {here:.2f} mm, measured {there:.2f} ({100 * (here / there - 1):+.1f} %)"
        )
        real = float(np.mean([swing.frequency for swing in seen]))
        print(
            f"  frequency {simulated:.2f} Hz, measured "
            f"{', '.join(f'{swing.frequency:.2f}' for swing in seen)} "
            f"({100 * (simulated / real - 1):+.1f} %)"
        )
        ratio = [swing.decay / (np.pi * swing.frequency) for swing in seen]
        print(
            f"  decay {', '.join(f'{swing.decay:.2f}' for swing in seen)} 1/s, that is a loss "
            f"factor of {', '.join(f'{value:.3f}' for value in ratio)}"
        )
    if options.picture:
        draw(found, options.picture)


def draw(found: Outcome, path: Path) -> None:
    """Sag of each marker, predicted and measured, and the recorded swinging."""
    figure = empty_figure(11.0, 4.2)
    left, right = figure.subplots(1, 2)
    ticks = []
    for row, case in enumerate(MASSES):
        title = "self weight (fitted)" if case == "gravity" else "with 52 g (predicted)"
        ticks.append(title)
        real = -measured(case)[:, :, 1, 2] / mm
        here = -found.shapes[case][:, :, 2].mean(axis=0) / mm
        at = row + np.linspace(-0.2, 0.2, 3)
        left.bar(at, here, width=0.17, color=SERIES[0], label=None if row else "simulated")
        for run in real:
            left.plot(at, run, "o", color=SERIES[1], markersize=5)
        left.plot([], [], "o", color=SERIES[1], label=None if row else "measured, two runs")
    plain_axes(left, x="", y="sag of the markers (mm): top, left, right", title="at rest")
    left.set_xticks(range(2), ticks)
    plain_legend(left, loc="upper left")
    for color, case in zip(SERIES, MASSES, strict=False):
        time, height = trace(case, "a")
        seen = [swing.frequency for swing in found.frequencies[case][1]]
        words = f"{found.frequencies[case][0]:.2f} Hz predicted, {np.mean(seen):.2f} Hz measured"
        right.plot(time, height - height[-1], color=color, label=words, linewidth=1.2)
    right.set_xlim(-0.05, 2.0)
    plain_axes(right, x="time after release (s)", y="height of the tip (mm)", title="released")
    plain_legend(right)
    figure.savefig(path)


if __name__ == "__main__":
    main()
