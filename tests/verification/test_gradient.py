"""Gradients by the adjoint against central differences of whole solutions."""

import dataclasses

import lattice_families as families
import numpy as np
import pytest

from voxsoft import Objective, gradient, simulate
from voxsoft.design import Design
from voxsoft.design.variation import number_of, with_number
from voxsoft.errors import DesignError, SimulationError
from voxsoft.metrics import METRICS
from voxsoft.metrics.registry import BUILT_IN
from voxsoft.simulation import Setup
from voxsoft.simulation.derivatives.loaded_state import LoadedState

# Residual of each solution: over a step of 1e-3 it leaves 1e-8 of a number in its difference.
TOLERANCE = 1e-11
# Differences of whole solutions, of fourth order: 1e-12 of truncation. Exponents hardly change
# small strains, so that theirs take a longer step; Poisson's ratio one that stays below 0.5.
STEP = 1e-3
STEPS = {"alpha": 3e-2, "poisson": 6e-6}
# Tolerance of the project; rounding and truncation above leave about 1e-6.
CLOSE = 1e-5

SOFT = '{model="neo-hookean", young="30 kPa", poisson=0.499}'
MATERIALS = {
    SOFT: ("young", "poisson", "density"),
    '{model="neo-hookean", young="30 kPa", poisson=0.4999}': ("poisson",),
    '{model="mooney-rivlin", c10="4 kPa", c01="1 kPa"}': ("c10", "c01"),
    '{model="yeoh", c=["5 kPa", "1 kPa", "0.2 kPa"]}': ("c.0", "c.1"),
    '{model="ogden", mu=["12 kPa", "3 kPa"], alpha=[1.7, -3.3]}': ("mu.0", "mu.1", "alpha.0"),
    '{model="gent", shear="10 kPa", jm=3}': ("shear", "jm"),
    '{model="lattice", edge="12 kPa", bulk="30 kPa"}': ("edge", "bulk"),
}


def solved(design):
    result = simulate(design, method="statics", tolerance=TOLERANCE)
    assert result.status == "ok"
    return result


def differences(design, targets, name):
    """Fourth-order central differences of solutions, by target."""
    value = number_of(design, name)
    part = next((step for word, step in STEPS.items() if word in name), STEP)
    step = part * (abs(value) or design.voxel_size)
    seen = {}
    for multiple in (-2, -1, 1, 2):
        result = solved(with_number(design, name, value + multiple * step))
        for key, target in targets.items():
            seen[key, multiple] = result.metric(
                target.metric, probe=target.probe, axis=target.axis, cavity=target.cavity
            )
    return {
        key: (8 * (seen[key, 1] - seen[key, -1]) - (seen[key, 2] - seen[key, -2])) / (12 * step)
        for key in targets
    }


def check(design, targets, names):
    found = gradient(solved(design), targets, names)
    for name in names:
        expected = differences(design, targets, name)
        for key in targets:
            assert found[key][name] == pytest.approx(expected[key], rel=CLOSE), (key, name)


BENT = {
    "tip": Objective(maximize="displacement", probe="station-9"),
    "across": Objective(maximize="displacement", probe="station-9", axis="x"),
    "energy": Objective(maximize="elastic_energy"),
    "farthest": Objective(maximize="max_displacement"),
    "stretch": Objective(maximize="max_stretch"),
}


@pytest.mark.long
@pytest.mark.parametrize("material", MATERIALS, ids=lambda text: text[8:50].replace('"', ""))
def test_a_beam_under_its_weight(material):
    beam = families.beam(length="40 mm").with_values(f"parts.0.material={material}")
    names = [f"parts.0.material.{constant}" for constant in MATERIALS[material]]
    check(beam, BENT, [*names, "loads.0.value"])


def test_a_cylinder_under_pressure():
    cylinder = families.cylinder(radius="15 mm", height="20 mm")
    targets = {
        "rise": Objective(maximize="displacement", probe="top", axis="z"),
        "volume": Objective(maximize="cavity_volume"),
        "swelling": Objective(maximize="cavity_volume_change", cavity=0),
        "energy": Objective(maximize="elastic_energy"),
    }
    design = cylinder.with_values(f"parts.0.material={SOFT}")
    check(design, targets, ["parts.0.material.young", "loads.0.value"])


