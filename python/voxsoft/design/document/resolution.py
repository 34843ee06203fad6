"""From a design document with formulas to one with values only.

A document is the content of a TOML file: nested dicts and lists. :func:`resolve` replaces every
formula by its value with dimension (:class:`~voxsoft.units.Quantity`), so that the typed models
can still tell a length from an area.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from voxsoft.design.document.formula import evaluate, is_formula
from voxsoft.design.parameter import Parameter, kind_of, read_quantity
from voxsoft.errors import DesignError, ErrorDetail, FormulaError, VoxSoftError
from voxsoft.records import closest, place, steps_of
from voxsoft.units import KINDS, Dimension, Number, Quantity, describe_dimension, write_exactly

Document = dict[str, Any]
Path = tuple[str | int, ...]

LONGEST_CHAIN: Final = 50
DEEPEST_DOCUMENT: Final = 50
# Free text, where a leading "=" means nothing.
_PROSE: Final = frozenset({"name", "description"})


def resolve(document: Mapping[str, Any]) -> Document:
    """Replace every formula of a document by its value.

    Parameters
    ----------
    document
        The design document; it is not changed.

    Returns
    -------
    dict
        A new document. A formula has become a :class:`~voxsoft.units.Quantity`, or a
        :class:`~voxsoft.units.Number` where it has no dimension.

    Raises
    ------
    FormulaError
        Listing every formula that cannot be evaluated.
    DesignError
        The document nests too deep.

    Examples
    --------
    >>> resolve({"parameters": {"mu": "5 mm"}, "voxel_size": "= mu/2"})["voxel_size"].value
    0.0025
    """
    resolution = Resolution.of(document)
    if resolution.problems:
        raise FormulaError.listing(resolution.problems)
    return resolution.document


@dataclass
class Resolution:
    """A document with values in place of formulas, and the problems of these.

    Attributes
    ----------
    document
        The values; :data:`UNREAD` stands for a formula that has none.
    problems
        Problems, each once.
    reported
        Paths with problems.
    """

    document: Document
    problems: list[ErrorDetail]
    reported: set[Path]

    @classmethod
    def of(cls, document: Mapping[str, Any]) -> Resolution:
        """Evaluate every formula of a document; see :func:`resolve`."""
        found = cls({}, [], set())
        parameters = _Parameters(document.get("parameters"))
        found.document = dict(_resolve(document, (), parameters, found))
        found.problems = list(dict.fromkeys(found.problems))
        return found


def is_inner_design(path: Path) -> bool:
    """Check if a path of a document leads to a design within it, which has names of its own.

    Examples
    --------
    >>> is_inner_design(("bodies", 0, "design")), is_inner_design(("bodies", 0, "set"))
    (True, False)
    """
    return len(path) > 2 and path[-1] == "design" and path[-3] == "bodies"


class _Unread:
    """No value that any field takes."""

    def __repr__(self) -> str:
        return "a formula without a value"


UNREAD: Final = _Unread()


def with_parameter_values(document: Mapping[str, Any], overrides: Mapping[str, object]) -> Document:
    """Give parameters of a document other values.

    Parameters
    ----------
    document
        The design document; it is not changed.
    overrides
        New values by name: text with a unit, or a number in SI units.

    Raises
    ------
    DesignError
        A name that is no parameter.

    Examples
    --------
    >>> with_parameter_values({"parameters": {"wall": {"value": "5 mm"}}}, {"wall": "2 mm"})
    {'parameters': {'wall': {'value': '2 mm'}}}
    """
    if not overrides:
        return dict(document)
    declared = document.get("parameters")
    parameters = dict(declared) if isinstance(declared, Mapping) else {}
    unknown = [
        ErrorDetail(name, "is not a parameter of this design", closest(name, map(str, parameters)))
        for name in overrides
        if name not in parameters
    ]
    if unknown:
        raise DesignError.listing(unknown)
    before = _Parameters(declared)
    for name, value in overrides.items():
        written = _with_unit(value, before(name).dimension, f"parameters.{name}")
        old = parameters[name]
        if isinstance(old, Parameter):
            old = old.model_dump(exclude_none=True)
        parameters[name] = {**old, "value": written} if isinstance(old, Mapping) else written
    return {**document, "parameters": parameters}


def _with_unit(value: object, dimension: Dimension, where: str) -> object:
    """Check the unit of a parameter's new value, or give an SI number the unit it needs."""
    if is_formula(value):
        return value
    quantity = read_quantity(value, where)
    is_si = quantity.dimension == Dimension() and not isinstance(value, str)
    if quantity.dimension != dimension and quantity.value != 0 and not is_si:
        came, due = describe_dimension(quantity.dimension), describe_dimension(dimension)
        raise DesignError(where, f'"{value}" is {came}; expected {due}')
    kind = kind_of(dimension) or "number"
    if isinstance(value, str):
        return value
    if not KINDS[kind].units:
        return value if isinstance(value, int) else quantity.value
    return write_exactly(quantity.value, kind)


