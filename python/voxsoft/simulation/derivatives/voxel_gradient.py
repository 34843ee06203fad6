"""Derivatives of metrics by the filled fraction of each voxel, for topologies of material."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft._memory import memory_limit
from voxsoft.errors import SimulationError
from voxsoft.metrics import Target, metric_named
from voxsoft.simulation.derivatives.gradient import (
    EquilibriumState,
    equilibrium_of,
    slopes_by_positions,
)
from voxsoft.simulation.results.result import Result
from voxsoft.simulation.setup.contact import has_contact
from voxsoft.simulation.solving.adjoint import readable_errors

Floats = NDArray[np.float64]

#: Relative change of fractions for which a number of the material itself shows.
_SHAKE: Final = 1e-3
#: Relative change of a number at the same positions that is rounding.
_ROUNDING: Final = 1e-9


@dataclass(frozen=True)
class VoxelSlopes:
    """Derivatives of a metric by the filled fraction of each voxel, in its unit.

    Attributes
    ----------
    stiffness : ndarray of float64, shape (v,)
        Slope by the fraction that counts for the stiffness of each voxel of the mesh.
    mass : ndarray of float64, shape (v,)
        Slope by the fraction that counts for its mass, and so for its weight.
    """

    stiffness: Floats
    mass: Floats

    @property
    def total(self) -> Floats:
        """Sum for one fraction of both, that of :meth:`~voxsoft.mesh.Mesh.with_fractions`, (v,)."""
        return self.stiffness + self.mass


def gradient_by_voxel(
    result: Result, targets: str | Sequence[str] | Mapping[str, Target]
) -> dict[str, VoxelSlopes]:
    """Compute derivatives of metrics with respect to the filled fraction of each voxel.

    Stiffness and mass are apart, so that a density may count in another way for each: with
    ``stiffness = density**3`` and ``mass = density`` (solid isotropic material with penalization)
    the derivative by the density is ``3 * density**2 * slopes.stiffness + slopes.mass``.

    One factorization of the tangent serves all voxels and all metrics.

    Parameters
    ----------
    result
        A stable equilibrium under the full loads without contact, of
        ``simulate(design, method="statics")``.
    targets
        Names of objectives or constraints of the design, or of metrics that need no choice; or a
        mapping from names of your own to objectives or constraints.

    Returns
    -------
    dict of VoxelSlopes
        Derivatives by target, in SI units; voxels in the order of the mesh.

    Raises
    ------
    SimulationError
        A result that is no such equilibrium, a mesh without voxels, contact, or a metric that
        depends on the material itself other than mass and elastic energy.

    Notes
    -----
    Layers, springs and the faces of full voxels that warp stay as they are. A mesh whose full
    voxels become partly full has none of these faces left, which is a jump that no slope shows.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.simulation import simulate
    >>> soft = '{model="neo-hookean", young="60 kPa"}'
    >>> beam = families.beam(length="40 mm").with_values(f"parts.0.material={soft}")
    >>> slopes = gradient_by_voxel(simulate(beam), "sag")["sag"]
    >>> bool(slopes.stiffness.sum() < 0 < slopes.mass.sum())
    True
    """
    state, chosen = equilibrium_of(result, targets)
    if has_contact(result.design):
        raise SimulationError(
            "gradient", "derivatives by voxels know no contact", "leave contact and objects out"
        )
    mesh = state.mesh
    if mesh.tet_voxel is None:
        raise SimulationError("gradient", "the mesh has no voxels", "make it from a grid of voxels")
    count = len(mesh.tets) // 5
    filled = np.ones(count) if mesh.fractions is None else mesh.fractions
    slopes = slopes_by_positions(state, chosen)
    explicit = _explicit(state, chosen, slopes, count)
    with readable_errors(len(state.positions)):
        by_stiffness, by_mass = _core.block_slopes(
            state.problem, state.positions, slopes, memory=memory_limit()
        )
    return {
        name: VoxelSlopes((one + own[0]) / filled, (other + own[1]) / filled)
        for name, one, other, own in zip(chosen, by_stiffness, by_mass, explicit, strict=True)
    }


def _explicit(
    state: EquilibriumState, targets: Mapping[str, Target], slopes: Floats, count: int
) -> list[tuple[Floats, Floats]]:
    """Return ``∂J/∂p`` of each target by the fractions of stiffness and mass."""
    shaken = 1.0 + _SHAKE * np.random.default_rng(0).uniform(-1.0, 1.0, (2, count))
    varied = replace(state, at=_core.with_fractions(state.problem, *shaken))
    none = np.zeros(count)
    found = []
    for (name, target), slope in zip(targets.items(), slopes, strict=True):
        metric = metric_named(target.metric)
        if metric.name == "mass":
            found.append((none, _core.block_masses(state.problem)))
            continue
        if metric.name == "elastic_energy":
            found.append((_core.block_energies(state.problem, state.positions), none))
            continue
        value, other = metric.value(state, target), metric.value(varied, target)
        if abs(other - value) > _ROUNDING * abs(value):
            raise SimulationError(
                name,
                "depends on the material of each voxel other than through the positions",
                "name a displacement, a rotation, the mass or the elastic energy",
            )
        if not slope.any():
            raise SimulationError(
                name, "does not change with the equilibrium", "name another metric"
            )
        found.append((none, none))
    return found
