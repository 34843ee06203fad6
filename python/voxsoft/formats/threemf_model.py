"""A model file of 3MF as objects and items, read from its XML without document types."""

from __future__ import annotations

import math
from array import array
from dataclasses import dataclass, field
from typing import Final
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.formats.threemf_names import CORE, UNITS

_SCHEMAS: Final = "http://schemas.microsoft.com/3dmanufacturing"
_MATERIAL: Final = f"{_SCHEMAS}/material/2015/02"
_PRODUCTION: Final = f"{_SCHEMAS}/production/2015/06"
_BEAMS: Final = f"{_SCHEMAS}/beamlattice/2017/02"
#: Extensions that may be required: they add no geometry, or it is read or told.
_READ: Final = {
    _MATERIAL,
    _PRODUCTION,
    _BEAMS,
    f"{_SCHEMAS}/trianglesets/2021/07",
}
#: Names of others by their namespace.
_CALLED: Final = {
    "slice": "slices",
    "securecontent": "encryption",
    "volumetric": "volumetric data",
    "implicit": "implicit functions",
    "booleanoperations": "Boolean operations",
    "displacement": "displacement maps",
}
#: Types of objects that are material of the body.
SOLID: Final = "model"
_AFFINE: Final = 12

Floats = NDArray[np.float64]
#: Path of a model file in the package, "" for the main one, and number of an object in it.
Key = tuple[str, str]


@dataclass
class Placed:
    """An object at a place: an item of the build, or a component of another object."""

    key: Key
    turn: Floats
    shift: Floats


@dataclass
class Object:
    """An object: a mesh, or components.

    Attributes
    ----------
    kind
        Its type: ``model``, ``support`` or another.
    name
        Its name, or an empty text.
    points
        Vertices, (n, 3).
    triangles
        Triangles, (t, 3).
    materials
        Name of the material of each triangle, (t,); empty where it has none.
    components
        Objects that it is joined from.
    has_beams
        True if it has a lattice of beams.
    """

    kind: str
    name: str
    points: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    triangles: NDArray[np.int64] = field(default_factory=lambda: np.zeros((0, 3), np.int64))
    materials: list[str] = field(default_factory=list)
    components: list[Placed] = field(default_factory=list)
    has_beams: bool = False


