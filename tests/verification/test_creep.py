"""Rubber that relaxes, over time without inertia, beside closed forms.

Only the deviatoric stress of rubber relaxes, so that all closed forms are those of a shear modulus
μ(t) = μ (1 + γ e^(-t/τ)), γ = g/(1 - g), beside a constant bulk modulus K: compliances of shear
relax with the retardation time τ/(1 - g), and a uniaxial strain relaxes with the time
τ (3K + μ/(1 - g))/(3K + μ).

A step has an error of at most 1e-5 of the largest stress in its branches (`ERROR` of
`crates/statics/src/path/creep.rs`), and a creep has some tens of steps, whose errors decay with the
branches: 1e-4 is allowed for all of them.
"""

import re
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import voxsoft as vs
from voxsoft.comparison import path_error_bars
from voxsoft.errors import SimulationError
from voxsoft.materials import relaxing_stress
from voxsoft.units import mm

G, TAU, YOUNG, POISSON = 0.3, 100.0, 60e3, 0.45
SHEAR, BULK = YOUNG / (2.0 * (1.0 + POISSON)), YOUNG / (3.0 * (1.0 - 2.0 * POISSON))
GAMMA = G / (1.0 - G)
#: Tolerance of a creep, from the error of its steps.
STEPS = 1e-4
LENGTH, SIDE = 20 * mm, 10 * mm
ROLLERS = [{"region": {axis: [0, 0]}, "axes": axis} for axis in "xyz"]
FAR = {"x": ["20 mm", "20 mm"]}


def bar(*, prony=((G, TAU),), clamps=(), loads=(), mullins=None, **changes):
    material = {
        "model": "neo-hookean",
        "young": YOUNG,
        "poisson": POISSON,
        "density": "1000 kg/m^3",
        "prony": [{"g": g, "tau": tau} for g, tau in prony],
    }
    if mullins:
        material["mullins"] = mullins
    return vs.Design.from_document(
        {
            "schema": "voxsoft/1",
            "name": "bar",
            "voxel_size": "5 mm",
            "shapes": {"bar": {"kind": "box", "size": ["20 mm", "10 mm", "10 mm"]}},
            "parts": [{"shape": "bar", "material": _in_units(material)}],
            "clamps": [*ROLLERS, *clamps],
            "loads": list(loads),
            "probes": {"end": FAR},
            "solver": {"error": "off"},
            **changes,
        }
    )


def _in_units(material):
    terms = [{"g": each["g"], "tau": f"{each['tau']} s"} for each in material["prony"]]
    return {**material, "young": f"{YOUNG} Pa", "prony": terms}


def ramp(end, factor=1.0):
    return {"time": [0, f"{end} s"], "factor": [0, factor]}


def pulled(way, end, **changes):
    """A bar whose end moves by `way` (m) within `end` seconds, and is held then."""
    motion = {"displacement": [f"{way} m", 0, 0], "history": ramp(end)}
    return bar(clamps=[{"region": FAR, "axes": "x", "motion": motion}], **changes)


def _relaxed(times):
    """Relaxation modulus of uniaxial strain, Pa."""
    sudden = SHEAR / (1.0 - G)
    long_term, at_first = _young(SHEAR), _young(sudden)
    time = TAU * (3.0 * BULK + sudden) / (3.0 * BULK + SHEAR)
    return long_term + (at_first - long_term) * np.exp(-times / time)


def _young(shear):
    return 9.0 * BULK * shear / (3.0 * BULK + shear)


def forces(path):
    """The force at the moved end at each time, N."""
    ends = path.results[0].mesh.vertices[:, 0] > LENGTH - 1e-6
    return np.array([result.reactions[ends, 0].sum() for result in path.results])


def test_a_step_load_creeps_with_the_retardation_time():
    stress = 6.0
    load = {"kind": "traction", "region": FAR, "value": [f"{stress} Pa", 0, 0]}
    path = vs.follow(bar(loads=[load]), "time=0..500 s/6")
    times = np.array(path.values)
    shear = (1.0 - G * np.exp(-(1.0 - G) * times / TAU)) / (3.0 * SHEAR)
    expected = stress * (shear + 1.0 / (9.0 * BULK))
    found = np.array(path.columns["end.x"][1]) / LENGTH
    # Finite strain: of the order of the strain, 1e-4.
    assert found == pytest.approx(expected, rel=STEPS + 2.0 * expected[-1])


