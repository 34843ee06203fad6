"""Assembly of a design of several bodies: the contents of all their designs in one list."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.activation import AnyActivation
from voxsoft.design.attachment import Attachment
from voxsoft.design.body import Body
from voxsoft.design.clamp import Clamp
from voxsoft.design.contact import BODY, FLOOR
from voxsoft.design.isometry import SAME, Isometry, rotation_of
from voxsoft.design.layer import Layer
from voxsoft.design.mirrored import mirrored_activation, mirrored_part, mirrored_region
from voxsoft.design.part import Part
from voxsoft.design.references import operand_names
from voxsoft.design.region import Region
from voxsoft.design.tendon import Guide, Tendon
from voxsoft.errors import DesignError, ErrorDetail, VoxSoftError
from voxsoft.records import Record
from voxsoft.shapes import Shape

if TYPE_CHECKING:
    from voxsoft.design.model import Design

Floats = NDArray[np.float64]

#: Parts of a mesh are numbered from 1 to this, with room for objects.
_MOST_PARTS: Final = 250


@dataclass
class Assembly:
    """Contents of a design and of its bodies' designs, in one list.

    Attributes
    ----------
    entries
        Entries of the design that replace its own.
    origins
        Source of each entry that came from the design of a body: for ``clamps[2]``
        ``bodies[0].design: clamps[0]``.
    left_out
        Entries of the bodies' designs that stay behind although they decide something.
    """

    entries: dict[str, Any]
    origins: dict[str, str] = field(default_factory=dict)
    left_out: list[ErrorDetail] = field(default_factory=list)
    empty_shapes: list[str] = field(default_factory=list)

    @classmethod
    def of(cls, design: Design) -> Assembly:
        """Assemble a design whose bodies :func:`body_problems` has nothing to say about.

        Raises
        ------
        DesignError
            Entries that cannot be expressed in the frame of the design, such as a clamp along a
            turned axis.
        """
        lists = (
            *("layers", "springs", "tendons", "activations", "clamps", "loads"),
            *("supplies", "connections"),
        )
        tables = ("shapes", "chambers", "probes")
        found = cls({key: [*getattr(design, key)] for key in lists})
        found.entries |= {key: dict(getattr(design, key)) for key in tables}
        found.entries |= {"bodies": [], "parts": []}
        for index, body in enumerate(design.bodies):
            if body.included is None:
                own = body.parts or [part for part in design.parts if part.body == body.name]
                found.entries["parts"] += [part.replace(body=body.name) for part in own]
                found.entries["bodies"].append(body.replace(parts=()))
            else:
                included = _Included(design, body, body.included.assembled, f"bodies[{index}]")
                included.add_to(found)
        count = len(found.entries["parts"])
        if count > _MOST_PARTS:
            what = f"have {count} parts together; at most {_MOST_PARTS} are allowed"
            raise DesignError("bodies", what, "join parts of one material, or leave bodies out")
        return found


def is_assembled(design: Design) -> bool:
    """Check if a design holds all entries in its own lists, parts in the order of their bodies."""
    names = [body.name for body in design.bodies]
    if any(body.included is not None or body.parts for body in design.bodies):
        return False
    order = [names.index(part.body) for part in design.parts if part.body in names]
    return order == sorted(order)


def body_problems(design: Design) -> Iterator[ErrorDetail]:
    """Find names that are there twice, and bodies and parts that do not belong to each other."""
    names = [body.name for body in design.bodies]
    taken = {BODY, FLOOR, *(each.name for each in design.objects)}
    for index, (body, name) in enumerate(zip(design.bodies, names, strict=True)):
        where = f"bodies[{index}]"
        if name in taken or name in names[:index]:
            what = f'the name "{name}" is taken'
            yield ErrorDetail(f"{where}.name", what, "give it another name")
        own = [part for part in design.parts if part.body == name]
        full = body.included is not None or bool(body.parts)
        if body.included is not None and body.included.mesh is not None:
            what = f"is the mesh {body.included.mesh.label}; several bodies need voxels"
            hint = 'make it of shapes, such as { kind = "mesh", path = "...", unit = "..." }'
            yield ErrorDetail(f"{where}.design", what, hint)
        if not full and not own:
            hint = 'name a design, or write parts = [{ shape = "...", material = "..." }]'
            yield ErrorDetail(where, "has neither a design nor parts", hint)
        for number, part in enumerate(body.parts):
            if part.body not in (None, name):
                what = f'is of "{part.body}" and stands in "{name}"'
                yield ErrorDetail(f"{where}.parts[{number}].body", what, "leave body out")
    for index, part in enumerate(design.parts):
        where = f"parts[{index}].body"
        if part.body is None and names:
            what = "is missing: the design has several bodies"
            yield ErrorDetail(where, what, f'name one of them, such as body = "{names[0]}"')
        elif part.body in names:
            body = design.bodies[names.index(part.body)]
            if body.included is not None or body.parts:
                what = f'"{part.body}" has {"a design" if body.included else "parts"} of its own'
                yield ErrorDetail(where, what, "write the part there, or make another body")
    if names:
        for index, layer in enumerate(design.layers):
            if layer.region.body is None:
                what = "is missing: a layer is bonded to one body"
                hint = f'name it, such as region = {{ body = "{names[0]}", z = [0, 0] }}'
                yield ErrorDetail(f"layers[{index}].region.body", what, hint)


def nothing_built(document: Mapping[str, Any]) -> Iterator[ErrorDetail]:
    """A design is of parts, or of bodies, and on voxels of some size."""
    if "voxel_size" not in document:
        yield ErrorDetail("voxel_size", "is missing")
    if not document.get("bodies"):
        if document.get("parts") is None:
            yield ErrorDetail("parts", "is missing")
        elif document["parts"] in ([], ()):
            yield ErrorDetail("parts", "has 0 entries; expected at least 1")


def entries_alone(design: Design, body: str) -> dict[str, Any]:
    """Entries of a design of one body of an assembled one, in its own frame: its parts and grid.

    Empty where the design has no bodies.
    """
    own = next((each for each in design.bodies if each.name == body), None)
    if own is None:
        return {}
    parts = [part.replace(body=None) for part in design.parts if part.body == body]
    return {
        "name": body,
        "voxel_size": own.voxel_size or design.voxel_size,
        "fill": own.fill or design.fill,
        "shapes": _used(design.shapes, parts),
        "materials": design.materials,
        "parts": parts,
    }


def _used(shapes: Mapping[str, Shape], parts: Iterable[Part]) -> dict[str, Shape]:
    """The shapes that some parts are made of, by name."""
    found: dict[str, Shape] = {}
    waiting = [name for part in parts for name in _names_in(part.shape)]
    while waiting:
        name = waiting.pop()
        if name not in found and name in shapes:
            found[name] = shapes[name]
            waiting += _names_in(shapes[name])
    return {name: found[name] for name in shapes if name in found}


def _names_in(shape: str | Shape) -> list[str]:
    if isinstance(shape, str):
        return [shape]
    return [name for _, name in operand_names(shape, ())]


def with_origins(error: VoxSoftError, design: Design) -> VoxSoftError:
    """An error about an assembled design with places as its files have them."""
    whole = design.assembled
    if all(whole.origin_of(each.where) == each.where for each in error.problems):
        return error
    return type(error).listing(
        ErrorDetail(whole.origin_of(each.where), each.what, each.hint) for each in error.problems
    )


def voxel_size_of(design: Design, part: Part) -> float:
    """The voxel size [m] of the body that a part of an assembled design is of."""
    sizes = {body.name: body.voxel_size for body in design.bodies}
    own = None if part.body is None else sizes.get(part.body)
    return design.voxel_size if own is None else own


def _fill_of(design: Design) -> str:
    """The `fill` of a design of one body, given or by default."""
    return "fraction" if design.has_cut_voxels else "binary"


@dataclass
class _Included:
    """A design that is a body of another, or several."""

    outer: Design
    body: Body
    inner: Design
    where: str

    def add_to(self, found: Assembly) -> None:
        """Add all that it says to an assembly."""
        entries = found.entries
        entries["bodies"] += self._bodies()
        entries["parts"] += [self._part(part) for part in self.inner.parts]
        entries["shapes"] |= {
            self._name(name): _renamed(shape, self.body.name)
            for name, shape in self.inner.shapes.items()
        }
        for key in ("chambers", "probes"):
            own: Mapping[str, Region] = getattr(self.inner, key)
            for name, place in own.items():
                entries[key][self._name(name)] = self._region(place, f"{key}.{name}")
        self._extend(found, "layers", [self._layer(*each) for each in enumerate(self.inner.layers)])
        self._extend(found, "clamps", [self._clamp(*each) for each in enumerate(self.inner.clamps)])
        springs = [self._attachment(*each) for each in enumerate(self.inner.springs)]
        self._extend(found, "springs", springs)
        tendons = [self._tendon(*each) for each in enumerate(self.inner.tendons)]
        self._extend(found, "tendons", tendons)
        activations = [self._activation(each) for each in self.inner.activations]
        self._extend(found, "activations", activations)
        loads = [(i, load) for i, load in enumerate(self.inner.loads) if _is_of_a_place(load)]
        placed = [self._load(*each) for each in loads]
        self._extend(found, "loads", placed, [index for index, _ in loads])
        for key in ("supplies", "connections"):
            self._extend(found, key, [self._fed(each) for each in getattr(self.inner, key)])
        found.left_out += self._left_behind()
        found.empty_shapes += [self._name(name) for name in self.inner.empty_shapes]

    def _extend(
        self, found: Assembly, key: str, added: Sequence[Record], own: Sequence[int] | None = None
    ) -> None:
        start = len(found.entries[key])
        numbers = range(len(added)) if own is None else own
        for offset, number in enumerate(numbers):
            origin = f"{key}[{number}]"
            origin = self.inner.origin_of(origin)
            found.origins[f"{key}[{start + offset}]"] = f"{self.where}.design: {origin}"
        found.entries[key] += added

    def _name(self, name: str) -> str:
        return f"{self.body.name}.{name}"

    def _of_body(self, name: str | None, where: str) -> str:
        """Name in the outer design of a body of the inner one."""
        if not self.inner.bodies:
            return self.body.name
        if name is None:
            what = f"{where}: names no body, and the design has several"
            hint = "within another design each place must be of one body: add body"
            raise DesignError(f"{self.where}.design", what, hint)
        return self._name(name)

    def _bodies(self) -> Iterator[Body]:
        rotation, position = self.body.pose
        if not self.inner.bodies:
            size, fill = self.body.voxel_size, self.body.fill
            yield Body(
                name=self.body.name,
                voxel_size=self.inner.voxel_size if size is None else size,
                fill=_fill_of(self.inner) if fill is None else fill,
                position=self.body.position,
                rotation=self.body.rotation,
            )
            return
        for key in ("voxel_size", "fill"):
            if getattr(self.body, key) is not None:
                what = "is that of one body, and the design has several"
                raise DesignError(f"{self.where}.{key}", what, "set it in that design")
        mirror = self._mirror
        for inner in self.inner.bodies:
            turn, way = inner.pose
            # Their parts are mirrored in their own frames: M (R x + p) = (M R M) M x + M p.
            yield Body(
                name=self._name(inner.name),
                voxel_size=inner.voxel_size or self.inner.voxel_size,
                fill=_fill_of(self.inner.alone(inner.name)),
                position=tuple((rotation @ mirror @ way + position).tolist()),
                rotation=rotation_of(rotation @ mirror @ turn @ mirror),
            )

    @property
    def _mirror(self) -> Floats:
        """The matrix of the mirror, (3, 3); that of no change without one."""
        return np.diag([-1.0 if axis == self.body.mirror else 1.0 for axis in "xyz"])

    @property
    def _frame(self) -> tuple[Floats, Floats]:
        """From points of the inner design to those of the outer one: ``x = A @ inner + b``."""
        rotation, position = self.body.pose
        return rotation @ self._mirror, position

    def _part(self, part: Part) -> Part:
        if self.body.mirror is not None:
            part = mirrored_part(part, self.body.mirror)
        material = part.material
        if isinstance(material, str) and material in {
            **self.inner.materials,
            **self.outer.materials,
        }:
            material = self.inner.material_of(part)
        return part.replace(
            shape=_renamed(part.shape, self.body.name),
            material=material,
            name=None if part.name is None else self._name(part.name),
            body=self._of_body(part.body, "parts"),
        )

    def _region(self, region: Region, where: str) -> Any:  # noqa: ANN401 - of the same class
        if self.body.mirror is not None:
            region = mirrored_region(region, self.body.mirror)
        shape = None if region.shape is None else _renamed(region.shape, self.body.name)
        return region.replace(body=self._of_body(region.body, where), shape=shape)

    def _layer(self, index: int, layer: Layer) -> Layer:
        name = None if layer.name is None else self._name(layer.name)
        return layer.replace(region=self._region(layer.region, f"layers[{index}]"), name=name)

    def _attachment(self, index: int, attachment: Attachment) -> Attachment:
        frame, position = self._frame

        def point(at: tuple[float, float, float]) -> tuple[float, float, float]:
            x, y, z = (frame @ at + position).tolist()
            return x, y, z

        placed = attachment.placed(lambda region: self._region(region, f"springs[{index}]"), point)
        return placed if placed.name is None else placed.replace(name=self._name(placed.name))

    def _activation(self, activation: AnyActivation) -> AnyActivation:
        if self.body.mirror is not None:
            activation = mirrored_activation(activation, self.body.mirror)
        return activation.replace(part=self._name(activation.part))

    def _tendon(self, index: int, tendon: Tendon) -> Tendon:
        where = f"tendons[{index}]"

        def guide(at: Guide) -> Guide:
            if at.object is not None:
                what = f'{where}: runs over the object "{at.object}", and objects are left out'
                raise DesignError(f"{self.where}.design", what, "write the tendon in this design")
            if at.fixed is not None:
                frame, position = self._frame
                return at.replace(fixed=tuple((frame @ at.fixed + position).tolist()))
            own = tuple((self._mirror @ np.array(at.point)).tolist())
            return at.replace(body=self._of_body(at.body, where), point=own)

        placed = tendon.placed(guide)
        return placed if placed.name is None else placed.replace(name=self._name(placed.name))

    def _load(self, index: int, load: Record) -> Record:
        changes: dict[str, Any] = {}
        region, cavity = getattr(load, "region", None), getattr(load, "cavity", None)
        if region is not None:
            changes["region"] = self._region(region, f"loads[{index}]")
        if cavity is not None:
            changes["cavity"] = f"{self.body.name}.{cavity}"
        value = getattr(load, "value", None)
        if isinstance(value, tuple):
            changes["value"] = tuple((self._frame[0] @ value).tolist())
        return load.replace(**changes)

    def _fed(self, supply: Record) -> Record:
        """A supply or a connection of chambers by the names that they have in the outer design."""
        changes: dict[str, Any] = {}
        if (own := getattr(supply, "chamber", None)) is not None:
            changes["chamber"] = self._name(str(own))
        if own := getattr(supply, "chambers", ()):
            changes["chambers"] = tuple(self._name(str(each)) for each in own)
        if (name := getattr(supply, "name", None)) is not None:
            changes["name"] = self._name(name)
        return supply.replace(**changes)

    def _clamp(self, index: int, clamp: Clamp) -> Clamp:
        where = f"clamps[{index}]"
        motion = clamp.motion
        if motion is not None and self.body.motion is not None:
            what = f"a clamp of the design has a motion of its own ({where})"
            raise DesignError(f"{self.where}.motion", what, "keep one of the two")
        if motion is not None:
            motion = Isometry(*self._frame).motion(motion)
        axes = "".join(sorted(self._axis("xyz".index(axis), where) for axis in clamp.axes))
        return clamp.replace(
            name=None if clamp.name is None else self._name(clamp.name),
            region=self._region(clamp.region, where),
            axes="xyz" if clamp.axes == "xyz" else axes,
            motion=motion or self.body.motion,
        )

    def _axis(self, axis: int, where: str) -> str:
        """The axis of the outer design along which one of the inner one points."""
        along = np.abs(self.body.pose[0][:, axis])
        best = int(np.argmax(along))
        inner = self.inner.clamps
        if along[best] < 1.0 - SAME and any(clamp.axes != "xyz" for clamp in inner):
            if self._holds_all(where):
                return "xyz"[best]
            what = f"turns {where}, which holds along some axes only, away from the axes"
            hint = 'hold "xyz" there, or turn the body by quarter turns'
            raise DesignError(f"{self.where}.rotation", what, hint)
        return "xyz"[best]

    def _holds_all(self, where: str) -> bool:
        index = int(where.removeprefix("clamps[").removesuffix("]"))
        return self.inner.clamps[index].axes == "xyz"

    def _left_behind(self) -> Iterator[ErrorDetail]:
        """Report entries that affect the inner design alone and that the outer one lacks."""
        name = f"{self.where}.design"
        if self.inner.floor is not None and self.outer.floor is None:
            what = f'the floor of "{self.inner.name}" is left out: a floor is that of all'
            yield ErrorDetail(name, what, "write [floor] in this design if there is one")
        everywhere = [load for load in self.inner.loads if not _is_of_a_place(load)]
        if everywhere and all(_is_of_a_place(load) for load in self.outer.loads):
            what = f'the {everywhere[0].kind} of "{self.inner.name}" is left out: it is that of all'
            hint = f'write [[loads]] kind = "{everywhere[0].kind}" in this design if it counts'
            yield ErrorDetail(name, what, hint)
        if self.inner.refine:
            what = f'the local refinement of "{self.inner.name}" is left out'
            hint = "write [[refine]] in this design, with the body in its region"
            yield ErrorDetail(name, what, hint)
        if self.inner.objects:
            what = f'the objects of "{self.inner.name}" are left out'
            yield ErrorDetail(
                name, what, "write those that belong to this design under [[objects]]"
            )
        if self.inner.contact is not None and self.outer.contact is None:
            what = f'the contact of "{self.inner.name}" is left out, and its friction too'
            yield ErrorDetail(name, what, "write [contact] in this design")


def _is_of_a_place(load: Record) -> bool:
    """Check if a load acts at a place of a body and not on everything, as gravity does."""
    fields = type(load).model_fields
    return "region" in fields or "cavity" in fields


def _renamed(shape: Any, prefix: str) -> Any:  # noqa: ANN401 - a name, or a shape of any kind
    """A shape whose names begin with that of a body."""
    if isinstance(shape, str):
        return f"{prefix}.{shape}"
    operands = getattr(shape, "of", None)
    if operands is None:
        return shape
    if isinstance(operands, tuple):
        return shape.replace(of=tuple(_renamed(each, prefix) for each in operands))
    return shape.replace(of=_renamed(operands, prefix))
