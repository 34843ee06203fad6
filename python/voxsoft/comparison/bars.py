"""Error bars: discretization errors of the numbers of a run, from runs on voxels of another size.

The run is made again on voxels of another size, and each number that both give is extrapolated
(:mod:`voxsoft.comparison.richardson`). Voxels half as large show more and cost about twelve times
the run; voxels twice as large cost a tenth of it, and show something only while they still are
the same body. So small bodies get finer voxels and large ones coarser. Where two sizes are not
regular, as of walls of one voxel, a third one halves the voxels once more while that is as quick.
Where the first choice is another body, or has no answer, others follow: every run that can be
solved on any other voxels has bars.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from voxsoft.comparison.contact_patch import REGULAR_PATCH, voxels_across
from voxsoft.comparison.error_bar import ErrorBar, ErrorBars
from voxsoft.comparison.number import Number, Numbers
from voxsoft.comparison.numbers import asked_of, frequencies_of, numbers_of
from voxsoft.comparison.other_voxels import TIMES_AS_LONG, cost_on_voxels, on_voxels
from voxsoft.comparison.richardson import Estimate, discretization_error
from voxsoft.design import Design
from voxsoft.design.discretization.discretize import voxels_of
from voxsoft.errors import SimulationError, VoxSoftError
from voxsoft.materials import Lattice
from voxsoft.simulation import Result, Setup, simulate
from voxsoft.simulation.setup.contact import has_contact
from voxsoft.simulation.solving.choice import kind_of, settings_at_rest

#: Most voxels of a finer run that was not asked for, in the part that symmetry leaves: some 10 s
#: for a body of rubber.
FINER_UP_TO: Final = 20_000
#: Same limit where a run takes ten times as long: with contact, friction of tendons, supplies, and
#: control by volume or arc length.
FINER_UP_TO_IF_SLOW: Final = 2_000
#: Multiple of these that a run may have if coarser voxels are another body: about a minute.
IF_NEEDED: Final = 4
#: Ratio of the sizes where neither halved nor doubled voxels have an answer.
LAST_RATIO: Final = 1.5
#: Most voxels of a run for a requested accuracy.
ACCURATE_UP_TO: Final = 400_000
#: Two sizes hold the same body if volumes are the same to this part: those of cut voxels follow
#: the shape to second order, and a wall that is off by more counts in the third power.
SAME_VOLUME: Final = 0.01
#: Voxels through a wall from which on errors are regular; see `richardson`.
REGULAR_WALL: Final = 2
#: Walls of one voxel may hide their error: one and two voxels can give the same number and both be
#: off, as a part of it. Of the 24 thin walls of `evidence/error_bars.py` those with two voxels were
#: 1 to 7.7 % off, and estimates whose sizes agree too well by up to 6.4 %.
HIDDEN_BY_WALLS: Final = 0.1
#: Same part where sizes are not the same body, whose walls may be any, and under a contact patch of
#: few voxels: forces of balls pressed into a block were 3 to 32 % off there, see `contact_patch`.
HIDDEN_BY_SHAPES: Final = 0.25
#: Least error from two sizes, as a part of the number: errors of corners and of free sides have
#: either sign, and may cancel in both. Among 70 bodies with known truth those that two sizes missed
#: agreed within 0.4 %, and all but one were less than this off. Since voxels at re-entrant edges
#: are relieved, two of five that agreed within 0.6 % were 1.5 and 2 % off (verification.md).
UNKNOWN: Final = 0.01
#: Relative change that is rounding: equilibrium or the shape alone sets such a number.
UNCHANGED: Final = 1e-6
#: The part of a vector below which components are rounding.
ROUNDING: Final = 1e-9

#: Called before each further run with the edge of its voxels in m, how many there are about, and
#: about how many seconds it takes.
Announce = Callable[[float, int, float], None]

#: Function that solves a design, given the run on voxels twice as large where that is known.
Solve = Callable[[Design, Result | None], Result]


def error_bars(
    result: Result,
    *,
    progress: Callable[[int, float, float], None] | None = None,
    announce: Announce | None = None,
    solve: Solve | None = None,
    frequencies: int = 0,
) -> ErrorBars:
    """Estimate the discretization errors of a run by further runs on other voxels.

    Parameters
    ----------
    result
        The run. The design's ``solver.error`` and ``solver.accuracy`` select the voxels.
    progress
        See :func:`voxsoft.simulate`.
    announce
        Called before each further run with its voxel size in m, number of voxels, and seconds.
    solve
        Solves the design on other voxels, given the run on voxels twice as large if that is known;
        default: :func:`voxsoft.simulate`.
    frequencies
        Number of natural frequencies that get a bar too, see :func:`voxsoft.modes`; default: none.
        Where one of the runs has no modes the bars say why in `missing`.

    Returns
    -------
    ErrorBars
        No error bars, with the reason, where they cannot be estimated: without an
        equilibrium, in motion over time and for lattices unless `error` or `accuracy` asks for
        them, or where voxels of no other size can be solved. Those of a motion are of its end, with
        the same steps in time.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> beam = families.beam(length="40 mm").with_values("parts.0.material=ecoflex-00-30")
    >>> result = vs.simulate(beam)
    >>> bars = error_bars(result)
    >>> bars.voxel_sizes
    (0.005, 0.0025)
    >>> bar = bars.metrics["max_displacement"]
    >>> abs(bar.value - bar.estimate) < 1.01 * bar.error < 0.02 * bar.estimate
    True
    """
    result = _of_equilibrium(result)
    refusal = _refusal(result)
    if refusal is None and solve is None and result.solver["way"] == "creep":
        refusal = "it has crept along a path over time", "take path_error_bars of the path"
    if refusal is not None:
        return ErrorBars.none(*refusal)
    search = _Search(result, progress, announce, solve, frequencies)
    return search.until_accurate() if _wants_accuracy(result.design) else search.pair()


def _of_equilibrium(result: Result) -> Result:
    """Return the result with settings at rest if its design of motion was solved by statics."""
    design = result.design
    if result.solver["method"] != "statics" or kind_of(design, design.solver).to_rest:
        return result
    at_rest = design.solver.replace(**settings_at_rest())
    return replace(result, design=design.replace(solver=at_rest))


def _refusal(result: Result) -> tuple[str, str] | None:
    """Return why a run has no error bars, with a hint; None if it can have them."""
    design = result.design
    if design.solver.error == "off":
        return 'the solver\'s error is "off"', 'write error = "auto"'
    if result.status != "ok":
        return "the run did not come to rest", "solve that first"
    unasked = design.solver.error == "auto" and not _wants_accuracy(design)
    if unasked and not kind_of(design, design.solver).to_rest:
        return "motion over time has none unless it is asked for", 'write error = "coarser"'
    if result.mesh.voxel_size is None:
        return "the mesh is not made of voxels", "compare several meshes"
    lattice = any(isinstance(design.material_of(part), Lattice) for part in design.parts)
    if lattice and unasked:
        what = "the constants of a lattice are fitted on voxels of one size, and hold its error"
        return what, 'take rubber, or write error = "finer" to see how the size changes it'
    return None


@dataclass
class _Run:
    """Run with the data that decide if another run holds the same bodies."""

    result: Result
    #: Voxel size in m; with several bodies the design's, to which all sizes keep their ratio.
    size: float
    #: Reason and hint why it has no natural frequencies, where these were asked for.
    refused: tuple[str, str] | None = None
    _numbers: Numbers | None = None

    @cached_property
    def setup(self) -> Setup:
        return Setup(self.result.design, self.result.mesh)

    @property
    def voxels(self) -> int:
        return self.setup.elements

    @property
    def solved(self) -> int:
        """Number of voxels in the part that planes of symmetry leave."""
        sector = self.setup.sector
        return self.voxels // (1 if sector is None else sector.count)

    @cached_property
    def patch(self) -> float | None:
        """Voxels across the narrowest contact patch; None without contact."""
        return voxels_across(self.result)

    def numbers(self, frequencies: int) -> Numbers:
        if self._numbers is None:
            self._numbers = numbers_of(self.setup, self.result)
            if frequencies:
                try:
                    self._numbers = {
                        **self._numbers,
                        **frequencies_of(self.result, frequencies),
                    }
                except SimulationError as error:
                    self.refused = f"no natural frequencies: {error.where} {error.what}", error.hint
        return self._numbers

    def doubts(self, finer: _Run) -> dict[str, float]:
        """Say why the errors of this run and a finer one may be no regular ones.

        Each reason has the part of a number that such sizes may hide.
        """
        found = {}
        if not self.is_like(finer):
            found["the voxels are not the same body"] = HIDDEN_BY_SHAPES
        if self.wall < REGULAR_WALL:
            found["walls are single voxels"] = HIDDEN_BY_WALLS
        if self.patch is not None and self.patch < REGULAR_PATCH:
            across = f"{self.patch:.2g}"
            plural = "" if across == "1" else "s"
            found[f"the contact patch is {across} voxel{plural} across"] = HIDDEN_BY_SHAPES
        return found

    @cached_property
    def wall(self) -> int:
        """Voxels through the thinnest wall."""
        design = self.result.design
        alone = [design.alone(name) for name in design.body_names] or [design]
        return min(map(_thinnest_wall, alone)) * design.solver.refine

    def is_like(self, other: _Run) -> bool:
        """Return True if both hold the same body, as far as volumes and extents show."""
        a, b = self.result, other.result
        if len(a.mesh.cavities) != len(b.mesh.cavities):
            return False
        volumes = [(a.metric("volume"), b.metric("volume"))]
        for mine, theirs in zip(a.mesh.cavities, b.mesh.cavities, strict=True):
            volumes.append((float(mine.volume), float(theirs.volume)))
        if a.mesh.fractions is None and b.mesh.fractions is None:
            mine, theirs = np.ptp(a.mesh.vertices, axis=0), np.ptp(b.mesh.vertices, axis=0)
            if not np.allclose(mine, theirs, rtol=0.0, atol=1e-6 * self.size):
                return False
        return all(math.isclose(v, w, rel_tol=SAME_VOLUME) for v, w in volumes)


def _thinnest_wall(design: Design) -> int:
    """Voxels through the thinnest wall of a body."""
    cells = voxels_of(design)
    found = [wall.thickness for wall in cells.cavity_walls]
    if not found and (thinnest := cells.wall_thickness.thinnest) is not None:
        found = [thinnest.thickness]
    return min(found, default=1)


class _Search:
    """Further runs of one result."""

    def __init__(
        self,
        result: Result,
        progress: Callable[[int, float, float], None] | None,
        announce: Announce | None,
        solve: Solve | None,
        frequencies: int,
    ) -> None:
        self.own = _Run(result, result.design.voxel_size)
        self._solve, self._frequencies = solve, frequencies
        self._progress, self._announce = progress, announce
        self._seconds = 0.0
        #: Doubt of bars that stand in for those of voxels without an answer.
        self._failed: dict[str, float] = {}

    def pair(self) -> ErrorBars:
        """Make error bars from one other size, or a third one where two are not regular."""
        asked, limit = self.own.result.design.solver.error, self._limit
        reasons: list[str] = []
        unlike: _Run | None = None
        small = 8 * self.own.solved <= limit
        if asked == "coarser" or (asked == "auto" and not small):
            other = self._solved(2.0 * self.own.size, None)
            if isinstance(other, str):
                reasons.append(f"on voxels twice as large {other}")
            elif asked == "coarser" or other.is_like(self.own):
                return self._bars([other, self.own])
            else:
                unlike = other
                reasons.append("voxels twice as large are another body")
        if asked == "finer" or (asked == "auto" and 8 * self.own.solved <= IF_NEEDED * limit):
            other = self._solved(0.5 * self.own.size, self.own)
            if not isinstance(other, str):
                return self._bars(self._with_third([self.own, other]))
            reasons.append(f"on voxels half as large {other}")
            self._failed["voxels half as large have no answer"] = HIDDEN_BY_SHAPES
        if asked == "auto":
            last = self._last_resort(unlike, small=small)
            if last is not None:
                return self._bars(last)
        hint = "compare several voxel sizes"
        if asked != "finer" and not small:
            about = TIMES_AS_LONG * self.own.result.seconds
            hint = f'error = "finer", which takes about {float(f"{about:.2g}"):g} s'
        return ErrorBars.none("; ".join(reasons), hint)

    @cached_property
    def _limit(self) -> int:
        """Most voxels of a finer run that is taken without more ado."""
        design = self.own.result.design
        rubs = any(tendon.friction > 0.0 for tendon in design.tendons)
        stepwise = self.own.result.solver["way"] in ("volume", "arc-length")
        slow = has_contact(design) or rubs or bool(design.supplies) or stepwise
        return FINER_UP_TO_IF_SLOW if slow else FINER_UP_TO

    def _with_third(self, runs: list[_Run]) -> list[_Run]:
        """Add voxels half as large to two sizes that show no order, if that is as quick."""
        asked = self.own.result.design.solver.error
        quick = 8 * runs[-1].solved <= self._limit
        if asked == "auto" and quick and runs[-2].doubts(runs[-1]):
            other = self._solved(0.5 * runs[-1].size, runs[-1])
            if not isinstance(other, str):
                return [*runs, other]
        return runs

    def _last_resort(self, unlike: _Run | None, *, small: bool) -> list[_Run] | None:
        """Find any other size with an answer, on which bars are wide; None if there is none."""
        if small:
            other = self._solved(2.0 * self.own.size, None)
            unlike = None if isinstance(other, str) else other
        cavities = len(self.own.result.mesh.cavities)
        if unlike is not None and len(unlike.result.mesh.cavities) == cavities:
            return [unlike, self.own]
        if LAST_RATIO**3 * self.own.solved <= IF_NEEDED * self._limit:
            other = self._solved(self.own.size / LAST_RATIO, None)
            if not isinstance(other, str):
                return [self.own, other]
        return None

    def until_accurate(self) -> ErrorBars:
        """Make error bars from ever smaller voxels, until all errors are within the accuracy."""
        runs = [self.own]
        while True:
            if 8 * runs[-1].voxels > ACCURATE_UP_TO:
                other: _Run | str = f"there would be about {8 * runs[-1].voxels:,} voxels"
            else:
                other = self._solved(0.5 * runs[-1].size, runs[-1])
            if isinstance(other, str):
                what = f"the accuracy was not reached: on voxels half as large {other}"
                hint = "ask for less, or begin with other voxels"
                if len(runs) == 1:
                    return ErrorBars.none(what, hint)
                return self._bars(runs, what, hint)
            runs.append(other)
            bars = self._bars(runs)
            for name, target in asked_of(self.own.result.design).items():
                if target.accuracy is not None and name not in bars.metrics:
                    what = f"{name} is the largest of all voxels and has none, so no accuracy"
                    return self._bars(runs, what, "give it a percentile, or leave accuracy out")
            if _is_accurate(bars, self.own.result.design):
                return bars

    def _solved(self, size: float, coarser: _Run | None) -> _Run | str:
        """Solve on other voxels, from the run on voxels twice as large; a text if that fails."""
        design = self.own.result.design
        factor = size / self.own.size
        if self._announce is not None:
            self._announce(size, *cost_on_voxels(self.own.voxels, self.own.result.seconds, factor))
        try:
            other = on_voxels(design, factor)
            begin = None if coarser is None else coarser.result
            if self._solve is None:
                result = simulate(other, progress=self._progress, coarser=begin)
            else:
                result = self._solve(other, begin)
        except VoxSoftError as error:
            return str(error).partition("\n")[0]
        self._seconds += result.seconds
        if _path(result) != _path(self.own.result):
            return (
                "the design is solved with other settings than the run had: write those of the "
                "run into its [solver]"
            )
        return _Run(result, size) if result.status == "ok" else result.message

    def _bars(self, runs: Sequence[_Run], missing: str = "", hint: str = "") -> ErrorBars:
        """Make the bars of runs on falling sizes, of which one is that of the design."""
        doubts = self._failed | runs[-2].doubts(runs[-1])
        hidden = max(doubts.values(), default=0.0)
        own = runs.index(self.own)
        sizes = [run.size for run in runs]
        numbers = [run.numbers(self._frequencies) for run in runs]
        refused = next((run.refused for run in runs if run.refused), None)
        if refused is not None and not missing:
            missing, hint = refused
        bars = {
            key: _bar(sizes, [each[key] for each in numbers], own, hidden)
            for key in numbers[own]
            if all(key in each for each in numbers)
        }
        # A cavity more or less shifts the index of all.
        alike = len({len(run.result.mesh.cavities) for run in runs}) == 1
        shifted = set() if alike else {"volumes", "pressures"}
        if len({len(run.result.snaps) for run in runs}) > 1:
            shifted.add("snaps")
        kept = {key: bar for key, bar in bars.items() if key[0] not in shifted}
        cavities = self.own.result.mesh.cavities
        return ErrorBars.of(
            kept,
            chambers=tuple(
                cavity.name or f"cavity {index}" for index, cavity in enumerate(cavities)
            ),
            voxel_sizes=tuple(sizes),
            voxels=tuple(run.voxels for run in runs),
            doubt=" and ".join(doubts),
            missing=missing,
            hint=hint,
            seconds=self._seconds,
        )


def _bar(sizes: Sequence[float], numbers: Sequence[Number], own: int, hidden: float) -> ErrorBar:
    """Make the bar of one number on falling sizes; two that are not regular may hide a part."""
    regular = not hidden
    # Components that symmetry makes zero hold only rounding.
    rounding = ROUNDING * max(number.scale for number in numbers)
    values = [each.value if abs(each.value) > rounding else 0.0 for each in numbers]
    last = numbers[-1]
    found: Estimate = discretization_error(sizes[-3:], values[-3:], regular=regular)
    error = found.error
    if abs(values[-1] - values[-2]) > UNCHANGED * abs(values[-1]):
        further = len(values) - 2
        # A halving more leaves a quarter of that.
        least = (0.0 if further else UNKNOWN) if regular else hidden / 4**further
        error = max(error, least * (last.deformed if values[-1] else 0.0))
    return ErrorBar.within(values[own], found.limit, error, last.kind, last.bounds)


def _path(result: Result) -> tuple[object, ...]:
    """Return the solver settings that decide which state a run ends in, and on which voxels."""
    used = result.solver
    control = used["way"] if used["way"] in ("volume", "arc-length") else "load"
    return control, used.get("volume_ratio"), used.get("refine")


def _wants_accuracy(design: Design) -> bool:
    """Return True if the design, or one of its goals, asks for an accuracy."""
    goals = any(target.accuracy is not None for target in asked_of(design).values())
    return goals or design.solver.accuracy is not None


def _is_accurate(bars: ErrorBars, design: Design) -> bool:
    """Return True if errors are small enough: goals by their own accuracy, else by the design's.

    Probes, or without them and without goals the largest displacement, are held to the design's.
    """
    for name, target in asked_of(design).items():
        accuracy = design.solver.accuracy if target.accuracy is None else target.accuracy
        bar = bars.metrics.get(name)
        if bar is None or accuracy is None:
            continue
        if bar.unknown or bar.error > accuracy * abs(bar.estimate):
            return False
    if design.solver.accuracy is None:
        return True
    pairs = [
        (math.hypot(*(bar.estimate for bar in each)), math.hypot(*(bar.error for bar in each)))
        for each in bars.probes.values()
    ]
    if not pairs and not asked_of(design):
        moved = bars.metrics["max_displacement"]
        pairs = [(abs(moved.estimate), moved.error)]
    # NaN stands for unknown, and a comparison with it does not hold.
    return all(error <= design.solver.accuracy * size for size, error in pairs)
