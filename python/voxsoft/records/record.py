"""The base of every typed table of a design."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping
from threading import RLock
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn, Self

from pydantic import BaseModel, ConfigDict, ValidationError

from voxsoft.errors import DesignError, ErrorDetail, VoxSoftError
from voxsoft.records.complaints import plain_error
from voxsoft.records.places import closest
from voxsoft.records.plain import plain_values
from voxsoft.records.signature import RecordType

#: Lock while a class is built of parts that others share; pydantic 2.14 has one of its own.
_BUILDING = RLock()


class Record(BaseModel, metaclass=RecordType):
    """An immutable table with named, typed entries; an unknown name is an error.

    Subclasses declare fields as in any pydantic model. Wrong input raises a
    :class:`~voxsoft.errors.VoxSoftError` (the class variable ``error_type``) that lists every
    problem with its place; pydantic's own error stays inside. :meth:`replace` makes another one;
    there is no way around the checks.

    Examples
    --------
    >>> class Slab(Record):
    ...     thickness: float
    >>> Slab(thicknes=1)
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: 2 problems
      thickness: is missing
      thicknes: is not known here. Try: did you mean "thickness"?
    >>> Slab(thickness=1).replace(thickness=2).thickness
    2.0
    """

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        validate_by_name=True,
        validate_by_alias=True,
        ser_json_inf_nan="constants",
        allow_inf_nan=False,
        defer_build=True,  # most commands use a few of the classes, and building all takes long
    )

    error_type: ClassVar[type[VoxSoftError]] = DesignError

    def __init__(self, /, *values: Any, **data: Any) -> None:  # noqa: ANN401 - fields are typed
        """Check the arguments against the fields of the class."""
        if values:
            data = _by_name(type(self), values, data)
        data = plain_values(data)
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise plain_error(error, type(self), data) from None

    # Tells pydantic that tables nested in tables may skip this constructor, so that the
    # outermost one sees all problems with their full place and the validation context.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @classmethod
    def model_rebuild(cls, *, _parent_namespace_depth: int = 2, **options: Any) -> bool | None:  # noqa: ANN401
        """Build the class, which its first use asks for, in one thread at a time."""
        with _BUILDING:
            return super().model_rebuild(
                _parent_namespace_depth=_parent_namespace_depth + 1, **options
            )

    @classmethod
    def _positional(cls) -> tuple[str, ...]:
        """Names of the entries that may be given by position, in their order."""
        return ()

    def replace(self, **changes: Any) -> Self:  # noqa: ANN401 - the fields declare the types
        """Return this with other values of some entries, checked like new.

        Parameters
        ----------
        **changes
            New values by the name of the entry.

        Raises
        ------
        VoxSoftError
            An unknown name, or values that are not valid; the class as for the constructor.
        """
        return type(self)(**{**self._entries(), **self._known(changes)})

    def _entries(self) -> dict[str, Any]:
        """Values of all entries by the name that a user writes."""
        fields = type(self).__pydantic_fields__
        return {info.alias or name: getattr(self, name) for name, info in fields.items()}

    def _known(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """Changes by the name that a user writes; an error if a name is none."""
        written = {
            name: info.alias or name for name, info in type(self).__pydantic_fields__.items()
        }
        known = {**written, **{name: name for name in written.values()}}
        wrong = [
            ErrorDetail(name, "is not known here", closest(name, written.values()))
            for name in changes
            if name not in known
        ]
        if wrong:
            raise self.error_type.listing(wrong)
        return {known[name]: value for name, value in changes.items()}

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy; with `update` the same as :meth:`replace`."""
        if update:
            return self.replace(**update)
        return copy.deepcopy(self) if deep else copy.copy(self)

    def __replace__(self, **changes: Any) -> Self:  # noqa: ANN401 - for copy.replace()
        return self.replace(**changes)

    if not TYPE_CHECKING:  # pydantic's plugin writes the second one itself

        def copy(self, **changes: Any) -> NoReturn:  # noqa: ANN401
            """Refuse: pydantic's old way to copy leaves out the checks."""
            name = type(self).__name__
            raise TypeError(f"{name}.copy() would leave out the checks; write replace(...)")

        @classmethod
        def model_construct(cls, *arguments: Any, **values: Any) -> NoReturn:  # noqa: ANN401
            """Refuse: it would leave out the checks."""
            name = cls.__name__
            raise TypeError(f"{name}.model_construct() would leave out the checks; write {name}()")

        construct: ClassVar[Any] = model_construct  # a bare name would be read as a field

    def __setattr__(self, name: str, value: Any) -> None:  # noqa: ANN401
        if name.startswith("_"):
            super().__setattr__(name, value)
        else:
            self._refuse_change(name)

    def __delattr__(self, name: str) -> None:
        if name.startswith("_"):
            super().__delattr__(name)
        else:
            self._refuse_change(name)

    def _refuse_change(self, name: str) -> NoReturn:
        names = [info.alias or field for field, info in type(self).model_fields.items()]
        if name not in names:
            raise self.error_type(name, "is not known here", closest(name, names))
        kind = type(self).__name__
        raise self.error_type(
            name,
            f"cannot be set: a {kind} does not change",
            f"make another one, {kind.lower()}.replace({name}=...)",
        )

    def __dir__(self) -> Iterable[str]:
        """Names of entries and methods, without pydantic's."""
        return dir(type(self))

    def __repr_args__(self) -> Iterable[tuple[str | None, Any]]:
        """Entries of a printed record: those that differ from their defaults."""
        for name, info in type(self).model_fields.items():
            value = getattr(self, name)
            if info.is_required() or value != info.get_default(call_default_factory=True):
                yield info.alias or name, value

    def __str__(self) -> str:
        return repr(self)


def _by_name(model: type[Record], values: tuple[Any, ...], data: dict[str, Any]) -> dict[str, Any]:
    """Join the values given by position with those given by name."""
    order = model._positional()
    name = model.__name__
    if not order:
        first = next(iter(model.model_fields), "...")
        raise TypeError(f"{name}() takes its entries by name, as in {name}({first}=...)")
    if len(values) > len(order):
        listed = ", ".join(order)
        came = f"{len(values)} came"
        raise TypeError(f"{name}() takes {listed} by position and the rest by name; {came}")
    given = dict(zip(order, values, strict=False))
    twice = sorted(given.keys() & data.keys())
    if twice:
        raise TypeError(f"{name}() got {twice[0]} by position and by name")
    return {**given, **data}
