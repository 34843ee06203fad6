"""Definition of a study as plain data, so that a folder is never resumed with another study."""

from __future__ import annotations

import functools
import hashlib
import inspect
import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from voxsoft._core import __version__
from voxsoft.design import Constraint, Design, Objective
from voxsoft.design.document.documents import with_paths_from
from voxsoft.errors import StudyError
from voxsoft.metrics import METRICS
from voxsoft.metrics.own import own_metrics
from voxsoft.study.space import Space

SCHEMA: Final = "voxsoft-study/1"


def definition(
    family: Design | Callable[..., Design],
    space: Space,
    objectives: Mapping[str, Objective],
    constraints: Mapping[str, Constraint],
    evaluate: Callable[..., object],
    seed: int,
    folder: Path,
) -> dict[str, Any]:
    """Write all data that decide the results of a study as plain data.

    A function, also that of a metric of the user's, is written as its name and a hash of its
    source text, where it has one. Files below `folder`, the folder of the study, get relative
    paths, so that it can be moved.
    """
    written = {
        "schema": SCHEMA,
        "voxsoft": __version__,
        "family": _without_own_targets(with_paths_from(family.document, folder))
        if isinstance(family, Design)
        else _function(family),
        "space": {name: domain.model_dump(mode="json") for name, domain in space.items()},
        "objectives": _dumped(objectives),
        "constraints": _dumped(constraints),
        "evaluate": _function(evaluate),
        "seed": seed,
    }
    own = own_metrics([*objectives.values(), *constraints.values()])
    if own:
        written["metrics"] = {each.name: _function(METRICS[each.name].value) for each in own}
    plain: dict[str, Any] = json.loads(json.dumps(written))
    return plain


def require_same(stored: Mapping[str, Any], now: Mapping[str, Any], where: str) -> None:
    """Refuse to resume a study with another definition.

    Raises
    ------
    StudyError
        Names the differences.

    Examples
    --------
    >>> require_same({"seed": 1}, {"seed": 2}, "runs/wall")
    Traceback (most recent call last):
    ...
    voxsoft.errors.StudyError: runs/wall: holds another study: seed was 1 and is now 2. Try: ...
    """
    found = [*_differences(stored, now, "")]
    if found:
        shown = "; ".join(found[:4]) + (f"; and {len(found) - 4} more" if len(found) > 4 else "")
        raise StudyError(
            where,
            f"holds another study: {shown}",
            "use another folder or name, or go back to the definition that is stored there",
        )


def _dumped(targets: Mapping[str, Objective] | Mapping[str, Constraint]) -> dict[str, Any]:
    return {
        name: target.model_dump(mode="json", exclude_none=True) for name, target in targets.items()
    }


def _without_own_targets(document: Mapping[str, Any]) -> dict[str, Any]:
    """Drop the targets, which the study states itself."""
    return {k: v for k, v in document.items() if k not in ("objectives", "constraints")}


def _function(function: Callable[..., object]) -> dict[str, Any]:
    if isinstance(function, functools.partial):
        return {**_function(function.func), "arguments": repr((function.args, function.keywords))}
    module = getattr(function, "__module__", "")
    name = getattr(function, "__qualname__", type(function).__qualname__)
    try:
        source = inspect.getsource(function)
    except (OSError, TypeError):
        return {"function": f"{module}.{name}"}
    digest = hashlib.sha256(inspect.cleandoc(source).encode()).hexdigest()
    return {"function": f"{module}.{name}", "source": digest}


def _differences(stored: object, now: object, where: str) -> Iterator[str]:
    if isinstance(stored, Mapping) and isinstance(now, Mapping):
        for key in [*stored, *(key for key in now if key not in stored)]:
            inner = f"{where}.{key}" if where else str(key)
            yield from _differences(stored.get(key), now.get(key), inner)
    elif stored != now:
        yield f"{where} was {_shown(stored)} and is now {_shown(now)}"


def _shown(value: object) -> str:
    if value is None:
        return "absent"
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 60 else f"{text[:57]}..."
