"""The union of all material models: what a design's ``material`` table may be."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from voxsoft.materials.lattice import CompliantLattice, Lattice

#: Any material model.
Material = Lattice | CompliantLattice

#: The same as a pydantic field, told apart by ``model``.
AnyMaterial = Annotated[Material, Field(discriminator="model")]
