"""Calibrations as the page wants them."""

from __future__ import annotations

from collections.abc import Sequence

from voxsoft.calibration import Calibration
from voxsoft.calibration.result import Fit
from voxsoft.files.specimen import stations
from voxsoft.studio.protocol import events
from voxsoft.units import format_quantity


def overlay_event(job: str, fits: Sequence[Fit]) -> events.Overlay:
    """Measured and simulated stations, as points of the design's space."""
    return events.Overlay(
        job=job,
        experiments=[
            events.OverlayExperiment(
                name=fit.experiment.name,
                measured=measured,
                simulated=simulated,
                error=fit.errors.tolist(),
                percent=fit.percent.tolist(),
            )
            for fit in fits
            for measured, simulated in [stations(fit)]
        ],
    )


def calibrated_event(job: str, answer: Calibration, card: str) -> events.Calibrated:
    """The result of a calibration as the page wants it."""
    profiles = {profile.name: profile for profile in answer.profiles}
    return events.Calibrated(
        job=job,
        parameters=[
            events.FittedParameter(
                name=name,
                value=value,
                kind=answer.kinds[name],
                text=format_quantity(float(f"{value:.4g}"), answer.kinds[name]),
                low=answer.bounds[name][0],
                high=answer.bounds[name][1],
                identifiable=answer.identifiable.get(name),
                sentence=profiles[name].sentence if name in profiles else "not asked",
            )
            for name, value in answer.parameters.items()
        ],
        table=[
            events.StationError(
                experiment=fit.experiment.name,
                station=station,
                measured=fit.deviation.measured[at].tolist(),
                simulated=fit.deviation.simulated[at].tolist(),
                error=float(fit.errors[at]),
                percent=float(fit.percent[at]),
            )
            for fit in answer.fits
            for at, station in enumerate(fit.experiment.measurement.station_names)
        ],
        quantities=list(answer.fits[0].experiment.measurement.quantities),
        identifiable=answer.identifiable,
        fitness=answer.fitness,
        mean_error=answer.mean_error,
        max_error=answer.max_error,
        material=answer.material.model_dump(mode="json", exclude_none=True),
        card=card,
        miss=answer.miss,
        warnings=answer.warnings,
    )
