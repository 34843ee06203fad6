"""The core in WebAssembly and the native one, deterministic: the same positions, bit for bit."""

import base64
import json
import shutil
import subprocess
from pathlib import Path

import lattice_families as families
import numpy as np
import pytest

import voxsoft as vs
from voxsoft import _core
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

ROOT = Path(__file__).parents[2]
CORE = ROOT / "studio" / "public" / "voxsoft.wasm"
NODE = shutil.which("node")

pytestmark = pytest.mark.skipif(NODE is None, reason="Node runs the WebAssembly core")

LATTICE = vs.Lattice(edge=60 * kPa, bulk=400 * kPa, density=1070.0)
RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.48, density=1070.0)


SILK = vs.Layer(region=vs.Region(z=(0, 0)), young="60 MPa", thickness="0.1 mm")


def cantilever(material, layers=()):
    return vs.Design(
        name="cantilever",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=vs.Box(size=(60 * mm, 10 * mm, 10 * mm)), material=material)],
        layers=layers,
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[vs.Gravity()],
    )


def scene_of(setup, **options):
    triangles = setup.mesh.triangles.astype(np.uint32)
    tags = np.zeros(len(triangles), np.uint8)
    controls = [(1.0, [0])]
    size = setup.design.voxel_size
    return _core.Scene(setup.problem, triangles, tags, size, controls=controls, **options)


def run_in_node(tmp_path, scene, seconds):
    (tmp_path / "scene").write_bytes(scene)
    script = Path(__file__).with_name("wasm_run.mjs")
    command = [NODE, script, CORE, tmp_path / "scene", tmp_path / "positions", str(seconds)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def played(scene, seconds, commands, **options):
    """Events of the native player for the same scene."""
    player = scene.play(**options)
    for command in commands:
        player.command(json.dumps(command).encode())
    player.advance(seconds, 3600.0)
    stat = json.loads(player.stat())
    return player, {key: stat[key] for key in stat if key not in OF_THE_CLOCK}


#: Numbers measured by the clock, and numbers that the runner leaves out.
OF_THE_CLOCK = {"step_ms", "real_time_factor", "topology"}


@pytest.mark.long
@pytest.mark.parametrize(
    ("design", "damping"),
    [
        (families.cylinder(), None),
        (families.cylinder(), 8.0),
        (cantilever(LATTICE), None),
        (cantilever(LATTICE, [SILK]), 8.0),
    ],
    ids=[
        "cylinder",
        "cylinder damped at a rate",
        "lattice beam",
        "lattice beam on a layer",
    ],
)
def test_a_thousand_substeps_have_the_same_bits(tmp_path, design, damping):
    setup = Setup.of(design)
    shown = np.unique(setup.mesh.triangles)
    point = int(np.argmax(setup.mesh.vertices[shown].sum(axis=1)))
    target = (setup.mesh.vertices[shown[point]] + [1 * mm, 2 * mm, -3 * mm]).tolist()
    commands = [
        {"t": "load", "index": 0, "factor": 0.75},
        {"t": "grab", "id": 3, "vertex": point, "target": target, "stiffness": 30.0},
        {"t": "play"},
    ]
    # A tolerance that is never met, so that both take all substeps.
    scene = scene_of(setup, damping=damping, tolerance=1e-30)
    problem, triangles = setup.problem, setup.mesh.triangles.astype(np.uint32)
    tags = np.zeros(len(triangles), np.uint8)
    substep = _core.Live(problem, triangles, tags, design.voxel_size, damping=damping).substep
    seconds = 1000 * substep
    done = run_in_node(tmp_path, scene.pack(json.dumps(commands)), seconds)
    assert done.returncode == 0, done.stderr
    reported = json.loads(done.stdout)

    player, stat = played(scene, seconds, commands, deterministic=True)
    native = player.positions()
    assert stat["substeps"] == 1000
    assert np.abs(native - setup.mesh.vertices).max() > 1e-4
    wasm = np.fromfile(tmp_path / "positions").reshape(native.shape)
    differ = np.flatnonzero((wasm != native).any(axis=1))
    off = np.abs(wasm - native).max()
    hint = "if the solver has changed: make wasm"
    assert differ.size == 0, f"{differ.size} vertices differ, by up to {off:.1e} m; {hint}"
    assert {key: reported["stat"][key] for key in stat} == stat
    assert base64.b64decode(reported["frame"]) == player.pack_frame(0)


@pytest.mark.long
@pytest.mark.parametrize(
    ("layers", "apart"),
    [((), 1e-9), ([SILK], 2e-3)],
    ids=["rubber beam", "rubber beam on a layer"],
)
def test_implicit_steps_agree(tmp_path, layers, apart):
    setup = Setup.of(cantilever(RUBBER, layers))
    scene, seconds = scene_of(setup, tolerance=1e-30), 12 * _core.FRAME_TIME
    commands = [{"t": "pace", "factor": 1}, {"t": "play"}]
    done = run_in_node(tmp_path, scene.pack(json.dumps(commands)), seconds)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["stat"]["substeps"] == 12
    wasm = np.fromfile(tmp_path / "positions").reshape(setup.mesh.vertices.shape)
    # A search ends where its last move is below a thousandth of the step, and rounding may end it
    # one move earlier: on the layer, native paths of loads 1e-12 apart end 0.4 % apart.
    # Wasm has to be on one of them.
    least = np.inf
    for change in range(5):
        load = {"t": "load", "index": 0, "factor": 1 + change * 1e-12}
        player, stat = played(scene, seconds, [load, *commands])
        assert stat["substeps"] == 12
        least = min(least, np.abs(wasm - player.positions()).max())
    moved = np.abs(wasm - setup.mesh.vertices).max()
    assert moved > 1 * mm
    assert least < apart * moved, "if the solver has changed: make wasm, then make studio"


def test_a_damaged_scene_is_reported(tmp_path):
    scene = scene_of(Setup.of(cantilever(LATTICE))).pack()
    for damaged, message in [
        (scene[:-3], "cut off or damaged"),
        (b"PK" + scene[2:], "no scene"),
        (scene[:4] + b"\x09" + scene[5:], "version 9"),
    ]:
        done = run_in_node(tmp_path, damaged, 1)
        assert done.returncode == 3
        assert message in done.stderr
