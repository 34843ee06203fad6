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


def pack(setup, **options):
    triangles = setup.mesh.triangles.astype(np.uint32)
    tags = np.zeros(len(triangles), np.uint8)
    return setup.problem, triangles, tags, setup.design.voxel_size, options


def run_in_node(tmp_path, scene, substeps):
    (tmp_path / "scene").write_bytes(scene)
    script = Path(__file__).with_name("wasm_run.mjs")
    command = [NODE, script, CORE, tmp_path / "scene", tmp_path / "positions", str(substeps)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


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
    vertex = int(np.argmax(setup.mesh.vertices.sum(axis=1)))
    target = (setup.mesh.vertices[vertex] + [1 * mm, 2 * mm, -3 * mm]).tolist()
    problem, triangles, tags, size, _ = pack(setup)
    # A tolerance that is never met, so that both take all substeps.
    options = {"damping": damping, "tolerance": 1e-30}
    notes = json.dumps({"loads": [[0, 0.75]], "grabs": [[3, vertex, *target, 30.0]]})
    scene = _core.pack_scene(problem, triangles, tags, size, notes=notes, **options)
    done = run_in_node(tmp_path, scene, 1000)
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)

    live = _core.Live(problem, triangles, tags, size, deterministic=True, **options)
    live.set_load(0, 0.75)
    live.grab(3, vertex, target, 30.0)
    look = live.advance(1000)
    native = live.positions()
    assert look["taken"] == 1000
    assert np.abs(native - setup.mesh.vertices).max() > 1e-4
    wasm = np.fromfile(tmp_path / "positions").reshape(native.shape)
    differ = np.flatnonzero((wasm != native).any(axis=1))
    off = np.abs(wasm - native).max()
    hint = "if the solver has changed: make wasm, then make studio"
    assert differ.size == 0, f"{differ.size} vertices differ, by up to {off:.1e} m; {hint}"
    assert told["look"][1:8] == [
        look[key]
        for key in ("time", "substep", "substeps", "back_offs", "residual", "elastic", "kinetic")
    ]
    assert base64.b64decode(told["frame"]) == live.pack_frame(1, 19, 0)


@pytest.mark.parametrize("layers", [(), [SILK]], ids=["rubber beam", "rubber beam on a layer"])
def test_implicit_steps_agree(tmp_path, layers):
    setup = Setup.of(cantilever(RUBBER, layers))
    problem, triangles, tags, size, _ = pack(setup)
    options = {"tolerance": 1e-30}
    done = run_in_node(tmp_path, _core.pack_scene(problem, triangles, tags, size, **options), 12)
    assert done.returncode == 0, done.stderr
    live = _core.Live(problem, triangles, tags, size, **options)
    assert live.method == "implicit"
    live.advance(12)
    native = live.positions()
    wasm = np.fromfile(tmp_path / "positions").reshape(native.shape)
    moved = np.abs(native - setup.mesh.vertices).max()
    # A search ends where its last move is below a thousandth of the step; other rounding may end
    # it one move earlier.
    hint = "if the solver has changed: make wasm, then make studio"
    assert np.abs(wasm - native).max() < 2e-3 * moved, hint


def test_a_damaged_scene_is_told(tmp_path):
    problem, triangles, tags, size, _ = pack(Setup.of(cantilever(LATTICE)))
    scene = _core.pack_scene(problem, triangles, tags, size)
    for damaged, message in [
        (scene[:-3], "cut off or damaged"),
        (b"PK" + scene[2:], "no scene"),
        (scene[:4] + b"\x09" + scene[5:], "version 9"),
    ]:
        done = run_in_node(tmp_path, damaged, 1)
        assert done.returncode == 3
        assert message in done.stderr
