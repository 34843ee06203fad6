"""Choices about how a design is solved."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from pydantic import Discriminator, Field, Tag

from voxsoft.records import Record
from voxsoft.units import NonNegativeRate, NonNegativeTime, PositiveTime, Proportion


def _named_or_rate(value: object) -> str:
    return "named" if value in ("auto", "critical") else "rate"


Count = Annotated[int, Field(ge=1, le=100_000)]
Damping = Annotated[
    Annotated[Literal["auto", "critical"], Tag("named")] | Annotated[NonNegativeRate, Tag("rate")],
    Discriminator(_named_or_rate),
]
Ratio = Annotated[float, Field(gt=0)]
Share = Annotated[float, Field(gt=0, le=1)]

#: Settings that ask how large the error is, and change no result.
OF_THE_ERROR: Final = frozenset({"error", "accuracy"})
Tolerance = Annotated[float, Field(gt=0, lt=1)]


class Solver(Record):
    """Solver settings; entries left out are chosen from the design and reported.

    These flat settings choose one of the methods of :mod:`voxsoft.simulation.solving.choice`, each
    a type with its own settings: load, arc-length and volume control of statics, relaxation,
    dynamics to rest or to an end time. A setting that the method has no field for is refused when
    the design is checked or solved.

    Parameters
    ----------
    method
        ``"statics"``: the equilibrium by Newton's method; ``"relaxation"``: to rest, without a
        time; ``"dynamics"``: motion over time, to rest or to an end time; ``"xpbd"``: dynamics if
        another setting asks for it, else relaxation; ``"auto"`` (default): statics if every part is
        hyperelastic or there are layers, and nothing asks for motion over time, else xpbd; slender
        bodies that its relaxation would take long for are solved by statics too.
    refine
        Solve on every voxel cut into this many along each axis: the same body, smaller
        elements. Default 1.
    time_step
        Dynamics only. Length of one step in seconds; smaller is more accurate in motion, and no
        different at rest.
    substeps
        Dynamics only. Substeps of each step, at least 1.
    iterations
        Dynamics only. Passes over the constraints in each substep, at least 1.
    damping
        Decay rate of velocities in 1/s, or ``"critical"`` (the lowest mode does not swing): both
        ask for dynamics; or ``"auto"`` (the fastest way to rest).
    retardation
        Dynamics only. How slowly the material gives way: the retardation time of Kelvin–Voigt
        damping in seconds, by which stress follows strain and its rate.
    tolerance
        Largest residual force at rest, relative to the load. Not used with an `end_time`.
    max_time
        Dynamics without an `end_time` only. Simulated time after which a run that is not at rest
        stops.
    end_time
        Dynamics only. Run to this time exactly, at rest or not: for motion over time.
    control
        Statics only. ``"load"`` (default): all loads grow together; ``"arc-length"``: the
        same, followed through snaps; ``"volume"``: other loads first, then the pressurized volume
        grows to ``volume_ratio`` and the pressure follows, past the limit of a balloon.
        All three know contact; with ``"arc-length"`` objects that are free are refused.
    steps
        Arc-length and volume control only: the steps; default 20. With friction a step takes at
        most a twentieth of the load or the growth: an arc that turns needs more of them.
    volume_ratio
        Volume control only: the pressurized volume at its end over that without pressure;
        default 1.5.
    first_step
        Load and arc-length control only: the first step of the path, as a part of the full load;
        default 1, or an arc of 0.2.
    error
        Method for the discretization error of a run: on ``"finer"`` voxels, half as large; on
        ``"coarser"`` ones, twice as large; by ``"auto"`` (default), finer ones for small bodies and
        coarser ones for others, where they are still the same body; or not at all, ``"off"``.
        It changes no result.
    accuracy
        The error that a run may leave, as a part of each probe's displacement and of each
        objective and constraint, ``"2 %"``: it goes to voxels as small as that takes.

    Examples
    --------
    >>> Solver(damping="5 1/s", substeps=4).damping
    5.0
    """

    method: Literal["auto", "statics", "relaxation", "dynamics", "xpbd"] = "auto"
    refine: int = Field(1, ge=1, le=16)
    time_step: PositiveTime | None = None
    substeps: Count | None = None
    iterations: Count | None = None
    damping: Damping | None = None
    retardation: NonNegativeTime | None = None
    tolerance: Tolerance | None = None
    max_time: PositiveTime | None = None
    end_time: PositiveTime | None = None
    control: Literal["load", "arc-length", "volume"] | None = None
    steps: Count | None = None
    volume_ratio: Ratio | None = None
    first_step: Share | None = None
    error: Literal["auto", "coarser", "finer", "off"] = "auto"
    accuracy: Proportion | None = None

    @property
    def is_timed(self) -> bool:
        """True if a run ends at a time, at rest or not."""
        return self.end_time is not None
