"""From a design to its state at rest or its motion over time."""

from voxsoft.simulation.check import CheckReport, Finding, check
from voxsoft.simulation.gradient import gradient
from voxsoft.simulation.many import Ensemble, Settled, simulate_many
from voxsoft.simulation.places import Place
from voxsoft.simulation.result import History, Result, Status
from voxsoft.simulation.run import ProgressCallback, balance, relax, simulate
from voxsoft.simulation.setup import Setup, named_regions
from voxsoft.simulation.targets import check_targets

__all__ = [
    "CheckReport",
    "Ensemble",
    "Finding",
    "History",
    "Place",
    "ProgressCallback",
    "Result",
    "Settled",
    "Setup",
    "Status",
    "balance",
    "check",
    "check_targets",
    "gradient",
    "named_regions",
    "relax",
    "simulate",
    "simulate_many",
]
