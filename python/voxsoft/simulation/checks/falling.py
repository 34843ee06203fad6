"""Free objects and loose bodies that fall, fly or slide away."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.simulation.setup.setup import Setup

#: Distance, in sizes of the body, beyond which a loose body is gone.
_FAR: Final = 5.0


@dataclass(frozen=True)
class Loose:
    """A free object or a component of the body that no clamp holds.

    Attributes
    ----------
    name
        Its name in words.
    position
        Present position of its middle [m], (3,).
    moved
        Distance from the initial position [m].
    """

    name: str
    position: NDArray[np.float64]
    moved: float

    @property
    def place(self) -> str:
        """Position in words."""
        x, y, z = 1e3 * self.position
        return f"({x:.1f}, {y:.1f}, {z:.1f}) mm"


def farthest_loose(setup: Setup, answer: _core.Answer) -> Loose | None:
    """Find the free object or loose component that has moved farthest; None without any.

    Parameters
    ----------
    setup
        The prepared design that was solved.
    answer
        The answer of the core.
    """
    assert setup.touching is not None
    found: list[Loose] = []
    poses = setup.touching.poses(answer.objects)
    for each, surface in zip(setup.design.objects, setup.touching.surfaces, strict=True):
        if each.is_free:
            position = np.array(poses[each.name].position)
            moved = float(np.linalg.norm(position - surface.middle))
            found.append(Loose(f'the object "{each.name}"', position, moved))
    part = setup.loose_piece
    if part is not None:
        whole = len(part) == len(setup.mesh.vertices)
        position = answer.positions[part].mean(axis=0)
        moved = float(np.linalg.norm(position - setup.mesh.vertices[part].mean(axis=0)))
        name = "the body" if whole else f"a component of {len(part)} vertices"
        found.append(Loose(name, position, moved))
    return max(found, key=lambda each: each.moved, default=None)


def is_gone(setup: Setup, loose: Loose) -> bool:
    """Return True if a loose body went so far that it does not come back."""
    size = float(np.linalg.norm(np.ptp(setup.mesh.vertices, axis=0)))
    return loose.moved > _FAR * size


def falls(setup: Setup, answer: _core.Answer) -> str:
    """Explain that statics found no equilibrium of a loose body, and suggest a remedy."""
    loose = farthest_loose(setup, answer)
    assert loose is not None  # statics ends so only where something is loose
    if is_gone(setup, loose):
        return (
            f"{loose.name} falls or slides away: nothing holds it under the whole load, and it was "
            f"last at {loose.place}, {1e3 * loose.moved:.3g} mm from where it began. Put something "
            "under it, grip it harder or with more friction, or hold it"
        )
    return (
        f"{loose.name} does not come to rest under the whole load: it was last at {loose.place}, "
        f"{1e3 * loose.moved:.3g} mm from where it began, and moves on. What slides or rolls "
        "without friction has no place to stay: give the contact friction, or write "
        'method = "dynamics"'
    )


def flies(setup: Setup, answer: _core.Answer) -> str | None:
    """Describe the loose body that has left a run over time; None if none has."""
    loose = farthest_loose(setup, answer)
    if loose is None or not is_gone(setup, loose):
        return None
    return (
        f"{loose.name} falls or flies away: it is {loose.moved:.3g} m from where it was, after "
        f"{answer.time:.3g} s; hold it, put something under it, or end earlier"
    )
