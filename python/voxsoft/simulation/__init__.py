"""Simulation of a design: its state at rest or its motion over time."""

from voxsoft.metrics import Place
from voxsoft.simulation.checks.check import CheckReport, check
from voxsoft.simulation.checks.penetration import Overlap, Penetration, find_penetration
from voxsoft.simulation.derivatives.gradient import gradient
from voxsoft.simulation.derivatives.voxel_gradient import VoxelSlopes, gradient_by_voxel
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.results.result import Recording, Result, Status
from voxsoft.simulation.results.vibration import Modes, modes
from voxsoft.simulation.runs.load_path import LoadPath, follow
from voxsoft.simulation.runs.many import Ensemble, Settled, simulate_many
from voxsoft.simulation.runs.observation import ChamberState, Observation
from voxsoft.simulation.runs.over import Over
from voxsoft.simulation.runs.run import ProgressCallback, balance, relax, simulate
from voxsoft.simulation.runs.simulator import Simulator
from voxsoft.simulation.runs.workspace import Workspace, workspace
from voxsoft.simulation.setup.setup import Setup, named_regions
from voxsoft.simulation.setup.targets import check_targets
from voxsoft.simulation.solving.choice import check_solver

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
    "VoxelSlopes",
    "Workspace",
    "balance",
    "check",
    "check_solver",
    "check_targets",
    "find_penetration",
    "follow",
    "gradient",
    "gradient_by_voxel",
    "modes",
    "named_regions",
    "relax",
    "simulate",
    "simulate_many",
    "workspace",
]
