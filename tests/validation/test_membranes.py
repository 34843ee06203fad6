"""Membranes that lift weights: the force on the disc, and how pressures are found and compared."""

import importlib
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, least_squares

import voxsoft as vs
from voxsoft.units import mm

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def membranes():
    sys.path.insert(0, str(ROOT / "evidence"))
    try:
        return importlib.import_module("membranes")
    finally:
        sys.path.remove(str(ROOT / "evidence"))


def tensions(along, around):
    """Engineering stresses in Pa of the card `ecoflex-00-30-epfl`, incompressible, in a sheet."""
    across = 1.0 / (along * around)
    terms = list(
        zip((24361.0418, 66.7032, 453.81), (1.7137766, 7.0678724, -3.3658807), strict=True)
    )
    return [
        sum(2.0 * mu / alpha * (stretch**alpha - across**alpha) for mu, alpha in terms) / stretch
        for stretch in (along, around)
    ]


def by_membrane_theory(height, pressure, disc, rim, thickness):
    """The force on the disc in N: a sheet without bending, by shooting from the disc to the rim.

    Equilibrium of an axisymmetric membrane: of the part within r, along the axis,
    2π h R T sin θ = F − π p r²; of a ring, across it, d(h R T cos θ)/dR = h T_around + p r dz/dR.
    """

    def slopes(radius, state, force):
        r, _, across = state
        along = (force - np.pi * pressure * r * r) / (2.0 * np.pi)
        pull = np.hypot(across, along)
        around = r / radius
        wanted = pull / (radius * thickness)
        stretch = brentq(lambda each: tensions(each, around)[0] - wanted, 0.3, 12.0)
        dr, dz = stretch * across / pull, stretch * along / pull
        return [dr, dz, thickness * tensions(stretch, around)[1] + pressure * r * dz]

    def missed(guess):
        start = [disc, 0.0, guess[1]]
        end = solve_ivp(slopes, (disc, rim), start, args=(guess[0],), rtol=1e-6, atol=1e-9).y[:, -1]
        return [(end[0] - rim) / rim, (-end[1] - height) / rim]

    found = least_squares(missed, [15.0, 0.8], diff_step=1e-4)
    assert found.cost < 1e-10
    return float(found.x[0])


@pytest.mark.slow
def test_the_force_on_the_disc_is_that_of_membrane_theory(membranes):
    """Voxels of 2 mm have 14.77 N; theory, without bending, some 14.8 N.

    Stairs at both rims and Poisson's ratio of the card, 0.48, are what differs: 1 % of the force.
    """
    plain = membranes.MEMBRANES[0]
    # As low as this the membrane's weight is a pressure from above: it slopes by less than 0.4.
    weight = 1070.0 * 9.81 * plain.thickness
    theory = by_membrane_theory(10 * mm, 2200.0 - weight, plain.disc, 70 * mm, plain.thickness)
    lifted = membranes.Lifted(plain, membranes.VARIANTS[0], 10 * mm)
    assert lifted.force(2200.0) == pytest.approx(theory, rel=0.01)


def test_a_pressure_is_found_by_secants(membranes):
    lifted = membranes.Lifted(membranes.MEMBRANES[0], membranes.VARIANTS[0], 10 * mm)
    asked = []

    def force(pressure):
        asked.append(pressure)
        return 4.0e-3 * pressure + 1.0e-6 * pressure**2

    lifted.force = force
    # The last secant leaves the product of how far its ends are off, 5 % and up to a quarter, times
    # the curvature, a quarter of the slope over the pressure: 0.3 %.
    assert force(lifted.pressure(14.72, 1800.0)) == pytest.approx(14.72, rel=5e-3)
    assert len(asked) <= 4
    lifted.force = lambda pressure: float("nan")
    assert np.isnan(lifted.pressure(14.72, 1800.0))


@pytest.mark.parametrize(
    ("measured", "off"),
    [
        # 1500 Pa are half-way between 10 and 30 mm, twice the measured 10 mm. 2500 Pa are above the
        # whole curve: 50 mm or more in place of 30.
        ((1500.0, 2500.0, 2600.0), [1.0, 2.0 / 3.0]),
        # 900 Pa are below it: less than 10 mm in place of 30.
        ((800.0, 900.0, 2600.0), [0.0, 2.0 / 3.0]),
    ],
)
def test_heights_are_read_where_the_pressure_rises(membranes, measured, off):
    heights = (10 * mm, 30 * mm, 50 * mm)
    real = dict(zip((("plain", 1.0, each) for each in heights), measured, strict=True))
    found = dict(zip(((1.0, each) for each in heights), (1000.0, 2000.0, 2400.0), strict=True))
    assert membranes.heights_off(found, real, "plain") == pytest.approx(off)


def test_rings_lie_at_their_radii():
    setup = vs.simulation.Setup.of(vs.load(ROOT / "examples/validation/membrane.toml"))
    for layer, middle in zip(setup.layers, (49 * mm, 62 * mm), strict=True):
        radius = np.hypot(*setup.mesh.vertices[np.unique(layer.bonded), :2].T)
        # A region takes in vertices within half a voxel, 1 mm; rings are 5 mm to either side.
        assert radius.min() == pytest.approx(middle - 5 * mm, abs=1.1 * mm)
        assert radius.max() == pytest.approx(middle + 5 * mm, abs=1.1 * mm)
