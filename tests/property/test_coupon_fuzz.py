"""Whatever a testing machine writes, a table is read or refused in words; so are fits."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from voxsoft.errors import MaterialError, MeasurementError, VoxSoftError
from voxsoft.materials.coupon import Curve, fit_coupons, read_curve

ECOFLEX = Path(__file__).parents[2] / "examples" / "data" / "tensile" / "ecoflex-00-30.csv"
TEXT = ECOFLEX.read_text(encoding="utf-8")
PIECES = st.sampled_from(
    ["", "\n", '"', ";", "\t", "nan", "inf", "1e999", "%", "(kPa)", "strain", "-", ",", "Ω", "0,5"]
)


@st.composite
def damaged(draw):
    start, length = draw(st.integers(0, len(TEXT))), draw(st.integers(0, 60))
    return TEXT[:start] + draw(PIECES) + TEXT[start + length :]


@settings(max_examples=150, deadline=None)
@given(damaged() | st.text(max_size=80))
@example("strain,stress_kPa\n" + "1e308,1\n" * 6)
@example("strain,stress_kPa\n" + '"\n' * 6)
@example("displacement_mm,stress_kPa\n" + "1,1\n" * 6)
def test_tables(text):
    try:
        curve = read_curve(text, area=1e-5, length=0.03)
    except MeasurementError:
        return
    assert np.isfinite(curve.strain).all()
    assert np.isfinite(curve.stress).all()


CURVES = given(
    st.lists(st.floats(0.0, 3.0), min_size=5, max_size=12, unique=True),
    st.integers(0, 2**32 - 1),
    st.sampled_from(["uniaxial", "equibiaxial", "planar"]),
    st.floats(1e-3, 1e9),
)


@pytest.mark.slow
@settings(max_examples=3, deadline=None)
@CURVES
def test_fits_of_any_curve(strains, seed, mode, size):
    ends_in_numbers_or_words(strains, seed, mode, size)


@pytest.mark.slow
@settings(max_examples=30, deadline=None)
@CURVES
def test_fits_of_many_curves(strains, seed, mode, size):
    ends_in_numbers_or_words(strains, seed, mode, size)


def ends_in_numbers_or_words(strains, seed, mode, size):
    """Numbers come out, or words; never a crash, a NaN among the constants, or no ranking."""
    random = np.random.default_rng(seed)
    stress = size * (np.sort(strains) + random.standard_normal(len(strains)))
    try:
        fit = fit_coupons([Curve(np.sort(strains), stress, mode)])
    except VoxSoftError:
        return
    assert fit.recommended in fit.models
    for found in fit.models:
        assert np.isfinite(found.material.constants).all()
        assert found.young.value > 0.0
        assert found.young.low <= found.young.value <= found.young.high
    if fit.recommended.stable_in_fit:
        # The card notes besides how far it was tested.
        assert fit.card("any").material.constants == fit.recommended.material.constants
    else:
        with pytest.raises(MaterialError, match="is unstable between the strains"):
            fit.card("any")
