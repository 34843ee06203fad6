"""The messages of the studio, and their types in TypeScript."""

from contextlib import suppress
from pathlib import Path

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxsoft.studio.protocol import commands, events
from voxsoft.studio.protocol.codec import ProtocolError, decode, encode
from voxsoft.studio.server.catalog import hello
from voxsoft.studio.typescript import typescript

PAGE_TYPES = Path(__file__).parents[3] / "studio" / "src" / "protocol.ts"


def test_types_of_the_page_are_those_of_the_server():
    assert PAGE_TYPES.read_text(encoding="utf-8") == typescript(), (
        "run: python -m voxsoft.studio.typescript > studio/src/protocol.ts"
    )


def test_a_command_is_read_with_its_defaults():
    assert decode('{"t":"grab","seq":1,"id":0,"vertex":5,"target":[0,0.1,0]}') == commands.Grab(
        seq=1, id=0, vertex=5, target=(0.0, 0.1, 0.0)
    )


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "{",
        '{"t":"nothing","seq":1}',
        '{"t":"play"}',
        '{"t":"step","seq":1,"n":0}',
        '{"t":"grab","seq":1,"id":0,"vertex":-1,"target":[0,0,0]}',
        '{"t":"grab","seq":1,"id":0,"vertex":1,"target":[0,0]}',
        '{"t":"load","seq":1,"index":0,"value":NaN}',
        '{"t":"job_start","seq":1,"spec":{"kind":"dance"}}',
        "[" * 100_000,
    ],
)
def test_invalid_commands_are_refused_in_words(text):
    with pytest.raises(ProtocolError, match="message: "):
        decode(text)


@given(st.one_of(st.binary(max_size=200), st.text(max_size=200)))
def test_random_text_is_refused_or_a_command(text):
    with suppress(ProtocolError):
        assert isinstance(decode(text), commands.Command)


@given(st.from_type(commands.Step) | st.from_type(commands.View) | st.from_type(commands.Hello))
def test_commands_survive_the_way_through_json(command):
    text = msgspec.json.encode(command)
    try:
        assert decode(text) == command
    except ProtocolError:  # a number outside its range, which construction does not check
        with pytest.raises(msgspec.ValidationError):
            msgspec.convert(msgspec.to_builtins(command), type(command))


def test_numbers_that_are_not_finite_become_null():
    row = events.Plot(topology=1, names=["t"], units=["s"], rows=[[float("nan"), 1.0]])
    assert '"rows":[[null,1.0]]' in encode(row)


def test_the_page_gets_the_default_constants_of_a_calibration(tmp_path):
    ranges = hello(tmp_path).fit_ranges
    assert {one.name: (one.low, one.high) for one in ranges["lattice"]} == {
        "edge": (1e3, 1e6),
        "bulk": (2e3, 1e6),
    }
    assert [one.name for one in ranges["ogden"]] == ["young"]
    assert ranges["rigid"] == ranges["lattice-compliance"] == []
