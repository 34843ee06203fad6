"""Style of all figures: colors, font sizes, an empty figure that needs no display."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

# Okabe and Ito's palette, https://jfly.uni-koeln.de/color/: eight colors that readers with any
# of the common kinds of color blindness distinguish.
BLACK: Final = "#000000"
ORANGE: Final = "#e69f00"
SKY: Final = "#56b4e9"
GREEN: Final = "#009e73"
BLUE: Final = "#0072b2"
RED: Final = "#d55e00"
PINK: Final = "#cc79a7"

#: Colors of series in order.
SERIES: Final = (BLUE, RED, GREEN, PINK, ORANGE, SKY)

GRAY: Final = "#7f7f7f"
PALE: Final = "#d9d9d9"

#: Perceptually uniform color map, readable in gray and by color-blind readers.
COLOR_MAP: Final = "viridis"

_DOTS_PER_INCH: Final = 150
_FONT_SIZE: Final = 10.0


def empty_figure(width: float, height: float) -> Figure:
    """Make a figure with a size in inches that belongs to no window and to no list of figures."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), dpi=_DOTS_PER_INCH, layout="constrained")


def plain_axes(axes: Axes, *, x: str, y: str, title: str = "") -> None:
    """Give axes their labels, a light grid behind the data, and no box."""
    axes.set_xlabel(x, fontsize=_FONT_SIZE)
    axes.set_ylabel(y, fontsize=_FONT_SIZE)
    if title:
        axes.set_title(title, fontsize=_FONT_SIZE + 1, loc="left")
    axes.grid(True, color=PALE, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def plain_legend(axes: Axes, **options: Any) -> None:  # noqa: ANN401 - options of matplotlib
    """Add a legend without a box, if there is more than one series."""
    handles, _ = axes.get_legend_handles_labels()
    if len(handles) > 1:
        axes.legend(frameon=False, fontsize=_FONT_SIZE - 1, **options)


def plain_log_axis(axis: Axis) -> None:
    """Label a logarithmic axis with plain numbers at 1, 2 and 5 times the powers of ten."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=12))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())
