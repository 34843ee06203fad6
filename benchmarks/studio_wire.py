"""The studio's server without a browser: frames to a client that takes each at once.

A browser that draws by software takes frames more slowly than the server makes them; this client
says what the server and the wire could give to a page that keeps up.
"""

from __future__ import annotations

import json
import math
import struct
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING
from urllib.parse import parse_qs, urlsplit

import numpy as np
from measure import Report

from voxsoft.studio.protocol.wire import HEADER, PROTOCOL

if TYPE_CHECKING:
    from websockets.sync.client import ClientConnection

#: Kinds of binary messages.
TOPOLOGY, FRAME = 1, 2
#: Simulated time before frames are counted [s], how long they are counted, how long to wait [s].
WARM, WINDOW, PATIENCE = 0.005, 5.0, 120.0
#: The clock's time in which the server looks a new body over beside its motion [s].
AT_FIRST = 4.0
#: The circle that a hand leads the tip around [m], and its spring [N/m].
RADIUS, STIFFNESS = 0.01, 20.0


class Tab:
    """Speaks as a tab of the browser does, and shows nothing."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self._seq = 0

    def send(self, tag: str, **fields: object) -> None:
        """Send a command."""
        self._seq += 1
        self._socket.send(json.dumps({"t": tag, "seq": self._seq, **fields}))

    def binary(self) -> bytes:
        """The next binary message; a frame is acknowledged at once."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            message = self._socket.recv(timeout=PATIENCE)
            if isinstance(message, bytes):
                if message[4] == FRAME:
                    self.send("ack", frame=struct.unpack_from("<I", message, 12)[0])
                return message
        raise SystemExit("wrong answer: no frame comes")

    def frame(self) -> tuple[float, int]:
        """Simulated time [s] and number of vertices of the next frame."""
        while (message := self.binary())[4] != FRAME:
            pass
        simulated, vertices = struct.unpack_from("<dI", message, 16)
        return simulated, vertices


@contextmanager
def visited(address: str) -> Iterator[tuple[Tab, bytes]]:
    """A tab at an address, with the topology of the body that it is sent first."""
    from websockets.sync.client import connect

    parts = urlsplit(address)
    token = parse_qs(parts.query)["token"][0]
    url = f"ws://{parts.netloc}/ws?token={token}"
    with connect(url, origin=f"http://{parts.netloc}", max_size=None) as socket:
        tab = Tab(socket)
        tab.send("hello", protocol=PROTOCOL)
        while (message := tab.binary())[4] != TOPOLOGY:
            pass
        yield tab, message


def wire(report: Report, count: int, address: str) -> None:
    """Frames per second that the server makes, and how much of time they show."""
    with visited(address) as (tab, topology):
        (drawn,) = struct.unpack_from("<I", topology, 24)
        tab.send("play")
        while (first := tab.frame())[0] < WARM:
            pass
        started, frames, last = time.perf_counter(), 0, first
        while (gone := time.perf_counter() - started) < WINDOW:
            last = tab.frame()
            frames += 1
        tab.send("reset")
    if last[1] != drawn or last[0] <= first[0]:
        raise SystemExit(
            f"wrong answer: frames of {count:,} voxels show another body, or no motion"
        )
    report.add(f"{count:,} voxels: frames of the server alone", frames / gone, "1/s")
    report.add(f"{count:,} voxels: simulated time", (last[0] - first[0]) / gone, "s/s")


def pulled_alone(report: Report, name: str, address: str) -> None:
    """The same while a hand leads the tip around a circle, once a second."""
    with visited(address) as (tab, topology):
        (drawn,) = struct.unpack_from("<I", topology, 24)
        rest = np.frombuffer(topology, "<f4", 3 * drawn, HEADER).reshape(-1, 3)
        tip = int(rest[:, 0].argmax())
        center = rest[tip].astype(float)

        def lead(gone: float) -> None:
            turn = 2 * math.pi * gone
            way = RADIUS * np.array([0.0, math.sin(turn), 1.0 - math.cos(turn)])
            target = (center + way).tolist()
            tab.send("grab", id=1, vertex=tip, target=target, stiffness=STIFFNESS)

        def follow(seconds: float) -> tuple[int, float, float]:
            """Frames at new times, the time simulated and that of the clock [s]."""
            began, frames = time.perf_counter(), 0
            first = last = tab.frame()[0]
            while (gone := time.perf_counter() - began) < seconds:
                lead(time.perf_counter() - started)
                now, vertices = tab.frame()
                if vertices != drawn:
                    raise SystemExit(f"wrong answer: frames of {name} show another body")
                frames += now > last
                last = now
            return frames, last - first, gone

        started = time.perf_counter()
        tab.send("play")
        lead(0.0)
        follow(AT_FIRST)
        frames, simulated, gone = follow(WINDOW)
        tab.send("reset")
    if not simulated > 0:
        raise SystemExit(f"wrong answer: {name} does not move")
    report.add(f"{name}, pulled: frames of the server alone", frames / gone, "1/s")
    report.add(f"{name}, pulled: simulated time of those", simulated / gone, "s/s")
