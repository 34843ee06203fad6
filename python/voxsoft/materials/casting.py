"""Data for casting silicones: ratio of the two components, pot life, cure."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib import resources

from voxsoft.records import Record
from voxsoft.units import Dimensionless, PositiveTime


class CastingData(Record):
    """Data for casting a silicone of two components.

    Parameters
    ----------
    title
        Name for people.
    parts
        Parts of A and of B, by weight.
    pot_life
        Time from mixing in which it pours.
    cure
        Time to the demolding at 23 degrees Celsius.
    elongation
        Strain at break.
    shrinkage
        Largest linear shrinkage that the maker states.
    source
        Source of the numbers.
    """

    title: str
    parts: tuple[Dimensionless, Dimensionless]
    pot_life: PositiveTime
    cure: PositiveTime
    elongation: Dimensionless
    shrinkage: Dimensionless
    source: str


@cache
def _known() -> dict[str, CastingData]:
    text = resources.files("voxsoft.materials").joinpath("casting.toml").read_text("utf-8")
    return {name: CastingData.model_validate(each) for name, each in tomllib.loads(text).items()}


def casting_data(material: str) -> CastingData | None:
    """Return the data for casting of a material card, by the silicone that its name begins with.

    Parameters
    ----------
    material
        Name of a card, such as ``"ecoflex-00-30-lattice"``.

    Returns
    -------
    CastingData or None
        None where the silicone is not known.

    Examples
    --------
    >>> casting_data("ecoflex-00-30-lattice").pot_life
    2700.0
    >>> casting_data("firm") is None
    True
    """
    fits = [name for name in _known() if material == name or material.startswith(f"{name}-")]
    return _known()[max(fits, key=len)] if fits else None
