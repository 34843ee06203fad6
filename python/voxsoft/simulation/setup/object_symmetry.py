"""Treatment of rigid objects beside planes of symmetry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Sharing:
    """Treatment of an object beside planes of symmetry: solved by itself, or as an image.

    Attributes
    ----------
    of, signs
        The number of the free object that it is the image of, and the factors on its vectors; None
        for an object that is solved by itself.
    share
        The part of it that is solved.
    held
        The axes along which it cannot move: across planes that cut it.
    """

    of: int | None = None
    signs: Sequence[float] = (1.0, 1.0, 1.0)
    share: float = 1.0
    held: Sequence[bool] = (False, False, False)
