"""Signature of a record for ``help``, a notebook and Tab: its entries, in short words."""

from __future__ import annotations

import inspect
import types
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic_core import PydanticUndefined

from voxsoft.units import KINDS, UnitOf

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass as _ModelType
    from pydantic.fields import FieldInfo
else:
    _ModelType = type(BaseModel)  # it has no public name

#: Unions of more members than this are shown by a common word.
_MOST_MEMBERS = 8


class _Words(str):
    """Text that a signature shows as it is."""

    def __repr__(self) -> str:
        return str(self)


class RecordType(_ModelType):
    """The type of record classes: pydantic's, with a signature and a directory for readers."""

    if not TYPE_CHECKING:  # pydantic's own is a method of the class

        @property
        def model_fields(cls) -> Mapping[str, FieldInfo]:
            """Fields by name; types that were not there yet with the class are known now."""
            if not cls.__pydantic_fields_complete__:
                cls.model_rebuild()
            return cls.__pydantic_fields__

    @property
    def __signature__(cls) -> inspect.Signature:
        """The constructor in short words."""
        return signature_of(cls)

    @__signature__.setter
    def __signature__(cls, value: object) -> None:
        """Leave pydantic's out, which spells every union and every check."""

    def __dir__(cls) -> list[str]:
        fields: Mapping[str, FieldInfo] = getattr(cls, "model_fields", {})
        own = {name for base in cls.__mro__ if _is_ours(base) for name in vars(base)}
        public = {name for name in own if not name.startswith("_") and name not in _HIDDEN}
        return sorted({*dir(object), *public, *fields, "__init__"})


#: Methods of pydantic that are refused, or are not for readers.
_HIDDEN = {
    *("copy", "construct", "model_construct", "model_copy"),
    *("model_config", "model_rebuild", "error_type"),
}


def _is_ours(base: type) -> bool:
    return issubclass(base, BaseModel) and base is not BaseModel


def signature_of(model: Any) -> inspect.Signature:  # noqa: ANN401 - a record class
    """Write the constructor of a record with the names that a user writes.

    Examples
    --------
    >>> from voxsoft.shapes import Sphere
    >>> signature_of(Sphere)
    <Signature (radius: Length, *, center: (Length, Length, Length) = (0.0, 0.0, 0.0))>
    """
    order = model._positional()
    fields: Mapping[str, FieldInfo] = model.model_fields
    kinds = [name for name in order if name in fields]
    rest = [name for name, info in fields.items() if name not in order and not _is_tag(info)]
    required = [name for name in rest if fields[name].is_required()]
    named = required + [name for name in rest if name not in required]
    parameters = [_parameter(name, fields[name], by_position=True) for name in kinds]
    parameters += [_parameter(name, fields[name], by_position=False) for name in named]
    return inspect.Signature(parameters)


def _is_tag(info: FieldInfo) -> bool:
    """Check if an entry only distinguishes classes, and has one value."""
    return get_origin(info.annotation) is Literal and len(get_args(info.annotation)) == 1


def _parameter(name: str, info: FieldInfo, *, by_position: bool) -> inspect.Parameter:
    kind = (
        inspect.Parameter.POSITIONAL_OR_KEYWORD if by_position else inspect.Parameter.KEYWORD_ONLY
    )
    default: Any = inspect.Parameter.empty
    if not info.is_required():
        default = info.get_default(call_default_factory=True)
        if default is PydanticUndefined:
            default = None
        default = _Words(short_default(default))
    annotation = _Words(
        short(Annotated[info.annotation, *info.metadata] if info.metadata else info.annotation)
    )
    return inspect.Parameter(info.alias or name, kind, default=default, annotation=annotation)


def short_default(value: object) -> str:
    """Write a default; a record by its name alone."""
    return f"{type(value).__name__}()" if isinstance(value, BaseModel) else repr(value)


def short(annotation: Any) -> str:  # noqa: ANN401 - any annotation
    """Write an annotation as a reader wants it: ``Length``, ``str | Shape``.

    Examples
    --------
    >>> from voxsoft.units import Point, PositiveLength
    >>> short(PositiveLength | None), short(Point)
    ('Length | None', '(Length, Length, Length)')
    """
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        units = [mark for mark in arguments[1:] if isinstance(mark, UnitOf)]
        return _kind(units[0].kind) if units else short(arguments[0])
    if origin in (Union, types.UnionType):
        return _union(arguments)
    if origin is Literal:
        return " | ".join(
            f'"{value}"' if isinstance(value, str) else repr(value) for value in arguments
        )
    if origin is tuple:
        if len(arguments) == 2 and arguments[1] is Ellipsis:
            return f"[{short(arguments[0])}, ...]"
        return f"({', '.join(map(short, arguments))})"
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return f"{{{short(arguments[0])}: {short(arguments[1])}}}"
    if annotation is None or annotation is type(None):
        return "None"
    return str(getattr(annotation, "__name__", annotation)).removeprefix("typing.")


def _kind(kind: str) -> str:
    return "float" if kind == "number" else KINDS[kind].name.title().replace(" ", "")


def _union(members: tuple[Any, ...]) -> str:
    """Join the members, those that share a base in its name if they are many."""
    words = list(dict.fromkeys(map(short, members)))
    if len(words) > _MOST_MEMBERS:
        return _common_base(members)
    return " | ".join([word for word in words if word != "None"] + ["None"] * ("None" in words))


def _common_base(members: tuple[Any, ...]) -> str:
    classes = [member for member in members if isinstance(member, type)]
    shared = [base for base in classes[0].__mro__ if all(issubclass(c, base) for c in classes)]
    return shared[0].__name__
