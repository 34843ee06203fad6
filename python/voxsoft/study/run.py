"""Evaluation of proposals on workers, and storage of every outcome as it comes."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import BrokenExecutor, Future
from dataclasses import dataclass, field, replace
from math import isfinite
from queue import Empty, SimpleQueue
from typing import Any, Final

from voxsoft._interrupt import Interrupts
from voxsoft.design import Constraint, Design, Objective
from voxsoft.design.document.identity import Hashes
from voxsoft.errors import VoxSoftError
from voxsoft.search.optuna_bridge import StoredStudy, TrialState
from voxsoft.study.equilibria import Equilibria
from voxsoft.study.event import ProgressCallback, TrialEvent
from voxsoft.study.gate import Gate
from voxsoft.study.outcome import Evaluate, Outcome
from voxsoft.study.proposals import Proposal
from voxsoft.study.trial import OUTCOME_KEY, Trial, outcome_of, read_trial, record_of
from voxsoft.study.workers import LostWorkersError, Workers, lost_workers

#: Seconds between two checks of a closed gate.
_LOOK: Final = 0.05
#: Seconds between two looks at the number of workers: a cluster may get more of them while all
#: trials that it has are on their way.
_LOOK_AT_SLOTS: Final = 1.0

Build = Callable[[Mapping[str, Any]], Design]


@dataclass(frozen=True)
class _Job:
    number: int
    design: Design
    hash: str


@dataclass
class StudyRun:
    """One run of a study: proposals in, stored trials out.

    Parameters
    ----------
    study
        Storage of the trials; only this process writes it.
    build
        Function from parameters to the design.
    evaluate
        Function from the design to its outcome, on a worker.
    objectives, constraints
        Objectives and constraints of the study, by name.
    workers
        Workers that evaluate.
    progress
        Called after each trial.
    total
        Number of trials in the end, for `progress`.
    gate
        While it is closed no trial begins; those that have are stored as they end.
    equilibria
        Storage for the states of designs that came to rest, if any.
    """

    study: StoredStudy
    build: Build
    evaluate: Evaluate
    objectives: Mapping[str, Objective]
    constraints: Mapping[str, Constraint]
    workers: Workers
    progress: ProgressCallback | None
    total: int
    gate: Gate | None = None
    equilibria: Equilibria | None = None
    _hashes: Hashes = field(default_factory=Hashes)
    _running: dict[Future[Outcome], _Job] = field(default_factory=dict)
    #: Futures that are done, as they end: a look at all that run would take longer, the more do.
    _ended: SimpleQueue[Future[Outcome]] = field(default_factory=SimpleQueue)
    _twins: dict[str, list[_Job]] = field(default_factory=dict)
    _solved: dict[str, tuple[int, Outcome]] = field(default_factory=dict)
    _best: float | None = None
    _doubts: tuple[str, ...] = ()
    _done: int = 0

    def __post_init__(self) -> None:
        """Take over the outcomes that earlier runs stored."""
        for stored in self.study.trials():
            if OUTCOME_KEY not in stored.user_attrs:
                continue
            record = stored.user_attrs[OUTCOME_KEY]
            if stored.state == TrialState.RUNNING:  # stopped between the two writes of a trial
                self._tell(stored.number, outcome_of(record))
            self._learn(read_trial(stored, self.objectives, self.constraints), outcome_of(record))

    def evaluate_all(self, batches: Iterable[Iterable[Proposal]]) -> None:
        """Evaluate batch after batch; each is drawn once the one before is stored.

        Raises
        ------
        LostWorkersError
            The workers are gone; all that was finished is stored.
        """
        with Interrupts() as interrupts:
            try:
                for batch in batches:
                    for proposal in batch:
                        interrupts.stop_if_interrupted()
                        self._wait_for_gate(interrupts)
                        self._begin(proposal)
                        # Queue a few more than run at once at the workers, so that none is idle.
                        while len(self._running) >= 2 * self.workers.slots:
                            self._collect(_LOOK_AT_SLOTS)
                    while self._running:
                        interrupts.stop_if_interrupted()
                        self._collect()
            except LostWorkersError:
                self._keep_finished()
                raise

    def _wait_for_gate(self, interrupts: Interrupts) -> None:
        while self.gate is not None and self.gate.closed:
            interrupts.stop_if_interrupted()
            if self._running:
                self._collect(_LOOK)
            else:
                time.sleep(_LOOK)

    def _begin(self, proposal: Proposal) -> None:
        try:
            design = self.build(proposal.parameters)
        except VoxSoftError as error:
            self._store(proposal.number, Outcome("failed", str(error)), "", None)
            return
        job = _Job(proposal.number, design, self._hashes.of(design))
        if job.hash in self._solved:
            self._share(job)
        elif job.hash in self._twins:
            self._twins[job.hash].append(job)
        else:
            self._submit(job)

    def _submit(self, job: _Job) -> None:
        try:
            future = self.workers.submit(self.evaluate, job.design)
        except BrokenExecutor:
            # The pool noticed a dead worker before any of its futures reported it.
            self._recover([])
            future = self.workers.submit(self.evaluate, job.design)
        self._running[future], self._twins[job.hash] = job, []
        future.add_done_callback(self._ended.put)

    def _collect(self, patience: float | None = None) -> None:
        """Store finished trials; wait for at least one, or for some seconds."""
        lost, gone = [], False
        try:
            ended = self._wait(patience)
        except KeyboardInterrupt:
            self._keep_finished()
            raise
        for future in sorted(ended, key=lambda done: self._running[done].number):
            if future.cancelled():
                gone = True
                continue
            job = self._running.pop(future)
            if isinstance(future.exception(), BrokenExecutor):
                lost.append(job)
            else:
                self._take(job, future)
        if gone:
            raise lost_workers(self.workers.where)
        if lost:
            self._recover(lost)

    def _wait(self, patience: float | None) -> list[Future[Outcome]]:
        """Wait for at least one trial to end, or for some seconds; return all that did."""
        ended = []
        try:
            ended.append(self._ended.get(timeout=patience))
            while True:
                ended.append(self._ended.get_nowait())
        except Empty:
            # Those that the study had given up with a broken pool are none of its own any more.
            return [future for future in ended if future in self._running]

    def _keep_finished(self) -> None:
        """Store finished trials before the study stops, without calling `progress`."""
        self.progress = None
        for future in [each for each in self._running if each.done() and not each.cancelled()]:
            job = self._running.pop(future)
            if not isinstance(future.exception(), BrokenExecutor):
                self._take(job, future)

    def _recover(self, lost: list[_Job]) -> None:
        """Go on after a worker died: it takes all trials of its pool with it.

        Each of them is tried once more, alone, so that the one to blame fails and no other. A
        broken pool answers nothing any more, and may forget trials that it took as it broke: those
        count as lost without a wait.
        """
        for future in list(self._running):
            job = self._running.pop(future)
            if not future.done() or isinstance(future.exception(), BrokenExecutor):
                lost.append(job)
            else:
                self._take(job, future)
        self.workers.recover()
        for job in sorted(lost, key=lambda job: job.number):
            future = self.workers.submit(self.evaluate, job.design)
            if isinstance(future.exception(), BrokenExecutor):
                self.workers.recover()
                message = "the worker process died twice while it evaluated this design"
                self._finish(job, Outcome("failed", message))
            else:
                self._take(job, future)

    def _take(self, job: _Job, future: Future[Outcome]) -> None:
        self._finish(job, _outcome(future, self.objectives))
        if self.gate is not None:
            self.gate.stored()

    def _finish(self, job: _Job, outcome: Outcome) -> None:
        # Store the state first: a listener may look for it when it learns of the trial.
        if outcome.equilibrium is not None:
            if self.equilibria is not None:
                self.equilibria.keep(job.hash, outcome.equilibrium)
            outcome = replace(outcome, equilibrium=None)
        self._store(job.number, outcome, job.hash, None)
        for twin in self._twins.pop(job.hash, []):
            self._share(twin)

    def _share(self, job: _Job) -> None:
        number, outcome = self._solved[job.hash]
        self._store(job.number, replace(outcome, seconds=0.0), job.hash, number)

    def _store(self, number: int, outcome: Outcome, design_hash: str, same_as: int | None) -> None:
        record = record_of(outcome, design_hash, same_as)
        self.study.write(number, OUTCOME_KEY, record)
        self._tell(number, outcome)
        trial = read_trial(self.study.trial(number), self.objectives, self.constraints)
        self._learn(trial, outcome)
        if self.progress is not None:
            total = max(self.total, self._done)
            self.progress(TrialEvent(trial, self._best, self._done, total, self._doubts))

    def _tell(self, number: int, outcome: Outcome) -> None:
        """Report a trial to the sampler, which learns to avoid designs that cannot be solved."""
        if outcome.status == "ok":
            values = [outcome.metrics[name] for name in self.objectives]
            self.study.tell(number, values)
        else:
            self.study.tell_unsolved(number)

    def _learn(self, trial: Trial, outcome: Outcome) -> None:
        self._done += 1
        if trial.hash and trial.same_as is None:
            self._solved[trial.hash] = (trial.number, outcome)
        if trial.feasible:
            name, objective = next(iter(self.objectives.items()))
            better = min if objective.direction == "minimize" else max
            value = trial.objectives[name]
            if self._best is None or better(value, self._best) != self._best:
                self._best, self._doubts = value, trial.warnings


def _outcome(future: Future[Outcome], objectives: Mapping[str, Objective]) -> Outcome:
    """Read the answer of a worker; an error there becomes a status."""
    try:
        outcome = future.result()
    except Exception as error:
        return Outcome("failed", f"{type(error).__name__}: {error}")
    if outcome.status != "ok":
        return outcome
    wrong = [name for name in objectives if not _finite(outcome.metrics.get(name))]
    if wrong:
        value = outcome.metrics.get(wrong[0], "missing")
        message = f'the objective "{wrong[0]}" is {value}'
        return replace(outcome, status="failed", message=message)
    return outcome


def _finite(value: float | None) -> bool:
    return value is not None and isfinite(value)
