"""The judges of contact: which faces of a body and of its objects pass through each other.

They are the exact predicates of ``voxsoft._core.penetration`` and ``ipctk``, the toolkit of
another group, which share no line with contact or with each other. Faces are those of the surfaces
that touch.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.simulation import Setup
from voxsoft.simulation.checks.crossed_surfaces import are_apart

#: Faces nearer than this on the unloaded body, in voxels, are a fold of the surface or the two
#: sides of a crease, which follow voxels that are crushed: contact does not look at neighbors.
FOLD = 1.5

Floats = NDArray[np.float64]
Triangles = NDArray[np.int32]


@dataclass(frozen=True)
class Faces:
    """The faces that must not pass through each other: the body's skin, then those of the plates.

    Attributes
    ----------
    setup
        The design made ready.
    """

    setup: Setup

    @cached_property
    def skin(self) -> _core.Skin:
        """The surface of the body."""
        touching = self.setup.touching
        assert touching is not None  # the design has contact
        (skin,) = touching.skins
        assert skin is not None  # the body touches with it
        return skin

    @cached_property
    def triangles(self) -> Triangles:
        """Of all points, (t, 3)."""
        found, first = [self.skin.triangles], len(self.skin.points)
        for surface in self._plates:
            found.append(surface.triangles + np.uint32(first))
            first += len(surface.vertices)
        return np.concatenate(found).astype(np.int32)

    @cached_property
    def _plates(self) -> tuple[Any, ...]:
        assert self.setup.touching is not None
        return self.setup.touching.surfaces

    def at(self, positions: Floats, factor: float) -> Floats:
        """All points [m], (p, 3), where the upper plate has gone this part of its way."""
        points = [self.skin.at(positions)]
        for each, surface in zip(self.setup.design.objects, self._plates, strict=True):
            way = np.zeros(3) if each.way is None else factor * np.array(each.way.displacement)
            points.append(surface.vertices + way)
        return np.concatenate(points)

    def crossings(self, points: Floats) -> tuple[int, int, int, float]:
        """Pairs of faces that pass through each other, by exact predicates.

        Returns
        -------
        met, plates, folded, depth
            How many of them contact must keep apart, how many of those are with a plate, how many
            are folds, and how deep any are at least [m].
        """
        none = np.zeros((0, 4), dtype=np.int32)
        pairs, found, _ = _core.penetration(points, points, none, none[:, :3], self.triangles)
        deep = max((depth for depth, *_ in found), default=0.0)
        if not len(pairs):
            return 0, 0, 0, deep
        plate = (self.triangles[pairs] >= len(self.skin.points)).any(axis=(1, 2))
        distance = FOLD * self.setup.design.voxel_size
        far = are_apart(self._rest, self.triangles, pairs, distance)
        met = int((plate | far).sum())
        return met, int(plate.sum()), len(pairs) - met, deep

    @cached_property
    def _rest(self) -> Floats:
        return self.at(self.setup.mesh.vertices, 0.0)

    @cached_property
    def _outside_mesh(self) -> Any:
        import ipctk

        return ipctk.CollisionMesh(self._rest, ipctk.edges(self.triangles), self.triangles)

    def crosses_by_ipctk(self, points: Floats) -> bool:
        """Whether any faces pass through each other, as the toolkit of another group finds."""
        import ipctk

        return bool(ipctk.has_intersections(self._outside_mesh, points))
