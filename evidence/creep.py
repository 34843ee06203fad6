"""Rubber with Prony branches along a path over time, beside closed forms and FElupe.

``python evidence/creep.py [--json] [--day]``. All but two cases are small strains of a standard
linear solid, one branch with g = 0.3 and τ = 100 s, shear modulus μ (1 + γ e^(-t/τ)),
γ = g/(1 - g), and a constant bulk modulus. The others are of finite strain and two branches: a bar
that is pulled by half of its length, and a balloon whose pressure rises, stays and falls. Each row
is a part of the long-term value, which is an equilibrium of its own and closed in form too, so that
it shows the creep and not the voxels; the last column has the error of that equilibrium.

- **bar, step load** and **load history**: elongation, with the compliance
  (1 - g e^(-(1 - g) t/τ))/3 μ + 1/9 K and its integral along the history;
- **bar, held**: force, with Young's modulus, which relaxes with the time
  τ (3 K + μ/(1 - g))/(3 K + μ);
- **rod, twisted**: torque of a square bar that warps freely, Saint-Venant's times 1 + γ e^(-t/τ);
- **balloon**: growth of the cavity of a sphere of 6 and 10 mm, by Lamé's solution, and at finite
  strain by the equations of an incompressible sphere: dq/dt + q/τ = γ ds/dt at each radius;
- **bar, pulled by half**: force, by the law that `voxsoft material fit` fits.

FElupe (``pip install felupe tensortrax``; without it its column is left empty) has the
multiplicative model of Shutov, Landgraf and Ihlemann (doi 10.1016/j.cma.2013.07.004), a standard
linear solid where strains are small. Its error is of first order in the step: two step lengths,
τ/20 and τ/40, are extrapolated to none.

`--day` follows the template ``pneunet`` with two branches, 10 and 1000 s, under its pressure for a
day, and reports seconds.

Long because each case stands beside its closed form and its model for FElupe.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import voxsoft as vs
from voxsoft.design import families
from voxsoft.materials import relaxing_stress
from voxsoft.units import mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from bending import SQUARE
from measure import Report

Floats = NDArray[np.float64]

#: A branch, and those of finite strain.
G, TAU = 0.3, 100.0
BRANCHES = ((0.3, 10.0), (0.2, 100.0))
SHEAR, POISSON = 20e3, 0.45
BULK = 2 * SHEAR * (1 + POISSON) / (3 * (1 - 2 * POISSON))
#: Poisson's ratio of finite strains, whose closed forms are incompressible.
NEARLY = 0.4999
LENGTH, WIDTH = 20 * mm, 10 * mm
#: Radii of the balloon.
INNER, OUTER = 6 * mm, 10 * mm
#: Pressures of the balloon in Pa, small and large, and its history: rise, hold, fall, hold.
SMALL, LARGE = 20.0, 9e3
HISTORY = {"time": [0.0, 10.0, 100.0, 110.0], "factor": [0.0, 1.0, 1.0, 0.5]}
#: Rise of the load of the bar with a history, s.
RISE = 50.0
TIMES = (0.0, 100.0, 200.0, 300.0)
#: Below this a value has no relative error.
NOTHING = 1e-9
#: FElupe's steps for each relaxation time.
STEPS = 20


def rubber(
    poisson: float = POISSON, branches: tuple[tuple[float, float], ...] = ((G, TAU),)
) -> Any:
    """Neo-Hookean rubber with branches (g, τ)."""
    prony = [{"g": g, "tau": tau} for g, tau in branches]
    return vs.NeoHookean(young=2 * SHEAR * (1 + poisson), poisson=poisson, prony=prony)


def bar(end: dict[str, Any], material: Any, *, held: str = "", voxel: float = 5 * mm) -> vs.Design:
    """A bar along x on rollers, with loads and the clamp `held` at its end."""
    rollers = [vs.Clamp(region=vs.Region(**{axis: (0, 0)}), axes=axis) for axis in "xyz"]
    far = vs.Region(x=(LENGTH, LENGTH))
    clamps = [vs.Clamp(region=far, axes=held, motion=end["motion"])] if held else []
    return vs.Design(
        name="bar",
        voxel_size=voxel,
        parts=[vs.Part(shape=vs.Box(size=(LENGTH, WIDTH, WIDTH)), material=material)],
        clamps=rollers + clamps,
        loads=[] if held else [vs.Traction(region=far, **end)],
        probes={"end": vs.Probe(x=(LENGTH, LENGTH))},
        objectives={"force": {"maximize": "reaction", "region": {"x": (LENGTH, LENGTH)}}}
        if held
        else {},
        solver={"error": "off"},
    )


def rod(angle: float) -> vs.Design:
    """A square bar along x, one end turned by an angle in rad, both free to warp."""
    middle = WIDTH / 2
    rotation = {"axis": (1, 0, 0), "angle": angle, "center": (0, middle, middle)}
    history = {"time": [0.0, 1e-6 * TAU], "factor": [0.0, 1.0]}
    turned = vs.Motion(rotation=rotation, history=history)
    return vs.Design(
        name="rod",
        voxel_size=WIDTH / 4,
        parts=[vs.Part(shape=vs.Box(size=(LENGTH, WIDTH, WIDTH)), material=rubber())],
        clamps=[
            vs.Clamp(region=vs.Region(x=(0, 0)), axes="yz"),
            vs.Clamp(region=vs.Region(x=(0, 0), y=(middle, middle), z=(middle, middle)), axes="x"),
            vs.Clamp(name="jaw", region=vs.Region(x=(LENGTH, LENGTH)), axes="yz", motion=turned),
        ],
        objectives={
            "torque": {
                "maximize": "reaction_moment",
                "clamp": "jaw",
                "axis": "x",
                "about": (0, middle, middle),
            }
        },
        solver={"error": "off"},
    )


def balloon(material: Any, pressure: float, **history: Any) -> vs.Design:
    """An eighth of a hollow sphere under a pressure in Pa."""
    shell = vs.Sphere(radius=OUTER) - vs.Sphere(radius=INNER)
    return vs.Design(
        name="balloon",
        voxel_size=1 * mm,
        fill="fraction",
        parts=[vs.Part(shape=shell, material=material)],
        symmetry=[{"plane": axis} for axis in "xyz"],
        loads=[vs.Pressure(value=pressure, **history)],
        solver={"error": "off"},
    )


def growth(result: vs.Result) -> float:
    """Growth of the cavity over its volume."""
    first = result.mesh.cavities[0].volume
    return float(result.cavity_volumes[0]) / first - 1


def compliance(times: Floats) -> Floats:
    """Elongation over stress of a bar under a load that came at time zero, 1/Pa."""
    times = np.asarray(times)
    crept = (1 - G * np.exp(-(1 - G) * times / TAU)) / (3 * SHEAR) + 1 / (9 * BULK)
    return np.where(times < 0, 0.0, crept)


def risen(times: Floats) -> Floats:
    """Elongation over stress of a bar whose load rises evenly."""

    def whole(t: Floats) -> Floats:
        t = np.maximum(t, 0)
        lag = TAU / (1 - G)
        return (t - G * lag * (1 - np.exp(-t / lag))) / (3 * SHEAR) + t / (9 * BULK)

    return (whole(times) - whole(times - RISE)) / RISE


def young(times: Floats) -> Floats:
    """Force over strain and section of a bar that is held from time zero on, Pa."""
    sudden = SHEAR / (1 - G)

    def modulus(shear: float) -> float:
        return 9 * BULK * shear / (3 * BULK + shear)

    lag = TAU * (3 * BULK + sudden) / (3 * BULK + SHEAR)
    fallen = (modulus(sudden) - modulus(SHEAR)) * np.exp(-np.asarray(times) / lag)
    return modulus(SHEAR) + fallen


def lame(times: Floats) -> Floats:
    """Growth of a cavity over its pressure, small strains, 1/Pa."""
    ratio = (INNER / OUTER) ** 3
    crept = (1 - G * np.exp(-(1 - G) * np.asarray(times) / TAU)) / (4 * SHEAR)
    return 3 * (crept + ratio / (3 * BULK)) / (1 - ratio)


def inflated(times: Floats, pressure_of: Callable[[float], float], long_term: bool) -> Floats:
    """Growth of the cavity of an incompressible sphere at finite strain.

    A radius R goes to r, r³ = R³ + a³ - A³, with the stretches r/R along the sphere and (R/r)²
    across. The stress s + Σ q of the branches is that by the stretches, and the pressure is the
    integral of 2 (σ_along - σ_across)/r over r.
    """
    nodes, weights = np.polynomial.legendre.leggauss(20)
    rest = (OUTER + INNER) / 2 + (OUTER - INNER) / 2 * nodes
    weights = (OUTER - INNER) / 2 * weights
    shares = np.array([] if long_term else [g for g, _ in BRANCHES])
    stiff = (shares / (1 - shares.sum()))[:, None, None]
    lags = np.array([] if long_term else [tau for _, tau in BRANCHES])[:, None, None]

    def stretches(grown: float) -> Floats:
        along = np.cbrt(rest**3 + grown * INNER**3) / rest
        return np.array([along, along**-2])

    def deviatoric(each: Floats) -> Floats:
        mean = (2 * each[0] ** 2 + each[1] ** 2) / 3
        return np.asarray(SHEAR * (each - mean / each))

    def carried(grown: float, flowed: Floats) -> float:
        each = stretches(grown)
        along, across = each * ((1 + stiff.sum()) * deviatoric(each) - flowed.sum(axis=0))
        radius = each[0] * rest
        return float((weights * 2 * (along - across) / radius * each[1]).sum())

    def state(instant: float, flowed: Floats) -> float:
        load = pressure_of(instant)
        return float(brentq(lambda v: carried(v, flowed) - load, -0.5, 6, xtol=1e-13))

    def rates(instant: float, row: Floats) -> Floats:
        flowed = row.reshape(-1, 2, len(rest))
        stress = deviatoric(stretches(state(instant, flowed)))
        return np.asarray(((stiff * stress - flowed) / lags).ravel())

    row = np.zeros((len(shares), 2, len(rest)))
    found = [state(times[0], row)]
    for begin, end in pairwise(times):
        if len(shares):
            way = solve_ivp(rates, (begin, end), row.ravel(), rtol=1e-7, atol=1e-5)
            row = way.y[:, -1].reshape(row.shape)
        found.append(state(end, row))
    return np.array(found)


@dataclass(frozen=True)
class Case:
    """A case at its times: ours and the closed form, as parts of the long-term values."""

    name: str
    times: Floats
    ours: Floats
    closed: Floats
    #: Error of the long-term value.
    rest: float
    felupe: Floats | None = None


def followed(design: vs.Design, times: Sequence[float] = TIMES) -> vs.LoadPath:
    """The path over time at some times in s, or an end of the script."""
    path = vs.follow(design, "time", times)
    if path.status != "ok":
        raise SystemExit(f"wrong answer: {design.name}, {path.message}")
    return path


def at_rest(design: vs.Design) -> vs.Result:
    """The long-term equilibrium, with all loads there."""
    return vs.simulate(design)


def cases() -> Iterator[Case]:
    """All cases of small strain, then those of finite strain."""
    stress, strain, angle = 6.0, 1e-5, 1e-4
    for name, closed, history in (
        ("bar, step load", compliance, {}),
        ("bar, load history", risen, {"history": {"time": [0, RISE], "factor": [0, 1]}}),
    ):
        design = bar({"value": (stress, 0, 0), **history}, rubber())
        path, rest = followed(design), float(at_rest(design).probes["end"][0])
        final = stress * LENGTH * float(compliance(np.array(np.inf)))
        times = np.array(path.values)
        found = np.array(path.columns["end.x"][1]) / rest
        limit = float(compliance(np.array(np.inf)))
        theirs = felupe_bar(times, RISE if history else 0.0)
        yield Case(name, times, found, closed(times) / limit, rest / final - 1, theirs)

    sudden = {"time": [0.0, 1e-6 * TAU], "factor": [0.0, 1.0]}
    pulled = vs.Motion(displacement=(strain * LENGTH, 0, 0), history=sudden)
    design = bar({"motion": pulled}, rubber(), held="x")
    values = (1e-3, *TIMES[1:])
    path, rest = followed(design, values), float(at_rest(design).metrics["force"])
    times = np.array(path.values)
    found = np.array([float(each.metrics["force"]) for each in path.results]) / rest
    final = float(young(np.array(np.inf)))
    off = rest / (final * strain * WIDTH**2) - 1
    yield Case("bar, held", times, found, young(times) / final, off, felupe_held(times))

    design = rod(angle)
    path, rest = followed(design, values), float(at_rest(design).metrics["torque"])
    found = np.array([float(each.metrics["torque"]) for each in path.results]) / rest
    final = SHEAR * SQUARE * WIDTH**4 * angle / LENGTH
    closed_form = 1 + G / (1 - G) * np.exp(-times / TAU)
    yield Case("rod, twisted", times, found, closed_form, rest / final - 1)

    design = balloon(rubber(), SMALL)
    path, rest = followed(design), growth(at_rest(design))
    times = np.array(path.values)
    found = np.array([growth(each) for each in path.results]) / rest
    final = float(lame(np.array(np.inf)))
    off = rest / (final * SMALL) - 1
    yield Case("balloon", times, found, lame(times) / final, off, felupe_balloon(times))

    material = rubber(NEARLY, BRANCHES)
    design = balloon(material, LARGE, history=HISTORY)
    path = followed(design, (0, 10, 40, 100, 110, 150, 300))
    times = np.array(path.values)

    def pressure(instant: float) -> float:
        return LARGE * float(np.interp(instant, HISTORY["time"], HISTORY["factor"]))

    rest = growth(at_rest(balloon(material, LARGE)))
    (final,) = inflated(np.zeros(1), lambda _: LARGE, long_term=True)
    found = np.array([growth(each) for each in path.results]) / rest
    expected = inflated(times, pressure, long_term=False) / final
    yield Case("balloon, load history", times, found, expected, rest / final - 1)

    rise = {"time": [0.0, 20.0], "factor": [0.0, 1.0]}
    pulled = vs.Motion(displacement=(LENGTH / 2, 0, 0), history=rise)
    design = bar({"motion": pulled}, material, held="x")
    path, rest = followed(design, (5, 20, 50, 300)), float(at_rest(design).metrics["force"])
    times = np.array(path.values)
    found = np.array([float(each.metrics["force"]) for each in path.results]) / rest
    final = SHEAR * (1.5 - 1.5**-2) * WIDTH**2
    # From the beginning of the rise on, in two lines.
    all_times = np.concatenate([[0.0], times])
    stretch = 1 + np.minimum(all_times / 20, 1) / 2
    force = relaxing_stress(material, all_times, stretch)[1:] * WIDTH**2
    yield Case("bar, pulled by half", times, found, force / final, rest / final - 1)


class Peer:
    """A standard linear solid of FElupe on a mesh, stepped over time."""

    def __init__(self, mesh: Any, axisymmetric: bool) -> None:
        import felupe as fe

        def energy(strain: Any, inner: Any, dtime: float) -> Any:
            from tensortrax.math import trace
            from tensortrax.math.linalg import det

            stiff = SHEAR * G / (1 - G)
            branch, inner = fe.finite_strain_viscoelastic(strain, inner, stiff, stiff * TAU, dtime)
            return SHEAR / 2 * (det(strain) ** (-1 / 3) * trace(strain) - 3) + branch, inner

        self.umat = fe.Hyperelastic(energy, nstatevars=6, dtime=0.0)
        kind = fe.FieldAxisymmetric if axisymmetric else fe.Field
        region = (fe.RegionQuad if axisymmetric else fe.RegionHexahedron)(mesh)
        self.field = fe.FieldContainer([kind(region, dim=2 if axisymmetric else 3)])
        unit = np.array([1.0, 0.0, 0.0, 1.0, 0.0, 1.0])[:, None, None]
        shape = (6, region.quadrature.npoints, mesh.ncells)
        self.solid = fe.SolidBodyNearlyIncompressible(
            self.umat, self.field, bulk=BULK, statevars=np.broadcast_to(unit, shape).copy()
        )

    def along(
        self,
        times: Floats,
        step: float,
        boundaries: dict[str, Any],
        others: list[Any],
        load: Callable[[float], None],
        measure: Callable[[], float],
    ) -> Floats:
        """What is measured at some times, sudden at zero and in steps of a length in s."""
        import felupe as fe

        dof0, dof1 = fe.dof.partition(self.field, boundaries)
        found, now = [], 0.0
        for target in times:
            count = int(np.ceil((target - now) / step - 1e-9)) if target > now else 1
            for number in range(1, count + 1):
                self.umat.kwargs["dtime"] = (target - now) / count
                load(now + (target - now) * number / count)
                ext0 = fe.dof.apply(self.field, boundaries, dof0)
                items = [self.solid, *others]
                fe.newtonraphson(
                    items=items, dof0=dof0, dof1=dof1, ext0=ext0, tol=1e-7, maxiter=20, verbose=0
                )
            now = float(target)
            found.append(measure())
        return np.array(found)


def extrapolated(by: Callable[[float], Floats]) -> Floats | None:
    """Results of two step lengths, extrapolated to none; None without FElupe."""
    if not (find_spec("felupe") and find_spec("tensortrax")):
        return None
    return 2 * by(TAU / STEPS / 2) - by(TAU / STEPS)


def felupe_bar(times: Floats, rise: float) -> Floats | None:
    """Elongation of a bar under a load, over its long-term one."""

    def by(step: float) -> Floats:
        import felupe as fe

        peer = Peer(fe.Cube(n=2), axisymmetric=False)
        points, field = peer.solid.field.region.mesh.points, peer.field
        end = points[:, 0] == 1
        held = {axis: fe.Boundary(field[0], **{f"f{axis}": 0}, skip=skip) for axis, skip in ROLLS}
        stress = 1e-5 * SHEAR
        force = fe.PointLoad(field, np.flatnonzero(end), values=[0.0, 0.0, 0.0])

        def load(now: float) -> None:
            part = min(now / rise, 1.0) if rise else 1.0
            force.update(np.array([part * stress / 4, 0.0, 0.0]))

        def measure() -> float:
            moved = float(field[0].values[end, 0].mean())
            return moved / (stress * float(compliance(np.array(np.inf))))

        return peer.along(times, step, held, [force], load, measure)

    return extrapolated(by)


#: Symmetry of FElupe's bar: the axis of each plane, and the axes that it leaves free.
ROLLS = (("x", (0, 1, 1)), ("y", (1, 0, 1)), ("z", (1, 1, 0)))


def felupe_held(times: Floats) -> Floats | None:
    """Force of a bar that is held, over its long-term one."""

    def by(step: float) -> Floats:
        import felupe as fe

        peer = Peer(fe.Cube(n=2), axisymmetric=False)
        field = peer.field
        end = field.region.mesh.points[:, 0] == 1
        held = {axis: fe.Boundary(field[0], **{f"f{axis}": 0}, skip=skip) for axis, skip in ROLLS}
        strain = 1e-5
        held["moved"] = fe.Boundary(field[0], fx=1, skip=(0, 1, 1), value=strain)

        def measure() -> float:
            force = peer.solid.assemble.vector().toarray().reshape(-1, 3)[end, 0].sum()
            return float(force) / (strain * float(young(np.array(np.inf))))

        return peer.along(
            np.concatenate([[0.0], times]), step, held, [], lambda now: None, measure
        )[1:]

    return extrapolated(by)


def felupe_balloon(times: Floats) -> Floats | None:
    """Growth of the cavity of a sphere, over the long-term one, on a meridian of 8 x 12 quads."""

    def by(step: float) -> Floats:
        import felupe as fe

        mesh = fe.Rectangle(a=(INNER, 0.0), b=(OUTER, np.pi / 2), n=(9, 13))
        radius, angle = mesh.points.T
        mesh.update(points=np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1))
        inside = radius == INNER
        peer = Peer(mesh, axisymmetric=True)
        field = peer.field
        held = {
            "x": fe.Boundary(field[0], fx=lambda x: np.isclose(x, 0, atol=1e-9), skip=(0, 1)),
            "y": fe.Boundary(field[0], fy=lambda y: np.isclose(y, 0, atol=1e-9), skip=(1, 0)),
        }
        edge = fe.RegionQuadBoundary(mesh, only_surface=True, mask=inside, ensure_3d=True)
        container = fe.FieldContainer([fe.FieldAxisymmetric(edge, dim=2)])
        pressure = fe.SolidBodyPressure(field=container)

        def load(now: float) -> None:
            pressure.update(SMALL)

        def measure() -> float:
            values = field[0].values[inside]
            away = np.stack([np.cos(angle), np.sin(angle)], axis=1)[inside]
            moved = (values * away).sum(axis=1).mean() / INNER
            return float(3 * moved) / (SMALL * float(lame(np.array(np.inf))))

        return peer.along(times, step, held, [pressure], load, measure)

    return extrapolated(by)


def a_day(report: Report) -> None:
    """Follow the PneuNet's template for a day, with two branches."""
    design = families.pneunet()
    prony = [{"g": 0.1, "tau": "10 s"}, {"g": 0.1, "tau": "1000 s"}]
    soft = vs.NeoHookean(young="70 kPa", poisson=0.49, prony=prony)
    parts = [part if part.name == "layer" else part.replace(material=soft) for part in design.parts]
    day = design.replace(parts=parts, solver={"error": "off"})
    start = time.perf_counter()
    path = followed(day, np.linspace(0, 86400, 25).tolist())
    report.add("a day of the template pneunet", time.perf_counter() - start, "s")
    report.add("its steps of Newton's method", sum(each.steps for each in path.results), "")
    bend = [float(each.metrics["bend"]) / mm for each in path.results]
    report.add("bend at first", bend[0], "mm")
    report.add("bend after a day", bend[-1], "mm")
    rest = float(vs.simulate(day).metrics["bend"]) / mm
    report.add("bend at rest", rest, "mm", bend[-1] / rest)


