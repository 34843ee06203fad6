"""Stress and strain of a design at given positions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.fields import Fields
from voxsoft.materials import Rigid
from voxsoft.mesh import Mesh
from voxsoft.simulation.setup.setup import Setup


def remember(problem: _core.Problem, peaks: NDArray[np.float64] | None) -> None:
    """Set the largest energies that softening voxels have had, as a result stores them."""
    if peaks is not None:
        problem.set_peaks(peaks)


def fields_of(
    design: Design,
    mesh: Mesh,
    positions: NDArray[np.float64],
    problem: _core.Problem | None = None,
    peaks: NDArray[np.float64] | None = None,
) -> Fields:
    """Measure stress and strain of a design's body at some positions.

    Parameters
    ----------
    design, mesh
        The body.
    positions
        Its vertices in m, (n, 3).
    problem
        Its mechanical problem, if there is one already.
    peaks
        Largest energy density that each softening voxel has had [J/m³], if no problem is given.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> beam = families.beam()
    >>> mesh = vs.mesh_of(beam)
    >>> bool(np.allclose(fields_of(beam, mesh, 1.1 * mesh.vertices).max_stretch, 1.1))
    True
    """
    if problem is None:
        # Clamps, layers and bonds decide which faces warp freely, and so their stress.
        setup = Setup(design, mesh)
        bonds = setup.touching is not None and setup.touching.bonds
        problem = setup.problem if bonds else setup.problem_alone
        remember(problem, peaks)
    rigid = [isinstance(design.material_of(part), Rigid) for part in design.parts]
    return Fields.of(_core.Fields(problem), mesh, positions, rigid)
