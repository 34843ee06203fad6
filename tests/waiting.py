"""Waiting for another process or thread: the one place in the tests that sleeps."""

import time

#: Seconds after which a missing event never comes, however busy the machine is.
PATIENCE = 120.0
#: Seconds between two looks.
_BETWEEN = 0.01


def until(condition, what="what was waited for", patience=PATIENCE):
    """Wait until a condition holds, and return its value.

    Parameters
    ----------
    condition
        Called again and again; its value counts once it is true.
    what
        Name of the awaited event: text, or a function that gives it when nothing came.
    patience
        Seconds after which the test fails.
    """
    end = time.perf_counter() + patience
    while not (value := condition()):
        assert time.perf_counter() < end, f"{what() if callable(what) else what}: never came"
        time.sleep(_BETWEEN)
    return value
