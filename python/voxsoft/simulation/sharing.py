"""How rigid objects are solved for beside planes of symmetry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Sharing:
    """How an object is solved for beside planes of symmetry.

    Attributes
    ----------
    of, signs
        The number of the free object that it is the image of, and by what vectors are multiplied;
        None for one that is solved for itself.
    share
        The part of it that is solved for.
    held
        The axes along which it cannot move: across planes that cut it.
    """

    of: int | None = None
    signs: Sequence[float] = (1.0, 1.0, 1.0)
    share: float = 1.0
    held: Sequence[bool] = (False, False, False)
