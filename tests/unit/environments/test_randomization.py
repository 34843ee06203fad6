"""Draws of materials and parameters for each episode."""

import numpy as np
import pytest

from voxsoft.design import families
from voxsoft.environments import Randomization, SoftRobotEnv, Task
from voxsoft.environments.robots import robot
from voxsoft.errors import DesignError

BEAM = families.beam()
BEAM = BEAM.replace(parts=[BEAM.parts[0].replace(material="ecoflex-00-50-lattice")])
NAME = "ecoflex-00-50-lattice.edge"


class Still(Task):
    def reward(self, before, after):
        return 0.0


def draw(design, seed=0, **options):
    return Randomization(**options).draw(design, np.random.default_rng(seed))


def test_the_material_of_a_card_is_drawn_from_its_posterior():
    design, drawn = draw(BEAM)
    assert list(drawn) == [NAME]
    [part] = design.parts
    assert part.material.edge == drawn[NAME] != BEAM.material_of(BEAM.parts[0]).edge
    values = [draw(BEAM, seed)[1][NAME] for seed in range(200)]
    inside = np.mean([39.1e3 < value < 47.2e3 for value in values])
    # Four standard deviations of a binomial of 200.
    assert inside == pytest.approx(0.95, abs=4 * np.sqrt(0.95 * 0.05 / 200))


def test_parts_of_one_material_have_one_draw():
    design, drawn = draw(robot("crawl"), spread=0.3)
    assert list(drawn) == ["rubber.young"]
    assert len({part.material.young() for part in design.parts}) == 1


def test_parts_that_are_named_are_drawn_alone():
    design, _ = draw(robot("crawl"), spread=0.3, parts=["rear"])
    rear, front, passive = (design.material_of(part).young() for part in design.parts)
    assert rear != front == passive


def test_parameters_are_drawn_evenly_from_a_range_or_that_of_the_design():
    crawl = robot("crawl")
    own = [draw(crawl, seed, parameters={"friction": None}) for seed in range(50)]
    assert all(0.2 <= drawn["friction"] <= 1.0 for _, drawn in own)
    assert own[0][0].contact.friction == own[0][1]["friction"]
    given = [draw(crawl, seed, parameters={"friction": (0.5, 0.6)})[1] for seed in range(50)]
    assert all(0.5 <= drawn["friction"] <= 0.6 for drawn in given)
    assert len({drawn["friction"] for drawn in given}) == 50


def test_each_episode_has_a_draw_that_the_seed_repeats():
    env = SoftRobotEnv(BEAM, Still(), drives={"gravity": (0, 9.81)}, randomize=Randomization())
    values = [env.reset(seed=seed)[1][NAME] for seed in (1, 2, 1)]
    assert values[0] == values[2] != values[1]
    # Without a seed the draws go on.
    assert env.reset()[1][NAME] not in values
    softer = env.simulator.design.parts[0].material.edge
    assert softer == env.step(np.array([0.0], np.float32))[4][NAME]


@pytest.mark.parametrize(
    ("options", "what"),
    [
        ({"parts": ["tail"]}, '"tail" is no part'),
        ({"parameters": {"grip": None}}, '"grip" is no parameter'),
        ({"parameters": {"friction": (0.6, 0.5)}}, "goes from 0.6 to 0.5"),
        ({}, "finds no card with a posterior"),
    ],
)
def test_a_draw_of_nothing_is_an_error_of_the_design(options, what):
    with pytest.raises(DesignError, match=what):
        draw(robot("crawl"), **options)
