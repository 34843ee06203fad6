"""Resolution of a design's loads to actions on a mesh, for all users of loads.

The core's problem, the studio's symbols and sliders, bricks of outside codes, predictions of cost,
warnings and metrics all use it; no other module asks of which kind a load is.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import AnyLoad, Design
from voxsoft.mesh import Mesh
from voxsoft.simulation.loads.actions import Action
from voxsoft.simulation.loads.kind import LoadedBody, LoadReading
from voxsoft.simulation.loads.kinds import KINDS


@dataclass(frozen=True, eq=False)
class ResolvedLoad:
    """A load on a mesh.

    Attributes
    ----------
    reading
        Its description without the mesh: kind, quantity, value, history, cavity.
    actions
        Its actions, without its history; the core counts each as a load of its own.
    mesh
        The mesh that it acts on.
    """

    reading: LoadReading
    actions: tuple[Action, ...]
    mesh: Mesh = field(repr=False)

    @property
    def at(self) -> NDArray[np.float64]:
        """Position of its arrow, (3,), m; the middle of the body if it has no action."""
        return self._arrow[0]

    @property
    def direction(self) -> NDArray[np.float64]:
        """Direction of its arrow, (3,), of length 1; zero if it has none."""
        return self._arrow[1]

    @cached_property
    def _arrow(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        rest = self.mesh.vertices
        if not self.actions:
            return rest.mean(axis=0), np.zeros(3)
        return self.actions[0].arrow(rest)


def read(load: AnyLoad) -> LoadReading:
    """Describe a load without its mesh.

    Parameters
    ----------
    load
        Any load of a design.

    Examples
    --------
    >>> from voxsoft.design import Pressure
    >>> found = read(Pressure(value="4 kPa", cavity=0))
    >>> found.label, found.quantity, found.size
    ('pressure in cavity 0', 'pressure', 4000.0)
    """
    return KINDS[type(load)].read(load)


def readings(design: Design) -> list[LoadReading]:
    """Describe each load of a design, in their order."""
    return [read(load) for load in design.loads]


def resolve(load: AnyLoad, body: LoadedBody, where: str) -> ResolvedLoad:
    """Resolve a load to its actions on a mesh.

    Parameters
    ----------
    load
        Any load of a design.
    body
        A mesh with its regions: a :class:`~voxsoft.simulation.Setup`.
    where
        The load's place in the design, for messages.

    Raises
    ------
    DesignError
        The load catches no vertex, or no triangle of the surface.
    NoCavityError
        A pressure in a cavity that does not exist.

    Examples
    --------
    >>> from voxsoft.design import Gravity, families
    >>> from voxsoft.simulation import Setup
    >>> setup = Setup.of(families.beam())
    >>> weight = resolve(Gravity(), setup, "loads[0]")
    >>> weight.direction.tolist()
    [0.0, 0.0, -1.0]
    >>> weight.actions
    (Acceleration(value=9.81, direction=array([ 0.,  0., -1.])),)
    """
    kind = KINDS[type(load)]
    return ResolvedLoad(kind.read(load), tuple(kind.actions(load, body, where)), body.mesh)
