"""Study: made, run and resumed by a user."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from functools import partial
from math import prod
from pathlib import Path
from typing import Any, TypeVar

from optuna.distributions import BaseDistribution
from optuna.samplers import BaseSampler

from voxsoft._folders import folder_name
from voxsoft.design import Constraint, Design, Objective, families, require_design
from voxsoft.errors import StudyError
from voxsoft.metrics.own import own_metrics
from voxsoft.search.optuna_bridge import BaseStorage, FrozenTrial, StoredStudy
from voxsoft.search.samplers import SINGLE_OBJECTIVE, grid_values
from voxsoft.simulation.runs.over import Over
from voxsoft.study.definition import definition
from voxsoft.study.equilibria import FOLDER, Equilibria
from voxsoft.study.event import ProgressCallback
from voxsoft.study.gate import Gate
from voxsoft.study.outcome import Evaluate, evaluate_design, evaluate_path, evaluate_with_metrics
from voxsoft.study.proposals import (
    Proposals,
    grid_proposals,
    sampled_proposals,
    seeded_samplers,
)
from voxsoft.study.result import StudyResult
from voxsoft.study.run import StudyRun
from voxsoft.study.slopes import answers_of, evaluate_slopes, require_slopes
from voxsoft.study.space import Domain, read_space, space_of
from voxsoft.study.storage import TrialStorage
from voxsoft.study.trial import OUTCOME_KEY, read_trial, violations
from voxsoft.study.workers import make_workers, require_metrics

Family = Design | Callable[..., Design]

_Target = TypeVar("_Target", Objective, Constraint)


class Study:
    """Design family with a search space of its parameters, objectives and constraints.

    Trials are stored as they finish. A study that was stopped, by Ctrl-C, a crash or a power
    cut, goes on when the same lines run again, and never repeats a finished trial. Parameters
    that lead to the same design are solved once.

    Parameters
    ----------
    family
        A parametric :class:`~voxsoft.design.Design`, or a function from parameters (as keywords)
        to a design. Default: the paper's cylindrical actuator, 105 designs.
    space
        Domain of each parameter, by name: ``(low, high)``, ``(low, high, step)``,
        ``(low, high, "log")`` in SI units or texts with units, or a list of choices. Default:
        every parameter of the design that has a min and a max. A function needs a space.
    objectives
        Objectives by name; several make a study with a Pareto front. Default: those of the design.
    constraints
        Metrics to keep within bounds, by name. Default: those of the design. A trial that
        breaks one is recorded and not feasible.
    folder
        Folder of the trials; default ``studies/NAME``. One process at a time writes it. The
        equilibria of its designs are kept there too, up to 256 MB, so that the studio shows them
        at once.
    storage
        An Optuna storage, as its URL or object; trials then go there and not to the folder.
    name
        Name of the study; default: the name of the design or function.
    seed
        Seed of every suggestion of a sampler, whatever the number of workers.
    over
        A path of equilibria that each design is followed along, see :func:`voxsoft.follow`:
        ``"loads[0].value=0..30 kPa/8"``. Objectives and constraints select by `along` the number of
        the path that counts. Default: each design is solved once.
    evaluate
        Function from a design to an :class:`~voxsoft.study.Outcome` that holds each objective and
        constraint under its name; default: simulate, or follow the path. It must be importable
        where the workers are.

    Raises
    ------
    StudyError
        No space, no objective, or a folder that holds another study.
    DesignError
        An objective or constraint that cannot be read.

    Examples
    --------
    >>> import tempfile
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from voxsoft.design import families
    >>> with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor() as threads:
    ...     study = Study(families.sphere(), {"wall": ("5 mm", "10 mm", "5 mm")}, folder=folder)
    ...     result = study.grid(executor=threads)
    >>> result.counts["ok"], result.best.parameters
    (2, {'wall': 0.005})
    """

    def __init__(
        self,
        family: Family | None = None,
        space: Mapping[str, object] | None = None,
        objectives: Mapping[str, Objective | Mapping[str, Any]] | None = None,
        constraints: Mapping[str, Constraint | Mapping[str, Any]] | None = None,
        *,
        folder: str | os.PathLike[str] | None = None,
        storage: str | BaseStorage | None = None,
        name: str | None = None,
        seed: int = 0,
        over: str | None = None,
        evaluate: Evaluate | None = None,
    ) -> None:
        family = families.paper_cylinder() if family is None else family
        if not callable(family):
            require_design(family, "family")
        self.name = name or _name_of(family)
        self.family, self.seed, self.over = family, seed, over
        self._evaluate = evaluate = _evaluate(over, evaluate)
        self.space = _read_space(family, space)
        own = family if isinstance(family, Design) else None
        self.objectives = _read_targets(Objective, objectives, own.objectives if own else {})
        self.constraints = _read_targets(Constraint, constraints, own.constraints if own else {})
        if not self.objectives:
            raise StudyError(
                "objectives",
                "are missing",
                'write {"rise": {"maximize": "displacement", "probe": "top", "axis": "z"}}',
            )
        # Set once for all trials of a design; a function may return one with other probes each
        # time.
        self._asked = None if own is None else self._asking(own)
        usual = Path("studies", folder_name(self.name, "study"))
        beside = Path(folder or usual)
        place = beside if storage is None else storage
        self.folder = place if isinstance(place, Path) else None
        self._storage = TrialStorage(
            self.name,
            [objective.direction for objective in self.objectives.values()],
            definition(
                family, self.space, self.objectives, self.constraints, evaluate, seed, beside
            )
            | ({} if over is None else {"over": over}),
            place,
        )

    def __repr__(self) -> str:
        return f"<Study {self.name}: {', '.join(self.objectives)} over {', '.join(self.space)}>"

    def grid(
        self,
        *,
        executor: Executor | None = None,
        scheduler: str | None = None,
        workers: int | None = None,
        progress: ProgressCallback | None = None,
        gate: Gate | None = None,
    ) -> StudyResult:
        """Evaluate every combination of steps and choices that the study does not hold yet.

        Parameters
        ----------
        executor
            Any :class:`concurrent.futures.Executor`; default: a pool of processes of this
            machine. A worker that dies costs nothing but time: its trial is tried again, and
            fails if the worker dies again.
        scheduler
            Address of a running Dask scheduler, ``"tcp://host:port"``, in place of an executor.
        workers
            Number of processes; default: one for each core.
        progress
            Called with a :class:`~voxsoft.study.TrialEvent` after each trial.
        gate
            Holds back trials while it is closed, also by another thread.

        Returns
        -------
        StudyResult
            All finished trials, those of earlier runs included.

        Raises
        ------
        StudyError
            A range without a step; a storage that is full, damaged or in use; workers that do
            not start.
        KeyboardInterrupt
            After Ctrl-C; finished trials are stored, and the message explains how to go on.
        """
        space, total = self._distributions, self.grid_size
        return self._run(
            lambda study: grid_proposals(study, space),
            total,
            executor,
            scheduler,
            workers,
            progress,
            gate,
        )

    def optimize(
        self,
        sampler: str | BaseSampler,
        budget: int,
        *,
        batch: int | None = None,
        executor: Executor | None = None,
        scheduler: str | None = None,
        workers: int | None = None,
        progress: ProgressCallback | None = None,
        gate: Gate | None = None,
    ) -> StudyResult:
        """Let a sampler choose trials until the study holds `budget` of them.

        Parameters
        ----------
        sampler
            A key of :data:`voxsoft.search.samplers.SAMPLERS`, or a sampler of Optuna. Named
            samplers know the constraints and follow the seed of the study; ``"grid"`` is
            :meth:`grid` and ends with it.
        budget
            Number of trials in the end, whatever their status, those of earlier runs included.
            A study that was stopped gives the same suggestions when it goes on; one whose budget is
            raised later sees the outcomes of its last, cut batch earlier.
        batch
            Trials that are suggested before their outcomes are seen. Suggestions depend on it,
            and not on the number of workers. Default: a generation for ``"genetic"``, 1 for
            ``"gradient"`` (more are further starts), else 8;
            a cluster of more workers than that needs a larger one to be busy.
        executor, scheduler, workers, progress, gate
            See :meth:`grid`.

        Returns
        -------
        StudyResult
            All finished trials, those of earlier runs included.

        Raises
        ------
        StudyError
            The errors of :meth:`grid`; an unknown sampler, or one that cannot take the objectives.
        MissingPackageError
            ``"gp"`` without PyTorch.
        KeyboardInterrupt
            After Ctrl-C; finished trials are stored, and the message explains how to go on.
        """
        if budget < 1 or (batch is not None and batch < 1):
            raise StudyError("budget" if budget < 1 else "batch", "expected at least 1")
        if sampler == "grid":
            return self.grid(
                executor=executor,
                scheduler=scheduler,
                workers=workers,
                progress=progress,
                gate=gate,
            )
        if sampler in SINGLE_OBJECTIVE and len(self.objectives) > 1:
            what = f'"{sampler}" takes one objective, and there are {len(self.objectives)}'
            raise StudyError("sampler", what, 'use "tpe", "nsga-ii" or "nsga-iii"')
        space, evaluate = self._distributions, self._evaluate
        if isinstance(sampler, str):
            constraints = self._violations if self.constraints else None
            answers = None
            if sampler == "gradient":
                if self.over is not None:
                    what = '"gradient" has no slopes along a path'
                    raise StudyError("sampler", what, 'use "cma-es" or "tpe"')
                require_slopes(self.family, tuple(space))
                evaluate = partial(evaluate_slopes, parameters=tuple(space))
                answers = answers_of(self.objectives, self.constraints, tuple(space))
            samplers = seeded_samplers(sampler, space, self.seed, constraints, answers)
            samplers(0)  # raises for bad settings before any worker starts
        else:
            own: BaseSampler = sampler
            samplers = lambda number: own  # noqa: E731
        return self._run(
            lambda study: sampled_proposals(study, space, budget, batch, samplers),
            budget,
            executor,
            scheduler,
            workers,
            progress,
            gate,
            evaluate,
        )

    def result(self) -> StudyResult:
        """Return the trials that are stored so far, also while another process runs the study."""
        with self._storage.open(write=False) as study:
            return self._result(study)

    @property
    def begun(self) -> int:
        """Number of stored trials, unfinished ones included."""
        with self._storage.open(write=False) as study:
            return len(study.trials())

    @property
    def grid_size(self) -> int:
        """Number of combinations of steps and choices.

        Raises
        ------
        StudyError
            A range without a step.
        """
        return prod(len(values) for values in grid_values(self._distributions).values())

    @property
    def _distributions(self) -> dict[str, BaseDistribution]:
        return {name: domain.distribution for name, domain in self.space.items()}

    def _run(
        self,
        proposals: Callable[[StoredStudy], Proposals],
        total: int,
        executor: Executor | None,
        scheduler: str | None,
        workers: int | None,
        progress: ProgressCallback | None,
        gate: Gate | None,
        evaluate: Evaluate | None = None,
    ) -> StudyResult:
        with self._storage.open(write=True) as study:
            evaluators = make_workers(executor, scheduler, workers, gate)
            finished = False
            evaluate = evaluate or self._evaluate
            own = own_metrics([*self.objectives.values(), *self.constraints.values()])
            if own:
                evaluate = partial(evaluate_with_metrics, own, evaluate)
            try:
                require_metrics(evaluators, own)
                StudyRun(
                    study,
                    self._build,
                    evaluate,
                    self.objectives,
                    self.constraints,
                    evaluators,
                    progress,
                    total,
                    gate,
                    None if self.folder is None else Equilibria(self.folder / FOLDER),
                ).evaluate_all(proposals(study))
                finished = True
            except KeyboardInterrupt:
                raise KeyboardInterrupt(self._how_to_resume(study, total)) from None
            finally:
                evaluators.close(now=not finished)
            return self._result(study)

    def _build(self, parameters: Mapping[str, Any]) -> Design:
        """Make the design of one trial, with the objectives and constraints of the study."""
        if self._asked is not None:
            return self._asked.with_parameters(**parameters)
        design = self.family(**parameters) if callable(self.family) else self.family
        if not isinstance(design, Design):
            raise TypeError(f"{_name_of(self.family)} returned {design!r}; expected a Design")
        return self._asking(design)

    def _asking(self, design: Design) -> Design:
        """Return the design with the objectives and constraints of the study."""
        return design.replace(objectives=self.objectives, constraints=self.constraints)

    def _violations(self, trial: FrozenTrial) -> tuple[float, ...]:
        record = trial.user_attrs[OUTCOME_KEY]
        return violations(record["metrics"] if record["status"] == "ok" else {}, self.constraints)

    def _result(self, study: StoredStudy) -> StudyResult:
        return StudyResult(
            self.name,
            self.folder,
            tuple(
                read_trial(stored, self.objectives, self.constraints)
                for stored in study.trials()
                if OUTCOME_KEY in stored.user_attrs
            ),
            self.objectives,
            tuple(self.space),
            self._kinds,
            self.over,
            self.constraints,
            self.space,
        )

    @property
    def _kinds(self) -> dict[str, str]:
        """Kind of quantity of each parameter, known only for a parametric design."""
        parameters = self.family.parameters if isinstance(self.family, Design) else {}
        return {name: parameters[name].kind for name in self.space if name in parameters}

    def _how_to_resume(self, study: StoredStudy, total: int) -> str:
        done = len(self._result(study).trials)
        return (
            f"stopped after {done} of {max(total, done)} trials, which are kept in "
            f"{self._storage.where}; run the same study again to go on"
        )


def _evaluate(over: str | None, evaluate: Evaluate | None) -> Evaluate:
    """Return the function that evaluates each design."""
    if over is None:
        return evaluate or evaluate_design
    if evaluate is not None:
        raise StudyError("over", "is not used beside an evaluate of your own", "give one of them")
    Over.read(over)  # raises for a bad path before any worker starts
    return partial(evaluate_path, over)


def _name_of(family: Family) -> str:
    if isinstance(family, Design):
        return family.name
    return str(getattr(family, "__name__", type(family).__name__)).strip("<>")


def _read_space(family: Family, given: Mapping[str, object] | None) -> dict[str, Domain]:
    if isinstance(family, Design):
        return space_of(family) if given is None else read_space(given, family)
    if given is None:
        raise StudyError(
            "space", "is missing: the family is a function", 'write {"wall": (0.005, 0.015)}'
        )
    return read_space(given, None)


def _read_targets(
    model: type[_Target],
    given: Mapping[str, _Target | Mapping[str, Any]] | None,
    own: Mapping[str, _Target],
) -> dict[str, _Target]:
    """Read the targets given to the study, or take those of the design."""
    if given is None:
        return dict(own)
    return {
        name: model(**target) if isinstance(target, Mapping) else target
        for name, target in given.items()
    }
