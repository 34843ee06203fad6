"""Changes made to a body by hand: changed loads and springs that pull.

Another revision of the design makes another body; hands stay where they were.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.motion.player import Player
from voxsoft.studio.protocol import commands, events
from voxsoft.studio.protocol.message import Triple


@dataclass(frozen=True)
class _Load:
    """A load that was changed: its kind, its size in the design, and its size now."""

    kind: str
    written: float
    now: float


@dataclass(frozen=True)
class _Pull:
    """A spring: its number, its place on the unloaded body, its target, and its stiffness."""

    number: int
    at: NDArray[np.float64]
    target: Triple
    stiffness: float


@dataclass(frozen=True)
class Hands:
    """Loads by their place in the design, those that are as written being None, and pulls."""

    loads: tuple[_Load | None, ...] = ()
    pulls: tuple[_Pull, ...] = ()

    @classmethod
    def on(cls, body: StudioBody, stat: events.Stat) -> Hands:
        """Read the changes made by hand to a body that is played."""
        rest = body.mesh.vertices[body.surface.vertices]
        pairs = zip(body.loads, stat.loads, strict=True)
        return cls(
            tuple(
                None if now == load.value else _Load(load.kind, load.value, now)
                for load, now in pairs
            ),
            tuple(
                _Pull(pull.id, rest[pull.vertex], pull.target, pull.stiffness)
                for pull in stat.grabs
                if pull.object is None
            ),
        )

    @property
    def idle(self) -> bool:
        """True if nothing was changed by hand."""
        return not self.pulls and not any(self.loads)

    def lay_on(self, body: StudioBody, player: Player) -> None:
        """Do the same to another body; a load that was written anew is left as it is written."""
        for index, (load, held) in enumerate(zip(body.loads, self.loads, strict=False)):
            if held is not None and (load.kind, load.value) == (held.kind, held.written):
                player.do(commands.Load(seq=0, index=index, value=held.now))
        rest = body.mesh.vertices[body.surface.vertices]
        for pull in self.pulls:
            player.do(
                commands.Grab(
                    seq=0,
                    id=pull.number,
                    vertex=int(np.linalg.norm(rest - pull.at, axis=1).argmin()),
                    target=pull.target,
                    stiffness=pull.stiffness,
                )
            )
