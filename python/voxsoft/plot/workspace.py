"""Picture of a workspace: its net of places from three sides."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from voxsoft.plot.quantities import scale_for
from voxsoft.plot.style import BLACK, COLOR_MAP, GRAY, empty_figure, plain_axes
from voxsoft.simulation import Workspace

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Axes across and upward of each view.
_VIEWS: Final = (("x", "z"), ("y", "z"), ("x", "y"))


def plot_workspace(found: Workspace) -> Figure:
    """Draw the reachable places: front, side and top, with a line along each drive.

    Parameters
    ----------
    found
        Result of :func:`voxsoft.workspace`.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels of one scale; colors follow the first drive, and a ring marks the place without
        load.
    """
    points, unloaded = found.points, found.unloaded
    scale = scale_for([*points.ravel(), *unloaded], "length")
    first = scale_for(found.drives[0].values, found.drives[0].kind)
    colors = np.broadcast_to(
        np.array(found.drives[0].values).reshape(-1, *(1,) * (points.ndim - 2)), points.shape[:-1]
    )
    everywhere = np.vstack([points.reshape(-1, 3), unloaded]) * scale.factor
    middle = (np.nanmax(everywhere, axis=0) + np.nanmin(everywhere, axis=0)) / 2.0
    reach = max(0.55 * float(np.ptp(everywhere[np.isfinite(everywhere[:, 0])], axis=0).max()), 1e-9)
    figure = empty_figure(12.5, 4.2)
    panels = figure.subplots(1, 3)
    for axes, view in zip(panels, _VIEWS, strict=True):
        seen = points[..., ["xyz".index(name) for name in view]] * scale.factor
        for drive in range(seen.ndim - 1):
            lines = np.moveaxis(seen, drive, 0).reshape(seen.shape[drive], -1, 2)
            axes.plot(*lines.transpose(2, 0, 1), color=GRAY, linewidth=0.6, zorder=1)
        dots = axes.scatter(
            *seen.reshape(-1, 2).T,
            c=colors.ravel() * first.factor,
            cmap=COLOR_MAP,
            s=14,
            zorder=2,
        )
        across, upward = (unloaded["xyz".index(name)] * scale.factor for name in view)
        axes.plot([across], [upward], "o", mfc="none", mec=BLACK, markersize=9, zorder=3)
        plain_axes(axes, x=scale.label(view[0]), y=scale.label(view[1]))
        for limit, name in zip((axes.set_xlim, axes.set_ylim), view, strict=True):
            center = middle["xyz".index(name)]
            limit(center - reach, center + reach)
        axes.set_aspect("equal")
    bar = figure.colorbar(dots, ax=panels, shrink=0.85, pad=0.01)
    bar.set_label(first.label(found.drives[0].key))
    return figure
