"""Event of an equilibrium for the page: its numbers, and its doubtful points."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Literal

import numpy as np

from voxsoft._shown import rounded
from voxsoft.comparison.bars import error_bars
from voxsoft.comparison.error_bar import ErrorBars, share_of, tendon_in_words, vector_in_words
from voxsoft.errors import VoxSoftError
from voxsoft.metrics import METRICS, Target
from voxsoft.simulation import Diagnostic, Result
from voxsoft.simulation.setup.supports import Force
from voxsoft.studio.bodies.grips import grips_of
from voxsoft.studio.bodies.objects import is_filmed
from voxsoft.studio.protocol import events
from voxsoft.units import format_percent, format_quantity


class Measurement(threading.Thread):
    """Measures an equilibrium on a thread of its own: warnings of large bodies take a while.

    Parameters
    ----------
    result
        Gives the result.
    report
        Called with the event for the page; not at all where the state cannot be measured.
    topology, frame
        Number of its body, and the frame that shows it.
    is_shown
        Returns True while that frame is shown: error bars are not looked for afterwards.
    finer
        True to look for error bars on voxels half as large, whatever the design asks for.
    """

    def __init__(
        self,
        result: Callable[[], Result],
        report: Callable[[events.Equilibrium], None],
        topology: int,
        frame: int,
        is_shown: Callable[[], bool],
        *,
        finer: bool = False,
    ) -> None:
        super().__init__(name="studio-equilibrium", daemon=True)
        self._result, self._report = result, report
        self._topology, self._frame = topology, frame
        self._is_shown = is_shown
        self._finer = finer

    def run(self) -> None:
        """Measure, and then look for the error bars."""
        try:
            result = self._result()
            if self._finer:
                result = with_error(result, "finer")
            found = equilibrium_of(result, self._topology, self._frame)
            self._report(found)
            if result.design.solver.error != "off":
                bars = error_bars(result, progress=self._go_on)
                self._report(equilibrium_of(result, self._topology, self._frame, bars))
        except (VoxSoftError, _Gone):
            return

    def _go_on(self, _: int, __: float, ___: float) -> None:
        if not self._is_shown():
            raise _Gone


def with_error(result: Result, error: Literal["finer"]) -> Result:
    """Copy a result with a design that asks for its error on such voxels."""
    solver = result.design.solver.replace(error=error)
    return replace(result, design=result.design.replace(solver=solver))


class _Gone(Exception):
    """The state that was measured is not shown any more."""


def equilibrium_of(
    result: Result, topology: int, frame: int, bars: ErrorBars | None = None
) -> events.Equilibrium:
    """Say all numbers of a result, with their error bars once they are known."""
    off = result.design.solver.error == "off"
    looking = bars is None and not off
    if bars is not None:
        source = f"{bars.sentence[:1].upper()}{bars.sentence[1:]}."
    else:
        source = "" if off else "Error bars are computed on other voxels."
    # Error bars of the design's own kind would only be looked for again.
    tried = result.design.solver.error == "finer"
    can_solve = result.status == "ok" and result.mesh.voxel_size is not None
    bars = bars or ErrorBars.none("", "")
    summary = result.summary()
    cavities = zip(summary["cavities"], range(len(summary["cavities"])), strict=True)
    return events.Equilibrium(
        topology=topology,
        frame=frame,
        status=result.status,
        sentence=f"{result.message[:1].upper()}{result.message[1:]}.",
        residual=format_percent(result.residual),
        seconds=result.seconds,
        probes=[
            events.MovedProbe(
                name=name,
                displacement=(float(x), float(y), float(z)),
                estimate=vector_in_words(bars.probes[name]) if name in bars.probes else "",
                share=share_of(bars.probes[name]) if name in bars.probes else None,
            )
            for name, (x, y, z) in result.probes.items()
        ],
        metrics=_metrics(result, bars),
        chambers=[
            events.Chamber(
                name=cavity.get("name") or f"cavity {index}",
                rest_volume=float(cavity["rest_volume"]),
                volume=float(cavity["volume"]),
                pressure=float(cavity["pressure"]),
                estimate=_chamber_in_words(bars, index) if bars.volumes else "",
                share=share_of([bars.volumes[index]], float(cavity["rest_volume"]))
                if bars.volumes
                else None,
            )
            for cavity, index in cavities
        ],
        largest_strain=result.metric("max_stretch") - 1.0,
        warnings=[finding_of(warning) for warning in result.warnings],
        error_bars=source,
        looking=looking,
        askable=not looking and not bars.voxel_sizes and not tried and can_solve,
        tendons=[
            events.Summarized(
                name=name,
                words=tendon.words,
                estimate=tendon_in_words(bars.tendons[name]) if name in bars.tendons else "",
            )
            for name, tendon in result.tendons.items()
        ],
        reactions=[
            events.Summarized(
                name=name,
                words=_force_in_words(force),
                estimate=vector_in_words(bars.reactions[name]) if name in bars.reactions else "",
            )
            for name, force in result.clamp_reactions.items()
        ],
        supplies=[
            events.Summarized(
                name=supply.name,
                words=supply.words,
                estimate=_supply_in_words(bars, supply.name),
            )
            for supply in result.supplies
        ],
        grips=grips_of(result),
        missing=_missing(result),
    )


def _chamber_in_words(bars: ErrorBars, index: int) -> str:
    """Write pressure and volume of a chamber with their errors; no pressure that is exact."""
    pressure, volume = bars.pressures[index], bars.volumes[index]
    return f"{volume}" if pressure.is_exact else f"{pressure}, {volume}"


def _supply_in_words(bars: ErrorBars, name: str) -> str:
    """Write pressure, volume and mass of a supply with their errors, in the order of its words."""
    found = bars.supplies.get(name)
    return "" if found is None else ", ".join(str(found[k]) for k in ("pressure", "volume", "mass"))


def _force_in_words(force: Force) -> str:
    size = float(np.linalg.norm(force))
    # A component below a billionth of the whole is rounding.
    parts = (0.0 if abs(each) <= 1e-9 * size else rounded(each) for each in force)
    return f"({', '.join(format_quantity(each, 'force') for each in parts)})"


def _missing(result: Result) -> str:
    """Missing parts of a stored state, in a sentence; empty where all are there."""
    filmed = is_filmed(result.design) and result.solver["way"] == "dynamics"
    if not filmed or len(result.recording.frames) > 0:
        return ""
    return "Only the end of this motion was stored, not the way there."


def finding_of(diagnostic: Diagnostic) -> events.Finding:
    """Pass a diagnostic on to the page."""
    return events.Finding(
        severity=diagnostic.severity,
        where=diagnostic.where,
        what=diagnostic.what,
        hint=diagnostic.hint,
        at=diagnostic.at,
    )


def _metrics(result: Result, bars: ErrorBars) -> list[events.MetricValue]:
    """The design's own first; chambers and stretch are told beside them.

    Load factors follow where they are answers.
    """
    own: dict[str, Target] = {**result.design.objectives, **result.design.constraints}
    kinds = {name: METRICS[target.metric].kind for name, target in own.items()}
    free = ("max_displacement", "reaction", "elastic_energy")
    kinds |= {name: METRICS[name].kind for name in free if name not in kinds}
    values = {name: float(result.metrics[name]) for name in kinds}
    known = dict(bars.metrics)
    for name in ("load_factor", "limit_factor"):
        factor: float | None = getattr(result, name)
        if factor is not None and (name == "limit_factor" or factor != 1.0):
            values[name], kinds[name] = factor, "number"
            if (bar := getattr(bars, name)) is not None:
                known[name] = bar
    return [
        events.MetricValue(
            name=name,
            value=values[name],
            kind=kind,
            estimate=str(known[name]) if name in known else "",
            share=share_of([known[name]]) if name in known else None,
        )
        for name, kind in kinds.items()
    ]
