"""Bodies: several in one design, each on a grid of its own and in a pose of its own."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    ConfigDict,
    Field,
    PlainSerializer,
    PlainValidator,
    PrivateAttr,
    ValidationInfo,
    WithJsonSchema,
    model_validator,
)

from voxsoft.design.clamp import Motion, Rotation
from voxsoft.design.document.included import inner_design
from voxsoft.design.isometry import Isometry
from voxsoft.design.mirrored import Axis, Triple
from voxsoft.design.operands import Name, ParameterName
from voxsoft.design.parameter import Parameter
from voxsoft.design.part import Part
from voxsoft.errors import DesignError
from voxsoft.geometry import rotation_matrix
from voxsoft.records import FrozenDict, Record, Table
from voxsoft.units import KINDS, Point, PositiveLength, read_from_file, write_exactly

if TYPE_CHECKING:
    from voxsoft.design.model import Design

Floats = NDArray[np.float64]


def _design_or_path(value: object, info: ValidationInfo) -> Any:  # noqa: ANN401
    """A path as it is; a design, or the table of one."""
    if isinstance(value, (str, os.PathLike)):
        return os.path.abspath(value)  # noqa: PTH100 - as text, and without asking the disk
    if isinstance(value, Mapping):
        return inner_design(value, from_file=read_from_file(info))
    from voxsoft.design.model import Design

    if not isinstance(value, Design):
        raise DesignError("", "is no design", 'name a file, such as "finger.toml"')
    return value


def _written(value: str | Design) -> object:
    return value if isinstance(value, str) else value.document


#: The path of a design file, or a design: the design itself in Python, its table in a file.
DesignOrPath = Annotated[
    Any,
    PlainValidator(_design_or_path),
    PlainSerializer(_written),
    WithJsonSchema(
        {
            "anyOf": [{"type": "string"}, {"type": "object"}],
            "description": "The path of another design file, from the folder of this one.",
        }
    ),
]


class Body(Record):
    """A body of a design: voxels on a grid of their own, in a pose of their own.

    Parameters
    ----------
    name
        Name in results and contact, and prefix of the names of its chambers and probes:
        ``"left.tip"``.
    design
        Another design, the same for as many bodies as you like: the path of its file from the
        folder of this one, or the design. Its parts, layers, springs, clamps, loads, chambers and
        probes come along, in its frame. Its floor, gravity, objects, contact, solver, objectives
        and constraints stay behind: these are the outer design's.
    set
        New values of the parameters of that design; formulas take those of the outer one.
    parts
        Parts of its own in place of a design; their shapes are those of the outer design.
    voxel_size, fill
        Grid of the body, as for :class:`Design`; default: those of `design`, for parts of the outer
        one.
    position, rotation
        Pose: first turned about its own origin, or the center that the rotation gives in the
        frame of the body, then moved.
    mirror
        ``"x"``, ``"y"`` or ``"z"``: the mirror image of `design` in the plane through its origin
        across that axis, before it is turned and moved. Shapes, fibers, places, forces and the
        motions of its clamps are mirrored, and so is the frame of the body.
    motion
        The way that all clamps of `design` go, as a robot's flange would move them; in the frame of
        the outer design. Default: they stay, or go the way that they have themselves.

    Raises
    ------
    DesignError
        Both a design and parts, a file that cannot be read, a parameter that is none, a mirror
        for parts of its own.

    Examples
    --------
    >>> from voxsoft.design import Design, Rotation, families
    >>> from voxsoft.units import mm
    >>> around = [
    ...     Body(
    ...         name=f"beam {angle}",
    ...         design=families.beam(),
    ...         set={"length": 50 * mm},
    ...         rotation=Rotation(axis=(0, 0, 1), angle=f"{angle} deg", center=(-20 * mm, 0, 0)),
    ...     )
    ...     for angle in (0, 120, 240)
    ... ]
    >>> star = Design(name="star", voxel_size=5 * mm, bodies=around)
    >>> [name for name in star.assembled.probes if name.endswith("9")]
    ['beam 0.station-9', 'beam 120.station-9', 'beam 240.station-9']
    """

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [
                {
                    "name": "block",
                    "parts": [
                        {
                            "shape": {"kind": "box", "size": ["20 mm", "20 mm", "20 mm"]},
                            "material": "ecoflex-00-30",
                        }
                    ],
                    "position": ["50 mm", 0, 0],
                }
            ]
        }
    )

    name: Name
    design: DesignOrPath | None = None
    set: Table[ParameterName, Parameter] = Field(default_factory=FrozenDict, max_length=200)
    parts: tuple[Part, ...] = Field((), max_length=250)
    voxel_size: PositiveLength | None = None
    fill: Literal["binary", "fraction"] | None = None
    position: Point = (0.0, 0.0, 0.0)
    rotation: Rotation | None = None
    mirror: Axis | None = None
    motion: Motion | None = None

    _included: Any = PrivateAttr(None)

    @model_validator(mode="after")
    def _read_design(self, info: ValidationInfo) -> Self:
        if self.design is None:
            for key in ("set", "mirror", "motion"):
                if getattr(self, key):
                    hint = f"name a design, or leave {key} out"
                    raise DesignError(key, "is for the design of a body, and there is none", hint)
            return self
        if self.parts:
            raise DesignError("parts", "the body has a design too", "keep one of them")
        ranged = [name for name, each in self.set.items() if each.min or each.max or each.step]
        if ranged:
            what = "has a range, which is the inner design's"
            raise DesignError(f"set.{ranged[0]}", what, "write the value alone")
        values = {name: _value(each, info) for name, each in self.set.items()}
        self._included = inner_design(self.design, values)
        # Numbers in SI units are of the kind of their parameter, and are written so.
        known = {name: self._included.parameters[name] for name in self.set}
        kinds = {name: each.replace(kind=known[name].kind) for name, each in self.set.items()}
        self.__dict__["set"] = FrozenDict(kinds)
        return self

    @property
    def included(self) -> Design | None:
        """The design that `design` means, with the values of `set`; None for parts of its own."""
        found: Design | None = self._included
        return found

    @property
    def pose(self) -> tuple[Floats, Floats]:
        """Rotation matrix, (3, 3), and position [m], (3,): ``x = rotation @ own + position``.

        With a mirror, `own` is a point of the mirror image.

        Examples
        --------
        >>> turned = Rotation(axis=(0, 0, 1), angle="90 deg")
        >>> rotation, position = Body(name="left", rotation=turned, position=(1, 0, 0)).pose
        >>> print(rotation @ (1, 0, 0) + position)
        [1. 1. 0.]
        """
        position = np.asarray(self.position)
        if self.rotation is None:
            return np.eye(3), position
        matrix = rotation_matrix(self.rotation.axis, self.rotation.angle)
        center = np.asarray(self.rotation.center)
        return matrix, position + center - matrix @ center

    def mirrored(self, name: str, axis: Axis, at: float = 0.0) -> Self:
        """Return the mirror image of this body in a plane of the outer design.

        Parameters
        ----------
        name
            Name of the image.
        axis
            Across which the plane is.
        at
            Position of the plane along the axis [m].

        Raises
        ------
        DesignError
            The body has parts of its own: only a design can be mirrored.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> left = Body(name="left", design=families.beam(), position=(0.03, 0, 0))
        >>> right = left.mirrored("right", "x")
        >>> right.position, right.mirror, right.rotation
        ((-0.03, 0.0, 0.0), 'x', None)
        """
        return self.replace(name=name, **Isometry.mirror(axis, at).changes(self))

    def arranged(
        self, names: Sequence[str], axis: Triple, center: Triple = (0.0, 0.0, 0.0)
    ) -> tuple[Self, ...]:
        """Return this body and copies of it, at equal angles around an axis.

        Parameters
        ----------
        names
            Names of the copies.
        axis
            Direction of the axis.
        center
            A point on it [m].

        Returns
        -------
        tuple of Body
            This one, and one for each name.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> first = Body(name="first", design=families.beam(), position=(0.03, 0, 0))
        >>> fingers = first.arranged(["second", "third"], axis=(0, 0, 1))
        >>> [round(float(np.rad2deg(finger.rotation.angle))) for finger in fingers[1:]]
        [120, 120]
        """
        step = 2.0 * np.pi / (len(names) + 1)
        turns = (Isometry.turn(axis, step * i, center) for i in range(1, len(names) + 1))
        copies = (
            self.replace(name=name, **turn.changes(self))
            for name, turn in zip(names, turns, strict=True)
        )
        return (self, *copies)


def _value(parameter: Parameter, info: ValidationInfo) -> str | float:
    """A value as the inner design reads it: text, or a number in SI units."""
    if KINDS[parameter.kind].units:
        return write_exactly(parameter.value, parameter.kind)
    # In a file a number without unit is one; a number typed in Python may be meant in SI units.
    return f"{parameter.value!r}" if read_from_file(info) else parameter.value
