"""Outside code from pip alone: mixed bricks with shape functions and numbering of scikit-fem.

Displacements are triquadratic (27 nodes), the pressure is linear and discontinuous, a pair that
neither locks in volume nor checkers (Boffi, Brezzi and Fortin 2013, doi
10.1007/978-3-642-36519-5, section 8.6.3). As the pressure belongs to one brick, it is eliminated
there: the volumetric energy is ``K/2 ∫ (Π(J - 1))²`` with the projection Π on linear functions.
All bricks are the same cube, so that shape functions are evaluated once. Newton's method with
steps of the load that grow and back off; pressure follows the faces, its stiffness included.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import PackageNotFoundError, version
from itertools import product
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.comparison.bricks import CORNERS, FACES, BrickModel
from voxsoft.comparison.outside import OutsideAnswer, rubber, support_forces
from voxsoft.comparison.stretch_energy import Term, stretch_derivatives, terms_of
from voxsoft.design.contact import FLOOR
from voxsoft.errors import MissingPackageError, OutsideCodeError, SimulationError
from voxsoft.simulation.compatibility import REASONS

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Largest residual force, relative to the forces that act.
TOLERANCE: Final = 1e-8
_ITERATIONS = 15
_FIRST_STEP, _SMALLEST_STEP = 0.5, 1e-3
_CHUNK = 128
# A prescribed displacement is met when it is this share of an edge away: rounding.
_CLOSE = 1e-12
# Newton's first steps in thin walls raise the residual a good deal before it falls.
_GROWTH, _SHORTEST = 100.0, 1e-2


def run_scikit_fem(model: BrickModel, *, time_limit: float = 600.0) -> OutsideAnswer:
    """Solve a problem on 27-node bricks by Newton's method.

    Parameters
    ----------
    model
        The problem, on bricks of 27 nodes.
    time_limit
        Seconds after which it gives up.

    Returns
    -------
    OutsideAnswer
        The answer, at the last equilibrium where the whole load was not reached.

    Raises
    ------
    MissingPackageError
        scikit-fem is not installed.
    OutsideCodeError
        It took longer than the limit.
    SimulationError
        A material that is not hyperelastic, layers, contact, or a floor.
    """
    release = scikit_fem_version()
    if model.layers:
        raise SimulationError("layers", *REASONS["layers", "scikit-fem"])
    if model.contact is not None and any(tool.name == FLOOR for tool in model.contact.tools):
        raise SimulationError("floor", *REASONS["floor", "scikit-fem"])
    if model.contact is not None:
        raise SimulationError("contact", *REASONS["contact", "scikit-fem"])
    started = time.perf_counter()
    bricks = _Bricks(model)
    reached, moved = _follow(bricks, started + time_limit, time_limit)
    inner, _ = bricks.elastic(moved, tangent=False)
    held = np.flatnonzero(model.fixed.any(axis=1))
    whole = reached == 1.0
    return OutsideAnswer(
        code="scikit-fem",
        version=release,
        element="Q2-P1",
        status="ok" if whole else "not-converged",
        message=(
            "reached the whole load"
            if whole
            else f"found no equilibrium past {reached:.1%} of the load; that state is kept"
        ),
        load_factor=reached,
        displacements=moved[model.vertex_nodes],
        held=held,
        reactions=support_forces(model, held, inner[held], reached),
        unknowns=int((~model.fixed).sum()),
        seconds=time.perf_counter() - started,
    )


def scikit_fem_version() -> str:
    """Return the version of scikit-fem.

    Raises
    ------
    MissingPackageError
        It is not installed.
    """
    try:
        return version("scikit-fem")
    except PackageNotFoundError as error:
        raise MissingPackageError(
            "scikit-fem", "is not installed", "pip install scikit-fem"
        ) from error


def _follow(bricks: _Bricks, deadline: float, time_limit: float) -> tuple[float, Floats]:
    """Raise the load to the whole in steps; return the share reached, and the displacements."""
    reached, step = 0.0, _FIRST_STEP
    moved = np.zeros_like(bricks.model.nodes)
    before: tuple[float, Floats] | None = None
    while reached < 1.0:
        factor = min(reached + step, 1.0)
        guess = moved
        if before is not None:
            guess = moved + (moved - before[1]) * (factor - reached) / (reached - before[0])
        found = _equilibrium(bricks, guess, factor, deadline)
        if time.perf_counter() > deadline:
            raise OutsideCodeError(
                "scikit-fem",
                f"did not end within {time_limit:g} s; it had reached {reached:.0%} of the load",
                "allow more time (--time-limit), split voxels less, or take CalculiX",
            )
        if found is None:
            step /= 4.0
            # The extrapolation may have failed.
            before = None
            if step < _SMALLEST_STEP:
                return reached, moved
            continue
        before, moved, iterations = (reached, moved), found[0], found[1]
        reached = factor
        step *= 2.0 if iterations <= 6 else 1.0
    return reached, moved


def _equilibrium(
    bricks: _Bricks, guess: Floats, factor: float, deadline: float
) -> tuple[Floats, int] | None:
    """Find the equilibrium at one load by Newton's method, or None."""
    from scipy.sparse.linalg import splu

    model = bricks.model
    free, bound = np.flatnonzero(~model.fixed.ravel()), np.flatnonzero(model.fixed.ravel())
    target = (factor * model.values).ravel()[bound]
    moved = guess
    for iteration in range(_ITERATIONS):
        inner, stiffness = bricks.elastic(moved)
        outer, follower = bricks.loads(moved, factor)
        rest = (outer - inner).ravel()[free]
        if not np.isfinite(rest).all() or time.perf_counter() > deadline:
            return None
        gap = target - moved.ravel()[bound]
        gap[np.abs(gap) < _CLOSE * model.edge] = 0.0
        if not gap.any() and np.abs(rest).sum() <= TOLERANCE * _sum(outer, inner):
            return moved, iteration
        matrix = (stiffness - follower).tocsr()[free]
        # Equilibrium matrices need no pivots for size; a symmetric order keeps the factors small.
        factors = splu(
            matrix[:, free].tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        # Prescribed nodes move with the first correction, and the free nodes along with them.
        correction = np.zeros(moved.size)
        correction[bound] = gap
        correction[free] = factors.solve(rest - matrix[:, bound] @ gap)
        largest = np.inf if gap.any() else _GROWTH * float(np.linalg.norm(rest))
        shorter = _search(bricks, moved, correction.reshape(moved.shape), factor, free, largest)
        if shorter is None:
            return None
        moved = shorter
    return None


def _search(
    bricks: _Bricks, moved: Floats, correction: Floats, factor: float, free: Ints, largest: float
) -> Floats | None:
    """Shorten a correction until the forces left over are finite and not larger than allowed."""
    size = 1.0
    while size > _SHORTEST:
        trial: Floats = moved + size * correction
        inner, _ = bricks.elastic(trial, tangent=False)
        outer, _ = bricks.loads(trial, factor)
        left = float(np.linalg.norm((outer - inner).ravel()[free]))
        if left <= largest and np.isfinite(left):
            return trial
        size /= 2.0
    return None


def _sum(*forces: Floats) -> float:
    return float(sum(np.abs(each).sum() for each in forces))


@dataclass(eq=False)
class _Bricks:
    """Elastic forces and loads of a model, and their derivatives."""

    model: BrickModel

    def __post_init__(self) -> None:
        self.laws: list[tuple[list[Term], float]] = []
        for part, material in enumerate(self.model.materials):
            where = f"parts[{part}].material"
            name, constants, bulk = rubber(material, "the code with scikit-fem", where)
            self.laws.append((terms_of(name, constants, where), bulk))

    @cached_property
    def _volume(self) -> tuple[Floats, Floats, Floats]:
        """Gradients (q, 27, 3), weights (q,), and orthonormal linear functions (q, 4)."""
        points, weights = _gauss(3, 3)
        _, gradients = self._shapes(points)
        volume = self.model.edge**3
        linear = np.column_stack([np.ones(len(points)), np.sqrt(12) * (points - 0.5)])
        return gradients, weights * volume, linear / np.sqrt(volume)

    def _shapes(self, points: Floats) -> tuple[Floats, Floats]:
        """Shape functions (q, 27) and gradients (q, 27, 3) in the model's order of nodes."""
        import skfem

        # scikit-fem numbers the corners of a cube in its own way.
        reference = skfem.refdom.RefHex.p.T.astype(int)
        order = [CORNERS.tolist().index(corner) for corner in reference.tolist()]
        corners = self.model.edge * CORNERS[order].astype(float)
        cube: Any = skfem.MeshHex(corners.T, np.arange(8)[:, None])
        basis = skfem.Basis(cube, skfem.ElementHex2(), quadrature=(points.T, np.ones(len(points))))
        places = np.rint(2 * basis.doflocs.T / self.model.edge).astype(int).tolist()
        own = self._halves
        rank = [places.index(half) for half in own]
        local = {int(dof): index for index, dof in enumerate(basis.element_dofs[:, 0])}
        each = [basis.basis[local[dof]][0] for dof in rank]
        values = np.stack([np.broadcast_to(np.asarray(one), (1, len(points)))[0] for one in each])
        gradients = np.stack([np.asarray(one.grad)[:, 0] for one in each])
        return values.T, gradients.transpose(2, 0, 1)

    @cached_property
    def _halves(self) -> list[list[int]]:
        nodes = self.model.nodes[self.model.bricks[0]]
        low = nodes.min(axis=0)
        halves: list[list[int]] = np.rint(2 * (nodes - low) / self.model.edge).astype(int).tolist()
        return halves

    @cached_property
    def _pattern(self) -> tuple[Ints, Ints]:
        dofs = (3 * self.model.bricks[:, :, None] + np.arange(3)).reshape(
            len(self.model.bricks), 81
        )
        return np.repeat(dofs, 81, axis=1).ravel(), np.tile(dofs, (1, 81)).ravel()

    def elastic(self, moved: Floats, *, tangent: bool = True) -> tuple[Floats, Any]:
        """Inner forces in N (n, 3), and the sparse stiffness in N/m."""
        from scipy.sparse import coo_array

        forces = np.zeros_like(moved)
        blocks = np.zeros((len(self.model.bricks), 81, 81)) if tangent else None
        for part, (terms, bulk) in enumerate(self.laws):
            members = np.flatnonzero(self.model.parts == part)
            for start in range(0, len(members), _CHUNK):
                some = members[start : start + _CHUNK]
                pulled, stiff = self._chunk(moved[self.model.bricks[some]], terms, bulk, tangent)
                np.add.at(forces, self.model.bricks[some], pulled)
                if blocks is not None:
                    blocks[some] = stiff
        if blocks is None:
            return forces, None
        rows, columns = self._pattern
        size = moved.size
        return forces, coo_array((blocks.ravel(), (rows, columns)), shape=(size, size)).tocsr()

    def _chunk(
        self, moved: Floats, terms: list[Term], bulk: float, tangent: bool
    ) -> tuple[Floats, Floats]:
        """Forces (e, 27, 3) and stiffness (e, 81, 81) of some bricks from (e, 27, 3)."""
        gradients, weights, linear = self._volume
        count = len(moved)
        stretch = np.eye(3) + np.einsum("eai,qaj->eqij", moved, gradients)
        left, sizes, right = np.linalg.svd(stretch)
        if (np.linalg.det(stretch) <= 0).any() or (sizes[..., 2] < 1e-9).any():
            return np.full((count, 27, 3), np.nan), np.zeros((count, 81, 81))
        volume = sizes.prod(axis=-1)
        lumped = np.einsum("q,qk,eq->ek", weights, linear, volume - 1.0)
        pressure = bulk * lumped @ linear.T
        _, slope, bend = stretch_derivatives(terms, sizes)
        cofactor = volume[..., None] / sizes
        slope = slope + pressure[..., None] * cofactor
        stress = np.einsum("eqik,eqk,eqkj->eqij", left, slope, right)
        forces = np.einsum("q,eqij,qaj->eai", weights, stress, gradients)
        if not tangent:
            return forces, np.zeros((0, 81, 81))
        both = cofactor[..., :, None] / sizes[..., None, :] * (1.0 - np.eye(3))
        bend = bend + pressure[..., None, None] * both
        modulus = _modulus(left, right, sizes, slope, bend)
        pairs = np.zeros((len(weights), 3, 3, 27, 3))
        for axis in range(3):
            pairs[:, axis, :, :, axis] = gradients.transpose(0, 2, 1)
        strain = pairs.reshape(len(weights), 9, 81)
        scaled = modulus @ strain * weights[:, None, None]
        stiffness = np.matmul(strain.reshape(-1, 81).T, scaled.reshape(count, -1, 81))
        # The pressure's share: K Σ_k b_k b_kᵀ with b_k = ∫ linear_k cof F : ∇δu.
        turned = np.einsum("eqik,eqk,eqkj->eqij", left, cofactor, right).reshape(count, -1, 9)
        swell = np.einsum("q,qk,eqc,qcd->ekd", weights, linear, turned, strain, optimize=True)
        return forces, stiffness + bulk * np.einsum("ekc,ekd->ecd", swell, swell)

    def loads(self, moved: Floats, factor: float) -> tuple[Floats, Any]:
        """Return outer forces in N (n, 3), and their derivative by the displacements."""
        from scipy.sparse import coo_array, csr_array

        size = moved.size
        forces = factor * (self.model.forces + self.model.weights)
        change: Any = csr_array((size, size))
        places = self.model.nodes + moved
        for load in self.model.pressures:
            for face, members in _by_face(load.faces):
                values, along, across, weights = self._face(face)
                bricks = self.model.bricks[members]
                x = places[bricks]
                first = np.einsum("qa,eai->eqi", along, x)
                second = np.einsum("qa,eai->eqi", across, x)
                push = factor * load.value
                pressed = np.einsum(
                    "q,qa,eqi->eai", push * weights, values, np.cross(first, second)
                )
                np.add.at(forces, bricks, pressed)
                # d(t1 × t2) = -[t2]× dt1 + [t1]× dt2
                blocks = np.einsum(
                    "q,qa,qb,eqij->eaibj",
                    push * weights,
                    values,
                    across,
                    _cross(first),
                    optimize=True,
                ) - np.einsum(
                    "q,qa,qb,eqij->eaibj",
                    push * weights,
                    values,
                    along,
                    _cross(second),
                    optimize=True,
                )
                dofs = (3 * bricks[:, :, None] + np.arange(3)).reshape(len(bricks), 81)
                rows = np.repeat(dofs, 81, axis=1).ravel()
                columns = np.tile(dofs, (1, 81)).ravel()
                change = change + coo_array((blocks.ravel(), (rows, columns)), shape=(size, size))
        return forces, change

    @cached_property
    def _faces(self) -> dict[int, tuple[Floats, Floats, Floats, Floats]]:
        return {}

    def _face(self, face: int) -> tuple[Floats, Floats, Floats, Floats]:
        """Shape functions and two tangents whose cross product points into the brick."""
        if face not in self._faces:
            flat, weights = _gauss(3, 2)
            a, b, _, d = (CORNERS[corner] for corner in FACES[face])
            points = a + flat[:, :1] * (b - a) + flat[:, 1:] * (d - a)
            values, gradients = self._shapes(points.astype(float))
            along, across = self.model.edge * (b - a), self.model.edge * (d - a)
            self._faces[face] = (values, gradients @ along, gradients @ across, weights)
        return self._faces[face]


def _modulus(left: Floats, right: Floats, sizes: Floats, slope: Floats, bend: Floats) -> Floats:
    """Differentiate the first Piola stress by the deformation gradient, (e, q, 9, 9).

    Computed in the frames of the singular value decomposition: stretches see the Hessian, and a
    pair of directions i, j turns and shears with ``(P_i ± P_j)/(λ_i ± λ_j)``.
    """
    shape = sizes.shape[:-1]
    inner = np.zeros((*shape, 3, 3, 3, 3))
    for i, j in product(range(3), repeat=2):
        inner[..., i, i, j, j] = bend[..., i, j]
        if i == j:
            continue
        gap, total = sizes[..., i] - sizes[..., j], sizes[..., i] + sizes[..., j]
        close = np.abs(gap) < 1e-6 * total
        limit = (bend[..., i, i] + bend[..., j, j]) / 2 - bend[..., i, j]
        shear = np.where(close, limit, (slope[..., i] - slope[..., j]) / np.where(close, 1.0, gap))
        turn = (slope[..., i] + slope[..., j]) / total
        inner[..., i, j, i, j] = (shear + turn) / 2
        inner[..., i, j, j, i] = (shear - turn) / 2
    frames = np.einsum("...ik,...lj->...ijkl", left, right).reshape(*shape, 9, 9)
    modulus: Floats = frames @ inner.reshape(*shape, 9, 9) @ np.swapaxes(frames, -1, -2)
    return modulus


def _by_face(faces: Ints) -> Iterator[tuple[int, Ints]]:
    for face in np.unique(faces[:, 1]).tolist():
        yield face, faces[faces[:, 1] == face, 0]


def _cross(vectors: Floats) -> Floats:
    """Make the matrix [v]× of each vector."""
    matrix = np.zeros((*vectors.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        matrix[..., i, j], matrix[..., j, i] = -vectors[..., k], vectors[..., k]
    return matrix


def _gauss(count: int, dimension: int) -> tuple[Floats, Floats]:
    """Return Gauss points (q, d) and weights (q,) on the unit cube."""
    places, weights = np.polynomial.legendre.leggauss(count)
    grid = np.meshgrid(*[places / 2 + 0.5] * dimension, indexing="ij")
    shares = np.meshgrid(*[weights / 2] * dimension, indexing="ij")
    return np.stack(grid, axis=-1).reshape(-1, dimension), np.prod(shares, axis=0).ravel()
