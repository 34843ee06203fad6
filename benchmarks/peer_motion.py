"""Other codes on one motion: simulated seconds in a second, to an equal error of the tip.

``python benchmarks/peer_motion.py [--json]``. A square cantilever of 60 x 10 x 10 mm, E = 400 kPa
and 1070 kg/m³, falls from straight under its weight and swings for half a second without damping:
the tip goes down by 17 % of the length, four times. The error is the root mean square of the
distance of the tip, every 10 ms, over the largest one that it goes. The truth is that of voxels,
extrapolated over grid and step; a second pair of grids tells how far it is known. With ν = 0 all
codes have one limit. With ν = 0.45 the clamp keeps the end from growing thinner, which a rod does
not know, and linear tetrahedra are stiff.

Each code is tried in several sizes and steps. Of those within 2 % and 5 % the quickest is run
again, all in turn, on one thread; medians of the processor's time, without building the model. A
code that gets to neither is shown with its quickest setting within a tenth of its least error. The
ratio is that to VoxSoft.

- VoxSoft: `vs.Simulator`, with an observation after each step.
- PyElastica: a Cosserat rod of a square section, `PositionVerlet`, clamped in the middle of its
  first element (with the end of that element at the wall it is of first order).
- MuJoCo's flex: tetrahedra, or one quadratic cell for all (`dof="quadratic"`), with its implicit
  integrator `discrete`; `Euler` was lost with steps of 0.2 ms.

``pip install 'voxsoft[peers]'`` has both; codes that are not installed are named and left out.
SofaGym and SoMoGym are left out: neither is on PyPI. The first needs a build of SOFA, which is not
there either, nor in Debian; the package `somo` is an empty placeholder of 2020, though PyBullet,
which it would drive, installs.
"""

from __future__ import annotations

import os

# One core, so that processor time is what a user waits; read when libraries start their threads.
os.environ["RAYON_NUM_THREADS"] = "1"
os.environ["OMP_NUM_THREADS"] = "1"
os.environ["OPENBLAS_NUM_THREADS"] = "1"
os.environ["NUMBA_NUM_THREADS"] = "1"

import statistics
import sys
import time
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from typing import Any, Final, NamedTuple

import numpy as np
from measure import Report
from numpy.typing import NDArray

import voxsoft as vs

LENGTH, SIDE = 60e-3, 10e-3
YOUNG, DENSITY, GRAVITY = 400e3, 1070.0, 9.81
POISSONS: Final = (0.0, 0.45)
#: Seconds that are simulated, and those between two looks at the tip.
END, LOOK = 0.5, 10e-3
#: Errors for which the quickest setting is looked for, in percent; rounds of those.
WANTED, ROUNDS = (2.0, 5.0), 5
#: Error that counts as the least one of a code, over that.
NEAR: Final = 1.1
#: Longest run that is tried, in seconds.
LONGEST: Final = 60.0
#: Grids of the truth across, coarse and fine, and of its check; steps of 1 ms, and of half of it.
TRUTH, CHECK, FINE = (4, 8), (3, 6), 1e-3

Floats = NDArray[np.float64]


class Setting(NamedTuple):
    """A size and a step of a code: its name, and a function that makes a body to be moved."""

    name: str
    step: float
    #: From ν to a function that takes one step, and one that tells how far the tip has gone, m.
    make: Callable[[float], tuple[Callable[[], object], Callable[[], Floats]]]


def run(setting: Setting, poisson: float, longest: float = LONGEST) -> tuple[Floats, float] | None:
    """Way of the tip, (50, 3), m, and processor time, s; None for a body that is lost."""
    step, tip = setting.make(poisson)
    every = round(LOOK / setting.step)
    ways = []
    begun = time.process_time()
    for index in range(1, round(END / setting.step) + 1):
        step()
        if index % every == 0:
            ways.append(tip())
            if not np.isfinite(ways[-1]).all() or time.process_time() - begun > longest:
                return None
    return np.array(ways), time.process_time() - begun


def voxels(across: int, step: float) -> Setting:
    """VoxSoft with so many voxels across."""

    def make(poisson: float) -> tuple[Callable[[], object], Callable[[], Floats]]:
        rubber = vs.NeoHookean(young=YOUNG, poisson=poisson, density=DENSITY)
        bar = vs.Design(
            name="bar",
            voxel_size=SIDE / across,
            parts=[vs.Part(shape=vs.Box(size=(LENGTH, SIDE, SIDE)), material=rubber)],
            clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
            loads=[vs.Gravity(value=GRAVITY)],
            probes={"tip": vs.Probe(x=(LENGTH, LENGTH))},
        )
        simulator = vs.Simulator(bar, time_step=step, damping=0.0)
        return simulator.step, lambda: simulator.state.probes["tip"]

    return Setting(f"{across} across, {1e3 * step:g} ms", step, make)


