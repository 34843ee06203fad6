"""Specs: all inputs that decide the results of a job, as typed values."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from voxsoft.comparison.defaults import (
    DEFAULT_SOLVERS,
    DEFAULT_SPLITS,
    DEFAULT_TIME_LIMIT,
    Outside,
)
from voxsoft.design import Constraint, Design, Objective
from voxsoft.errors import StudyError, VoxSoftError
from voxsoft.files.cards import card_name
from voxsoft.jobs.source import DesignSource, MeasuredTable
from voxsoft.records import FrozenDict, Record
from voxsoft.records.table import Table
from voxsoft.study.space import Choices, Range
from voxsoft.units import PositiveTime

Scalar = bool | int | float | str
Bounds = tuple[float | str, float | str]


def _source(given: Any) -> Any:  # noqa: ANN401 - pydantic checks other values
    return DesignSource.of_design(given) if isinstance(given, Design) else given


def _domain(given: Any) -> Any:  # noqa: ANN401 - pydantic checks other values
    return {"values": given} if isinstance(given, list) else given


Domain = Annotated[Range | Choices, BeforeValidator(_domain)]


class JobSpec(Record):
    """Fields of the specs of all jobs: the design, which may be given as a Design."""

    error_type: ClassVar[type[VoxSoftError]] = StudyError

    kind: str
    design: Annotated[DesignSource, BeforeValidator(_source)]

    @property
    def tables(self) -> tuple[MeasuredTable, ...]:
        """Measured tables of the job."""
        return ()


class RunSpec(JobSpec):
    """Bring a design to rest, or to its end time.

    Parameters
    ----------
    design
        A :class:`DesignSource`, or a :class:`~voxsoft.design.Design`.
    solver
        Settings in place of those of the design.
    over
        A path to follow, as :func:`voxsoft.follow` reads it: ``"loads[0].value=0..30 kPa/16"``.
    figure
        True to draw ``body.png`` too, ``contact.png`` where something touches, and ``path.png``
        of a path.
    frequencies
        Number of natural frequencies to find at the end, with error bars; default: none.
    frames
        Interval at which the body is kept over time, in ``frames.npz``; default: at the end alone.
    kept
        True if the folder holds the state on the studio's screen, which no job repeats.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> RunSpec(design=families.beam(), solver={"method": "xpbd"}).kind
    'run'
    """

    kind: Literal["run"] = "run"
    solver: Table[str, Scalar] = Field(default_factory=FrozenDict)
    over: str | None = None
    figure: bool = False
    frequencies: int = Field(0, ge=0)
    frames: PositiveTime | None = None
    kept: bool = False

    @model_validator(mode="after")
    def _keeps_all_of_a_path(self) -> Self:
        if self.over is not None and self.frames is not None:
            what = "are of a motion over time, and a path keeps all of its states"
            raise StudyError("frames", what, "leave them out")
        return self


class Stage(Record):
    """A part of a study that ended before the present one began, by another search or budget.

    Parameters
    ----------
    sampler, batch
        See :class:`StudySpec`.
    budget
        Number of trials that the study held at its end.
    """

    error_type: ClassVar[type[VoxSoftError]] = StudyError

    sampler: str
    budget: int = Field(ge=1)
    batch: int | None = Field(None, ge=1)


class StudySpec(JobSpec):
    """Solve many designs: all of a grid (a sweep), or suggestions of a sampler (an optimization).

    Parameters
    ----------
    sampler, batch, workers, seed
        See :meth:`voxsoft.study.Study.optimize`; the number of workers changes no result.
    budget
        Number of trials in the end; None for a grid, which ends with its last point.
    space, objectives, constraints
        In place of those of the design.
    over
        A path that each design is followed along, ``"loads[0].value=0..30 kPa/8"``.
    confirm
        Number of the best designs that are solved again, as rubber and on finer voxels.
    earlier
        Trials that the study held when this part of it began. Suggestions depend on where an
        earlier budget cut a batch, so that a repetition goes the same way.
    """

    kind: Literal["study"] = "study"
    sampler: str = "grid"
    budget: int | None = Field(None, ge=1)
    batch: int | None = Field(None, ge=1)
    seed: int = 0
    workers: int | None = Field(None, ge=1)
    space: Table[str, Domain] | None = None
    objectives: Table[str, Objective] | None = None
    constraints: Table[str, Constraint] | None = None
    over: str | None = None
    confirm: int = Field(0, ge=0)
    earlier: tuple[Stage, ...] = ()

    @model_validator(mode="after")
    def _has_a_budget(self) -> Self:
        if self.sampler != "grid" and self.budget is None:
            raise StudyError("budget", "is missing", "say how many trials; a grid needs none")
        if self.over is not None and self.confirm:
            what = "solves single equilibria again, and this study follows paths"
            hint = "leave it out; voxsoft run --over gives the path of the best with error bars"
            raise StudyError("confirm", what, hint)
        return self


class CalibrateSpec(JobSpec):
    """Fit the design's material to measurements.

    Parameters
    ----------
    data
        The measured tables.
    bounds
        Range of each constant, as the `parameters` of :func:`voxsoft.calibration.calibrate`.
    method, generations, population, free_scale, refine, identify, seed, workers
        See :func:`voxsoft.calibration.calibrate`.
    card
        Name of the material card; default: that of the material or file that was measured.
    """

    kind: Literal["calibrate"] = "calibrate"
    data: tuple[MeasuredTable, ...] = Field(min_length=1)
    method: str = "genetic"
    generations: int = Field(50, ge=1)
    population: int = Field(30, ge=4)
    bounds: Table[str, Bounds] | None = None
    free_scale: bool = False
    refine: bool = True
    identify: bool = True
    seed: int = 0
    workers: int | None = Field(None, ge=1)
    card: str | None = None

    @property
    def tables(self) -> tuple[MeasuredTable, ...]:
        """Measured tables."""
        return self.data

    @property
    def card_name(self) -> str:
        """Name of the card that the calibration writes."""
        first = self.data[0]
        stem = first.name.rpartition(".")[0] or first.name
        return self.card or card_name(first.select or stem)


class CompareSpec(JobSpec):
    """Solve a design in several ways, with estimates of their errors.

    Parameters
    ----------
    data
        Measured tables of the real body.
    solvers, outside, voxel_sizes, splits, time_limit
        See :func:`voxsoft.compare`; sizes in m, the time in s.
    """

    kind: Literal["compare"] = "compare"
    data: tuple[MeasuredTable, ...] = ()
    solvers: tuple[str, ...] = DEFAULT_SOLVERS
    outside: Outside = "auto"
    voxel_sizes: tuple[float, ...] | None = None
    splits: tuple[int, ...] = DEFAULT_SPLITS
    time_limit: float = DEFAULT_TIME_LIMIT

    @property
    def tables(self) -> tuple[MeasuredTable, ...]:
        """Measured tables."""
        return self.data


#: Spec of a job; `kind` distinguishes them.
Spec = RunSpec | StudySpec | CalibrateSpec | CompareSpec

#: Spec as a field of a record, discriminated by `kind`.
TaggedSpec = Annotated[Spec, Field(discriminator="kind")]
