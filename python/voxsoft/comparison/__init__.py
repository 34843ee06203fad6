"""Comparison of VoxSoft's solvers with each other, with outside codes and with measurements."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxsoft._lazy import lazy_names

if TYPE_CHECKING:
    from voxsoft.comparison.bars import error_bars
    from voxsoft.comparison.comparison import Comparison, Run
    from voxsoft.comparison.confirmation import Confirmation, confirm
    from voxsoft.comparison.deck import Deck
    from voxsoft.comparison.error_bar import ErrorBar, ErrorBars
    from voxsoft.comparison.local_error import local_errors
    from voxsoft.comparison.path_bars import path_error_bars
    from voxsoft.comparison.refining import refined
    from voxsoft.comparison.richardson import Estimate, discretization_error
    from voxsoft.comparison.run import compare
    from voxsoft.comparison.workspace_bars import line_error

__all__ = [
    "Comparison",
    "Confirmation",
    "Deck",
    "ErrorBar",
    "ErrorBars",
    "Estimate",
    "Run",
    "compare",
    "confirm",
    "discretization_error",
    "error_bars",
    "line_error",
    "local_errors",
    "path_error_bars",
    "refined",
]

# Imported when first used: a job reads the arguments of a comparison without its solvers.
_HOMES = {
    "Comparison": "voxsoft.comparison.comparison",
    "Confirmation": "voxsoft.comparison.confirmation",
    "Deck": "voxsoft.comparison.deck",
    "ErrorBar": "voxsoft.comparison.error_bar",
    "ErrorBars": "voxsoft.comparison.error_bar",
    "Estimate": "voxsoft.comparison.richardson",
    "Run": "voxsoft.comparison.comparison",
    "compare": "voxsoft.comparison.run",
    "confirm": "voxsoft.comparison.confirmation",
    "discretization_error": "voxsoft.comparison.richardson",
    "error_bars": "voxsoft.comparison.bars",
    "line_error": "voxsoft.comparison.workspace_bars",
    "local_errors": "voxsoft.comparison.local_error",
    "path_error_bars": "voxsoft.comparison.path_bars",
    "refined": "voxsoft.comparison.refining",
}
__getattr__, __dir__ = lazy_names(__name__, _HOMES)
