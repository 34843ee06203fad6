"""Motion of the material around a probe: rotation, rates, strain, as small instruments see them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from voxsoft.mesh import Mesh
from voxsoft.metrics import Place

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LocalMotion:
    """Motion at a place: means over the voxels that have a vertex of the probe.

    Attributes
    ----------
    velocity
        Velocity along the axes of the design, m/s, (3,).
    rotation
        Rotation of the material from the unloaded design, (3, 3): the columns are its own axes.
    rate
        Angular velocity along its own axes, rad/s, (3,): the reading of a gyroscope.
    acceleration
        Mean acceleration over the last step less gravity, along its own axes, m/s², (3,): the
        reading of an accelerometer, which at rest is 9.81 m/s² upward.
    strain
        Green–Lagrange strain along the axes of the design: xx, yy, zz, xy, yz, zx, (6,).
    """

    velocity: Floats
    rotation: Floats
    rate: Floats
    acceleration: Floats
    strain: Floats


@dataclass(frozen=True, eq=False)
class Patch:
    """The vertices around a probe, by which its motion is fitted.

    Attributes
    ----------
    vertices
        Their indices, (k,).
    rest
        Their unloaded positions less the mean, m, (k, 3).
    """

    vertices: NDArray[np.int64]
    rest: Floats

    @classmethod
    def around(cls, place: Place, mesh: Mesh) -> Patch:
        """Take all vertices of the voxels, or tetrahedra, that have a vertex of the probe."""
        marked = np.zeros(len(mesh.vertices), dtype=bool)
        marked[place.vertices[place.weights != 0.0]] = True
        near = marked[mesh.tets].any(axis=1)
        if mesh.voxel_size is not None:
            near = np.repeat(near.reshape(-1, 5).any(axis=1), 5)
        vertices = np.unique(mesh.tets[near]).astype(np.int64)
        rest = mesh.vertices[vertices]
        return cls(vertices, rest - rest.mean(axis=0))

    def motion(
        self,
        positions: Floats,
        velocities: Floats,
        before: Floats | None,
        step: float,
        pull: Floats,
    ) -> LocalMotion:
        """Fit the motion.

        Parameters
        ----------
        positions, velocities
            All vertices, (n, 3), m and m/s.
        before
            Velocities a step ago; None without one.
        step
            Length of the step in s.
        pull
            Acceleration by gravity, m/s², (3,).
        """
        now, speeds = positions[self.vertices], velocities[self.vertices]
        arms, velocity = now - now.mean(axis=0), speeds.mean(axis=0)
        moments = self.rest.T @ self.rest
        gradient = np.linalg.solve(moments, self.rest.T @ arms).T
        left, _, right = np.linalg.svd(gradient)
        flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
        rotation = left @ flip @ right
        inertia = (arms**2).sum() * np.eye(3) - arms.T @ arms
        turning = np.linalg.solve(inertia, np.cross(arms, speeds - velocity).sum(axis=0))
        last = velocity if before is None else before[self.vertices].mean(axis=0)
        felt = (velocity - last) / step - pull
        green = 0.5 * (gradient.T @ gradient - np.eye(3))
        strain = green[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]
        return LocalMotion(velocity, rotation, rotation.T @ turning, rotation.T @ felt, strain)
