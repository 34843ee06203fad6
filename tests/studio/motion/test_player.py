"""The core's player speaks the protocol: the same names and nothing besides, in both directions."""

import json

import lattice_families as families
import msgspec
import numpy as np
import pytest

from voxsoft.errors import SimulationError
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.scene import scene_of
from voxsoft.studio.motion.playback import Playback
from voxsoft.studio.motion.player import Command, Player, Shown
from voxsoft.studio.protocol import commands, events


@pytest.fixture(scope="module")
def body():
    return StudioBody.of(families.cylinder(), 1, 1)


def names(struct):
    """The names of a struct as they are sent, with those of the structs in its lists."""
    inner = {
        field.encode_name: names(field.type.item_type.cls)
        for field in msgspec.inspect.type_info(struct).fields
        if isinstance(field.type, msgspec.inspect.ListType)
        and isinstance(field.type.item_type, msgspec.inspect.StructType)
    }
    return {field.encode_name for field in msgspec.inspect.type_info(struct).fields}, inner


def sent(value):
    """Event of the core in the form of the player."""
    inner = {
        name: sent(entry[0])
        for name, entry in value.items()
        if isinstance(entry, list) and entry and isinstance(entry[0], dict)
    }
    return set(value) - {"t"}, inner


def test_events_have_the_names_of_the_protocol(body):
    player = scene_of(body).play()
    grab = commands.Grab(seq=1, id=2, vertex=3, target=(0.0, 0.0, 0.1))
    [stat] = json.loads(player.command(msgspec.json.encode(grab)))
    # The player does not know the solver, its progress, and the states without time.
    found, inner = sent(stat)
    assert (found | {"solver", "progress", "untimed"}, inner) == names(events.Stat)
    assert sent(json.loads(player.plot())) == names(events.Plot)
    [picked] = json.loads(player.command(msgspec.json.encode(commands.Pick(seq=1, vertex=3))))
    assert sent(picked) == names(events.Picked)
    assert sent(json.loads(player.shown())) == names(Shown)


@pytest.mark.parametrize("command", Command.__args__, ids=lambda command: command.__name__)
def test_every_command_is_understood_with_all_it_may_say(body, command):
    """A field that the core did not know would go unheard: it must make a difference there."""
    reported = {
        commands.Step: {"n": 3},
        commands.Pace: {"factor": 0.1},
        commands.Load: {"index": 0, "value": 5e3},
        commands.Grab: {"id": 4, "vertex": 3, "target": (0.0, 0.0, 0.1), "stiffness": 20.0},
        commands.Release: {"id": 4},
        commands.Seek: {"frame": 1},
        commands.Pick: {"vertex": 5},
        commands.Probe: {"vertex": 5},
    }.get(command, {})
    player = Player(body)
    player.do(commands.Step(seq=1, n=2))
    for _ in range(2):
        player.advance(1 / 60, 1.0)
    player.do(command(seq=2, **reported))
    stat = player.stat()
    if command is commands.Pace:
        assert stat.pace_chosen == 0.1
    if command is commands.Load:
        assert stat.loads[0] == pytest.approx(5e3)
    if command is commands.Grab:
        [pull] = stat.grabs
        assert (pull.id, pull.vertex, pull.stiffness) == (4, 3, 20.0)
        assert pull.target == (0.0, 0.0, 0.1)
    if command is commands.Seek:
        assert (stat.state, stat.frame) == ("past", 1)
    if command is commands.Probe:
        assert player.plot().names[-1] == "vertex 5"


def test_impossible_requests_name_place_and_reason(body):
    player = Player(body)
    with pytest.raises(SimulationError, match="there are 1 loads") as refused:
        player.do(commands.Load(seq=1, index=7, factor=1.0))
    assert refused.value.where == "load"
    with pytest.raises(SimulationError, match="press play first"):
        player.do(commands.Seek(seq=1, frame=3))


def test_before_there_is_a_player_the_same_is_reported(body):
    playback = Playback()
    playback.begin(body)
    without = (playback.stat(), playback.plot(), playback.frame, playback.state)
    playback.require_player()
    assert without == (playback.stat(), playback.plot(), playback.frame, playback.state)


def test_a_page_shows_the_given_state_first(body):
    """Positions beside the unloaded ones are packed; of another body they are refused."""
    rest = body.mesh.vertices
    scene = scene_of(body)
    moved = scene.pack("", rest + 0.001)
    assert len(moved) > len(scene.pack("")) + rest.nbytes - 1
    with pytest.raises(ValueError, match="positions"):
        scene.pack("", np.zeros((3, 3)))
