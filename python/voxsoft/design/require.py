"""A plain word where something else than a design came."""

from __future__ import annotations

import os

from voxsoft.design.model import Design
from voxsoft.errors import DesignError


def require_design(given: object, where: str = "design") -> Design:
    """Return a design as it is, and refuse anything else.

    Parameters
    ----------
    given
        The argument.
    where
        The argument's name.

    Raises
    ------
    DesignError
        It is no design; the message for a path gives the way to load it.

    Examples
    --------
    >>> require_design("pad.toml")
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: design: "pad.toml" came; expected a Design. Try: read the file...
    """
    if isinstance(given, Design):
        return given
    if isinstance(given, (str, os.PathLike)):
        path = os.fspath(given)
        hint = f'read the file first, vs.load("{path}")'
        raise DesignError(where, f'"{path}" came; expected a Design', hint)
    raise DesignError(where, f"{type(given).__name__} came; expected a Design")