def rod(count: int, step: float) -> Setting:
    """PyElastica with so many elements along."""

    def make(poisson: float) -> tuple[Callable[[], object], Callable[[], Floats]]:
        import elastica

        code: Any = elastica
        kinds = (code.BaseSystemCollection, code.Constraints, code.Forcing)
        scene: Any = type("Scene", kinds, {})()
        shear = YOUNG / (2.0 * (1.0 + poisson))
        edge = LENGTH / (count - 0.5)
        bar = code.CosseratRod.straight_rod(
            count,
            np.array([-0.5 * edge, 0.0, 0.0]),
            np.array([1.0, 0.0, 0.0]),
            np.array([0.0, 0.0, 1.0]),
            count * edge,
            SIDE / np.sqrt(np.pi),
            DENSITY,
            youngs_modulus=YOUNG,
            shear_modulus=shear,
        )
        # It has round sections; those of a square have other stiffnesses.
        bar.bend_matrix[0, 0] = bar.bend_matrix[1, 1] = YOUNG * SIDE**4 / 12.0
        bar.bend_matrix[2, 2] = 0.1406 * shear * SIDE**4
        bar.shear_matrix[0, 0] = bar.shear_matrix[1, 1] = 5.0 / 6.0 * shear * SIDE**2
        bar.shear_matrix[2, 2] = YOUNG * SIDE**2
        scene.append(bar)
        scene.constrain(bar).using(
            code.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,)
        )
        down = np.array([0.0, 0.0, -GRAVITY])
        scene.add_forcing_to(bar).using(code.GravityForces, acc_gravity=down)
        scene.finalize()
        stepper = code.PositionVerlet()
        now = [0.0]

        def advance() -> None:
            now[0] = stepper.step(scene, now[0], step)

        return advance, lambda: bar.position_collection[:, -1] - [LENGTH, 0.0, 0.0]

    return Setting(f"{count} elements, {1e3 * step:g} ms", step, make)


_FLEX: Final = """<mujoco>
<option gravity="0 0 {gravity}" timestep="{step}" integrator="discrete">
<flag contact="disable"/></option>
<size memory="200M"/>
<worldbody><flexcomp name="bar" type="grid" dim="3" count="{along} {nodes} {nodes}"
 spacing="{edge} {edge} {edge}" mass="{mass}" radius="1e-4" dof="{dof}">
<elasticity young="{young}" poisson="{poisson}" damping="0"/>
<contact selfcollide="none"/><pin gridrange="0 0 0 0 {across} {across}"/>
</flexcomp></worldbody></mujoco>"""


def flex(across: int, step: float, dof: str) -> Setting:
    """MuJoCo's flex with so many cubes across."""

    def make(poisson: float) -> tuple[Callable[[], object], Callable[[], Floats]]:
        import mujoco

        code: Any = mujoco
        # It warns at every step that its linear solver stopped early, into a file of this folder.
        code.set_mju_user_warning(lambda message: None)
        text = _FLEX.format(
            gravity=-GRAVITY,
            step=step,
            along=round(LENGTH / SIDE * across) + 1,
            nodes=across + 1,
            across=across,
            edge=SIDE / across,
            mass=DENSITY * LENGTH * SIDE**2,
            dof=dof,
            young=YOUNG,
            poisson=poisson,
        )
        model = code.MjModel.from_xml_string(text)
        data = code.MjData(model)
        code.mj_forward(model, data)
        rest = data.flexvert_xpos.copy()
        end = rest[:, 0] > rest[:, 0].max() - 1e-9

        def tip() -> Floats:
            code.mj_kinematics(model, data)
            code.mj_flex(model, data)
            way: Floats = (data.flexvert_xpos - rest)[end].mean(axis=0)
            return way

        return lambda: code.mj_step(model, data), tip

    kind = "tetrahedra" if dof == "full" else f"{dof} cell"
    return Setting(f"{kind}, {across} across, {1e3 * step:g} ms", step, make)


