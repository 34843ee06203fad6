"""Laws of hyperelastic models over random constants."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import voxsoft as vs
from voxsoft.materials import MODES, nominal_stress, nominal_tangent, stable_range
from voxsoft.materials.homogeneous import principal_stretches

MODULI = st.floats(1e3, 1e6)
SIGNED = st.floats(-0.4, 1.0)
EXPONENTS = st.floats(0.5, 8.0) | st.floats(-8.0, -0.5)
POISSON = st.floats(0.0, 0.4999)


@st.composite
def ogdens(draw):
    terms = draw(st.lists(st.tuples(MODULI, EXPONENTS), min_size=1, max_size=3))
    return vs.Ogden(mu=[mu for mu, _ in terms], alpha=[alpha for _, alpha in terms])


MATERIALS = st.one_of(
    st.builds(lambda e, nu: vs.NeoHookean(young=e, poisson=nu), MODULI, POISSON),
    st.builds(lambda c, r: vs.MooneyRivlin(c10=c, c01=c * r), MODULI, SIGNED),
    st.builds(lambda c, r, s: vs.Yeoh(c=[c, c * r / 10, c * s / 100]), MODULI, SIGNED, SIGNED),
    st.builds(lambda mu, jm: vs.Gent(shear=mu, jm=jm), MODULI, st.floats(30.0, 200.0)),
    ogdens(),
)
STRETCHES = st.floats(0.4, 3.0)
PULLED = {"uniaxial": 1, "equibiaxial": 2, "planar": 1}
LAWS = settings(max_examples=60, deadline=None)


@LAWS
@given(MATERIALS, STRETCHES, st.sampled_from(MODES))
def test_stress_is_the_derivative_of_the_energy(material, stretch, mode):
    """n P = dU/dλ and its tangent, by central differences of fourth order."""
    if isinstance(material, vs.Gent):  # whose derivatives grow without bound toward its limit
        assume(np.sum(principal_stretches(mode, stretch) ** 2) - 3.0 < 0.5 * material.jm)
    step = 2e-3 * stretch
    points = stretch + step * np.array([-2.0, -1.0, 1.0, 2.0])
    weights = np.array([1.0, -8.0, 8.0, -1.0]) / (12.0 * step)
    energies = material.energy(principal_stretches(mode, points))
    stresses = nominal_stress(material, points, mode)
    # The differences leave a relative error of order step⁴ α⁴/30 (a power α of at most 16 here:
    # 1e-6), of the largest number that is differenced.
    scale = np.abs(energies).max() / stretch + np.abs(stresses).max() + material.shear
    slope = weights @ energies / PULLED[mode]
    assert slope == pytest.approx(nominal_stress(material, stretch, mode), abs=1e-5 * scale)
    tangent = nominal_tangent(material, stretch, mode)
    assert weights @ stresses == pytest.approx(tangent, abs=1e-5 * (scale + abs(tangent)))


@LAWS
@given(MATERIALS, st.permutations(range(3)), STRETCHES, STRETCHES)
def test_gradient_and_hessian_belong_to_the_energy(material, order, first, second):
    stretches = np.array([first, second, 1.0 / (first * second)])[list(order)]
    if isinstance(material, vs.Gent):  # whose derivatives grow without bound toward its limit
        assume(np.sum(stretches**2) - 3.0 < 0.5 * material.jm)
    step = 1e-4
    gradient, hessian = material.log_gradient(stretches), material.log_hessian(stretches)
    np.testing.assert_allclose(hessian, hessian.T, rtol=1e-12)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        # Steps that keep the volume: one axis grows as another shrinks.
        along = np.zeros(3)
        along[a], along[b] = 1.0, -1.0
        ahead, behind = stretches * np.exp(step * along), stretches * np.exp(-step * along)
        slope = (material.energy(ahead) - material.energy(behind)) / (2.0 * step)
        scale = np.abs(gradient).max() + np.abs(hessian).max()
        # Second order in the step: 1e-8 times (power of the energy)², at most 16².
        assert slope == pytest.approx(along @ gradient, abs=1e-5 * scale)
        change = (material.log_gradient(ahead) - material.log_gradient(behind)) / (2.0 * step)
        np.testing.assert_allclose(change, hessian @ along, atol=1e-4 * scale)


@LAWS
@given(MATERIALS)
def test_the_three_tests_agree_at_small_strain(material):
    """E, 2 E and 4/3 E with the E of incompressible material, 3 μ₀, whatever its own ν."""
    for mode, factor in (("uniaxial", 1.0), ("equibiaxial", 2.0), ("planar", 4.0 / 3.0)):
        assert nominal_stress(material, 1.0, mode) == pytest.approx(0.0, abs=1e-9 * material.shear)
        slope = nominal_tangent(material, 1.0, mode)
        assert slope == pytest.approx(3.0 * factor * material.shear, rel=1e-9)


@LAWS
@given(ogdens(), st.sampled_from(MODES))
def test_positive_terms_are_stable_in_drucker_s_sense(material, mode):
    assert stable_range(material, mode).drucker == pytest.approx((0.3, 5.0))


@LAWS
@given(MATERIALS)
def test_equibiaxial_tension_is_uniaxial_compression(material):
    """Incompressible: λ_u = λ_b⁻², and the true stresses differ by a pressure only."""
    pulled = np.linspace(1.05, 1.7, 8)
    biaxial = nominal_stress(material, pulled, "equibiaxial") * pulled
    pressed = nominal_stress(material, pulled**-2.0, "uniaxial") * pulled**-2.0
    if np.all(np.isfinite(biaxial)):
        np.testing.assert_allclose(biaxial, -pressed, rtol=1e-9)
