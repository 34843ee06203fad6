"""The protocol of the studio: messages between page and server over one websocket.

Text messages are JSON objects: :data:`~voxsoft.studio.protocol.commands.AnyCommand` from the page,
:data:`~voxsoft.studio.protocol.events.AnyEvent` from the server. ``studio/src/protocol.ts`` is
generated from the same classes. Binary messages, from the server only, hold bodies and frames as
the core packs them.
"""

from __future__ import annotations

from typing import Final

import msgspec

from voxsoft.errors import VoxSoftError
from voxsoft.studio.protocol.commands import AnyCommand
from voxsoft.studio.protocol.events import Event

#: Longest text message that is read, bytes.
LONGEST_MESSAGE: Final = 12_000_000

_decoder: Final[msgspec.json.Decoder[AnyCommand]] = msgspec.json.Decoder(AnyCommand)
_encoder: Final = msgspec.json.Encoder()


class ProtocolError(VoxSoftError, ValueError):
    """A message that is none of the protocol's."""


def decode(text: str | bytes) -> AnyCommand:
    """Read one command.

    Raises
    ------
    ProtocolError
        It is not JSON, or not a command with fields of the right types.

    Examples
    --------
    >>> decode('{"t": "step", "seq": 7, "n": 3}')
    Step(seq=7, n=3)
    >>> decode('{"t": "step", "seq": 7, "n": "many"}')
    Traceback (most recent call last):
    ...
    voxsoft.studio.protocol.codec.ProtocolError: message: Expected `int`, got `str` - at `$.n`
    """
    try:
        return _decoder.decode(text)
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        raise ProtocolError("message", str(error)) from None


def encode(event: Event) -> str:
    """Write one event; numbers that are not finite become null.

    Examples
    --------
    >>> from voxsoft.studio.protocol.events import Log
    >>> encode(Log(level="info", text="meshed"))
    '{"t":"log","level":"info","text":"meshed"}'
    """
    return _encoder.encode(event).decode()
