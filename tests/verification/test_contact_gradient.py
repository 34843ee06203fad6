"""Gradients where something touches, against central differences of whole solutions."""

import pytest
from pressed import slit

from voxsoft import Objective, gradient, simulate
from voxsoft.design import Design
from voxsoft.design.contact import Contact
from voxsoft.design.variation import number_of, with_number
from voxsoft.errors import SimulationError

# Contact is then off by 1e-4 of what it may be off by default, which is 1e-3 voxels: 4e-10 m.
TOLERANCE = 1e-12
# Moves what presses by some 1e-6 m, so that contact leaves 1e-4 of a difference at most. Of second
# order: 1e-6 times the curvature of laws that are nearly linear over so little.
STEP = 1e-3
CLOSE = 1e-4

FORCE = Objective(maximize="contact_force", object="plate")
ENERGY = Objective(maximize="elastic_energy")
PLATE = {"kind": "box", "size": ["20 mm", "20 mm", "4 mm"], "center": ["4.3 mm", "3.9 mm", "10 mm"]}
BALL = {"kind": "sphere", "radius": "30 mm", "center": ["6.3 mm", "5.9 mm", "42.35 mm"]}


def pressed(shape, friction, sideways="0.1 mm", size="8 mm", depth="-1 mm"):
    """A block of cubic voxels under a rigid thing that comes down on it."""
    return Design.from_document(
        {
            "name": "pressed",
            "voxel_size": "4 mm",
            "parameters": {"depth": depth, "E": "100 kPa"},
            "shapes": {"body": {"kind": "box", "size": [size] * 3}, "plate": shape},
            "parts": [
                {
                    "shape": "body",
                    "material": {"model": "neo-hookean", "young": "= E", "poisson": 0.45},
                }
            ],
            "clamps": [{"region": {"z": [0, 0]}}],
            "loads": [{"kind": "force", "region": {"x": [size, size]}, "value": ["20 mN", 0, 0]}],
            "probes": {"side": {"x": [size, size]}},
            "objects": [
                {
                    "name": "plate",
                    "shape": "plate",
                    "motion": {"displacement": [sideways, 0, "= depth"]},
                }
            ],
            "contact": {"friction": friction},
        }
    )


def solved(design):
    result = simulate(design, method="statics", tolerance=TOLERANCE)
    assert result.status == "ok", result.message
    return result


def check(design, targets, names):
    found = gradient(solved(design), targets, names)
    for name in names:
        value = number_of(design, name)
        step = STEP * abs(value)
        high, low = (solved(with_number(design, name, value + way * step)) for way in (1, -1))
        for key, target in targets.items():
            ends = [
                each.metric(
                    target.metric, probe=target.probe, axis=target.axis, object=target.object
                )
                for each in (high, low)
            ]
            expected = (ends[0] - ends[1]) / (2 * step)
            assert found[key][name] == pytest.approx(expected, rel=CLOSE), (key, name)


SIDE = Objective(maximize="displacement", probe="side", axis="x")


def test_a_plate_without_friction():
    targets = {"force": FORCE, "energy": ENERGY}
    check(pressed(PLATE, 0.0), targets, ["E", "depth"])
    check(pressed(PLATE, 0.0), {"side": SIDE}, ["depth", "loads.0.value.0"])


@pytest.mark.slow
def test_a_plate_that_sticks():
    design = pressed(PLATE, 0.9)
    check(design, {"force": FORCE, "energy": ENERGY}, ["E", "depth"])
    sideways = "objects.0.motion.displacement.0"
    along = Objective(maximize="contact_force", object="plate", axis="x")
    check(design, {"side": SIDE, "along": along}, [sideways])


@pytest.mark.slow
def test_a_ball_without_friction():
    design = pressed(BALL, 0.0, sideways="0.3 mm", size="12 mm", depth="-1.5 mm")
    check(design, {"force": FORCE, "energy": ENERGY}, ["E", "depth"])


@pytest.mark.long
def test_slip_or_new_contact_with_friction_is_refused():
    slipping = pressed(PLATE, 0.1, sideways="1 mm")
    with pytest.raises(SimulationError, match="surfaces slip on the way under"):
        gradient(simulate(slipping, method="statics"), {"force": FORCE}, "E")
    apart = pressed({**PLATE, "center": ["4.3 mm", "3.9 mm", "10.34 mm"]}, 0.9)
    with pytest.raises(SimulationError, match="came into contact under way"):
        gradient(simulate(apart, method="statics"), {"force": FORCE}, "depth")


def test_friction_at_a_loose_tolerance_is_refused():
    """Anchors then depend on the rest of an iteration, and slopes were off by a third."""
    result = simulate(pressed(PLATE, 0.9), method="statics")
    with pytest.raises(SimulationError, match="too much for a derivative with friction"):
        gradient(result, {"force": FORCE}, "E")


def test_self_contact_is_refused():
    result = simulate(slit(contact=Contact()), method="statics")
    with pytest.raises(SimulationError, match="the body presses itself"):
        gradient(result, {"energy": ENERGY}, "parts.0.material.young")


def test_motion_that_moves_nothing_has_no_slope():
    """A plate without friction slides over the block: the rest of its slope is rounding."""
    name = "objects.0.motion.displacement.0"
    found = gradient(solved(pressed(PLATE, 0.0)), {"side": SIDE}, name)
    assert abs(found["side"][name]) < CLOSE


def test_areas_and_surfaces_that_change_in_jumps_are_refused():
    design = pressed(PLATE, 0.0)
    result = simulate(design, method="statics")
    area = Objective(maximize="contact_area", object="plate")
    with pytest.raises(SimulationError, match="contact_area: has no derivative"):
        gradient(result, {"area": area}, "E")


def test_a_gap_without_contact():
    """It closes as the plate comes down, less by the way of the corner under the force."""
    plate = {**PLATE, "center": ["4.3 mm", "3.9 mm", "13 mm"]}
    gap = {"gap": Objective(maximize="contact_gap", object="plate")}
    found = gradient(solved(pressed(plate, 0.0)), gap, "depth")
    assert found["gap"]["depth"] == pytest.approx(1.0, rel=1e-9)
