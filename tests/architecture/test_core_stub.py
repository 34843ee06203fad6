"""The border to the core is typed. That `_core.pyi` tells the truth is seen by `make lint`."""

from pathlib import Path
from typing import get_args

import voxsoft
from voxsoft import _core
from voxsoft.simulation.results.result import Status
from voxsoft.simulation.runs.run import _STATUSES

PACKAGE = Path(voxsoft.__file__).parent


def test_the_border_is_typed():
    """Remaining untyped values are the live player's, which has its own way across."""
    text = (PACKAGE / "_core.pyi").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if "dict[str, Any]" in line]
    assert all("def advance" in line for line in lines)


def test_every_status_of_the_core_has_its_word():
    core = {getattr(_core.Status, name) for name in dir(_core.Status) if name.isupper()}
    never = {_core.Status.SLOW, _core.Status.OUT_OF_MEMORY, _core.Status.CANCELLED}
    assert set(_STATUSES) == core - never  # a trial goes on, an error is raised
    assert set(_STATUSES.values()) <= set(get_args(Status))
