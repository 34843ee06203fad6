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

from voxsoft.studio.server import StudioServer
from voxsoft.studio.wire import PROTOCOL

#: Seconds after which what has not come never will, however busy the machine is.
PATIENCE = 120.0
EXAMPLES = Path(__file__).parents[2] / "examples"


class Page:
    """What a tab of the browser does, without a browser."""

    def __init__(self, socket):
        self._socket = socket
        self._seq = 0
        self.frames = []
        self.smooth = None
        self.topology = None
        self.log = []

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
        return SimpleNamespace(**event)

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

    async def shown(self, condition, seconds=PATIENCE):
        """Read on until a statistic meets a condition and its frame has come; in any order."""
        stat = None
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

    async def quiet(self, seconds=0.3):
        """Read what comes until nothing does for a while."""
        while True:
            try:
                await self.receive(seconds)
            except TimeoutError:
                return

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


@asynccontextmanager
async def visited(port, token, hello=True, **options):
    """A tab of the studio at a port."""
    url = f"ws://127.0.0.1:{port}/ws?token={token}"
    settings = {"origin": f"http://127.0.0.1:{port}", "max_size": None, **options}
    async with websockets.connect(url, **settings) as socket:
        page = Page(socket)
        if hello:
            await page.send("hello", protocol=PROTOCOL)
            await page.until("document", ack=False)
        yield page


SERVE = """
import sys
from pathlib import Path
from voxsoft.studio.server import StudioServer
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
        """Send a signal and wait; returns the exit code and what was written to stderr."""
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

    def make(source=EXAMPLES / "cylinder.toml", runs=None):
        studio = Studio(runs or tmp_path / "runs", source).start()
        started.append(studio)
        return studio

    yield make
    for studio in started:
        studio.stop()


@pytest.fixture
def studio(make_studio):
    return make_studio()


@pytest.fixture(scope="module")
def at_rest(tmp_path_factory):
    """A studio whose cylinder was played, and then brought to rest."""
    studio = Studio(tmp_path_factory.mktemp("studio") / "runs", EXAMPLES / "cylinder.toml").start()

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
