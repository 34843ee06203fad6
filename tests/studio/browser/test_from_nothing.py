"""Robots built from nothing by the mouse alone, with no text: how many actions it takes."""

import pytest
from hands import drawn, first_shape, renewed, saved

import voxsoft as vs

pytestmark = pytest.mark.browser


def test_a_chamber_from_nothing_to_rest_under_pressure(empty, tmp_path):
    tab, hand = empty
    first_shape(tab, hand, "box")
    tab.shot("nothing-1-box")
    renewed(tab, lambda: hand.press(name="What to do with box", then="Hollow it out"))
    hand.body()
    hand.here("here-clamp")
    hand.key("1")
    hand.key("x")
    hand.body(60, 40)
    tab.shot("nothing-2-wall")
    hand.here("here-fill")
    hand.key("r")
    tab.until("voxsoft.state === 'at-rest'")
    tab.shot("nothing-3-rest")
    design = saved(tab, tmp_path / "robot.toml")
    assert [load.kind for load in design.loads] == ["pressure"]
    result = vs.simulate(design)
    assert result.status == "ok"
    assert result.cavity_volumes[0] > 1.01 * result.mesh.cavities[0].volume
    # The aim of a first user: a dozen actions.
    assert hand.actions <= 12


def test_a_bending_finger_with_a_layer_from_nothing(empty, tmp_path):
    tab, hand = empty
    first_shape(tab, hand, "box")
    entry = tab.find("shapes-box")
    for axis, size in (("x", "100 mm"), ("z", "30 mm")):
        field = entry.get_by_label(f"Size {axis}", exact=True)
        renewed(tab, lambda field=field, size=size: hand.number(field, size))
    renewed(tab, lambda: hand.press(name="What to do with box", then="Hollow it out"))
    drawn(tab)
    for axis, side, verb in ((0, 1, "clamp"), (2, 1, "layer")):
        hand.face(axis, side)
        hand.here(f"here-{verb}")
    hand.key("3")  # from the left, at the free end
    hand.face(0, -1)
    hand.here("here-probe")
    hand.key("1")
    hand.key("x")
    hand.body(60, 20)
    hand.here("here-fill")
    hand.key("r")
    tab.until("voxsoft.state === 'at-rest'")
    tab.shot("finger-rest")
    design = saved(tab, tmp_path / "robot.toml")
    assert [layer.name for layer in design.layers] == ["fabric"]
    bent = vs.simulate(design)
    assert bent.status == "ok"
    # The top cannot stretch: the free end rises.
    assert bent.probes["probe"][2] > 1e-4
    assert hand.actions <= 25