class Model:
    """A model file.

    Parameters
    ----------
    where
        Name of the file, for messages.
    path
        Path of the model file in the package, "" for the main one.
    data
        Its XML.

    Raises
    ------
    FileError
        It is no XML or has a document type; it requires an extension that is not read; a number,
        index or transform is invalid.
    """

    def __init__(self, where: str, path: str, data: bytes) -> None:
        self.objects: dict[str, Object] = {}
        self.items: list[Placed] = []
        self.unit = UNITS["millimeter"]
        self._where, self._path = where, path
        self._materials: dict[str, list[str]] = {}
        self._namespaces: dict[str, str] = {}
        self._object: Object | None = None
        self._id = ""
        self._default: tuple[str | None, str | None] = (None, None)
        self._group: list[str] = []
        self._points, self._corners = array("d"), array("q")
        self._owners: list[tuple[str | None, str | None]] = []
        self._is_model = False
        parser = expat.ParserCreate(namespace_separator=" ")
        parser.StartDoctypeDeclHandler = self._on_doctype
        parser.StartNamespaceDeclHandler = self._on_namespace
        parser.StartElementHandler = self._on_start
        parser.EndElementHandler = self._on_end
        try:
            parser.Parse(data, True)
        except expat.ExpatError as error:
            what = f"is damaged: its model is no XML ({error})"
            raise FileError(where, what, "save or copy it again") from None
        except (KeyError, ValueError, OverflowError) as error:
            what = f"is damaged in line {parser.CurrentLineNumber} of its model: {error}"
            raise FileError(where, what, "save it again") from None
        if not self._is_model:
            raise FileError(where, "holds no model: its XML has no element <model>")

    def _on_doctype(self, *_: object) -> None:
        what = "has a document type in its model, which 3MF does not allow"
        raise FileError(self._where, what, "save it again by the program that it came from")

    def _on_namespace(self, prefix: str | None, uri: str) -> None:
        self._namespaces.setdefault(prefix or "", uri)

    def _on_start(self, tag: str, entries: dict[str, str]) -> None:
        reader = _READERS.get(tag)
        if reader is not None:
            reader(self, entries)

    def _model(self, entries: dict[str, str]) -> None:
        self._is_model = True
        unit = entries.get("unit", "millimeter")
        if unit not in UNITS:
            what = f"has the unit {unit!r}; 3MF knows {', '.join(UNITS)}"
            raise FileError(self._where, what, "save it in one of these")
        self.unit = UNITS[unit]
        for prefix in entries.get("requiredextensions", "").split():
            uri = self._namespaces.get(prefix, prefix)
            if uri not in _READ:
                called = next((name for key, name in _CALLED.items() if f"/{key}/" in uri), uri)
                what = f"requires the extension {prefix} of 3MF, {called}, which is not read"
                raise FileError(self._where, what, "export it as plain triangles")

    def _materials_start(self, entries: dict[str, str]) -> None:
        self._group = self._materials.setdefault(entries["id"], [])

    def _material(self, entries: dict[str, str]) -> None:
        self._group.append(entries.get("name") or entries.get("color", ""))

    def _object_start(self, entries: dict[str, str]) -> None:
        self._id = entries["id"]
        self._object = Object(entries.get("type", SOLID), entries.get("name", "").strip())
        self._default = (entries.get("pid"), entries.get("pindex"))
        self._points, self._corners, self._owners = array("d"), array("q"), []

    def _vertex(self, entries: dict[str, str]) -> None:
        for axis in "xyz":
            value = float(entries[axis])
            if not math.isfinite(value):
                raise ValueError(f"a coordinate is {value}")
            self._points.append(value)

    def _triangle(self, entries: dict[str, str]) -> None:
        for corner in ("v1", "v2", "v3"):
            self._corners.append(int(entries[corner]))
        group, index = self._default
        if "pid" in entries or "p1" in entries:
            group, index = entries.get("pid", group), entries.get("p1", index)
        self._owners.append((group, index))

    def _component(self, entries: dict[str, str]) -> None:
        if self._object is not None:
            self._object.components.append(self._placed(entries))

    def _item(self, entries: dict[str, str]) -> None:
        self.items.append(self._placed(entries))

    def _beams(self, _: dict[str, str]) -> None:
        if self._object is not None:
            self._object.has_beams = True

    def _placed(self, entries: dict[str, str]) -> Placed:
        path = entries.get(f"{_PRODUCTION} path", "").lstrip("/") or self._path
        numbers = [float(each) for each in entries.get("transform", "").split()]
        matrix = np.array(numbers or [1.0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0])
        if len(matrix) != _AFFINE or not np.isfinite(matrix).all():
            raise ValueError(f"a transform has {len(matrix)} numbers; expected 12 finite ones")
        turn = matrix[:9].reshape(3, 3)
        if np.linalg.det(turn) == 0.0:
            raise ValueError("a transform makes an object flat")
        return Placed((path, entries["objectid"]), turn, matrix[9:])

    def _on_end(self, tag: str) -> None:
        if tag != f"{CORE} object" or self._object is None:
            return
        made = self._object
        made.points = np.array(self._points).reshape(-1, 3)
        made.triangles = np.array(self._corners, dtype=np.int64).reshape(-1, 3)
        if len(made.triangles) and not (
            made.triangles.min() >= 0 and made.triangles.max() < len(made.points)
        ):
            raise ValueError(f"object {self._id} has a triangle with a vertex that is missing")
        if any(group is not None for group, _ in self._owners):
            made.materials = [self._called(group, index) for group, index in self._owners]
        if self._id in self.objects:
            raise ValueError(f"there are two objects {self._id}")
        self.objects[self._id], self._object = made, None

    def _called(self, group: str | None, index: str | None) -> str:
        names = self._materials.get(group or "", [])
        number = int(index or 0)
        return names[number] if 0 <= number < len(names) else ""


_READERS: Final = {
    f"{CORE} model": Model._model,
    f"{CORE} basematerials": Model._materials_start,
    f"{CORE} base": Model._material,
    f"{_MATERIAL} colorgroup": Model._materials_start,
    f"{_MATERIAL} color": Model._material,
    f"{CORE} object": Model._object_start,
    f"{CORE} vertex": Model._vertex,
    f"{CORE} triangle": Model._triangle,
    f"{CORE} component": Model._component,
    f"{CORE} item": Model._item,
    f"{_BEAMS} beamlattice": Model._beams,
}
