"""Scene for the core's player: the problem of a body, its surface, its loads and probes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft._memory import memory_limit
from voxsoft.design.contact import names_of
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.objects import touches_live
from voxsoft.studio.bodies.probes import Probe, placed_probes
from voxsoft.studio.protocol.message import Triple

#: Residual at which a body counts as at rest: small beside the resolution of a picture.
TOLERANCE: Final = 1e-4


def scene_of(body: StudioBody, probes: Sequence[Probe] | None = None) -> _core.Scene:
    """Make the scene of a body.

    Parameters
    ----------
    body
        The body; it must be one that can be solved.
    probes
        Plotted probes; default: the probes of the design.

    Raises
    ------
    VoxSoftError
        The body cannot be solved.
    """
    design, solver = body.setup.design, body.setup.design.solver
    surfaces: list[str] = []
    middles: list[Triple] = []
    if body.setup.touching is not None and touches_live(body.setup):
        surfaces = names_of(design.objects, design.floor is not None)
        middles = [_triple(surface.middle) for surface in body.setup.touching.surfaces]
    probes = placed_probes(body) if probes is None else probes
    return _core.Scene(
        body.played,
        body.mesh.triangles.astype(np.uint32),
        body.surface.tags,
        body.mesh.voxel_size or 0.0,
        topology=body.topology,
        controls=_controls(body),
        probes=[(probe.name, probe.vertices.tolist(), probe.weights.tolist()) for probe in probes],
        substeps=solver.substeps,
        damping=solver.damping if isinstance(solver.damping, float) else None,
        retardation=solver.retardation or 0.0,
        tolerance=TOLERANCE,
        surfaces=surfaces,
        middles=middles,
        memory=memory_limit(),
    )


def _triple(point: NDArray[np.float64]) -> Triple:
    x, y, z = point.tolist()
    return (x, y, z)


def _controls(body: StudioBody) -> list[tuple[float, list[int]]]:
    """The value of each load and tendon, and the core's loads that it became: one a cavity."""
    controls, first = [], 0
    for load, value in zip(body.setup.loads, body.load_values, strict=False):
        count = len(load.actions)
        controls.append((value, list(range(first, first + count))))
        first += count
    for value in body.load_values[len(controls) :]:  # those of tendons, one load each
        controls.append((value, [first]))
        first += 1
    return controls
