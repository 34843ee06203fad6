"""A studio that runs for real, and a tab that talks to it."""

import asyncio
import json
import signal
import struct
import subprocess
import sys
import threading
from contextlib import asynccontextmanager
from pathlib import Path
from types import SimpleNamespace

import pytest
import websockets
from own_loop import run

from voxsoft.studio.protocol.wire import PROTOCOL
from voxsoft.studio.server.process import StudioServer

#: Seconds after which a missing event never comes, however busy the machine is.
PATIENCE = 120.0
EXAMPLES = Path(__file__).parents[2] / "examples"
CYLINDER = EXAMPLES / "cylinder.toml"


@pytest.fixture(scope="session", autouse=True)
def state_of_the_tests(tmp_path_factory):
    """Ports and tokens of these studios are not kept among those of the user."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_STATE_HOME", str(tmp_path_factory.mktemp("state")))
        yield


class Page:
    """A tab of the browser, without a browser."""

    def __init__(self, socket):
        self._socket = socket
        self._seq = 0
        self.frames = []
        self.smooth = None
        self.topology = None
        self.document = None
        self.stat = None
        self.log = []

    @property
    def rev(self):
        """The revision of the document that this tab saw last."""
        return self.document.rev

    async def send(self, tag, **fields):
        self._seq += 1
        await self._socket.send(json.dumps({"t": tag, "seq": self._seq, **fields}))
        return self._seq

    async def send_raw(self, data):
        await self._socket.send(data)

    async def receive(self, seconds=PATIENCE):
        """The next message: an event as a namespace, or a binary message as its header."""
        message = await asyncio.wait_for(self._socket.recv(), seconds)
        if isinstance(message, bytes):
            return self._binary(message)
        event = json.loads(message)
        self.log.append(event)
        received = SimpleNamespace(**event)
        if received.t == "document":
            self.document = received
        elif received.t == "stat":
            self.stat = received
        return received

    def _binary(self, message):
        head = struct.unpack_from("<IBBHIIdII", message)
        names = ("magic", "kind", "flags", "field", "topology", "frame", "time", "n", "seq")
        found = SimpleNamespace(**dict(zip(names, head, strict=True)), bytes=message)
        found.t = {1: "topology", 2: "frame", 3: "smooth"}[found.kind]
        if found.kind == 2:
            self.frames.append(found)
        elif found.kind == 3:
            self.smooth = found
        else:
            self.topology = found
        return found

    async def until(self, tag, condition=lambda _: True, seconds=PATIENCE, ack=True):
        """Read on until a message of a kind that meets a condition."""
        async with asyncio.timeout(seconds):
            while True:
                message = await self.receive(None)
                if message.t == "frame" and ack:
                    await self.send("ack", frame=message.frame)
                if message.t == tag and condition(message):
                    return message

    async def shown(self, condition, seconds=PATIENCE, *, seen=False):
        """Read on until a statistic meets a condition and its frame has come; in any order.

        With `seen` the last statistic that came before counts too.
        """
        stat = self.stat if seen else None
        async with asyncio.timeout(seconds):
            while True:
                frame = self.frames[-1] if self.frames else None
                if stat is not None and frame is not None:
                    same = (frame.topology, frame.frame) == (stat.topology, stat.frame)
                    resting = bool(frame.flags & 4) == (stat.state == "at-rest")
                    if condition(stat) and same and resting:
                        return stat, frame
                message = await self.receive()
                if message.t == "frame":
                    await self.send("ack", frame=message.frame)
                elif message.t == "stat":
                    stat = message

    async def settled(self):
        """Read all events caused by earlier commands.

        A question is answered by the engine's thread, and reaches it through that of the commands:
        what either was asked before has been told by then. A frame that waits goes out after the
        words that wait, so it may follow the first answer, but not the second.
        """
        for _ in range(2):
            asked = await self.send("pick", vertex=0)
            while True:
                message = await self.receive()
                # If there is no body yet, that is the answer.
                if message.t == "picked" or (message.t == "error" and message.seq == asked):
                    break

    async def close(self):
        await self._socket.close()


class Studio:
    """A server on a thread of its own."""

    def __init__(self, runs, source=None):
        self.server = StudioServer(source, runs=runs)
        self.session = self.server.session
        self.token, self.port = self.server.token, self.server.port
        self.origin = f"http://127.0.0.1:{self.port}"
        self._ready = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def _run(self):
        self.server.run(lambda _: self._ready.set())

    def start(self):
        self._thread.start()
        assert self._ready.wait(20)
        return self

    def stop(self):
        self.server.stop()
        self._thread.join(20)
        assert not self._thread.is_alive()

    def page(self, hello=True, **options):
        return visited(self.port, self.token, hello=hello, **options)

    async def begin_again(self, source):
        """Be as at the start: the file, unloaded at time zero, nothing to undo. Runs stay."""
        async with self.page() as page:
            while page.document.can_undo or page.document.before:
                rev = page.rev
                await page.send("undo", beyond=True)
                await page.until("document", lambda d, rev=rev: d.rev > rev)
            if page.document.path is None:  # undo would lead back to a document without a file
                await page.send("save", path="left.toml", overwrite=True)
                await page.until("saved")
            await page.send("pace")
            await page.send("solver", method="auto")
            rev = page.rev
            await page.send("open", what="file", name=str(source))
            await page.until("document", lambda d: d.rev > rev)
            body = await page.until("body", lambda b: b.rev == page.rev)
            # Its statistic may have come before it, and a body that stands still has no other.
            await page.shown(
                lambda s: s.state == "paused" and s.topology == body.topology, seen=True
            )


@asynccontextmanager
async def visited(port, token, hello=True, **options):
    """A tab of the studio at a port."""
    url = f"ws://127.0.0.1:{port}/ws?token={token}"
    settings = {"origin": f"http://127.0.0.1:{port}", "max_size": None, **options}
    async with websockets.connect(url, **settings) as socket:
        page = Page(socket)
        if hello:
            await page.send("hello", protocol=PROTOCOL)
            await page.until("document")
        yield page


SERVE = """
import sys
from pathlib import Path
from voxsoft.studio.server.process import StudioServer
server = StudioServer(Path(sys.argv[1]), runs=Path(sys.argv[2]), port=0, token="token")
server.run_and_exit(lambda address: print(server.port, flush=True))
"""


class OwnProcess:
    """A server in a process of its own, which a test may kill or interrupt."""

    def __init__(self, source, runs):
        command = [sys.executable, "-c", SERVE, str(source), str(runs)]
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        self.port = int(self.process.stdout.readline())

    def page(self, **options):
        return visited(self.port, "token", **options)

    def end(self, how, seconds=60):
        """Send a signal and wait; returns the exit code and the text of stderr."""
        self.process.send_signal(how)
        _, reported = self.process.communicate(timeout=seconds)
        return self.process.returncode, reported


@pytest.fixture
def in_own_process(tmp_path):
    """Start studios in processes of their own, with runs in a folder of the test."""
    started = []

    def start(source, runs=None):
        started.append(OwnProcess(source, runs or tmp_path / "runs"))
        return started[-1]

    yield start
    for studio in started:
        if studio.process.poll() is None:
            studio.end(signal.SIGKILL)


@pytest.fixture
def make_studio(tmp_path):
    """Start studios in a folder of the test; they are stopped at its end."""
    started = []

    def make(source=CYLINDER, runs=None):
        studio = Studio(runs or tmp_path / "runs", source).start()
        started.append(studio)
        return studio

    yield make
    for studio in started:
        studio.stop()


@pytest.fixture
def fresh_studio(make_studio):
    """A server of the test's own, for tests of runs and drafts, and of the first picture."""
    return make_studio()


@pytest.fixture(scope="module")
def shared_studio(tmp_path_factory):
    """A server for all tests of a file, with the cylinder; changes by one are seen by the next."""
    studio = Studio(tmp_path_factory.mktemp("studio") / "runs", CYLINDER).start()
    yield studio
    studio.stop()


@pytest.fixture
def studio(shared_studio):
    """The server of the file, with its document opened again."""
    run(shared_studio.begin_again(CYLINDER))
    return shared_studio


@pytest.fixture(scope="module")
def at_rest(tmp_path_factory):
    """A studio whose cylinder was played, and then brought to rest."""
    studio = Studio(tmp_path_factory.mktemp("studio") / "runs", CYLINDER).start()

    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            await page.send("play")
            await page.shown(lambda s: s.state == "at-rest")
            await page.send("rest")
            await page.shown(lambda s: s.state == "at-rest" and "residual" in s.sentence)

    run(scenario())
    yield studio
    studio.stop()
