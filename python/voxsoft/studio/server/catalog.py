"""Catalog for the page: templates, materials, samplers, fields, metrics."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path
from typing import Any, get_args

from voxsoft._core import __version__
from voxsoft.calibration import usual_ranges
from voxsoft.calibration.methods import METHODS
from voxsoft.design import Design, families
from voxsoft.materials import Material, card_names, load_card
from voxsoft.metrics import METRICS
from voxsoft.search.samplers import SAMPLERS, SINGLE_OBJECTIVE
from voxsoft.studio.bodies.fields import CONTACT_FIELDS, FIELDS
from voxsoft.studio.documents.materials import young_of
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.commands import RestMethod
from voxsoft.studio.protocol.wire import PROTOCOL
from voxsoft.units import UnitOf


def hello(runs_folder: Path) -> events.Hello:
    """List the abilities of this server."""
    return events.Hello(
        version=__version__,
        protocol=PROTOCOL,
        design_schema=_schema(),
        templates=list(_templates()),
        materials=list(_materials()),
        samplers=[
            events.Sampler(name=name, title=title, single_objective=name in SINGLE_OBJECTIVE)
            for name, title in SAMPLERS.items()
        ],
        calibration_methods=list(METHODS),
        fit_ranges=_fit_ranges(),
        methods=list(get_args(RestMethod)),
        metrics=[
            events.Metric(
                name=name,
                kind=metric.kind,
                needs_probe="probe" in metric.needs,
                needs_base="base" in metric.needs,
                needs_cavity="cavity" in metric.takes,
                takes_percentile="percentile" in metric.takes,
                needs_object="object" in metric.needs | metric.takes,
            )
            for name, metric in METRICS.items()
        ],
        fields=[*FIELDS, *CONTACT_FIELDS],
        runs_folder=str(runs_folder),
        cores=os.cpu_count() or 1,
    )


@cache
def _fit_ranges() -> dict[str, list[events.FitRange]]:
    modulus = UnitOf("modulus")
    return {
        model.model_fields["model"].default: [
            events.FitRange(
                name=name, kind="modulus", low=modulus.read(low), high=modulus.read(high)
            )
            for name, (low, high) in usual_ranges(model).items()
        ]
        for model in get_args(Material)
    }


@cache
def _schema() -> dict[str, Any]:
    return Design.json_schema()


@cache
def _templates() -> tuple[events.Template, ...]:
    return tuple(
        events.Template(name=name, title=_title(text), text=text)
        for name in families.FAMILIES
        for text in [families.family_text(name)]
    )


def _title(text: str) -> str:
    """The first sentence of a file's first comment."""
    comment = " ".join(
        line.lstrip("# ") for line in text.split("\n\n")[0].splitlines() if line.startswith("#")
    )
    return comment.partition(". ")[0].partition(": ")[0].rstrip(".")


@cache
def _materials() -> tuple[events.MaterialCard, ...]:
    found = []
    for name in card_names():
        card = load_card(name)
        found.append(
            events.MaterialCard(
                name=name,
                title=card.title,
                source=card.source,
                model=card.material.model,
                young=young_of(card.material),
            )
        )
    return tuple(found)
