"""Lattice material: springs along the edges of tetrahedra and a bulk stiffness inside them."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from voxsoft import _core
from voxsoft.errors import MaterialError, VoxSoftError
from voxsoft.materials.tested import StretchRange
from voxsoft.records import Record
from voxsoft.units import PositiveDensity, UnitOf, to_si

#: Density of platinum-cure silicones such as EcoFlex and Dragon Skin, kg/m³ (maker's datasheets).
SILICONE_DENSITY = 1070.0

PositiveModulus = Annotated[float, UnitOf("modulus", positive=True)]


class Lattice(Record):
    """The paper's material with constants that survive a change of voxel size and time step.

    An edge of rest length ``l`` has the compliance ``1/(edge l s)``, where the share ``s`` is the
    part of a full turn around the edge that is filled with material (1 inside the body, less on
    its surface); a tetrahedron of rest volume ``V0`` has ``V0/bulk`` on ``V - V0``.

    Parameters
    ----------
    edge
        Resistance to stretch: the modulus of the springs along the edges of its
        tetrahedra. Young's modulus is 2.1 to 2.6 times as large, see :meth:`young`.
    bulk
        Resistance to a change of volume: the bulk modulus of the tetrahedra. Large
        values lock thin walls in bending.
    density
        Default 1070 kg/m³, a platinum-cure silicone.
    tested_stretch
        Stretch of the specimens from which the constants come, if that is known;
        results that go farther carry a warning. Default: not known.

    Examples
    --------
    >>> soft = Lattice(edge="20 kPa", bulk="100 kPa")
    >>> soft.edge, soft.density
    (20000.0, 1070.0)
    >>> Lattice(edge="-20 kPa", bulk="1 kPa")
    Traceback (most recent call last):
    ...
    voxsoft.errors.MaterialError: edge: "-20 kPa" is not positive. Try: give a modulus above zero
    """

    error_type: ClassVar[type[VoxSoftError]] = MaterialError

    model: Literal["lattice"] = "lattice"
    edge: PositiveModulus
    bulk: PositiveModulus
    density: PositiveDensity = SILICONE_DENSITY
    tested_stretch: StretchRange | None = None

    def young(self, voxel_size: float | str = 1.0) -> float:
        """Young's modulus in Pa for small strain along the axes of a large block of voxels.

        Parameters
        ----------
        voxel_size
            Edge length of a voxel in m; moduli do not depend on it.
        """
        return self.core.young(to_si(voxel_size, "length", "voxel_size"))

    def poisson(self, voxel_size: float | str = 1.0) -> float:
        """Poisson's ratio under the same conditions as :meth:`young`."""
        return self.core.poisson(to_si(voxel_size, "length", "voxel_size"))

    @property
    def core(self) -> _core.Material:
        """Material of the Rust core."""
        return _core.Material.lattice(edge=self.edge, bulk=self.bulk, density=self.density)


class CompliantLattice(Record):
    """The raw compliances of the paper's Table I, which belong to one voxel size.

    Every voxel brings its own 18 edges of the same compliance whatever their length (so that an
    inner cube edge is four springs side by side), and five tetrahedra with the volume compliance.

    Parameters
    ----------
    edge_compliance
        In m/N. Young's modulus of the lattice is ``40/(7 edge_compliance voxel_size)``.
    volume_compliance
        In m³/Pa, on ``V - V0``. At the paper's values and voxel size it has no effect at all:
        the constraint is nine orders of magnitude softer than the springs.
    density
        Default 1070 kg/m³.

    Notes
    -----
    Table I cannot be used as it stands: it was found with particle masses that add up to 1/15 of
    the real mass, so with true masses its beams collapse. :meth:`to_moduli` gives moduli of the
    same Young's modulus; compare them with a measured one before use.

    Examples
    --------
    >>> table_1 = CompliantLattice(edge_compliance="0.2 m/N", volume_compliance="0.05 m^3/Pa")
    >>> round(table_1.young(voxel_size=5e-3))
    5714
    """

    error_type: ClassVar[type[VoxSoftError]] = MaterialError

    model: Literal["lattice-compliance"] = "lattice-compliance"
    edge_compliance: Annotated[float, UnitOf("compliance", positive=True)]
    volume_compliance: Annotated[float, UnitOf("volume compliance", positive=True)]
    density: PositiveDensity = Field(SILICONE_DENSITY)

    def young(self, voxel_size: float | str) -> float:
        """Young's modulus in Pa at a voxel size in m, for small strain along the axes."""
        return self.core.young(to_si(voxel_size, "length", "voxel_size"))

    def poisson(self, voxel_size: float | str) -> float:
        """Poisson's ratio under the same conditions as :meth:`young`."""
        return self.core.poisson(to_si(voxel_size, "length", "voxel_size"))

    def to_moduli(self, voxel_size: float | str, bulk: float | str) -> Lattice:
        """Return the lattice of the same Young's modulus with a bulk modulus of your choice.

        The edge modulus ``e`` solves ``E = C11 - 2 C12²/(C11 + C12)`` with
        ``C11 = (1 + √2) e + K`` and ``C12 = e/√2 + K``, which increases with ``e``.

        Parameters
        ----------
        voxel_size
            Voxel size in m of the compliances.
        bulk
            Bulk modulus ``K`` of the result in Pa.
        """
        from scipy.optimize import brentq

        target = self.young(voxel_size)

        def excess(edge: float) -> float:
            return Lattice(edge=edge, bulk=bulk).young() - target

        # E lies between 2.09 e (K = 0) and 2.57 e (K infinite), which brackets e.
        edge = float(brentq(excess, target / 2.6, target / 2.0, rtol=1e-12))
        return Lattice(edge=edge, bulk=bulk, density=self.density)

    @property
    def core(self) -> _core.Material:
        """Material of the Rust core."""
        return _core.Material.lattice_compliance(
            edge=self.edge_compliance, volume=self.volume_compliance, density=self.density
        )
