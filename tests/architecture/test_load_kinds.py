"""Loads are told apart in one place, so that a new kind is one model and one entry there."""

import ast
from pathlib import Path
from typing import get_args

import pytest

from voxsoft.design import AnyLoad
from voxsoft.simulation import loads
from voxsoft.simulation.loads import KINDS, actions

PACKAGE = Path(loads.__file__).parents[2]
MODELS = set(get_args(get_args(AnyLoad)[0]))
KIND_WORDS = {model.model_fields["kind"].default for model in MODELS}
ACTIONS = {each.__name__ for each in actions.Action.__subclasses__()}
NAMES = {model.__name__ for model in MODELS} | ACTIONS
#: Sites that may ask, each with how often: pressure on an open surface has a volume to it.
ALLOWED = {"simulation/derivatives/loaded_state.py": 1}


def asks(node):
    """Check if an expression asks for the kind of a load, or of an action of one."""
    match node:
        case ast.Call(func=ast.Name(id="isinstance"), args=[_, kinds]):
            return bool(NAMES & {n.id for n in ast.walk(kinds) if isinstance(n, ast.Name)})
        case ast.MatchClass(cls=ast.Name(id=name)):
            return name in NAMES
        case ast.Compare(left=ast.Attribute(attr="kind"), comparators=[ast.Constant(value=word)]):
            return word in KIND_WORDS - {"pressure", "force"} or (
                word in KIND_WORDS and ast.unparse(node.left) in ("load.kind", "reading.kind")
            )
    return False


def sites(text):
    return sum(asks(node) for node in ast.walk(ast.parse(text)))


def test_loads_are_distinguished_in_one_place():
    found = {
        path.relative_to(PACKAGE).as_posix(): count
        for path in PACKAGE.rglob("*.py")
        if (count := sites(path.read_text(encoding="utf-8")))
        and not path.is_relative_to(Path(loads.__file__).parent)
    }
    assert found == ALLOWED


@pytest.mark.parametrize(
    "text",
    [
        "isinstance(load, Pressure)",
        "isinstance(load, (Gravity, Traction))",
        "isinstance(load, Force | Traction)",
        "match load:\n    case Gravity():\n        pass",
        "load.kind == 'pressure'",
        "each.kind == 'gravity'",
    ],
)
def test_a_site_is_seen(text):
    assert sites(text) == 1


def test_every_model_has_its_entry():
    assert set(KINDS) == MODELS
    assert {model.__module__ for model in MODELS} == {"voxsoft.design.load"}
