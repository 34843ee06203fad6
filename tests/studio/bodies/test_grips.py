"""Verdict on the grip of free objects at the end of a run, in the words of the page."""

from pathlib import Path

import pytest

import voxsoft as vs
from voxsoft.design import Floor, Object
from voxsoft.studio.bodies.equilibrium import equilibrium_of
from voxsoft.studio.bodies.grips import grips_of

PINCH = vs.load(Path(__file__).parents[3] / "examples" / "pinch.toml")
#: The plate hangs with its lower edge at -10 mm; it is 45 g heavy.
FLOOR = Floor(z="-10.02 mm")
WEIGHT = 0.045 * 9.81


def pinched(end_time=0.2, **changes):
    solver = PINCH.solver.model_copy(update={"end_time": end_time})
    return vs.simulate(PINCH.replace(solver=solver, **changes))


@pytest.mark.slow
def test_objects_carried_by_friction_alone_are_held():
    result = pinched()
    (grip,) = grips_of(result)
    assert (grip.name, grip.verdict) == ("plate", "held")
    assert grip.weight == pytest.approx(WEIGHT)
    assert grip.pressed == result.metric("grip_force", object="plate")
    assert grip.margin == pytest.approx(result.metric("hold_margin", object="plate"))
    assert "weight 0.441 N" in grip.sentence
    assert "Friction could carry" in grip.sentence
    # It was not lifted, and nothing says so.
    assert "above" not in grip.sentence
    assert equilibrium_of(result, 1, 1).grips == [grip]


def test_an_object_on_the_floor_between_smooth_pads_is_touched():
    contact = PINCH.contact.model_copy(update={"friction": 0.0})
    (grip,) = grips_of(pinched(contact=contact, floor=FLOOR))
    assert grip.verdict == "touched"
    assert grip.margin is None
    assert "still stands" in grip.sentence


def test_an_unpressed_object_is_lost():
    clamps = [clamp.model_copy(update={"motion": None}) for clamp in PINCH.clamps]
    lost = pinched(clamps=clamps, floor=FLOOR)
    (grip,) = grips_of(lost)
    assert (grip.verdict, grip.pressed, grip.margin) == ("lost", 0.0, None)
    assert grip.sentence == "plate: not held."
    # The floor does not grip an object on it: a study would else drop the object it should hold.
    assert lost.metric("grip_force", object="plate") == 0.0
    assert lost.metric("hold_margin", object="plate") == 0.0


@pytest.mark.slow
def test_a_body_lifted_by_its_clamps_is_held_above_its_start():
    clamps = []
    for clamp in PINCH.clamps:
        x, _, _ = clamp.motion.displacement
        # The pads touch after a fifth of the way, and take the plate of 20 mm along from there.
        motion = clamp.motion.model_copy(update={"displacement": (x, 0.0, 4e-3)})
        clamps.append(clamp.model_copy(update={"motion": motion}))
    (grip,) = grips_of(pinched(clamps=clamps, loads=[]))
    assert (grip.verdict, grip.weight) == ("held", None)
    assert 2e-3 < grip.rise < 4e-3
    assert "mm above where it began" in grip.sentence


def test_without_free_objects_there_is_nothing_to_say():
    fixed = [Object(name="plate", shape="plate")]
    assert grips_of(pinched(0.02, objects=fixed)) == []
