"""Pictures of coupon fits: measured stress, all models, their errors and their predictions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from voxsoft.materials import MODES, Mode, nominal_stress, stable_range
from voxsoft.materials.coupon import CouponFit, Curve, ModelFit
from voxsoft.plot.quantities import Scale, scale_for
from voxsoft.plot.style import (
    BLACK,
    GRAY,
    PALE,
    SERIES,
    empty_figure,
    plain_axes,
    plain_legend,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLORS: Final = (*SERIES, GRAY, BLACK)
_DASHES: Final = ("--", "-.", ":")
_SHAPES: Final[dict[Mode, str]] = {"uniaxial": "o", "equibiaxial": "s", "planar": "^"}
_SAMPLES: Final = 200
# Strain range of beams in bending.
_SMALL: Final = 0.5


def plot_coupons(fit: CouponFit, model: str | None = None) -> Figure:
    """Draw the measured curves and every fitted model.

    Parameters
    ----------
    fit
        Result of :func:`voxsoft.materials.coupon.fit_coupons`.
    model
        Name of the model to emphasize; default: the recommended one.

    Returns
    -------
    matplotlib.figure.Figure
        Four panels: stress over strain with all models, and the same up to a strain of 50 %; the
        error of each model; and the stress of the emphasized model in all three modes, dotted where
        it is unstable, with a bar for the range of all models that fit alike in a mode without a
        curve.

    Examples
    --------
    >>> from voxsoft.materials.coupon import Curve, fit_coupons
    >>> strain = np.linspace(0.0, 1.0, 30)
    >>> figure = plot_coupons(fit_coupons([Curve(strain, 40e3 * strain)]))
    >>> len(figure.axes)
    4
    """
    chosen = fit.of(model)
    figure = empty_figure(11.0, 8.0)
    (whole, start), (errors, modes) = figure.subplots(2, 2)
    stresses = np.concatenate([curve.stress for curve in fit.curves])
    scale = scale_for(stresses, "pressure")
    everything = _legend_order(fit, chosen)
    _draw_curves(whole, fit, everything, chosen, scale, np.inf)
    plain_axes(whole, x="strain", y=scale.label("engineering stress"), title="all models")
    _draw_curves(start, fit, everything, chosen, scale, _SMALL)
    plain_axes(start, x="strain", y=scale.label("engineering stress"), title="the start")
    handles, labels = whole.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=6, frameon=False, fontsize=9)
    _draw_errors(errors, fit, everything, chosen, stresses)
    _draw_modes(modes, fit, chosen, scale)
    return figure


def _legend_order(fit: CouponFit, chosen: ModelFit) -> list[tuple[ModelFit, str, str]]:
    """Pair every model with its color and dashes, the same in all panels."""
    looks = [
        (found, _COLORS[i % len(_COLORS)], "-" if found is chosen else _DASHES[i % len(_DASHES)])
        for i, found in enumerate(fit.models)
    ]
    return sorted(looks, key=lambda look: look[0] is not chosen)


def _draw_curves(
    axes: Axes,
    fit: CouponFit,
    models: list[tuple[ModelFit, str, str]],
    chosen: ModelFit,
    scale: Scale,
    farthest: float,
) -> None:
    shown: set[Mode] = set()
    for curve in fit.curves:
        near = np.abs(curve.strain) <= farthest
        label = f"measured, {curve.mode}" if curve.mode not in shown else None
        shown.add(curve.mode)
        axes.plot(
            curve.strain[near],
            curve.stress[near] * scale.factor,
            _SHAPES[curve.mode],
            color=BLACK,
            markerfacecolor="none",
            markersize=4,
            label=label,
            zorder=5,
        )
    for found, color, dashes in models:
        for mode in [mode for mode in MODES if mode in shown]:
            low, high = _span([curve for curve in fit.curves if curve.mode == mode], farthest)
            strain = np.linspace(low, high, _SAMPLES)
            axes.plot(
                strain,
                nominal_stress(found.material, 1.0 + strain, mode) * scale.factor,
                dashes,
                color=color,
                linewidth=2.4 if found is chosen else 1.1,
                label=found.name if mode == fit.curves[0].mode else None,
                zorder=4 if found is chosen else 3,
            )
    drawn = np.concatenate([c.stress[np.abs(c.strain) <= farthest] for c in fit.curves])
    if len(drawn):
        low, high = float(min(drawn.min(), 0.0)), float(max(drawn.max(), 0.0))
        room = 0.08 * (high - low)
        axes.set_ylim((low - room) * scale.factor, (high + room) * scale.factor)


def _span(curves: list[Curve], farthest: float) -> tuple[float, float]:
    low = min(0.0, *(float(curve.strain.min()) for curve in curves))
    high = max(0.0, *(float(curve.strain.max()) for curve in curves))
    return max(low, -farthest), min(high, farthest)


def _draw_errors(
    axes: Axes,
    fit: CouponFit,
    models: list[tuple[ModelFit, str, str]],
    chosen: ModelFit,
    stresses: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
) -> None:
    """Draw errors in the unit that suits the good models; those of the bad ones leave the panel."""
    good = sorted(found.max_error for found in fit.models)
    limit = 1.2 * good[len(good) // 2]
    scale = scale_for(limit, "pressure")
    for found, color, dashes in models:
        for curve in fit.curves:
            error = nominal_stress(found.material, curve.stretch, curve.mode) - curve.stress
            axes.plot(
                curve.strain,
                error * scale.factor,
                dashes,
                color=color,
                linewidth=2.0 if found is chosen else 1.0,
            )
    axes.axhline(0.0, color=BLACK, linewidth=0.8)
    if limit > 0.0:
        axes.set_ylim(-limit * scale.factor, limit * scale.factor)
    share = chosen.rmse / float(np.abs(stresses).max())
    title = f"error; {chosen.name}: {share:.1%} of the largest stress (root mean square)"
    plain_axes(axes, x="strain", y=scale.label("model minus measured"), title=title)


def _draw_modes(axes: Axes, fit: CouponFit, chosen: ModelFit, scale: Scale) -> None:
    """Draw the stress of one model in all modes, from compression to the largest strain of the fit.

    The panel ends at three times the largest measured stress: a model that goes off there in a mode
    that nobody measured is not to be trusted in it. Bars span all models that fit alike.
    """
    limit = 3.0 * max(float(np.abs(curve.stress).max()) for curve in fit.curves) * scale.factor
    top = 0.0
    largest = max(float(curve.stretch.max()) for curve in fit.curves)
    for mode, color in zip(MODES, SERIES, strict=False):
        low = 0.7
        stretch = np.linspace(low, max(largest, 1.3), _SAMPLES)
        stress = nominal_stress(chosen.material, stretch, mode) * scale.factor
        top = max(top, min(1.1 * float(np.nanmax(stress)), limit))
        stable = stable_range(chosen.material, mode, low, float(stretch[-1])).stable
        inside = (stretch >= stable[0] * (1.0 - 1e-9)) & (stretch <= stable[1] * (1.0 + 1e-9))
        axes.plot(stretch - 1.0, stress, ":", color=color, linewidth=1.2)
        axes.plot(
            stretch - 1.0, np.where(inside, stress, np.nan), color=color, linewidth=1.8, label=mode
        )
    for curve in fit.curves:
        axes.plot(
            curve.strain,
            curve.stress * scale.factor,
            _SHAPES[curve.mode],
            color=GRAY,
            markerfacecolor="none",
            markersize=3,
            zorder=1,
        )
    colors = dict(zip(MODES, SERIES, strict=False))
    for open_mode in fit.untested:
        at, ends = open_mode.stretch - 1.0, np.array([open_mode.low, open_mode.high]) * scale.factor
        axes.plot([at, at], ends, "_-", color=colors[open_mode.mode], linewidth=1.2, markersize=8)
        top = max(top, min(1.1 * float(ends[1]), limit))
    axes.axvspan(*_span(list(fit.curves), np.inf), color=PALE, alpha=0.3, linewidth=0)
    axes.set_ylim(-0.5 * top, top)
    title = f"{chosen.name} in all modes (dotted: unstable; shaded: fitted)"
    plain_axes(axes, x="strain", y=scale.label("engineering stress"), title=title)
    plain_legend(axes, loc="upper left")
