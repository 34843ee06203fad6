"""Molds in a slicer: PrusaSlicer reads them with their sizes and slices them without a warning.

It comes with Debian (``apt-get install --no-install-recommends prusa-slicer``, 100 MB installed).
"""

import re
import shutil
import subprocess

import pytest

import voxsoft as vs
from voxsoft.fabrication import make
from voxsoft.files.fabrication import write_fabrication

SLICER = shutil.which("prusa-slicer")
#: Words of its messages about a mesh that it had to repair, or that cannot be printed.
FAULTS = re.compile(r"warning|error|repair|open edge|non-manifold|auto-repaired|outside", re.I)


@pytest.mark.slow
@pytest.mark.skipif(SLICER is None, reason="PrusaSlicer is not installed")
@pytest.mark.parametrize("name", ["cylinder", "gripper_finger"])
def test_molds_are_sliced_without_a_warning(name, tmp_path):
    made = make(vs.load(f"examples/{name}.toml"))
    folder = write_fabrication(made, tmp_path / "made")
    for title, (vertices, _) in made.surfaces().items():
        file = folder / f"{title}.3mf"
        info = run("--info", str(file))
        size = [float(re.search(rf"size_{axis} = ([\d.]+)", info)[1]) for axis in "xyz"]
        # It prints six digits of mm.
        assert size == pytest.approx(1e3 * (vertices.max(axis=0) - vertices.min(axis=0)), abs=1e-4)
        assert "manifold = yes" in info
        assert "number_of_parts =  1" in info
        sliced = run("--export-gcode", "--output", str(tmp_path / "out.gcode"), str(file))
        assert not FAULTS.search(sliced), sliced
        assert (tmp_path / "out.gcode").stat().st_size > 10_000


def run(*arguments: str) -> str:
    done = subprocess.run(
        [str(SLICER), *arguments], capture_output=True, text=True, timeout=300, check=True
    )
    return done.stdout + done.stderr
