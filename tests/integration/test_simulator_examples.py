"""Every example in a simulator: commands within bounds, saved on the way, restored to the bit."""

from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.errors import DesignError

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
#: Examples of each way to drive whose steps take a fifth of a second.
LIGHT = (
    "beam",
    "crawler",
    "cylinder",
    "dielectric_bender",
    "pulsed_finger",
    "shape_memory_finger",
    "tendon_finger",
)
ALL = sorted(path.stem for path in EXAMPLES.glob("*.toml"))


@pytest.fixture(autouse=True)
def beside_the_benchmarks(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))


def bits(seen):
    return (
        seen.time,
        seen.status,
        seen.positions.tobytes(),
        seen.velocities.tobytes(),
        seen.chambers,
        seen.energy,
        dict(seen.commands),
    )


def drive(name, before, after):
    from walk import walk

    simulator = vs.Simulator(vs.load(EXAMPLES / f"{name}.toml"))
    given = walk(simulator, before + after)
    for commands in given[:before]:
        saved = simulator.step(commands)
        assert saved.status != "diverged", saved.message
    first = [bits(simulator.step(commands)) for commands in given[before:]]
    # An alloy that does not transform yet leaves its finger at rest.
    rests = simulator.state.status == "at-rest"
    assert rests or simulator.state.positions.tobytes() != saved.positions.tobytes()
    last = simulator.state
    with pytest.raises(DesignError, match=r'commands: "no such drive" is no command'):
        simulator.step({"no such drive": 1.0})
    assert simulator.state is last
    simulator.restore(saved)
    assert [bits(simulator.step(commands)) for commands in given[before:]] == first
    assert np.isfinite(last.positions).all()


@pytest.mark.long
@pytest.mark.parametrize("name", LIGHT)
def test_an_example_goes_on_to_the_same_bits(name):
    drive(name, 3, 2)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in ALL if name not in LIGHT])
def test_a_large_example_goes_on_to_the_same_bits(name):
    drive(name, 2, 1)
