"""The three bodies of `peers.py`: a beam, a twisted bar and a thick sphere, with their truths.

All have E = 60 kPa and ν = 0.49, neo-Hookean with the volumetric energy K/2 (J - 1)².

- Beam: 100 x 10 x 10 mm under its weight, 10 mm of it clamped; the number is where the middle of
  its end goes. The truth is of converged mixed bricks.
- Twisted bar: 40 x 10 x 10 mm between two clamps, one of which turns by 90 degrees about the bar;
  the number is the torque of the support at the turned end.
- Thick sphere: 10 and 20 mm, pressed from inside until the inner radius has grown by two fifths;
  the number is the growth of the chamber. The truth is a closed form, `tests/round_walls.py`.
"""

from __future__ import annotations

import runpy
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

import voxsoft as vs
from voxsoft.units import kPa, mm

YOUNG: Final = 60 * kPa
POISSON: Final = 0.49
DENSITY: Final = 1070.0
SIDE: Final = 10 * mm
BEAM_LENGTH: Final = 100 * mm
BAR_LENGTH: Final = 40 * mm
TWIST: Final = np.pi / 2
INNER, OUTER, STRETCH = 10 * mm, 20 * mm, 1.4

_closed_form = runpy.run_path(str(Path(__file__).parents[1] / "tests" / "round_walls.py"))
#: What presses the sphere to its stretch, Pa.
PRESSURE: Final = float(
    _closed_form["inner_pressure"](YOUNG, POISSON, STRETCH, INNER, OUTER, sphere=True)
)


@dataclass(frozen=True, eq=False)
class Body:
    """A body of the comparison.

    Attributes
    ----------
    name, number
        What it is called, and what is looked at.
    truth
        That number, converged, in SI units.
    """

    name: str
    number: str
    truth: np.ndarray

    def error(self, number: np.ndarray) -> float:
        """Error of a number, of the truth."""
        return float(np.linalg.norm(number - self.truth) / np.linalg.norm(self.truth))


BEAM: Final = Body("beam", "tip", np.array([-44.0603e-3, 0.0, -72.9053e-3]))
#: `peers.py --reference`: mixed bricks of scikit-fem, 2 to 5 across, extrapolated. Voxels, 4, 8 and
#: 12 across, tend to 1.1296 mN·m.
BAR: Final = Body("twisted bar", "torque", np.array([1.1298e-3]))
SPHERE: Final = Body(
    "thick sphere", "growth of the chamber", np.array([4 / 3 * np.pi * INNER**3 * (STRETCH**3 - 1)])
)


def rubber() -> vs.NeoHookean:
    """What all of them are made of."""
    return vs.NeoHookean(young=YOUNG, poisson=POISSON, density=DENSITY)


def beam(across: int) -> vs.Design:
    """The beam, with so many voxels across."""
    return vs.Design(
        name=BEAM.name,
        voxel_size=SIDE / across,
        parts=[vs.Part(shape=vs.Box(size=(BEAM_LENGTH, SIDE, SIDE)), material=rubber())],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 10 * mm)))],
        loads=[vs.Gravity()],
        probes={"tip": vs.Probe(point=(BEAM_LENGTH, SIDE / 2, SIDE / 2))},
    )


def twisted_bar(across: int) -> vs.Design:
    """The bar, with so many voxels across."""
    turn = vs.Rotation(axis=(1, 0, 0), angle=float(TWIST), center=(0, SIDE / 2, SIDE / 2))
    return vs.Design(
        name=BAR.name,
        voxel_size=SIDE / across,
        parts=[vs.Part(shape=vs.Box(size=(BAR_LENGTH, SIDE, SIDE)), material=rubber())],
        clamps=[
            vs.Clamp(region=vs.Region(x=(0, 0))),
            vs.Clamp(region=vs.Region(x=(BAR_LENGTH, BAR_LENGTH)), motion=vs.Motion(rotation=turn)),
        ],
    )


def thick_sphere(wall: int) -> vs.Design:
    """An eighth of the sphere, with so many voxels through its wall."""
    return vs.Design(
        name=SPHERE.name,
        voxel_size=(OUTER - INNER) / wall,
        fill="fraction",
        parts=[vs.Part(shape=vs.Sphere(radius=OUTER) - vs.Sphere(radius=INNER), material=rubber())],
        symmetry=[{"plane": axis} for axis in "xyz"],
        loads=[vs.Pressure(value=PRESSURE)],
    )


def torque(points: np.ndarray, forces: np.ndarray) -> np.ndarray:
    """Torque about the axis of the bar, (1,), of forces (n, 3) in N at points (n, 3) in m."""
    arms = points[:, 1:] - SIDE / 2
    return np.array([float(arms[:, 0] @ forces[:, 2] - arms[:, 1] @ forces[:, 1])])


def turned(points: np.ndarray, angle: float) -> np.ndarray:
    """Points (n, 3) of the turned end in m at an angle in rad."""
    arms = points[:, 1:] - SIDE / 2
    cos, sin = np.cos(angle), np.sin(angle)
    across = np.column_stack(
        (cos * arms[:, 0] - sin * arms[:, 1], sin * arms[:, 0] + cos * arms[:, 1])
    )
    return np.column_stack((points[:, 0], across + SIDE / 2))


def cube_shell(surface: int, wall: int) -> tuple[np.ndarray, np.ndarray]:
    """Bricks between a cube of half edge 10 mm and one of 20 mm, x, y, z > 0: points and corners.

    `to_sphere` maps it onto the eighth of the sphere.
    """
    points, bricks = [], []
    for axis in range(3):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        u, v, w = np.meshgrid(
            np.arange(surface + 1), np.arange(surface + 1), np.arange(wall + 1), indexing="ij"
        )
        radius = INNER + (OUTER - INNER) * w.ravel() / wall
        place = np.empty((len(radius), 3))
        place[:, axis] = radius
        place[:, first] = radius * u.ravel() / surface
        place[:, second] = radius * v.ravel() / surface
        number = np.arange(len(radius)).reshape(u.shape)
        lows = [number[a : a + surface, b : b + surface, c : c + wall] for a, b, c in CORNERS]
        bricks.append(np.column_stack([low.ravel() for low in lows]) + sum(map(len, points)))
        points.append(place)
    every, corners = np.concatenate(points), np.concatenate(bricks)
    _, kept, number = np.unique(
        np.rint(every / (1e-6 * mm)).astype(np.int64),
        axis=0,
        return_index=True,
        return_inverse=True,
    )
    return every[kept], number.ravel()[corners]


#: Corners of a brick as CalculiX and Abaqus count them; their order is right-handed.
CORNERS: Final = (
    (0, 0, 0),
    (1, 0, 0),
    (1, 1, 0),
    (0, 1, 0),
    (0, 0, 1),
    (1, 0, 1),
    (1, 1, 1),
    (0, 1, 1),
)


def to_sphere(points: np.ndarray) -> np.ndarray:
    """The place on the sphere of points (n, 3) of the cube's shell; equal angles along an edge."""
    radius = points.max(axis=1, keepdims=True)
    ways = np.tan(np.pi / 4 * points / radius)
    return radius * ways / np.linalg.norm(ways, axis=1, keepdims=True)
