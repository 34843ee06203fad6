"""What is drawn of one body: packed topologies and frames."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.studio import events
from voxsoft.studio.body import StudioBody
from voxsoft.studio.fields import DISPLACEMENT, FIELDS
from voxsoft.studio.frames import pack_points, value_at
from voxsoft.studio.mover import Mover
from voxsoft.studio.surface import ShrunkTets, pack_tets


class Moment(NamedTuple):
    """What is shown of a body: the present of its mover, or positions [m] of another time [s]."""

    frame: int
    flags: int
    time: float
    mover: Mover | None
    positions: NDArray[np.float64] | None


class Canvas:
    """Packs what tabs see of a body.

    Parameters
    ----------
    body
        The body.
    """

    def __init__(self, body: StudioBody) -> None:
        self._body = body

    def topology(self, mode: str) -> bytes:
        """The surface, or the tetrahedra, as the page reads them."""
        body = self._body
        if mode == "surface":
            return body.packed()
        return pack_tets(self._shrunk, body.mesh, body.topology)

    def frame(self, moment: Moment, field: int, mode: str, seq: int = 0) -> bytes:
        """A moment as the page reads it."""
        body, tets = self._body, mode == "tets"
        frame, seq = moment.frame & 0xFFFF_FFFF, seq & 0xFFFF_FFFF
        unmoved = moment.mover is None and moment.positions is None
        if body.refusal is not None or (unmoved and field == DISPLACEMENT):
            # Nothing moves what cannot be solved, and the core holds no such problem. And a shape
            # that has only just come is shown before the core gets ready for its fields.
            rest = body.mesh.vertices
            points = self._shrunk.points(rest) if tets else rest[body.surface.vertices]
            return pack_points(
                points,
                np.zeros(len(points)),
                topology=body.topology,
                frame=frame,
                time=0.0,
                seq=seq,
                field=field,
                flags=moment.flags,
            )
        if moment.positions is None and moment.mover is not None:
            display = self._tets if tets else None
            return moment.mover.packed(frame, field, seq, moment.flags, display)
        return (self._tets if tets else self._surface).pack_frame(
            self.positions(moment),
            topology=body.topology,
            frame=frame,
            field=field,
            seq=seq,
            flags=moment.flags,
            time=moment.time,
        )

    def positions(self, moment: Moment) -> NDArray[np.float64]:
        """Where the vertices of the mesh are [m]."""
        if moment.positions is not None:
            return moment.positions
        return self._body.mesh.vertices if moment.mover is None else moment.mover.positions()

    def picked(self, moment: Moment, shown: int) -> events.Picked:
        """All that is known of a vertex of the surface, fields to the 16 bits of a frame."""
        body = self._body
        vertex = int(body.surface.vertices[shown])
        rest, now = body.mesh.vertices[vertex], self.positions(moment)[vertex]
        values = []
        for field in FIELDS:
            value = None
            if body.refusal is None:
                value = value_at(self.frame(moment, field.id, "surface"), shown)
            values.append(
                events.Value(field=field.id, name=field.name, value=value, unit=field.unit)
            )
        return events.Picked(
            vertex=shown,
            rest=(float(rest[0]), float(rest[1]), float(rest[2])),
            position=(float(now[0]), float(now[1]), float(now[2])),
            values=values,
        )

    @cached_property
    def _shrunk(self) -> ShrunkTets:
        return ShrunkTets.of(self._body.mesh, self._body.surface)

    @cached_property
    def _surface(self) -> _core.Display:
        body = self._body
        triangles, size = body.mesh.triangles.astype(np.uint32), body.mesh.voxel_size or 0.0
        return _core.Display.surface(body.setup.problem, triangles, body.surface.tags, size)

    @cached_property
    def _tets(self) -> _core.Display:
        body, shrunk = self._body, self._shrunk
        tags, size = shrunk.tags[::4].copy(), body.mesh.voxel_size or 0.0
        return _core.Display.tets(body.setup.problem, shrunk.corners, tags, size)
