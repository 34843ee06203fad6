"""Discretization error of the places of a workspace: the same lines on voxels of another size."""

from __future__ import annotations

import math
from collections.abc import Callable

from voxsoft.comparison.bars import Announce
from voxsoft.comparison.error_bar import ErrorBars
from voxsoft.comparison.path_bars import path_error_bars
from voxsoft.simulation import LoadPath


def line_error(
    path: LoadPath,
    probe: str,
    *,
    progress: Callable[[int, float, float], None] | None = None,
    announce: Announce | None = None,
) -> tuple[float, ErrorBars]:
    """Estimate the discretization error of the places of one line of a workspace.

    Parameters
    ----------
    path
        The line.
    probe
        Name of the probe.
    progress, announce
        See :func:`voxsoft.error_bars`.

    Returns
    -------
    float
        The largest error of a place, m; NaN where it is not known.
    ErrorBars
        Error bars of the line's last equilibrium, with their source.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> beam = families.beam(length="40 mm").with_values("parts.0.material=ecoflex-00-30")
    >>> error, _ = line_error(vs.follow(beam, "loads[0].value=0..9.81 m/s^2/3"), "station-9")
    >>> 0.0 < error < 1e-3
    True
    """
    bars = path_error_bars(path, progress=progress, announce=announce)
    known = [each.probes[probe] for each in bars if probe in each.probes]
    errors = [math.hypot(*(axis.error for axis in place)) for place in known]
    return max(errors, default=math.nan) if len(known) == len(bars) else math.nan, bars[-1]
