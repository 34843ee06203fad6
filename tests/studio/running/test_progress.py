"""A pause is reported at once, with the unfinished work, and takes no time from the job."""

import multiprocessing
import threading
from pathlib import Path

import pytest
from waiting import until

from voxsoft.jobs import events as jobs
from voxsoft.studio.running.progress import Progress


class Report:
    """Events of a job."""

    def __init__(self, kind):
        self.sent = []
        self.progress = Progress(kind, Path("runs/a"), self.sent.append)

    @property
    def last(self):
        return (self.sent[-1].state, self.sent[-1].stage)

    def until(self, *last):
        until(lambda: self.last == last, lambda: f"{last} after {self.last}")


@pytest.fixture
def study():
    return Report("study")


@pytest.fixture
def calibration():
    return Report("calibrate")


def test_a_study_tells_how_many_designs_are_being_finished(study):
    progress, gate = study.progress, study.progress.gate()
    workers = gate.for_pool(multiprocessing.get_context("spawn"))
    progress.at(jobs.Progress(3, 8, "designs"))
    workers.begun.value = 2
    progress.pause()
    assert gate.closed
    study.until("pausing", "2 designs are being finished")
    workers.begun.value = 1
    progress.at(jobs.Progress(4, 8, "designs"))  # the one that ended is stored: nothing waits here
    study.until("pausing", "1 design is being finished")
    workers.begun.value = 0
    study.until("paused", "")
    assert study.sent[-1].done == 4
    progress.resume()
    assert not gate.closed
    assert study.last == ("running", "")


def test_a_study_paused_before_it_has_begun_begins_paused(study):
    study.progress.pause()
    assert study.progress.gate().closed
    study.until("paused", "")


def test_other_work_is_held_where_it_next_says_how_far_it_is(calibration):
    progress = calibration.progress
    progress.at(jobs.Progress(1, 50, "generations", "search"))
    progress.pause()
    assert calibration.last == ("pausing", "the present generation is being finished")
    work = threading.Thread(
        target=progress.at, args=(jobs.Progress(2, 50, "generations", "search"),)
    )
    work.start()
    calibration.until("paused", "search")
    assert work.is_alive()
    progress.resume()
    work.join(30)
    assert not work.is_alive()
    assert calibration.last == ("running", "search")


def test_pauses_do_not_count_as_work(calibration, monkeypatch):
    now = [100.0]
    monkeypatch.setattr("voxsoft.studio.running.progress.time.monotonic", lambda: now[0])
    reported = Report("calibrate")
    progress = reported.progress
    progress.pause()
    now[0] += 2  # begun work is being finished
    work = threading.Thread(target=progress.at, args=(jobs.Progress(1, 3, "generations"),))
    work.start()
    while reported.sent[-1].state != "paused":
        pass
    now[0] += 1000
    assert progress.elapsed == 2
    progress.resume()
    work.join(30)
    now[0] += 5
    assert progress.elapsed == 7


def test_a_new_unit_of_progress_has_a_time_of_its_own():
    run = Report("run")
    run.progress.at(jobs.Progress(0, 11, "equilibria"))
    run.progress.at(jobs.Progress(11, 11, "equilibria"))
    assert (run.sent[-1].of, run.sent[-1].left) == ("equilibria", 0.0)
    run.progress.at(jobs.Progress(0, 100, "percent of a further run"))
    assert (run.sent[-1].of, run.sent[-1].left) == ("percent of a further run", None)
    run.progress.at(jobs.Progress(50, 100, "percent of a further run"))
    # Equal to the time of the first half; the equilibria before do not count.
    assert 0.0 <= run.sent[-1].left < run.sent[-1].elapsed
