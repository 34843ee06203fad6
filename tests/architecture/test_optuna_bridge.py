"""Trials are stored with Optuna in one file, through public names only."""

import ast
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "python" / "voxsoft"
BRIDGE = PACKAGE / "search" / "optuna_bridge.py"
FILES = sorted(PACKAGE.rglob("*.py"))
#: Modules that others may import: samplers and distributions, which store nothing.
OPEN = ("optuna.distributions", "optuna.samplers")
#: Files that also use the module itself, for its samplers and their warnings, or in types alone.
SAMPLERS = {"search/samplers.py", "search/genetic_sampler.py", "search/gradient_sampler.py"}
#: Private names of Optuna's studies and trials, and of the pools of processes.
PRIVATE = {
    "_cached_frozen_trial",
    "_executor_manager_thread",
    "_processes",
    "_study_id",
    "_suggest",
    "_tell",
    "_trial_id",
}


def modules(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module is not None:
            yield node.module


def foreign_privates(tree: ast.AST) -> Iterator[str]:
    """Private attributes that are not those of the object whose method it is."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and node.attr.startswith("_"):
            own = isinstance(node.value, ast.Name) and node.value.id in ("self", "cls")
            if not own and (node.attr in PRIVATE or node.attr == "_storage"):
                yield f"line {node.lineno}: .{node.attr}"


def test_no_file_uses_private_names_of_optuna_or_of_pools():
    found = {
        str(file): places
        for file in FILES
        if (places := [*foreign_privates(ast.parse(file.read_text("utf-8")))])
    }
    assert found == {}


def test_only_the_bridge_stores_trials():
    found = {}
    for file in FILES:
        name = file.relative_to(PACKAGE).as_posix()
        used = {m for m in modules(ast.parse(file.read_text("utf-8"))) if m.startswith("optuna")}
        used -= {*OPEN, "optuna"} if name in SAMPLERS else {*OPEN}
        if used and file != BRIDGE:
            found[name] = used
    assert found == {}


def test_optuna_has_an_upper_bound():
    text = (PACKAGE.parents[1] / "pyproject.toml").read_text(encoding="utf-8")
    assert '"optuna>=4.1,<6"' in text
