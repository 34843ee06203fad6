"""Names and archives that come from the page."""

import tomllib
import zipfile

import numpy as np
import pytest
import trimesh

from voxsoft import check
from voxsoft.design import Design
from voxsoft.design.discretization.discretize import mesh_of, voxels_of
from voxsoft.errors import FileError
from voxsoft.files import write_surfaces
from voxsoft.simulation.setup.volumes import volumes_of
from voxsoft.studio.documents.uploads import (
    design_of_mesh,
    facts_of_mesh,
    safe_name,
    unpack_folder,
)
from voxsoft.studio.protocol.commands import MeshImport


@pytest.mark.parametrize(
    ("given", "stored"),
    [
        ("arm.toml", "arm.toml"),
        ("../../arm.toml", "arm.toml"),
        ("C:\\Users\\me\\arm v2.STL", "arm-v2.stl"),
        (".hidden.csv", "hidden.csv"),
        ("\u202egpj.obj", "gpj.obj"),
        ("a" * 300 + ".npy", "a" * 120 + ".npy"),
        ("con.csv", "_con.csv"),
        ("my scan.NII.gz", "my-scan.nii.gz"),
    ],
)
def test_a_name_stays_in_its_folder(given, stored):
    assert safe_name(given) == stored


@pytest.mark.parametrize("inside", ["../outside.txt", "/tmp/outside.txt", "a/../../outside.txt"])
def test_an_archive_that_leads_outside_is_refused_whole(tmp_path, inside):
    archive = tmp_path / "run.zip"
    with zipfile.ZipFile(archive, "w") as packed:
        packed.writestr("design.toml", "a = 1")
        packed.writestr(inside, "no")
    (tmp_path / "runs").mkdir()
    with pytest.raises(FileError, match="outside itself"):
        unpack_folder(archive, tmp_path / "runs")
    assert list((tmp_path / "runs").iterdir()) == []
    assert not (tmp_path / "outside.txt").exists()


def test_an_archive_that_is_none_is_reported(tmp_path):
    archive = tmp_path / "run.zip"
    archive.write_bytes(b"PK\x03\x04 and no more")
    with pytest.raises(FileError, match="is no archive"):
        unpack_folder(archive, tmp_path)


def test_a_bomb_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("voxsoft.studio.documents.uploads.LARGEST_ARCHIVE", 1_000_000)
    archive = tmp_path / "run.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
        packed.writestr("zeros", bytes(2_000_000))
    with pytest.raises(FileError, match="too large when unpacked"):
        unpack_folder(archive, tmp_path)


def uploaded(tmp_path, array):
    np.save(tmp_path / "scan.npy", array)
    return Design.from_document(tomllib.loads(design_of_mesh(tmp_path / "scan.npy")))


def test_labels_of_an_array_are_parts(tmp_path):
    labels = np.zeros((6, 4, 3), np.uint8)
    labels[:3], labels[3:, 1:] = 1, 7
    design = uploaded(tmp_path, labels)
    assert [part.label for part in design.parts] == ["label 1", "label 7"]
    filled = voxels_of(design).array
    np.testing.assert_array_equal(filled, np.select([labels == 1, labels == 7], [1, 2]))
    assert voxels_of(design).voxel_size == 1e-3


@pytest.mark.parametrize("labels", [np.ones((4, 3, 5), np.int64), np.ones((4, 3, 5), bool)])
def test_an_array_of_one_label_is_one_part(tmp_path, labels):
    design = uploaded(tmp_path, labels)
    assert len(design.parts) == 1
    assert voxels_of(design).count == 60


@pytest.mark.parametrize(
    ("array", "what"),
    [
        (np.full((4, 4, 4), 0.03), "compare with a threshold"),
        (np.full((4, 4, 4), -1000, np.int16), "numbered 0 .* to 255"),
        (np.full((4, 4, 4), 300, np.int16), "numbered 0 .* to 255"),
        (np.ones((4, 4), np.uint8), "expected three axes"),
        (np.zeros((4, 4, 4), np.uint8), "is 0 everywhere"),
    ],
)
def test_an_array_that_is_no_labels_is_refused(tmp_path, array, what):
    with pytest.raises(FileError, match=what):
        uploaded(tmp_path, array)


def test_a_mesh_that_says_its_unit_is_read_in_it(tmp_path):
    file = tmp_path / "box.glb"
    trimesh.creation.box((0.04, 0.02, 0.02)).export(file)
    text = design_of_mesh(file)
    assert "Its numbers are, as it says, in m: change" in text
    design = Design.from_document(tomllib.loads(text))
    assert mesh_of(design).volume == pytest.approx(16e-6, rel=1e-3)


