"""Observations as bytes: a motion goes on to the same bits in another process."""

import hashlib
import json
import pickle
import subprocess
import sys
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import families
from voxsoft.errors import SimulationError
from voxsoft.simulation import Sensor

#: A finger that remembers all: gas behind a valve, friction of a tendon and of a plate, softening.
FINGER = vs.Design(
    name="finger",
    voxel_size="4 mm",
    parts=[
        vs.Part(
            shape=vs.Box(size=("48 mm", "16 mm", "16 mm"))
            - vs.Box(size=("40 mm", "8 mm", "4 mm"), corner=("4 mm", "4 mm", "8 mm")),
            material=vs.NeoHookean(
                young="100 kPa",
                poisson=0.45,
                density=1070.0,
                mullins={"r": 1.5, "m": "100 Pa", "beta": 0.1},
            ),
        )
    ],
    clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
    chambers={"air": {"point": ("20 mm", "8 mm", "10 mm")}},
    supplies=[
        {
            "kind": "flow",
            "chamber": "air",
            "source": "20 kPa",
            "valve": {"conductance": "0.002 L/s/bar"},
        }
    ],
    tendons=[
        {
            "name": "flexor",
            "through": [(0, "8 mm", "2 mm"), ("24 mm", "8 mm", "2 mm"), ("48 mm", "8 mm", "2 mm")],
            "shortening": "1 mm",
            "friction": 0.1,
        }
    ],
    objects=[
        vs.design.Object(
            name="plate",
            shape=vs.Box(size=("12 mm", "24 mm", "4 mm"), corner=("36 mm", "-4 mm", "-4.2 mm")),
            motion=vs.Motion(),
        )
    ],
    contact={"friction": 0.5},
    loads=[vs.Gravity()],
    probes={"tip": vs.Probe(x=("48 mm", "48 mm"))},
)
SENSORS = [Sensor(of="energy", noise=1e-6, drift=1e-6, delay="40 ms"), "chambers.air.pressure"]
SCRIPT = """
import sys
from pathlib import Path
sys.path.insert(0, {folder!r})
from test_stored_observation import digest, made
simulator = made()
simulator.restore(Path("state.npz").read_bytes())
print(digest(simulator))
"""


def made():
    return vs.Simulator(FINGER, sensors=SENSORS, seed=7)


def driven():
    simulator = made()
    for _ in range(3):
        seen = simulator.step(simulator.targets)
    assert np.linalg.norm(seen.contacts[0].force) > 1e-3
    return simulator


def bits(seen):
    return (
        seen.time,
        seen.status,
        seen.message,
        seen.positions.tobytes(),
        seen.velocities.tobytes(),
        seen.residual,
        seen.elastic_energy,
        seen.kinetic_energy,
        seen.chambers,
        seen.tendons["flexor"].tensions.tobytes(),
        [tuple(each.force) for each in seen.contacts],
        dict(seen.commands),
        dict(seen.work),
        seen.power,
        {name: each.tobytes() for name, each in seen.probes.items()},
        {name: each.tobytes() for name, each in seen.sensors.items()},
        seen.motion("tip").acceleration.tobytes(),
    )


def digest(simulator):
    commands = (None, {"flexor": "0.5 mm", "plate": (0, 0, "1 mm")}, {"air.valve": 0.0})
    seen = [bits(simulator.step(each)) for each in commands]
    return hashlib.sha256(repr(seen).encode()).hexdigest()


@pytest.mark.long
def test_it_goes_on_in_another_process(tmp_path):
    simulator = driven()
    seen = simulator.state
    (tmp_path / "state.npz").write_bytes(seen.to_bytes())
    other = pickle.loads(pickle.dumps(simulator))
    assert other.design == simulator.design
    assert other._live.memory() == seen._moment.memory
    expected = digest(simulator)
    assert digest(other) == expected
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT.format(folder=str(Path(__file__).parent))],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        check=True,
    )
    assert done.stdout.split() == [expected]


@pytest.mark.long
def test_all_of_an_observation_comes_back():
    simulator = driven()
    seen = simulator.state
    found = simulator.restore(seen.to_bytes())
    assert found is simulator.state is not seen
    assert bits(found) == bits(seen)
    # A first observation has no velocities before it.
    first = simulator.reset()
    assert bits(simulator.restore(first.to_bytes())) == bits(first)


def changed(content, **changes):
    """Return bytes with other entries of their text or other arrays."""
    with np.load(BytesIO(content)) as arrays:
        found = dict(arrays)
    text = json.loads(str(found["text"]))
    for name, value in changes.items():
        (found if name in found else text)[name] = value
    found["text"] = np.array(json.dumps(text))
    written = BytesIO()
    np.savez(written, **found)
    return written.getvalue()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda content: content[:-40], "its bytes are damaged"),
        (lambda content: b"", "its bytes are damaged"),
        (lambda content: changed(content, voxsoft="0.1.0"), r"are of VoxSoft 0\.1\.0, and this is"),
        (lambda content: changed(content, design="0"), "are of another design"),
        (lambda content: changed(content, time_step=0.01), "of steps of 0.01 s, not 0.02 s"),
        (lambda content: changed(content, memory=np.zeros(9, np.uint8)), "bytes: damaged, or"),
        (lambda content: changed(content, driven={}), "are damaged: 'values'"),
    ],
)
def test_bytes_of_something_else_are_refused(change, words):
    simulator = vs.Simulator(families.beam())
    content = simulator.step().to_bytes()
    before = simulator.state
    with pytest.raises(SimulationError, match=words):
        simulator.restore(change(content))
    assert simulator.state is before
    assert simulator.restore(content).time == 0.02
