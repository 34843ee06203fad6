"""Tests wait for conditions, never for time to pass."""

import re
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
#: Sleeping, and reading until nothing has come for a while (`until` and `settled` are the cures).
SLEEPS = re.compile(
    r"\bsleep\((?!0\))"
    r"|wait_for_timeout\("
    r"|except (?:asyncio\.)?TimeoutError:\s+(?:return|break|pass|continue)\b"
    r"|suppress\((?:asyncio\.)?TimeoutError\)"
)

#: Files that may sleep, and why.
ALLOWED = {
    "waiting.py": "looks again at a condition",
    "study_families.py": "trials that take their time, so that a study can be stopped",
    "unit/shapes/test_shapes_errors.py": "a field that takes its time, to be interrupted",
    "studio/browser/test_pictures.py": "takes pictures for the documents, and checks nothing",
    "studio/browser/test_view_and_run.py": "compares a picture with the one before it",
}


def test_no_test_waits_for_time_to_pass():
    found = {
        path.relative_to(TESTS).as_posix()
        for path in TESTS.rglob("*.py")
        if path != Path(__file__) and SLEEPS.search(path.read_text(encoding="utf-8"))
    }
    assert found <= ALLOWED.keys(), "use `until` of tests/waiting.py, or `settled` of a page"
    assert found == ALLOWED.keys(), "a file that may sleep does not any more"


@pytest.mark.parametrize(
    "line",
    [
        "time.sleep(0.1)",
        "tab.page.wait_for_timeout(400)",
        "except TimeoutError:\n    return",
        "with suppress(TimeoutError):",
    ],
)
def test_the_ways_of_waiting_are_known(line):
    assert SLEEPS.search(line)


def test_giving_way_to_other_tasks_is_no_waiting():
    assert not SLEEPS.search("await asyncio.sleep(0)")
