"""A beam of Dragon Skin 10: one modulus from self weight, and its predictions.

Coarse elements of 5 mm keep this quick; `docs/validation.md` has the figures of 2.5 mm.
"""

import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def eth():
    sys.path.insert(0, str(ROOT / "examples" / "validation"))
    try:
        import eth_beam
    finally:
        sys.path.pop(0)
    return eth_beam


@pytest.fixture(scope="module")
def found(eth):
    return eth.outcome()


def test_self_weight_identifies_a_plausible_modulus(found):
    # The authors found 263.8 kPa with tetrahedra. 275.7 was seen, and 275.4 kPa with 2.5 mm.
    assert found.young == pytest.approx(264e3, rel=0.06)
    simulated, measured = found.sags["gravity"]
    assert simulated == pytest.approx(measured, rel=1e-3)  # the modulus is found to 0.02 %


def test_the_unseen_load_is_predicted(found):
    """-5.3 % was seen: short of the 3 % that were hoped for, and of one sign for all markers."""
    simulated, measured = found.sags["load52"]
    assert simulated == pytest.approx(measured, rel=0.06)


def test_the_frequencies_are_predicted(found):
    """-2.8 and -4.5 % were seen; the two runs are 0.04 Hz apart."""
    for simulated, swings in found.frequencies.values():
        real = np.mean([swing.frequency for swing in swings])
        assert simulated == pytest.approx(real, rel=0.05)


def test_the_lowest_mode_is_that_of_a_beam(eth):
    """Inverse iteration as above on a slender, light beam against Euler and Bernoulli.

    The section of 10 mm makes it slender: shear and the clamp change the frequency by 2 %.
    """
    import voxsoft as vs

    young, length, thick = 1e6, 0.1, 0.01
    design = vs.Design(
        name="slender",
        voxel_size=0.005,
        shapes={"bar": vs.Box(size=(length, thick, thick))},
        parts=(vs.Part(shape="bar", material=vs.NeoHookean(young=young, poisson=0.3)),),
        clamps=(vs.Clamp(region=vs.Region(x=(0, 0))),),
        loads=(vs.Gravity(value=1e-3),),
    )
    beam = eth.Setup.of(design)
    found = eth.frequency(beam, vs.simulate(beam), 0.0)
    exact = 1.8751**2 / (2 * np.pi) * np.sqrt(young * thick**2 / (12 * 1070 * length**4))
    assert found == pytest.approx(exact, rel=0.03)


def test_swings_are_read_from_a_known_oscillation(eth):
    time = np.arange(0.0, 3.0, 0.01)
    height = 4.0 * np.exp(-2.0 * time) * np.cos(2 * np.pi * 6.3 * time + 0.4)
    swing = eth.oscillation(time, height)
    assert swing.frequency == pytest.approx(6.3, rel=1e-6)
    assert swing.decay == pytest.approx(2.0, rel=1e-5)


@pytest.fixture(scope="module")
def swing(eth):
    sys.path.insert(0, str(ROOT / "examples" / "validation"))
    try:
        import eth_beam_swing
    finally:
        sys.path.pop(0)
    return eth_beam_swing


def test_the_weight_hangs_on_the_upper_edge(eth, swing):
    rubber = eth.vs.NeoHookean(young=260e3, poisson=0.499)
    bare, heavy = (eth.Setup.of(swing.loaded(mass, rubber)) for mass in (0.0, 0.052))
    assert heavy.problem.masses.sum() - bare.problem.masses.sum() == pytest.approx(0.052, rel=1e-9)
    first, other = (
        (each.problem.masses[:, None] * each.mesh.vertices).sum(axis=0) for each in (bare, heavy)
    )
    center = (other - first) / 0.052
    # The row outside is rubber where the beam has none: 3.2 g of 52 stand half a voxel off.
    assert center[0] == pytest.approx(0.0, abs=0.5e-3)
    assert center[1] == pytest.approx(15e-3, abs=1e-9)


@pytest.mark.slow
def test_the_decay_with_a_weight_is_predicted_from_that_without(eth, swing):
    """The share of one Prony branch is that which the script fits to the bare beam, 0.180.

    -7 % was seen with the weight, where the two runs are 13 % apart; Kelvin-Voigt damping, whose
    loss factor falls with the frequency, is 51 % short.
    """
    branch = swing.dampings([7.52, 4.13])[1]
    young = swing.coarse(269.3e3)
    decay, frequency = {}, {}
    for case, mass in eth.MASSES.items():
        found = eth.oscillation(*swing.released(mass, young, branch, 0.180))
        real = [each.decay for each in eth.swings(case)]
        decay[case] = found.decay / np.mean(real) - 1
        frequency[case] = found.frequency / np.mean([s.frequency for s in eth.swings(case)]) - 1
    assert abs(decay["gravity"]) < 0.02  # the fit stops at 0.5 %, of a share of three digits
    assert abs(decay["load52"]) < 0.13
    assert max(map(abs, frequency.values())) < 0.05  # +3.9 % and +0.5 % were seen
