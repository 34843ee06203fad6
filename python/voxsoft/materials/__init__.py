"""Materials: models with constants in SI units, and the library of cards.

A *model* says how a material answers (``"lattice"``: edge and bulk modulus); a *card* is a named
model with its density and where its numbers come from. Cards are plain TOML files.

Examples
--------
>>> from voxsoft.units import kPa
>>> soft = Lattice(edge=20 * kPa, bulk=100 * kPa)
>>> round(soft.young(voxel_size=5e-3) / 1e3, 1)
49.0
>>> "ecoflex-00-30" in card_names()
True
"""

from voxsoft.materials.card import Card, card_names, load_card, material_of
from voxsoft.materials.lattice import SILICONE_DENSITY, CompliantLattice, Lattice
from voxsoft.materials.model import AnyMaterial, Material

__all__ = [
    "SILICONE_DENSITY",
    "AnyMaterial",
    "Card",
    "CompliantLattice",
    "Lattice",
    "Material",
    "card_names",
    "load_card",
    "material_of",
]
