"""Energies of one voxel, for every element that `elements.py` compares.

A voxel is a cube with eight corners, and every element here is a function of 21 numbers that are
linear in the corners' positions: the mean gradient F₀ (3 × 3) and four hourglass vectors w₁…w₄
(3 each, made dimensionless by 2/h). With ξ, η, ζ ∈ [−1, 1] the corners move as

    x = x̄ + (h/2) (F₀ (ξ, η, ζ) + w₁ ηζ + w₂ ζξ + w₃ ξη + w₄ ξηζ)

so an energy per unit of volume does not know the size of the voxel. `docs/method/elements.md`
derives the ones that are not in textbooks.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np

jax.config.update("jax_enable_x64", True)  # type: ignore[no-untyped-call]

#: Corners of the cube in units of half its edge, (8, 3).
CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
#: The four hourglass patterns at the corners, (4, 8): ηζ, ζξ, ξη, ξηζ.
PATTERNS = np.array(
    [
        CORNERS[:, 1] * CORNERS[:, 2],
        CORNERS[:, 2] * CORNERS[:, 0],
        CORNERS[:, 0] * CORNERS[:, 1],
        CORNERS.prod(axis=1),
    ]
)
#: Corner positions in units of h to (F₀ columns, w₁…w₄), (7, 8).
MODES = np.vstack([CORNERS.T, PATTERNS]) / 4.0

_GAUSS = CORNERS / np.sqrt(3.0)
_FACES = np.vstack([np.eye(3), -np.eye(3)])
_TETS = {
    1: [(0, 3, 5, 6), (1, 0, 3, 5), (2, 0, 3, 6), (4, 0, 5, 6), (7, 3, 5, 6)],
    0: [(1, 2, 4, 7), (0, 1, 2, 4), (3, 1, 2, 7), (5, 1, 4, 7), (6, 2, 4, 7)],
}

Array = jax.Array
Energy = Callable[[Array, Array, Array, Array], Array]


@dataclass(frozen=True)
class Element:
    """An element: its energy per unit of volume and how many unknowns it condenses.

    `energy(g, z, material, parity)` takes the modes g (7, 3), the inner unknowns z (inner,), the
    material (μ, K, c20) in Pa, and the parity of the voxel (0 or 1).
    """

    name: str
    energy: Energy
    inner: int = 0
    #: Evaluations of the material in one evaluation of the element.
    points: int = 1


def determinant(f: Array) -> Array:
    """Determinant of a 3 × 3 matrix; written out, as the compiler is slow with the general one."""
    return jnp.dot(f[0], jnp.cross(f[1], f[2]))


def cofactor(f: Array) -> Array:
    """Cofactors of a 3 × 3 matrix, J F⁻ᵀ."""
    return jnp.stack([jnp.cross(f[1], f[2]), jnp.cross(f[2], f[0]), jnp.cross(f[0], f[1])])


def mean(f: Callable[[Array], Array], points: np.ndarray) -> Array:
    """Mean of a function over points."""
    return jnp.mean(jax.vmap(f)(jnp.asarray(points)), axis=0)


def isochoric(f: Array, material: Array) -> Array:
    """Neo-Hookean (and Yeoh's second term) of the isochoric invariant, in Pa."""
    jacobian = determinant(f)
    strain = jnp.sum(f * f) * jacobian ** (-2.0 / 3.0) - 3.0
    return material[0] / 2 * strain + material[2] * strain**2


def volumetric(jacobian: Array, material: Array) -> Array:
    """K/2 (J − 1)², in Pa."""
    return material[1] / 2 * (jacobian - 1.0) ** 2


def whole(f: Array, material: Array) -> Array:
    """Both parts of the energy."""
    return isochoric(f, material) + volumetric(determinant(f), material)


def poisson(material: Array) -> Array:
    """Poisson's ratio of small strains."""
    shear, bulk = material[0], material[1]
    return (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear)


def gradient(g: Array, point: Array) -> Array:
    """Deformation gradient of the trilinear brick at a point, (3, 3)."""
    x, y, z = point
    w1, w2, w3, w4 = g[3], g[4], g[5], g[6]
    hourglass = [
        w2 * z + w3 * y + w4 * y * z,
        w1 * z + w3 * x + w4 * z * x,
        w1 * y + w2 * x + w4 * x * y,
    ]
    return g[:3].T + jnp.stack(hourglass, axis=1)


def five_tets(g: Array, z: Array, material: Array, parity: Array) -> Array:
    """Five linear tetrahedra, the split alternating with the parity."""
    corners = CORNERS @ g[:3] + PATTERNS.T @ g[3:]

    def split(which: int) -> Array:
        total = jnp.zeros(())
        for tet in _TETS[which]:
            rest = (CORNERS[list(tet[1:])] - CORNERS[tet[0]]).T
            now = (corners[np.array(tet[1:])] - corners[tet[0]]).T
            share = abs(np.linalg.det(rest)) / 48
            total += share * whole(now @ np.linalg.inv(rest), material)
        return total

    return jnp.where(parity == 0, split(0), split(1))


def full_brick(g: Array, z: Array, material: Array, parity: Array) -> Array:
    """Eight nodes, 2 × 2 × 2 points."""
    return mean(lambda p: whole(gradient(g, p), material), _GAUSS)


def mean_dilatation(g: Array, z: Array, material: Array, parity: Array) -> Array:
    """Isochoric part at 2 × 2 × 2 points, volumetric part of the voxel's own volume (Q1P0)."""
    volume = mean(lambda p: determinant(gradient(g, p)), _GAUSS)
    shape = mean(lambda p: isochoric(gradient(g, p), material), _GAUSS)
    return shape + volumetric(volume, material)


def enhanced(g: Array, z: Array, material: Array, parity: Array) -> Array:
    """Nine enhanced modes F₀ (a_k ⊗ e_k) ξ_k (Simo & Armero 1992)."""
    a = z.reshape(3, 3)
    return mean(lambda p: whole(gradient(g, p) + g[:3].T @ (a * p[None, :]), material), _GAUSS)


def enhanced_transposed(g: Array, z: Array, material: Array, parity: Array) -> Array:
    """Nine enhanced modes F₀ (e_k ⊗ a_k) ξ_k (Glaser & Armero 1997)."""
    a = z.reshape(3, 3)
    return mean(lambda p: whole(gradient(g, p) + g[:3].T @ (a * p[:, None]), material), _GAUSS)


def isotropic_hourglass(kappa: float) -> Energy:
    """One point, and a stiffness κμ against every hourglass vector (Flanagan & Belytschko 1981)."""

    def energy(g: Array, z: Array, material: Array, parity: Array) -> Array:
        f = g[:3].T
        return whole(f, material) + kappa * material[0] / 2 * jnp.sum(g[3:] ** 2)

    return energy


def rotation(f: Array) -> Array:
    """Rotation of the polar decomposition, by Newton's iteration (Higham 1986)."""
    turned: Array = jax.lax.fori_loop(0, 7, lambda _, r: (r + cofactor(r) / determinant(r)) / 2, f)
    return turned


def assumed(w: Array, point: Array, thickness: Array) -> Array:
    """Gradient of the hourglass vectors without parasitic shear, with thickness strain, (3, 3).

    `w` (4, 3) in the voxel's own axes; the ξηζ vector is left out. `thickness` is the strain
    across a bent layer for each unit of the strains in it, ν/(1 − ν) for plane stress.
    """
    x, y, z = point
    (w1x, w1y, w1z), (w2x, w2y, w2z), (w3x, w3y, w3z) = w[0], w[1], w[2]
    xx = w2x * z + w3x * y - thickness * (w3y + w2z) * x
    yy = w3y * x + w1y * z - thickness * (w1z + w3x) * y
    zz = w1z * y + w2z * x - thickness * (w2x + w1y) * z
    return jnp.array([[xx, w1x * z, w1x * y], [w2y * z, yy, w2y * x], [w3z * y, w3z * x, zz]])


def bending_trace(w: Array, nu: Array) -> Array:
    """Mean square of the volume strain that plane stress leaves in the bending modes."""
    factor = (1 - 2 * nu) / (1 - nu)
    pairs = jnp.array([w[2, 1] + w[1, 2], w[0, 2] + w[2, 0], w[1, 0] + w[0, 1]])
    return factor**2 * jnp.sum(pairs**2) / 3


def warp(w: Array, material: Array) -> Array:
    """Energy of the ξηζ vector: Young's modulus on its ∂x/∂x, whose mean square is 1/9."""
    young = 2 * material[0] * (1 + poisson(material))
    return young / 2 * jnp.sum(w[3] ** 2) / 9


def physical(g: Array, z: Array, material: Array, parity: Array) -> Array:
    """One point, and the linear assumed-strain energy of the turned hourglass vectors."""
    f, nu = g[:3].T, poisson(material)
    w = g[3:] @ rotation(f)

    def shape(point: Array) -> Array:
        h = assumed(w, point, nu / (1 - nu))
        strain = (h + h.T) / 2
        deviator = strain - jnp.trace(strain) / 3 * jnp.eye(3)
        return material[0] * jnp.sum(deviator**2)

    total = whole(f, material) + warp(w, material) + mean(shape, _FACES)
    return total + material[1] / 2 * bending_trace(w, nu)


def sampled(turned: bool, mean_volume: bool = True) -> Energy:
    """Six points on the faces: isochoric part there, volumetric part of their mean J.

    `turned`: the material at F₀ + R₀ Ĥ with Ĥ from R₀ᵀw; else at F₀ (1 + Ĥ) with Ĥ from F₀⁻¹w.
    Without `mean_volume` the volumetric part is that of F₀.
    """

    def energy(g: Array, z: Array, material: Array, parity: Array) -> Array:
        f, nu = g[:3].T, poisson(material)
        frame = rotation(f) if turned else f
        w = g[3:] @ (frame if turned else cofactor(f) / determinant(f))

        def moved(point: Array) -> Array:
            return f + frame @ assumed(w, point, nu / (1 - nu))

        volume = mean(lambda p: determinant(moved(p)), _FACES) if mean_volume else determinant(f)
        shape = mean(lambda p: isochoric(moved(p), material), _FACES)
        rest = warp(w, material) + material[1] / 2 * bending_trace(w, nu)
        return shape + volumetric(volume, material) + rest

    return energy


ELEMENTS = {
    element.name: element
    for element in (
        Element("five tets", five_tets, points=5),
        Element("full brick", full_brick, points=8),
        Element("mean dilatation", mean_dilatation, points=8),
        Element("enhanced", enhanced, inner=9, points=8),
        Element("enhanced transposed", enhanced_transposed, inner=9, points=8),
        Element("isotropic 0.05", isotropic_hourglass(0.05)),
        Element("isotropic 0.5", isotropic_hourglass(0.5)),
        Element("physical", physical),
        Element("turned", sampled(True), points=6),
        Element("pulled back, J of F0", sampled(False, mean_volume=False), points=6),
        Element("pulled back", sampled(False), points=6),
    )
}
