"""Base class of the solution methods that a design's settings choose from."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from voxsoft import _core
from voxsoft.errors import SimulationError, VoxSoftError
from voxsoft.records import Record
from voxsoft.simulation.setup.setup import Setup

#: Called now and then with (steps, time in s, residual).
Progress = Callable[[int, float, float], None] | None


@dataclass(frozen=True)
class Report:
    """Report of a solver.

    Attributes
    ----------
    answer
        The answer of the core.
    status
        Final status: that of the core, or one derived from it.
    steps
        Steps of all attempts.
    """

    answer: _core.Answer
    status: _core.Status
    steps: int

    @classmethod
    def of(cls, answer: _core.Answer, earlier: int = 0) -> Report:
        """Wrap an answer as it is, after so many steps of earlier attempts."""
        return cls(answer, answer.status, earlier + answer.steps)


#: Settings as used, and the report.
Answer = tuple[dict[str, Any], Report]


class Watch(NamedTuple):
    """Options to observe a run while it is solved.

    Attributes
    ----------
    progress
        Callback for the progress.
    record_interval
        Interval between two records of the probes in s; None for the default.
    frames
        True to record all vertices as well.
    """

    progress: Progress = None
    record_interval: float | None = None
    frames: bool = False


class Method(Record):
    """Solution method with its own settings, and no others.

    The settings of a design's :class:`~voxsoft.design.Solver` that a method has a field for are
    used by it; all others are refused. A new method is a subclass with its fields and
    :meth:`solve`, and its place in :mod:`voxsoft.simulation.solving.choice`.
    """

    error_type: ClassVar[type[VoxSoftError]] = SimulationError

    #: Name in errors, and common name with other methods of its family.
    title: ClassVar[str]
    family: ClassVar[str]
    #: True if it ends when the body is at rest.
    to_rest: ClassVar[bool] = True
    #: Keyword arguments of :func:`~voxsoft.simulation.simulate` that it uses besides its fields.
    extra: ClassVar[frozenset[str]] = frozenset()

    @abstractmethod
    def solve(self, setup: Setup, watch: Watch) -> Answer:
        """Solve a prepared design.

        Parameters
        ----------
        setup
            The prepared design.
        watch
            Progress callback and recording options.

        Returns
        -------
        used, report
            The settings as used, as in ``result.solver``, and the report.
        """