def block(**changes):
    """A bar with everything that a derivative may meet; 3 x 2 x 2 voxels."""
    return Design.from_document(
        {
            "name": "bar",
            "voxel_size": "5 mm",
            "parameters": {"pull": "1 mm", "E": "40 kPa", "weight": {"value": "0 m/s^2"}},
            "shapes": {"body": {"kind": "box", "size": ["15 mm", "10 mm", "10 mm"]}},
            "parts": [
                {"shape": "body", "material": {"model": "neo-hookean", "young": "= 2*E"}},
            ],
            "clamps": [{"region": {"x": [0, 0]}}],
            "loads": [{"kind": "gravity", "value": "9.81 m/s^2"}],
            "probes": {"end": {"x": ["15 mm", "15 mm"]}, "point": {"point": ["= 10*pull", 0, 0]}},
            **changes,
        }
    )


def test_parameters_pass_through_formulas():
    tip = {"tip": Objective(maximize="displacement", probe="end")}
    check(block(), tip, ["E"])


def test_a_moved_probe_measures_another_place():
    """The point moves along the bar, whose body stays: an explicit derivative only."""
    tip = {"tip": Objective(maximize="displacement", probe="point", axis="z")}
    check(block(parameters={"pull": "0.83 mm", "E": "40 kPa"}), tip, ["pull"])


def test_prescribed_motion_moves_the_clamped_vertices_too():
    moving = [
        {"region": {"x": [0, 0]}},
        {
            "region": {"x": ["15 mm", "15 mm"]},
            "motion": {
                "displacement": ["= pull", 0, 0],
                "rotation": {"axis": [1, 0.2, 0], "angle": "20 deg", "center": [0, 0, "2 mm"]},
            },
        },
    ]
    targets = {
        "middle": Objective(maximize="displacement", probe="end", axis="x"),
        "point": Objective(maximize="displacement", probe="point"),
        "energy": Objective(maximize="elastic_energy"),
        # Not the largest stretch: it stands at a kink here, where edges trade places.
    }
    turn = {
        "turn": Objective(maximize="rotation", probe="end"),
        "about": Objective(maximize="rotation", probe="end", axis="x"),
        "aside": Objective(maximize="rotation", probe="end", axis="y"),
    }
    angle = "clamps.1.motion.rotation.angle"
    probes = {"end": {"x": ["15 mm", "15 mm"]}, "point": {"point": ["7 mm", "2 mm", "3 mm"]}}
    design = block(clamps=moving, probes=probes)
    check(design, targets | turn, [angle])
    check(design, targets, ["pull"])
    # The held end does not depend on the material.
    check(design, {key: targets[key] for key in ("point", "energy")}, ["E"])


def test_two_materials_in_one_body():
    """A stiff skin on a soft bar, of two laws: each constant by the adjoint of the whole."""
    parts = [
        {
            "shape": {"kind": "box", "size": ["30 mm", "10 mm", "5 mm"], "corner": [0, 0, "5 mm"]},
            "material": {"model": "yeoh", "c": ["40 kPa", "4 kPa"], "poisson": 0.45},
        },
        {"shape": "body", "material": {"model": "neo-hookean", "young": "= E", "poisson": 0.499}},
    ]
    bar = block(
        shapes={"body": {"kind": "box", "size": ["30 mm", "10 mm", "10 mm"]}},
        parts=parts,
        probes={
            "end": {"x": ["30 mm", "30 mm"]},
            "point": {"point": ["30 mm", "10 mm", "5 mm"]},
        },
    )
    targets = {
        "sag": Objective(maximize="displacement", probe="end", axis="z"),
        # On the seam, where elements of both materials meet.
        "seam": Objective(maximize="displacement", probe="point", axis="x"),
        "turn": Objective(maximize="rotation", probe="end"),
        "energy": Objective(maximize="elastic_energy"),
    }
    lines = {
        f"{metric}{axis or ''}": Objective(maximize=metric, probe="end", base="point", axis=axis)
        for metric in ("chord_angle", "curvature")
        for axis in (None, "x")
    }
    targets |= lines
    constants = ["parts.0.material.c.0", "parts.0.material.c.1", "parts.1.material.poisson"]
    check(bar, targets, ["E", *constants, "parts.0.material.density", "loads.0.value"])


