"""Exported scenes in MuJoCo: where tips come to rest there, beside ours.

``python evidence/mujoco_scenes.py [--json]``. The ratio of each row is the way of the tip in MuJoCo
over ours. The beam is that of `tests/crosscheck/test_mujoco.py` in several sizes of voxels, bent
within small strain, with Poisson's ratio 0.3; the others are examples as they are, followed for two
seconds.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import mujoco
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

import voxsoft as vs
from voxsoft.design import Design
from voxsoft.files import write_scene

EXAMPLES = Path(__file__).parents[1] / "examples"
#: Examples with the probe whose way is compared.
TIPS = {
    "tendon_finger": "tip",
    "beam": "station-9",
    "cylinder": "top",
    "magnetic_gripper": "tip",
    "pneunet": "tip",
}
#: Those under a pressure.
INFLATED = ("cylinder", "pneunet")
SECONDS = 2.0


def beam(voxel_size: float, side: float = 0.01) -> Design:
    """A square beam of 50 mm, by default 10 mm across."""
    rubber = {"model": "neo-hookean", "young": 100e3, "poisson": 0.3, "density": 1070.0}
    return Design(
        name="beam",
        voxel_size=voxel_size,
        parts=[{"shape": {"kind": "box", "size": (0.05, side, side)}, "material": rubber}],
        clamps=[{"region": {"x": (0.0, 0.0)}}],
        loads=[{"kind": "gravity", "value": 0.5}],
        probes={"tip": {"x": (0.05, 0.05)}},
    )


def designs() -> Iterator[tuple[str, Design, str]]:
    """Every design with its name and the probe at its tip."""
    for across in (2, 3, 4, 6):
        yield f"beam, {across} across", beam(0.01 / across), "tip"
    for size in (0.0025, 0.00125):
        yield f"beam of 9 mm, cut voxels of {1e3 * size:g} mm", beam(size, 0.009), "tip"
    for name, probe in TIPS.items():
        yield name, vs.load(EXAMPLES / f"{name}.toml"), probe


def way(design: Design, probe: str, *, follows: bool = False) -> float:
    """Way of a probe in MuJoCo [m]; pressures follow the walls if asked for."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "scene.xml"
        write_scene(path, design)
        model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    pressures = list(pressed(model, data)) if follows else []
    while data.time < SECONDS:
        data.xfrc_applied[:] = 0.0
        for pressure, bodies in pressures:
            a, b, c = data.xpos[bodies].transpose(1, 0, 2)
            for corner in range(3):
                forces = -pressure / 12.0 * np.cross(b - a, c - a)
                np.add.at(data.xfrc_applied[:, :3], bodies[:, corner], forces)
        mujoco.mj_step(model, data)
    return float(np.linalg.norm([data.sensor(f"{probe}.{axis}").data[0] for axis in "xyz"]))


def pressed(model: mujoco.MjModel, data: mujoco.MjData) -> Iterator[tuple[float, np.ndarray]]:
    """Take the pressures from the actuators: each with the vertices of its triangles."""
    for index in range(model.nnumeric):
        name = model.numeric(index).name
        actuator = data.actuator(name.removesuffix(".triangles"))
        faces = model.numeric(index).data.reshape(-1, 3).astype(int)
        numbers = [model.body(f"vertex/{vertex}").id for vertex in range(faces.max() + 1)]
        yield float(actuator.ctrl[0]), np.array(numbers)[faces]
        actuator.ctrl[0] = 0.0


def main() -> None:
    """Measure everything."""
    # It writes its warnings into a file of the working directory.
    mujoco.set_mju_user_warning(lambda message: None)
    report = Report("Tips of exported scenes in MuJoCo")
    for name, design, probe in designs():
        ours = float(np.linalg.norm(vs.simulate(design, error="off").probes[probe]))
        theirs = way(design, probe)
        report.add(name, 1e3 * theirs, "mm", theirs / ours)
        if name in INFLATED:
            theirs = way(design, probe, follows=True)
            report.add(f"{name}, pressure that follows", 1e3 * theirs, "mm", theirs / ours)
    report.show()


if __name__ == "__main__":
    sys.exit(main())
