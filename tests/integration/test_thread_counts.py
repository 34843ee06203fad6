"""Any number of threads that a user may set gives the same answers, or is refused."""

import os
import subprocess
import sys

import lattice_families as families
import pytest

import voxsoft as vs
from voxsoft.errors import StudyError

#: Voxels of a shape, a lattice by relaxation and a rubber by multigrid, each large enough for
#: several threads, as one hash of all bits.
WORK = """
import hashlib, sys
import voxsoft as vs
from voxsoft.units import kPa, mm

def body(material, across):
    box = vs.Box(size=(across * mm,) * 3)
    return vs.Design(
        name="cube", voxel_size=1 * mm, parts=[vs.Part(shape=box, material=material)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))], loads=[vs.Gravity()],
    )

digest = hashlib.sha256()
side = 32 * mm
shape = vs.Box(size=(side,) * 3) & vs.Gyroid(period=8 * mm, form="solid")
digest.update(vs.voxelize(shape, side / 64).array.tobytes())
if len(sys.argv) > 1:
    print(digest.hexdigest())
    sys.exit()
lattice = vs.Lattice(edge=60 * kPa, bulk=400 * kPa, density=1070)
digest.update(vs.simulate(body(lattice, 16), tolerance=1e-2).positions.tobytes())
rubber = vs.NeoHookean(young=60 * kPa)
soft = vs.simulate(body(rubber, 16), method="statics", tolerance=1e-2)
digest.update(soft.positions.tobytes())
print(digest.hexdigest())
"""


def digest(threads, *only_sampling):
    """The hash of the work with so many threads of the core; 0 leaves the number to it."""
    environment = os.environ | {"RAYON_NUM_THREADS": threads}
    command = [sys.executable, "-c", WORK, *only_sampling]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return done.stdout


def test_one_thread_and_the_default_give_the_same_bits():
    alone = digest("1")
    assert len(alone) > 60
    assert digest("0") == alone


@pytest.mark.slow
def test_a_thousand_threads_work():
    """They do get in each other's way: a solution with its short loops takes a minute."""
    assert digest("1000", "only sampling") == digest("1", "only sampling")


def test_more_workers_than_memory_are_refused_before_they_start(tmp_path, monkeypatch):
    monkeypatch.setattr("voxsoft.study.workers.memory_limit", lambda: 2 << 30)
    study = vs.Study(families.cylinder(), folder=tmp_path)
    with pytest.raises(StudyError, match=r"1000 processes take about .* GB.*at most"):
        study.grid(workers=1000)