def test_springs_beside_rubber():
    """The lattice and the hyperelastic voxel share vertices, and so one tangent."""
    half = {"kind": "box", "size": ["10 mm", "10 mm", "10 mm"]}
    bar = block(
        shapes={"body": {"kind": "box", "size": ["20 mm", "10 mm", "10 mm"]}},
        parts=[
            {"shape": half, "material": {"model": "lattice", "edge": "= E", "bulk": "90 kPa"}},
            {"shape": "body", "material": {"model": "neo-hookean", "young": "60 kPa"}},
        ],
        probes={"end": {"x": ["20 mm", "20 mm"]}, "point": {"point": ["12 mm", 0, 0]}},
    )
    tip = {"sag": Objective(maximize="displacement", probe="end", axis="z")}
    check(bar, tip, ["E", "parts.0.material.bulk", "parts.1.material.young"])


def test_forces_and_a_pressure_on_an_open_surface():
    """The pressure turns with the face: the tangent is not symmetric, and the sum changes."""
    loads = [
        {"kind": "traction", "region": {"x": ["15 mm", "15 mm"]}, "value": "-900 Pa"},
        {"kind": "force", "region": {"x": ["15 mm", "15 mm"]}, "value": [0, "20 mN", "-30 mN"]},
    ]
    targets = {
        "turn": Objective(maximize="rotation", probe="end"),
        "support": Objective(maximize="reaction"),
        "along": Objective(maximize="reaction", axis="z"),
    }
    check(block(loads=loads), targets, ["E", "loads.0.value", "loads.1.value.2"])


def test_a_body_on_a_floor():
    floor = block(
        floor={"z": 0},
        clamps=[{"region": {"x": [0, 0]}, "axes": "x"}, {"region": {"y": [0, 0]}, "axes": "y"}],
    )
    targets = {
        "squeeze": Objective(maximize="max_displacement"),
        "support": Objective(maximize="reaction", axis="z"),
    }
    found = gradient(solved(floor), targets, ["loads.0.value"])
    expected = differences(floor, targets, "loads.0.value")
    for key in targets:
        assert found[key]["loads.0.value"] == pytest.approx(expected[key], rel=CLOSE)


def test_mass_and_a_number_that_is_zero():
    bar = block(loads=[{"kind": "gravity", "value": "= weight"}])
    targets = {
        "mass": Objective(maximize="mass"),
        "end": Objective(maximize="displacement", probe="end", axis="z"),
    }
    found = gradient(solved(bar), targets, ["weight", "parts.0.material.density"])
    volume = 15e-3 * 10e-3 * 10e-3
    bar_mass = 1070 * volume
    # Rounding of 1e-16 over a step of 5e-6.
    assert found["mass"]["parts.0.material.density"] == pytest.approx(volume, rel=1e-9)
    assert abs(found["mass"]["weight"]) < 1e-9 * bar_mass
    check(bar, {"end": targets["end"]}, ["weight"])


#: Metrics of contact have slopes along the path: tests/verification/test_contact_gradient.py.
WITHOUT_CONTACT = sorted(
    name for name in BUILT_IN if METRICS[name].slope and "object" not in METRICS[name].needs
)