def test_a_held_strain_relaxes():
    end, strain = 1e-3, 1e-4
    path = vs.follow(pulled(strain * LENGTH, end), "time=0..400 s/5")
    times = np.array(path.values)
    expected = _relaxed(times[1:]) * strain * SIDE**2
    assert forces(path)[1:] == pytest.approx(expected, rel=STEPS + 2.0 * strain)


@pytest.mark.parametrize(("end", "modulus"), [(1e-4 * TAU, "sudden"), (1e4 * TAU, "long-term")])
def test_fast_and_slow_loading_have_the_two_limits(end, modulus):
    strain = 1e-4
    path = vs.follow(pulled(strain * LENGTH, end), f"time=0..{end} s/2")
    shear = SHEAR / (1.0 - G) if modulus == "sudden" else SHEAR
    young = _young(shear)
    # The branch lags or relaxes by γ/1e4 meanwhile.
    expected = young * strain * SIDE**2
    assert forces(path)[-1] == pytest.approx(expected, rel=STEPS + 2.0 * strain + 1e-4)


def test_a_twisted_rod_relaxes_with_the_shear_modulus():
    motion = {"rotation": {"axis": [1, 0, 0], "angle": "0.1 deg"}, "history": ramp(1e-3)}
    design = bar().replace(
        clamps=[
            {"region": {"x": [0, 0]}},
            {"region": FAR, "motion": motion},
        ]
    )
    path = vs.follow(design, "time=0..300 s/4")
    rest = path.results[0].mesh.vertices
    end = rest[:, 0] > LENGTH - 1e-6
    arm = rest[end][:, 1:] - rest[end][:, 1:].mean(axis=0)

    def torque(result):
        force = result.reactions[end][:, 1:]
        return float((arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]).sum())

    found = np.array([torque(result) for result in path.results[1:]])
    times = np.array(path.values[1:])
    # Where the clamps prevent warping, bulk takes a part that a uniform shear has not: 1e-6 here.
    at_rest = torque(vs.simulate(design))
    expected = at_rest * (1.0 + GAMMA * np.exp(-times / TAU))
    assert found == pytest.approx(expected, rel=STEPS + 1e-4)


def test_growth_against_clamps_relaxes():
    strain = 1e-4
    growth = {"part": "bar", "kind": "strain", "value": strain, "history": ramp(1e-3)}
    held = bar(clamps=[{"region": FAR, "axes": "x"}], activations=[growth])
    path = vs.follow(held, "time=0..400 s/5")
    expected = -_relaxed(np.array(path.values[1:])) * strain * SIDE**2
    assert forces(path)[1:] == pytest.approx(expected, rel=STEPS + 3.0 * strain)


def test_a_sphere_under_pressure_creeps():
    inner, outer, pressure = 6 * mm, 10 * mm, 20.0
    design = bar().replace(
        voxel_size=2 * mm,
        shapes={
            "outer": {"kind": "sphere", "radius": "10 mm"},
            "inner": {"kind": "sphere", "radius": "6 mm"},
            "bar": {"kind": "difference", "of": ["outer", "inner"]},
        },
        clamps=[],
        probes={},
        symmetry=[{"plane": axis} for axis in "xyz"],
        loads=[{"kind": "pressure", "value": f"{pressure} Pa"}],
    )
    path = vs.follow(design, "time=0..300 s/4")
    volumes = np.array([result.cavity_volumes[0] for result in path.results])
    first = path.results[0].mesh.cavities[0].volume
    growth = (volumes - first) / first
    times = np.array(path.values)
    # Hollow sphere: u/a = p a³/(b³ - a³) (1/3K + b³/(4 μ a³)).
    bulk = 4.0 * SHEAR * (inner / outer) ** 3 / (3.0 * BULK)
    shear = 1.0 - G * np.exp(-(1.0 - G) * times / TAU)
    expected = (shear + bulk) / (shear[-1] + bulk)
    # The share of the bulk is that of a sphere of voxels, 10 % off in its radii.
    assert growth / growth[-1] == pytest.approx(expected, abs=STEPS + 0.3 * bulk * G)


