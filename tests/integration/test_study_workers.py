"""Studies on worker processes, a broken executor and a Dask cluster: lost workers and trials."""

import multiprocessing
import os
import re
import signal
import sys
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from functools import partial

import pytest
from study_families import FALL, block, counted, deadly, slow
from waiting import until

from voxsoft.errors import MissingPackageError, StudyError
from voxsoft.study import Study
from voxsoft.study.workers import LocalProcesses

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


@pytest.mark.slow
def test_dask_replaces_a_worker_that_is_killed(make, tmp_path):
    distributed = pytest.importorskip("distributed")
    study = make(slow)
    killed = []

    def kill_one(event):
        if event.done == 4:
            pids = client.run(os.getpid)
            killed.append(next(iter(pids.values())))
            os.kill(killed[0], signal.SIGKILL)

    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
        ) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        result = study.grid(scheduler=cluster.scheduler_address, progress=kill_one)
    assert killed
    assert result.counts["ok"] == len(result.trials) == 18


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
