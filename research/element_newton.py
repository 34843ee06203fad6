"""A small Newton solver for voxel bodies under gravity and cavity pressure (see `elements.py`)."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from element_energies import CORNERS, MODES, Element
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array
from scipy.sparse.linalg import splu

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CHUNK = 128


@dataclass
class Body:
    """Voxels of one material, their corners, what is held and what pulls.

    Lengths in m, forces in N; `vertices` (n, 3), `cells` (m, 8), `held` (n, 3) marks the degrees
    of freedom that keep the value they are given, `force` (n, 3) is a dead load, `faces` (k, 4)
    are the quadrilaterals, seen counterclockwise from the solid, under `pressure` in Pa.
    """

    h: float
    vertices: Floats
    cells: Ints
    parity: Ints
    material: Floats
    held: NDArray[np.bool_]
    force: Floats
    faces: Ints = field(default_factory=lambda: np.zeros((0, 4), dtype=np.int64))
    pressure: float = 0.0


class NotConverged(RuntimeError):
    """Newton found no equilibrium."""


@functools.lru_cache
def kernel(element: Element) -> Callable[..., Any]:
    """Energy, gradient and Hessian of a chunk of voxels in the 21 modes and the inner unknowns."""

    def energy(u: jax.Array, material: jax.Array, parity: jax.Array) -> jax.Array:
        return element.energy(u[:21].reshape(7, 3), u[21:], material, parity)

    def all_of(u: jax.Array, material: jax.Array, parity: jax.Array) -> tuple[jax.Array, ...]:
        value, slope = jax.value_and_grad(energy)(u, material, parity)
        return value, slope, jax.hessian(energy)(u, material, parity)

    return jax.jit(jax.vmap(all_of, in_axes=(0, None, 0)))


@functools.lru_cache
def _energies(element: Element) -> Callable[..., Any]:
    def energy(u: jax.Array, material: jax.Array, parity: jax.Array) -> jax.Array:
        return element.energy(u[:21].reshape(7, 3), u[21:], material, parity)

    return jax.jit(jax.vmap(energy, in_axes=(0, None, 0)))


def _enclosed(x: jax.Array) -> jax.Array:
    """Volume between the origin and a bilinear face, positive if it turns away from the origin."""
    a, b, c, d = x
    total = jnp.zeros(())
    for s in (-1 / np.sqrt(3), 1 / np.sqrt(3)):
        for t in (-1 / np.sqrt(3), 1 / np.sqrt(3)):
            p = ((1 - s) * (1 - t) * a + (1 + s) * (1 - t) * b) / 4
            p += ((1 + s) * (1 + t) * c + (1 - s) * (1 + t) * d) / 4
            ps = (-(1 - t) * a + (1 - t) * b + (1 + t) * c - (1 + t) * d) / 4
            pt = (-(1 - s) * a - (1 + s) * b + (1 + s) * c + (1 - s) * d) / 4
            total += jnp.dot(p, jnp.cross(ps, pt)) / 3
    return total


_face = jax.jit(
    jax.vmap(lambda x: (_enclosed(x), jax.grad(_enclosed)(x), jax.hessian(_enclosed)(x)))
)


def chunks(
    call: Callable[..., Any], u: Floats, material: Floats, parity: Ints
) -> list[NDArray[Any]]:
    """Run a compiled kernel over chunks of one size, so that it compiles once."""
    count = len(u)
    padded = -(-count // CHUNK) * CHUNK
    index = np.minimum(np.arange(padded), count - 1)
    parts = []
    for start in range(0, padded, CHUNK):
        take = index[start : start + CHUNK]
        result = call(u[take], material, parity[take])
        parts.append(result if isinstance(result, tuple) else (result,))
    return [np.concatenate([np.asarray(p[i]) for p in parts])[:count] for i in range(len(parts[0]))]


def modes(body: Body, x: Floats) -> Floats:
    """The 21 modes of every voxel, (m, 21)."""
    found: Floats = np.einsum("an,mni->mai", MODES / body.h, x[body.cells]).reshape(-1, 21)
    return found


#: Corner positions in units of h to the 21 modes, (21, 24).
TO_MODES = np.einsum("an,ij->ainj", MODES, np.eye(3)).reshape(21, 24)


class Solver:
    """Equilibria of one body with one element; keeps positions and inner unknowns between calls."""

    def __init__(self, element: Element, body: Body) -> None:
        self.element, self.body = element, body
        self.x = body.vertices.copy()
        self.z = np.zeros((len(body.cells), element.inner))
        self.iterations = 0
        self._free = np.flatnonzero(~body.held.ravel())

    def _potential(self, x: Floats, z: Floats, load: float) -> float:
        body = self.body
        u = np.hstack([modes(body, x), z])
        (value,) = chunks(_energies(self.element), u, body.material, body.parity)
        total = float(value.sum()) * body.h**3 - load * float(np.sum(body.force * x))
        if len(body.faces):
            total -= load * body.pressure * float(np.sum(_face(x[body.faces])[0]))
        return total

    def system(self, load: float) -> tuple[float, Floats, csc_array, list[Floats]]:
        """Potential energy, gradient (3n,), condensed Hessian and what recovers the inner step."""
        body = self.body
        u = np.hstack([modes(body, self.x), self.z])
        value, slope, hess = chunks(kernel(self.element), u, body.material, body.parity)
        volume = body.h**3
        total = float(value.sum()) * volume - load * float(np.sum(body.force * self.x))
        inner: list[Floats] = []
        rg, kg = slope[:, :21], hess[:, :21, :21]
        if self.element.inner:
            kz = np.linalg.solve(
                hess[:, 21:, 21:],
                np.concatenate([slope[:, 21:, None], hess[:, 21:, :21]], axis=2),
            )
            inner = [kz[:, :, 0], kz[:, :, 1:]]
            rg = rg - np.einsum("mij,mj->mi", hess[:, :21, 21:], inner[0])
            kg = kg - hess[:, :21, 21:] @ inner[1]
        b = TO_MODES / body.h
        forces = volume * rg @ b
        blocks = volume * (b.T @ kg @ b)
        dofs = (3 * body.cells[:, :, None] + np.arange(3)).reshape(len(body.cells), 24)
        residual = -load * body.force.ravel()
        np.add.at(residual, dofs, forces)
        rows = [np.repeat(dofs, 24, axis=1).ravel()]
        cols = [np.tile(dofs, (1, 24)).ravel()]
        data = [blocks.ravel()]
        if len(body.faces):
            enclosed, push, turn = (np.asarray(part) for part in _face(self.x[body.faces]))
            total -= load * body.pressure * float(enclosed.sum())
            dofs = (3 * body.faces[:, :, None] + np.arange(3)).reshape(-1, 12)
            np.add.at(residual, dofs, -load * body.pressure * push.reshape(-1, 12))
            rows.append(np.repeat(dofs, 12, axis=1).ravel())
            cols.append(np.tile(dofs, (1, 12)).ravel())
            data.append((-load * body.pressure * turn).ravel())
        size = self.x.size
        index = (np.concatenate(rows), np.concatenate(cols))
        matrix = coo_array((np.concatenate(data), index), shape=(size, size)).tocsc()
        return total, residual, matrix, inner

    def tangent(self, load: float) -> csc_array:
        """Condensed Hessian of the degrees of freedom that are free."""
        return self.system(load)[2][self._free][:, self._free]

    def newton(self, load: float, tolerance: float = 1e-9, limit: int = 40) -> None:
        """Find the equilibrium under a share of the load.

        The largest residual of a corner is to fall below `tolerance` of the largest load of a
        corner; K times the precision of a position over h is noise.
        """
        body, free = self.body, self._free
        scale = max(
            float(np.abs(body.force).max()),
            body.pressure * body.h**2,
            1e-6 * float(body.material[0]) * body.h**2,
        )
        noise = 1e-15 * float(np.ptp(body.vertices)) / body.h
        enough = tolerance * scale + 2 * noise * float(body.material[1]) * body.h**2

        last = np.inf
        for _ in range(limit):
            total, residual, matrix, inner = self.system(load)
            norm = float(np.abs(residual[free]).max())
            if norm < enough or (norm < 1e-6 * scale and norm > 0.3 * last):
                return
            last = norm
            self.iterations += 1
            step = np.zeros(self.x.size)
            reduced = matrix[free][:, free]
            factor = splu(
                reduced,
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
            step[free] = factor.solve(-residual[free])
            move = step.reshape(-1, 3)
            shift = np.zeros_like(self.z)
            if inner:
                change = modes(body, move)
                shift = -inner[0] - np.einsum("mij,mj->mi", inner[1], change)
            slope = float(residual @ step)
            length = 1.0
            while True:
                x, z = self.x + length * move, self.z + length * shift
                new = self._potential(x, z, load)
                small = abs(length * slope) < 1e-10 * abs(total)
                if new <= total + 1e-4 * length * min(slope, 0.0) or (np.isfinite(new) and small):
                    break
                length /= 2
                if length < 1e-6:
                    raise NotConverged("the line search found no lower energy")
            self.x, self.z = x, z
        raise NotConverged(f"{limit} steps did not bring the residual down")

    def solve(self, steps: int = 1) -> Floats:
        """Apply the load in steps, halved where Newton fails; displacements (n, 3) in m."""
        done, width = 0.0, 1.0 / steps
        while done < 1.0 - 1e-12:
            keep = self.x.copy(), self.z.copy()
            target = min(1.0, done + width)
            try:
                self.newton(target)
            except NotConverged:
                self.x, self.z = keep
                width /= 2
                if width < 1e-3:
                    raise
                continue
            done = target
        return self.x - self.body.vertices


def body_of(inside: NDArray[np.bool_], h: float, material: Floats) -> Body:
    """A free body of the voxels that are `True` in a grid (nx, ny, nz)."""
    where = np.argwhere(inside)
    shape = np.array(inside.shape) + 1
    corner = where[:, None, :] + ((CORNERS + 1) / 2).astype(np.int64)
    keys = np.ravel_multi_index(tuple(np.moveaxis(corner, -1, 0)), tuple(shape))
    unique, cells = np.unique(keys, return_inverse=True)
    vertices = np.stack(np.unravel_index(unique, tuple(shape)), axis=1) * h
    return Body(
        h=h,
        vertices=vertices.astype(np.float64),
        cells=cells.reshape(-1, 8).astype(np.int64),
        parity=where.sum(axis=1) % 2,
        material=material,
        held=np.zeros((len(unique), 3), dtype=bool),
        force=np.zeros((len(unique), 3)),
    )


#: Corners of the six faces, counterclockwise seen from outside, by (axis, side).
_QUADS = {
    (0, 0): (0, 1, 3, 2),
    (0, 1): (4, 6, 7, 5),
    (1, 0): (0, 4, 5, 1),
    (1, 1): (2, 3, 7, 6),
    (2, 0): (0, 2, 6, 4),
    (2, 1): (1, 5, 7, 3),
}


def faces_toward(body: Body, inside: NDArray[np.bool_], cavity: NDArray[np.bool_]) -> Ints:
    """Faces of the solid that look into the cells of `cavity`, seen from the solid side, (k, 4).

    Their order makes the enclosed volume of the cavity positive.
    """
    where = np.argwhere(inside)
    padded = np.pad(cavity, 1)
    quads = []
    for (axis, side), corners in _QUADS.items():
        step = np.zeros(3, dtype=np.int64)
        step[axis] = 2 * side - 1
        beside = where + 1 + step
        hit = padded[tuple(beside.T)]
        quads.append(body.cells[hit][:, corners[::-1]])
    return np.concatenate(quads)
