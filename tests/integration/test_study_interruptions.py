"""A study in a process of its own: killed, interrupted, out of disk; nothing finished is lost."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from waiting import until

TESTS = Path(__file__).parents[1]

SCRIPT = """
import sys
from functools import partial
from pathlib import Path
from study_families import FALL, block, counted
from voxsoft.study import Study

if __name__ == "__main__":
    evaluate = partial(counted, Path(sys.argv[2]))
    space = {"x": (0.0, 1.0, 0.1), "y": (1, 10)}
    study = Study(block, space, FALL, folder=sys.argv[1], evaluate=evaluate)
    tell = lambda event: print(event.done, flush=True)
    result = study.grid(workers=2, progress=tell)
    print("finished", result.counts["ok"])
"""

NO_GUARD = SCRIPT.replace('if __name__ == "__main__":', "if True:")

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals and limits")


@pytest.fixture
def start(tmp_path):
    """Start the script; its evaluations leave a line each in tmp_path/mark."""
    environment = os.environ | {"PYTHONPATH": str(TESTS)}

    def start(text=SCRIPT, **options):
        path = tmp_path / "script.py"
        path.write_text(text)
        return subprocess.Popen(
            [sys.executable, str(path), str(tmp_path / "study"), str(tmp_path / "mark")],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            **options,
        )

    return start


def wait_for(process, count):
    for line in process.stdout:
        if line.strip() == str(count):
            return
    pytest.fail(f"ended early: {process.stderr.read()}")


@pytest.mark.long
def test_a_killed_study_resumes_and_repeats_no_finished_trial(start, tmp_path):
    process = start()
    wait_for(process, 30)
    process.kill()
    reported = 30 + len(process.stdout.read().split())
    process.wait()

    output, errors = start().communicate(timeout=120)
    assert output.split()[-2:] == ["finished", "110"], errors
    assert output.split()[0] in {str(reported + 1), str(reported + 2)}  # stored, and not yet told
    evaluated = (tmp_path / "mark").read_text().splitlines()
    assert len(set(evaluated)) == 110
    # Only trials that were on the workers at the kill (two run, two wait) ran twice.
    assert len(evaluated) - 110 <= 4


@pytest.mark.slow
def test_the_workers_of_a_killed_study_end(start):
    process = start()
    wait_for(process, 5)
    process.kill()
    process.wait()
    until(lambda: not _session_lives(process.pid), "the end of the workers")


def _session_lives(group):
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.slow
def test_a_study_that_is_killed_again_and_again_still_ends(start, tmp_path):
    for count in (7, 31, 70):
        process = start()
        wait_for(process, count)
        process.kill()
        process.wait()
    output, errors = start().communicate(timeout=120)
    assert output.split()[-2:] == ["finished", "110"], errors


@pytest.mark.long
def test_ctrl_c_says_how_to_go_on(start):
    process = start()
    wait_for(process, 20)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to all processes at once
    _, errors = process.communicate(timeout=60)
    assert "trials, which are kept in" in errors
    assert "run the same study again to go on" in errors
    assert "Process ForkServer" not in errors
    output, errors = start().communicate(timeout=120)
    assert output.split()[-2:] == ["finished", "110"], errors


@pytest.mark.slow
def test_two_runs_of_one_study_at_once_are_refused(start):
    first = start()
    wait_for(first, 3)
    first.send_signal(signal.SIGSTOP)
    _, errors = start().communicate(timeout=60)
    first.send_signal(signal.SIGCONT)
    assert "is being written by another process" in errors
    output, _ = first.communicate(timeout=120)
    assert output.split()[-2:] == ["finished", "110"]


@pytest.mark.slow
def test_a_full_disk_names_the_file_and_keeps_finished_work(start):
    import resource

    def small_disk():
        resource.setrlimit(resource.RLIMIT_FSIZE, (40_000, 40_000))

    full = start(preexec_fn=small_disk)
    output, errors = full.communicate(timeout=120)
    assert "StorageError" in errors
    assert "study.journal: cannot be written" in errors
    done = len(output.split())
    assert 10 < done < 110
    output, errors = start().communicate(timeout=120)
    assert output.split()[-2:] == ["finished", "110"], errors
    assert output.split()[0] in {str(done + 1), str(done + 2)}


@pytest.mark.long
def test_a_script_without_a_main_guard_learns_so(start):
    _, errors = start(NO_GUARD).communicate(timeout=60)
    assert '`if __name__ == "__main__":`' in errors
