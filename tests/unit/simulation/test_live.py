"""The live run behind the studio: steps, hands on it, and the bytes that are sent."""

import struct
import threading

import lattice_families as families
import numpy as np
import pytest

import voxsoft as vs
from voxsoft import _core
from voxsoft._core import LiveStatus as Status
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

LATTICE = vs.Lattice(edge=60 * kPa, bulk=400 * kPa, density=1070.0)
HEADER = struct.Struct("<IBBHIIdII6f2f")
#: Two states at rest whose residuals are below 1e-4 differ by about as much, the slowest mode last.
SAME = 2e-3


def beam(length=30 * mm):
    return vs.Design(
        name="beam",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=vs.Box(size=(length, 10 * mm, 10 * mm)), material=LATTICE)],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[vs.Gravity()],
    )


def live_of(setup, **settings):
    triangles = setup.mesh.triangles.astype(np.uint32)
    tags = np.zeros(len(triangles), np.uint8)
    return _core.Live(setup.problem, triangles, tags, setup.design.voxel_size, **settings)


def settle(live):
    for _ in range(500):
        look = live.advance(1000)
        if look.status != Status.MOVING:
            return look
    pytest.fail(f"not at rest: {look}")


@pytest.fixture(scope="module")
def setup():
    return Setup.of(beam())


def test_comes_to_the_rest_of_simulate(setup):
    expected = vs.simulate(setup, method="xpbd").positions
    live = live_of(setup)
    look = settle(live)
    assert look.status == Status.AT_REST
    assert look.residual < 1e-4
    assert 0 <= look.kinetic < 1e-4 * look.elastic
    moved = np.abs(expected - setup.mesh.vertices).max()
    assert np.abs(live.positions() - expected).max() < SAME * moved
    again = live.advance(1000)
    assert (again.taken, again.substeps) == (0, look.substeps)


def test_pressure_follows_the_slider():
    setup = Setup.of(families.cylinder())
    live = live_of(setup)
    live.set_load(0, 0.0)
    assert settle(live).elastic < 1e-12
    live.set_load(0, None)
    settle(live)
    expected = vs.simulate(setup, method="xpbd").positions
    moved = np.abs(expected - setup.mesh.vertices).max()
    assert np.abs(live.positions() - expected).max() < SAME * moved
    with pytest.raises(ValueError, match="load"):
        live.set_load(9, 1.0)


def test_a_hand_pulls_and_lets_go(setup):
    live = live_of(setup)
    settle(live)
    before = live.positions()
    vertex = int(np.argmax(setup.mesh.vertices.sum(axis=1)))
    target = before[vertex] + [0.0, 3 * mm, 0.0]
    live.grab(4, vertex, target.tolist(), 100.0)
    settle(live)
    [(number, held, asked, force, stretch)] = live.grabs()
    assert (number, held, asked) == (4, vertex, target.tolist())
    assert np.linalg.norm(force) == pytest.approx(100.0 * stretch)
    net = setup.problem.net_forces(live.positions())[vertex]
    assert np.linalg.norm(net + force) < 1e-3 * np.linalg.norm(force)
    assert live.release(4)
    assert not live.release(4)
    settle(live)
    moved = np.abs(before - setup.mesh.vertices).max()
    assert np.abs(live.positions() - before).max() < SAME * moved
    with pytest.raises(ValueError, match="stiffness"):
        live.grab(0, vertex, target.tolist(), -1.0)


def test_goes_back_and_elsewhere(setup):
    live = live_of(setup)
    look = settle(live)
    rest = live.positions()
    live.reset()
    np.testing.assert_array_equal(live.positions(), setup.mesh.vertices)
    live.seek(rest, look.time)
    assert live.advance(64).status == Status.AT_REST
    with pytest.raises(ValueError, match="positions"):
        live.seek(rest[1:])


def test_an_advance_keeps_to_its_budget_and_its_limit(setup):
    live = live_of(setup)
    assert live.advance_for(0.0).taken == 1
    assert live.advance_for(60.0, max_substeps=7).taken == 7
    with pytest.raises(ValueError, match="seconds"):
        live.advance_for(-1.0)


