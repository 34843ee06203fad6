"""Error bars along a path: the same path on voxels of another size."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from voxsoft.comparison.bars import Announce, error_bars
from voxsoft.comparison.error_bar import ErrorBar, ErrorBars
from voxsoft.design import Design
from voxsoft.simulation import LoadPath, Result, follow


def path_error_bars(
    path: LoadPath,
    *,
    progress: Callable[[int, float, float], None] | None = None,
    announce: Announce | None = None,
    frequencies: int = 0,
) -> tuple[ErrorBars, ...]:
    """Estimate the discretization errors at each value of a path.

    Parameters
    ----------
    path
        The path. Its design's ``solver.error`` and ``solver.accuracy`` select the voxels.
    progress, announce, frequencies
        See :func:`voxsoft.error_bars`.

    Returns
    -------
    tuple of ErrorBars
        One for each equilibrium, see :func:`voxsoft.error_bars`.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> beam = families.beam(length="40 mm").with_values("parts.0.material=ecoflex-00-30")
    >>> bars = path_error_bars(vs.follow(beam, "loads[0].value=0..9.81 m/s^2/3"))
    >>> first, middle, last = (bar.metrics["max_displacement"].error for bar in bars)
    >>> first < 1e-9 < middle < last
    True
    """
    paths: dict[float, LoadPath] = {}

    def announce_all(size: float, voxels: int, seconds: float) -> None:
        if announce is not None and size not in paths:
            announce(size, voxels, seconds * len(path.results))

    def at(number: int) -> Callable[[Design, Result | None], Result]:
        def solve(design: Design, _: Result | None) -> Result:
            size = design.voxel_size
            if size not in paths:
                # The design of one value has only the end of its histories; the path's has all.
                other = path.design.with_values(f"voxel_size={size * 1e3!r} mm")
                over = path.over.up_to(len(path.results))
                paths[size] = follow(other, over, progress=progress)
            return paths[size].results[min(number, len(paths[size].results) - 1)]

        return solve

    return tuple(
        error_bars(
            result,
            progress=progress,
            announce=announce_all,
            solve=at(number),
            frequencies=frequencies,
        )
        for number, result in enumerate(path.results)
    )


def bars_of(name: str, bars: Sequence[ErrorBars]) -> Iterator[ErrorBar | None]:
    """Yield the error bar of one column of a path at each of its values, or None.

    Columns are those of :attr:`voxsoft.simulation.LoadPath.columns`: metrics, components of probes
    such as ``"tip.z"``, and the ``volume`` and ``pressure`` of each chamber.
    """
    entry, _, part = name.rpartition(".")
    for each in bars:
        rows = {"volume": each.volumes, "pressure": each.pressures}
        if name in each.metrics:
            yield each.metrics[name]
        elif entry in each.probes and part in ("x", "y", "z"):
            yield each.probes[entry]["xyz".index(part)]
        elif entry in each.chambers and rows.get(part):
            yield rows[part][each.chambers.index(entry)]
        else:
            yield None
