"""Picture of a fit of branches: stress over time and over strain, measured and fitted."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxsoft.materials import nominal_stress, relaxing_stress
from voxsoft.materials.coupon import BranchFit
from voxsoft.plot.quantities import scale_for
from voxsoft.plot.style import BLACK, GRAY, SERIES, empty_figure, plain_axes, plain_legend

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Rows of a test that are drawn.
_DRAWN = 400


def plot_branches(fit: BranchFit) -> Figure:
    """Draw the stress of all tests over time, and over the strain, with the fit as lines.

    Parameters
    ----------
    fit
        Result of :func:`voxsoft.materials.coupon.fit_branches`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels. Times are logarithmic; in the right one the long-term stress is gray.

    Examples
    --------
    >>> from voxsoft.materials import NeoHookean
    >>> from voxsoft.materials.coupon import TimedTest, fit_branches
    >>> rubber = NeoHookean(young="60 kPa", prony=[{"g": 0.3, "tau": "20 s"}])
    >>> time, strain = np.geomspace(0.5, 200.0, 60), np.full(60, 0.5)
    >>> stress = relaxing_stress(rubber, time, 1.0 + strain)
    >>> len(plot_branches(fit_branches([TimedTest(time, strain, stress)])).axes)
    2
    """
    every = fit.every
    scale = scale_for(np.concatenate([each.stress for each in every]), "pressure")
    figure = empty_figure(11.0, 4.5)
    over_time, over_strain = figure.subplots(1, 2)
    for number, test in enumerate(fit.tests):
        color = SERIES[number % len(SERIES)]
        rows = slice(None, None, max(1, len(test.time) // _DRAWN))
        fitted = relaxing_stress(fit.material, test.time, test.stretch) * scale.factor
        for axes, along in ((over_time, test.time), (over_strain, test.strain)):
            measured = test.stress[rows] * scale.factor
            axes.plot(along[rows], measured, "o", color=GRAY, markersize=2, zorder=1)
            axes.plot(along[rows], fitted[rows], color=color, linewidth=1.8, label=test.name)
    for curve in fit.curves:
        over_strain.plot(curve.strain, curve.stress * scale.factor, "x", color=GRAY, markersize=3)
    low = min(0.0, *(float(each.strain.min()) for each in every))
    high = max(0.0, *(float(each.strain.max()) for each in every))
    strain = np.linspace(low, high, 100)
    long_term = nominal_stress(fit.material, 1.0 + strain) * scale.factor
    over_strain.plot(strain, long_term, "--", color=BLACK, linewidth=1.0, label="long-term")
    over_time.set_xscale("log")
    label = scale.label("engineering stress")
    branches = ", ".join(f"{b.g.value:.3g} in {b.tau.value:.3g} s" for b in fit.branches)
    plain_axes(over_time, x="time (s)", y=label, title=f"{fit.model}; g {branches}")
    plain_axes(over_strain, x="strain", y=label, title="over the strain")
    plain_legend(over_strain, loc="best")
    return figure
