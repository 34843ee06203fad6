"""Setup of all tests."""

import locale
import signal

import pytest

# A shell that starts the tests in the background has Ctrl-C ignored, and so would every process
# that the tests start and interrupt.
signal.signal(signal.SIGINT, signal.default_int_handler)

# `tests/unit/metrics/test_own_metrics.py` registers these metrics; a search for doctests would do
# so first.
collect_ignore = ["own_metrics.py"]


@pytest.fixture
def lib3mf():
    """Give lib3mf, whose writer leaves the locale of the whole process at C."""
    module = pytest.importorskip("lib3mf")
    before = locale.setlocale(locale.LC_ALL)
    yield module
    locale.setlocale(locale.LC_ALL, before)