def main() -> None:
    """Solve, show and report."""
    report = Report("Creep over time", day="follow the template pneunet for a day instead")
    if report.options["day"]:
        a_day(report)
        report.show()
        return
    table = Table(title="Parts of the long-term value", title_justify="left")
    for column in (
        "case",
        "time s",
        "ours",
        "closed form",
        "off %",
        "FElupe",
        "off %",
        "at rest off %",
    ):
        table.add_column(column, justify="left" if column == "case" else "right")
    for case in cases():
        print(case.name, file=sys.stderr, flush=True)
        for row, instant in enumerate(case.times):
            ours, closed = case.ours[row], case.closed[row]
            cells = [
                case.name if row == 0 else "",
                f"{instant:.4g}",
                f"{ours:.6f}",
                f"{closed:.6f}",
            ]
            cells.append(f"{100 * (ours / closed - 1):+.4f}" if closed > NOTHING else "")
            theirs = None if case.felupe is None else case.felupe[row]
            cells.append("" if theirs is None else f"{theirs:.6f}")
            cells.append(
                f"{100 * (theirs / closed - 1):+.4f}" if theirs and closed > NOTHING else ""
            )
            cells.append(f"{100 * case.rest:+.3f}" if row == 0 else "")
            table.add_row(*cells)
            name = f"{case.name}, {instant:g} s"
            ratio = ours / closed if closed > NOTHING else None
            report.rows.append({"name": name, "value": ours, "unit": "", "ratio": ratio})
            if theirs is not None:
                ratio = theirs / closed if closed > NOTHING else None
                report.rows.append(
                    {"name": f"{name}, FElupe", "value": theirs, "unit": "", "ratio": ratio}
                )
    if report.options["json"]:
        report.show()
    else:
        Console(width=120).print(table)


if __name__ == "__main__":
    main()
