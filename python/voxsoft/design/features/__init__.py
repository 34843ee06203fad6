"""Ready features: a bellows, a fold, a finger, a row of chambers, to add to any design.

Each is a TOML file beside this module with its parameters and shapes, of which ``body`` is the
whole. Added to a design, its shapes get the name of the feature in front, and its parameters where
one of their names is taken, so that several of a kind stand beside each other. A first feature
comes with a part, a clamp and a load.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any, Final

from voxsoft.errors import DesignError
from voxsoft.records import closest
from voxsoft.units import format_quantity

#: A change of a design file: path and value.
Change = tuple[list[str | int], Any]


@dataclass(frozen=True)
class Feature:
    """A ready feature.

    Attributes
    ----------
    name
        Name of its file, and of its first copy in a design.
    sentence
        Its build.
    """

    name: str
    sentence: str


#: In the order in which they are shown.
FEATURES: Final = (
    Feature("bellows", "Folds between two lids, which air unfolds."),
    Feature("fold", "A sleeve with one fold, open at both ends."),
    Feature("finger", "A bar with a round tip and a room above its thick foot: it bends."),
    Feature("chamber-row", "A row of chambers with a duct on a foot: it bends as they swell."),
)

_NAME: Final = re.compile(r"[A-Za-z_]\w*")
_WHOLE: Final = "body"


def feature_changes(
    source: Mapping[str, Any], name: str, at: tuple[float, float, float] | None = None
) -> tuple[str, list[Change]]:
    """Return the name of a new feature in a design, and the changes that add it.

    Parameters
    ----------
    source
        Design as the file has it, with units and formulas.
    name
        One of those of :data:`FEATURES`.
    at
        Place of its foot in m; default: as its file has it, at the origin.

    Returns
    -------
    name
        Name of its shape.
    changes
        Paths and values. A design without parts gets its part, clamp, load and probe as well.

    Raises
    ------
    DesignError
        There is no such feature.

    Examples
    --------
    >>> added, changes = feature_changes({"shapes": {"bellows": {"kind": "sphere"}}}, "bellows")
    >>> added, changes[0][0]
    ('bellows2', ['parameters', 'wall'])
    """
    if name not in {each.name for each in FEATURES}:
        known = tuple(each.name for each in FEATURES)
        raise DesignError("feature", f'there is no feature "{name}"', closest(name, known))
    given = _fragment(name)
    new = _free_name(name.replace("-", "_"), source)
    names = {each: f"{new}_{each}" for each in given["shapes"]}
    if any(each in source.get("parameters", {}) for each in given["parameters"]):
        names |= {each: f"{new}_{each}" for each in given["parameters"]}
    if at is None:
        names[_WHOLE] = new
    changes: list[Change] = [
        ([section, names.get(key, key)], _renamed(value, names))
        for section in ("parameters", "shapes")
        for key, value in given[section].items()
    ]
    if at is not None:
        by = [format_quantity(x, "length") for x in at]
        placed = {"kind": "translate", "of": names[_WHOLE], "by": by}
        changes.append((["shapes", new], placed))
        names[_WHOLE] = new
    if source.get("parts") or source.get("bodies"):
        return new, changes
    for section, value in given["first"].items():
        changes += _first(section, _renamed(value, names), source)
    return new, changes


def _first(section: str, value: Any, source: Mapping[str, Any]) -> list[Change]:  # noqa: ANN401
    """Changes by what a first feature brings with it; entries that a design has already stay."""
    if isinstance(value, list):
        begun = len(source.get(section, ()))
        return [([section, begun + i], each) for i, each in enumerate(value)]
    if isinstance(value, Mapping):
        known = source.get(section, {})
        return [([section, key], each) for key, each in value.items() if key not in known]
    return [([section], value)]


@cache
def _fragment(name: str) -> dict[str, Any]:
    text = resources.files(__name__).joinpath(f"{name}.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def _free_name(name: str, source: Mapping[str, Any]) -> str:
    """Return the name, or one with a number, that begins no name of the design."""
    taken = [*source.get("shapes", {}), *source.get("parameters", {})]
    number, free = 1, name
    while any(each == free or each.startswith(f"{free}_") for each in taken):
        number += 1
        free = f"{name}{number}"
    return free


def _renamed(value: Any, names: Mapping[str, str]) -> Any:  # noqa: ANN401
    """Give names in formulas, and names of shapes, their new form, at any depth."""
    if isinstance(value, Mapping):
        return {
            key: each if key == "kind" else _renamed(each, names) for key, each in value.items()
        }
    if isinstance(value, list):
        return [_renamed(each, names) for each in value]
    if not isinstance(value, str):
        return value
    if value.startswith("="):
        return _NAME.sub(lambda found: names.get(found[0], found[0]), value)
    return names.get(value, value)
