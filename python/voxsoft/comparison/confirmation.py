"""The best designs of a study solved again: as rubber, on finer voxels, with error bars.

A study ranks by quick runs: the paper's spring lattice, few voxels. These slower runs check for
the first few of its ranking if the best design stays the best.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from voxsoft.comparison.richardson import Estimate, discretization_error
from voxsoft.design import Design
from voxsoft.errors import VoxSoftError
from voxsoft.materials import card_names
from voxsoft.simulation import Result, simulate
from voxsoft.simulation.compatibility import refuse
from voxsoft.study import StudyResult, Trial

#: Suffix of a card of the paper's material; the name without it is the rubber of the same silicone.
_LATTICE: Final = "-lattice"

#: Called before each run with how many are done and how many there are.
ProgressCallback = Callable[[int, int], None]


@dataclass(frozen=True)
class Confirmed:
    """One design of a study, solved again.

    Attributes
    ----------
    trial
        Its trial in the study.
    estimate
        The study's first objective on the study's voxels and on finer ones, and the error of the
        finest; None if a run failed.
    message
        Reason why there is no estimate; empty if there is one.
    warnings
        Warnings about the finest result.
    """

    trial: Trial
    estimate: Estimate | None
    message: str = ""
    warnings: tuple[str, ...] = ()

    @property
    def value(self) -> float | None:
        """The objective on the finest voxels, in SI units."""
        return None if self.estimate is None else self.estimate.values[-1]


@dataclass(frozen=True)
class Confirmation:
    """The first designs of a ranking, solved again.

    Attributes
    ----------
    objective
        Name of the objective that ranks them.
    materials
        Replaced cards by name, with their replacements; empty where nothing was exchanged.
    voxel_sizes
        Sizes in m, falling.
    designs
        Designs in the order of the study.
    maximize
        True if more is better.
    """

    objective: str
    materials: Mapping[str, str]
    voxel_sizes: tuple[float, ...]
    designs: tuple[Confirmed, ...]
    maximize: bool

    @property
    def ranking(self) -> tuple[Confirmed, ...]:
        """The designs that came to rest, best first."""
        solved = [found for found in self.designs if found.value is not None]
        sign = -1.0 if self.maximize else 1.0
        return tuple(sorted(solved, key=lambda found: sign * (found.value or 0.0)))

    @property
    def within_the_error(self) -> bool:
        """True if the error bars of the best and the second overlap."""
        first = [found.estimate for found in self.ranking[:2] if found.estimate is not None]
        if len(first) < 2:
            return False
        best, second = first
        return abs(best.values[-1] - second.values[-1]) <= best.error + second.error

    @property
    def sentence(self) -> str:
        """Sentence on the study's ranking."""
        failed = [found for found in self.designs if found.estimate is None]
        if len(self.designs) == 1 and not failed:
            return "the design was solved again; one alone has no ranking"
        if len(self.ranking) < 2:
            return "too few of the designs could be solved again to rank them"
        kept = [found.trial.number for found in self.designs if found.estimate is not None]
        now = [found.trial.number for found in self.ranking]
        order = ", ".join(str(self._place(number)) for number in now)
        words = "the ranking is the same" if kept == now else f"the ranking differs: now {order}"
        if self.within_the_error:
            words += "; the first two are within their errors of each other"
        return words + (f"; {len(failed)} could not be solved again" if failed else "")

    def _place(self, number: int) -> int:
        return 1 + [found.trial.number for found in self.designs].index(number)

    def summary(self) -> dict[str, Any]:
        """Everything as plain data in SI units (``"confirmed"`` in the ``--json`` of a study)."""
        return {
            "objective": self.objective,
            "materials": dict(self.materials),
            "voxel_sizes": list(self.voxel_sizes),
            "designs": [
                {
                    "trial": found.trial.number,
                    "parameters": dict(found.trial.parameters),
                    "in_the_study": found.trial.objectives[self.objective],
                    "value": found.value,
                    "error": None if found.estimate is None else found.estimate.error,
                    "message": found.message,
                    "warnings": list(found.warnings),
                }
                for found in self.designs
            ],
            "ranking": [found.trial.number for found in self.ranking],
            "within_the_error": self.within_the_error,
            "sentence": self.sentence,
        }


def as_rubber(design: Design) -> tuple[Design, dict[str, str]]:
    """Replace the cards of the paper's spring lattice by the rubber of the same silicone.

    Returns
    -------
    design, materials
        The design, and the replaced cards with their replacements.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> beam = families.beam().with_values("parts.0.material=ecoflex-00-30-lattice")
    >>> as_rubber(beam)[1]
    {'ecoflex-00-30-lattice': 'ecoflex-00-30'}
    """
    exchanged: dict[str, str] = {}
    for index, part in enumerate(design.parts):
        name = part.material
        if not isinstance(name, str) or name in design.materials:
            continue
        rubber = name.removesuffix(_LATTICE)
        if rubber != name and rubber in card_names():
            design = design.with_values(f"parts.{index}.material={rubber}")
            exchanged[name] = rubber
    return design, exchanged


def confirm(
    design: Design,
    study: StudyResult,
    *,
    count: int = 3,
    halvings: int = 1,
    progress: ProgressCallback | None = None,
) -> Confirmation:
    """Solve the first designs of a study's ranking again, as rubber and on finer voxels.

    Parameters
    ----------
    design
        The study's family.
    study
        Result of the study.
    count
        Number of designs, from the best on, at least 1. Trials of the same design count once.
    halvings
        Number of times the voxels are halved; the error is estimated from all sizes
        (:func:`voxsoft.comparison.discretization_error`).
    progress
        Called before each run.

    Examples
    --------
    >>> import tempfile
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> beam = families.beam(length="40 mm").with_values("parts.0.material=ecoflex-00-30-lattice")
    >>> space = {"length": ["40 mm", "50 mm"]}
    >>> study = vs.Study(beam, space, folder=tempfile.mkdtemp())
    >>> again = confirm(beam, study.grid(workers=1), count=2)
    >>> again.sentence
    'the ranking is the same'
    """
    refuse(design, "confirmation")
    rubber, materials = as_rubber(design)
    first = next(iter(study.objectives))
    trials = [trial for trial in study.ranking if trial.same_as is None][:count]
    sizes = tuple(design.voxel_size / 2**power for power in range(halvings + 1))
    designs: list[Confirmed] = []
    for index, trial in enumerate(trials):
        variant = rubber.with_parameters(**dict(trial.parameters))
        results: list[Result] = []
        message = ""
        for step, size in enumerate(sizes):
            if progress is not None:
                progress(index * len(sizes) + step, len(trials) * len(sizes))
            try:
                result = simulate(variant.with_values(f"voxel_size={size * 1e3!r} mm"))
            except VoxSoftError as error:
                message = str(error)
                break
            if result.status != "ok":
                message = result.message
                break
            results.append(result)
        designs.append(_confirmed(trial, first, sizes, results, message))
    maximize = study.objectives[first].direction == "maximize"
    return Confirmation(first, materials, sizes, tuple(designs), maximize)


def _confirmed(
    trial: Trial, objective: str, sizes: Sequence[float], results: Sequence[Result], message: str
) -> Confirmed:
    if message:
        return Confirmed(trial, None, message)
    values = [result.metrics[objective] for result in results]
    warnings = tuple(str(warning) for warning in results[-1].warnings)
    return Confirmed(trial, discretization_error(sizes, values), warnings=warnings)