@pytest.mark.parametrize("name", WITHOUT_CONTACT)
def test_slopes_of_metrics_are_their_derivatives(name):
    """At any positions, not only in equilibrium, along a random direction."""
    pressed = families.cylinder(radius="15 mm", height="20 mm").with_values(
        f"parts.0.material={SOFT}", "parts.0.material.tested_stretch.largest=1.5"
    )
    loads = [{"kind": "traction", "region": {"z": ["20 mm", "20 mm"]}, "value": "500 Pa"}]
    probes = {"top": {"z": ["20 mm", "20 mm"]}, "side": {"x": ["10 mm", "15 mm"]}}
    changes = {"loads": loads, "probes": probes}
    setup = Setup.of(Design.from_document({**pressed.document, **changes}))
    random = np.random.default_rng(3)
    rest = setup.mesh.vertices
    turned = rest @ np.linalg.qr(random.normal(size=(3, 3)))[0]
    turned = turned * np.sign(np.linalg.det(np.linalg.lstsq(rest, turned, rcond=None)[0]))
    positions = turned + 2e-4 * random.normal(size=rest.shape)
    way, step = random.normal(size=rest.shape), 1e-7
    metric = METRICS[name]
    for axis in [None, "y"] if "axis" in metric.takes else [None]:
        target = Objective(maximize=name, axis=axis, probe="top", base="side")
        along = float(np.vdot(metric.slope(LoadedState(setup, positions), target), way))
        high, low = (
            metric.value(LoadedState(setup, positions + sign * step * way), target)
            for sign in (1, -1)
        )
        # Rounding of a number of its own size, over the step.
        size = abs(high) / step * 1e-12 + 1e-30
        assert along == pytest.approx((high - low) / (2 * step), rel=1e-5, abs=size)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("radius", "changes the shape.*fraction"),
        ("shapes.outer.radius", "changes the shape.*fraction"),
        ("radios", "neither a parameter.*did you mean"),
        ("loads.0.valve", "did you mean"),
        ("loads.3.value", "count from 0"),
        ("loads.0.kind", "not a number"),
        ("parts.0.material.model", "not a number"),
        ("loads.0.cavity", "not a number"),
    ],
)
def test_numbers_without_a_derivative(name, words):
    cylinder = families.cylinder(radius="15 mm", height="20 mm").replace(fill="binary")
    result = solved(cylinder.with_values(f"parts.0.material={SOFT}"))
    with pytest.raises(DesignError, match=words):
        gradient(result, "rise", name)


def test_a_count_has_no_derivative():
    ring = {"kind": "array", "of": "cell", "count": ["= cells", 1, 1], "spacing": ["5 mm", 0, 0]}
    bar = block(
        parameters={"cells": 3, "E": "40 kPa", "pull": "1 mm"},
        shapes={"cell": {"kind": "box", "size": ["5 mm", "10 mm", "10 mm"]}, "body": ring},
    )
    with pytest.raises(DesignError, match=r"cells: cannot be varied.*no count"):
        gradient(solved(bar), "elastic_energy", "cells")


def test_unknown_targets():
    result = solved(block())
    with pytest.raises(DesignError, match=r'elastic_energi: is neither.*"elastic_energy"'):
        gradient(result, "elastic_energi", "E")
    with pytest.raises(DesignError, match="probe: is missing"):
        gradient(result, "displacement", "E")


def test_results_that_are_no_equilibrium():
    bar = block()
    with pytest.raises(SimulationError, match=r"comes from xpbd.*statics"):
        gradient(simulate(families.beam(length="40 mm"), method="xpbd"), "sag", "length")
    with pytest.raises(SimulationError, match=r"the residual is .*too much"):
        gradient(simulate(bar, method="statics", tolerance=1e-2), "elastic_energy", "E")
    cylinder = families.cylinder(radius="15 mm", height="20 mm")
    inflated = simulate(
        cylinder.with_values(f"parts.0.material={SOFT}"),
        control="volume",
        steps=1,
        volume_ratio=1.02,
    )
    assert inflated.load_factor != 1.0
    with pytest.raises(SimulationError, match="no equilibrium under the full loads"):
        gradient(inflated, "elastic_energy", "loads.0.value")
    with pytest.raises(SimulationError, match="not stable"):
        gradient(dataclasses.replace(solved(bar), stable=False), "elastic_energy", "E")


def test_a_replaced_design_is_differentiated_as_it_is():
    """Loads that come twice are loads twice as large, for the slopes as well."""
    bar = block()
    doubled = bar.replace(loads=(*bar.loads, *bar.loads))
    slope = gradient(solved(doubled), "elastic_energy", "E")["elastic_energy"]["E"]
    scaled = bar.replace(loads=[each.replace(value=_twice(each.value)) for each in bar.loads])
    expected = gradient(solved(scaled), "elastic_energy", "E")["elastic_energy"]["E"]
    assert slope == pytest.approx(expected, rel=1e-6)


def _twice(value):
    return 2 * value if isinstance(value, float) else tuple(2 * each for each in value)
