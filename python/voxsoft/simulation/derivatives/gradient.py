"""Derivatives of metrics at an equilibrium, by the adjoint method at the converged state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design, Objective
from voxsoft.design.discretization.cut_cells import cuts_cells
from voxsoft.design.discretization.cut_voxels import CutVoxels
from voxsoft.design.shape_memory import ShapeMemory
from voxsoft.design.variation import number_of, with_number
from voxsoft.errors import DesignError, SimulationError, VoxSoftError
from voxsoft.mesh import Mesh
from voxsoft.metrics import METRICS, Target, metric_named
from voxsoft.records import closest
from voxsoft.simulation.compatibility import refuse
from voxsoft.simulation.derivatives.differences import STENCIL, STEP
from voxsoft.simulation.derivatives.loaded_state import LoadedState
from voxsoft.simulation.derivatives.path_gradient import check_residual, path_gradient
from voxsoft.simulation.results.result import Result
from voxsoft.simulation.setup.contact import has_contact
from voxsoft.simulation.setup.layers import sealed
from voxsoft.simulation.setup.motion import held_axes, held_positions
from voxsoft.simulation.setup.places import voxel_size
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.adjoint import adjoint_states, readable_errors

Floats = NDArray[np.float64]

#: Largest distance of clamped vertices from their prescribed positions, in voxels.
_MISPLACED: Final = 1e-6
#: Relative rounding of tensions: a tendon that slides all along has those of one pulled at once.
_STUCK: Final = 1e-9
#: Largest sum of the changes to both sides over their magnitudes where a slope is smooth: steps of
#: 5e-6 leave less.
_KINK: Final = 1e-3
#: Rounding of a few stretches.
_ROUNDING: Final = 1e-14


def gradient(
    result: Result,
    targets: str | Sequence[str] | Mapping[str, Target],
    parameters: str | Sequence[str],
) -> dict[str, dict[str, float]]:
    r"""Compute derivatives of metrics with respect to numbers of the design.

    At an equilibrium :math:`r(x, p) = 0` a metric :math:`J(x, p)` changes with a number
    :math:`p` by

    .. math:: dJ/dp = \partial J/\partial p + \mu \cdot \partial r/\partial p,
              \qquad K^T \mu = \partial J/\partial x, \quad K = -\partial r/\partial x.

    One factorization of the tangent :math:`K` serves all metrics and all numbers; nothing is
    solved again.

    Parameters
    ----------
    result
        A stable equilibrium under the full loads, of ``simulate(design, method="statics")``. The
        tighter its tolerance, the more digits are right.
    targets
        Names of objectives or constraints of the design, or of metrics that need no choice; or a
        mapping from names of your own to objectives or constraints.
    parameters
        Parameters of the design, or paths of numbers as ``--set`` writes them:
        ``parts.0.material.young``, ``parts.0.material.mu.1``, ``loads.0.value``,
        ``clamps.1.motion.displacement.2``.

    Returns
    -------
    dict of dict
        Derivatives by target, then by parameter, in SI units.

    Raises
    ------
    SimulationError
        A result that is no such equilibrium, or a tangent that is singular there.
    DesignError
        An unknown target or parameter; a whole number; a shape whose voxels are either full or
        empty, so that the derivative is zero or does not exist.

    Notes
    -----
    :math:`\partial r/\partial p` and :math:`\partial J/\partial p` are differences of forces and
    metrics at the same positions, with clamped vertices where the varied design puts them. Kinks
    have one-sided slopes: the largest displacement, vertices that just touch the floor.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.simulation import simulate
    >>> soft = '{model="neo-hookean", young="60 kPa"}'
    >>> beam = families.beam(length="40 mm").with_values(f"parts.0.material={soft}")
    >>> result = simulate(beam)
    >>> slopes = gradient(result, "sag", ["parts.0.material.young", "loads.0.value"])["sag"]
    >>> slopes["parts.0.material.young"] < 0 < slopes["loads.0.value"]
    True
    """
    base, chosen = equilibrium_of(result, targets)
    setup = base.setup
    names = [parameters] if isinstance(parameters, str) else list(parameters)
    varied = [_variation(base, name) for name in names]
    if has_contact(result.design):
        with readable_errors(len(base.positions)):
            return path_gradient(setup, result, chosen, dict(zip(names, varied, strict=True)))
    slopes = slopes_by_positions(base, chosen)
    adjoints = adjoint_states(setup.problem, base.positions, slopes)
    return {
        target_name: {
            name: variation.explicit(target) + float(np.vdot(adjoint, variation.forces))
            for name, variation in zip(names, varied, strict=True)
        }
        for (target_name, target), adjoint in zip(chosen.items(), adjoints, strict=True)
    }


def equilibrium_of(
    result: Result, targets: str | Sequence[str] | Mapping[str, Target]
) -> tuple[EquilibriumState, dict[str, Target]]:
    """Return the state of a result that has derivatives, and the targets with their names."""
    _check_state(result)
    refuse(result.design, "gradient")
    chosen = _targets(result.design, targets)
    for target in chosen.values():
        _check_slope(target)
    setup = Setup(result.design, result.mesh)
    taut = tuple(result.tendons[each.name].tension > 0.0 for each in setup.tendons)
    base = EquilibriumState(setup, result.positions, taut=taut)
    _check_positions(base)
    _check_way(setup, result)
    return base, chosen


def slopes_by_positions(state: LoadedState, targets: Mapping[str, Target]) -> Floats:
    """Return ``∂J/∂x`` of each target, (k, n, 3)."""
    return np.array([_slope(state, target) for target in targets.values()])


def _check_slope(target: Target) -> None:
    if metric_named(target.metric).slope is None:
        raise SimulationError(target.metric, "has no derivative", "name another metric")


def _slope(state: LoadedState, target: Target) -> Floats:
    slope = metric_named(target.metric).slope
    assert slope is not None  # targets without one are refused
    return slope(state, target)


@dataclass(frozen=True)
class EquilibriumState(LoadedState):
    """A setup and positions at which its forces and metrics are evaluated.

    A stiff tendon has stretched by so little that a difference would leave it slack: tendons that
    are `taut` stay so.
    """

    taut: tuple[bool, ...] = ()

    @cached_property
    def net_forces(self) -> Floats:
        """Elastic plus external force on every vertex [N], (n, 3)."""
        return self.problem.net_forces(self.positions, [*self.taut])

    @cached_property
    def _cut(self) -> CutVoxels:
        design, mesh = self.setup.design, self.setup.mesh
        cut = CutVoxels.of(design, max(1, round(design.voxel_size / voxel_size(mesh))))
        if mesh.fractions is None:
            same = cut.voxels.count == len(mesh.tets) // 5
            same = same and not cuts_cells(design, design.voxel_size)
        else:
            same = np.array_equal(cut.fractions, mesh.fractions)
        if not same:
            raise SimulationError(
                "gradient", "the result has other cut voxels than its design", "solve it again"
            )
        return cut

    def reshaped(self, design: Design, name: str) -> Mesh:
        """Return the mesh of the same voxels, filled as a design with another shape fills them."""
        own = self.setup.design
        if design.voxel_size != own.voxel_size:
            what = "cannot be varied: it changes the voxel size, and the grid with it"
            raise DesignError(name, what, "keep voxel_size, and vary shapes")
        if not own.has_cut_voxels:
            raise DesignError(
                name,
                "cannot be varied: it changes the shape, and voxels are either full or empty, so "
                "that the derivative is zero or does not exist",
                'use fill = "fraction", where cut voxels hold their share of material',
            )
        mesh = self._cut.resampled(design).mesh()
        return sealed(mesh, self.setup.layers, design, self._cut)


@dataclass(frozen=True)
class _Variation:
    """States with a number a little lower and higher, at the same positions of free vertices."""

    states: tuple[EquilibriumState, ...]
    weights: tuple[float, ...]
    offsets: tuple[float, ...]

    @cached_property
    def forces(self) -> Floats:
        """``∂r/∂p`` with clamped vertices going along, (n, 3)."""
        change: Floats = np.sum(
            [
                weight * state.net_forces
                for state, weight in zip(self.states, self.weights, strict=True)
            ],
            axis=0,
        )
        return change

    def explicit(self, target: Target) -> float:
        """Compute ``∂J/∂p`` with clamped vertices going along."""
        return sum(
            weight * metric_named(target.metric).value(state, target)
            for state, weight in zip(self.states, self.weights, strict=True)
        )


def _variation(base: EquilibriumState, name: str) -> _Variation:
    design = base.setup.design
    value = number_of(design, name)
    step = STEP * _scale(design, name, value)
    try:
        states = [
            _state_with(base, with_number(design, name, value + multiple * step), name)
            for multiple, _ in STENCIL
        ]
    except VoxSoftError as error:
        if "cannot be varied" in error.what:
            raise
        raise DesignError(
            name,
            f"cannot be varied by a little: {error}",
            "name a number that the design takes at any value, and no count",
        ) from None
    _check_memory(base.setup.design, [state.setup.design for state in states], name)
    return _Variation(
        tuple(states),
        tuple(weight / step for _, weight in STENCIL),
        tuple(multiple * step for multiple, _ in STENCIL),
    )


def _check_memory(design: Design, varied: Sequence[Design], name: str) -> None:
    """Refuse a number that warms shape memory in one way and cools it in another."""
    for index, activation in enumerate(design.activations):
        if not isinstance(activation, ShapeMemory):
            continue
        changes = [each.activations[index].stretch - activation.stretch for each in varied]
        # The stencil is symmetric: linear terms cancel, rounding and quadratic terms remain.
        if abs(sum(changes)) > _KINK * sum(map(abs, changes)) + _ROUNDING:
            raise DesignError(
                name,
                f"has no derivative: activations[{index}] has another slope up than down there",
                "take a state on a branch of its loop, or vary what does not warm it",
            )


def _state_with(base: EquilibriumState, design: Design, name: str) -> EquilibriumState:
    before = base.setup
    mesh = before.mesh if _shapes(design) == _shapes(before.design) else base.reshaped(design, name)
    if design.floor != before.design.floor:
        raise DesignError(name, "cannot be varied: it moves the floor", "name another number")
    setup = Setup(design, mesh)
    _check_films(before, setup, name)
    held = held_axes(before)
    if (held_axes(setup) != held).any():
        raise DesignError(
            name,
            "cannot be varied: a clamp then catches other vertices",
            "move the ends of the clamp's region away from half a voxel",
        )
    shift = held_positions(setup) - held_positions(before)
    return EquilibriumState(setup, base.positions + np.where(held, shift, 0.0), taut=base.taut)


def _check_films(before: Setup, varied: Setup, name: str) -> None:
    """Refuse a number that moves a film against the faces of voxels that stand for it."""
    if varied.mesh.fractions is None:
        return
    for index, (old, new) in enumerate(zip(before.layers, varied.layers, strict=True)):
        if len(old.openings) and old.gap != new.gap:
            raise DesignError(
                name,
                f"cannot be varied: it moves layers[{index}], which closes a chamber, and what "
                "that does to the chamber is not known",
                "vary what leaves the plane of the layer where it is",
            )


def _shapes(design: Design) -> tuple[object, ...]:
    return design.voxel_size, design.shapes, tuple(part.shape for part in design.parts)


def _scale(design: Design, name: str, value: float) -> float:
    """Return the scale of a number, for its step; for zero its range, a voxel, or one unit."""
    if value != 0.0:
        return abs(value)
    parameter = design.parameters.get(name)
    if parameter is not None and parameter.min is not None and parameter.max is not None:
        return parameter.max - parameter.min
    lengths = name.startswith(("clamps", "probes", "shapes")) or (
        parameter is not None and parameter.kind == "length"
    )
    return design.voxel_size if lengths else 1.0


def _targets(
    design: Design, asked: str | Sequence[str] | Mapping[str, Target]
) -> dict[str, Target]:
    if isinstance(asked, Mapping):
        return dict(asked)
    own: dict[str, Target] = {**design.objectives, **design.constraints}
    found: dict[str, Target] = {}
    for name in [asked] if isinstance(asked, str) else asked:
        if name not in own and name not in METRICS:
            what = "is neither an objective, nor a constraint, nor a metric"
            raise DesignError(name, what, closest(name, [*own, *METRICS]))
        found[name] = own.get(name) or Objective(maximize=name)
    return found


def _check_state(result: Result) -> None:
    if result.solver["method"] != "statics":
        raise SimulationError(
            "gradient",
            f"the result comes from {result.solver['method']}, whose state is no equilibrium to "
            "the last digits",
            'use simulate(design, method="statics")',
        )
    if result.status != "ok" or abs(result.load_factor - 1.0) > 1e-12:
        raise SimulationError(
            "gradient",
            f"the result is no equilibrium under the full loads: {result.message}",
            'lower the loads, and leave control = "volume" out',
        )
    if result.solver["way"] == "creep":
        raise SimulationError(
            "gradient",
            "the result has crept, and its viscous stress is no function of the design alone",
            'use simulate(design, method="statics"), which has the long-term stiffness',
        )
    if has_contact(result.design) and result.solver["way"] != "load":
        way = result.solver["way"]
        raise SimulationError(
            "gradient",
            f"the result comes from {way} control, and with contact they follow load control",
            f'leave control = "{way}" out',
        )
    if result.stable is False:
        raise SimulationError(
            "gradient",
            "the equilibrium is not stable: a real body would leave it",
            "lower the loads to before the limit",
        )
    if not has_contact(result.design):
        check_residual(result.residual)


def _check_way(setup: Setup, result: Result) -> None:
    """Raise where a tendon sticks: its tension then depends on the load path."""
    fresh = setup.problem.tendons(result.positions) if setup.tendons else ()
    for tendon, found in zip(setup.tendons, fresh, strict=True):
        came = result.tendons[tendon.name].tensions
        if np.abs(came - found.tensions).max() > _STUCK * max(came.max(), *found.tensions):
            raise SimulationError(
                "gradient",
                f'the tendon "{tendon.name}" sticks where it bends, and derivatives of what '
                "depends on the way there are not known yet",
                "set its friction to zero, or use a sampler without gradients",
            )


def _check_positions(state: EquilibriumState) -> None:
    """Raise unless clamped vertices are at their prescribed positions."""
    setup = state.setup
    held = held_axes(setup)
    off = np.abs(np.where(held, state.positions - held_positions(setup), 0.0)).max()
    if off > _MISPLACED * setup.design.voxel_size:
        raise SimulationError(
            "gradient", "clamped vertices are not where the design wants them", "solve it again"
        )