def _uniaxial(times, stretch_of, prony):
    """Nominal stress (Pa) of a cube under a stretch over time, see `docs/method/materials.md`."""

    def deviatoric(along, across):
        volume = along * across**2
        scale = volume ** (-2.0 / 3.0)
        mean = (along**2 + 2.0 * across**2) / 3.0
        pairs = np.array([along, across])
        return SHEAR * scale * (pairs - mean / pairs)

    shares = np.array([g for g, _ in prony])
    stiffness = shares / (1.0 - shares.sum())
    relaxation = np.array([tau for _, tau in prony])

    def state(time, flowed):
        along = stretch_of(time)

        def lateral(across):
            volume = along * across**2
            own = (1.0 + stiffness.sum()) * deviatoric(along, across)[1] - flowed[:, 1].sum()
            return own + BULK * (volume - 1.0) * volume / across

        across = brentq(lateral, 0.5, 1.5, xtol=1e-14)
        return along, across

    def rates(time, row):
        flowed = row.reshape(-1, 2)
        stress = deviatoric(*state(time, flowed))
        return ((stiffness[:, None] * stress - flowed) / relaxation[:, None]).ravel()

    rows = [np.zeros(2 * len(prony))]
    for begin, end in pairwise(times):
        found = solve_ivp(rates, (begin, end), rows[-1], rtol=1e-9, atol=1e-6)
        rows.append(found.y[:, -1])
    stresses = []
    for time, row in zip(times, rows, strict=True):
        flowed = row.reshape(-1, 2)
        along, across = state(time, flowed)
        volume = along * across**2
        own = (1.0 + stiffness.sum()) * deviatoric(along, across)[0] - flowed[:, 0].sum()
        stresses.append(own + BULK * (volume - 1.0) * volume / along)
    return np.array(stresses)


def test_a_cube_at_a_large_strain_follows_the_ode_of_the_model():
    prony, end = ((0.3, 10.0), (0.2, 1000.0)), 20.0
    path = vs.follow(pulled(0.5 * LENGTH, end, prony=prony), "time=0..200 s/11")
    stresses = _uniaxial(path.values, lambda time: 1.0 + 0.5 * min(time / end, 1.0), prony)
    assert forces(path) == pytest.approx(stresses * SIDE**2, rel=STEPS, abs=1e-9)


def test_the_law_that_tests_over_time_are_fitted_with_is_that_of_a_simulation():
    prony, end = ((0.3, 10.0), (0.2, 1000.0)), 20.0
    design = pulled(0.5 * LENGTH, end, prony=prony)
    part = design.parts[0]
    material = part.material.replace(young_modulus=YOUNG, poisson=0.499)
    path = vs.follow(design.replace(parts=[part.replace(material=material)]), "time=0..200 s/11")
    times = np.array(path.values[1:])
    expected = relaxing_stress(material, times, 1.0 + 0.5 * np.minimum(times / end, 1.0))
    # The closed form is incompressible and has Young's modulus 3 μ: of the order of μ/K = 0.002.
    assert forces(path)[1:] == pytest.approx(expected * SIDE**2, rel=STEPS + 2e-3)


def test_work_is_stored_or_lost_in_the_branches_and_never_created():
    strain, volume = 1e-4, LENGTH * SIDE**2
    design = pulled(strain * LENGTH, 50.0)
    history = {"time": [0, "50 s", "200 s", "250 s"], "factor": [0, 1, 1, 0]}
    moved = design.clamps[-1].motion.replace(history=history)
    clamps = [*design.clamps[:-1], design.clamps[-1].replace(motion=moved)]
    path = vs.follow(design.replace(clamps=clamps), "time=0..400 s/161")
    force, way = forces(path), np.array(path.columns["end.x"][1])
    across = np.array(path.columns["end.y"][1]) / (SIDE / 2.0)
    # Deviatoric stress of the branch along the bar; half of it, negative, across.
    branch = 2.0 / 3.0 * (force / SIDE**2 - 2.0 * SHEAR * (way / LENGTH - across))
    kept = 1.5 * branch**2 / (4.0 * GAMMA * SHEAR) * volume
    stored = np.array([result.elastic_energy for result in path.results])
    lost = _integral(force, way) - stored - kept
    expected = 2.0 * _integral(kept, np.array(path.values)) / TAU
    # Trapezoids of h = 2.5 s: (h/τ)²/12 of what they integrate; and finite strain.
    largest = (stored + kept).max()
    allowed = largest * ((2.5 / TAU) ** 2 / 12.0 + 2.0 * strain)
    assert lost == pytest.approx(expected, abs=allowed)
    # Between two records the end goes a twentieth of its way.
    assert np.diff(lost).min() > -allowed / 20.0
    assert lost[-1] > 0.1 * largest


