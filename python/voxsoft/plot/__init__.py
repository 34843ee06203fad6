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

from voxsoft.plot.body import body_image, plot_body
from voxsoft.plot.calibration import plot_fitness, plot_profiles, plot_shape
from voxsoft.plot.comparison import (
    plot_agreement,
    plot_convergence,
    plot_errors,
    plot_shapes,
    plot_times,
)
from voxsoft.plot.coupon import plot_coupons
from voxsoft.plot.study import plot_history, plot_pareto, plot_scatter

__all__ = [
    "body_image",
    "plot_agreement",
    "plot_body",
    "plot_convergence",
    "plot_coupons",
    "plot_errors",
    "plot_fitness",
    "plot_history",
    "plot_pareto",
    "plot_profiles",
    "plot_scatter",
    "plot_shape",
    "plot_shapes",
    "plot_times",
]
