"""Springs between places of a body, or to fixed points."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, ClassVar, Self

import numpy as np
from pydantic import ConfigDict, model_validator

from voxsoft import _core_data
from voxsoft.design.attachment import AttachingBody, Attachment
from voxsoft.design.region import Probe, Region
from voxsoft.errors import DesignError
from voxsoft.units import NonNegativeLength, Point, UnitOf, format_quantity

#: Vertices of both ends together: the stiffness joins each of them with each other.
_MOST_VERTICES = 400


class Spring(Attachment):
    """A linear spring between two places of the body, or between one and a fixed point.

    Parameters
    ----------
    at
        The first end: a point of the undeformed body, or a region, at whose mean it pulls.
    stiffness
        Force per stretch, above zero.
    to
        The second end, on the body too. Give this or `anchor`.
    anchor
        The second end as a point in space that does not move, on the body or off it.
    length
        The length at which it pulls at nothing; default: as long as it is on the unloaded body.
        A spring that is shorter than this pushes.
    name
        Name in results.

    Notes
    -----
    The energy is ``k (d − L)²/2`` with the distance ``d`` of the two ends. It has no mass, and
    passes through the body and through obstacles.

    Examples
    --------
    >>> tie = Spring(at=Probe(point=("100 mm", 0, 0)), anchor=("100 mm", 0, "50 mm"), stiffness=20)
    >>> tie.stiffness
    20.0
    >>> Spring(at=Probe(point=(0, 0, 0)), stiffness="20 N/m")
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: has no second end. Try: give "to", a place on the body, or "anchor"
    """

    term: ClassVar[str] = "springs"

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [
                {"at": {"z": [0, 0]}, "anchor": [0, 0, "-20 mm"], "stiffness": "10 N/m"},
            ]
        }
    )

    at: Probe
    stiffness: Annotated[float, UnitOf("stiffness", positive=True)]
    to: Probe | None = None
    anchor: Point | None = None
    length: NonNegativeLength | None = None

    @model_validator(mode="after")
    def _has_two_ends(self) -> Spring:
        if self.to is None and self.anchor is None:
            what, hint = "has no second end", 'give "to", a place on the body, or "anchor"'
            raise DesignError("", what, hint)
        if self.to is not None and self.anchor is not None:
            raise DesignError("", 'has both "to" and "anchor"', "keep one of them")
        return self

    @property
    def places(self) -> tuple[Probe | Point, ...]:
        """Its two ends."""
        return self.at, self.to or self.anchor or (0.0, 0.0, 0.0)

    @property
    def summary(self) -> str:
        """Its stiffness."""
        return f"spring of {format_quantity(self.stiffness, 'stiffness')}"

    def placed(self, region: Callable[[Region], Region], point: Callable[[Point], Point]) -> Self:
        """Return the same for a body in another frame; see :meth:`Attachment.placed`."""
        placed = super().placed(region, point)
        return placed if self.anchor is None else placed.replace(anchor=point(self.anchor))

    def element(self, body: AttachingBody, where: str) -> _core_data.Spring:
        """Return the core's `Spring`; see :meth:`Attachment.element`."""
        first = body.place(self.at, f"{where}.at")
        ends = [(first, 1.0)]
        along = body.position(first)
        if self.to is not None:
            second = body.place(self.to, f"{where}.to")
            ends.append((second, -1.0))
            along = along - body.position(second)
        anchor = (0.0, 0.0, 0.0) if self.anchor is None else self.anchor
        distance = float(np.linalg.norm(along - np.asarray(anchor)))
        vertices, which = np.unique(
            np.concatenate([place.vertices for place, _ in ends]), return_inverse=True
        )
        signed = np.concatenate([sign * place.weights for place, sign in ends])
        weights = np.bincount(which, weights=signed)
        if len(vertices) > _MOST_VERTICES:
            what = f"its ends hold {len(vertices):,} vertices; at most {_MOST_VERTICES} are allowed"
            raise DesignError(where, what, "give a point or a smaller region")
        if not np.abs(weights).max() > 1e-9:
            raise DesignError(where, "both ends are the same place", "move one of them")
        if distance == 0.0 and self.length:
            shown = format_quantity(self.length, "length")
            what = f"its ends are on one spot, so a length of {shown} has no direction"
            raise DesignError(where, what, "move an end, or leave the length out")
        return {
            "vertices": vertices.tolist(),
            "weights": weights.tolist(),
            "anchor": list(anchor),
            "length": distance if self.length is None else self.length,
            "stiffness": self.stiffness,
        }
