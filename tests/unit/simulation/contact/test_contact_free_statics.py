"""Free objects and bodies without clamps in equilibrium: where they rest, or that they do not."""

import json

import numpy as np
import pytest
from gripped import GRAVITY, bar, dropped, pinched
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import Contact, Floor, Object, Solver
from voxsoft.errors import DesignError
from voxsoft.files import save
from voxsoft.simulation import simulate
from voxsoft.units import kPa, mm

SOFT = vs.NeoHookean(young=100 * kPa, poisson=0.45, density=1000)


def statics(design):
    return simulate(design, method="statics")


def test_a_ball_that_starts_above_a_pad_comes_to_lie_on_it():
    found = statics(dropped())
    assert (found.status, found.stable) == ("ok", True)
    assert found.residual < 1e-7
    (contact,) = found.contacts
    assert contact.force == pytest.approx((0.0, 0.0, -0.01 * GRAVITY), abs=1e-7 * GRAVITY)
    assert contact.gap > 0.0
    # Motion over time ends there too, but for where it rolled to on the way.
    moved = simulate(dropped(), method="dynamics", time_step=0.01)
    height = moved.objects["ball"].position[2]
    assert found.objects["ball"].position[2] == pytest.approx(height, abs=1e-3 * mm)


def test_a_gripped_object_is_held_by_friction():
    held = statics(pinched(0.7, objects=[bar(40 * mm)]))
    assert held.status == "ok"
    (contact,) = held.contacts
    assert contact.force[2] == pytest.approx(-0.045 * GRAVITY, rel=1e-6)
    # Faces along the weight: friction carries it, and its bound is that of the pressure on them.
    assert contact.friction[2] == pytest.approx(-0.045 * GRAVITY, rel=1e-4)
    assert contact.bound == pytest.approx(0.7 * contact.pressure, rel=1e-9)
    margin = held.metric("hold_margin", object="block")
    assert margin == pytest.approx(0.7 * contact.pressure / (0.045 * GRAVITY), rel=1e-4)
    assert held.metric("grip_force", object="block") == contact.pressure
    assert contact.summary()["friction_bound"] == contact.bound


@pytest.mark.slow  # sliding out of a grip takes long; the core's tests have a quick one
def test_a_grip_lets_go_at_its_margin():
    near = statics(pinched(0.02, objects=[bar(40 * mm)]))
    least = 0.02 / near.metric("hold_margin", object="block")
    held = statics(pinched(1.03 * least, objects=[bar(40 * mm)]))
    assert held.status == "ok"
    # Bounds are right to 0.3 %, and the pads press a little less where they are free to bulge.
    assert held.metric("hold_margin", object="block") == pytest.approx(1.03, abs=0.01)
    fallen = statics(pinched(0.97 * least, objects=[bar(40 * mm)]))
    assert fallen.status == "not-at-rest"
    assert 'the object "block" falls or slides away' in fallen.message


def test_an_unheld_object_is_named_and_exits_with_4(tmp_path):
    stone = Object(
        name="stone",
        shape=vs.Sphere(radius=6 * mm, center=(60 * mm, 10 * mm, 20 * mm)),
        motion="free",
        mass="1 g",
        voxel_size=3 * mm,
    )
    save(dropped(objects=[stone], solver=Solver(method="statics")), tmp_path / "stone.toml")
    command = ["run", str(tmp_path / "stone.toml"), "--json"]
    ended = CliRunner().invoke(app, command)
    assert ended.exit_code == 4, ended.output
    summary = json.loads(ended.stdout)
    assert summary["status"] == "not-at-rest"
    assert 'the object "stone" falls or slides away' in summary["message"]
    assert "it was last at (60.0, 10.0, -" in summary["message"]


