"""Simulation of a design: its state at rest or its motion over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxsoft._lazy import lazy_names

if TYPE_CHECKING:
    from voxsoft.metrics import Place
    from voxsoft.simulation.checks.check import CheckReport, check
    from voxsoft.simulation.checks.penetration import Overlap, Penetration, find_penetration
    from voxsoft.simulation.derivatives.gradient import gradient
    from voxsoft.simulation.derivatives.voxel_gradient import VoxelSlopes, gradient_by_voxel
    from voxsoft.simulation.diagnostic import Diagnostic
    from voxsoft.simulation.results.result import Recording, Result, Status
    from voxsoft.simulation.results.vibration import Modes, modes
    from voxsoft.simulation.runs.commands import Command
    from voxsoft.simulation.runs.load_path import LoadPath, follow
    from voxsoft.simulation.runs.many import Ensemble, Settled, simulate_many
    from voxsoft.simulation.runs.observation import ChamberState, Observation
    from voxsoft.simulation.runs.over import Over
    from voxsoft.simulation.runs.rollout import Rollout, rollout
    from voxsoft.simulation.runs.run import ProgressCallback, balance, relax, simulate
    from voxsoft.simulation.runs.sensors import Sensor
    from voxsoft.simulation.runs.simulator import Simulator
    from voxsoft.simulation.runs.workspace import Workspace, workspace
    from voxsoft.simulation.setup.setup import Setup, named_regions
    from voxsoft.simulation.setup.targets import check_targets
    from voxsoft.simulation.solving.choice import check_solver

__all__ = [
    "ChamberState",
    "CheckReport",
    "Command",
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
    "Rollout",
    "Sensor",
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
    "rollout",
    "simulate",
    "simulate_many",
    "workspace",
]

# A check needs a fifth of the modules, and a run half of them.
__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "ChamberState": "voxsoft.simulation.runs.observation",
        "CheckReport": "voxsoft.simulation.checks.check",
        "Command": "voxsoft.simulation.runs.commands",
        "Diagnostic": "voxsoft.simulation.diagnostic",
        "Ensemble": "voxsoft.simulation.runs.many",
        "LoadPath": "voxsoft.simulation.runs.load_path",
        "Modes": "voxsoft.simulation.results.vibration",
        "Observation": "voxsoft.simulation.runs.observation",
        "Over": "voxsoft.simulation.runs.over",
        "Overlap": "voxsoft.simulation.checks.penetration",
        "Penetration": "voxsoft.simulation.checks.penetration",
        "Place": "voxsoft.metrics",
        "ProgressCallback": "voxsoft.simulation.runs.run",
        "Recording": "voxsoft.simulation.results.result",
        "Result": "voxsoft.simulation.results.result",
        "Rollout": "voxsoft.simulation.runs.rollout",
        "Settled": "voxsoft.simulation.runs.many",
        "Sensor": "voxsoft.simulation.runs.sensors",
        "Setup": "voxsoft.simulation.setup.setup",
        "Simulator": "voxsoft.simulation.runs.simulator",
        "Status": "voxsoft.simulation.results.result",
        "VoxelSlopes": "voxsoft.simulation.derivatives.voxel_gradient",
        "Workspace": "voxsoft.simulation.runs.workspace",
        "balance": "voxsoft.simulation.runs.run",
        "check": "voxsoft.simulation.checks.check",
        "check_solver": "voxsoft.simulation.solving.choice",
        "check_targets": "voxsoft.simulation.setup.targets",
        "find_penetration": "voxsoft.simulation.checks.penetration",
        "follow": "voxsoft.simulation.runs.load_path",
        "gradient": "voxsoft.simulation.derivatives.gradient",
        "gradient_by_voxel": "voxsoft.simulation.derivatives.voxel_gradient",
        "modes": "voxsoft.simulation.results.vibration",
        "named_regions": "voxsoft.simulation.setup.setup",
        "relax": "voxsoft.simulation.runs.run",
        "rollout": "voxsoft.simulation.runs.rollout",
        "simulate": "voxsoft.simulation.runs.run",
        "simulate_many": "voxsoft.simulation.runs.many",
        "workspace": "voxsoft.simulation.runs.workspace",
    },
)
