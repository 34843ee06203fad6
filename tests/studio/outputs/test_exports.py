"""Files of the shown body, read back by the programs they are for."""

import asyncio
import io
import tomllib
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

import httpx
import meshio
import mujoco
import numpy as np
import pytest
from own_loop import run
from pxr import Usd, UsdGeom

import voxsoft as vs
from voxsoft.comparison import Deck
from voxsoft.design import families
from voxsoft.errors import FileError
from voxsoft.files import read_mesh, write_run
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.outputs.exports import Shown, export_run, export_shown


def export(studio, format, **options):
    headers = {"origin": studio.origin}
    key = {"token": studio.token}
    answer = httpx.post(
        f"{studio.origin}/export",
        params=key,
        json={"format": format, "options": options},
        headers=headers,
        timeout=60,
    )
    if answer.status_code != 200:
        return answer
    return httpx.get(f"{studio.origin}{answer.json()['url']}", params=key, timeout=60)


@pytest.mark.long
@pytest.mark.parametrize(("unit", "meter"), [("mm", 1e-3), ("m", 1.0)])
def test_a_surface_has_the_size_and_unit_asked_for(at_rest, tmp_path, unit, meter):
    for format in ("stl", "obj"):
        file = tmp_path / f"body.{format}"
        for voxels, count, rel in ((True, 1408, 1e-5), (False, 5616, 0.01)):
            file.write_bytes(export(at_rest, format, unit=unit, voxels=voxels).content)
            found = meshio.read(file)
            size = np.ptp(found.points, axis=0) * meter
            assert size == pytest.approx([0.05, 0.05, 0.035], rel=rel)
            assert len(found.cells_dict["triangle"]) == count
    file.write_bytes(export(at_rest, "obj", unit=unit, deformed=True).content)
    assert np.ptp(meshio.read(file).points[:, 2]) * meter > 0.04  # it rose by some 13 mm


@pytest.mark.parametrize("format", ["vtu", "msh", "inp"])
def test_a_mesh_is_read_back(at_rest, tmp_path, format):
    file = tmp_path / f"body.{format}"
    alone = {"mesh_alone": True} if format == "inp" else {}
    file.write_bytes(export(at_rest, format, **alone).content)
    mesh = read_mesh(file)
    assert (len(mesh.vertices), len(mesh.tets)) == (660, 1500)
    if format == "vtu":
        moved = meshio.read(file).point_data["displacement"]
        assert moved[:, 2].max() == pytest.approx(0.013, abs=1e-3)


def test_of_the_lattice_the_mesh_alone_is_written_and_the_loss_is_listed(tmp_path):
    lattice = vs.load(Path(__file__).parents[3] / "examples/cylinder.toml")
    body = StudioBody.of(lattice, rev=1, topology=1)
    shown = Shown("cylinder", "", body, body.mesh.vertices, None, (), (), (), factors=(1.0,))
    run_folder = write_run(vs.simulate(lattice, error="off"), tmp_path / "run")
    for written in (
        export_shown(shown, "inp", {}, tmp_path),
        export_run(run_folder, "inp", {}, tmp_path / "run"),
    ):
        (lost,) = written.lost
        assert lost.where == "computation"
        assert "holds the mesh alone" in lost.what
        assert 'no "lattice" material' in lost.what
        text = written.file.read_text(encoding="ascii")
        assert "*ELEMENT, TYPE=C3D4" in text
        assert "*STEP" not in text


def test_a_computation_has_the_loads_as_they_are_set(tmp_path):
    body = StudioBody.of(families.beam(), rev=1, topology=1)
    shown = Shown("beam", "", body, body.mesh.vertices, None, (), (), (), factors=(0.5,))
    written = export_shown(shown, "inp", {"unit": "mm", "element": "C3D8I", "split": 2}, tmp_path)
    assert [each.where for each in written.lost] == ["unit"]  # bricks of 2.5 mm, in N
    text = written.file.read_text(encoding="ascii")
    assert "*ELEMENT, TYPE=C3D8I" in text
    assert "640 bricks" in text
    assert "ALL-ELEMENTS, GRAV, 4905, 0, 0, -1\n" in text
    with pytest.raises(FileError, match="split: 'two' is no int"):
        export_shown(shown, "inp", {"split": "two"}, tmp_path)