def test_a_body_without_clamps_lies_on_a_floor_or_an_object():
    ground = Object(
        name="ground",
        shape=vs.Box(size=(60 * mm, 60 * mm, 6 * mm), center=(10 * mm, 10 * mm, -4 * mm)),
        voxel_size=6 * mm,
    )
    weight = 20 * mm * 20 * mm * 8 * mm * 1000 * GRAVITY
    for where in ({"floor": Floor(z=-1 * mm), "objects": []}, {"objects": [ground]}):
        lying = statics(dropped(clamps=[], **where))
        assert lying.status == "ok", lying.message
        (contact,) = lying.contacts
        assert contact.force[2] == pytest.approx(weight, rel=1e-6)
        assert lying.probes["top"][2] == pytest.approx(-1 * mm, abs=0.05 * mm)


def test_a_body_that_nothing_holds_is_named():
    aside = Object(
        name="post",
        shape=vs.Box(size=(8 * mm, 8 * mm, 8 * mm), center=(60 * mm, 0, 0)),
    )
    fallen = statics(dropped(clamps=[], objects=[aside]))
    assert fallen.status == "not-at-rest"
    assert fallen.message.startswith("the body falls or slides away")
    with pytest.raises(DesignError, match="nothing holds the body"):
        statics(dropped(clamps=[], objects=[], contact=Contact()))


def test_a_balanced_object_is_called_unstable():
    # A traced ball on a rigid table stands on a vertex.
    table = Object(
        name="table",
        shape=vs.Box(size=(20 * mm, 20 * mm, 4 * mm), center=(10 * mm, 10 * mm, 30 * mm)),
    )
    ball = Object(
        name="ball",
        shape=vs.Sphere(radius=6 * mm, center=(10 * mm, 10 * mm, 40 * mm)),
        motion="free",
        mass="10 g",
        voxel_size=3 * mm,
    )
    found = statics(dropped(objects=[table, ball], contact=Contact()))
    assert found.status == "ok", found.message
    assert found.stable is False
    assert "it is not stable" in found.message
    assert any("not stable" in warning.what for warning in found.warnings)
    (contact,) = (each for each in found.contacts if "ball" in each.of)
    assert contact.of == ("table", "ball")
    assert contact.force[2] == pytest.approx(-0.01 * GRAVITY, rel=1e-6)


@pytest.mark.slow  # it may tip over, which takes long
def test_a_pencil_on_its_tip_is_unstable_or_falls():
    pencil = Object(
        name="pencil",
        shape=vs.Capsule(
            start=(10 * mm, 10 * mm, 12 * mm), end=(10 * mm, 10 * mm, 40 * mm), radius=3 * mm
        ),
        motion="free",
        mass="10 g",
        voxel_size=2 * mm,
    )
    found = statics(dropped(objects=[pencil]))
    if found.status == "ok":
        assert found.stable is False
        assert "it is not stable" in found.message
        assert any("not stable" in warning.what for warning in found.warnings)
    else:
        assert "does not come to rest" in found.message or "falls" in found.message


@pytest.mark.slow  # it rolls through a hundred facets; the rows above are quicker
@pytest.mark.parametrize("friction", [0.02, 0.1])
def test_a_ball_goes_to_the_lowest_point_of_a_bowl(friction):
    block = vs.Box(size=(24 * mm, 24 * mm, 12 * mm), center=(0, 0, 6 * mm))
    bowl = block - vs.Sphere(radius=14 * mm, center=(0, 0, 20 * mm))
    ball = Object(
        name="ball",
        shape=vs.Sphere(radius=4 * mm, center=(4 * mm, 1 * mm, 14 * mm)),
        motion="free",
        mass="5 g",
        voxel_size=1.5 * mm,
    )
    design = vs.Design(
        name="bowl",
        voxel_size=3 * mm,
        parts=[vs.Part(shape=bowl, material=SOFT)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Gravity()],
        objects=[ball],
        contact=Contact(friction=friction),
    )
    found = statics(design)
    assert found.status == "ok", found.message
    x, y, _ = found.objects["ball"].position
    # Friction may hold it where the slope is its coefficient, for 10 mm between the radii.
    assert np.hypot(x, y) < friction * 10 * mm
