"""A user's solver with scikit-fem: mixed bricks (Q2 displacements, Q1 pressure), Newton's method.

Written as its examples write hyperelasticity, with its assembly and SciPy's direct solver, and with
all that a careful user would add: steps of the load with extrapolation, and the tangent of a
pressure that follows. It has none of the code of `voxsoft.comparison.scikit_fem`, which takes from
scikit-fem only shape functions, and bricks that are all the same cube.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import peer_bodies
import skfem
from peer_bodies import BAR_LENGTH, BEAM_LENGTH, CORNERS, DENSITY, INNER, POISSON, SIDE, YOUNG
from scipy.sparse import bmat
from scipy.sparse.linalg import splu
from skfem.helpers import ddot, det, grad, identity, inv, mul, transpose

from voxsoft.units import mm

SHEAR = YOUNG / (2 * (1 + POISSON))
BULK = YOUNG / (3 * (1 - 2 * POISSON))
GRAVITY = 9.80665
#: First step of the load, and what a failed one is divided by.
FIRST_STEP, CUT = 0.25, 4.0
ITERATIONS = 12


class Problem(NamedTuple):
    """What a body adds to its mesh.

    `held` are degrees of freedom of the displacement, `values` gives what they come to at a share
    of the load, `loads` the forces and the stiffness of loads, `number` what is looked at.
    """

    displacement: Any
    pressure: Any
    held: np.ndarray
    values: Callable[[float], np.ndarray]
    loads: Callable[[np.ndarray, float], tuple[np.ndarray, Any]]
    number: Callable[[np.ndarray, np.ndarray], np.ndarray]


@skfem.BilinearForm
def _stiffness(u, v, w):
    return ddot(np.einsum("ijkl...,kl...->ij...", w["tangent"], grad(u)), grad(v))


@skfem.BilinearForm
def _coupling(u, q, w):
    return q * w["J"] * ddot(w["turn"], grad(u))


@skfem.BilinearForm
def _softness(p, q, w):
    return p * q / BULK


@skfem.LinearForm
def _forces(v, w):
    return ddot(w["stress"], grad(v))


@skfem.LinearForm
def _volumes(q, w):
    return (w["J"] - 1 - w["p"] / BULK) * q


@skfem.LinearForm
def _weight(v, w):
    return -DENSITY * GRAVITY * v[2]


@skfem.LinearForm
def _push(v, w):
    """A pressure of 1 Pa on the faces, as they are now."""
    cofactor = w["J"] * w["turn"]
    return -ddot(cofactor, v[:, None] * w.n[None, :])


@skfem.BilinearForm
def _push_stiffness(u, v, w):
    turn, J, H = w["turn"], w["J"], grad(u)
    change = J * (ddot(turn, H) * turn - mul(turn, mul(transpose(H), turn)))
    return -ddot(change, v[:, None] * w.n[None, :])


def _strains(basis: Any, moved: np.ndarray) -> dict[str, Any]:
    """Deformation gradient, its inverse transposed, and its determinant at the points."""
    H = grad(basis.interpolate(moved))
    F = H + identity(H)
    return {"F": F, "turn": transpose(inv(F)), "J": det(F)}


def _stresses(F: Any, turn: Any, J: Any, p: Any) -> dict[str, Any]:
    """First Piola stress, and its derivative by the deformation gradient, at the points.

    Both are evaluated once, as a form is called for each pair of shape functions.
    """
    scale, squares = SHEAR * J ** (-2 / 3), ddot(F, F)
    outer = "ij...,kl...->ijkl..."
    both = np.einsum(outer, turn, turn)
    crossed = np.einsum("il...,kj...->ijkl...", turn, turn)
    eye = np.einsum("ik,jl->ijkl", np.eye(3), np.eye(3))[..., None, None]
    mixed = np.einsum(outer, turn, F) + np.einsum(outer, F, turn)
    isochoric = eye - 2 / 3 * mixed + 2 / 9 * squares * both + squares / 3 * crossed
    return {
        "stress": scale * (F - squares / 3 * turn) + p * J * turn,
        "tangent": scale * isochoric + p * J * (both - crossed),
    }


def _no_load(moved: np.ndarray, share: float) -> tuple[float, float]:
    return 0.0, 0.0


def _bases(mesh: Any, mapped: bool) -> tuple[Any, Any]:
    element = skfem.ElementVector(skfem.ElementHex2())
    displacement = skfem.Basis(mesh, element, intorder=4 if not mapped else 5)
    return displacement, displacement.with_element(skfem.ElementHex1())


def _grid(length: float, across: int) -> Any:
    along = np.linspace(0, length, round(length / SIDE) * across + 1)
    side = np.linspace(0, SIDE, across + 1)
    return skfem.MeshHex.init_tensor(along, side, side)


def beam(across: int) -> Problem:
    """The beam, with so many bricks across."""
    u, p = _bases(_grid(BEAM_LENGTH, across), False)
    held = np.flatnonzero(u.doflocs[0] < 10 * mm + 1e-9)
    weight = _weight.assemble(u)
    middle = np.array([BEAM_LENGTH, SIDE / 2, SIDE / 2])
    tip = np.flatnonzero(np.linalg.norm(u.doflocs - middle[:, None], axis=0) < 1e-9)
    return Problem(
        u,
        p,
        held,
        lambda share: np.zeros(len(held)),
        lambda moved, share: (share * weight, 0.0),
        lambda moved, inner: moved[tip],
    )


def twisted_bar(across: int) -> Problem:
    """The bar, with so many bricks across."""
    u, p = _bases(_grid(BAR_LENGTH, across), False)
    near = np.flatnonzero(u.doflocs[0] < 1e-9)
    far = np.flatnonzero(u.doflocs[0] > BAR_LENGTH - 1e-9)
    # The three components of a node follow each other.
    points = u.doflocs[:, far[::3]].T

    def values(share: float) -> np.ndarray:
        there = peer_bodies.turned(points, share * peer_bodies.TWIST) - points
        return np.concatenate((np.zeros(len(near)), there.ravel()))

    def number(moved: np.ndarray, inner: np.ndarray) -> np.ndarray:
        return peer_bodies.torque(points + moved[far].reshape(-1, 3), inner[far].reshape(-1, 3))

    return Problem(u, p, np.concatenate((near, far)), values, _no_load, number)


def thick_sphere(wall: int) -> Problem:
    """An eighth of the sphere, with so many bricks through its wall, as many along an edge."""
    points, bricks = peer_bodies.cube_shell(wall, wall)
    flat = skfem.MeshHex(points.T.copy(), _own_order(bricks).T.copy())
    curved = skfem.MeshHex2.from_mesh(flat)
    mesh = skfem.MeshHex2(
        doflocs=np.ascontiguousarray(peer_bodies.to_sphere(curved.doflocs.T).T), t=curved.t
    )
    u, p = _bases(mesh, True)
    inside = flat.facets_satisfying(
        lambda x: np.isclose(x.max(axis=0), INNER), boundaries_only=True
    )
    faces = skfem.FacetBasis(mesh, u.elem, facets=inside, intorder=5)
    held = np.concatenate(
        [
            dofs.all([f"u^{axis + 1}"])
            for axis in range(3)
            for dofs in [
                u.get_dofs(flat.facets_satisfying(lambda x, a=axis: np.isclose(x[a], 0.0)))
            ]
        ]
    )

    def loads(moved: np.ndarray, share: float) -> tuple[np.ndarray, Any]:
        strains = _strains(faces, moved)
        load = share * peer_bodies.PRESSURE
        # The normal of the faces points out of the wall: into the room.
        return (
            load * _push.assemble(faces, **strains),
            load * _push_stiffness.assemble(faces, **strains),
        )

    def number(moved: np.ndarray, inner: np.ndarray) -> np.ndarray:
        return 8 * np.array([_room(faces, moved) - _room(faces, np.zeros_like(moved))])

    return Problem(u, p, held, lambda share: np.zeros(len(held)), loads, number)


@skfem.Functional
def _flux(w):
    """A third of the flux of the place through the faces as they are: the room's volume."""
    cofactor = w["J"] * w["turn"]
    return -ddot(cofactor, (w.x + w["u"])[:, None] * w.n[None, :]) / 3


