"""Comparison of VoxSoft's solvers with each other, with outside codes and with measurements."""

from voxsoft.comparison.comparison import Comparison, Run
from voxsoft.comparison.confirmation import Confirmation, confirm
from voxsoft.comparison.richardson import Estimate, discretization_error
from voxsoft.comparison.run import compare

__all__ = [
    "Comparison",
    "Confirmation",
    "Estimate",
    "Run",
    "compare",
    "confirm",
    "discretization_error",
]
