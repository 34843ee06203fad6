"""The thread that meshes: of several wishes only the newest is fulfilled."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Final, NamedTuple

from voxsoft.design import Design
from voxsoft.errors import VoxSoftError
from voxsoft.simulation.check import CheckReport
from voxsoft.studio.body import StudioBody
from voxsoft.studio.smooth import pack_smooth

#: A wish waits this long for a newer one, as a slider that is dragged sends many [s].
PATIENCE: Final = 0.01


class _Wish(NamedTuple):
    design: Design
    rev: int


class Mesher(threading.Thread):
    """Makes bodies of designs, one at a time.

    Parameters
    ----------
    done
        Called with each body.
    examined
        Called with a body, what the doctor says of it, and its smooth surface if it has one, unless
        a newer wish came meanwhile.
    failed
        Called with the revision of a design that could not be meshed, and the reason.
    """

    def __init__(
        self,
        done: Callable[[StudioBody], None],
        examined: Callable[[StudioBody, CheckReport, bytes | None], None],
        failed: Callable[[int, VoxSoftError], None],
    ) -> None:
        super().__init__(name="studio-mesher", daemon=True)
        self._done, self._examined, self._failed = done, examined, failed
        self._wish: _Wish | None = None
        self._changed = threading.Condition()
        self._ended = False
        self._count = 0

    def ask(self, design: Design, rev: int) -> None:
        """Ask for a body; an older wish that has not been begun is dropped."""
        with self._changed:
            self._wish = _Wish(design, rev)
            self._changed.notify()

    def end(self) -> None:
        """Stop after the body that is being made."""
        with self._changed:
            self._ended = True
            self._changed.notify()

    def run(self) -> None:
        """Fulfil wishes until the end."""
        while (wish := self._next()) is not None:
            self._count += 1
            try:
                body = StudioBody.of(wish.design, wish.rev, self._count)
            except VoxSoftError as error:
                self._failed(wish.rev, error)
                continue
            except MemoryError:
                what = "needs more memory than there is"
                self._failed(wish.rev, VoxSoftError("voxel_size", what, "make the voxels larger"))
                continue
            except Exception as error:  # the thread must live on, whatever a design does to it
                self._failed(wish.rev, VoxSoftError("design", f"{type(error).__name__}: {error}"))
                continue
            self._done(body)
            with self._changed:
                newer = self._wish is not None or self._ended
            if not newer:
                self._examined(body, body.report(), pack_smooth(wish.design, body.topology))

    def _next(self) -> _Wish | None:
        with self._changed:
            while self._wish is None and not self._ended:
                self._changed.wait()
            if self._wish is not None and not self._ended:
                self._changed.wait(PATIENCE)
            wish, self._wish = self._wish, None
            return None if self._ended else wish
