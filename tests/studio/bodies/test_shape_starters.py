"""The page's first text of a new shape is a design, and can be seen."""

import json
import re
import tomllib
from pathlib import Path

import pytest

import voxsoft as vs
from voxsoft.studio.bodies.ghosts import ghost_of

ROOT = Path(__file__).parents[3]
STARTERS = json.loads((ROOT / "studio/src/panes/design/shapes/shapeStarters.json").read_text())
SIDE = 20.0
PLACES = {"middle": [0, 0, 0], "foot": [0, 0, -SIDE / 2]}
PLACES |= {"left": [-SIDE / 2, 0, 0], "right": [SIDE / 2, 0, 0]}
MADE_OF = {"one": "body", "two": ["body", "ball"]}
MADE_OF["lattice"] = {"kind": "gyroid", "period": "10 mm", "thickness": "2 mm"}

BODY = """
schema = "voxsoft/1"
name = "body"
voxel_size = "5 mm"

[shapes]
body = { kind = "box", size = ["40 mm", "40 mm", "40 mm"] }
ball = { kind = "sphere", radius = "30 mm" }

[[parts]]
shape = "body"
material = "ecoflex-00-30"
"""


def filled(value):
    """A starter as the page writes it, with its lengths in mm."""
    if isinstance(value, list):
        return [filled(each) for each in value]
    if not isinstance(value, str):
        return value
    if value in PLACES:
        return [f"{each} mm" for each in PLACES[value]]
    if value in MADE_OF:
        return MADE_OF[value]
    number = re.fullmatch(r"(-?[\d.]+) side", value)
    return f"{float(number[1]) * SIDE} mm" if number else value


@pytest.mark.long
@pytest.mark.parametrize("kind", sorted(set(STARTERS) - {"mesh"}))
def test_a_new_shape_is_good_and_can_be_seen(kind):
    document = tomllib.loads(BODY)
    document["shapes"]["new"] = {"kind": kind} | {
        key: filled(value) for key, value in STARTERS[kind].items()
    }
    ghost = ghost_of(vs.Design.from_document(document), "new")
    assert ghost.trouble == ""
    assert ghost.triangles
