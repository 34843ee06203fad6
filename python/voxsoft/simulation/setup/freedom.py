"""Rigid-body motions that no clamp stops, so that there may be no equilibrium."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft._components import components
from voxsoft.simulation.setup.contact import has_contact
from voxsoft.simulation.setup.setup import Setup

#: Singular values below this part of the largest count as zero. Those of real supports are ratios
#: of lengths, such as the width of a clamp over the length of the body.
NONE = 1e-6
#: Tolerance for a motion to be along or about an axis alone.
_ALONE = 1e-4


def free_motion(setup: Setup) -> str:
    """Describe rigid-body motions of a component that nothing stops; empty if there are none.

    Elements that share vertices are one component; hinges between voxels on one edge are not
    considered. With a floor, contact, a layer, a spring or a tendon, which may hold a component as
    well, the text is empty.

    Parameters
    ----------
    setup
        The body and its clamps.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> beam = families.beam()
    >>> free_motion(Setup.of(beam))
    ''
    >>> free_motion(Setup.of(beam.with_values("clamps.0.axes=xz")))
    'move along y'
    """
    design = setup.design
    if design.floor is not None or design.layers or setup.attached:
        return ""
    if has_contact(design) or setup.tendons:
        return ""
    held = np.zeros((len(setup.mesh.vertices), 3), dtype=bool)
    for clamp, vertices in zip(design.clamps, setup.clamped, strict=True):
        held[vertices] |= [axis in clamp.axes for axis in "xyz"]
    if (sector := setup.sector) is not None:
        here = sector.vertices if setup.mesh is sector.mesh else slice(None)
        held[:, sector.axes] |= sector.on_planes[here]
    found = (_in_words(_free(setup.mesh.vertices[p], held[p])) for p in _joined(setup))
    return next(filter(None, found), "")


def _joined(setup: Setup) -> list[NDArray[np.intp]]:
    """Find the vertices of each component."""
    tets = setup.mesh.tets
    first, others = tets[:, :1].repeat(3, axis=1), tets[:, 1:]
    labels = components(first.ravel(), others.ravel(), len(setup.mesh.vertices))
    return [np.flatnonzero(labels == label) for label in range(labels.max(initial=-1) + 1)]


def _free(points: NDArray[np.float64], held: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Find the rigid-body motions of points, (n, 3) m, that spare their held axes, (n, 3).

    Returns an orthonormal basis, (6, k): three translations and three rotations each.
    """
    arms = points - points.mean(axis=0)
    arms = arms / max(float(np.abs(arms).max()), 1e-300)
    shifts = np.broadcast_to(np.eye(3), (len(points), 3, 3))
    # A rotation about the axis k moves a point by eₖ × arm: one column for each axis.
    turns = np.stack([np.cross(axis, arms) for axis in np.eye(3)], axis=2)
    stopped = np.concatenate([shifts, turns], axis=2)[held]
    # Six by six, however many vertices are held.
    squares, motions = np.linalg.eigh(stopped.T @ stopped)
    sizes = np.sqrt(np.maximum(squares, 0.0))
    free: NDArray[np.float64] = motions[:, sizes <= NONE * max(float(sizes.max()), 1e-300)]
    return free


def _in_words(free: NDArray[np.float64]) -> str:
    """Describe free rigid-body motions, (6, k), by the axes along and about which there are some.

    A rotation may be about any line along its axis. Motions along or about no axis alone are
    askew.
    """
    if not free.shape[1]:
        return ""
    turns = free[3:]
    along = [axis for at, axis in enumerate("xyz") if np.linalg.norm(free[at]) > 1.0 - _ALONE]
    about = []
    for at, axis in enumerate("xyz"):
        mix, *_ = np.linalg.lstsq(turns, np.eye(3)[at], rcond=_ALONE)
        if np.abs(turns @ mix - np.eye(3)[at]).max() < _ALONE:
            about.append(axis)
    words = [f"move along {_listed(along)}"] if along else []
    words += [f"turn about {_listed(about)}"] if about else []
    return " and to ".join(words) or "move askew to the axes"


def _listed(names: list[str]) -> str:
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
