"""From a request for a shape to the shape: the newest wins; the picture comes before the words."""

import queue
import struct
import threading

import lattice_families as families
import numpy as np
import pytest

from voxsoft.studio.bodies import mesher
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.mesher import Mesher
from voxsoft.studio.bodies.surface import Surface
from voxsoft.studio.motion.canvas import Canvas
from voxsoft.studio.motion.pictures import Pictures
from voxsoft.studio.motion.playback import Playback
from voxsoft.studio.motion.player import Player
from voxsoft.studio.protocol.tab import Tab
from voxsoft.studio.protocol.wire import CAVITY
from voxsoft.studio.server.catalog import FIELDS
from voxsoft.voxels import Voxels

DISPLACEMENT = next(field.id for field in FIELDS if field.name == "displacement")


@pytest.fixture(scope="module")
def body():
    return StudioBody.of(families.cylinder(), 1, 1)


@pytest.fixture
def requests(monkeypatch):
    """A mesher whose bodies are made only when the test lets them."""
    begun, let, made, shown = [], threading.Semaphore(0), threading.Semaphore(0), []

    def of(design, rev, topology):
        begun.append(rev)
        made.release()
        let.acquire()
        return rev

    monkeypatch.setattr(mesher.StudioBody, "of", of)
    monkeypatch.setattr(mesher, "IDLE", 60.0)
    thread = Mesher(lambda: None, shown.append, *[lambda *_: None] * 3)
    thread.start()
    yield thread, begun, made, let, shown
    thread.end()
    let.release()
    thread.join(20)


def test_a_check_that_fails_is_reported_and_the_mesher_lives_on(monkeypatch):
    events = queue.SimpleQueue()
    put = lambda name: lambda *what: events.put((name, *what))  # noqa: E731
    names = ("done", "examined", "failed", "unexamined")
    thread = Mesher(lambda: None, *map(put, names))
    whole = mesher.StudioBody.report
    monkeypatch.setattr(mesher.StudioBody, "report", lambda _: 1 / 0)
    thread.start()
    try:
        thread.ask(families.cylinder(), 1)
        assert events.get(timeout=20)[0] == "done"
        name, error = events.get(timeout=20)
        assert name == "unexamined"
        assert "ZeroDivisionError" in str(error)
        monkeypatch.setattr(mesher.StudioBody, "report", whole)
        thread.ask(families.cylinder(), 2)
        assert [events.get(timeout=20)[0] for _ in range(2)] == ["done", "examined"]
    finally:
        thread.end()
        thread.join(20)


def test_a_late_timer_does_not_announce_a_body_that_came(monkeypatch):
    """A timer that woke just before it was cancelled calls its function all the same."""
    late, heard = [], queue.SimpleQueue()

    class Late:
        def __init__(self, seconds, function, arguments=()):
            late.append(lambda: function(*arguments))

        def start(self):
            pass

        def cancel(self):
            pass

    monkeypatch.setattr(mesher.threading, "Timer", Late)
    monkeypatch.setattr(mesher.StudioBody, "of", lambda design, rev, topology: rev)
    thread = Mesher(lambda: heard.put("slow"), heard.put, *[lambda *_: None] * 3)
    thread.start()
    thread.ask(families.cylinder(), 7)
    assert heard.get(timeout=20) == 7
    late[0]()
    assert heard.empty()
    thread.end()
    thread.join(20)


def test_only_the_newest_of_several_requests_is_answered(requests):
    thread, begun, made, let, shown = requests
    design = families.cylinder()
    thread.ask(design, 1)
    assert made.acquire(timeout=20)
    for rev in (2, 3, 4):
        thread.ask(design, rev)
    let.release()
    assert made.acquire(timeout=20)
    thread.ask(design, 5)
    let.release()
    assert made.acquire(timeout=20)
    let.release()
    thread.end()
    thread.join(20)
    assert begun == [1, 4, 5]
    assert shown == [1, 4, 5]


class Heard:
    """A bus that keeps its events."""

    def __init__(self):
        self.reported = []
        self._tab = Tab(socket=None, greeted=True)

    def tabs(self):
        return [self._tab]

    def topology(self, packed, mode):
        self.reported.append("topology")

    def publish(self, event):
        self.reported.append(type(event).__name__)

    def frame(self, tab, packed):
        self.reported.append("frame")


def test_the_shape_is_sent_before_all_that_is_reported_of_it(body):
    heard, playback = Heard(), Playback()
    playback.begin(body)
    pictures = Pictures(playback, heard)
    pictures.begin(body)
    pictures.paint_all()
    assert heard.reported == ["topology", "Body", "frame"]


def test_a_tab_gets_no_frames_before_its_snapshot(body):
    """They could not be acknowledged before the page heard its greeting."""
    heard, playback = Heard(), Playback()
    heard.send_to = lambda tab, event: heard.publish(event)
    heard.topology_for = lambda tab, packed: heard.topology(packed, "surface")
    (tab,) = heard.tabs()
    tab.greeted = False
    playback.begin(body)
    pictures = Pictures(playback, heard)
    pictures.paint_all()
    assert heard.reported == []
    pictures.send_snapshot(tab)
    assert heard.reported == ["Body", "topology", "Plot", "frame"]


def drawn(packed):
    """Positions [m] of a frame, the step between two of them, and the range of its field."""
    origin, scale = np.frombuffer(packed, "<f4", 6, 32).astype(float).reshape(2, 3)
    steps = np.frombuffer(packed, "<u2", offset=64).reshape(-1, 4)
    return (
        origin + scale * steps[:, :3] / 65_535,
        scale / 65_535,
        struct.unpack_from("<2f", packed, 56),
    )


@pytest.mark.parametrize("mode", ["surface", "solid", "tets"])
def test_the_first_frame_equals_that_of_the_core(body, mode, monkeypatch):
    canvas = Canvas(body)
    of_core = canvas.frame(Player(body), DISPLACEMENT, mode)
    monkeypatch.setattr(Canvas, "_surface", None)
    monkeypatch.setattr(Canvas, "_solid", None)
    monkeypatch.setattr(Canvas, "_tets", None)
    points, _, span = drawn(Canvas(body).frame(None, DISPLACEMENT, mode))
    expected, step, expected_span = drawn(of_core)
    assert (np.abs(points - expected) <= 1.01 * step).all()
    assert span == expected_span == (0.0, 0.0)


def test_triangles_know_their_part_and_their_cavity():
    rng = np.random.default_rng(3)
    grid = rng.integers(1, 4, (5, 5, 5))
    grid[2, 2, 2] = 0
    mesh = Voxels.from_array(grid, voxel_size=0.01).mesh()
    assert len(mesh.cavities) == 1
    tags = Surface.of(mesh).tags
    inside = {frozenset(corners) for corners in mesh.cavities[0].triangles.tolist()}
    of_faces = {}
    for tet, part in zip(mesh.tets.tolist(), mesh.tet_part.tolist(), strict=True):
        for left_out in range(4):
            of_faces[frozenset(tet[:left_out] + tet[left_out + 1 :])] = part - 1
    expected = [
        CAVITY if frozenset(corners) in inside else of_faces[frozenset(corners)]
        for corners in mesh.triangles.tolist()
    ]
    assert tags.tolist() == expected
    assert len(set(expected)) == 4
