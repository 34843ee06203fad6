"""Queue of a tab, and the order in which it is sent."""

import asyncio

from own_loop import run

from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.tab import LONGEST_QUEUE, Tab


class Wire:
    """Keeps sent messages."""

    def __init__(self):
        self.sent = []
        self.closed = None

    async def send_text(self, data):
        self.sent.append(data)

    async def send_bytes(self, data):
        self.sent.append(data)

    async def close(self, code=1000, reason=None):
        self.closed = code


async def turns():
    """Let every other task of the loop go on until it waits: none needs more than three turns."""
    for _ in range(10):
        await asyncio.sleep(0)


def pumped(fill):
    async def scenario():
        wire = Wire()
        tab = Tab(wire)
        pump = asyncio.create_task(tab.pump())
        for step in fill(tab):
            del step
            await turns()
        await turns()
        pump.cancel()
        return wire

    return run(scenario())


def test_without_credits_the_newest_frame_waits_alone():
    def fill(tab):
        for name in (b"1", b"2", b"3", b"4"):
            yield tab.put_frame(name)
        yield tab.ack()

    assert pumped(fill).sent == [b"1", b"2", b"4"]


def test_a_new_topology_goes_first_and_drops_waiting_frames():
    def fill(tab):
        tab.put_frame(b"old")
        yield tab.put_topology(b"topology")
        yield tab.put_frame(b"new")

    assert pumped(fill).sent == [b"topology", b"new"]


def test_shapes_and_displays_of_a_body_wait_beside_each_other():
    def message(kind, flags, body, name):
        return bytes(4) + bytes([kind, flags, 0, 0]) + body.to_bytes(4, "little") + name

    surface, tets, anew = (message(1, 1, 7, b"a"), message(1, 2, 7, b"b"), message(1, 1, 7, b"c"))
    smooth, other = message(3, 0, 7, b"d"), message(1, 1, 8, b"e")

    def sent(*messages):
        def fill(tab):
            for each in messages:
                (tab.put_smooth if each is smooth else tab.put_topology)(each)
            yield None

        return pumped(fill).sent

    assert sent(surface, smooth, tets) == [surface, smooth, tets]
    assert sent(surface, tets, anew) == [tets, anew]
    assert sent(surface, smooth, other) == [other]


def test_statistics_and_rows_are_merged_while_they_wait():
    def fill(tab):
        for time in (0.0, 1.0):
            tab.put(events.Stat(topology=1, state="playing", sentence="", time=time))
        for row in (1.0, 2.0):
            tab.put(events.Plot(topology=1, names=["t"], units=["s"], rows=[[row]]))
        yield None

    sent = pumped(fill).sent
    assert len(sent) == 2
    assert '"time":1.0' in sent[0]
    assert '"rows":[[1.0],[2.0]]' in sent[1]


def test_outdated_events_are_not_kept_for_a_slow_tab():
    def fill(tab):
        for number in range(1000):
            tab.put(events.Runs(rows=[], trash=[], folder=f"{number}"))
            tab.put(events.Stat(topology=1, state="playing", sentence="", time=float(number)))
            tab.put(events.Plot(topology=1, names=["t"], units=["s"], rows=[[float(number)]]))
            tab.put_topology(bytes([number % 256]))
        yield None

    sent = pumped(fill).sent
    texts = [each for each in sent if isinstance(each, str)]
    assert [each for each in sent if isinstance(each, bytes)] == [bytes([999 % 256])]
    assert len(texts) == 3
    assert any('"folder":"999"' in each for each in texts)
    assert any('"time":999.0' in each for each in texts)
    assert any("[0.0],[1.0]" in each and "[999.0]]" in each for each in texts)


def test_a_tab_that_reads_nothing_is_cut_off_though_its_pump_is_stuck():
    class Stuck(Wire):
        async def send_text(self, data):
            await asyncio.Event().wait()

    async def scenario():
        wire = Stuck()
        tab = Tab(wire)
        pump = asyncio.create_task(tab.pump())
        tab.put(events.Log(level="info", text="the pump is stuck with this one"))
        await turns()
        for _ in range(3 * LONGEST_QUEUE):
            tab.put(events.Log(level="info", text=""))
        assert tab.closed
        assert len(tab._queue) == 0
        await turns()
        pump.cancel()
        return wire

    assert run(scenario()).closed == 1013


def test_a_tab_that_does_not_keep_up_is_cut_off():
    def fill(tab):
        for _ in range(LONGEST_QUEUE + 1):
            tab.put(events.Log(level="info", text=""))
        yield None

    wire = pumped(fill)
    assert wire.closed == 1013
    assert wire.sent == []
