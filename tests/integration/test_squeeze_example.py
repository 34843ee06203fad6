"""The example that is squeezed: its leaves bear on each other, and not without contact."""

import pytest

import voxsoft as vs
from voxsoft.units import mm


def squeezed(way, **changes):
    design = vs.load("examples/squeeze.toml").with_parameters(squeeze=way)
    result = vs.simulate(design.replace(**changes))
    assert result.status == "ok"
    return result


def forces(result):
    """The upright force of the plate, and the pressure forces of the leaves on each other, in N."""
    pressed = {contact.of: contact.pressed for contact in result.contacts}
    (plate,) = [each for each in result.contacts if each.of == ("body", "plate")]
    return abs(plate.force[2]), pressed.get(("body", "body"), 0.0)


@pytest.mark.slow
def test_leaves_that_meet_bear_on_each_other():
    result = squeezed(8 * mm)
    force, between = forces(result)
    assert between > 0.1
    assert not result.penetration.overlaps
    assert not result.warnings
    # What the plate pushes down the clamp pushes up: both are of one equilibrium, found to 1e-4 of
    # the forces that act, of which the leaves' are the largest.
    assert force == pytest.approx(abs(result.reactions[:, 2].sum()), abs=1e-3 * max(force, between))


@pytest.mark.slow
def test_it_is_soft_until_it_is_solid():
    soft, solid = squeezed(8 * mm), squeezed(13 * mm)
    assert not solid.penetration.overlaps
    assert not solid.warnings
    # 0.23 and 8.3 N: leaves on each other are many times as stiff as leaves that bend.
    assert forces(solid)[0] > 20 * forces(soft)[0]
    pairs = [
        {"of": ["body", "plate"], "kind": "bonded"},
        {"of": ["body", "body"], "kind": "none"},
    ]
    through = squeezed(13 * mm, contact={"pairs": pairs})
    assert any("overlap" in str(warning) for warning in through.warnings)
    assert forces(through)[0] < 0.1 * forces(solid)[0]
