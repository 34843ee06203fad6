"""Comparison of VoxSoft's solvers with each other, with outside codes and with measurements."""

from voxsoft.comparison.comparison import Comparison, Run
from voxsoft.comparison.richardson import Estimate, discretization_error
from voxsoft.comparison.run import compare

__all__ = ["Comparison", "Estimate", "Run", "compare", "discretization_error"]
