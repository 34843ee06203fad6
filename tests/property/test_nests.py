"""Nests of closed shells, in any order and sense: material where the innermost shell says so."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from voxsoft.shapes.nesting import Nested, unnested

#: A sphere of triangles lies between this part of its radius and the whole.
_ROUND = 0.97


@dataclass
class Shell:
    """A cube or a ball of half width r with its sense, its parent's number, depth and root."""

    center: NDArray[np.float64]
    half: float
    is_ball: bool
    sense: int
    parent: int
    depth: int
    root: int

    def surface(self) -> trimesh.Trimesh:
        """Its triangles, turned by its sense."""
        if self.is_ball:
            found = trimesh.creation.icosphere(2, self.half)
        else:
            found = trimesh.creation.box([2 * self.half] * 3)
        found.apply_translation(self.center)
        if self.sense < 0:
            found.invert()
        return found

    def holds(self, places: NDArray[np.float64], part: float = 1.0) -> NDArray[np.bool_]:
        """Which places are within it, made smaller by a part."""
        away = np.abs(places - self.center)
        if self.is_ball:
            return np.linalg.norm(away, axis=1) < part * self.half
        return away.max(axis=1) < self.half


def nest(rng: np.random.Generator) -> list[Shell]:
    """One to three bodies side by side, each with shells in shells up to four deep."""
    shells: list[Shell] = []

    def add(center: NDArray[np.float64], half: float, parent: int, depth: int, root: int) -> None:
        number = len(shells)
        root = number if root < 0 else root
        is_ball = bool(rng.integers(2))
        shells.append(Shell(center, half, is_ball, int(rng.choice([-1, 1])), parent, depth, root))
        if depth == 4:
            return
        # The largest cube within a ball has 1/√3 of its radius as half its width.
        room = half * (_ROUND / np.sqrt(3.0) if is_ball else 1.0)
        children = int(rng.integers(0, 3))
        for index in range(children):
            own = 0.9 * room / children * rng.uniform(0.6, 1.0)
            shift = np.zeros(3)
            shift[0] = (index + 0.5) * 2 * room / children - room if children > 1 else 0.0
            add(center + shift, own, number, depth + 1, root)

    for body in range(int(rng.integers(1, 4))):
        add(np.array([3.0 * body, 0.0, 0.0]), 1.0, -1, 0, -1)
    return shells


@pytest.mark.parametrize("nested", [None, "void"])
@pytest.mark.parametrize(
    "seed", [pytest.param(n, marks=[pytest.mark.slow] * (n >= 4)) for n in range(12)]
)
def test_the_innermost_shell_decides(seed: int, nested: Nested | None):
    import igl

    rng = np.random.default_rng(seed)
    shells = nest(rng)
    order = rng.permutation(len(shells))
    surface = trimesh.util.concatenate([shells[number].surface() for number in order])
    triangles, found = unnested(
        np.asarray(surface.vertices), np.asarray(surface.faces, dtype=np.int64), nested
    )
    places = rng.uniform([-1.1] * 3, [7.1, 1.1, 1.1], (4000, 3))
    near = np.zeros(len(places), dtype=bool)
    innermost = np.full(len(places), -1)
    for number, shell in enumerate(shells):  # parents come before their children
        near |= shell.holds(places) != shell.holds(places, _ROUND)
        innermost[shell.holds(places)] = number
    solid = np.array(
        [
            shell.depth % 2 == 0 if nested else shell.sense == shells[shell.root].sense
            for shell in shells
        ]
    )
    expected = (innermost >= 0) & solid[innermost]
    wound = igl.winding_number(
        np.asarray(surface.vertices), triangles, np.ascontiguousarray(places[~near])
    )
    # The exact sum of angles: one in material, zero elsewhere, up to rounding.
    np.testing.assert_allclose(wound, expected[~near], atol=1e-9)
    by_sense = [shell.sense == shells[shell.root].sense for shell in shells]
    alike = [
        shell.parent >= 0 and by_sense[number] == by_sense[shell.parent]
        for number, shell in enumerate(shells)
    ]
    assert (found.shells, found.alike) == (len(shells), sum(alike))
