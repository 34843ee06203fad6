"""The thread that meshes: of several requests only the newest is fulfilled."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Final, NamedTuple

from voxsoft.design import Design
from voxsoft.errors import VoxSoftError
from voxsoft.simulation.checks.check import CheckReport
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.smooth import pack_smooth

#: The checks of a body begin when nothing was requested so long [s].
IDLE: Final = 0.15
#: A body that takes longer than this is announced [s].
SLOW: Final = 0.25


class _Request(NamedTuple):
    design: Design
    rev: int


class Mesher(threading.Thread):
    """Makes bodies of designs, one at a time.

    Parameters
    ----------
    slow
        Called when a body takes its time.
    done
        Called with each body.
    examined
        Called with a body, the report of its checks, and its smooth surface if it has one,
        unless a newer request came meanwhile.
    failed
        Called with the revision of a design that could not be meshed, and the reason.
    unexamined
        Called with the reason where the checks of a body, or its smooth surface, failed.
    """

    def __init__(
        self,
        slow: Callable[[], None],
        done: Callable[[StudioBody], None],
        examined: Callable[[StudioBody, CheckReport, bytes | None], None],
        failed: Callable[[int, VoxSoftError], None],
        unexamined: Callable[[VoxSoftError], None],
    ) -> None:
        super().__init__(name="studio-mesher", daemon=True)
        self._slow, self._done, self._examined, self._failed = slow, done, examined, failed
        self._unexamined = unexamined
        self._request: _Request | None = None
        self._changed = threading.Condition()
        self._ended = False
        self._count = self._made = 0

    def ask(self, design: Design, rev: int) -> None:
        """Ask for a body; an older request that has not been begun is dropped."""
        with self._changed:
            self._request = _Request(design, rev)
            self._changed.notify()

    def end(self) -> None:
        """Stop after the body that is being made."""
        with self._changed:
            self._ended = True
            self._changed.notify()

    def run(self) -> None:
        """Answer requests until the end."""
        while (request := self._next()) is not None:
            self._count += 1
            announcement = threading.Timer(SLOW, self._announce, [self._count])
            announcement.daemon = True
            announcement.start()
            body = self._body_of(request)
            announcement.cancel()
            with self._changed:
                self._made = self._count
            if body is None:
                continue
            self._done(body)
            if self._idle():
                self._examine(body, request.design)

    def _announce(self, count: int) -> None:
        """Announce a body that takes its time: a timer may wake after it was cancelled."""
        with self._changed:
            if count > self._made:
                self._slow()

    def _body_of(self, request: _Request) -> StudioBody | None:
        """Make a body; None where that fails, which is told."""
        try:
            return StudioBody.of(request.design, request.rev, self._count)
        except BaseException as error:  # a panic of the core too: the thread must live on
            self._failed(request.rev, _in_words(error))
        return None

    def _examine(self, body: StudioBody, design: Design) -> None:
        try:
            report, smooth = body.report(), pack_smooth(design, body.voxels, body.topology)
        except BaseException as error:  # as above
            self._unexamined(_in_words(error))
        else:
            self._examined(body, report, smooth)

    def _idle(self) -> bool:
        """Wait a little; whether nothing was requested meanwhile."""
        with self._changed:
            if self._request is None and not self._ended:
                self._changed.wait(IDLE)
            return self._request is None and not self._ended

    def _next(self) -> _Request | None:
        with self._changed:
            while self._request is None and not self._ended:
                self._changed.wait()
            request, self._request = self._request, None
            return None if self._ended else request


def _in_words(error: BaseException) -> VoxSoftError:
    if isinstance(error, VoxSoftError):
        return error
    if isinstance(error, MemoryError):
        what = "needs more memory than there is"
        return VoxSoftError("voxel_size", what, "make the voxels larger")
    return VoxSoftError("design", f"{type(error).__name__}: {error}")
