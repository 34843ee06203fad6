"""The scoreboard of measured robots: intervals, coverage, files and the command."""

import json
import math

import pytest
from typer.testing import CliRunner

from voxsoft.cli.app import app
from voxsoft.errors import FileError
from voxsoft.plot import plot_scoreboard
from voxsoft.scoreboard import Prediction, predictions_in, read_scores, score

NEAR = Prediction("beam", "sag", "length", 0.010, 0.0104, material=3e-4, numerics=4e-4)
FAR = Prediction("beam", "pull", "force", 2.0, 1.0, geometry=0.1, repeatability=0.1, scale=4.0)

CASE = """
from voxsoft.scoreboard import Prediction

def predictions():
    yield Prediction("beam", "sag", "length", 0.010, 0.0104, material=3e-4, numerics=4e-4)
"""
LOST = """
from voxsoft.errors import SimulationError

def predictions():
    raise SimulationError("load", "was too much", "take less")
"""


def test_parts_of_an_interval_add_up_in_squares():
    assert NEAR.half_width == pytest.approx(5e-4)
    assert (NEAR.low, NEAR.high) == pytest.approx((0.0099, 0.0109))
    assert NEAR.inside
    assert not FAR.inside
    assert NEAR.width == pytest.approx(0.1)
    assert FAR.width == pytest.approx(2 * math.hypot(0.1, 0.1) / 4.0)


def test_a_kind_that_is_none_is_refused():
    with pytest.raises(ValueError, match="not a kind"):
        Prediction("beam", "sag", "longness", 1.0, 1.0)


def test_coverage_and_width_are_means():
    board = score([NEAR, FAR])
    assert board.coverage == 0.5
    assert board.width == pytest.approx((NEAR.width + FAR.width) / 2)
    assert board.cases == ["beam"]
    assert math.isnan(score([]).coverage)
    figure = plot_scoreboard(board)
    assert "50 % inside" in figure.axes[0].get_title(loc="left")


def test_scores_are_read_as_they_are_written(tmp_path):
    board = score([NEAR, FAR])
    file = tmp_path / "scores.csv"
    file.write_text(board.csv())
    again = read_scores(file)
    for mine, theirs in zip(board.predictions, again.predictions, strict=True):
        assert (theirs.case, theirs.name, theirs.kind) == (mine.case, mine.name, mine.kind)
        assert (theirs.low, theirs.high) == pytest.approx((mine.low, mine.high))
        assert theirs.inside is mine.inside
        assert theirs.width == pytest.approx(mine.width)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("case,name\na,b\n", "no column kind"),
        ("case,name,kind,measured,predicted,low,high\na,b,length,1,x,0,2\n", "line 2"),
        ("case,name,kind,measured,predicted,low,high\na,b,length,1,3,0,2\n", "not between"),
        ("case,name,kind,measured,predicted,low,high\na,b,long,1,1,0,2\n", "line 2.*kind"),
    ],
)
def test_bad_scores_are_refused(tmp_path, text, words):
    file = tmp_path / "scores.csv"
    file.write_text(text)
    with pytest.raises(FileError, match=words):
        read_scores(file)


def test_cases_of_a_folder_are_run_and_one_that_fails_leaves_the_others(tmp_path):
    (tmp_path / "beam.py").write_text(CASE)
    (tmp_path / "lost.py").write_text(LOST)
    (tmp_path / "other.py").write_text("x = 1\n")
    heard = []
    board = predictions_in(tmp_path, announce=lambda *each: heard.append(each))
    assert board.predictions == (NEAR,)
    assert "was too much" in board.failed["lost"]
    assert heard == [("beam", 0, 2), ("lost", 1, 2)]
    with pytest.raises(FileError, match='did you mean "beam"'):
        predictions_in(tmp_path, ["beem"])
    with pytest.raises(FileError, match="is not a folder"):
        predictions_in(tmp_path / "none")


def test_the_command(tmp_path):
    (tmp_path / "beam.py").write_text(CASE)
    out = tmp_path / "scores"
    call = ["verify", "--folder", str(tmp_path), "--out", str(out)]
    answer = CliRunner().invoke(app, [*call, "--json"])
    assert answer.exit_code == 0, answer.stderr
    found = json.loads(answer.stdout)
    assert found["coverage"] == 1.0
    (case,) = found["cases"]
    assert case["name"] == "beam: sag"
    assert case["low"] < case["measured"] < case["predicted"] < case["high"]
    assert (out / "scores.png").stat().st_size > 1000
    shown = CliRunner().invoke(app, ["verify", "--scores", str(out / "scores.csv")])
    assert "100 % of 1 inside" in shown.output
    (tmp_path / "lost.py").write_text(LOST)
    assert CliRunner().invoke(app, call).exit_code == 4
