"""Pictures: bodies, studies and calibrations as matplotlib figures.

Every function returns a :class:`matplotlib.figure.Figure` and needs no display; save it with
``figure.savefig("name.png")``. Axes carry units, color maps are perceptually uniform, and colors
stay apart for color-blind readers.

Examples
--------
>>> import voxsoft as vs
>>> from voxsoft.design import families
>>> from voxsoft.plot import plot_body
>>> figure = plot_body(vs.simulate(families.beam()))
>>> [axes.get_label() for axes in figure.axes]
['body', 'colorbar']
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxsoft._lazy import lazy_names

if TYPE_CHECKING:
    from voxsoft.plot.body import body_image, plot_body
    from voxsoft.plot.calibration import plot_fitness, plot_profiles, plot_shape
    from voxsoft.plot.comparison import (
        plot_agreement,
        plot_convergence,
        plot_errors,
        plot_shapes,
        plot_times,
    )
    from voxsoft.plot.control import plot_bode, plot_step, plot_track
    from voxsoft.plot.coupon import plot_coupons
    from voxsoft.plot.path import plot_path
    from voxsoft.plot.scoreboard import plot_scoreboard
    from voxsoft.plot.study import plot_history, plot_pareto, plot_paths, plot_scatter
    from voxsoft.plot.workspace import plot_workspace

__all__ = [
    "body_image",
    "plot_agreement",
    "plot_bode",
    "plot_body",
    "plot_convergence",
    "plot_coupons",
    "plot_errors",
    "plot_fitness",
    "plot_history",
    "plot_pareto",
    "plot_path",
    "plot_paths",
    "plot_profiles",
    "plot_scatter",
    "plot_scoreboard",
    "plot_shape",
    "plot_shapes",
    "plot_step",
    "plot_times",
    "plot_track",
    "plot_workspace",
]

# Imported when first used: the picture of a body needs no fit of coupons.
_HOMES = {
    "body_image": "voxsoft.plot.body",
    "plot_agreement": "voxsoft.plot.comparison",
    "plot_bode": "voxsoft.plot.control",
    "plot_body": "voxsoft.plot.body",
    "plot_convergence": "voxsoft.plot.comparison",
    "plot_coupons": "voxsoft.plot.coupon",
    "plot_errors": "voxsoft.plot.comparison",
    "plot_fitness": "voxsoft.plot.calibration",
    "plot_history": "voxsoft.plot.study",
    "plot_path": "voxsoft.plot.path",
    "plot_paths": "voxsoft.plot.study",
    "plot_pareto": "voxsoft.plot.study",
    "plot_profiles": "voxsoft.plot.calibration",
    "plot_scatter": "voxsoft.plot.study",
    "plot_scoreboard": "voxsoft.plot.scoreboard",
    "plot_shape": "voxsoft.plot.calibration",
    "plot_shapes": "voxsoft.plot.comparison",
    "plot_step": "voxsoft.plot.control",
    "plot_times": "voxsoft.plot.comparison",
    "plot_track": "voxsoft.plot.control",
    "plot_workspace": "voxsoft.plot.workspace",
}
__getattr__, __dir__ = lazy_names(__name__, _HOMES)
