"""Search space of a calibration: a range with units for each modulus, on a log scale."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from voxsoft.errors import MaterialError
from voxsoft.materials import CompliantLattice, Hyperelastic, Lattice, Material
from voxsoft.materials.constants import constant_of, constants_of, with_constants
from voxsoft.records import closest
from voxsoft.units import UnitOf, format_quantity

Bounds = tuple[float | str, float | str]

#: Default ranges of the lattice material.
#:
#: Silicones and gels for soft robots have Young's moduli of some 5 kPa to 2 MPa, and the edge
#: modulus is 0.39 to 0.48 of that. A lattice needs no bulk stiffness to be stable, and at 2 kPa it
#: adds less than a tenth to the stiffness of the softest of them; from about a hundred edge moduli
#: on it is as good as incompressible and only locks harder.
DEFAULT_BOUNDS: Final[Mapping[str, Bounds]] = {
    "edge": ("1 kPa", "1 MPa"),
    "bulk": ("2 kPa", "1 MPa"),
}

#: Default range of a hyperelastic material: its stiffness, the shape of its curve as it is.
HYPERELASTIC_BOUNDS: Final[Mapping[str, Bounds]] = {"young": ("5 kPa", "2 MPa")}


def usual_ranges(model: type[Material]) -> Mapping[str, Bounds]:
    """Return the constants that are fitted by default, with their ranges.

    Examples
    --------
    >>> from voxsoft.materials import Ogden, Rigid
    >>> usual_ranges(Ogden), usual_ranges(Rigid)
    ({'young': ('5 kPa', '2 MPa')}, {})
    """
    if issubclass(model, Hyperelastic):
        return HYPERELASTIC_BOUNDS
    return DEFAULT_BOUNDS if issubclass(model, Lattice) else {}


@dataclass(frozen=True)
class Space:
    """Ranges of the constants that are searched; the others stay as the design has them.

    Genes run from 0 to 1 and are uniform in the logarithm of the constant.

    Attributes
    ----------
    names
        Names of the constants of the material model.
    low, high
        Ranges of the constants in SI units, (n,).
    base
        Material that the other constants come from.

    Examples
    --------
    >>> space = Space.of({"edge": ("1 kPa", "100 kPa")}, Lattice(edge="5 kPa", bulk="7 kPa"))
    >>> middle = space.material_at([0.5])
    >>> round(middle.edge, 6), middle.bulk
    (10000.0, 7000.0)
    """

    names: tuple[str, ...]
    low: tuple[float, ...]
    high: tuple[float, ...]
    base: Material

    @classmethod
    def of(cls, parameters: Mapping[str, Bounds] | None, material: Material) -> Space:
        """Read the ranges given to a calibration.

        Raises
        ------
        MaterialError
            A constant that the material does not have, or a range that is empty.
        """
        if isinstance(material, CompliantLattice):
            raise MaterialError(
                "material",
                f'is "{material.model}"; a calibration fits moduli',
                'give the parts { model = "lattice", edge = "20 kPa", bulk = "20 kPa" }',
            )
        own = usual_ranges(type(material))
        asked = own if parameters is None else parameters
        if not asked:
            raise MaterialError("parameters", "none is named", f"name {' or '.join(own)}")
        kinds = constants_of(material)
        ranges = [_range(name, bounds, kinds, material) for name, bounds in asked.items()]
        return cls(
            tuple(asked),
            tuple(low for low, _ in ranges),
            tuple(high for _, high in ranges),
            material,
        )

    def __len__(self) -> int:
        """Count the constants that are searched."""
        return len(self.names)

    def values(self, genes: ArrayLike) -> NDArray[np.float64]:
        """Return the constants in SI units at these genes, (n,) → (n,)."""
        share = np.asarray(genes, dtype=np.float64)
        low, high = np.log(self.low), np.log(self.high)
        found: NDArray[np.float64] = np.exp(low + share * (high - low))
        # exp(log(x)) may miss x by a bit, and a bound must not be missed.
        return np.where(share <= 0.0, self.low, np.where(share >= 1.0, self.high, found))

    def spans(self) -> NDArray[np.float64]:
        """Return the length of each range in the natural logarithm, (n,)."""
        lengths: NDArray[np.float64] = np.log(self.high) - np.log(self.low)
        return lengths

    def parameters(self, genes: ArrayLike) -> dict[str, float]:
        """Return the constants in SI units by name."""
        return dict(zip(self.names, (float(v) for v in self.values(genes)), strict=True))

    def values_of(self, material: Material) -> dict[str, float]:
        """Read the constants that are searched from a material, SI, by name."""
        return {name: constant_of(material, name) for name in self.names}

    @property
    def kinds(self) -> dict[str, str]:
        """Kind of quantity of each constant that is searched, by name."""
        known = constants_of(self.base)
        return {name: known[name] for name in self.names}

    def material_at(self, genes: ArrayLike) -> Material:
        """Return the material with these constants."""
        return with_constants(self.base, self.parameters(genes))


def _range(
    name: str, bounds: Bounds, kinds: Mapping[str, str], material: Material
) -> tuple[float, float]:
    if name not in kinds:
        lattice = isinstance(material, Lattice)
        kin = "modulus of the lattice" if lattice else f'constant of "{material.model}"'
        raise MaterialError(f"parameters.{name}", f"is not a {kin}", closest(name, kinds))
    unit = UnitOf(kinds[name], positive=True)
    low, high = (unit.read(bound) for bound in bounds)
    if not low < high:
        first, last = (format_quantity(bound, kinds[name]) for bound in (low, high))
        raise MaterialError(f"parameters.{name}", f"the range {first} to {last} is empty")
    return low, high
