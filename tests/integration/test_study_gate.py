"""A gate holds the trials of a study that have not begun, and costs none that have."""

import multiprocessing
import os
import signal
import sys
import threading
from functools import partial

import pytest
from study_families import FALL, block, patient
from waiting import until

from voxsoft.study import Gate, Study

SPACE = {"x": (0.0, 0.2, 0.1), "y": (1, 6)}


class Running:
    """A study of 18 designs on two workers, on a thread of its own."""

    def __init__(self, folder):
        self.mark = folder / "mark"
        self.gate = Gate()
        self.study = Study(
            block, SPACE, FALL, folder=folder / "study", evaluate=partial(patient, self.mark)
        )
        self._thread = threading.Thread(target=self._run, daemon=True)

    def _run(self):
        self.result = self.study.grid(workers=2, gate=self.gate)

    def start(self):
        self._thread.start()
        return self

    def begun(self):
        return len(self.mark.read_text().splitlines()) if self.mark.exists() else 0

    def stored(self):
        return len(self.study.result().trials)

    def release(self):
        self.mark.with_suffix(".go").touch()

    def end(self):
        self._thread.join(60)
        assert not self._thread.is_alive()
        return getattr(self, "result", None)


@pytest.fixture
def running(tmp_path):
    study = Running(tmp_path)
    yield study
    # A study that a failed test leaves at its gate would hold up all that come after.
    study.release()
    study.gate.open()
    study.end()


def test_trials_that_have_begun_end_and_no_other_begins(running):
    running.start()
    until(lambda: running.begun() == 2)
    running.gate.close()
    assert running.gate.begun == 2
    assert running.stored() == 0
    running.release()
    until(lambda: running.gate.begun == 0)
    until(lambda: running.stored() == 2)
    until(lambda: running.gate.waiting == 2)
    assert (running.begun(), running.stored()) == (2, 2)
    running.gate.open()
    assert running.end().counts["ok"] == 18
    assert running.begun() == 18


@pytest.mark.skipif(sys.platform == "win32", reason="no signals to kill a worker with")
def test_workers_that_are_killed_at_a_closed_gate_cost_nothing(running):
    running.start()
    until(lambda: running.begun() == 2)
    running.gate.close()
    running.release()
    until(lambda: running.stored() == 2)
    killed = multiprocessing.active_children()
    for child in killed:
        os.kill(child.pid, signal.SIGKILL)
    # A new pool may have started already, and waits at the gate too.
    until(lambda: not set(killed) & set(multiprocessing.active_children()))
    assert running.begun() == 2
    running.gate.open()
    assert running.end().counts["ok"] == 18


@pytest.mark.skipif(sys.platform == "win32", reason="no signals to kill a worker with")
def test_a_worker_killed_amid_a_trial_is_not_counted_for_ever(running):
    running.start()
    until(lambda: running.begun() == 2)
    running.gate.close()
    for child in multiprocessing.active_children():
        os.kill(child.pid, signal.SIGKILL)
    until(lambda: running.gate.begun == 0)
    running.release()
    running.gate.open()
    assert running.end().counts["ok"] == 18
