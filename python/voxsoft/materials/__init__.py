"""Materials: models with constants in SI units, and the library of cards.

A *model* defines the stress of a material: ``"lattice"`` (edge and bulk modulus, the paper's), a
hyperelastic one, ``"neo-hookean"``, ``"mooney-rivlin"``, ``"yeoh"``, ``"ogden"``, ``"gent"``, or
``"rigid"``. A *card* is a named model with its density and the source of its numbers, in a plain
TOML file.

Examples
--------
>>> from voxsoft.units import kPa
>>> soft = Lattice(edge=20 * kPa, bulk=100 * kPa)
>>> round(soft.young(voxel_size=5e-3) / 1e3, 1)
49.0
>>> NeoHookean(young=60 * kPa).shear < 60 * kPa / 2
True
>>> "ecoflex-00-30" in card_names()
True
"""

from voxsoft.materials.card import Card, card_names, is_card_path, load_card, material_of
from voxsoft.materials.constants import constants_of, with_constants
from voxsoft.materials.fiber import Fiber
from voxsoft.materials.gent import Gent
from voxsoft.materials.homogeneous import MODES, Mode, nominal_stress, nominal_tangent
from voxsoft.materials.hyperelastic import Hyperelastic, PronyTerm
from voxsoft.materials.lattice import SILICONE_DENSITY, CompliantLattice, Lattice
from voxsoft.materials.model import AnyMaterial, Material
from voxsoft.materials.mooney_rivlin import MooneyRivlin
from voxsoft.materials.mullins import Mullins
from voxsoft.materials.neo_hookean import NeoHookean
from voxsoft.materials.ogden import Ogden
from voxsoft.materials.posterior import Posterior
from voxsoft.materials.relaxing import relaxing_stress
from voxsoft.materials.rigid import Rigid
from voxsoft.materials.softening import cycled_stress
from voxsoft.materials.stability import StableRange, stable_range, stable_ranges
from voxsoft.materials.tested import StretchRange
from voxsoft.materials.uniaxial import uniaxial_stress
from voxsoft.materials.yeoh import Yeoh

__all__ = [
    "MODES",
    "SILICONE_DENSITY",
    "AnyMaterial",
    "Card",
    "CompliantLattice",
    "Fiber",
    "Gent",
    "Hyperelastic",
    "Lattice",
    "Material",
    "Mode",
    "MooneyRivlin",
    "Mullins",
    "NeoHookean",
    "Ogden",
    "Posterior",
    "PronyTerm",
    "Rigid",
    "StableRange",
    "StretchRange",
    "Yeoh",
    "card_names",
    "constants_of",
    "cycled_stress",
    "is_card_path",
    "load_card",
    "material_of",
    "nominal_stress",
    "nominal_tangent",
    "relaxing_stress",
    "stable_range",
    "stable_ranges",
    "uniaxial_stress",
    "with_constants",
]
