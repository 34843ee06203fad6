"""Checks of the unloaded body, which its state does not change: made once for each mesh."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterable
from functools import wraps
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.simulation.diagnostic import Diagnostic

Positions = NDArray[np.float64] | None


class Kept(Protocol):
    """A check that accepts positions without using them."""

    def __call__(
        self, design: Design, mesh: Mesh, positions: Positions = None, /
    ) -> tuple[Diagnostic, ...]:
        """Find errors and warnings."""


def once_for_each_mesh(
    check: Callable[[Design, Mesh], Iterable[Diagnostic]],
) -> Kept:
    """Keep the findings of a check for as long as the mesh is in use.

    Frames of a run and a live body repeat the check.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> calls = []
    >>> check = once_for_each_mesh(lambda design, mesh: calls.append(mesh) or ())
    >>> beam = families.beam()
    >>> mesh = mesh_of(beam)
    >>> check(beam, mesh), check(beam, mesh), len(calls)
    ((), (), 1)
    """
    known: dict[int, tuple[Design, tuple[Diagnostic, ...]]] = {}

    @wraps(check)
    def found(design: Design, mesh: Mesh, _: Positions = None) -> tuple[Diagnostic, ...]:
        kept = known.get(id(mesh))
        if kept is not None and kept[0] is design:
            return kept[1]
        if kept is None:
            weakref.finalize(mesh, known.pop, id(mesh), None)
        known[id(mesh)] = (design, tuple(check(design, mesh)))
        return known[id(mesh)][1]

    return found
