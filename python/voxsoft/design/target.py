"""Objectives and constraints: goals of a study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import (
    Field,
    SerializationInfo,
    SerializerFunctionWrapHandler,
    ValidationInfo,
    model_serializer,
    model_validator,
)

from voxsoft.design.chamber import CavityChoice
from voxsoft.design.operands import Name
from voxsoft.design.parameter import AnyQuantity, as_one_kind, read_quantity, write_quantities
from voxsoft.design.region import Region
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import Point, Proportion, read_from_file

Axis = Literal["x", "y", "z"]
Along = Literal["last", "largest", "smallest", "mean"]


class Objective(Record):
    """A metric to make as large or as small as possible.

    Parameters
    ----------
    maximize, minimize
        Name of the metric, such as ``"displacement"``; give one of the two.
    probe
        Place of the measurement, for a metric that needs a place.
    base
        Another probe, where the line to the first one begins, for a metric that needs a line.
    axis
        The component; default: the magnitude.
    cavity
        The name of a chamber of the design, or the index of a cavity; 0 is the largest. Default:
        ``"all"``.
    percentile
        Percentile of a metric that takes the largest of all voxels: that share of the volume stays
        at or below, above 0 and at most 100; default: 100.
    accuracy
        The error to leave of it, as a part of its size, ``"2 %"``: a run takes as small voxels as
        that needs. Default: as the solver says, or none.
    object
        The other side of a contact, for a metric of contact: the name of an object, or
        ``"body"`` for the body with itself. Default: the only object there is.
    tendon
        The name of a tendon, for a metric of one. Default: the only one there is.
    clamp
        The name of a clamp, or its place, ``"clamps[0]"``, for a metric of supports. Default: all
        that hold the body.
    region
        Place where supports count, in the unloaded body. Default: everywhere.
    about
        Point of a moment, ``["40 mm", 0, 0]``; with `axis` the moment is that about the line
        through it along this axis. Default: the origin.
    along
        The number of a path of equilibria that counts: ``"last"``, ``"largest"``, ``"smallest"`` or
        ``"mean"``. Default: the last. Without a path there is only one.

    Examples
    --------
    >>> rise = Objective(maximize="displacement", probe="top", axis="z")
    >>> rise.metric, rise.direction
    ('displacement', 'maximize')
    """

    maximize: Name | None = None
    minimize: Name | None = None
    probe: Name | None = None
    base: Name | None = None
    axis: Axis | None = None
    cavity: CavityChoice | None = None
    percentile: float | None = Field(None, gt=0, le=100)
    object: Name | None = None
    tendon: Name | None = None
    clamp: Name | None = None
    region: Region | None = None
    about: Point | None = None
    along: Along | None = None
    accuracy: Proportion | None = None

    @model_validator(mode="after")
    def _one_direction(self) -> Objective:
        if (self.maximize is None) == (self.minimize is None):
            raise DesignError("", "needs one of maximize and minimize")
        return self

    @property
    def metric(self) -> str:
        """Name of the metric."""
        return self.maximize or self.minimize or ""

    @property
    def direction(self) -> Literal["maximize", "minimize"]:
        """Which way is better."""
        return "maximize" if self.maximize else "minimize"


class Constraint(Record):
    """A metric to keep within bounds.

    Parameters
    ----------
    metric
        Name of the metric.
    probe, base, axis, cavity, percentile, object, tendon, clamp, region, about, along, accuracy
        See :class:`Objective`.
    min, max
        The bounds, with units where the metric has one; at least one of them.
    kind
        The kind of quantity of the bounds, found from their unit.

    Examples
    --------
    >>> Constraint(metric="mass", max="30 g").max
    0.03
    """

    metric: Name
    probe: Name | None = None
    base: Name | None = None
    axis: Axis | None = None
    cavity: CavityChoice | None = None
    percentile: float | None = Field(None, gt=0, le=100)
    object: Name | None = None
    tendon: Name | None = None
    clamp: Name | None = None
    region: Region | None = None
    about: Point | None = None
    along: Along | None = None
    accuracy: Proportion | None = None
    min: AnyQuantity | None = None
    max: AnyQuantity | None = None
    kind: str = "number"

    @model_validator(mode="before")
    @classmethod
    def _read_bounds(cls, data: Any, info: ValidationInfo) -> Any:  # noqa: ANN401
        """Read the bounds as a parameter reads its range: one kind, SI inside."""
        if not isinstance(data, Mapping):
            return data
        from_file = read_from_file(info)
        bounds = {
            name: read_quantity(data[name], name)
            for name in ("min", "max")
            if data.get(name) is not None
        }
        # A bare bound is fine where the metric has no unit, so it cannot be refused here.
        return {**data, **as_one_kind(bounds, data.get("kind"), from_file=from_file)}

    @model_validator(mode="after")
    def _bounded(self) -> Constraint:
        if self.min is None and self.max is None:
            raise DesignError("", "has no bound", "give min or max")
        if self.min is not None and self.max is not None and self.min > self.max:
            raise DesignError("min", "is above max", "swap the two")
        return self

    @model_serializer(mode="wrap")
    def _written(
        self, handler: SerializerFunctionWrapHandler, info: SerializationInfo
    ) -> dict[str, Any]:
        """Write the bounds with their units in JSON mode."""
        return write_quantities(handler(self), self.kind, info)
