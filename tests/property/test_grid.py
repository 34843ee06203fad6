"""Bodies of whole voxels are exact wherever they lie, symmetric ones symmetric; from STL too."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

import voxsoft as vs
from voxsoft.design.discretization.discretize import mesh_of, voxels_of
from voxsoft.shapes import Box, Cylinder, Shape, TriangleMesh, voxelize

#: Edges of voxels: a power of two in mm, one that is not, and thirds.
SIZES = (0.002, 0.0008, 0.004 / 3.0)
#: Places of a face within a voxel: the special ones, and the rest at random.
SPECIAL = (0.0, 0.5, 1.0)
#: Units of files, in m; files hold float32 numbers.
UNITS = {"mm": 1e-3, "m": 1.0, "inch": 0.0254}


def corners(rng: np.random.Generator, size: float) -> Iterator[NDArray[np.float64]]:
    """Lowest corners [m]: all special ones along each axis, and random ones."""
    for special in np.stack(np.meshgrid(SPECIAL, SPECIAL, SPECIAL), axis=-1).reshape(-1, 3):
        yield size * (special + rng.integers(-20, 20, 3))
    for _ in range(20):
        yield size * rng.uniform(-20, 20, 3)


def boxes(seed: int) -> Iterator[tuple[NDArray[np.float64], NDArray[np.int64], float]]:
    """Lowest corner [m], voxels along the axes, voxel size [m]."""
    rng = np.random.default_rng(seed)
    for size in SIZES:
        for corner in corners(rng, size):
            yield corner, rng.integers(1, 12, 3), size
        for _ in range(10):  # centered on the axes
            count = rng.integers(1, 12, 3)
            yield -size * count / 2.0, count, size


def from_stl(mesh: trimesh.Trimesh, unit: str, path: Path) -> TriangleMesh:
    """A body in meters as a program would export it: scaled, then cut to float32."""
    scaled = mesh.copy()
    scaled.apply_scale(1.0 / UNITS[unit])
    scaled.export(path)
    return TriangleMesh(path=str(path), unit=unit)


def is_symmetric(array: NDArray[np.uint8]) -> list[bool]:
    """Along each axis, whether the filled cells are their own mirror image."""
    filled = np.argwhere(array > 0)
    low, high = filled.min(axis=0), filled.max(axis=0) + 1
    content = array[tuple(map(slice, low, high))]
    return [bool(np.array_equal(content, np.flip(content, axis))) for axis in range(3)]


def check_whole(shape: Shape, count: NDArray[np.int64], size: float) -> None:
    voxels = voxelize(shape, size)
    assert voxels.count == math.prod(count.tolist())
    # An STL file's rounding moves a face by 1e-7 of its place, not more.
    middle = np.mean(np.asarray(shape.bounds()), axis=0)
    assert voxels.bounds.mean(axis=0) == pytest.approx(middle, abs=1e-4 * size)


def test_boxes_of_whole_voxels_keep_their_volume():
    tried = 0
    for corner, count, size in boxes(1):
        check_whole(Box(size=tuple(size * count), corner=tuple(corner)), count, size)
        tried += 1
    assert tried == 3 * (27 + 20 + 10)


@pytest.mark.long
@pytest.mark.parametrize("unit", UNITS)
def test_their_stl_copies_too(unit: str, tmp_path: Path):
    for index, (corner, count, size) in enumerate(boxes(2)):
        mesh = trimesh.creation.box(bounds=[corner, corner + size * count])
        check_whole(from_stl(mesh, unit, tmp_path / f"{index}.stl"), count, size)


@pytest.mark.parametrize("unit", UNITS)
def test_boxes_that_abut_or_overlap_in_one_stl_are_one_body(unit: str, tmp_path: Path):
    rng = np.random.default_rng(3)
    for index in range(30):
        size = SIZES[index % 3]
        start = size * rng.choice([0.0, 0.5, rng.uniform()], 3) + size * rng.integers(-9, 9, 3)
        whole = rng.integers(2, 9, 3)
        # Inner faces at all places, through centers among them; outer faces a whole number apart.
        inner = size * rng.choice([0.5, 1.0, 1.5, rng.uniform(0.1, 1.9)], 2)
        reach = size * whole
        first, second = reach.copy(), np.zeros(3)
        first[0], second[0] = inner.max(), inner.min() if index % 2 else inner.max()
        both = trimesh.util.concatenate(
            [
                trimesh.creation.box(bounds=[start, start + first]),
                trimesh.creation.box(bounds=[start + second, start + reach]),
            ]
        )
        check_whole(from_stl(both, unit, tmp_path / f"{index}.stl"), whole, size)


def rounds(seed: int) -> Iterator[tuple[Shape, float, bool]]:
    """Cylinders and tubes across all axes, at special and random places; whether they are whole."""
    rng = np.random.default_rng(seed)
    for index in range(60):
        size = SIZES[index % 3]
        axis = "xyz"[rng.integers(3)]
        radius = size * rng.choice([rng.integers(2, 12) / 2.0, rng.uniform(1.2, 6.0)])
        height = size * rng.choice([rng.integers(1, 9), rng.uniform(1.0, 9.0)])
        center = size * rng.choice([0.0, 0.5, 1.0, rng.uniform()], 3)
        shape: Shape = Cylinder(radius=radius, height=height, base=tuple(center), axis=axis)
        if rng.uniform() < 0.5 and radius > 2.5 * size:
            bore = radius - size * rng.choice([1.0, 1.5, 2.0])
            shape = shape - Cylinder(radius=bore, height=height, base=tuple(center), axis=axis)
        yield shape, size, True


def test_round_bodies_are_symmetric_wherever_they_lie():
    tried = 0
    for shape, size, _ in rounds(4):
        voxels = voxelize(shape, size)
        assert is_symmetric(voxels.array) == [True, True, True], (shape, size)
        tried += 1
    assert tried == 60


@pytest.mark.parametrize("unit", UNITS)
def test_round_stl_bodies_are_symmetric(unit: str, tmp_path: Path):
    rng = np.random.default_rng(5)
    for index in range(12):
        size = SIZES[index % 3]
        # 32 sides: mirror images across x, y and z.
        mesh = trimesh.creation.cylinder(
            radius=size * rng.uniform(2.0, 6.0), height=size * rng.uniform(2.0, 8.0), sections=32
        )
        mesh.apply_translation(size * rng.uniform(-3, 3, 3))
        shape = from_stl(mesh, unit, tmp_path / f"{index}.stl")
        assert is_symmetric(voxelize(shape, size).array) == [True, True, True]


def test_hollow_boxes_are_exact_with_their_chamber():
    rng = np.random.default_rng(6)
    for index in range(60):
        size = SIZES[index % 3]
        corner = size * rng.choice([0.0, 0.5, rng.uniform()], 3)
        wall, room = rng.integers(1, 4), rng.integers(1, 6, 3)
        outer = Box(size=tuple(size * (room + 2 * wall)), corner=tuple(corner))
        inner = Box(size=tuple(size * room), corner=tuple(corner + size * wall))
        voxels = voxelize(outer - inner, size)
        assert voxels.count == math.prod((room + 2 * wall).tolist()) - math.prod(room.tolist())
        (cavity,) = voxels.cavities
        assert cavity.volume == pytest.approx(math.prod(room.tolist()) * size**3, rel=1e-9)


def test_parts_that_meet_on_centers_leave_no_gap():
    for middle in ("11 mm", "10 mm", "10.3 mm"):
        design = vs.Design.model_validate(
            {
                "schema": "voxsoft/1",
                "name": "two",
                "voxel_size": "2 mm",
                "shapes": {
                    "left": {"kind": "box", "size": [middle, "6 mm", "6 mm"]},
                    "right": {
                        "kind": "box",
                        "size": ["10 mm", "6 mm", "6 mm"],
                        "corner": [middle, 0, 0],
                    },
                },
                "parts": [
                    {"shape": "left", "material": "ecoflex-00-30"},
                    {"shape": "right", "material": "dragon-skin-20"},
                ],
            }
        )
        voxels = voxels_of(design)
        assert len(voxels.components("face")) == 1


def test_a_body_of_fractions_lies_on_its_faces_too():
    rod = {
        "schema": "voxsoft/1",
        "name": "rod",
        "voxel_size": "2 mm",
        "fill": "fraction",
        "shapes": {
            "rod": {
                "kind": "box",
                "size": ["30 mm", "6 mm", "6 mm"],
                "corner": [0, "-3 mm", "-3 mm"],
            }
        },
        "parts": [{"shape": "rod", "material": "ecoflex-00-30"}],
    }
    mesh = mesh_of(vs.Design.model_validate(rod))
    # The small cubes at the eight corners, cut by one plane each, miss 3e-4 of a cell.
    assert mesh.volume == pytest.approx(30e-3 * 6e-3 * 6e-3, rel=8 * 4e-4 / 135)
    assert mesh.vertices[:, 1].min() == pytest.approx(-3e-3, abs=1e-12)
