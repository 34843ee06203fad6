"""Mappings of a record, which change as little as the record itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Any, NoReturn, TypeVar

from pydantic import AfterValidator

from voxsoft.errors import DesignError

K = TypeVar("K")
V = TypeVar("V")


class FrozenDict(dict[K, V]):
    """A dict that cannot be changed, and has a hash if its values have one.

    Examples
    --------
    >>> sizes = FrozenDict({"wall": 0.005})
    >>> sizes["wall"] = 0.01
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: wall: cannot be set in place: a record does not change. Try: ...
    >>> sizes | {"wall": 0.01}
    {'wall': 0.01}
    """

    def _refuse(self, *arguments: Any, **_: Any) -> NoReturn:  # noqa: ANN401 - any of dict's own
        where = arguments[0] if arguments and isinstance(arguments[0], str) else "table"
        raise DesignError(
            where,
            "cannot be set in place: a record does not change",
            "make a new design by design.replace(...) or design.with_parameters(...)",
        )

    __setitem__ = __delitem__ = __ior__ = _refuse
    clear = pop = popitem = setdefault = update = _refuse

    def __hash__(self) -> int:  # type: ignore[override]
        return hash(frozenset(self.items()))

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[dict[K, V]]]:
        return type(self), (dict(self),)


#: A field that holds a mapping: read as a dict, kept as one that cannot be changed.
Table = Annotated[Mapping[K, V], AfterValidator(FrozenDict)]
