"""Warnings about a loaded body, reported wherever it is shown.

Each check is a function of the design, its mesh and the positions of the vertices, or of the design
and its stress and strain there, so that results at rest, frames of a run and the live body of the
studio are judged alike. To add one, write it in a file of its own and name it in :data:`CHECKS` or
:data:`FIELD_CHECKS`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.fields import Fields
from voxsoft.mesh import Mesh
from voxsoft.simulation.checks.coarse_walls import coarse_walls
from voxsoft.simulation.checks.collapse import collapsed_voxels
from voxsoft.simulation.checks.crossed_surfaces import crossed_surfaces
from voxsoft.simulation.checks.overlaps import overlap_warnings
from voxsoft.simulation.checks.separation import separations
from voxsoft.simulation.checks.surfaces import doubtful_surfaces
from voxsoft.simulation.checks.tested_range import beyond_tests
from voxsoft.simulation.checks.thickness import doubtful_thickness
from voxsoft.simulation.checks.thin_seals import thin_seals
from voxsoft.simulation.checks.vanished import vanished_shapes
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.loads.immersion import surfaced
from voxsoft.simulation.results.fields import fields_of
from voxsoft.simulation.setup.chambers import ambiguous_indices
from voxsoft.simulation.setup.dielectrics import broken_down
from voxsoft.simulation.setup.volumes import doubtful_volumes

#: Check of a design, its mesh and positions in m, (n, 3).
Check = Callable[[Design, Mesh, NDArray[np.float64]], Iterable[Diagnostic]]
#: Check of a design and its stress and strain.
FieldCheck = Callable[[Design, Fields], Iterable[Diagnostic]]


def _ambiguous_indices(design: Design, mesh: Mesh, _: NDArray[np.float64]) -> Iterator[Diagnostic]:
    return ambiguous_indices(design, mesh)


def _left_out(design: Design, _mesh: Mesh, _: NDArray[np.float64]) -> Iterator[Diagnostic]:
    """Warn of entries of bodies' designs that are left out although they affect each alone."""
    return (Diagnostic("warning", *problem) for problem in design.left_out)


CHECKS: Final[tuple[Check, ...]] = (
    _ambiguous_indices,
    _left_out,
    doubtful_surfaces,
    doubtful_thickness,
    doubtful_volumes,
    coarse_walls,
    vanished_shapes,
    thin_seals,
    overlap_warnings,
    crossed_surfaces,
    separations,
    broken_down,
    surfaced,
)
FIELD_CHECKS: Final[tuple[FieldCheck, ...]] = (collapsed_voxels, beyond_tests)


def warnings_at(
    design: Design, mesh: Mesh, positions: NDArray[np.float64], fields: Fields | None = None
) -> tuple[Diagnostic, ...]:
    """Find warnings about a body at some positions.

    Parameters
    ----------
    design, mesh
        The body.
    positions
        Its vertices in m, (n, 3).
    fields
        Its stress and strain there, where they are known already.

    Returns
    -------
    tuple of Diagnostic
        Diagnostics with subject, finding and remedy; empty if there are none.
    """
    known = fields_of(design, mesh, positions) if fields is None else fields
    of_fields = (warning for check in FIELD_CHECKS for warning in check(design, known))
    of_places = (warning for check in CHECKS for warning in check(design, mesh, positions))
    return (*of_fields, *of_places)
