"""Names of a package that are loaded when first used, so that importing it stays light."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from importlib import import_module
from typing import Any


def lazy_names(
    package: str, homes: Mapping[str, str], modules: Sequence[str] = ()
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Make the ``__getattr__`` and ``__dir__`` of a package.

    Parameters
    ----------
    package
        Its name.
    homes
        The module that holds each public name.
    modules
        Modules of the package that are loaded when first used as well. A name that is none of
        these, and that one of the modules has among its public ones, is an error that says so.

    Examples
    --------
    >>> get, names = lazy_names("voxsoft", {"Voxels": "voxsoft.voxels"})
    >>> get("Voxels").__name__
    'Voxels'
    >>> get("Voxel")
    Traceback (most recent call last):
    ...
    AttributeError: module 'voxsoft' has no attribute 'Voxel'
    """

    def get(name: str) -> Any:  # noqa: ANN401 - any public object
        module = sys.modules[package]
        if name in modules:
            return import_module(f"{package}.{name}")
        if name not in homes:
            # With name and obj, Python itself looks for the closest name in __dir__.
            what = f"module '{package}' has no attribute '{name}'"
            if found := [] if name.startswith("_") else _holding(package, modules, name):
                what += f": it is {' or '.join(f'{package}.{each}.{name}' for each in found)}"
            raise AttributeError(what, name=name, obj=module)
        value = getattr(import_module(homes[name]), name)
        setattr(module, name, value)
        return value

    def names() -> list[str]:
        return sorted(
            {*homes, *modules, *(n for n in vars(sys.modules[package]) if n.startswith("__"))}
        )

    return get, names


def _holding(package: str, modules: Sequence[str], name: str) -> list[str]:
    """The modules that have a name among their public ones."""
    found = []
    for each in modules:
        with suppress(ImportError):
            if name in getattr(import_module(f"{package}.{each}"), "__all__", ()):
                found.append(each)
    return found
