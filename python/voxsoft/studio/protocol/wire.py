"""Numbers that the page must know as the server does: codes, flags and marks of messages.

They are written into ``studio/src/protocol.ts`` beside the types of the messages. Numbers with
which the core packs and plays are the core's own.
"""

from __future__ import annotations

from enum import IntEnum, IntFlag
from typing import Final

from voxsoft import _core

#: Raised when a message changes its meaning; page and server must agree.
PROTOCOL: Final = 1
#: Frames that may be under way to a tab.
CREDITS: Final = 2
#: Largest file that is taken from the page [bytes].
LARGEST_UPLOAD: Final = 64 * 1024 * 1024
#: Speeds of time that can be chosen: simulated seconds for each second of the clock.
PACES: Final = _core.PACES

#: The first four bytes of a binary message, and the length of its head.
MAGIC: Final = _core.MAGIC
HEADER: Final = _core.HEADER
#: The topologies of a body at rest beside the view: its own, and that of the objects around it.
STILL_BODY: Final = 1
STILL_OBJECTS: Final = 2
#: Bit of a triangle's tag that says that it faces a cavity.
CAVITY: Final = 0x80


class CloseCode(IntEnum):
    """Why the server closes a websocket; from 4000 on the codes are the studio's own."""

    #: The tab reads too slowly; it may come back at once.
    TRY_AGAIN = 1013
    #: The page speaks another version of the protocol.
    OTHER_PROTOCOL = 4000
    #: The page said nothing in time; it may come back.
    NO_HELLO = 4001
    #: Too many messages in a row were none of the protocol's.
    WRONG_MESSAGES = 4002


class MessageKind(IntEnum):
    """Kind of a binary message."""

    TOPOLOGY = _core.MESSAGE_KINDS["TOPOLOGY"]
    FRAME = _core.MESSAGE_KINDS["FRAME"]
    SMOOTH = _core.MESSAGE_KINDS["SMOOTH"]


class FrameFlag(IntFlag):
    """Flags of a frame beside its numbers."""

    PAUSED = _core.FRAME_FLAGS["PAUSED"]
    DIVERGED = _core.FRAME_FLAGS["DIVERGED"]
    AT_REST = _core.FRAME_FLAGS["AT_REST"]


class TopologyFlag(IntFlag):
    """Kind of a topology."""

    SURFACE = _core.TOPOLOGY_FLAGS["SURFACE"]
    SHRUNK_TETS = _core.TOPOLOGY_FLAGS["SHRUNK_TETS"]
