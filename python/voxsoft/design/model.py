"""The design: all it takes to build and load one robot.

Long because all entries, and all ways to read, change and write them, are of this one class.
"""

from __future__ import annotations

import copy
import os
from collections.abc import Iterable, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal, Self

from pydantic import (
    Field,
    ModelWrapValidatorHandler,
    PrivateAttr,
    ValidationError,
    ValidationInfo,
    model_validator,
)
from pydantic_core import PydanticSerializationError

from voxsoft.design.activation import AnyActivation
from voxsoft.design.assembly import (
    Assembly,
    body_problems,
    entries_alone,
    is_assembled,
    nothing_built,
)
from voxsoft.design.body import Body
from voxsoft.design.chamber import Chamber, ChamberName
from voxsoft.design.clamp import Clamp
from voxsoft.design.contact import BODY, Contact, contact_problems
from voxsoft.design.document.assignment import set_values
from voxsoft.design.document.documents import plain_document, with_absolute_paths, written_path
from voxsoft.design.document.emptiness import (
    holds_difference,
    with_stand_ins,
    without_empty_shapes,
)
from voxsoft.design.document.identity import NOT_PHYSICS, Hashes, with_fill
from voxsoft.design.document.kept_formulas import with_kept_formulas
from voxsoft.design.document.resolution import Document, Resolution, formulas, with_parameter_values
from voxsoft.design.document.schema import with_formulas
from voxsoft.design.file_mesh import FileMesh, mesh_problems, with_element_size
from voxsoft.design.history import History, with_named
from voxsoft.design.layer import Layer
from voxsoft.design.load import AnyLoad, Floor
from voxsoft.design.molds import Molds
from voxsoft.design.object import Object
from voxsoft.design.operands import MaterialName, Name, ParameterName
from voxsoft.design.parameter import Parameter
from voxsoft.design.part import Part
from voxsoft.design.references import Included, dangling_references, dangling_shapes, shape_names
from voxsoft.design.refinement import Refinement
from voxsoft.design.region import Probe
from voxsoft.design.solver import Solver
from voxsoft.design.spring import Spring
from voxsoft.design.supply import AnySupply, Connection
from voxsoft.design.symmetry import Symmetry, symmetry_problems
from voxsoft.design.target import Constraint, Objective
from voxsoft.design.tendon import Tendon
from voxsoft.errors import DesignError, ErrorDetail, FormulaError, VoxSoftError
from voxsoft.materials import AnyMaterial, Lattice, Material, is_card_path, load_card
from voxsoft.records import FrozenDict, Record, Table, plain_error, plain_values, problems_of
from voxsoft.shapes import AnyShape
from voxsoft.units import EXACT, FILE_CONTEXT, PositiveLength, format_quantity

if TYPE_CHECKING:
    from voxsoft.studio.outputs.html import LivePage

SCHEMA: Final = "voxsoft/1"
#: Types of entries that are records or hold them.
_OF_RECORDS: Final = (Record, tuple, Mapping)


