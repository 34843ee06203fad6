"""Posterior of a card: how far its constants are known, and draws of materials from it."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from voxsoft.errors import MaterialError, UnitError
from voxsoft.materials.card import Card
from voxsoft.materials.constants import constant_of, constants_of, with_constants
from voxsoft.materials.model import Material
from voxsoft.units import parse

#: Standard deviations to either end of a 95 % interval.
_TWO_SIDES: Final = 1.959964
#: Two-sided interval as calibrations and fits of coupons note it.
_BETWEEN: Final = re.compile(r"between (?P<low>.+?) and (?P<high>.+?) \(95 %\)")


@dataclass(frozen=True)
class Posterior:
    """A material with 95 % intervals of its constants.

    Attributes
    ----------
    material
        Material with the values of the card, the medians.
    intervals
        Lower and upper end by the name of the constant (:func:`~voxsoft.materials.constants_of`),
        SI units; above zero. Constants that are not named are held.

    Notes
    -----
    The logarithm of a constant is normal on either side of the value, with the spread of that
    side: draws are positive, half of them lie below the value of the card and 95 % in its interval.
    A card notes no correlations. Where it has the interval of Young's modulus, that alone is drawn
    and scales all moduli of a rubber, since its constants vary together: drawn one by one they
    would give curves that no specimen had.

    Examples
    --------
    >>> from voxsoft.materials import load_card
    >>> posterior = Posterior.of(load_card("ecoflex-00-30-lattice"))
    >>> posterior.intervals
    {'edge': (20100.0, 24000.0)}
    >>> posterior.draw(np.random.default_rng(0)).edge == posterior.material.edge
    False
    """

    material: Material
    intervals: Mapping[str, tuple[float, float]]

    @classmethod
    def of(cls, card: Card) -> Posterior | None:
        """Read the posterior that a calibration or a fit noted on a card; None without one.

        Raises
        ------
        MaterialError
            An interval that cannot be read, that does not hold the value of the card, or that
            reaches down to zero.
        """
        found: dict[str, tuple[float, float]] = {}
        for name, kind in constants_of(card.material).items():
            key = f"{name}_interval"
            match = _BETWEEN.search(str(card.calibration.get(key, "")))
            if match is None:
                continue
            where = f"{card.name}.calibration.{key}"
            try:
                ends = [_number(match[end], kind) for end in ("low", "high")]
            except UnitError as error:
                raise MaterialError(where, error.what, error.hint) from None
            low, high = ends
            value = constant_of(card.material, name)
            if not 0.0 < low <= value <= high:
                what = f"{match[0]} does not lie around {value:g}, above zero"
                raise MaterialError(where, what, "correct the card")
            found[name] = (low, high)
        if "young" in found:
            found = {"young": found["young"]}
        return cls(card.material, found) if found else None

    @classmethod
    def around(cls, material: Material, share: float) -> Posterior:
        """Return a posterior of a share to either side of the stiffness, on a scale of logarithms.

        Parameters
        ----------
        material
            A rubber or a lattice.
        share
            Share of its value by which each modulus is uncertain (95 %): 0.3 for 30 % more and as
            many times less.

        Raises
        ------
        MaterialError
            A share that is not above zero, or a material without moduli.
        """
        if not (share > 0.0 and math.isfinite(share)):
            raise MaterialError("spread", f"{share!r} is no share", "give 0.3 for 30 %")
        names = constants_of(material)
        moduli = ["young"] if "young" in names else [n for n, k in names.items() if k == "modulus"]
        if not moduli:
            what = f'"{material.model}" has no moduli'
            raise MaterialError("spread", what, "leave its part out")
        values = {name: constant_of(material, name) for name in moduli}
        ends = {n: (value / (1.0 + share), value * (1.0 + share)) for n, value in values.items()}
        return cls(material, ends)

    def draw(self, generator: np.random.Generator) -> Material:
        """Draw one material.

        Parameters
        ----------
        generator
            Source of the numbers; the same seed gives the same material.
        """
        drawn: dict[str, float] = {}
        for name, (low, high) in self.intervals.items():
            value, z = constant_of(self.material, name), float(generator.standard_normal())
            end = high if z > 0.0 else low
            drawn[name] = value * math.exp(abs(z) / _TWO_SIDES * math.log(end / value))
        return with_constants(self.material, drawn)


def _number(text: str, kind: str) -> float:
    return float(text) if kind == "number" else parse(text, kind)
