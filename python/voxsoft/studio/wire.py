"""Numbers that the page must know as the server does: codes, flags and marks of messages.

They are written into ``studio/src/protocol.ts`` beside the types of the messages. The core packs
surfaces and frames with the same marks (``crates/frames``); tests compare the two.
"""

from __future__ import annotations

from enum import IntEnum, IntFlag
from typing import Final

#: Raised when a message changes its meaning; page and server must agree.
PROTOCOL: Final = 1
#: Frames that may be under way to a tab.
CREDITS: Final = 2
#: Largest file that is taken from the page [bytes].
LARGEST_UPLOAD: Final = 64 * 1024 * 1024
#: Speeds of time that can be chosen: simulated seconds for each second of the clock.
PACES: Final = (1.0, 1 / 2, 1 / 5, 1 / 10, 1 / 50, 1 / 200)

#: The first four bytes of a binary message, and the length of its head.
MAGIC: Final = 0x31465856  # "VXF1"
HEADER: Final = 64
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
    """What a binary message holds."""

    TOPOLOGY = 1
    FRAME = 2
    SMOOTH = 3


class FrameFlag(IntFlag):
    """What is said of a frame beside its numbers."""

    PAUSED = 1
    DIVERGED = 2
    AT_REST = 4


class TopologyFlag(IntFlag):
    """What a topology describes."""

    SURFACE = 1
    SHRUNK_TETS = 2
