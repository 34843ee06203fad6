"""States found without time have none, also after time has run."""

import pytest

from voxsoft.design import families
from voxsoft.simulation import simulate
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.motion.playback import Playback
from voxsoft.studio.protocol import commands


@pytest.fixture
def played():
    """A beam of which a tenth of a second was played."""
    playback = Playback()
    playback.begin(StudioBody.of(families.beam(), 1, 1))
    playback.do(commands.Play(seq=0))
    for _ in range(6):
        playback.advance(1 / 60, 10.0)
    playback.do(commands.Pause(seq=0))
    return playback


def stat(playback):
    return playback.complete(playback.stat())


def test_motion_has_its_time_and_the_equilibrium_after_it_has_none(played):
    assert stat(played).time > 0.0
    assert not stat(played).untimed
    played.go_to_rest(simulate(played.body.setup))
    assert stat(played).state == "at-rest"
    assert stat(played).untimed
    shown = played.shown_as("beam", "")
    assert (shown.sentence, shown.time) == ("at rest", 0.0)


def test_an_earlier_frame_and_the_motion_after_it_have_their_time(played):
    played.go_to_rest(simulate(played.body.setup))
    played.do(commands.Seek(seq=0, frame=2))
    assert stat(played).state == "past"
    assert not stat(played).untimed
    assert "s, not at rest" in played.shown_as("beam", "").sentence
