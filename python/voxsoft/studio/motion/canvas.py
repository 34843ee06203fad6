"""Drawing of one body: packed topologies and frames."""

from __future__ import annotations

from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.simulation.results.contact_field import ContactField
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.fields import DISPLACEMENT, FIELDS, contact_values
from voxsoft.studio.bodies.surface import tets_to_draw, voxels_to_cut
from voxsoft.studio.motion.player import Player
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.message import Triple
from voxsoft.studio.protocol.wire import FrameFlag

_STILL: Final = FrameFlag.PAUSED
#: Flags of frames as the core sets them.
_FLAGS: Final = {
    "playing": FrameFlag(0),
    "at-rest": FrameFlag.PAUSED | FrameFlag.AT_REST,
    "diverged": FrameFlag.PAUSED | FrameFlag.DIVERGED,
}


class Canvas:
    """Packs topologies and frames of a body for the tabs.

    Parameters
    ----------
    body
        The body.
    """

    def __init__(self, body: StudioBody) -> None:
        self._body = body

    def topology(self, mode: str) -> bytes:
        """The surface, alone or with the voxels behind it, or the tetrahedra: as the page reads."""
        return self._outline(mode).pack_topology(self._body.topology)

    def frame(
        self,
        player: Player | None,
        field: int,
        mode: str,
        seq: int = 0,
        contact: ContactField | None = None,
    ) -> bytes:
        """The present state of a player as the page reads it; without one, the body as it was made.

        Fields of contact are those of `contact`, and zero without one.
        """
        body = self._body
        values = contact_values(field, contact)
        if values is not None:
            return self._touched(player, field, values, mode=mode, seq=seq & 0xFFFF_FFFF)
        if player is not None:
            return player.packed(field, seq, None if mode == "surface" else self._display(mode))
        rest, topology, seq = body.mesh.vertices, body.topology, seq & 0xFFFF_FFFF
        if body.refusal is not None or field == DISPLACEMENT:
            # Nothing moves a body that cannot be solved, and the core holds no such problem.
            # And a new shape is shown before the core gets ready for its fields.
            outline = self._outline(mode)
            return outline.pack_frame(rest, topology=topology, field=field, seq=seq, flags=_STILL)
        return self._display(mode).pack_frame(
            rest, topology=topology, frame=0, field=field, seq=seq, flags=_STILL
        )

    def swung(
        self, positions: NDArray[np.float64], field: int, mode: str, seq: int, frame: int
    ) -> bytes:
        """A frame of an equilibrium that is drawn elsewhere, with a field of where it is drawn."""
        return self._display(mode).pack_frame(
            positions,
            topology=self._body.topology,
            frame=frame,
            field=field if field < len(FIELDS) else DISPLACEMENT,
            seq=seq & 0xFFFF_FFFF,
            flags=_FLAGS["at-rest"],
        )

    def _touched(
        self,
        player: Player | None,
        field: int,
        values: NDArray[np.float64],
        *,
        mode: str,
        seq: int,
    ) -> bytes:
        """A frame with values of the mesh that the core does not know; none are zero."""
        outline = self._outline(mode)
        flags, frame, time = _STILL, 0, 0.0
        if player is not None:
            shown = player.shown()
            flags, frame, time = _FLAGS.get(player.state, _STILL), shown.frame, shown.time
        return outline.pack_frame(
            self.positions(player),
            topology=self._body.topology,
            field=field,
            values=values[outline.vertices] if len(values) else None,
            frame=frame,
            seq=seq,
            flags=flags,
            time=time,
        )

    def positions(self, player: Player | None) -> NDArray[np.float64]:
        """Positions of the vertices of the mesh [m]."""
        return self._body.mesh.vertices if player is None else player.positions()

    def picked(self, shown: int) -> events.Picked:
        """Position of a vertex of the surface on a body that has no fields."""
        x, y, z = self._body.mesh.vertices[self._body.surface.vertices[shown]].tolist()
        at: Triple = (x, y, z)
        values = [
            events.Value(field=field.id, name=field.name, value=None, unit=field.unit)
            for field in FIELDS
        ]
        return events.Picked(vertex=shown, rest=at, position=at, values=values)

    def _outline(self, mode: str) -> _core.Outline:
        if mode == "tets":
            return self._outline_of_tets
        return self._outline_of_solid if mode == "solid" else self._body.surface.outline

    def _display(self, mode: str) -> _core.Display:
        if mode == "tets":
            return self._tets
        return self._solid if mode == "solid" else self._surface

    @cached_property
    def _surface(self) -> _core.Display:
        body = self._body
        triangles, size = body.mesh.triangles.astype(np.uint32), body.mesh.voxel_size or 0.0
        return _core.Display.surface(body.played, triangles, body.surface.tags, size)

    @cached_property
    def _outline_of_solid(self) -> _core.Outline:
        body = self._body
        mesh, tags, size = body.mesh, body.surface.tags, body.mesh.voxel_size or 0.0
        triangles, voxels = mesh.triangles.astype(np.uint32), voxels_to_cut(mesh)
        return _core.Outline.solid(mesh.vertices, triangles, tags, voxels, size)

    @cached_property
    def _solid(self) -> _core.Display:
        body = self._body
        mesh, tags, size = body.mesh, body.surface.tags, body.mesh.voxel_size or 0.0
        triangles, voxels = mesh.triangles.astype(np.uint32), voxels_to_cut(mesh)
        return _core.Display.solid(body.played, triangles, tags, voxels, size)

    @cached_property
    def _outline_of_tets(self) -> _core.Outline:
        mesh = self._body.mesh
        tets, tags = tets_to_draw(mesh, self._body.surface)
        return _core.Outline.tets(mesh.vertices, tets, tags, mesh.voxel_size or 0.0)

    @cached_property
    def _tets(self) -> _core.Display:
        body = self._body
        tets, tags = tets_to_draw(body.mesh, body.surface)
        return _core.Display.tets(body.played, tets, tags, body.mesh.voxel_size or 0.0)
