"""Union type of all material models, for a design's ``material`` table."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from voxsoft.materials.gent import Gent
from voxsoft.materials.lattice import CompliantLattice, Lattice
from voxsoft.materials.mooney_rivlin import MooneyRivlin
from voxsoft.materials.neo_hookean import NeoHookean
from voxsoft.materials.ogden import Ogden
from voxsoft.materials.rigid import Rigid
from voxsoft.materials.yeoh import Yeoh

#: Any material model.
Material = Lattice | CompliantLattice | NeoHookean | MooneyRivlin | Yeoh | Ogden | Gent | Rigid

#: Any material model as a pydantic field, discriminated by ``model``.
AnyMaterial = Annotated[Material, Field(discriminator="model")]
