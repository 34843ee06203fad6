"""The closed tube of `round_bodies.py` in FElupe, refined: a second code beside `axisymmetric.py`.

``pip install felupe``, then ``python evidence/tube_in_felupe.py [--json]``. Three-field
quadrilaterals of 2, 1 and 0.5 mm with rotational symmetry, the limit by Richardson with the order
of the inner edges (2 times 0.5445), and the Q2 elements of `axisymmetric.py` beside it.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, Final

import numpy as np
from axisymmetric import can
from numpy.typing import NDArray
from round_bodies import HEIGHTS, POISSON, RADII, TUBE_PRESSURE, YOUNG

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

SIZES: Final = (2.0, 1.0, 0.5)
ORDER: Final = 2 * 0.5445
#: Steps to the full pressure.
STEPS: Final = 8
#: Tolerance of places in mm.
NEAR: Final = 1e-6

Floats = NDArray[np.float64]


def volume(path: Floats) -> float:
    """Volume in ml inside a line (n, 2) of heights and radii in mm."""
    (height, radius) = path.T
    sums = radius[1:] ** 2 + radius[1:] * radius[:-1] + radius[:-1] ** 2
    return float(np.pi / 3 * (np.diff(height) * sums).sum()) / 1000


def solved(fem: Any, size: float) -> dict[str, float]:
    """Growth in ml and displacements in mm for quadrilaterals of a size in mm."""
    inner, outer = RADII
    low, bottom, top, high = HEIGHTS
    corners = [
        ((low, 0), (bottom, inner)),
        ((low, inner), (bottom, outer)),
        ((bottom, inner), (top, outer)),
        ((top, 0), (high, inner)),
        ((top, inner), (high, outer)),
    ]
    parts = [
        fem.Rectangle(
            a=a, b=b, n=tuple(round((q - p) / size) + 1 for p, q in zip(a, b, strict=True))
        )
        for a, b in corners
    ]
    mesh = fem.mesh.merge_duplicate_points(fem.mesh.concatenate(parts), decimals=6)
    places = mesh.points
    field = fem.FieldsMixed(fem.RegionQuad(mesh), n=3, axisymmetric=True)
    shear, bulk = YOUNG / 2 / (1 + POISSON), YOUNG / 3 / (1 - 2 * POISSON)
    body = fem.SolidBody(fem.ThreeFieldVariation(fem.NeoHooke(mu=shear, bulk=bulk)), field)

    def line(axis: int, at: float, other: tuple[float, float]) -> NDArray[np.bool_]:
        along = places[:, 1 - axis]
        within = (along > other[0] - NEAR) & (along < other[1] + NEAR)
        return (np.abs(places[:, axis] - at) < NEAR) & within

    wall = line(1, inner, (bottom, top))
    floor, cap = (line(0, at, (0, inner)) for at in (bottom, top))
    room = fem.RegionQuadBoundary(mesh, mask=wall | floor | cap, only_surface=True, ensure_3d=True)
    load = fem.SolidBodyPressure(fem.FieldContainer([fem.FieldAxisymmetric(room, dim=2)]))
    bounds = {
        "foot": fem.Boundary(field[0], fx=low),
        "axis": fem.Boundary(field[0], fy=0.0, skip=(1, 0)),
    }
    ramp = {load: fem.math.linsteps([0, TUBE_PRESSURE], num=STEPS)}
    job = fem.Job([fem.Step([body, load], ramp=ramp, boundaries=bounds)])
    job.evaluate(verbose=0)
    moved = field[0].values

    def ordered(mask: NDArray[np.bool_], axis: int, sign: int) -> NDArray[np.intp]:
        found = np.flatnonzero(mask)
        return found[np.argsort(sign * places[found, axis])]

    path = np.concatenate([ordered(floor, 1, 1), ordered(wall, 0, 1)[1:], ordered(cap, 1, -1)[1:]])

    def at(height: float, radius: float) -> Floats:
        nearest = np.abs(places - [height, radius]).sum(axis=1).argmin()
        return np.asarray(moved[nearest])

    middle = (bottom + top) / 2
    return {
        "growth in ml": volume((places + moved)[path]) - volume(places[path]),
        "bore in mm": float(at(middle, inner)[1]),
        "outside in mm": float(at(middle, outer)[1]),
        "top in mm": float(at(high, 0.0)[0]),
    }


def main() -> None:
    """Print both codes."""
    import felupe

    report = Report("The closed tube in two codes")
    each = [solved(felupe, size) for size in SIZES]
    own = can(RADII, HEIGHTS, YOUNG, POISSON, 2.5).at_pressure(TUBE_PRESSURE)
    middle = (HEIGHTS[1] + HEIGHTS[2]) / 2
    ours = {
        "growth in ml": own.grown,
        "bore in mm": float(own.moved((RADII[0], middle))[0]),
        "outside in mm": float(own.moved((RADII[1], middle))[0]),
        "top in mm": float(own.moved((0.0, HEIGHTS[3]))[1]),
    }
    for name in each[0]:
        for size, found in zip(SIZES, each, strict=True):
            report.add(f"{name}, FElupe, {size:g} mm", found[name], "")
        fine = each[-1][name]
        limit = fine + (fine - each[-2][name]) / (2**ORDER - 1)
        report.add(f"{name}, FElupe, limit", limit, "")
        report.add(f"{name}, Q2 of axisymmetric.py", ours[name], "", ours[name] / limit)
    report.show()


if __name__ == "__main__":
    main()
