"""The state of a solver is stored beside positions, and read back to the last bit."""

import dataclasses
import json
from dataclasses import replace

import numpy as np
import pytest
from pressed import PLATE, pressed

import voxsoft as vs
from voxsoft.design import Contact, Floor, Object, VolumeSupply, families
from voxsoft.errors import SimulationError
from voxsoft.materials import Mullins
from voxsoft.simulation import Setup, simulate
from voxsoft.simulation.runs.solved_state import SolvedState, is_given_by_positions
from voxsoft.units import kPa, mm

#: A ball of 8 mm between the plate and the block's upper face.
BALL = Object(
    name="ball",
    shape=vs.Sphere(radius=4 * mm, center=(6 * mm, 6 * mm, 16.02 * mm)),
    motion=vs.Motion(displacement=(0, 0, -1.5 * mm)),
    voxel_size=2 * mm,
)


def same(a, b):
    """Check if two values are alike to the last bit, of any type."""
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and np.array_equal(a, b, equal_nan=True)
    if dataclasses.is_dataclass(a):
        names = [each.name for each in dataclasses.fields(a)]
        return type(a) is type(b) and all(same(getattr(a, n), getattr(b, n)) for n in names)
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, (tuple, list)):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b, strict=True))
    return type(a) is type(b) and a == b


def gripped():
    return pressed(objects=[BALL], contact=Contact(friction=0.4), loads=[vs.Gravity()])


def softening():
    rubber = vs.Yeoh(c=(10 * kPa, 1 * kPa), poisson=0.45, mullins=Mullins(r=1.6, m=1 * kPa))
    block = vs.Box(size=(12 * mm, 12 * mm, 12 * mm))
    return pressed(objects=[PLATE], parts=[vs.Part(shape=block, material=rubber)])


def supplied():
    return families.sphere().replace(
        loads=(), supplies=(VolumeSupply(chamber="all", value="1 mL"),)
    )


def moving():
    """A cube that falls on the floor for some moments."""
    solver = vs.Solver(method="dynamics", time_step=0.005, end_time=0.03)
    return pressed(
        objects=(),
        clamps=(),
        loads=[vs.Gravity()],
        floor=Floor(z=-0.1 * mm),
        solver=solver,
        contact=Contact(),
    )


@pytest.mark.long
@pytest.mark.parametrize("make", [gripped, softening, supplied, moving])
def test_a_result_is_read_back_to_the_last_bit(make):
    design = make()
    assert not is_given_by_positions(design)
    result = simulate(design)
    assert result.status == "ok", result.message
    stored = SolvedState.of(result)
    assert "NotImplemented" not in stored.text
    setup = Setup.of(design)  # of a mesh made anew, as when a design is opened
    found = stored.result(setup, result.positions)
    for each in dataclasses.fields(result):
        if each.name not in ("design", "mesh", "places", "recording"):
            assert same(getattr(found, each.name), getattr(result, each.name)), each.name
    assert found.design == result.design
    frames = result.recording.frames[:0]
    assert same(replace(found.recording, frames=frames), replace(result.recording, frames=frames))
    assert len(found.recording.frames) == 0
    assert found.metrics == result.metrics
    assert found.fields.stress.tolist() == result.fields.stress.tolist()
    assert [str(each) for each in found.warnings] == [str(each) for each in result.warnings]
    assert found.summary() == result.summary()


def test_states_given_by_positions_are_measured_anew_and_not_stored():
    assert is_given_by_positions(families.beam())


@pytest.fixture(scope="module")
def state():
    design = gripped()
    result = simulate(design)
    return Setup.of(design), result, SolvedState.of(result)


def test_poses_of_objects_are_read_without_the_rest(state):
    _, result, stored = state
    assert stored.objects == result.objects


def test_results_of_another_version_are_not_taken(state):
    setup, result, stored = state
    old = replace(stored, text=json.dumps(json.loads(stored.text) | {"voxsoft": "0.0.1"}))
    with pytest.raises(SimulationError, match="another version"):
        old.result(setup, result.positions)


def test_results_of_another_mesh_are_not_taken(state):
    _, _, stored = state
    finer = Setup.of(gripped().replace(voxel_size=3 * mm))
    with pytest.raises(SimulationError, match="another mesh"):
        stored.result(finer, finer.mesh.vertices)


@pytest.mark.parametrize(
    "change",
    [
        lambda s: replace(s, text=""),
        lambda s: replace(s, text="[]"),
        lambda s: replace(s, text=s.text.replace('"reactions"', '"other"')),
        lambda s: replace(s, text=s.text.replace('"steps": ', '"steps": "many" , "x": ')),
        lambda s: replace(s, arrays=s.arrays[:1]),
    ],
)
def test_damaged_files_are_refused_with_a_remedy(state, change):
    setup, result, stored = state
    with pytest.raises(SimulationError, match="solve the design again"):
        change(stored).result(setup, result.positions)
