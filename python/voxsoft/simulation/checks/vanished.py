"""Subtracted shapes that the parameters leave without size."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.simulation.diagnostic import Diagnostic


def vanished_shapes(
    design: Design, mesh: Mesh | None = None, positions: NDArray[np.float64] | None = None
) -> Iterator[Diagnostic]:
    """Warn of shapes that are not subtracted: a formula makes a size of them zero or negative.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> solid = families.cylinder(radius="20 mm", wall="20 mm")
    >>> print(*vanished_shapes(solid))  # doctest: +ELLIPSIS
    shapes.cavity: a formula leaves it without size, and nothing is subtracted. Try: ...
    """
    for name in design.empty_shapes:
        yield Diagnostic(
            "warning",
            f"shapes.{name}",
            "a formula leaves it without size, and nothing is subtracted",
            "make walls thinner or the body larger, unless it is meant to be solid there",
        )
