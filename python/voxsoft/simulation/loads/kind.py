"""What has to be said of a kind of load, and what is known of a load without its mesh."""

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

Quantity = Literal["acceleration", "force", "pressure", "magnetic field"]
Triple = tuple[float, float, float]
L = TypeVar("L")


class LoadedBody(Protocol):
    """What loads are laid on: a :class:`~voxsoft.simulation.Setup`."""

    @property
    def design(self) -> Design:
        """What it is made from."""

    @property
    def mesh(self) -> Mesh:
        """The tetrahedra; cavities have the names of the design's chambers."""

    def vertices_in(self, region: Region, where: str) -> Vertices:
        """Vertices that a region catches; `where` is the place an error names."""


@dataclass(frozen=True)
class LoadReading:
    """What a load is, before it is laid on a mesh.

    Attributes
    ----------
    kind
        Its name in a design.
    label
        What people call it.
    quantity
        What its value measures: the kind of its unit.
    components
        Its value without its history, SI: one number, or x, y, z.
    direction
        Which way it points, of any length; zero if it follows a surface.
    history
        Its factor over time.
    cavity
        Where it is, if that is a cavity.
    """

    kind: str
    label: str
    quantity: Quantity
    components: tuple[float, ...]
    direction: Triple
    history: History | None
    cavity: CavityChoice | None = None

    @property
    def size(self) -> float:
        """Its value without its history, SI; of a vector the length."""
        number, *others = self.components
        return float(np.linalg.norm(self.components)) if others else number

    @property
    def final_factor(self) -> float:
        """Its factor in the end."""
        return 1.0 if self.history is None else self.history.factors[-1]


class LoadKind(ABC, Generic[L]):
    """Tells what loads of one kind are, and what they do."""

    @abstractmethod
    def read(self, load: L) -> LoadReading:
        """Say what a load is."""

    @abstractmethod
    def actions(self, load: L, body: LoadedBody, where: str) -> Sequence[Action]:
        """Say what it does to a body.

        Parameters
        ----------
        load, body
            The load, and what it is laid on.
        where
            Its place in the design, for messages.

        Raises
        ------
        DesignError
            It catches nothing.
        """