def _settings() -> Iterator[tuple[str, str, list[Setting]]]:
    """Yield each code: its package, its name, and its settings."""
    ours = [voxels(across, step) for across in (1, 2, 3) for step in (5e-3, 2.5e-3, 1e-3)]
    yield "voxsoft", "VoxSoft", [*ours, voxels(3, 5e-4), voxels(4, 1e-3)]
    counts = ((6, 4e-4), (6, 2e-4), (12, 2e-4), (12, 1e-4), (24, 1e-4), (24, 5e-5), (48, 5e-5))
    yield "elastica", "PyElastica", [rod(count, step) for count, step in (*counts, (96, 2e-5))]
    steps = (5e-3, 2e-3, 1e-3, 5e-4, 2e-4)
    cells = [flex(across, step, "full") for across in (2, 4) for step in steps[:3]]
    whole = [flex(1, step, "quadratic") for step in (*steps, 1e-4)]
    yield "mujoco", "MuJoCo flex", [*cells, *whole]


def truth(poisson: float, grids: tuple[int, int]) -> Floats:
    """Way of the tip, (50, 3), m: extrapolated over grid and step, both of second order."""

    def way(across: int, step: float) -> Floats:
        found = run(voxels(across, step), poisson, np.inf)
        assert found is not None
        return found[0]

    coarse, fine = grids
    ends, share = way(coarse, FINE), 1.0 / ((fine / coarse) ** 2 - 1.0)
    finer = way(fine, FINE)
    return finer + share * (finer - ends) + 4.0 / 3.0 * (way(coarse, FINE / 2) - ends)


def error(way: Floats, exact: Floats) -> float:
    """Error of a way of the tip in percent."""
    largest = np.linalg.norm(exact, axis=1).max()
    return float(100.0 * np.sqrt(((way - exact) ** 2).sum(axis=1).mean()) / largest)


class Point(NamedTuple):
    """A setting that was tried: seconds of the processor, and error in percent."""

    setting: Setting
    seconds: float
    error: float


def tried(settings: list[Setting], poisson: float, exact: Floats) -> list[Point]:
    """Run all settings once; those that are lost are left out."""
    found = []
    run(settings[0], poisson)  # it compiles
    for setting in settings:
        outcome = run(setting, poisson)
        if outcome is None:
            print(f"{setting.name}: lost", file=sys.stderr, flush=True)
            continue
        point = Point(setting, outcome[1], error(outcome[0], exact))
        words = f"{setting.name}: {point.error:.1f} %, {point.seconds:.3f} s"
        print(words, file=sys.stderr, flush=True)
        found.append(point)
    return found


def chosen(points: list[Point]) -> dict[str, Point]:
    """The quickest setting within each error, or near the least one, by how far it gets."""
    found = {}
    for wanted in WANTED:
        if good := [point for point in points if point.error <= wanted]:
            found[f"to {wanted:g} %"] = min(good, key=lambda point: point.seconds)
    if points and not found:
        least = min(point.error for point in points)
        near = [point for point in points if point.error <= NEAR * least]
        found["at best"] = min(near, key=lambda point: point.seconds)
    return found


def compare(report: Report, poisson: float) -> None:
    """Add the rows of one ν."""
    exact = truth(poisson, TRUTH)
    report.add(f"ν = {poisson:g}: truth, by other grids", error(truth(poisson, CHECK), exact), "%")
    picked: list[tuple[str, str, Point]] = []
    for package, code, settings in _settings():
        if find_spec(package) is None:
            print(f"{code} is not installed, and left out", file=sys.stderr, flush=True)
            continue
        points = tried(settings, poisson, exact)
        picked += [(code, reached, point) for reached, point in chosen(points).items()]
    times: list[list[float]] = [[] for _ in picked]
    for _ in range(ROUNDS):
        for (_, _, point), own in zip(picked, times, strict=True):
            outcome = run(point.setting, poisson)
            assert outcome is not None
            own.append(outcome[1])
    ours = {}
    for (code, reached, point), own in zip(picked, times, strict=True):
        rate = END / statistics.median(own)
        if code == "VoxSoft":
            ours[reached] = rate
        name = f"ν = {poisson:g}: {code} {reached} ({point.setting.name}; {point.error:.1f} %)"
        report.add(name, rate, "s/s", rate / ours[reached] if reached in ours else None)
        report.add(f"{name}, steps", rate / point.setting.step, "1/s")


def main() -> None:
    """Compare all codes that are installed."""
    report = Report("Simulated seconds in a second of the processor, to an equal error of the tip")
    for poisson in POISSONS:
        compare(report, poisson)
    report.show()


if __name__ == "__main__":
    main()
