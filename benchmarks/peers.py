"""Other codes on one beam: seconds to the static tip within 1 %, and the error of that tip.

``python benchmarks/peers.py [--json] [--picture]``. A cantilever of 100 x 10 x 10 mm, 10 mm of it
clamped, E = 60 kPa, ν = 0.49, 1070 kg/m³, under its weight. Each code runs in several sizes of
elements, on one core, in processor time; meshing is left out. Time counts to within 1 % of the
code's own state at rest, the error is that of that state against converged mixed bricks (Q2-Q1).
`--picture` draws both into `target/bench/peers.png`.

- VoxSoft: statics of hyperelastic voxels, with a tolerance that keeps the tip within 1 %.
- CalculiX, where the program `ccx` is: linear and quadratic bricks, processor time of its process
  with the input that `voxsoft compare` writes (a quarter of the load first, criteria a hundred
  times as strict as its own defaults), once.
- MuJoCo's flex, `pip install 'voxsoft[peers]'`: tetrahedra, run over time with damping; the
  quickest of several steps and dampings that come to rest. ν = 0.3 and 0.45, as 0.49 locks them.

Codes that are not installed are named and left out. pyPBD has no elastic modulus to give it: its
finite elements are constraints without a compliance, so that their stiffness is that of the
number of substeps (docs/method/speed.md).
"""

from __future__ import annotations

import os

os.environ["RAYON_NUM_THREADS"] = "1"

import resource
import statistics
import sys
import time
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from bodies import tip
from measure import Report

import voxsoft as vs
from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.calculix_deck import NODES_OF, Element
from voxsoft.errors import MissingPackageError, OutsideCodeError
from voxsoft.files.calculix import calculix_path, run_calculix
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

#: Displacement of the middle of the end face, in m, of converged finite elements (x, y, z).
REFERENCE = np.array([-44.0603e-3, 0.0, -72.9053e-3])
DENSITY, YOUNG, POISSON = 1070.0, 60 * kPa, 0.49
#: A tip counts as reached within this part of the code's own displacement at rest.
REACHED = 1e-2
#: No code with a right model is off by more; a larger error is a wrong model or a mechanism.
SANE = 0.6
ACROSS = (2, 4)
#: Our voxels bend right from one across, so that one and three are worth showing too.
OUR_ACROSS = (1, 2, 3, 4)
PICTURE = Path("target/bench/peers.png")
REPEATS = 5
#: Residual of statics that keeps the tip within 1 % (checked in every run).
LOOSE = 1e-3
#: Elements of CalculiX, and the wall-clock seconds that each of its runs may take.
ELEMENTS: tuple[Element, ...] = ("C3D8R", "C3D8I", "C3D20R")
PATIENCE = 60.0
#: Seconds that MuJoCo's beam is followed for, and what is tried: time steps in s, dampings in s.
FOLLOWED, STEPS, DAMPINGS = 3.0, (0.005, 0.01, 0.02), (0.02, 0.1)
#: Processor seconds after which a run of it is given up.
LONGEST = 15.0

FLEX = """<mujoco>
<option gravity="0 0 -9.81" timestep="{step}" integrator="discrete">
<flag contact="disable"/></option>
<size memory="200M"/>
<worldbody><flexcomp name="beam" type="grid" dim="3" count="{along} {nodes} {nodes}"
 spacing="{edge} {edge} {edge}" mass="{mass}" radius="1e-4">
<elasticity young="{young}" poisson="{poisson}" damping="{damping}"/>
<contact selfcollide="none"/><pin gridrange="0 0 0 {across} {across} {across}"/>
</flexcomp></worldbody></mujoco>"""


def beam(across: int) -> Setup:
    """The beam, with so many voxels across."""
    rubber = vs.NeoHookean(young=YOUNG, poisson=POISSON, density=DENSITY)
    design = vs.Design(
        name="beam",
        voxel_size=10 * mm / across,
        parts=[vs.Part(shape=vs.Box(size=(100 * mm, 10 * mm, 10 * mm)), material=rubber)],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 10 * mm)))],
        loads=[vs.Gravity()],
        probes={"tip": vs.Probe(point=(100 * mm, 5 * mm, 5 * mm))},
    )
    setup = Setup.of(design)
    _ = setup.problem, setup.places
    return setup


def error_of(moved: np.ndarray) -> float:
    """Error of a tip, of the reference's displacement."""
    return float(np.linalg.norm(moved - REFERENCE) / np.linalg.norm(REFERENCE))


def say(words: str) -> None:
    """Tell on standard error, which is not part of the figures."""
    print(words, file=sys.stderr, flush=True)


def show(report: Report, name: str, seconds: float, moved: np.ndarray) -> None:
    """Add time and error of one code, unless its answer is none."""
    error = error_of(moved)
    if not error < SANE:
        raise SystemExit(f"wrong answer: {name} is off by {error:.0%}")
    report.add(f"{name}: to the tip within 1 %", seconds * 1e3, "ms")
    report.add(f"{name}: error of the tip", error * 100, "%")


def ours(report: Report, across: int) -> None:
    """Statics, to a residual that 1 % takes."""
    setup = beam(across)
    own = tip(vs.simulate(setup, method="statics"))
    times = []
    for _ in range(REPEATS):
        start = time.process_time()
        moved = tip(vs.simulate(setup, method="statics", tolerance=LOOSE))
        times.append(time.process_time() - start)
        if not np.linalg.norm(moved - own) < REACHED * np.linalg.norm(own):
            raise SystemExit("wrong answer: a loose tolerance misses the tip by more than 1 %")
    show(report, f"VoxSoft, {across} across", statistics.median(times), own)


