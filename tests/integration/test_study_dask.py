"""A study on a Dask cluster of processes: its workers and its scheduler are killed."""

import json
import os
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest
from study_families import deadly_once
from waiting import until

from voxsoft.design import families
from voxsoft.errors import StudyError
from voxsoft.study import Study, evaluate_design

distributed = pytest.importorskip("distributed")

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(sys.platform == "win32", reason="no signals to kill a process with"),
]

TESTS = Path(__file__).parents[1]
SPACE = {"radius": ("20 mm", "25 mm", "5 mm"), "wall": ("5 mm", "15 mm", "5 mm"), "height": [0.03]}
DEADLY = 0.01
WORKERS = 2


@contextmanager
def cluster(folder):
    """Start a scheduler and its workers; yield its address and its process."""
    folder.mkdir()
    place = folder / "scheduler.json"
    paths = [str(TESTS), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(paths)}

    def start(kind, *options):
        module = f"distributed.cli.dask_{kind}"
        given = ["--scheduler-file", str(place), "--host", "127.0.0.1", "--no-dashboard"]
        log = folder / f"{kind}.log"
        with log.open("a") as file:
            command = [sys.executable, "-m", module, *given, *options]
            return subprocess.Popen(command, env=environment, stdout=file, stderr=file)

    processes = [start("scheduler", "--port", "0")]
    try:
        processes += [start("worker", "--no-nanny", "--nthreads", "1") for _ in range(WORKERS)]
        until(lambda: place.exists() and place.read_text().endswith("}"), "the scheduler")
        address = json.loads(place.read_text())["address"]
        with distributed.Client(address, set_as_default=False) as client:
            client.wait_for_workers(WORKERS)
        yield address, processes[0]
    finally:
        for process in processes:
            process.kill()
        for process in processes:
            process.wait()


@pytest.fixture
def make(tmp_path):
    def make(name, evaluate=evaluate_design):
        family = families.paper_cylinder()
        return Study(family, SPACE, folder=tmp_path / name, evaluate=evaluate)

    return make


@pytest.fixture
def undisturbed(make):
    with ThreadPoolExecutor(1) as thread:
        return answers(make("undisturbed").grid(executor=thread))


def answers(result):
    """All that is found of each trial, without its time."""
    return [
        (each.number, each.parameters, each.status, each.message, each.objectives, each.metrics)
        for each in result.trials
    ]


def ends(folder):
    """Numbers of the trials with an outcome in a journal, as often as it has one."""
    lines = (folder / "study.journal").read_text().splitlines()
    logs = [json.loads(line) for line in lines]
    return sorted(log["trial_id"] for log in logs if "outcome" in log.get("user_attr", {}))


def test_a_worker_that_is_killed_costs_no_trial(make, undisturbed, tmp_path):
    mark = tmp_path / "mark"
    study = make("killed", partial(deadly_once, mark, DEADLY))
    with cluster(tmp_path / "cluster") as (address, _):
        result = study.grid(scheduler=address)
        with distributed.Client(address, set_as_default=False) as client:
            assert len(client.nthreads()) == WORKERS - 1
    assert mark.exists()
    assert answers(result) == undisturbed
    assert ends(tmp_path / "killed") == list(range(len(undisturbed)))


def test_a_scheduler_that_is_killed_ends_the_study_which_goes_on_later(
    make, undisturbed, tmp_path, capfd
):
    study = make("resumed")
    with cluster(tmp_path / "first") as (address, scheduler):

        def kill(event):
            if event.done == 2:
                scheduler.send_signal(signal.SIGKILL)
                scheduler.wait()

        with pytest.raises(StudyError, match=f"scheduler {address}: the connection .* was lost"):
            study.grid(scheduler=address, progress=kill)
    assert "Traceback" not in capfd.readouterr().err
    kept = answers(study.result())
    assert 2 <= len(kept) < len(undisturbed)
    assert all(each in undisturbed for each in kept)
    with cluster(tmp_path / "second") as (address, _):
        result = make("resumed").grid(scheduler=address)
    assert answers(result) == undisturbed
    assert ends(tmp_path / "resumed") == list(range(len(undisturbed)))
