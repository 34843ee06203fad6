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
from voxsoft.simulation.solving.equilibrium import too_large_a_tangent

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
    the masses of the vertices, by subspace iteration. Pressures keep their value, and nothing is
    damped. With planes of symmetry the modes are those of the whole body, antisymmetric ones too.

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
        The result is no stable equilibrium, the design has contact or supplies, or the tangent does
        not fit in memory.

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
    return modes_of(setup, result.positions, count)


def modes_of(setup: Setup, positions: NDArray[np.float64], count: int) -> Modes:
    """Find the slowest eigenmodes at an equilibrium of a setup without contact."""
    try:
        squares, shapes = _core.modes(setup.problem, positions, count, memory=memory_limit())
    except MemoryError as error:
        (needed,) = error.args
        what = too_large_a_tangent(len(positions), needed)
        raise SimulationError("modes", what, "use larger voxels") from None
    except ArithmeticError:
        what = "the body moves freely, or its equilibrium is not stable"
        raise SimulationError("modes", what, "hold it, or lower the load") from None
    largest = np.linalg.norm(shapes, axis=2).max(axis=1)
    return Modes(np.sqrt(squares) / (2.0 * np.pi), shapes / largest[:, None, None])
