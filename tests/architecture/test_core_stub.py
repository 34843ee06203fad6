"""What `_core.pyi` says of the compiled module is what is there: names, signatures, defaults."""

import os
import subprocess
import sys
from pathlib import Path
from typing import get_args

import voxsoft
from voxsoft import _core
from voxsoft.simulation.result import Status
from voxsoft.simulation.run import _STATUSES

PACKAGE = Path(voxsoft.__file__).parent


def test_the_stub_tells_the_truth(tmp_path):
    # From another folder, and without the present one on the path: modules there may hide others.
    options = ["--ignore-disjoint-bases", "--concise", "--allowlist", allowlist(tmp_path)]
    done = subprocess.run(
        [sys.executable, "-P", "-m", "mypy.stubtest", "voxsoft._core", *options],
        env={**os.environ, "MYPYPATH": str(PACKAGE.parent)},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def allowlist(folder):
    """PyO3 lists all names in `__all__`, which the stub needs not; `MeshArrays` names a type."""
    file = folder / "allowed"
    file.write_text("voxsoft._core.__all__\nvoxsoft._core.MeshArrays\n", encoding="utf-8")
    return str(file)


def test_the_border_is_typed():
    """What is left is the live player's, which has its own way across."""
    text = (PACKAGE / "_core.pyi").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if "dict[str, Any]" in line]
    assert all("def advance" in line for line in lines)


def test_every_status_of_the_core_has_its_word():
    core = {getattr(_core.Status, name) for name in dir(_core.Status) if name.isupper()}
    never = {_core.Status.SLOW, _core.Status.OUT_OF_MEMORY, _core.Status.CANCELLED}
    assert set(_STATUSES) == core - never  # a trial goes on, an error is raised
    assert set(_STATUSES.values()) <= set(get_args(Status))