def _integral(values, over):
    parts = (values[1:] + values[:-1]) / 2.0 * np.diff(over)
    return np.concatenate([[0.0], np.cumsum(parts)])


def test_records_on_the_way_change_nothing_but_the_error_of_steps():
    few = forces(vs.follow(pulled(1e-3 * LENGTH, 10.0), "time=0..100 s/2"))
    many = forces(vs.follow(pulled(1e-3 * LENGTH, 10.0), "time=0..100 s/41"))
    assert few[-1] == pytest.approx(many[-1], rel=STEPS)


def test_softening_and_creep_go_together():
    soft = {"r": 1.5, "m": "0.2 kPa", "beta": 0.1}
    design = pulled(0.3 * LENGTH, 10.0, mullins=soft)
    history = {"time": [0, "10 s", "20 s", "30 s"], "factor": [0, 1, 0.5, 0.5]}
    motion = design.clamps[-1].motion.replace(history=history)
    there = design.replace(clamps=[*design.clamps[:-1], design.clamps[-1].replace(motion=motion)])
    softened = forces(vs.follow(there, "time=0..2000 s/3"))
    elastic = there.replace(
        parts=[there.parts[0].replace(material=there.parts[0].material.replace(prony=[]))]
    )
    # After twenty relaxation times only the long-term stress is left, with its softening.
    assert softened[-1] == pytest.approx(forces(vs.follow(elastic, "time=0..30 s/4"))[-1], rel=5e-3)


def test_bars_and_slopes_of_a_crept_state_do_not_take_it_for_one_at_rest():
    load = {"kind": "traction", "region": FAR, "value": ["60 Pa", 0, 0]}
    goal = {"reach": {"maximize": "displacement", "probe": "end", "axis": "x"}}
    solver = {"error": "finer"}
    path = vs.follow(bar(loads=[load], objectives=goal, solver=solver), "time=0..100 s/2")
    crept = path.results[-1]
    assert "crept" in vs.error_bars(crept).missing
    with pytest.raises(SimulationError, match="has crept"):
        vs.gradient(crept, ["reach"], ["parts.0.material.young"])
    bars = path_error_bars(path)
    # A uniform stress has no error of discretization; each size has that of its steps.
    for found, result in zip(bars, path.results, strict=True):
        reach = float(result.metrics["reach"])
        assert found.metrics["reach"].estimate == pytest.approx(reach, rel=STEPS)


def test_time_that_goes_back_is_refused():
    with pytest.raises(SimulationError, match="goes back in time"):
        vs.follow(pulled(1e-3 * LENGTH, 1.0), "time=0..10..0 s/5")


def test_a_stiffness_of_a_crept_state_says_that_it_is_the_long_term_one():
    load = {"kind": "traction", "region": FAR, "value": ["60 Pa", 0, 0]}
    goal = {"pitch": {"maximize": "natural_frequency"}}
    crept = vs.follow(bar(loads=[load], objectives=goal), "time=0..100 s/2").results[-1]
    (warning,) = [each for each in crept.warnings if each.where == "pitch"]
    assert "long-term stiffness" in warning.what
    # The tangent of the elastic body at that shape, which is strained by some thousandths.
    elastic = vs.simulate(bar(prony=(), loads=[load], objectives=goal))
    assert float(crept.metrics["pitch"]) == pytest.approx(float(elastic.metrics["pitch"]), rel=2e-3)


