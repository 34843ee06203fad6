"""What every member of the union of methods is that a design's settings choose from."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from voxsoft import _core
from voxsoft.errors import SimulationError, VoxSoftError
from voxsoft.records import Record
from voxsoft.simulation.setup import Setup

#: Called now and then with (steps, time in s, residual).
Progress = Callable[[int, float, float], None] | None


@dataclass(frozen=True)
class Report:
    """What a solver found.

    Attributes
    ----------
    answer
        What the core says.
    status
        How it ended, as far as the core can tell and beyond.
    steps
        Steps of all attempts.
    """

    answer: _core.Answer
    status: _core.Status
    steps: int

    @classmethod
    def of(cls, answer: _core.Answer, earlier: int = 0) -> Report:
        """An answer as it is, after so many steps of earlier attempts."""
        return cls(answer, answer.status, earlier + answer.steps)


#: Settings as used, and what was found.
Answer = tuple[dict[str, Any], Report]


class Watch(NamedTuple):
    """What is seen of a run while it is made.

    Attributes
    ----------
    progress
        Who is told.
    record_interval
        Time between two records of the probes in s; None for the default.
    frames
        Whether all vertices are recorded as well.
    """

    progress: Progress = None
    record_interval: float | None = None
    frames: bool = False


class Method(Record):
    """A way to the answer with its own settings, and no others.

    The settings of a design's :class:`~voxsoft.design.Solver` that a method has a field for are
    used by it; all others are refused. A new method is a subclass with its fields and
    :meth:`solve`, and its place in :mod:`voxsoft.simulation.choice`.
    """

    error_type: ClassVar[type[VoxSoftError]] = SimulationError

    #: What an error calls it, and what it calls it together with others of its family.
    title: ClassVar[str]
    family: ClassVar[str]
    #: Whether it ends when the body is at rest.
    to_rest: ClassVar[bool] = True
    #: Keyword arguments of :func:`~voxsoft.simulation.simulate` that it uses besides its fields.
    extra: ClassVar[frozenset[str]] = frozenset()

    @abstractmethod
    def solve(self, setup: Setup, watch: Watch) -> Answer:
        """Solve a design made ready.

        Parameters
        ----------
        setup
            The design made ready.
        watch
            Who is told, and what is recorded.

        Returns
        -------
        used, report
            The settings as used, as ``result.solver`` tells them, and what was found.
        """
