"""Stress and strain of a body: in each voxel, and averaged on its vertices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final, Literal, Self, get_args

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import DesignError
from voxsoft.mesh import Mesh
from voxsoft.records import closest

if TYPE_CHECKING:
    from voxsoft._core import Fields as CoreFields

Floats = NDArray[np.float64]

#: Fields of one number for each voxel.
FieldName = Literal["von_mises", "max_stretch", "energy_density", "volume_ratio"]
FIELDS: Final[tuple[FieldName, ...]] = get_args(FieldName)


@dataclass(frozen=True, eq=False)
class VertexFields:
    """Stress and strain averaged on the vertices, as the studio colors a body by them.

    The mean of the voxels around a vertex, weighed by their volumes; where materials meet, of both.

    Attributes
    ----------
    stress
        Cauchy stress in Pa, (n, 6): xx, yy, zz, xy, yz, xz.
    von_mises
        Mean of the von Mises stresses around in Pa, (n,).
    max_stretch
        Mean of the largest principal stretches around, (n,).
    energy_density
        Elastic energy per rest volume in J/m³, (n,).

    Notes
    -----
    Inverted voxels have no stress and do not count in averages of it; a vertex of inverted voxels
    alone has NaN.
    """

    stress: Floats
    von_mises: Floats
    max_stretch: Floats
    energy_density: Floats


@dataclass(frozen=True, eq=False, repr=False)
class Fields:
    """Stress and strain in each voxel (each tetrahedron, where a mesh is not made of voxels).

    All are means over the voxel: bending within a voxel does not show in them, so that a wall one
    voxel thick has the stress of its middle surface, not of its faces.

    Attributes
    ----------
    stress
        Cauchy stress in Pa, (v, 6): xx, yy, zz, xy, yz, xz. Of a lattice it is that of a continuum
        with the same energy. Viscous stress is not in it. NaN in voxels that are inverted.
    von_mises
        Von Mises stress in Pa, (v,); NaN likewise.
    principal_stretches
        Length over original length along the principal directions, largest first, (v, 3).
        Their product is the volume ratio of the mean deformation: the last is negative where that
        is inside out.
    energy_density
        Elastic energy per rest volume in J/m³, (v,).
    volume_ratio
        Volume over original volume where it is smallest in the voxel, (v,): of the five
        tetrahedra of a lattice, of the six points at which a hyperelastic voxel is integrated.
        Zero and below mean that the voxel is inverted.
    volumes
        Original volume of the material in m³, (v,).
    centers
        Middle of each voxel at rest in m, (v, 3).
    parts
        The part of each, an index into ``design.parts``, (v,).
    rigid
        True where that part is rigid, (v,): the stress there is that of a stiff stand-in, and
        :meth:`percentile` leaves it out.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> fields = vs.simulate(families.beam()).fields
    >>> fields.stress.shape[1], fields.at_vertices.von_mises.ndim
    (6, 1)
    >>> fields.percentile("von_mises", 99) <= fields.percentile("von_mises", 100)
    True
    """

    stress: Floats
    von_mises: Floats
    principal_stretches: Floats
    energy_density: Floats
    volume_ratio: Floats
    volumes: Floats
    centers: Floats
    parts: NDArray[np.intp]
    rigid: NDArray[np.bool_]
    _core: CoreFields
    _order: NDArray[np.intp]
    _positions: Floats

    @classmethod
    def of(cls, core: CoreFields, mesh: Mesh, positions: Floats, rigid: Sequence[bool]) -> Self:
        """Measure a body at some positions.

        Parameters
        ----------
        core
            The elements of its problem.
        mesh
            Its mesh.
        positions
            Vertices in m, (n, 3).
        rigid
            True for each rigid part of the design.
        """
        order = np.argsort(core.blocks, kind="stable")
        found = {name: values[order] for name, values in core.measure(positions).items()}
        parts = mesh.tet_part[:: 1 if mesh.tet_voxel is None else 5].astype(np.intp) - 1
        return cls(
            stress=found["stress"],
            von_mises=found["von_mises"],
            principal_stretches=found["stretches"],
            energy_density=found["energy_density"],
            volume_ratio=found["volume_ratio"],
            volumes=core.volumes[order],
            centers=_centers(mesh),
            parts=parts,
            rigid=np.asarray(rigid, dtype=bool)[parts],
            _core=core,
            _order=order,
            _positions=np.asarray(positions, dtype=np.float64),
        )

    @property
    def max_stretch(self) -> Floats:
        """Largest principal stretch of each voxel, (v,)."""
        largest: Floats = self.principal_stretches[:, 0]
        return largest

    @cached_property
    def at_vertices(self) -> VertexFields:
        """The fields averaged on the vertices."""
        return VertexFields(**self._core.at_vertices(self._positions))

    def max_stretch_slope(self, percent: float = 100.0) -> Floats:
        """Derivative of a percentile of the largest stretch by the positions of all vertices.

        Parameters
        ----------
        percent
            See :meth:`percentile`. The slope is that of the one voxel that has the value.

        Returns
        -------
        ndarray of float64, shape (n, 3)
            In 1/m.
        """
        return self.stretch_slope(self.where("max_stretch", percent))

    def stretch_slope(self, voxel: int | None) -> Floats:
        """Derivative of the largest stretch of one voxel; zero without one.

        Parameters
        ----------
        voxel
            Its index, as :meth:`where` returns it.

        Returns
        -------
        ndarray of float64, shape (n, 3)
            In 1/m.
        """
        if voxel is None:
            return np.zeros_like(self._positions)
        return self._core.stretch_slope(self._positions, int(self._order[voxel]))

    def percentile(self, name: FieldName, percent: float = 100.0) -> float:
        """The value that so many percent of the volume stay at or below; rigid parts do not count.

        Parameters
        ----------
        name
            ``"von_mises"``, ``"max_stretch"``, ``"energy_density"`` or ``"volume_ratio"``.
        percent
            Above 0, at most 100, where it is the largest of all voxels.

        Returns
        -------
        float
            In SI units; NaN where no voxel has the number.

        Raises
        ------
        DesignError
            An unknown field, or a percentage out of range.
        """
        index = self.where(name, percent)
        return float("nan") if index is None else float(self._values(name)[index])

    def where(self, name: FieldName, percent: float = 100.0) -> int | None:
        """The voxel with the value of :meth:`percentile`; None where no voxel has a number."""
        return self.where_of(self._values(name), percent)

    def where_of(self, values: Floats, percent: float = 100.0) -> int | None:
        """The voxel that has a percentile of a number of your own.

        Parameters
        ----------
        values
            For each voxel, (k,); those that are not finite do not count, nor do rigid parts.
        percent
            See :meth:`percentile`.
        """
        if not 0.0 < percent <= 100.0:
            raise DesignError("percentile", f"{percent:g} is not above 0 and at most 100", "try 99")
        counted = np.flatnonzero(np.isfinite(values) & ~self.rigid)
        if len(counted) == 0:
            return None
        order = counted[np.argsort(values[counted], kind="stable")]
        below = np.cumsum(self.volumes[order])
        # A part in 1e9 for the rounding of the sum.
        due = below[-1] * (percent / 100.0) * (1.0 - 1e-9)
        return int(order[np.searchsorted(below, due)])

    def point_data(self) -> dict[str, Floats]:
        """Arrays on the vertices for a VTU file, (n, ...), in SI units."""
        return dict(vars(self.at_vertices))

    def cell_data(self, mesh: Mesh) -> dict[str, Floats]:
        """Arrays in the tetrahedra for a VTU file, (m, ...), in SI units.

        Parameters
        ----------
        mesh
            The mesh that was measured; the tetrahedra of a voxel have the same values.
        """
        names = ("stress", "von_mises", "principal_stretches", "energy_density", "volume_ratio")
        each = slice(None) if mesh.tet_voxel is None else mesh.tet_voxel
        return {name: getattr(self, name)[each] for name in names}

    def _values(self, name: str) -> Floats:
        if name not in FIELDS:
            raise DesignError("field", f'"{name}" is not known', closest(name, FIELDS))
        values: Floats = getattr(self, name)
        return values

    def __repr__(self) -> str:
        return f"Fields({len(self.volumes)} voxels)"


def _centers(mesh: Mesh) -> Floats:
    """Middles of tetrahedra, or of voxels: those of the boxes around their five tetrahedra."""
    per_voxel = 1 if mesh.tet_voxel is None else 5
    corners = mesh.vertices[mesh.tets].reshape(-1, 4 * per_voxel, 3)
    if per_voxel == 1:
        middles: Floats = corners.mean(axis=1)
        return middles
    boxes: Floats = (corners.min(axis=1) + corners.max(axis=1)) / 2.0
    return boxes