def _arch(force, *, g, end, **solver):
    """A flat arch, clamped at both ends, on whose top a force grows until `end` seconds."""
    material = {"model": "neo-hookean", "young": "100 kPa", "poisson": 0.45}
    if g:
        material["prony"] = [{"g": g, "tau": "10 s"}]
    tube = {"kind": "difference", "of": ["outer", "inner"]}
    round_bar = {"kind": "cylinder", "axis": "y"}
    top = {"kind": "box", "size": ["120 mm", "10 mm", "20 mm"], "center": [0, 0, "60 mm"]}
    middle = {"x": ["-1.5 mm", "1.5 mm"]}
    sides = [{"x": ["-80 mm", "-30 mm"]}, {"x": ["30 mm", "80 mm"]}]
    return vs.Design.from_document(
        {
            "schema": "voxsoft/1",
            "name": "arch",
            "voxel_size": "2 mm",
            "shapes": {
                "outer": {**round_bar, "radius": "62 mm", "height": "4 mm"},
                "inner": {**round_bar, "radius": "58 mm", "height": "10 mm"},
                "tube": tube,
                "top": top,
                "arch": {"kind": "intersection", "of": ["tube", "top"]},
            },
            "parts": [{"shape": "arch", "material": material}],
            "clamps": [
                *({"region": side} for side in sides),
                {"region": {"z": [0, "80 mm"]}, "axes": "y"},
            ],
            "loads": [
                {
                    "kind": "force",
                    "region": {**middle, "z": ["59 mm", "70 mm"]},
                    "value": [0, 0, f"{-force} N"],
                    "history": ramp(end),
                }
            ],
            "probes": {"top": middle},
            "solver": {"error": "off", **solver},
        }
    )


@pytest.mark.long
def test_a_snap_is_reported_with_its_time():
    force, end, g = 0.05, 20.0, 0.2
    static = vs.simulate(_arch(force, g=0.0, end=end, control="arc-length", steps=20))
    path = vs.follow(_arch(force, g=g, end=end), f"time=0..{end} s/5")
    assert path.status == "ok"
    (snap,) = [time for result in path.results for time in result.snaps]
    # The load at which it snaps lies between the limits of the long-term and of the
    # instantaneous stiffness, as branches have relaxed in part.
    assert static.limit_factor * end < snap < static.limit_factor / (1.0 - g) * end
    snapped = next(result for result in path.results if result.snaps)
    assert f"the body snapped at {snap:.6g} s" in snapped.message
    assert any(f"snapped to another one at {snap:.6g} s" in str(w) for w in snapped.warnings)


@pytest.mark.long
def test_a_creep_past_a_limit_is_lost_at_a_time_and_a_load():
    design = bar().replace(
        voxel_size=2 * mm,
        shapes={
            "outer": {"kind": "sphere", "radius": "10 mm"},
            "inner": {"kind": "sphere", "radius": "6 mm"},
            "bar": {"kind": "difference", "of": ["outer", "inner"]},
        },
        clamps=[],
        probes={},
        symmetry=[{"plane": axis} for axis in "xyz"],
        loads=[{"kind": "pressure", "value": "40 kPa", "history": ramp(20.0)}],
    )
    path = vs.follow(design, "time=0..20 s/2")
    assert path.status == "not-at-rest"
    found = re.search(r"found after ([\d.]+) s under pressure .*? of ([\d.]+) kPa", path.message)
    time, pressure = map(float, found.groups())
    # The load of its history at that time, both to four digits.
    assert pressure == pytest.approx(2.0 * time, rel=1e-3)
    assert 0.0 < time < 20.0
    assert "motion with inertia" in path.message


@pytest.mark.long
def test_a_sudden_load_past_a_limit_snaps_at_time_zero():
    force, g = 0.05, 0.2
    static = vs.simulate(_arch(force, g=0.0, end=1.0, control="arc-length", steps=20))
    # The instantaneous stiffness, 1/(1 - g) times the long-term one, is what it meets.
    assert static.limit_factor / (1.0 - g) < 1.0
    design = _arch(force, g=g, end=1.0)
    sudden = design.replace(loads=[design.loads[0].replace(history=None)])
    path = vs.follow(sudden, "time=0..20 s/3")
    assert path.status == "ok"
    assert [result.snaps for result in path.results] == [(0.0,), (), ()]
    assert "the body snapped at 0 s" in path.results[0].message
    assert any("snapped to another one at 0 s" in str(w) for w in path.results[0].warnings)
    # The arch hangs down on either side of the snap at rest too, and creeps on from there.
    tops = np.array(path.columns["top.z"][1])
    rest = vs.simulate(_arch(force, g=0.0, end=1.0)).probes["top"][2]
    assert np.all(np.diff(tops) < 0.0)
    assert rest < tops[-1]


@pytest.mark.long
def test_a_sudden_load_below_the_limit_does_not_snap():
    force, g = 0.012, 0.2
    design = _arch(force, g=g, end=1.0)
    sudden = design.replace(loads=[design.loads[0].replace(history=None)])
    path = vs.follow(sudden, "time=0..1 s/2")
    assert [result.snaps for result in path.results] == [(), ()]