def test_a_frame_holds_positions_and_a_field(setup):
    live = live_of(setup)
    settle(live)
    frame = live.pack_frame(3, 12, 3, seq=5, flags=4)
    magic, kind, flags, field, topology, number, time, n, seq, *rest = HEADER.unpack(frame[:64])
    assert magic.to_bytes(4, "little") == b"VXF1"
    assert (kind, flags, field, topology, number, seq) == (2, 4, 3, 3, 12, 5)
    assert time > 0
    shown = live.vertices
    assert n == len(shown)
    origin, scale, (low, high) = rest[:3], rest[3:6], rest[6:]
    rows = np.frombuffer(frame[64:], "<u2").reshape(n, 4) / 65535
    positions = live.positions()[shown]
    # Half a step of each axis, and origin and scale in float32.
    step = np.asarray(scale) / 65535
    error = np.abs(np.asarray(origin) + rows[:, :3] * scale - positions)
    assert (error < 0.51 * step + 1e-8).all()
    sag = (positions - setup.mesh.vertices[shown])[:, 2]
    assert np.abs(low + rows[:, 3] * (high - low) - sag).max() < 1e-6
    stored = _core.Display.surface(
        setup.problem,
        setup.mesh.triangles.astype(np.uint32),
        np.zeros(len(setup.mesh.triangles), np.uint8),
        5 * mm,
    )
    again = stored.pack_frame(
        live.positions(), topology=3, frame=12, field=3, seq=5, flags=4, time=time
    )
    assert again == frame
    with pytest.raises(ValueError, match="no field 9"):
        live.pack_frame(1, 1, 9)


def test_the_topology_is_sent_once(setup):
    live = live_of(setup)
    topology = live.pack_topology(3)
    _, kind, flags, _, number, _, size, n, triangles = struct.unpack("<IBBHIIdII", topology[:32])
    (edges,) = struct.unpack("<I", topology[32:36])
    assert (kind, flags, number, size) == (1, 1, 3, 5 * mm)
    # A box of 6 x 2 x 2 voxels: 56 squares, of which each edge belongs to two.
    assert (triangles, edges) == (112, 112)
    assert len(topology) == 64 + 12 * n + 12 * triangles + 8 * edges + triangles


def test_tets_are_shown_shrunk(setup):
    tets = setup.mesh.tets[:10].astype(np.uint32)
    display = _core.Display.tets(setup.problem, tets, np.ones(10, np.uint8), 5 * mm)
    live = live_of(setup)
    assert display.points == 40
    assert len(live.pack_frame(2, 1, 5, display=display)) == 64 + 8 * 40
    other = Setup.of(beam(20 * mm))
    with pytest.raises(ValueError, match="another problem"):
        live_of(other).pack_frame(2, 1, 5, display=display)


def test_threads_take_turns(setup):
    """Steps on two threads, hands and frames on a third: none waits for ever."""
    # Long enough for four slabs, which run in the pool of threads.
    live = live_of(Setup.of(beam(100 * mm)))
    failed = []

    def pull():
        try:
            for number in range(200):
                live.grab(0, 5, [0.01, 0.0, number * 1e-5], 10.0)
                live.pack_frame(1, number, 5)
                live.release(0)
        except Exception as error:
            failed.append(error)

    def step():
        while hand.is_alive():
            live.advance(20)

    hand = threading.Thread(target=pull)
    hand.start()
    other = threading.Thread(target=step)
    other.start()
    step()
    other.join()
    hand.join()
    assert failed == []
    assert np.isfinite(live.positions()).all()


def test_the_deterministic_way_differs_by_rounding_alone(setup):
    quick, plain = live_of(setup, damping=5.0), live_of(setup, damping=5.0, deterministic=True)
    quick.advance(500)
    plain.advance(500)
    moved = np.abs(plain.positions() - setup.mesh.vertices).max()
    assert np.abs(quick.positions() - plain.positions()).max() < 1e-9 * moved


def test_implicit_steps_keep_to_a_limit_of_memory():
    material = vs.NeoHookean(young=60 * kPa, poisson=0.49, density=1070.0)
    design = beam()
    design = design.replace(parts=[part.replace(material=material) for part in design.parts])
    rubber = Setup.of(design)
    assert live_of(rubber).advance(1).taken == 1
    live = live_of(rubber, memory=10_000)
    with pytest.raises(MemoryError, match=r"about \d+ bytes"):
        live.advance(1)
    assert (live.positions() == rubber.mesh.vertices).all()
