"""The exported surface is the shape that is simulated, by name, from each way in."""

import zipfile

import numpy as np
import pytest
import trimesh
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import families
from voxsoft.errors import FileError
from voxsoft.files import export, write_run, write_shape
from voxsoft.shapes import Sphere

VOLUME = 1e-4
PARTS = ("skin", "core")


def ball():
    radius = Sphere(radius=0.008)
    return vs.Design(
        name="ball",
        voxel_size=0.002,
        parts=[
            vs.Part(name="skin", shape=radius.shell(0.003), material="ecoflex-00-30"),
            vs.Part(name="core", shape=radius, material="ecoflex-00-50"),
        ],
        clamps=[vs.Clamp(region=vs.Region(z=("-inf", -0.005)))],
        loads=[vs.Gravity(value="600 m/s^2")],
    )


@pytest.fixture(scope="module")
def result():
    return vs.simulate(ball())


def volumes(path, factor):
    options = {"split_groups": True} if path.suffix == ".obj" else {}
    scene = trimesh.load_scene(path, **options)
    assert all(body.is_watertight for body in scene.geometry.values())
    return {name: body.volume / factor**3 for name, body in scene.geometry.items()}


@pytest.mark.parametrize(("suffix", "factor"), [(".stl", 1e3), (".obj", 1e3), (".glb", 1.0)])
def test_each_part_has_the_simulated_volume(tmp_path, suffix, factor, result):
    simulated = result.summary()["volumes"]["parts"]
    path = tmp_path / f"ball{suffix}"
    write_shape(path, ball())
    found = volumes(path, factor)
    assert set(found) == set(PARTS)
    for name in PARTS:
        assert found[name] == pytest.approx(simulated[name]["simulated"], rel=VOLUME)


def test_a_run_gives_its_unloaded_and_its_deformed_shape(tmp_path, result):
    write_run(result, tmp_path / "run")
    export(tmp_path / "run", tmp_path / "rest.stl")
    export(tmp_path / "run", tmp_path / "loaded.stl", deformed=True)
    write_shape(tmp_path / "same.stl", result, deformed=True)
    rest, loaded = (trimesh.load_scene(tmp_path / f"{n}.stl").bounds for n in ("rest", "loaded"))
    sag = result.mesh.vertices[:, 2].max() - result.positions[:, 2].max()
    # The vertices of voxels lie above the surface that they carry: they say it to a tenth.
    assert rest[1, 2] - loaded[1, 2] == pytest.approx(1e3 * sag, rel=0.1)
    assert (tmp_path / "same.stl").read_bytes() == (tmp_path / "loaded.stl").read_bytes()
    moved = sum(volumes(tmp_path / "loaded.stl", 1e3).values())
    mesh = result.mesh
    expected = (vs.mesh_of(ball()).fractions[mesh.tet_voxel] * tets(result)).sum()
    assert moved == pytest.approx(expected, rel=VOLUME)


def tets(result):
    a, b, c, d = (result.positions[result.mesh.tets[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def test_the_command_writes_the_shape_or_the_faces_of_voxels(tmp_path):
    families.sphere().save(tmp_path / "ball.toml")
    mesh = vs.mesh_of(families.sphere())
    found = {}
    for name, option in (("smooth.stl", []), ("stairs.stl", ["--voxels"])):
        arguments = ["export", str(tmp_path / "ball.toml"), str(tmp_path / name), *option]
        assert CliRunner().invoke(app, arguments).exit_code == 0
        (found[name],) = volumes(tmp_path / name, 1e3).values()
    assert found["smooth.stl"] == pytest.approx(mesh.volume, rel=VOLUME)
    # The faces hold cut voxels as full ones.
    assert found["stairs.stl"] == pytest.approx(mesh.tet_volumes.sum(), rel=VOLUME)
    assert found["stairs.stl"] > 1.1 * found["smooth.stl"]


def test_a_3mf_of_several_parts_has_their_names(tmp_path):
    ball().save(tmp_path / "ball.toml")
    export(tmp_path / "ball.toml", tmp_path / "ball.3mf")
    with zipfile.ZipFile(tmp_path / "ball.3mf") as archive:
        model = archive.read("3D/3dmodel.model").decode()
    assert all(f'name="{name}"' in model for name in PARTS)


def test_only_surfaces_take_voxels(tmp_path):
    ball().save(tmp_path / "ball.toml")
    with pytest.raises(FileError, match="is no surface"):
        export(tmp_path / "ball.toml", tmp_path / "ball.vtu", voxels=True)


def test_a_design_has_no_shape_under_load(tmp_path):
    with pytest.raises(FileError, match="no shape under load"):
        write_shape(tmp_path / "ball.stl", ball(), deformed=True)
