"""The design: all it takes to build and load one robot."""

from __future__ import annotations

import os
from collections.abc import Mapping
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

from voxsoft.design.assignment import set_values
from voxsoft.design.clamp import Clamp
from voxsoft.design.documents import plain_document
from voxsoft.design.emptiness import without_empty_shapes
from voxsoft.design.identity import NOT_PHYSICS, hash_of
from voxsoft.design.layer import Layer
from voxsoft.design.load import AnyLoad, Floor
from voxsoft.design.operands import Name, ParameterName
from voxsoft.design.parameter import Parameter
from voxsoft.design.part import Part
from voxsoft.design.references import dangling_references
from voxsoft.design.region import Probe
from voxsoft.design.resolution import Document, resolve, with_parameter_values
from voxsoft.design.schema import with_formulas
from voxsoft.design.solver import Solver
from voxsoft.design.target import Constraint, Objective
from voxsoft.errors import DesignError
from voxsoft.materials import AnyMaterial, Material, load_card
from voxsoft.records import Record, plain_error
from voxsoft.shapes import AnyShape
from voxsoft.units import FILE_CONTEXT, PositiveLength

if TYPE_CHECKING:
    from voxsoft.studio.html import LivePage

SCHEMA: Final = "voxsoft/1"


class Design(Record):
    """A soft robot: parts, how it is held and loaded, and what to measure.

    The same model reads a Python call, a dict and a design file. Wherever a value may stand, a
    dict or file may hold a formula of parameters instead, ``"= radius - wall"``; the attributes
    hold the values, in SI units.

    Parameters
    ----------
    name
        What to call it.
    voxel_size
        Edge of a voxel.
    fill
        What a cell that the surface cuts becomes. ``"binary"`` (default): full if its center is
        inside, else empty. ``"fraction"``: it carries the part of it that is inside, in mass,
        stiffness and pressure.
    shapes
        Named shapes, to be used by parts and by other shapes.
    parts
        What is made of which material; the first one wins where parts overlap.
    description
        Free text.
    parameters
        Named values for formulas, with ranges for a study.
    materials
        Materials of this design, by name; a part may also name a material card.
    layers
        Thin layers of fabric, film or paper bonded to the body.
    clamps, loads, floor
        How it is held and loaded. There is no gravity without a :class:`Gravity` load.
    probes
        Named places to measure at.
    objectives, constraints
        What a study asks of the design.
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
    voxel_size: PositiveLength
    fill: Literal["binary", "fraction"] = "binary"
    parameters: dict[ParameterName, Parameter] = Field(default_factory=dict, max_length=200)
    shapes: dict[Name, AnyShape] = Field(default_factory=dict)
    materials: dict[Name, AnyMaterial] = Field(default_factory=dict)
    parts: tuple[Part, ...] = Field(min_length=1, max_length=250)
    layers: tuple[Layer, ...] = Field((), max_length=250)
    clamps: tuple[Clamp, ...] = ()
    loads: tuple[AnyLoad, ...] = ()
    floor: Floor | None = None
    probes: dict[Name, Probe] = Field(default_factory=dict)
    objectives: dict[Name, Objective] = Field(default_factory=dict)
    constraints: dict[Name, Constraint] = Field(default_factory=dict)
    solver: Solver = Solver()

    _source: Document = PrivateAttr(default_factory=dict)
    _from_file: bool = PrivateAttr(default=False)
    _empty_shapes: tuple[str, ...] = PrivateAttr(default=())

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
            Whether a bare number where a unit is due is an error (default), or SI.

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
          voxel_size: 5 has no unit; a length is due. Try: write "5 mm"
          parts: is missing
        """
        context = {**(FILE_CONTEXT if from_file else {}), "overrides": dict(overrides or {})}
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
        source = with_parameter_values(data, context.get("overrides", {}))
        resolved, empty = without_empty_shapes(resolve(source))
        design = handler(resolved)
        design._source, design._from_file = source, context.get("source") == "file"
        design._empty_shapes = empty
        problems = list(dangling_references(design))
        if problems:
            raise DesignError.listing(problems)
        return design

    def __str__(self) -> str:
        try:
            return self.to_toml()
        except DesignError:
            return repr(self)

    @property
    def empty_shapes(self) -> tuple[str, ...]:
        """Names of subtracted shapes of which the parameters leave nothing."""
        return self._empty_shapes

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
    def document(self) -> Document:
        """The design as plain data with its formulas, as a file would hold it."""
        return plain_document(self._source, self.resolved, from_file=self._from_file)

    @property
    def resolved(self) -> Document:
        """The design as plain data with every value in place of its formula.

        Raises
        ------
        DesignError
            A shape is made of a Python function: such a design has no document and no hash.
        """
        return self._values_without(frozenset())

    def _values_without(self, tables: frozenset[str]) -> Document:
        try:
            dumped = self.model_dump(
                mode="json", by_alias=True, exclude_none=True, exclude=set(tables)
            )
        except PydanticSerializationError as error:
            what = "hold a Python function, which no file can hold"
            raise DesignError("shapes", what, "write it as an expression") from error
        return {key: value for key, value in dumped.items() if value not in ("", {}, [])}

    @property
    def hash(self) -> str:
        """SHA-256, in hexadecimal, of all that decides the result of a simulation.

        Name, description, parameters, objectives and constraints do not count; values that
        formulas gave do. Numbers are rounded to 12 significant digits.
        """
        return hash_of(self._values_without(NOT_PHYSICS))

    def with_parameters(self, **values: float | str) -> Self:
        """Return the design with other values of its parameters.

        Parameters
        ----------
        **values
            By name: text with a unit, or numbers in SI units.

        Raises
        ------
        DesignError
            An unknown name, a value outside its range, or a design that is no longer valid.
        """
        return type(self).from_document(self._source, values, from_file=self._from_file)

    def with_values(self, *assignments: str) -> Self:
        """Return the design with any of its values changed.

        Parameters
        ----------
        *assignments
            Texts ``key=value`` as :func:`voxsoft.design.set_values` reads them, such as
            ``"voxel_size=2.5 mm"`` or ``"parts.0.material=ecoflex-00-50"``.

        Raises
        ------
        DesignError
            A path that leads nowhere, or a design that is no longer valid.
        """
        return type(self).from_document(set_values(self.document, assignments))

    def to_toml(self, *, resolved: bool = False) -> str:
        """Write the design as the text of a design file.

        Parameters
        ----------
        resolved
            Whether to write values in place of formulas.
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
        from voxsoft.studio.html import page_of

        return page_of(self)

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        """Return the JSON Schema of a design document, formulas included."""
        schema = with_formulas(cls.model_json_schema(by_alias=True))
        dialect = "https://json-schema.org/draft/2020-12/schema"
        return {"$schema": dialect, "$id": SCHEMA, **schema}