def test_the_objects_of_a_3mf_are_parts_by_name_in_its_unit(tmp_path):
    file = tmp_path / "two.3mf"
    low, high = (
        trimesh.creation.box(bounds=b) for b in (((0, 0, 0), (1, 1, 1)), ((0, 0, 1), (1, 1, 2)))
    )
    parts = {name: (0.02 * b.vertices, b.faces) for name, b in (("lower half", low), ("tip", high))}
    write_surfaces(file, parts)
    design = Design.from_document(tomllib.loads(design_of_mesh(file)))
    assert [part.shape for part in design.parts] == ["lower half", "tip"]
    found = volumes_of(design, mesh_of(design)).parts
    assert [each.simulated for each in found.values()] == pytest.approx([8e-6, 8e-6], rel=0.05)


def test_a_mesh_of_a_doubtful_size_is_asked_about(tmp_path):
    file = tmp_path / "box_m.stl"
    trimesh.creation.box((0.04, 0.02, 0.02)).export(file)
    text = design_of_mesh(file, MeshImport(unit="mm"))
    assert ", m: 40 mm long" in design_of_mesh(file)
    found = [str(each) for each in check(Design.from_document(tomllib.loads(text))).findings]
    assert any("box_m.stl is read in mm" in each for each in found)


def test_the_labels_of_an_image_are_parts(tmp_path):
    file = tmp_path / "scan.vti"
    file.write_text(
        '<VTKFile type="ImageData"><ImageData WholeExtent="0 2 0 1 0 1" Origin="0 0 0" '
        'Spacing="10 10 10"><Piece Extent="0 2 0 1 0 1"><CellData><DataArray type="Int32" '
        'Name="tissue" format="ascii">3 1000000</DataArray></CellData></Piece></ImageData>'
        "</VTKFile>"
    )
    design = Design.from_document(tomllib.loads(design_of_mesh(file)))
    assert [part.shape for part in design.parts] == ["label 3", "label 1000000"]
    found = volumes_of(design, mesh_of(design)).parts
    assert [each.simulated for each in found.values()] == pytest.approx([1e-6, 1e-6], rel=0.05)


def test_voxels_of_voxcad_keep_their_size(tmp_path):
    file = tmp_path / "robot.vxa"
    file.write_text(
        "<VXA><VXC><Lattice><Lattice_Dim>0.0005</Lattice_Dim></Lattice>"
        '<Structure Compression="ASCII_READABLE"><X_Voxels>2</X_Voxels><Y_Voxels>1</Y_Voxels>'
        "<Z_Voxels>2</Z_Voxels><Data><Layer>13</Layer><Layer>10</Layer></Data></Structure>"
        "</VXC></VXA>"
    )
    design = Design.from_document(tomllib.loads(design_of_mesh(file)))
    found = voxels_of(design)
    assert found.voxel_size == 0.0005
    np.testing.assert_array_equal(found.array, [[[1, 1]], [[2, 0]]])


@pytest.mark.parametrize(
    ("sides", "unit"), [((40, 10, 10), "mm"), ((0.04, 0.01, 0.01), "m"), ((4, 1, 1), "cm")]
)
def test_the_unit_of_a_mesh_is_guessed_from_its_size(tmp_path, sides, unit):
    file = tmp_path / "finger.stl"
    trimesh.creation.box(sides).export(file)
    facts = facts_of_mesh(file)
    assert (facts.unit, facts.stated, facts.voxels, facts.parts) == (unit, False, False, [])
    np.testing.assert_allclose(np.subtract(facts.high, facts.low), sides, rtol=1e-6)
    design = Design.from_document(tomllib.loads(design_of_mesh(file)))
    assert mesh_of(design).volume == pytest.approx(4e-6, rel=0.05)
    assert design.voxel_size == pytest.approx(0.04 / facts.cells, rel=0.05)


@pytest.mark.parametrize("up", ["x", "-x", "y", "-y", "z", "-z"])
def test_an_imported_mesh_is_scaled_and_turned_and_stands_on_its_clamp(tmp_path, up):
    file = tmp_path / "finger.stl"
    trimesh.creation.box(bounds=((1, 2, 3), (2, 4, 6))).export(file)
    text = design_of_mesh(file, MeshImport(unit="cm", scale=2.0, up=up))
    design = Design.from_document(tomllib.loads(text))
    low, high = design.shapes["body"].build().bounds()
    along = "xyz".index(up[-1])
    assert high[2] - low[2] == pytest.approx(0.02 * (along + 1))
    [first, last] = [np.array([0.02, 0.04, 0.06])[along], np.array([0.04, 0.08, 0.12])[along]]
    assert low[2] == pytest.approx(-last if up[0] == "-" else first)
    region = tomllib.loads(text)["clamps"][0]["region"]["z"]
    assert Design.from_document(tomllib.loads(text)).clamps[0].region is not None
    assert float(region[0].split()[0]) == pytest.approx(1e3 * low[2], abs=1e-3)


def test_a_unit_that_a_file_states_is_no_guess(tmp_path):
    file = tmp_path / "box.glb"
    trimesh.creation.box((4.0, 2.0, 2.0)).export(file)
    assert (facts_of_mesh(file).unit, facts_of_mesh(file).stated) == ("m", True)