def _room(faces: Any, moved: np.ndarray) -> float:
    return float(_flux.assemble(faces, u=faces.interpolate(moved).value, **_strains(faces, moved)))


def _own_order(bricks: np.ndarray) -> np.ndarray:
    """Corners of bricks in the order of scikit-fem."""
    ours = np.array(CORNERS, dtype=float)
    theirs = skfem.MeshHex.init_refdom().p.T
    return bricks[:, [int(np.flatnonzero((ours == each).all(axis=1))[0]) for each in theirs]]


def solve(problem: Problem, tolerance: float) -> tuple[np.ndarray, float]:
    """The number at rest, and the processor seconds it took, assembly included."""
    start = time.process_time()
    u, p = problem.displacement, problem.pressure
    count = u.N
    free = np.setdiff1d(np.arange(count + p.N), problem.held)
    state = np.zeros(count + p.N)
    softness = _softness.assemble(p)
    reached, step, last = 0.0, FIRST_STEP, None
    inner = np.zeros(count)
    while reached < 1.0:
        share = min(reached + step, 1.0)
        guess = state.copy()
        if last is not None:
            guess += (state - last[1]) * (share - reached) / (reached - last[0])
        guess[problem.held] = problem.values(share)
        found = None
        for _ in range(ITERATIONS):
            strains = _strains(u, guess[:count])
            if np.min(strains["J"]) <= 0:
                break
            pressure = p.interpolate(guess[count:]).value
            stresses = _stresses(**strains, p=pressure)
            inner = _forces.assemble(u, stress=stresses["stress"])
            load, follow = problem.loads(guess[:count], share)
            residual = np.concatenate(
                (inner - load, _volumes.assemble(p, J=strains["J"], p=pressure))
            )
            acting = max(np.linalg.norm(np.asarray(load)), np.linalg.norm(inner))
            if np.linalg.norm(residual[:count][free[free < count]]) <= tolerance * acting:
                found = guess
                break
            coupling = _coupling.assemble(u, p, J=strains["J"], turn=strains["turn"])
            stiffness = _stiffness.assemble(u, tangent=stresses["tangent"]) - follow
            system = bmat([[stiffness, coupling.T], [coupling, -softness]], "csc")
            guess = guess + _correction(system, residual, free)
        if found is None:
            step, last = step / CUT, None
            if step < 1e-3:
                raise SystemExit(f"scikit-fem found no equilibrium past {reached:.0%}")
            continue
        last, state, reached = (reached, state), found, share
    number = problem.number(state[:count], inner)
    return number, time.process_time() - start


def _correction(system: Any, residual: np.ndarray, free: np.ndarray) -> np.ndarray:
    step = np.zeros(len(residual))
    step[free] = splu(system[free][:, free].tocsc()).solve(-residual[free])
    return step
