"""What the page is told of an equilibrium: its numbers, and what is doubtful about it."""

from __future__ import annotations

import threading
from collections.abc import Callable

from voxsoft.errors import VoxSoftError
from voxsoft.metrics import METRICS, Target
from voxsoft.simulation import Diagnostic, Result
from voxsoft.studio import events
from voxsoft.units import format_percent


class Measurement(threading.Thread):
    """Measures an equilibrium on a thread of its own: warnings of large bodies take a while.

    Parameters
    ----------
    result
        Gives the result.
    report
        Called with what the page gets; not at all where the state cannot be measured.
    topology, frame
        Which body it is of, and the frame that shows it.
    """

    def __init__(
        self,
        result: Callable[[], Result],
        report: Callable[[events.Equilibrium], None],
        topology: int,
        frame: int,
    ) -> None:
        super().__init__(name="studio-equilibrium", daemon=True)
        self._result, self._report = result, report
        self._topology, self._frame = topology, frame

    def run(self) -> None:
        """Measure."""
        try:
            found = equilibrium_of(self._result(), self._topology, self._frame)
        except VoxSoftError:
            return
        self._report(found)


def equilibrium_of(result: Result, topology: int, frame: int) -> events.Equilibrium:
    """Say all numbers of a result."""
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
            events.MovedProbe(name=name, displacement=(float(x), float(y), float(z)))
            for name, (x, y, z) in result.probes.items()
        ],
        metrics=_metrics(result),
        chambers=[
            events.Chamber(
                name=cavity.get("name") or f"cavity {index}",
                rest_volume=float(cavity["rest_volume"]),
                volume=float(cavity["volume"]),
                pressure=float(cavity["pressure"]),
            )
            for cavity, index in cavities
        ],
        largest_strain=result.metric("max_stretch") - 1.0,
        warnings=[finding_of(warning) for warning in result.warnings],
    )


def finding_of(diagnostic: Diagnostic) -> events.Finding:
    """Pass a diagnostic on to the page."""
    return events.Finding(
        severity=diagnostic.severity,
        where=diagnostic.where,
        what=diagnostic.what,
        hint=diagnostic.hint,
        at=diagnostic.at,
    )


def _metrics(result: Result) -> list[events.MetricValue]:
    """The design's own first; chambers and stretch are told beside them."""
    own: dict[str, Target] = {**result.design.objectives, **result.design.constraints}
    kinds = {name: METRICS[target.metric].kind for name, target in own.items()}
    free = ("max_displacement", "reaction", "elastic_energy")
    kinds |= {name: METRICS[name].kind for name in free if name not in kinds}
    return [
        events.MetricValue(name=name, value=float(result.metrics[name]), kind=kind)
        for name, kind in kinds.items()
    ]
