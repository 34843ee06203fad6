"""Natural frequencies and eigenmodes of small vibrations about an equilibrium."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft._memory import memory_limit
from voxsoft.errors import SimulationError
from voxsoft.simulation.compatibility import refuse
from voxsoft.simulation.results.fields import remember
from voxsoft.simulation.results.result import Result
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.choice import kind_of
from voxsoft.simulation.solving.equilibrium import (
    ArcLengthControl,
    LoadControl,
    Statics,
    VolumeControl,
    find_equilibrium,
    too_large_a_tangent,
)

#: Controls of statics by the word for them in a result.
_CONTROLS: Final[dict[str, type[Statics]]] = {
    "load": LoadControl,
    "arc-length": ArcLengthControl,
    "volume": VolumeControl,
}
#: Distance from the positions of a result within which its equilibrium is found again, in voxels:
#: far above the tolerance of equilibria, and below any change of a frequency that is shown.
_SAME: Final = 1e-3
#: Default number of modes.
DEFAULT_COUNT: Final = 6


@dataclass(frozen=True)
class Modes:
    """Eigenmodes of small vibrations about an equilibrium, the slowest first.

    Attributes
    ----------
    frequencies
        Natural frequencies in Hz, (k,).
    shapes
        Displacement of each vertex, (k, n, 3), scaled so that the largest of each mode is 1.
    """

    frequencies: NDArray[np.float64]
    shapes: NDArray[np.float64]

    def summary(self) -> dict[str, Any]:
        """Return the frequencies in Hz as plain data."""
        return {"frequencies": self.frequencies.tolist()}


def modes(result: Result, count: int = DEFAULT_COUNT) -> Modes:
    """Find the slowest eigenmodes of a loaded body.

    Solves ``K φ = ω² M φ`` with the tangent of the elastic forces and loads at the equilibrium, and
    the masses of the vertices, by subspace iteration. Pressure loads keep their value, and nothing
    is damped. Surfaces in contact stay in contact where they press, and slide or stick as they do
    at rest; supplies push back as their volume changes, at constant temperature. With planes of
    symmetry the modes are those of the whole body, antisymmetric ones too. Rubber with ``prony``
    branches has its long-term stiffness, crept or not.

    Parameters
    ----------
    result
        An equilibrium.
    count
        Number of modes.

    Returns
    -------
    Modes
        Eigenmodes in the order of their frequencies.

    Raises
    ------
    SimulationError
        The result is no stable equilibrium, or the tangent does not fit in memory.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> beam = families.beam(length="60 mm").with_values("parts.0.material=ecoflex-00-30")
    >>> [round(f, 1) for f in vs.modes(vs.simulate(beam), 2).frequencies.tolist()]
    [5.6, 5.6]
    """
    if result.status != "ok":
        raise SimulationError("modes", f"the run is {result.status}", "bring it to rest first")
    if count < 1:
        raise SimulationError("count", f"is {count}", "ask for one mode or more")
    over_time = not kind_of(result.design, result.design.solver).to_rest
    # A design of motion may have been brought to rest all the same, as the studio does.
    if over_time and result.velocities.any():
        what = "are those of an equilibrium, and the run is motion over time"
        raise SimulationError("modes", what, "leave out end_time and other settings of motion")
    refuse(result.design, "modes")
    setup = Setup(result.design, result.mesh)
    remember(setup.problem, result.peaks)
    found = modes_of(*_loaded(setup, result), count)
    # Without the frames of rigid objects, which have vertices after the body's and may move more.
    shapes = found.shapes[:, : len(result.positions)]
    largest = np.linalg.norm(shapes, axis=2).max(axis=1)
    return Modes(found.frequencies, shapes / np.where(largest > 0.0, largest, 1.0)[:, None, None])


def _loaded(setup: Setup, result: Result) -> tuple[_core.Problem, NDArray[np.float64]]:
    """Return the problem of a setup with its memory at a result, and the positions of all vertices.

    Contact forces are no function of positions: the load path is followed again.

    Raises
    ------
    SimulationError
        The path ends elsewhere.
    """
    if setup.touching is None and setup.fluids is None:
        return setup.problem, result.positions
    control = _CONTROLS.get(result.solver["way"], LoadControl)
    kept = {key: each for key, each in result.solver.items() if key in control.model_fields}
    _, report = find_equilibrium(setup, control(**kept), None)
    off = float(np.abs(report.answer.positions - result.positions).max())
    if not off <= _SAME * setup.design.voxel_size:
        raise SimulationError(
            "modes",
            "the equilibrium of this result, with its contact or supplies, is not found again",
            'solve it with method = "statics"',
        )
    return report.answer.problem, report.answer.all_positions


def modes_of(problem: _core.Problem, positions: NDArray[np.float64], count: int) -> Modes:
    """Find the slowest eigenmodes at an equilibrium of a problem, with the contact it remembers."""
    try:
        squares, shapes = _core.modes(problem, positions, count, memory=memory_limit())
    except MemoryError as error:
        (needed,) = error.args
        what = too_large_a_tangent(len(positions), needed)
        raise SimulationError("modes", what, "use larger voxels") from None
    except ArithmeticError:
        what = "the body moves freely, or its equilibrium is not stable"
        raise SimulationError("modes", what, "hold it, or lower the load") from None
    largest = np.linalg.norm(shapes, axis=2).max(axis=1)
    return Modes(np.sqrt(squares) / (2.0 * np.pi), shapes / largest[:, None, None])
