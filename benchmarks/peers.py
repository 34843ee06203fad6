"""Other codes on three bodies: seconds to within 1 % of rest, and the error of that state.

``python benchmarks/peers.py [--json] [--picture] [--reference]``. A beam under its weight, a bar
that is twisted by 90 degrees and a thick sphere under pressure (`peer_bodies.py`), in several sizes
of elements, on one core, in processor time; meshing is left out. Time counts to within 1 % of the
code's own state at rest, the error is that of that state against the truth. The last rows give the
least time of each code to an error of 2 % and 5 %. `--picture` draws errors over times into
`target/bench/peers.png`; `--reference` makes the truth of the bar instead.

- VoxSoft: statics of hyperelastic voxels, with a tolerance that keeps the number within 1 %.
- CalculiX, where the program `ccx` is: linear and quadratic bricks, processor time of its process
  with the input that `voxsoft compare` writes (a quarter of the load first, criteria a hundred
  times as strict as its own defaults), once.
- scikit-fem: mixed bricks with its own assembly (`peer_scikit_fem.py`).
- MuJoCo's flex, Newton and Drake: linear tetrahedra that move until they rest
  (`peer_tetrahedra.py`).

``pip install 'voxsoft[peers]'`` has those of them that pip has. Codes that are not installed are
named and left out. pyPBD has no elastic modulus to give it: its finite elements are constraints
without a compliance, so that their stiffness is that of the number of substeps
(docs/method/speed.md).
"""

from __future__ import annotations

import os

# One core, so that processor time is what a user waits; read when libraries start their threads.
os.environ["RAYON_NUM_THREADS"] = "1"
os.environ["OMP_NUM_THREADS"] = "1"
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from measure import Report
from peer_bodies import BAR, BEAM, SPHERE, Body
from peer_bricks import ELEMENTS, calculix, scikit_fem, voxsoft
from peer_tetrahedra import CODES, LONGEST, POISSONS, Run

from voxsoft.comparison import discretization_error
from voxsoft.errors import MissingPackageError, OutsideCodeError
from voxsoft.files.calculix import calculix_path

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: No code with a right model is off by more; a larger error is a wrong model or a mechanism.
SANE = 0.6
#: Errors for which the least time is looked for.
WANTED = (2.0, 5.0)
PICTURE = Path("target/bench/peers.png")
#: Elements across a bar or through a wall, by body: of VoxSoft, CalculiX, scikit-fem, tetrahedra.
OUR_SIZES = {BEAM: (1, 2, 3, 4), BAR: (1, 2, 4, 8), SPHERE: (2, 4, 8)}
CALCULIX_SIZES = {BEAM: (2, 4), BAR: (2, 4), SPHERE: (2, 4)}
SCIKIT_FEM_SIZES = {BEAM: (1, 2), BAR: (1, 2, 3), SPHERE: (1, 2)}
TETRAHEDRA = (2, 4)
#: Sizes of scikit-fem from which the truth of the bar is extrapolated.
REFERENCE = (2, 3, 4, 5)


@dataclass(frozen=True)
class Point:
    """A code on a body in one size: elements across, milliseconds, and error in percent."""

    body: Body
    code: str
    across: int
    milliseconds: float
    error: float


def say(words: str) -> None:
    """Tell on standard error, which is not part of the figures."""
    print(words, file=sys.stderr, flush=True)


