"""Finished robots: each is an example, opens without a warning, and can be solved."""

import tomllib
from io import BytesIO
from pathlib import Path

import pytest
from PIL import Image

from voxsoft.design import Design, robots
from voxsoft.errors import DesignError
from voxsoft.simulation import check, simulate

EXAMPLES = Path(__file__).parents[3] / "examples"
NAMES = [robot.name for robot in robots.ROBOTS]
#: Those whose many voxels take seconds to look at alone.
LARGE = {"bellows", "starfish", "wound_bender"}
#: Those that take more than some seconds; tests/integration drives the crawler and the gripper too.
LONG = LARGE | {"pumped_gripper", "crawler", "tendon_finger", "wound_tube"}
#: Starts whose robot another start opens too, wound at another angle.
ALIKE = {"pressure-cylinder-extend"}


def started(start):
    return Design.from_document(tomllib.loads(robots.robot_text(start.robot)), start.parameters)


@pytest.mark.parametrize("name", NAMES)
def test_a_robot_is_the_example_of_its_name(name):
    assert robots.robot_text(name) == (EXAMPLES / f"{name}.toml").read_text(encoding="utf-8")


@pytest.mark.long
@pytest.mark.parametrize(
    "name", [pytest.param(each, marks=pytest.mark.slow if each in LARGE else ()) for each in NAMES]
)
def test_a_robot_opens_without_a_warning(name):
    report = check(Design.from_document(tomllib.loads(robots.robot_text(name))))
    assert report.findings == ()


@pytest.mark.long
@pytest.mark.parametrize(
    "name", [pytest.param(each, marks=pytest.mark.slow if each in LONG else ()) for each in NAMES]
)
def test_a_robot_comes_to_rest_without_a_warning(name):
    result = simulate(Design.from_document(tomllib.loads(robots.robot_text(name))))
    assert result.status == "ok"
    assert result.warnings == ()


@pytest.mark.parametrize("name", NAMES)
def test_a_robot_has_a_picture_without_background(name):
    with Image.open(BytesIO(robots.robot_picture(name))) as picture:
        assert picture.format == "WEBP"
        assert picture.size == (480, 320)
        alpha = picture.convert("RGBA").getchannel("A")
    assert alpha.getextrema() == (0, 255)
    # The robot is in the middle, and nothing of it is cut off.
    left, top, right, bottom = alpha.point(lambda a: 255 * (a > 128)).getbbox()
    assert abs(left - (480 - right)) < 4
    assert abs(top - (320 - bottom)) < 4
    assert min(left, top) > 0


def test_the_first_robot_moves_in_its_picture():
    with Image.open(BytesIO(robots.robot_picture(NAMES[0], moving=True))) as picture:
        assert picture.n_frames >= 10
    with pytest.raises(DesignError, match="no moving picture"):
        robots.robot_picture("bellows", moving=True)


def test_each_combination_of_answers_leads_to_one_robot():
    names = [start.name for start in robots.STARTS]
    assert len(set(names)) == len(names)
    assert {start.robot for start in robots.STARTS} <= set(NAMES)


@pytest.mark.long
@pytest.mark.parametrize(
    "start",
    [
        pytest.param(
            each,
            marks=pytest.mark.slow if each.robot in LARGE or each.name in ALIKE else (),
            id=each.name,
        )
        for each in robots.STARTS
    ],
)
def test_answers_lead_to_a_design_without_a_warning(start):
    assert check(started(start)).findings == ()


@pytest.mark.parametrize(
    "start",
    [
        pytest.param(start, id=start.name, marks=pytest.mark.slow if start.robot in LONG else ())
        for start in robots.STARTS
        if start.parameters  # those without are robots as they are
    ],
)
def test_answers_lead_to_a_design_that_comes_to_rest_without_a_warning(start):
    result = simulate(started(start))
    assert result.status == "ok"
    assert result.warnings == ()


def test_a_missing_name_is_reported_with_known_ones():
    with pytest.raises(DesignError, match="bellows"):
        robots.robot("bellow")
    with pytest.raises(DesignError, match="tendon-trunk-bend"):
        robots.start("tendon-trunk-bent")