class Design(Record):
    """A soft robot: parts, clamps, loads and measured quantities.

    One model reads a Python call, a dict and a design file. Wherever a value may stand, a
    dict or file may hold a formula of parameters instead, ``"= radius - wall"``; the attributes
    hold the values, in SI units.

    Parameters
    ----------
    name
        Name of the design.
    voxel_size
        Edge of a voxel. A design with a `mesh` has none; the attribute is then the edge of a cube
        with five of its tetrahedra.
    mesh
        The file whose tetrahedra are the body, in place of shapes on a grid.
    fill
        Treatment of cells that the surface cuts. ``"binary"``: full if the center is inside, else
        empty. ``"fraction"``: it carries the part of it that is inside, in mass, stiffness and
        pressure. Default: ``"binary"`` where a part is the spring lattice, else ``"fraction"``.
    shapes
        Named shapes, to be used by parts and by other shapes.
    parts
        Parts and their materials; the first one wins where parts overlap. In a design of
        several bodies each names its own.
    bodies
        Several bodies, each on a grid of its own and in a pose of its own; default: the parts are
        one body.
    description
        Free text.
    parameters
        Named values for formulas, with ranges for a study.
    materials
        Materials of this design, by name; a part may also name a material card.
    layers
        Thin layers of fabric, film or paper bonded to the body.
    springs
        Springs between places of the body, or to fixed points.
    tendons
        Lines through the body that are pulled.
    histories
        Histories by name, which loads, motions and tendons of a file call ``history``.
    activations
        Parts that are longer or shorter by themselves: swollen, warm, shrunk.
    clamps, loads, floor
        Supports, loads and the floor. There is no gravity without a :class:`Gravity` load.
    refine
        Regions in which voxels are half as large as elsewhere.
    symmetry
        Planes of symmetry: a half, quarter or eighth of the body is solved.
    objects, contact
        Rigid things beside the body, and contact with its friction.
    chambers
        Cavities by name, each found by its place; loads and metrics refer to them by ``cavity``.
    supplies, connections
        Drives of chambers as volumes of gas or liquid, and lines that let them exchange it.
    probes
        Named places to measure at.
    objectives, constraints
        Goals of a study of the design.
    molds
        Options for its molds.
    solver
        Choices about the solution.

    Raises
    ------
    DesignError
        Listing every problem with its place.
    FormulaError
        If only formulas are wrong.

    Examples
    --------
    >>> from voxsoft.shapes import Box
    >>> from voxsoft.units import mm
    >>> beam = Design(
    ...     name="beam",
    ...     voxel_size=5 * mm,
    ...     parameters={"length": "100 mm"},
    ...     shapes={"body": {"kind": "box", "size": ["= length", "10 mm", "10 mm"]}},
    ...     parts=[{"shape": "body", "material": "ecoflex-00-30"}],
    ... )
    >>> beam.shapes["body"].size
    (0.1, 0.01, 0.01)
    >>> beam.with_parameters(length=50 * mm).shapes["body"].size
    (0.05, 0.01, 0.01)
    """

    schema_: Literal["voxsoft/1"] = Field(SCHEMA, alias="schema")
    name: Name
    description: str = ""
    # Without a default in the schema; whether it is due, the mesh decides.
    voxel_size: PositiveLength = Field(default_factory=float)
    mesh: FileMesh | None = None
    fill: Literal["binary", "fraction"] | None = None
    parameters: Table[ParameterName, Parameter] = Field(default_factory=FrozenDict, max_length=200)
    shapes: Table[Name, AnyShape] = Field(default_factory=FrozenDict)
    materials: Table[MaterialName, AnyMaterial] = Field(default_factory=FrozenDict)
    parts: tuple[Part, ...] = Field((), max_length=250)
    bodies: tuple[Body, ...] = Field((), max_length=250)
    layers: tuple[Layer, ...] = Field((), max_length=250)
    springs: tuple[Spring, ...] = ()
    tendons: tuple[Tendon, ...] = Field((), max_length=250)
    histories: Table[Name, History] = Field(default_factory=FrozenDict, max_length=200)
    activations: tuple[AnyActivation, ...] = ()
    clamps: tuple[Clamp, ...] = ()
    loads: tuple[AnyLoad, ...] = ()
    floor: Floor | None = None
    refine: tuple[Refinement, ...] = Field((), max_length=250)
    symmetry: tuple[Symmetry, ...] = Field((), max_length=3)
    objects: tuple[Object, ...] = Field((), max_length=250)
    contact: Contact | None = None
    chambers: Table[ChamberName, Chamber] = Field(default_factory=FrozenDict)
    supplies: tuple[AnySupply, ...] = Field((), max_length=250)
    connections: tuple[Connection, ...] = Field((), max_length=250)
    probes: Table[Name, Probe] = Field(default_factory=FrozenDict)
    objectives: Table[Name, Objective] = Field(default_factory=FrozenDict)
    constraints: Table[Name, Constraint] = Field(default_factory=FrozenDict)
    molds: Molds | None = None
    solver: Solver = Solver()

    _source: Document = PrivateAttr(default_factory=dict)
    _typed: frozenset[str] = PrivateAttr(default=frozenset())
    _empty_shapes: tuple[str, ...] = PrivateAttr(default=())
    _assembled: Any = PrivateAttr(default=None)
    _origins: dict[str, str] = PrivateAttr(default_factory=dict)
    _left_out: tuple[ErrorDetail, ...] = PrivateAttr(default=())

    @classmethod
    def from_document(
        cls,
        document: Mapping[str, Any],
        overrides: Mapping[str, object] | None = None,
        *,
        from_file: bool = True,
    ) -> Self:
        """Make a design of plain data, as a design file holds it.

        Parameters
        ----------
        document
            Nested dicts and lists; formulas allowed.
        overrides
            New values of parameters by name: text with a unit, or numbers in SI units.
        from_file
            True if a bare number where a unit belongs is an error (default); else it is SI.

        Raises
        ------
        DesignError
            Listing every problem with its place.

        Examples
        --------
        >>> Design.from_document({"name": "ball", "voxel_size": 5})
        Traceback (most recent call last):
        ...
        voxsoft.errors.DesignError: 2 problems
          voxel_size: 5 has no unit; expected a length. Try: write "5 mm"
          parts: is missing
        """
        if isinstance(document, Mapping):
            document = with_absolute_paths(plain_values(document), Path())
        return cls._read(document, overrides or {}, None if from_file else frozenset(document))

    @classmethod
    def _read(
        cls,
        document: Mapping[str, Any],
        overrides: Mapping[str, object],
        typed: frozenset[str] | None,
        like: Self | None = None,
    ) -> Self:
        """Read a document; `typed` are its keys that were typed in Python, None for a file.

        `like` is a design of the same document with other values of its parameters.
        """
        context: dict[str, Any] = {"overrides": dict(overrides), "ready": True, "like": like}
        context |= {"typed": typed} if typed else FILE_CONTEXT
        try:
            return cls.model_validate(document, context=context)
        except ValidationError as error:
            raise plain_error(error, cls, document) from None

    @model_validator(mode="wrap")
    @classmethod
    def _resolve(
        cls, data: object, handler: ModelWrapValidatorHandler[Self], info: ValidationInfo
    ) -> Self:
        """Set parameters, evaluate formulas, then read the values."""
        if not isinstance(data, Mapping):
            return handler(data)
        context = info.context or {}
        source = data if context.get("ready") else with_absolute_paths(plain_values(data), Path())
        source = with_parameter_values(source, context.get("overrides", {}))
        like: Self | None = context.get("like")
        kept = {} if like is None else like._same_at_all_parameters
        found = Resolution.of({key: each for key, each in source.items() if key not in kept})
        if context.get("whole"):
            return handler(with_element_size(with_stand_ins(found.document))[0])
        document, empty = without_empty_shapes(found.document)
        document, unnamed = with_named(document)
        document |= kept
        document, unsized = with_element_size(document)
        problems = [*found.problems, *unnamed, *unsized]
        only_formulas = bool(found.problems) and not unnamed and not unsized
        included: Included | None = None
        try:
            design = handler(document)
        except ValidationError as error:
            wrong = [*problems_of(error, cls, document, found.reported), *nothing_built(document)]
        else:
            wrong = [*nothing_built(document), *design._assemble(empty)]
            wrong += [] if unsized or wrong or kept else mesh_problems(design)
            if not wrong:
                whole = design.assembled
                tables = frozenset(whole.chambers), frozenset(whole.probes)
                included = Included(design.body_names, *tables)
        problems, only_formulas = [*problems, *wrong], only_formulas and not wrong
        dangling: list[ErrorDetail] = []
        if like is None or not kept:
            dangling = list(dangling_references(document, empty, included))
        elif empty != like.empty_shapes:  # of all names only those of shapes can be lost
            moved = {key: each for key, each in document.items() if key not in kept}
            if like._shapes_named_by_same & {*empty} or any(dangling_shapes(moved, empty)):
                dangling = list(dangling_shapes(document, empty))
        if problems or dangling:
            error_type = FormulaError if only_formulas and not dangling else DesignError
            raise error_type.listing(dict.fromkeys([*problems, *dangling]))
        design._source, design._empty_shapes = source, empty
        is_file = context.get("source") == "file"
        design._typed = frozenset() if is_file else context.get("typed", frozenset(source))
        return design

    def _assemble(self, empty: tuple[str, ...]) -> list[ErrorDetail]:
        """Gather the entries of the designs of bodies; return their problems."""
        wrong = list(body_problems(self))
        if not wrong and not is_assembled(self):
            try:
                found = Assembly.of(self)
                entries = {**self._entries(), **found.entries}
                whole = self._read(entries, {}, frozenset(entries))
            except VoxSoftError as error:
                return [*error.problems]
            whole._empty_shapes = (*empty, *found.empty_shapes)
            whole._origins, whole._left_out = found.origins, tuple(found.left_out)
            self._assembled = whole
            return []  # lacks of contact and references are found in the whole
        floor = self.floor is not None
        wrong += symmetry_problems(self.symmetry)
        wrong += contact_problems(self.objects, self.contact, floor, self.body_names)
        return wrong

    @property
    def assembled(self) -> Self:
        """The design with all that the designs of its bodies say in lists of its own.

        Entries of a body have its name: the parts and regions by ``body``, chambers and probes by
        the beginning of their names. A design that is so already is returned as it is.
        """
        return self if self._assembled is None else self._assembled

    @property
    def body_names(self) -> tuple[str, ...]:
        """Names of the bodies in contact: ``"body"`` where there is but one without a name."""
        return tuple(body.name for body in self.assembled.bodies) or (BODY,)

    def alone(self, body: str) -> Self:
        """Return a design of one body, in its own frame: its parts and its grid, and no more.

        Parameters
        ----------
        body
            The name of a body, of :attr:`body_names`.

        Examples
        --------
        >>> from voxsoft.design import Body, families
        >>> beam = Body(name="left", design=families.beam(), position=(0, 0, 1))
        >>> pair = Design(name="one", voxel_size=0.01, bodies=[beam])
        >>> pair.alone("left").voxel_size
        0.005
        """
        entries = entries_alone(self.assembled, body)
        return type(self)(**entries) if entries else self

    def origin_of(self, where: str) -> str:
        """File and place of an entry of an assembled design; its own entries keep their place."""
        head, dot, rest = where.partition(".")
        return self._origins.get(head, head) + dot + rest

    @property
    def left_out(self) -> tuple[ErrorDetail, ...]:
        """Entries of the designs of bodies left out although they decide how these behave alone."""
        return self._left_out

    def __str__(self) -> str:
        try:
            return self.to_toml()
        except DesignError:  # it holds a Python function
            return super().__repr__()

    def __repr__(self) -> str:
        held = [
            f"{len(value)} {name}"
            for name, value in self._entries().items()
            if isinstance(value, (tuple, Mapping)) and value
        ]
        size = format_quantity(self.voxel_size, "length")
        body = f"voxels of {size}" if self.mesh is None else f"the mesh {self.mesh.label}"
        return f"<Design {self.name}: {body}, {', '.join(held)}>"

    @property
    def empty_shapes(self) -> tuple[str, ...]:
        """Names of subtracted shapes of which the parameters leave nothing."""
        return self._empty_shapes

    def is_typed(self, key: str) -> bool:
        """Check if an entry was typed in Python, where numbers may be without a unit."""
        return key in self._typed

    def material_of(self, part: Part) -> Material:
        """Return the material of a part: its own, one of this design's, or that of a card.

        Parameters
        ----------
        part
            A part of this design.

        Examples
        --------
        >>> from voxsoft.materials import Lattice
        >>> from voxsoft.shapes import Box
        >>> soft = Lattice(edge="20 kPa", bulk="100 kPa")
        >>> part = Part(shape=Box(size=(1, 1, 1)), material="soft")
        >>> cube = Design(name="cube", voxel_size=0.5, parts=[part], materials={"soft": soft})
        >>> cube.material_of(cube.parts[0]) == soft
        True
        """
        if not isinstance(part.material, str):
            return part.material
        own = self.materials.get(part.material)
        return load_card(part.material).material if own is None else own

    @property
    def has_cut_voxels(self) -> bool:
        """True if cells that the surface cuts carry a part: `fill`, given or by default, says so.

        A design of several bodies has them if one of its bodies has. A surface along the grid cuts
        no cell.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> beam = families.beam()
        >>> beam.has_cut_voxels, beam.replace(fill="binary").has_cut_voxels
        (True, False)
        """
        whole = self.assembled
        if whole.bodies:
            return any(whole.alone(body.name).has_cut_voxels for body in whole.bodies)
        if self.mesh is not None:
            return False
        if self.fill is not None:
            return self.fill == "fraction"
        return not any(isinstance(self.material_of(part), Lattice) for part in self.parts)

    def __eq__(self, other: object) -> bool:
        """Compare all values and all formulas, wherever the two came from."""
        if not isinstance(other, Design):
            return NotImplemented
        return self._entries() == other._entries() and self._formulas == other._formulas

    def __hash__(self) -> int:
        return hash(tuple(self._entries().values()))

    @property
    def _formulas(self) -> dict[tuple[str | int, ...], str]:
        """Formulas by their path; one that is all of a parameter is that of its value."""
        found = {written_path(path): formula for path, formula in formulas(self._source)}
        return {
            (*path, "value") if path[-2:-1] in (("parameters",), ("set",)) else path: formula
            for path, formula in found.items()
        }

    @property
    def document(self) -> Document:
        """The design as plain data with its formulas, as a file would hold it.

        Numbers have all their digits, so that reading it gives the same design.
        """
        if not self._typed:
            return copy.deepcopy(self._source)
        return plain_document(self._source, self._whole._dumped(context=EXACT), self._typed)

    @property
    def _whole(self) -> Self:
        """The design with its empty shapes, for writing it."""
        context = {"whole": True, "ready": True}
        return type(self).model_validate(self._source, context=context)

    @property
    def resolved(self) -> Document:
        """The design as plain data with every value in place of its formula.

        Raises
        ------
        DesignError
            A shape is made of a Python function: such a design has no document and no hash.
        """
        whole = self.assembled
        return with_fill(whole._dumped(cards=True), whole)

    def _dumped(
        self,
        exclude: Iterable[str] = (),
        context: Mapping[str, bool] | None = None,
        *,
        cards: bool = False,
    ) -> Document:
        """Plain data; with `cards`, materials in place of the paths of their cards."""
        try:
            unsaid = () if self.mesh is None else ("voxel_size", "fill")
            dumped = self.model_dump(
                mode="json",
                by_alias=True,
                exclude_none=True,
                exclude={*exclude, *unsaid},
                context=context,
            )
        except PydanticSerializationError as error:
            what = "hold a Python function, which no file can hold"
            raise DesignError("shapes", what, "write it as an expression") from error
        for table, part in zip(dumped.get("parts", ()), self.parts, strict=False):
            if cards and isinstance(part.material, str) and is_card_path(part.material):
                table["material"] = self.material_of(part).model_dump(
                    mode="json", by_alias=True, exclude_none=True
                )
        return {key: value for key, value in dumped.items() if value not in ("", {}, [])}

    @property
    def hash(self) -> str:
        """SHA-256, in hexadecimal, of all that decides the result of a simulation.

        Name, description, parameters, objectives and constraints do not count; values that
        formulas gave do. Numbers are rounded to 12 significant digits.
        """
        return Hashes().of(self)

    def physics(self, exclude: Iterable[str] = ()) -> Document:
        """Plain data of the entries that decide the result of a simulation.

        Parameters
        ----------
        exclude
            Keys of further entries to leave out.

        Raises
        ------
        DesignError
            A shape is made of a Python function.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> sorted(families.beam().physics({"loads", "probes"}))
        ['clamps', 'parts', 'shapes', 'solver', 'voxel_size']
        """
        dumped = self._dumped({*NOT_PHYSICS, *exclude}, cards=True)
        return {key: value for key, value in dumped.items() if key not in NOT_PHYSICS}

    def with_parameters(self, **values: float | str) -> Self:
        """Return the design with other values of its parameters.

        Parameters
        ----------
        **values
            Values by name: text with a unit, or numbers in SI units.

        Raises
        ------
        DesignError
            An unknown name, a value outside its range, or a design that is no longer valid.
        """
        return self._read(self._source, values, self._typed or None, self)

    @cached_property
    def _same_at_all_parameters(self) -> dict[str, Any]:
        """Records without formulas, by their keys; none of several bodies, or on a file's mesh.

        Nothing where a history has formulas: loads and motions hold a copy, not its name.
        """
        moved = {path[0] for path, _ in formulas(self._source)}
        if self.bodies or self.mesh is not None or "histories" in moved:
            return {}
        moved |= {"parameters", "shapes", "histories"}  # others use them by name
        moved |= {key for key, each in self._source.items() if holds_difference(each)}
        return {
            key: each
            for key, each in self._entries().items()
            if key in self._source and key not in moved and isinstance(each, _OF_RECORDS)
        }

    @cached_property
    def _shapes_named_by_same(self) -> frozenset[str]:
        """Names of shapes in the entries of :attr:`_same_at_all_parameters`."""
        return frozenset(name for _, name in shape_names(self._same_at_all_parameters))

    def replace(self, **changes: Any) -> Self:  # noqa: ANN401 - the fields declare the types
        """Return the design with other values of some of its entries, checked like new.

        Parameters
        ----------
        **changes
            New values by key, as the constructor takes them: ``loads=[...]``,
            ``voxel_size="2 mm"``. They take the place of all that stood there.

        Raises
        ------
        DesignError
            An unknown key, or a design that is no longer valid.

        Notes
        -----
        Formulas in all other entries stay, and follow new `parameters`. Of the entries that are
        replaced, those that come from this design as they are keep their formulas too.

        Examples
        --------
        >>> from voxsoft.design import Gravity, families
        >>> beam = families.beam()
        >>> light = beam.replace(loads=[Gravity(value="1.62 m/s^2")])
        >>> light.loads[0].value, light.with_parameters(length="50 mm").loads[0].value
        (1.62, 1.62)
        >>> beam.replace(lodas=[])
        Traceback (most recent call last):
        ...
        voxsoft.errors.DesignError: lodas: is not known here. Try: did you mean "loads"?
        """
        return self._with(changes, {})

    def _with(self, changes: Mapping[str, Any], overrides: Mapping[str, object]) -> Self:
        """Replace entries and set parameters."""
        known = with_absolute_paths(plain_values(self._known(changes)), Path())
        kept = with_kept_formulas(self._entries(), self._source, known)
        return self._read({**self._source, **kept}, overrides, self._typed | frozenset(kept))

    def with_values(self, *assignments: str, **values: Any) -> Self:  # noqa: ANN401
        """Return the design with any of its values changed.

        Parameters
        ----------
        *assignments
            Texts ``key=value`` as :func:`voxsoft.design.set_values` reads them, such as
            ``"voxel_size=2.5 mm"`` or ``"parts[0].material=ecoflex-00-50"``.
        **values
            Values by single names: a parameter of the design, else a key of it. Text with a
            unit, or numbers in SI units. They are set first.

        Raises
        ------
        DesignError
            A path that leads nowhere, or a design that is no longer valid.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> families.beam().with_values(voxel_size="2.5 mm", length="50 mm").voxel_size
        0.0025
        """
        changed = self
        if values:
            own = {name: value for name, value in values.items() if name in self.parameters}
            rest = {name: value for name, value in values.items() if name not in own}
            changed = self._with(rest, own)
        if not assignments:
            return changed
        return self.from_document(set_values(changed.document, assignments))

    def to_toml(self, *, resolved: bool = False) -> str:
        """Write the design as the text of a design file.

        Parameters
        ----------
        resolved
            True to write values in place of formulas.
        """
        # `files` lies above `design` in the layers; this method is the one convenience that
        # reaches up, and it does so when called, so that no import runs in a circle.
        from voxsoft.files.toml_text import write_toml

        return write_toml(self.resolved if resolved else self.document)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the design to a file, with its formulas.

        Parameters
        ----------
        path
            The file, by custom ``*.toml``; it is replaced if it exists.

        Raises
        ------
        FileError
            The file cannot be written.
        """
        from voxsoft.files.designs import save

        save(self, path)

    def show(self) -> LivePage:
        """Show the design as a page that is alive: in a notebook, or as a file with ``save``.

        The body moves in the browser, under hands and loads, with no server behind it.

        Raises
        ------
        VoxSoftError
            The design cannot be meshed or solved.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> "voxsoft-scene" in families.beam().show().text
        True
        """
        from voxsoft.studio.outputs.html import page_of

        return page_of(self)

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        """Return the JSON Schema of a design document, formulas included."""
        schema = with_formulas(cls.model_json_schema(by_alias=True))
        dialect = "https://json-schema.org/draft/2020-12/schema"
        return {"$schema": dialect, "$id": SCHEMA, **schema}
