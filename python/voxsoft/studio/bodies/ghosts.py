"""Ghosts: the surfaces of single shapes of a design, which the page draws over the body."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable, Iterator, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design, Part
from voxsoft.errors import VoxSoftError
from voxsoft.shapes import Shape
from voxsoft.shapes.base import Triple
from voxsoft.shapes.sketching import Sketch, sketch
from voxsoft.shapes.triangles import TriangleMesh
from voxsoft.studio.bodies.objects import packed
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.tab import Tab

#: Shown margin of a shape without end beyond the body, in lengths of its longest side.
AROUND: Final = 0.1
#: Half the side of that room where there is no body, in voxels.
ALONE: Final = 10
#: Surfaces that are kept for the next request.
MOST_KEPT: Final = 32


class _Request(NamedTuple):
    design: Design | None
    rev: int
    names: tuple[str, ...]


class GhostTracer(threading.Thread):
    """Traces shapes for tabs, one at a time; of the requests of a tab only the newest counts.

    Parameters
    ----------
    send
        Called with a tab and the ghosts it asked for.
    """

    def __init__(self, send: Callable[[Tab, events.Event], None]) -> None:
        super().__init__(name="studio-ghosts", daemon=True)
        self._send = send
        self._requests: OrderedDict[Tab, _Request] = OrderedDict()
        self._changed = threading.Condition()
        self._ended = False
        self._kept = Kept()

    def ask(self, tab: Tab, design: Design | None, rev: int, names: Sequence[str]) -> None:
        """Ask for shapes of a design by their names; earlier requests of the tab are dropped."""
        with self._changed:
            self._requests[tab] = _Request(design, rev, tuple(names))
            self._changed.notify()

    def end(self) -> None:
        """Stop after the shapes that are being traced."""
        with self._changed:
            self._ended = True
            self._changed.notify()

    def run(self) -> None:
        """Answer requests until the end."""
        while (found := self._next()) is not None:
            tab, (design, rev, names) = found
            shapes = (
                []
                if design is None
                else [ghost_of(design, name, self._kept) for name in names if name in design.shapes]
            )
            self._send(tab, events.Ghosts(rev=rev, shapes=shapes))

    def _next(self) -> tuple[Tab, _Request] | None:
        with self._changed:
            while not self._requests and not self._ended:
                self._changed.wait()
            return None if self._ended else self._requests.popitem(last=False)


class Kept:
    """The surfaces that were traced last, by all that decides them."""

    def __init__(self) -> None:
        self._sketches: OrderedDict[Hashable, Sketch] = OrderedDict()

    def get(self, key: Hashable, make: Callable[[], Sketch]) -> Sketch:
        """The surface of a key; made where it is not known."""
        found = self._sketches.pop(key, None)
        if found is None:
            found = make()
        self._sketches[key] = found
        if len(self._sketches) > MOST_KEPT:
            self._sketches.popitem(last=False)
        return found


def ghost_of(design: Design, name: str, kept: Kept | None = None) -> events.Ghost:
    """Trace a named shape of a design.

    Parameters
    ----------
    design
        The design.
    name
        Name in :attr:`Design.shapes`.
    kept
        Surfaces that are known already.

    Returns
    -------
    events.Ghost
        The ghost, or the reason why there is no surface.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> ghost = ghost_of(families.cylinder(), "cavity")
    >>> ghost.trouble, [round(1e3 * side, 1) for side in ghost.high]
    ('', [20.0, 20.0, 40.0])
    """
    shape = design.shapes[name]
    bodies = list(dict.fromkeys(part.body for part in _users(design, shape)))
    detail = design.voxel_size / 2
    trouble = ""
    try:
        room = _room(design, bodies)
        key = (_identity(shape, design), room, detail)
        found = (kept or Kept()).get(key, lambda: sketch(shape.build(design.shapes), room, detail))
    except VoxSoftError as error:
        found, trouble = _nothing(), str(error)
    except BaseException as error:  # a panic of the core too: the thread must live on
        found, trouble = _nothing(), f"{type(error).__name__}: {error}"
    if len(found.triangles) == 0 and not trouble:
        trouble = "has no inside, or one too thin to be seen here"
    ends = found.vertices if len(found.vertices) else np.zeros((1, 3))
    return events.Ghost(
        name=name,
        vertices=packed(found.vertices.astype("<f4")),
        triangles=packed(found.triangles.astype("<u4")),
        low=_triple(ends.min(axis=0)),
        high=_triple(ends.max(axis=0)),
        step=found.step,
        clipped=found.clipped,
        trouble=trouble,
        poses=_poses(design, bodies),
    )


def _poses(design: Design, bodies: Sequence[str | None]) -> list[events.BodyPose]:
    """The poses of some bodies; of none, or of the only one, the frame of the design."""
    poses = {body.name: body.pose for body in design.bodies}
    found = [poses[name] for name in bodies if name in poses] or [(np.eye(3), np.zeros(3))]
    return [
        events.BodyPose(
            position=_triple(position), rotation=[float(each) for each in rotation.ravel()]
        )
        for rotation, position in found
    ]


def _made_of_shapes(design: Design) -> tuple[Part, ...]:
    """The parts of a design that shapes make; none where a file does."""
    return design.parts if design.mesh is None else ()


def _users(design: Design, shape: Shape) -> Iterator[Part]:
    """The parts that are made of a shape, whole or with others."""
    for part in _made_of_shapes(design):
        own = design.shapes[part.shape] if isinstance(part.shape, str) else part.shape
        if any(each is shape for each in own.every(design.shapes)):
            yield part


def _room(design: Design, bodies: Sequence[str | None]) -> tuple[Triple, Triple]:
    """The box of some bodies and a bit more, in their own frames; of all where there are none."""
    boxes = []
    for part in _made_of_shapes(design):
        if bodies and part.body not in bodies:
            continue
        shape = design.shapes[part.shape] if isinstance(part.shape, str) else part.shape
        box = np.array(shape.bounds(design.shapes))
        if np.isfinite(box).all() and (box[1] > box[0]).all():
            boxes.append(box)
    reach = np.full(3, ALONE * design.voxel_size)
    low, high = -reach, reach
    if boxes:
        low, high = np.min(boxes, axis=0)[0], np.max(boxes, axis=0)[1]
        more = AROUND * (high - low).max()
        low, high = low - more, high + more
    return _triple(low), _triple(high)


def _identity(shape: Shape, design: Design) -> Hashable:
    """All that decides a shape: its fields, and the times of change of its files."""
    parts = tuple(shape.every(design.shapes))
    files = [Path(each.path) for each in parts if isinstance(each, TriangleMesh)]
    return parts, tuple(file.stat().st_mtime_ns for file in files if file.is_file())


def _nothing() -> Sketch:
    return Sketch(np.zeros((0, 3)), np.zeros((0, 3), np.int64), 0.0, "")


def _triple(values: NDArray[np.float64]) -> Triple:
    x, y, z = (float(value) for value in values)
    return (x, y, z)
