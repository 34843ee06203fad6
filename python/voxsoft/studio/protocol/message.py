"""The base of all messages of the studio: JSON objects tagged by ``t``."""

from __future__ import annotations

import re
from typing import Any, Final

import msgspec

#: A point or vector in SI units, in the order x, y, z.
Triple = tuple[float, float, float]

#: Any value that JSON can hold.
Json = Any

_CAPITAL: Final = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")


def tag_of(name: str) -> str:
    """Write the name of a message class as its tag.

    Examples
    --------
    >>> tag_of("JobStart")
    'job_start'
    """
    return _CAPITAL.sub("_", name.rpartition(".")[2]).lower()


class Message(msgspec.Struct, kw_only=True, tag_field="t", tag=tag_of):
    """Base of text messages over the websocket."""


class Entry(msgspec.Struct, kw_only=True):
    """Base of the objects inside messages."""