def test_a_computation_of_a_run_folder_is_that_of_its_design(tmp_path):
    beam = families.beam(length="40 mm")
    run_folder = write_run(vs.simulate(beam, error="off"), tmp_path / "run")
    file = export_run(run_folder, "inp", {"unit": "um"}, tmp_path).file
    # Weights of probes have last digits, which the folder rounds.
    own = Deck.of(beam, unit="um").text.partition("*STEP")[2]
    assert file.read_text(encoding="ascii").partition("*STEP")[2] == own
    bent = export_run(run_folder, "inp", {"deformed": True}, tmp_path).file
    assert "*ELEMENT, TYPE=C3D4" in bent.read_text(encoding="ascii")


@pytest.mark.long
def test_molds_come_as_an_archive_with_their_sheet(at_rest, tmp_path):
    held = zipfile.ZipFile(io.BytesIO(export(at_rest, "molds").content))
    names = {name.rpartition("/")[2] for name in held.namelist()} - {""}
    parts = {"body-high-lower.3mf", "body-low-lower.3mf", "body-low-upper.3mf", "plate-1.3mf"}
    assert names == parts | {"design.toml", "make.json", "sheet.html"}
    sheet = next(name for name in held.namelist() if name.endswith("sheet.html"))
    assert b"Ecoflex 00-30" in held.read(sheet)


def test_a_scene_opens_in_mujoco_and_its_losses_are_in_the_log(studio, tmp_path):
    async def scenario():
        async with studio.page() as page:
            await page.until("body")
            answer = await asyncio.to_thread(export, studio, "xml")
            await page.until("log", lambda log: "cylinder.xml: loads[0]: is a gener" in log.text)
            return answer

    file = tmp_path / "cylinder.xml"
    file.write_bytes(run(scenario()).content)
    model = mujoco.MjModel.from_xml_path(str(file))
    assert model.nflexvert == 660
    assert model.actuator("loads[0]").ctrllimited == 0


def test_a_scene_in_usd_has_the_state_of_the_screen(at_rest, tmp_path):
    file = tmp_path / "body.usdz"
    file.write_bytes(export(at_rest, "usdz").content)
    stage = Usd.Stage.Open(str(file))
    volume = UsdGeom.TetMesh(stage.GetPrimAtPath("/cylinder/body/volume"))
    rest, now = (np.array(volume.GetPointsAttr().Get(time)) for time in (0.0, 24.0))
    assert (now - rest)[:, 2].max() == pytest.approx(0.013, abs=1e-3)


@pytest.mark.long
def test_text_tables_voxels_pictures_and_folders(at_rest):
    text = export(at_rest, "toml").text
    assert "= radius - wall" in text
    assert "=" not in tomllib.loads(export(at_rest, "toml", resolved=True).text)["shapes"]["cavity"]
    head, *rows = export(at_rest, "csv").text.splitlines()
    assert head == "time_s,residual,elastic_energy_J,kinetic_energy_J,top_m"
    assert len(rows) >= 2
    assert np.load(io.BytesIO(export(at_rest, "npy").content)).sum() == 300
    picture = export(at_rest, "png").content
    assert picture.startswith(b"\x89PNG")
    assert len(picture) > 10_000
    names = zipfile.ZipFile(io.BytesIO(export(at_rest, "run").content)).namelist()
    assert {"cylinder/design.toml", "cylinder/summary.json", "cylinder/result.vtu"} <= set(names)


@pytest.mark.parametrize(
    ("format", "options", "words"),
    [
        ("exe", {}, "is not known"),
        ("stl", {"unit": "kg"}, "unit"),
        ("png", {"scale": 1000}, "is no scale"),
        ("stl", {"run": "../x"}, "no name for a folder"),
        ("stl", {"run": "never"}, "not in the list"),
    ],
)
def test_impossible_exports_are_reported(at_rest, format, options, words):
    answer = export(at_rest, format, **options)
    assert answer.status_code == 422
    assert words in f"{answer.json()['where']} {answer.json()['what']}"


def test_a_download_that_is_not_there_is_reported(at_rest):
    answer = httpx.get(f"{at_rest.origin}/download/nothing", params={"token": at_rest.token})
    assert answer.status_code == 404
    assert "export it again" in answer.json()["hint"]


def test_a_series_comes_as_an_archive_with_its_states(at_rest, tmp_path):
    zipfile.ZipFile(io.BytesIO(export(at_rest, "pvd").content)).extractall(tmp_path)
    (listed,) = tmp_path.glob("*/*.pvd")
    (row,) = ET.parse(listed).getroot().iter("DataSet")
    found = meshio.read(listed.parent / row.get("file"))
    assert found.point_data["displacement"][:, 2].max() == pytest.approx(0.013, abs=1e-3)
    assert {"von_mises", "max_stretch"} <= found.point_data.keys()
