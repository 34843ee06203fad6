"""Result of a study."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, get_args

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import Shown, counted, rounded
from voxsoft.design import Constraint, Objective
from voxsoft.errors import MissingPackageError, StorageError, StudyError
from voxsoft.metrics import METRICS
from voxsoft.records import closest
from voxsoft.simulation import Diagnostic, Status
from voxsoft.study.bounds import broken_by_all
from voxsoft.study.indexed_cavities import switched_cavities
from voxsoft.study.plateau import alike, repeated, spans
from voxsoft.study.space import Domain
from voxsoft.study.trial import Trial
from voxsoft.units import format_quantity

if TYPE_CHECKING:
    import pandas as pd


#: Number of trials that a printed result lists.
_SHOWN: Final = 3


@dataclass(frozen=True, repr=False)
class StudyResult(Shown):
    """All finished trials of a study.

    Attributes
    ----------
    name
        Name of the study.
    folder
        Folder of the study, or None for a database.
    trials
        Every finished trial in order of its number, whatever its status.
    objectives
        Objectives by name.
    parameters
        Names of the parameters, in the order of the space.
    kinds
        Kind of quantity of each parameter by name (a key of :data:`voxsoft.units.KINDS`); empty
        where the family is a function, for which they are unknown.
    over
        Path that each design was followed along; None where each was solved once.
    constraints
        Constraints by name.
    space
        Range or choices of each parameter by name.
    """

    name: str
    folder: Path | None
    trials: tuple[Trial, ...]
    objectives: Mapping[str, Objective]
    parameters: tuple[str, ...]
    kinds: Mapping[str, str] = field(default_factory=dict)
    over: str | None = None
    constraints: Mapping[str, Constraint] = field(default_factory=dict)
    space: Mapping[str, Domain] = field(default_factory=dict)

    def _lines(self) -> Iterator[str]:
        found = [f"{number:,} {status}" for status, number in self.counts.items() if number]
        yield f"{self.name}: {counted(len(self.trials), 'trial')}: {', '.join(found) or 'none'}"
        for rank, trial in enumerate(self.ranking[:_SHOWN], start=1):
            yield f"{rank}. {self._in_words(trial)}"
        if len(self.objectives) > 1:
            yield f"{counted(len(self.pareto_front), 'trial')} on the Pareto front"

    def _in_words(self, trial: Trial) -> str:
        sizes = [f"{k} {_quantity(v, self.kinds.get(k))}" for k, v in trial.parameters.items()]
        asked = self.objectives.items()
        values = [
            f"{name} {_quantity(trial.objectives[name], _kind_of(target))}"
            for name, target in asked
        ]
        return f"{', '.join(values)} at {', '.join(sizes)}"

    def _repr_html_(self) -> str:
        """Show the table of all trials, as pandas does."""
        return str(self.table().to_html(max_rows=20))

    @property
    def counts(self) -> dict[Status, int]:
        """Number of trials by status; every status is there, also with 0."""
        found = Counter(trial.status for trial in self.trials)
        return {status: found[status] for status in get_args(Status)}

    @property
    def best(self) -> Trial | None:
        """Best feasible trial by the first objective, or None if there is none."""
        return self.ranking[0] if self.ranking else None

    @cached_property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """Warnings: designs are one body, a cavity index switches, or none is allowed."""
        return (
            *switched_cavities(self.trials),
            *repeated(self.trials),
            *broken_by_all(self.trials, self.constraints),
        )

    @cached_property
    def distinct(self) -> int:
        """Number of distinct bodies among the solved designs, by all of their metrics."""
        return len(alike(trial for trial in self.trials if trial.status == "ok"))

    @cached_property
    def ranks(self) -> tuple[int, ...]:
        """Rank of each trial of :attr:`ranking`; designs that are one body share a place."""
        places: dict[int, int] = {}
        for group in alike(self.ranking):
            first = 1 + min(self.ranking.index(trial) for trial in group)
            places |= {trial.number: first for trial in group}
        return tuple(places[trial.number] for trial in self.ranking)

    @cached_property
    def plateau(self) -> dict[str, tuple[float, float]]:
        """Range of each parameter in which the best design stays one body; SI units."""
        groups = alike(self.ranking)
        return spans(groups[0]) if groups else {}

    @cached_property
    def ranking(self) -> tuple[Trial, ...]:
        """Feasible trials, best by the first objective first."""
        return self.ranked_by(next(iter(self.objectives)))

    def ranked_by(self, objective: str) -> tuple[Trial, ...]:
        """Return the feasible trials, best first; equal ones in order of their number.

        Parameters
        ----------
        objective
            Name of the objective to rank by.

        Raises
        ------
        StudyError
            An unknown objective.
        """
        name = self._objective(objective)
        sign = self._sign(name)
        feasible = [trial for trial in self.trials if trial.feasible]
        return tuple(sorted(feasible, key=lambda trial: sign * trial.objectives[name]))

    @cached_property
    def pareto_front(self) -> tuple[Trial, ...]:
        """Feasible trials that no other beats in one objective without losing in another.

        Sorted by the first objective, best first. Among trials with the same design only the
        first is listed.
        """
        candidates = [trial for trial in self.ranking if trial.same_as is None]
        costs = np.array([self._costs(trial) for trial in candidates])
        return tuple(
            trial
            for trial, cost in zip(candidates, costs, strict=True)
            if not ((costs <= cost).all(axis=1) & (costs < cost).any(axis=1)).any()
        )

    def scatter(
        self, objective: str | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the data of a scatter plot of parameters colored by an objective.

        Parameters
        ----------
        objective
            Default: the first.

        Returns
        -------
        points : (m, p) array
            Parameters in SI units, in the order of :attr:`parameters`. Choices that are no
            numbers are numbered in the order in which they appear.
        values : (m,) array
            The objective in SI units.
        """
        name = self._objective(objective)
        ok = [trial for trial in self.trials if trial.status == "ok"]
        columns = [_numbers([trial.parameters[key] for trial in ok]) for key in self.parameters]
        values = np.array([trial.objectives[name] for trial in ok], dtype=np.float64)
        return np.column_stack(columns), values

    def history(
        self, objective: str | None = None
    ) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
        """Return the history of an objective over the trials.

        Parameters
        ----------
        objective
            Default: the first.

        Returns
        -------
        numbers : (m,) array
            Numbers of the feasible trials.
        values : (m,) array
            Their objective in SI units.
        best : (m,) array
            The best value up to each of them.
        """
        name = self._objective(objective)
        feasible = [trial for trial in self.trials if trial.feasible]
        numbers = np.array([trial.number for trial in feasible], dtype=np.int64)
        values = np.array([trial.objectives[name] for trial in feasible], dtype=np.float64)
        sign = self._sign(name)
        return numbers, values, sign * np.minimum.accumulate(sign * values)

    def table(self) -> pd.DataFrame:
        """Return one row for each trial.

        Returns
        -------
        pandas.DataFrame
            Columns: ``number``, ``status``, the parameters, the objectives, other metrics,
            ``feasible``, ``same_as`` (the trial that solved the same design), ``seconds``,
            ``hash``, ``message``, ``warnings``. SI units; missing numbers are NaN, never 0. A name
            that is taken gets its role in brackets, ``number (parameter)``.
        """
        import pandas as pd

        measured = dict.fromkeys(
            name for trial in self.trials for name in trial.metrics if name not in self.objectives
        )
        before: dict[str, Any] = {
            "number": [trial.number for trial in self.trials],
            "status": [trial.status for trial in self.trials],
        }
        after: dict[str, Any] = {
            "feasible": [trial.feasible for trial in self.trials],
            "same_as": pd.array([trial.same_as for trial in self.trials], dtype="Int64"),
            "seconds": [trial.seconds for trial in self.trials],
            "hash": [trial.hash for trial in self.trials],
            "message": [trial.message for trial in self.trials],
            "warnings": ["; ".join(trial.warnings) for trial in self.trials],
        }
        columns: dict[str, Any] = {}

        def add(name: str, what: str, values: list[Any]) -> None:
            taken = name in before or name in columns or name in after
            columns[f"{name} ({what})" if taken else name] = values

        for name in self.parameters:
            add(name, "parameter", [trial.parameters.get(name) for trial in self.trials])
        for name in self.objectives:
            add(name, "objective", [trial.objectives.get(name, np.nan) for trial in self.trials])
        for name in measured:
            add(name, "metric", [trial.metrics.get(name, np.nan) for trial in self.trials])
        return pd.DataFrame(before | columns | after)

    def paths(self) -> pd.DataFrame:
        """Return the paths that designs were followed along, one row for each equilibrium.

        Returns
        -------
        pandas.DataFrame
            Columns: ``number`` (the trial), the key that changed, and each objective and
            constraint, in SI units; empty without paths.

        Examples
        --------
        >>> import tempfile
        >>> from concurrent.futures import ThreadPoolExecutor
        >>> from voxsoft.design import families
        >>> from voxsoft.study import Study
        >>> over = "loads[0].value=0..1 kPa/3"
        >>> space = {"wall": ["2.5 mm"]}
        >>> with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor() as threads:
        ...     study = Study(families.pneunet(chambers=2), space, over=over, folder=folder)
        ...     paths = study.grid(executor=threads).paths()
        >>> list(paths), len(paths)
        (['number', 'loads[0].value', 'bend'], 3)
        """
        import pandas as pd

        rows = [
            pd.DataFrame({"number": trial.number, **trial.path})
            for trial in self.trials
            if trial.path
        ]
        return pd.concat(rows, ignore_index=True) if rows else pd.DataFrame()

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write :meth:`table` as comma-separated text.

        Raises
        ------
        StudyError
            The file cannot be written.
        """
        _write(path, lambda: self.table().to_csv(path, index=False))

    def to_parquet(self, path: str | os.PathLike[str]) -> None:
        """Write :meth:`table` as a Parquet file.

        Raises
        ------
        MissingPackageError
            The package `pyarrow` is not installed.
        StudyError
            The file cannot be written.
        """
        if find_spec("pyarrow") is None:
            raise MissingPackageError(
                "to_parquet", "needs the package pyarrow", "pip install pyarrow"
            )
        _write(path, lambda: self.table().to_parquet(path, index=False, engine="pyarrow"))

    def summary(self) -> dict[str, Any]:
        """Return plain data in SI units: the ``--json`` of ``sweep`` and ``optimize``."""
        best = self.best
        return {
            "trials": len(self.trials),
            "counts": dict(self.counts),
            "distinct": self.distinct,
            "best": None
            if best is None
            else {
                "number": best.number,
                "parameters": dict(best.parameters),
                "plateau": {name: list(ends) for name, ends in self.plateau.items()},
                "objectives": dict(best.objectives),
                "warnings": list(best.warnings),
            },
            "pareto_front": [trial.number for trial in self.pareto_front],
            "warnings": [warning.summary() for warning in self.warnings],
            "folder": None if self.folder is None else str(self.folder),
        }

    def _objective(self, name: str | None) -> str:
        if name is None:
            return next(iter(self.objectives))
        if name not in self.objectives:
            raise StudyError("objective", f'"{name}" is not known', closest(name, self.objectives))
        return name

    def _sign(self, objective: str) -> float:
        """Return 1 where smaller is better, -1 where larger is."""
        return 1.0 if self.objectives[objective].direction == "minimize" else -1.0

    def _costs(self, trial: Trial) -> list[float]:
        return [self._sign(name) * trial.objectives[name] for name in self.objectives]


def _kind_of(target: Objective) -> str | None:
    return METRICS[target.metric].kind if target.metric in METRICS else None


def _quantity(value: object, kind: str | None) -> str:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return f"{value:.4g}" if kind is None else format_quantity(rounded(value), kind)


def _numbers(values: list[Any]) -> NDArray[np.float64]:
    if all(isinstance(value, int | float) for value in values):
        return np.array(values, dtype=np.float64)
    order = {value: float(index) for index, value in enumerate(dict.fromkeys(values))}
    return np.array([order[value] for value in values], dtype=np.float64)


def _write(path: str | os.PathLike[str], write: Callable[[], object]) -> None:
    try:
        write()
    except OSError as error:
        reason = error.strerror or str(error)
        raise StorageError(os.fspath(path), f"cannot be written: {reason}") from None
