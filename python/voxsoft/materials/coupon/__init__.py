r"""Coupon tests: stress-strain curves of a material, and the models fitted to them.

Examples
--------
>>> text = "strain,stress_kPa\n0,0\n0.1,5.471\n0.3,14.17\n0.6,24.18\n0.8,29.83\n1,35\n"
>>> fit = fit_coupons([read_curve(text, name="coupon 1")])
>>> fit.recommended.name
'neo-hookean'
"""

from voxsoft.materials.coupon.branches import Branch, BranchFit, fit_branches
from voxsoft.materials.coupon.curve import TOE_CORRECTIONS, Curve, Toe, ToeCorrection
from voxsoft.materials.coupon.cycles import Cycles, SofteningFit, fit_softening
from voxsoft.materials.coupon.fit import DEFAULT_MAX_STRAIN, fit_coupons
from voxsoft.materials.coupon.interval import Interval
from voxsoft.materials.coupon.modulus_test import (
    BendingTest,
    FrequencyTest,
    KnownModulus,
    MeasuredModulus,
    read_modulus_tests,
)
from voxsoft.materials.coupon.result import CouponFit, ModelFit
from voxsoft.materials.coupon.table import (
    curve_quantities,
    read_curve,
    read_cycles,
    read_timed_test,
)
from voxsoft.materials.coupon.timed import TestKind, TimedTest
from voxsoft.materials.coupon.untested import UntestedMode

__all__ = [
    "DEFAULT_MAX_STRAIN",
    "TOE_CORRECTIONS",
    "BendingTest",
    "Branch",
    "BranchFit",
    "CouponFit",
    "Curve",
    "Cycles",
    "FrequencyTest",
    "Interval",
    "KnownModulus",
    "MeasuredModulus",
    "ModelFit",
    "SofteningFit",
    "TestKind",
    "TimedTest",
    "Toe",
    "ToeCorrection",
    "UntestedMode",
    "curve_quantities",
    "fit_branches",
    "fit_coupons",
    "fit_softening",
    "read_curve",
    "read_cycles",
    "read_modulus_tests",
    "read_timed_test",
]