class Points:
    """The points of all codes, as they come."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self.all: list[Point] = []

    def add(self, body: Body, code: str, across: int, seconds: float, number: np.ndarray) -> None:
        """Add a code on a body, unless its answer is none."""
        error = body.error(number)
        name = f"{body.name}, {code}, {across} across"
        if not error < SANE:
            say(f"{name}: the {body.number} is off by {error:.0%}, and is left out")
            return
        self.all.append(Point(body, code, across, seconds * 1e3, error * 100))
        self._report.add(f"{name}: to within 1 % of rest", seconds * 1e3, "ms")
        self._report.add(f"{name}: error of the {body.number}", error * 100, "%")

    def summarize(self) -> None:
        """Add the least times to the errors that are wanted."""
        for body in (BEAM, BAR, SPHERE):
            for wanted in WANTED:
                for code in dict.fromkeys(each.code for each in self.all if each.body is body):
                    times = [
                        each.milliseconds
                        for each in self.all
                        if each.body is body and each.code == code and each.error <= wanted
                    ]
                    least = min(times, default=float("nan"))
                    self._report.add(f"{body.name}, {code}: time to {wanted:g} %", least, "ms")


def attempt(
    points: Points,
    body: Body,
    code: str,
    across: int,
    solve: Callable[[], tuple[float, np.ndarray]],
) -> None:
    """Add a point, or say why there is none."""
    try:
        seconds, number = solve()
    except OutsideCodeError as error:
        say(f"{body.name}, {code}, {across} across: {error}")
        return
    points.add(body, code, across, seconds, number)


def bricks(points: Points, body: Body) -> None:
    """VoxSoft, CalculiX and scikit-fem."""
    for across in OUR_SIZES[body]:
        attempt(points, body, "VoxSoft", across, lambda n=across: voxsoft(body.name, n))
    try:
        calculix_path()
    except MissingPackageError as error:
        say(f"left out: {error}")
    else:
        for element in ELEMENTS:
            for across in CALCULIX_SIZES[body]:
                attempt(
                    points,
                    body,
                    f"CalculiX {element}",
                    across,
                    lambda n=across, e=element: calculix(body.name, n, e),
                )
    if find_spec("skfem") is None:
        say("left out: scikit-fem is not installed; pip install 'voxsoft[peers]'")
        return
    for across in SCIKIT_FEM_SIZES[body]:
        attempt(points, body, "scikit-fem Q2-Q1", across, lambda n=across: scikit_fem(body.name, n))


def tetrahedra(points: Points, body: Body) -> None:
    """The codes for robots."""
    for package, (code, bodies) in CODES.items():
        if body.name not in bodies:
            continue
        if find_spec(package) is None:
            say(f"left out: {code} is not installed; pip install 'voxsoft[peers]'")
            continue
        for poisson in POISSONS:
            for across in TETRAHEDRA:
                name = f"{code}, ν = {poisson}"
                runs = [run for run in bodies[body.name](across, poisson) if run is not None]
                if not runs:
                    say(f"{body.name}, {name}, {across} across: no rest within {LONGEST:g} s")
                    continue
                best: Run = min(runs, key=lambda run: run.seconds)
                points.add(body, name, across, best.seconds, best.number)


def draw(points: list[Point]) -> None:
    """Error over time of all codes, a plot for each body, a line for each kind of element."""
    from voxsoft.plot.style import BLACK, GRAY, SERIES, empty_figure, plain_axes, plain_log_axis

    figure = empty_figure(11.0, 4.6)
    plots: list[Axes] = list(figure.subplots(1, 3))
    codes = [code for code in dict.fromkeys(each.code for each in points) if code != "VoxSoft"]
    colors = {code: SERIES[index % len(SERIES)] for index, code in enumerate(codes)}
    marks = {code: "ovD^"[index // len(SERIES)] for index, code in enumerate(codes)}
    lines = {}
    for axes, body in zip(plots, (BEAM, BAR, SPHERE), strict=True):
        plain_axes(axes, x="processor time (ms)", y=f"error of the {body.number} (%)")
        axes.set(xscale="log", yscale="log", title=body.name)
        plain_log_axis(axes.yaxis)
        for wanted in WANTED:
            axes.axhline(wanted, color=GRAY, linewidth=0.8, linestyle=":")
        for code in ["VoxSoft", *codes]:
            own = [each for each in points if each.body is body and each.code == code]
            if not own:
                continue
            is_ours = code == "VoxSoft"
            color = BLACK if is_ours else colors[code]
            (line,) = axes.plot(
                [each.milliseconds for each in own],
                [each.error for each in own],
                color=color,
                marker="s" if is_ours else marks[code],
                linewidth=1.8 if is_ours else 1.0,
            )
            lines[code] = line
            for each in own:
                place = (each.milliseconds, each.error)
                axes.annotate(
                    str(each.across), place, (4, 4), textcoords="offset points", color=color, size=7
                )
    figure.legend(
        lines.values(), lines.keys(), loc="outside lower center", ncols=4, frameon=False, fontsize=8
    )
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(PICTURE)


def make_reference() -> None:
    """Print the torque of the bar, extrapolated from sizes of scikit-fem, and ours beside it."""
    values = []
    for across in REFERENCE:
        values.append(float(scikit_fem(BAR.name, across)[1][0]))
        say(f"scikit-fem, {across} across: {values[-1]:.8g} N·m")
    limit = discretization_error([1 / across for across in REFERENCE], values).limit
    print(f"scikit-fem, {REFERENCE} across: {values}; their limit {limit:.8g} N·m")
    sizes = OUR_SIZES[BAR]
    own = [float(voxsoft(BAR.name, across)[1][0]) for across in sizes]
    limit = discretization_error([1 / across for across in sizes], own).limit
    print(f"VoxSoft, {sizes} across: {own}; their limit {limit:.8g} N·m")


def main() -> None:
    """Run all that is there."""
    report = Report(
        "Other codes on three bodies",
        picture="draw errors over times",
        reference="make the truth of the twisted bar",
    )
    if report.options["reference"]:
        make_reference()
        return
    points = Points(report)
    for body in (BEAM, BAR, SPHERE):
        bricks(points, body)
        tetrahedra(points, body)
    points.summarize()
    if report.options["picture"]:
        draw(points.all)
    report.show()


if __name__ == "__main__":
    main()
