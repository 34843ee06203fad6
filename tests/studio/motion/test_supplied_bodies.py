"""Supplies in the studio: time does not run, Solve finds the motion, and the text takes them."""

from pathlib import Path

import numpy as np
import pytest

from voxsoft.errors import SimulationError
from voxsoft.files.designs import load
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.motion.playback import Playback
from voxsoft.studio.motion.rest import RestSearch
from voxsoft.studio.protocol import commands, events

FINGER = Path(__file__).parents[3] / "examples" / "pulsed_finger.toml"


class Listener:
    """Keeps the results of a search."""

    result = sentence = None

    def found(self, search, result):
        self.result = result

    def not_found(self, search, sentence):
        self.sentence = sentence

    def searching(self, search, sentence, progress):
        pass


@pytest.fixture(scope="module")
def finger():
    """A short one, for a moment."""
    short = load(FINGER).with_parameters(length="30 mm")
    return short.with_values("solver.end_time=40 ms", "solver.method=auto")


def test_time_does_not_run_and_says_so(finger):
    playback = Playback()
    playback.begin(StudioBody.of(finger, 1, 1))
    assert "supplies" in playback.body.event().not_live
    with pytest.raises(SimulationError, match="press Solve"):
        playback.do(commands.Play(seq=1))


def test_solve_shows_the_motion_as_a_film(finger):
    playback, listener = Playback(), Listener()
    playback.begin(StudioBody.of(finger, 1, 1))
    search = RestSearch(playback.body, [], "auto", listener)
    search.run()
    assert listener.sentence is None
    result = listener.result
    assert result.status == "ok"
    left = result.recording.chambers["left"]
    assert len(left.pressure) == len(result.recording.frames) > 2
    assert (np.diff(left.pressure) > 0.0).all()
    reported = playback.go_to_rest(result)
    (curves,) = [event for event in reported if isinstance(event, events.Chambers)]
    assert curves.times == result.recording.times.tolist()
    named = {each.name: each for each in curves.chambers}
    assert named["left"].pressure == left.pressure.tolist()
    (emptied,) = [event for event in playback.reset() if isinstance(event, events.Chambers)]
    assert emptied.chambers == []
    playback.go_to_rest(result)
    assert playback.stat().time == pytest.approx(0.04)
    assert result.metrics["chamber_pressure"] == pytest.approx(left.pressure[-1])


def test_forms_begin_with_an_example_of_each_kind(finger):
    schema = type(finger).json_schema()
    definitions = schema["$defs"]
    for name in ("PressureSupply", "VolumeSupply", "MassSupply", "FlowSupply", "Connection"):
        assert definitions[name]["examples"]