class _Parameters:
    """Values of parameters by name, evaluated when first asked for."""

    def __init__(self, declared: object) -> None:
        self._declared = declared if isinstance(declared, Mapping) else {}
        self._values: dict[str, Quantity] = {}
        self._asking: list[str] = []

    def __call__(self, name: str) -> Quantity:
        if name not in self._values:
            self._values[name] = self._evaluate(name)
        return self._values[name]

    def _evaluate(self, name: str) -> Quantity:
        if name not in self._declared:
            raise FormulaError(
                "", f'"{name}" is not a parameter', closest(name, map(str, self._declared))
            )
        if name in self._asking:
            circle = [*self._asking[self._asking.index(name) :], name]
            raise FormulaError("", f"runs in a circle: {' → '.join(circle)}")
        if len(self._asking) >= LONGEST_CHAIN:
            raise FormulaError("", f"chains more than {LONGEST_CHAIN} parameters")
        self._asking.append(name)
        try:
            return self._value_of(name)
        finally:
            self._asking.pop()

    def _value_of(self, name: str) -> Quantity:
        declared = self._declared[name]
        if isinstance(declared, Parameter):
            return Quantity(declared.value, declared.dimension)
        value = declared.get("value") if isinstance(declared, Mapping) else declared
        where = place(("parameters", name))
        if is_formula(value):
            return self._formula(str(value), f"{where}.value" if value != declared else where)
        if value is None:
            raise DesignError(where, "has no value", 'write one such as "25 mm"')
        quantity = read_quantity(value, where)
        if not isinstance(declared, Mapping) or quantity.dimension != Dimension():
            return quantity
        return Quantity(quantity.value, _dimension_beside(declared, quantity.value, where))

    def _formula(self, text: str, where: str) -> Quantity:
        """Evaluate the formula of a parameter; its problems are reported for it alone."""
        try:
            return evaluate(text, self)
        except FormulaError as error:
            what = _within(text, error.what)
            raise FormulaError(error.where or where, what, error.hint) from None


def _dimension_beside(declared: Mapping[str, Any], value: float, where: str) -> Dimension:
    """Find the dimension of a bare number in a parameter's table: that of its kind.

    A number other than zero beside bounds with units lacks its own, which is best said here:
    every formula that uses the parameter would fail for the same reason.
    """
    kind = declared.get("kind")
    if isinstance(kind, str) and kind in KINDS:
        return KINDS[kind].dimension
    for bound in (declared.get("min"), declared.get("max"), declared.get("step")):
        if isinstance(bound, str) and not is_formula(bound):
            dimension = read_quantity(bound, where).dimension
            if value != 0 and dimension != Dimension():
                raise DesignError(
                    where, f"{value:g} has no unit; its range has one", f"add it, as in {bound}"
                )
            return dimension
    return Dimension()


def _resolve(value: object, path: Path, parameters: _Parameters, found: Resolution) -> Any:  # noqa: ANN401 - a document holds anything
    if len(path) > DEEPEST_DOCUMENT:
        raise DesignError(place(path[:3]), f"nests deeper than {DEEPEST_DOCUMENT} levels")
    if isinstance(value, str):
        if not is_formula(value) or (path and path[-1] in _PROSE):
            return value
        return _evaluated(value, path, parameters, found)
    if isinstance(value, (int, float)):  # the abstract Mapping takes ten times as long to ask for
        return value
    if is_inner_design(path):
        return value  # its formulas are of parameters of its own
    if isinstance(value, Mapping):
        return {k: _resolve(v, (*path, k), parameters, found) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_resolve(v, (*path, i), parameters, found) for i, v in enumerate(value)]
    return value


def _evaluated(
    formula: str, path: Path, parameters: _Parameters, found: Resolution
) -> Quantity | Number | _Unread:
    try:
        result = evaluate(formula, parameters)
        return result if result.dimension != Dimension() else Number(result.value)
    except FormulaError as error:
        what = _within(formula, error.what)
        found.problems.append(ErrorDetail(error.where or place(path), what, error.hint))
    except VoxSoftError as error:  # the value of a parameter that the formula uses
        found.problems.append(ErrorDetail(error.where, error.what, error.hint))
        found.reported.add(tuple(steps_of(error.where)))
    found.reported.add(path)
    return UNREAD


def _within(formula: str, what: str) -> str:
    return what if what.startswith('in "') else f'in "{formula}": {what}'


def formulas(document: object, path: Path = ()) -> Iterator[tuple[Path, str]]:
    """Find every formula of a document with its path; those of designs within it are left out."""
    if is_inner_design(path):
        return
    if isinstance(document, Mapping):
        for key, value in document.items():
            yield from formulas(value, (*path, key))
    elif isinstance(document, (list, tuple)):
        for index, value in enumerate(document):
            yield from formulas(value, (*path, index))
    elif is_formula(document) and not (path and path[-1] in _PROSE):
        yield path, str(document)
