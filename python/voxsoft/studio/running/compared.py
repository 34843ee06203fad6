"""Two runs or trials side by side."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

from voxsoft.design import Design
from voxsoft.design.document.documents import with_absolute_paths
from voxsoft.errors import VoxSoftError
from voxsoft.files.designs import read_document, read_text
from voxsoft.records import place
from voxsoft.studio.protocol import events
from voxsoft.studio.running.runs import RunList, kind_of, read_summary
from voxsoft.studio.running.studying import design_text_of, stored_trial


def compared(runs: RunList, a: str, b: str) -> events.Compared:
    """Set two runs, or trials written "RUN/NUMBER", side by side.

    Raises
    ------
    VoxSoftError
        One of them cannot be read.
    """
    first, first_document = _side(runs, a)
    second, second_document = _side(runs, b)
    return events.Compared(
        a=first, b=second, differences=list(_differences(first_document, second_document, []))
    )


def _side(runs: RunList, name: str) -> tuple[events.Side, dict[str, Any]]:
    run, _, number = name.rpartition("/")
    folder = runs.folder_of(run or name)
    file = folder / "design.toml"
    text = read_text(file) if file.is_file() else design_text_of(folder)
    document = read_document(text, name)
    parameters: dict[str, Any] = {}
    metrics: dict[str, float | None] = {}
    status = ""
    if run:
        trial = stored_trial(folder, number)
        parameters, status = dict(trial.parameters), trial.status
        metrics = {**trial.objectives, **trial.metrics}
        design = Design.from_document(with_absolute_paths(document, folder))
        text = design.with_parameters(**parameters).to_toml()
        document = tomllib.loads(text)
    else:
        with suppress(VoxSoftError):
            design = Design.from_document(with_absolute_paths(document, folder))
            parameters = {key: each.value for key, each in design.parameters.items()}
        with suppress(OSError, VoxSoftError):
            content = read_summary(folder)
            status = str(content.get("status", "ok"))
            if kind_of(folder) == "run":
                metrics = dict(content.get("metrics", {}))
    side = events.Side(
        id=name,
        name=name,
        status=status,
        parameters=parameters,
        metrics=metrics,
        text=text,
    )
    return side, document


def _differences(a: object, b: object, path: list[str | int]) -> Iterator[events.Difference]:
    if isinstance(a, dict) and isinstance(b, dict):
        for key in [*a, *(key for key in b if key not in a)]:
            yield from _differences(a.get(key), b.get(key), [*path, key])
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        for index, pair in enumerate(zip(a, b, strict=True)):
            yield from _differences(*pair, [*path, index])
    elif a != b:
        yield events.Difference(where=place(path), a=a, b=b)
