"""Interface of a kind of load, and the description of a load without its mesh."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, Literal, Protocol, TypeVar

import numpy as np

from voxsoft.design import Design, History, Region
from voxsoft.design.chamber import CavityChoice
from voxsoft.mesh import Mesh
from voxsoft.simulation.loads.actions import Action, Vertices
from voxsoft.simulation.loads.surface import OuterSurface

Quantity = Literal["acceleration", "force", "pressure", "magnetic field", "density", "number"]
Triple = tuple[float, float, float]
L = TypeVar("L")


class LoadedBody(Protocol):
    """Body that loads act on: a :class:`~voxsoft.simulation.Setup`."""

    @property
    def design(self) -> Design:
        """Design that it is made from."""

    @property
    def mesh(self) -> Mesh:
        """The tetrahedra; cavities have the names of the design's chambers."""

    @property
    def outer_surfaces(self) -> tuple[OuterSurface, ...]:
        """The outer surface of each of its bodies."""

    def vertices_in(self, region: Region, where: str) -> Vertices:
        """Vertices that a region catches; `where` is the place an error names."""


@dataclass(frozen=True)
class LoadReading:
    """Description of a load without its mesh.

    Attributes
    ----------
    kind
        Its name in a design.
    label
        Its name for people.
    quantity
        Quantity of its value: the kind of its unit.
    components
        Its value without its history, SI: one number, or x, y, z.
    direction
        Its direction, of any length; zero if it follows a surface.
    history
        Its factor over time.
    cavity
        Its cavity, if it acts in one.
    varies
        True if it changes with time by itself.
    """

    kind: str
    label: str
    quantity: Quantity
    components: tuple[float, ...]
    direction: Triple
    history: History | None
    cavity: CavityChoice | None = None
    varies: bool = False

    @property
    def size(self) -> float:
        """Its value without its history, SI; of a vector the length."""
        number, *others = self.components
        return float(np.linalg.norm(self.components)) if others else number

    @property
    def final_factor(self) -> float:
        """Final factor of its history; 1 without one."""
        return 1.0 if self.history is None else self.history.factors[-1]


class LoadKind(ABC, Generic[L]):
    """Description and actions of loads of one kind."""

    @abstractmethod
    def read(self, load: L) -> LoadReading:
        """Describe a load."""

    @abstractmethod
    def actions(self, load: L, body: LoadedBody, where: str) -> Sequence[Action]:
        """Return the actions of a load on a body.

        Parameters
        ----------
        load, body
            The load, and the body that it acts on.
        where
            Its place in the design, for messages.

        Raises
        ------
        DesignError
            The load catches nothing.
        """
