"""The reference pages written by hand name everything there is, and nothing else."""

import re
from pathlib import Path
from typing import get_args

import pytest
import typer

from voxsoft import Design, Solver
from voxsoft.cli.app import app
from voxsoft.materials import Material
from voxsoft.metrics.registry import BUILT_IN
from voxsoft.shapes import KINDS

REFERENCE = Path(__file__).parents[2] / "docs" / "reference"
# A function is Python code, which no file can hold.
KINDS_IN_FILES = set(KINDS) - {"function"}


def section(page, title):
    text = (REFERENCE / page).read_text(encoding="utf-8")
    found = re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    return found[1]


def cells(text, column):
    """Names in code in one column of the tables of a text, the first of each entry."""
    rows = re.findall(r"^\|(.*)\|$", text, re.MULTILINE)
    return {name for row in rows for name in re.findall(r"`([^`]+)`", row.split("|")[column])}


def commands():
    """Every verb with its command; those of a group are ``group verb``."""
    found = {}
    for name, command in typer.main.get_command(app).commands.items():
        inner = getattr(command, "commands", None)
        if inner is None:
            found[name] = command
        else:
            found |= {f"{name} {verb}": inner[verb] for verb in inner}
    return found


def test_every_key_of_the_solver_is_there():
    assert cells(section("design-file.md", "Solver"), 0) == set(Solver.model_fields)


def test_every_verb_is_there():
    text = (REFERENCE / "command-line.md").read_text(encoding="utf-8").split("## Options")[0]
    # The verb's words are lower case, its arguments are not.
    named = {" ".join(w for w in name.split() if w.islower()) for name in cells(text, 0)}
    assert named == set(commands())


def test_every_option_is_there_with_its_verbs():
    rows = re.findall(r"^\|(.*)\|$", section("command-line.md", "Options"), re.MULTILINE)[2:]
    documented = {}
    for row in rows:
        options, verbs, _ = row.split("|")[:3]
        named = set(re.findall(r"`([\w ]+)`", verbs))
        verbs = set(commands()) - named if "all but" in verbs else named
        for option in re.findall(r"`(--[\w-]+)", options):
            documented[option] = verbs
    real = {}
    for verb, command in commands().items():
        for parameter in command.params:
            for option in parameter.opts:
                if option.startswith("--") and option != "--help":
                    real.setdefault(option, set()).add(verb)
    assert documented == real


def test_every_kind_of_shape_is_there():
    assert cells(section("design-file.md", "Shapes"), 1) == KINDS_IN_FILES


def test_every_material_model_is_there_with_its_constants():
    text = section("design-file.md", "Materials")
    rows = [row.split("|") for row in re.findall(r"^\|(.*)\|$", text, re.MULTILINE)[2:]]
    documented = {row[0].strip(" `"): set(re.findall(r"`(\w+)`", row[1])) for row in rows}
    shared = {"model", "poisson", "density", "prony", "mullins", "tested_stretch"}
    real = {
        model.model_fields["model"].default: {
            field.alias or name for name, field in model.model_fields.items() if name not in shared
        }
        for model in get_args(Material)
    }
    assert documented == real


def test_every_metric_is_there():
    assert cells(section("design-file.md", "Metrics"), 0) == BUILT_IN


def test_every_key_of_a_design_is_there():
    text = (REFERENCE / "design-file.md").read_text(encoding="utf-8").split("## Numbers")[0]
    keys = {name.strip("[]") for name in cells(text, 0)}
    assert keys == {field.alias or name for name, field in Design.model_fields.items()}


@pytest.mark.parametrize("page", sorted(REFERENCE.glob("*.md")), ids=lambda page: page.name)
def test_names_of_the_reference_exist(page):
    for name in re.findall(r"^::: ([\w.]+)$", page.read_text(encoding="utf-8"), re.MULTILINE):
        module, _, last = name.rpartition(".")
        try:
            __import__(name)
        except ImportError:
            assert hasattr(__import__(module, fromlist=[last]), last), name
