"""Simulation of a design: its state at rest or its motion over time."""

from voxsoft.metrics import Place
from voxsoft.simulation.check import CheckReport, check
from voxsoft.simulation.choice import check_solver
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.gradient import gradient
from voxsoft.simulation.load_path import LoadPath, follow
from voxsoft.simulation.many import Ensemble, Settled, simulate_many
from voxsoft.simulation.observation import ChamberState, Observation
from voxsoft.simulation.over import Over
from voxsoft.simulation.penetration import Overlap, Penetration, find_penetration
from voxsoft.simulation.reachable import Workspace, workspace
from voxsoft.simulation.result import Recording, Result, Status
from voxsoft.simulation.run import ProgressCallback, balance, relax, simulate
from voxsoft.simulation.setup import Setup, named_regions
from voxsoft.simulation.simulator import Simulator
from voxsoft.simulation.targets import check_targets
from voxsoft.simulation.vibration import Modes, modes

__all__ = [
    "ChamberState",
    "CheckReport",
    "Diagnostic",
    "Ensemble",
    "LoadPath",
    "Modes",
    "Observation",
    "Over",
    "Overlap",
    "Penetration",
    "Place",
    "ProgressCallback",
    "Recording",
    "Result",
    "Settled",
    "Setup",
    "Simulator",
    "Status",
    "Workspace",
    "balance",
    "check",
    "check_solver",
    "check_targets",
    "find_penetration",
    "follow",
    "gradient",
    "modes",
    "named_regions",
    "relax",
    "simulate",
    "simulate_many",
    "workspace",
]
