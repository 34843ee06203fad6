"""Elements attached to a body beside its material, between places of it."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator
from typing import ClassVar, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core_data
from voxsoft.design.operands import Name
from voxsoft.design.region import Probe, Region
from voxsoft.records import Record
from voxsoft.units import Point


class PlaceOnBody(Protocol):
    """Vertices, and the weights of the mean that is a place; the weights sum to 1."""

    @property
    def vertices(self) -> NDArray[np.uint32]:
        """Indices, (n,)."""

    @property
    def weights(self) -> NDArray[np.float64]:
        """A weight for each, (n,)."""


class AttachingBody(Protocol):
    """The body that elements are attached to: a :class:`~voxsoft.simulation.Setup`."""

    def place(self, probe: Probe, where: str) -> PlaceOnBody:
        """Return the vertices of the mesh at a point or region of the undeformed body."""

    def position(self, place: PlaceOnBody) -> NDArray[np.float64]:
        """Return where a place is in the undeformed body, (3,), m."""


class Attachment(Record):
    """Something that pulls at places of a body.

    Notes
    -----
    A kind is a subclass with the name of its term in the core, and a field of
    :class:`~voxsoft.design.Design` that holds a tuple of it; nothing else needs to know the kind.
    """

    #: The name of the core's term, a variant of its `Attachment`.
    term: ClassVar[str]

    name: Name | None = None

    @property
    @abstractmethod
    def places(self) -> tuple[Probe | Point, ...]:
        """Places it joins, in turn: places on the body, and points in space that do not move."""

    @property
    @abstractmethod
    def summary(self) -> str:
        """Short description with its size, for pictures and lists."""

    def placed(self, region: Callable[[Region], Region], point: Callable[[Point], Point]) -> Self:
        """Return the same for a body in another frame.

        Parameters
        ----------
        region, point
            Functions that map places on the body, and points in space.

        Notes
        -----
        A kind with points in space places these itself.
        """
        places = {name: region(each) for name, each in self if isinstance(each, Region)}
        return self.replace(**places)

    @abstractmethod
    def element(self, body: AttachingBody, where: str) -> _core_data.Element:
        """Return the element of the core's term, by the names of its fields, as plain data.

        Parameters
        ----------
        body
            The body made ready.
        where
            The place in the design that an error names.

        Raises
        ------
        DesignError
            A place that is not on the body, or ends that the element cannot have.
        """


def attachments_of(design: Record) -> Iterator[tuple[str, Attachment]]:
    """Yield everything that a design attaches to its body, each with its place in the design."""
    for name, entries in design:
        for index, entry in enumerate(entries if isinstance(entries, tuple) else ()):
            if isinstance(entry, Attachment):
                yield f"{name}[{index}]", entry
