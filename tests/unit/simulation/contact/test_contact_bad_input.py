"""Objects unfit for their purpose: open meshes, and plates thinner than a step."""

import numpy as np
import pytest
import trimesh
from gripped import GRAVITY, bar, pinched
from pressed import pressed

import voxsoft as vs
from voxsoft.design import Contact, Object
from voxsoft.errors import DesignError
from voxsoft.simulation import simulate
from voxsoft.units import mm


def test_a_mesh_that_is_open_is_refused_with_the_place_of_its_hole(tmp_path):
    box = trimesh.creation.box((8.0, 8.0, 8.0))
    box.apply_translation((6.0, 6.0, 17.0))
    is_top = box.triangles_center[:, 2] > 20.9
    box.update_faces(~is_top)
    box.export(tmp_path / "open.stl")
    shape = {"kind": "mesh", "path": str(tmp_path / "open.stl"), "unit": "mm"}
    with pytest.raises(DesignError, match=r"objects\[0\]\.shape.*hole of 4 edges.*\(6, 6, 21\) mm"):
        simulate(pressed(objects=[{"name": "lid", "shape": shape}]))


@pytest.mark.parametrize("friction", [0.0, pytest.param(0.3, marks=pytest.mark.slow)])
def test_a_plate_thinner_than_a_step_does_not_pass_through(friction):
    # A millimeter thick, and it moves by three: without friction in one step.
    thin = Object(
        name="plate",
        shape=vs.Box(size=(14 * mm, 14 * mm, 1 * mm), center=(6 * mm, 6 * mm, 12.75 * mm)),
        motion=vs.Motion(displacement=(0, 0, -3 * mm)),
        voxel_size=1 * mm,
    )
    found = simulate(pressed(objects=[thin], contact=Contact(friction=friction)))
    assert found.status == "ok"
    (contact,) = [each for each in found.contacts if each.of == ("body", "plate")]
    assert contact.force[2] < 0.0
    assert contact.gap > 0.0
    assert found.positions[:, 2].max() < 9.9 * mm
    assert np.allclose(found.objects["plate"].position[2], 9.75 * mm, atol=1e-6 * mm)


@pytest.mark.slow
def test_a_plate_that_moves_through_the_body_is_not_let_through():
    through = Object(
        name="plate",
        shape=vs.Box(size=(14 * mm, 14 * mm, 2 * mm), center=(6 * mm, 6 * mm, 13.5 * mm)),
        motion=vs.Motion(displacement=(0, 0, -30 * mm)),
        voxel_size=2 * mm,
    )
    found = simulate(pressed(objects=[through]))
    assert found.status == "not-at-rest"
    assert found.load_factor < 0.5


@pytest.mark.long
def test_blocked_force_holds_an_object():
    found = simulate(pressed())
    (contact,) = found.contacts
    assert found.metric("blocked_force", object="plate", axis="z") == -contact.force[2] > 0.0
    assert found.metric("blocked_force") == pytest.approx(np.linalg.norm(contact.force))
    assert found.metric("grip_force") == contact.pressure
    assert found.metric("hold_margin") == 0.0  # without friction
    held = simulate(pinched(0.7, objects=[bar(40 * mm)]), method="statics")
    with pytest.raises(DesignError, match='"block" moves freely, and blocked_force asks'):
        held.metric("blocked_force")
    with pytest.raises(DesignError, match='"body" is no object, and grip_force asks how'):
        held.metric("grip_force", object="body")
    assert held.metric("grip_force") > 0.045 * GRAVITY
