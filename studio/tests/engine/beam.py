"""Write ``beam.scene``: a beam of 6 x 2 x 2 voxels that is held at x = 0 and sags under its weight.

``python studio/tests/engine/beam.py``, after a change of the bytes of scenes.
"""

from pathlib import Path

import numpy as np

import voxsoft as vs
from voxsoft import _core
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

design = vs.Design(
    name="beam",
    voxel_size=5 * mm,
    parts=[
        vs.Part(
            shape=vs.Box(size=(30 * mm, 10 * mm, 10 * mm)),
            material=vs.Lattice(edge=60 * kPa, bulk=400 * kPa, density=1070.0),
        )
    ],
    clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
    loads=[vs.Gravity()],
)
setup = Setup.of(design)
triangles = setup.mesh.triangles.astype(np.uint32)
scene = _core.Scene(
    setup.problem,
    triangles,
    np.zeros(len(triangles), np.uint8),
    design.voxel_size,
    topology=4,
    controls=[(9.81, [0])],
    probes=[("tip", [len(setup.mesh.vertices) - 1], [1.0])],
)
Path(__file__).with_name("beam.scene").write_bytes(scene.pack('{"name":"beam"}'))
