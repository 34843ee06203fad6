"""Waiting for another process or thread: the one place in the tests that sleeps."""

import time

#: Seconds after which what has not come never will, however busy the machine is.
PATIENCE = 120.0
#: Seconds between two looks.
_BETWEEN = 0.01


def until(condition, what="what was waited for", patience=PATIENCE):
    """Wait until a condition holds, and return what it gave.

    Parameters
    ----------
    condition
        Called again and again; what it gives counts once it is true.
    what
        What is waited for: text, or a function that says it when nothing came.
    patience
        Seconds after which the test fails.
    """
    end = time.perf_counter() + patience
    while not (value := condition()):
        assert time.perf_counter() < end, f"{what() if callable(what) else what}: never came"
        time.sleep(_BETWEEN)
    return value