def calculix(report: Report, across: int, element: Element) -> None:
    """Bricks of CalculiX on the same voxels."""
    setup = beam(across)
    model = BrickModel.of(setup, split=1, nodes=NODES_OF[element])
    name = f"CalculiX {element}, {across} across"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        answer = run_calculix(model, element=element, time_limit=PATIENCE)
    except OutsideCodeError as error:
        say(f"{name}: {error}")
        return
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if answer.status != "ok":
        say(f"{name}: {answer.message}")
        return
    place = setup.places["tip"]
    moved = place.weights @ answer.displacements[place.vertices]
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    show(report, name, seconds, moved)


def flex_runs(across: int, poisson: float) -> Iterator[tuple[float, np.ndarray]]:
    """Processor seconds to the tip within 1 %, and the tip at rest, for each setting that rests."""
    import mujoco

    code: Any = mujoco
    # It warns at every step that its linear solver stopped early, into a file of this folder.
    code.set_mju_user_warning(lambda message: None)
    for step in STEPS:
        for damping in DAMPINGS:
            text = FLEX.format(
                step=step,
                along=10 * across + 1,
                nodes=across + 1,
                across=across,
                edge=10 * mm / across,
                mass=DENSITY * (100 * mm) * (10 * mm) ** 2,
                young=YOUNG,
                poisson=poisson,
                damping=damping,
            )
            model = code.MjModel.from_xml_string(text)
            data = code.MjData(model)
            code.mj_forward(model, data)
            rest = data.flexvert_xpos.copy()
            end = np.abs(rest[:, 0] - rest[:, 0].max()) < 1e-9
            moved, times = [], []
            start = time.process_time()
            while data.time < FOLLOWED and time.process_time() - start < LONGEST:
                code.mj_step(model, data)
                moved.append((data.flexvert_xpos - rest)[end].mean(axis=0))
                times.append(time.process_time() - start)
            if data.time < FOLLOWED:
                continue
            path = np.array(moved)
            away = np.linalg.norm(path - path[-1], axis=1) / np.linalg.norm(path[-1])
            if not np.isfinite(away).all() or away[len(away) // 2 :].max() > REACHED:
                continue  # It still swings, or has blown up.
            first = int(np.flatnonzero(away > REACHED)[-1]) + 1  # It starts away from its end.
            yield times[first], path[-1]


def flex(report: Report, across: int) -> None:
    """Tetrahedra of MuJoCo."""
    for poisson in (0.3, 0.45):
        runs = list(flex_runs(across, poisson))
        if not runs:
            say(f"MuJoCo flex, {across} across, ν = {poisson}: no setting came to rest")
            continue
        seconds, moved = min(runs, key=lambda run: run[0])
        show(report, f"MuJoCo flex, {across} across, ν = {poisson}", seconds, moved)


def draw(report: Report) -> None:
    """Error over time of all codes, a line for each kind of element."""
    from voxsoft.plot.style import (
        BLACK,
        GRAY,
        SERIES,
        empty_figure,
        plain_axes,
        plain_legend,
        plain_log_axis,
    )

    series: dict[str, list[tuple[float, float, str]]] = {}
    for time_row, error_row in zip(report.rows[::2], report.rows[1::2], strict=True):
        code, across, *poisson = time_row["name"].split(":")[0].split(", ")
        name = ", ".join([code, *poisson])
        series.setdefault(name, []).append((time_row["value"], error_row["value"], across))
    figure = empty_figure(8.0, 4.4)
    axes = figure.subplots()
    plain_axes(axes, x="processor time (ms)", y="error of the tip (%)")
    axes.set(xscale="log", yscale="log")
    plain_log_axis(axes.yaxis)
    axes.axhline(2.0, color=GRAY, linewidth=0.8, linestyle=":")
    axes.axvline(20.0, color=GRAY, linewidth=0.8, linestyle=":")
    for index, (name, points) in enumerate(series.items()):
        is_ours = name == "VoxSoft"
        color = BLACK if is_ours else SERIES[index % len(SERIES)]
        times, errors, across = zip(*points, strict=True)
        axes.plot(
            times,
            errors,
            color=color,
            marker="s" if is_ours else "o",
            linewidth=1.8 if is_ours else 1.0,
            label=name,
        )
        for x, y, word in zip(times, errors, across, strict=True):
            axes.annotate(
                word.split()[0], (x, y), (4, 4), textcoords="offset points", color=color, size=8
            )
    plain_legend(axes, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(PICTURE)


def main() -> None:
    """Run all that is there."""
    report = Report("Other codes on one beam", picture="draw error over time")
    for across in OUR_ACROSS:
        ours(report, across)
    try:
        calculix_path()
    except MissingPackageError as error:
        say(f"left out: {error}")
    else:
        for element in ELEMENTS:
            for across in ACROSS:
                calculix(report, across, element)
    if find_spec("mujoco") is None:
        say("left out: MuJoCo is not installed; pip install 'voxsoft[peers]'")
    else:
        for across in ACROSS:
            flex(report, across)
    if report.options["picture"]:
        draw(report)
    report.show()


if __name__ == "__main__":
    main()
