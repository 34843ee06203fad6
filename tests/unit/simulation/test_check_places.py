"""Findings of a check have a subject, and a place on the body."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import families
from voxsoft.simulation import check
from voxsoft.voxels import Voxels


def body(*cells, shape=(6, 6, 6)):
    """Voxels of 10 mm at an origin that is not zero."""
    filled = np.zeros(shape, dtype=np.uint8)
    for cell in cells:
        filled[cell] = 1
    return Voxels.from_array(filled, voxel_size=0.01, origin=(0.1, 0.0, -0.02))


def found(voxels, words):
    """The findings that say some words."""
    return [finding for finding in check(voxels).findings if words in finding.what]


def test_a_hinge_is_where_its_cells_touch():
    (hinge,) = found(body((0, 0, 0), (1, 1, 0)), "hinge")
    # Both cells have the corner (0.11, 0.01) of the grid in common, in the middle of their height.
    assert hinge.at == pytest.approx((0.11, 0.01, -0.015))
    assert "near (110, 10, -15) mm" in hinge.what


def test_a_piece_that_hangs_on_nothing_is_where_the_smaller_one_is():
    (components,) = found(body((0, 0, 0), (1, 0, 0), (5, 5, 5)), "components")
    assert components.at == pytest.approx((0.155, 0.055, 0.035))


@pytest.mark.parametrize("held", ["both", "one"])
def test_fingers_that_are_clamped_each_hang_on_something(held):
    fingers = vs.Box(size=(0.02, 0.02, 0.06)) | vs.Box(size=(0.02, 0.02, 0.06), corner=(0.05, 0, 0))
    region = vs.Region(z=(0, 0)) if held == "both" else vs.Region(x=(0, 0.04), z=(-0.03, -0.03))
    design = vs.Design(
        name="fingers",
        voxel_size=0.01,
        parts=[vs.Part(shape=fingers, material=vs.NeoHookean(young=1e5, poisson=0.45))],
        clamps=[vs.Clamp(region=region)],
        loads=[vs.Gravity()],
    )
    warned = [one for one in check(design).findings if "components" in one.what]
    assert bool(warned) == (held == "one")


def test_a_thin_wall_and_a_leak_are_where_they_are():
    filled = np.ones((6, 6, 6), dtype=np.uint8)
    filled[2:4, 2:4, 1:4] = 0  # under it one voxel is left
    voxels = Voxels.from_array(filled, voxel_size=0.01)
    (wall,) = found(voxels, "1 voxel thick")
    assert 0.0 < wall.at[2] < 0.01
    assert 0.02 < wall.at[0] < 0.04
    filled[2, 2, 0] = 0
    (leak,) = found(Voxels.from_array(filled, voxel_size=0.01), "open through")
    assert leak.at == pytest.approx((0.025, 0.025, 0.005))


@pytest.mark.parametrize(
    ("change", "where", "at"),
    [
        ("probes.top.z=['1 m', '1 m']", "probes.top", (None, None, 1.0)),
        ("clamps[0].region.z=['1 m', '2 m']", "clamps[0].region", (None, None, 1.0)),
        ("clamps[0].region.z=['1 m', 'inf']", "clamps[0].region", (None, None, 1.0)),
    ],
)
def test_a_pair_without_contact_is_named_with_the_searched_place(change, where, at):
    design = families.cylinder().with_values(change)
    (finding,) = [one for one in check(design).findings if "touches nothing" in one.what]
    assert finding.where == where
    for axis, due in enumerate(at):
        if due is not None:
            assert finding.at[axis] == pytest.approx(due)
    assert np.isfinite(finding.at).all()


def test_a_place_is_part_of_the_plain_data():
    (hinge,) = found(body((0, 0, 0), (1, 1, 0)), "hinge")
    assert hinge.summary()["at"] == pytest.approx([0.11, 0.01, -0.015])
    assert vs.check(families.beam()).valid
