"""Anchors of tendons that pull harder at a point than the rubber there carries."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from voxsoft.design.tendon import guide_of
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.setup.setup import Setup
from voxsoft.units import format_quantity

#: Largest pull at a point, in Young's moduli times the face of a voxel. The rubber of a finger of
#: 8 mm with voxels of 1 and 2 mm gives way at 0.8 and 0.7: one voxel bears the pull, however small.
_MOST: Final = 0.5


def weak_anchors(setup: Setup) -> Iterator[Diagnostic]:
    """Find tendons that pull at a point of a body with more than a voxel carries.

    Parameters
    ----------
    setup
        A prepared design, whose tendons are on its mesh.
    """
    mesh = setup.mesh
    for index, tendon in enumerate(setup.tendons):
        anchor = guide_of(tendon.tendon.through[-1])
        vertices = tendon.places[-1].get("vertices", [])
        if tendon.tendon.drive != "tension" or anchor.radius is not None or not vertices:
            continue
        around = np.isin(mesh.tets, np.array(vertices)).any(axis=1)
        parts = np.unique(mesh.tet_part[around])
        size = mesh.voxel_size or setup.design.voxel_size
        young = max(setup.materials[part - 1].young(size) for part in parts)
        pull, carried = tendon.size * tendon.final_factor, _MOST * young * size**2
        if pull > carried:
            yield Diagnostic(
                "warning",
                f"tendons[{index}].through[{len(tendon.tendon.through) - 1}]",
                f"pulls with {format_quantity(pull, 'force')} at a point, and a voxel there "
                f"carries {format_quantity(float(f'{carried:.2g}'), 'force')}",
                'spread it as by a knot: { point = [...], radius = "2 mm" }',
            )
