"""Studies on worker processes, executors and Dask: lost workers and trials.

A real cluster is in `test_study_dask.py`.
"""

import multiprocessing
import os
import re
import sys
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from functools import partial
from types import SimpleNamespace

import pytest
from study_families import FALL, block, bowl, counted, deadly, slow
from waiting import until

from voxsoft.errors import MissingPackageError, StudyError
from voxsoft.study import Study
from voxsoft.study.workers import DaskCluster, LocalProcesses

SPACE = {"x": (0.0, 0.2, 0.1), "y": (1, 6)}


@pytest.fixture
def mark(tmp_path):
    """A file that workers share."""
    return tmp_path / "mark"


@pytest.fixture
def make(tmp_path):
    return lambda evaluate: Study(block, SPACE, FALL, folder=tmp_path / "study", evaluate=evaluate)


@pytest.mark.skipif(sys.platform == "win32", reason="no signals to kill a worker with")
def test_a_worker_that_dies_fails_only_the_trial_that_kills_it_twice(make, mark):
    result = make(partial(deadly, mark)).grid(workers=2)
    by_y = {
        y: {trial.status for trial in result.trials if trial.parameters["y"] == y}
        for y in range(1, 7)
    }
    assert by_y == {1: {"ok"}, 2: {"ok"}, 3: {"failed"}, 4: {"ok"}, 5: {"ok"}, 6: {"ok"}}
    assert "died twice" in next(t.message for t in result.trials if t.status == "failed")
    assert mark.exists()


def test_workers_do_not_outlive_the_study(make, mark):
    make(partial(counted, mark)).grid(workers=2)
    assert len(mark.read_text().splitlines()) == 18
    until(lambda: multiprocessing.active_children() == [], "the end of the workers")


def test_a_broken_executor_ends_the_study_and_keeps_its_trials(make, mark):
    context = multiprocessing.get_context("spawn")
    study = make(partial(deadly, mark))
    with (
        ProcessPoolExecutor(1, mp_context=context) as pool,
        pytest.raises(StudyError, match="executor: broke"),
    ):
        study.grid(executor=pool, workers=1)
    kept = len(study.result().trials)
    assert kept == 2
    assert len(study.grid(workers=1).trials) == 18


class LastOnly(Executor):
    """An executor that cancels the first of two tasks and does the second."""

    def __init__(self):
        self._first = None

    def submit(self, task, /, *arguments):
        future = Future()
        if self._first is None:
            self._first = future
            return future
        future.set_result(task(*arguments))
        self._first.cancel()
        return future


def test_trials_that_end_as_the_workers_are_lost_are_kept(make):
    study = make(bowl)
    with pytest.raises(StudyError, match="executor: the connection to the workers was lost"):
        study.grid(executor=LastOnly(), workers=1)
    assert [trial.number for trial in study.result().trials] == [1]


class Scheduler:
    """A client of Dask whose scheduler ends after some questions."""

    questions = 0

    def __init__(self, *_, **__):
        pass

    def get_executor(self, **_):
        return self

    def nthreads(self):
        Scheduler.questions += 1
        if Scheduler.questions > 2:
            raise OSError("in <TCP (closed)>")
        return {"a": 2, "b": 2}


def test_a_scheduler_is_rarely_asked_for_its_workers_and_lost_in_plain_words(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", SimpleNamespace(Client=Scheduler))
    monkeypatch.setattr(Scheduler, "questions", 0)
    monkeypatch.setattr("voxsoft.study.workers.time", SimpleNamespace(monotonic=lambda: now))
    now = 5.0
    cluster = DaskCluster("tcp://here:1")
    assert [cluster.slots for _ in range(50)] == [4] * 50
    assert Scheduler.questions == 1
    now = 7.0
    assert cluster.slots == 4
    assert Scheduler.questions == 2
    now = 9.0
    with pytest.raises(StudyError, match=r"scheduler tcp://here:1: the connection .* was lost"):
        _ = cluster.slots


def test_a_scheduler_that_is_not_there_is_named(make, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr("voxsoft.study.workers.DASK_TIMEOUT", 0.5)
    with pytest.raises(StudyError, match=re.escape('"tcp://127.0.0.1:9" does not answer')):
        make(slow).grid(scheduler="tcp://127.0.0.1:9")


def test_dask_that_is_not_installed_names_the_command(make, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingPackageError, match="pip install distributed"):
        make(slow).grid(scheduler="tcp://127.0.0.1:9")


def test_an_executor_and_a_scheduler_exclude_each_other(make):
    with ProcessPoolExecutor(1) as pool, pytest.raises(StudyError, match="give one"):
        make(slow).grid(executor=pool, scheduler="tcp://127.0.0.1:9")


def test_a_pool_that_breaks_while_it_starts_a_worker_is_replaced(monkeypatch):
    """Python's pool breaks so: its pipes are closed when the new worker would take them."""

    def closed(*_):
        raise OSError("handle is closed")

    workers = LocalProcesses(1)
    try:
        monkeypatch.setattr(workers._pool, "submit", closed)
        workers._context.Process()  # which never starts
        with pytest.raises(BrokenExecutor):
            workers.submit(os.getpid)
        workers.recover()
        assert workers.submit(os.getpid).result(60) != os.getpid()
    finally:
        workers.close(now=True)
