"""Arrays of voxels as files: NumPy's and those of VoxCAD, each with the usual traps."""

import numpy as np
import pytest
from scipy.io import savemat

from voxsoft.design import Design
from voxsoft.design.discretization.discretize import voxels_of
from voxsoft.errors import DesignError, FileError, ShapeError, UnitError
from voxsoft.files import check_mesh, export, read_mesh
from voxsoft.files.meshes import read_mesh_file
from voxsoft.formats.read import read_contents
from voxsoft.shapes import TriangleMesh, voxelize
from voxsoft.voxels import Voxels

#: Labels without a symmetry: a row along x, a cell beside its end, one above its beginning.
LABELS = np.zeros((4, 3, 2), np.uint8)
LABELS[:, 0, 0] = 2
LABELS[3, 1, 0] = 7
LABELS[0, 0, 1] = 7


def vxa(labels, *, lattice="<Lattice_Dim>0.002</Lattice_Dim>", **changes):
    """The text of a file of VoxCAD."""
    nx, ny, nz = labels.shape
    layers = ["".join(map(str, labels[:, :, z].ravel(order="F"))) for z in range(nz)]
    made = {"coding": "ASCII_READABLE", "layers": layers, "x": nx, "top": "VXA"} | changes
    rows = "\n".join(f"<Layer><![CDATA[{layer}]]></Layer>" for layer in made["layers"])
    return f"""<?xml version="1.0" encoding="ISO-8859-1"?>
<{made["top"]} Version="1.1"><Environment><GravAcc>-9.81</GravAcc></Environment>
<VXC Version="0.94">{f"<Lattice>{lattice}</Lattice>" if lattice else ""}
<Palette><Material ID="2"><Name>Muscle</Name></Material>
<Material ID="5"><Name>Unused</Name></Material></Palette>
<Structure Compression="{made["coding"]}">
<X_Voxels>{made["x"]}</X_Voxels><Y_Voxels>{ny}</Y_Voxels><Z_Voxels>{nz}</Z_Voxels>
<Data>{rows}</Data></Structure></VXC></{made["top"]}>"""


def write_vxa(file, labels=LABELS, **changes):
    file.write_text(vxa(labels, **changes))
    return file


def design_of(file, unit=None):
    shape = {"kind": "mesh", "path": str(file), **({} if unit is None else {"unit": unit})}
    shapes = {name: {**shape, "part": name} for name in ("label 2", "label 7")}
    return Design.from_document(
        {
            "name": "labels",
            "voxel_size": "2 mm",
            "shapes": shapes,
            "parts": [{"shape": name, "material": "ecoflex-00-30"} for name in shapes],
            "clamps": [{"region": {"z": [0, 0]}}],
        }
    )


def test_an_array_lies_along_x_y_z_with_its_labels(tmp_path):
    np.save(tmp_path / "a.npy", LABELS)
    found = design_of(tmp_path / "a.npy", "2 mm")
    filled = voxels_of(found)
    np.testing.assert_array_equal(
        filled.array, np.select([LABELS == 2, LABELS == 7], [1, 2])[:, :2]
    )
    read = read_mesh_file(tmp_path / "a.npy", unit="2 mm")
    assert list(read.report.parts.values()) == ["label 2", "label 7"]
    assert read.mesh.volume == pytest.approx(6 * 8e-9)


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("kind", [np.int64, np.uint8, np.bool_, ">u2"])
def test_the_order_and_type_in_the_file_do_not_matter(tmp_path, order, kind):
    np.save(tmp_path / "a.npy", np.asarray(LABELS.astype(kind), order=order))
    found = voxelize(TriangleMesh(path=str(tmp_path / "a.npy"), unit="2 mm"), 2e-3)
    np.testing.assert_array_equal(found.array != 0, (LABELS != 0)[:, :2])


@pytest.mark.parametrize("seed", range(6))
def test_any_array_is_filled_cell_by_cell(tmp_path, seed):
    # Cells of such arrays meet at edges and corners, and enclose others.
    random = np.random.default_rng(seed)
    cells = random.random((6, 5, 4)) < (0.2, 0.5, 0.8)[seed % 3]
    cells[0, 0, 0] = cells[-1, -1, -1] = True
    np.save(tmp_path / "a.npy", cells * random.integers(1, 4, cells.shape))
    found = voxelize(TriangleMesh(path=str(tmp_path / "a.npy"), unit="0.7 mm"), 0.7e-3)
    np.testing.assert_array_equal(found.array != 0, cells)


@pytest.mark.parametrize(
    ("array", "what"),
    [
        (LABELS.astype(float), "holds float64; parts are whole numbers.*compare with a threshold"),
        (-LABELS.astype(np.int16), "holds -7 to 0; parts are numbered 0"),
        (50 * LABELS.astype(np.int16), "holds 0 to 350; parts are numbered 0 .* to 255"),
        (LABELS[0], "shape .3, 2.; expected three axes"),
        (0 * LABELS, "is 0 everywhere"),
        (LABELS[:0], "is empty: its shape is .0, 3, 2."),
        (np.array([[[None]]]), "is no array of NumPy: it holds objects"),
    ],
)
def test_other_numbers_are_refused(tmp_path, array, what):
    np.save(tmp_path / "a.npy", array)
    with pytest.raises(FileError, match=what):
        read_contents(tmp_path / "a.npy")


def test_a_file_that_is_no_array_is_refused(tmp_path):
    (tmp_path / "a.npy").write_bytes(b"\x93NUMPY and no more")
    with pytest.raises(FileError, match="is no array of NumPy"):
        read_contents(tmp_path / "a.npy")
    np.savez(tmp_path / "b.npz", LABELS)
    (tmp_path / "b.npz").rename(tmp_path / "b.npy")
    with pytest.raises(FileError, match="is no array of NumPy: the magic string"):
        read_contents(tmp_path / "b.npy")


def test_the_size_of_a_voxel_is_asked_for(tmp_path):
    file = tmp_path / "a.npy"
    np.save(file, LABELS)
    asked = "voxels are; its body is 4 × 2 × 2 voxels"
    with pytest.raises(UnitError, match=f"{asked}.*--voxel-size the side of a voxel"):
        check_mesh(file)
    with pytest.raises(UnitError, match=f"{asked}.*unit="):
        read_mesh(file)
    with pytest.raises(ShapeError, match=asked):
        TriangleMesh(path=str(file)).state()
    with pytest.raises(DesignError, match=asked):
        Design.from_document({"name": "a", "mesh": {"path": str(file)}, "parts": []})
    with pytest.raises(UnitError, match="--voxel-size"):
        check_mesh(file, voxel_size="0 mm")
    with pytest.raises(UnitError, match="no positive length"):
        read_mesh(file, unit="-1 mm")


@pytest.mark.parametrize("given", [{"voxel_size": "2 mm"}, {"voxel_size": 2e-3}, {"unit": "2 mm"}])
def test_check_takes_the_voxels_as_they_are(tmp_path, given):
    np.save(tmp_path / "a.npy", LABELS)
    report = check_mesh(tmp_path / "a.npy", **given)
    assert report.valid
    assert report.voxels == 6
    assert report.file.meter == 2e-3
    assert not any(each.where == "voxel size" for each in report.findings)
    finer = check_mesh(tmp_path / "a.npy", unit="2 mm", voxel_size="1 mm")
    assert finer.voxels == 48


def test_an_exported_array_is_read_again(tmp_path):
    made = design_of(write_vxa(tmp_path / "a.vxa"))
    made.save(tmp_path / "a.toml")
    export(tmp_path / "a.toml", tmp_path / "b.npy")
    again = voxelize(TriangleMesh(path=str(tmp_path / "b.npy"), unit="2 mm"), 2e-3)
    np.testing.assert_array_equal(again.array != 0, voxels_of(made).array != 0)


@pytest.mark.parametrize("top", ["VXA", "VXD"])
def test_voxcad_has_x_fastest_and_layers_upward(tmp_path, top):
    file = write_vxa(tmp_path / f"a.{top.lower()}", top=top)
    found = design_of(file)
    expected = np.select([LABELS == 2, LABELS == 7], [1, 2])
    np.testing.assert_array_equal(voxels_of(found).array, expected[:, :2])
    report = check_mesh(file)
    assert (report.voxels, report.file.meter) == (6, 0.002)
    assert any('Label 2 is the material "Muscle"' in each for each in report.file.differences)
    assert not any("Unused" in each for each in report.file.differences)


def test_voxcad_without_a_lattice_asks_for_its_size(tmp_path):
    file = write_vxa(tmp_path / "a.vxd", lattice="", top="VXD")
    with pytest.raises(UnitError, match="how large its voxels are"):
        check_mesh(file)
    assert check_mesh(file, voxel_size="2 mm").voxels == 6


def test_voxcad_with_flat_voxels_keeps_their_sides(tmp_path):
    lattice = "<Lattice_Dim>0.002</Lattice_Dim><Z_Dim_Adj>0.5</Z_Dim_Adj>"
    found = read_contents(write_vxa(tmp_path / "a.vxa", lattice=lattice))
    assert np.ptp(found.points, axis=0).tolist() == [4, 2, 1]
    assert found.unit == 0.002


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"coding": "ZLIB"}, 'coded as "ZLIB"; ASCII_READABLE is read'),
        ({"layers": ["2222", "7000"]}, "2 layers of 4 voxels, for 4 × 3 × 2"),
        ({"layers": ["2222000700:0", "700000000000"]}, "has ':' among its voxels"),
        ({"x": "four"}, "<X_Voxels> is 'four'; expected a number"),
        ({"lattice": "<X_Line_Offset>0.5</X_Line_Offset>"}, "lines or layers are shifted"),
        ({"lattice": "<Lattice_Dim>-1</Lattice_Dim>"}, "have no size"),
    ],
)
def test_other_structures_are_refused(tmp_path, changes, what):
    with pytest.raises(FileError, match=what):
        read_contents(write_vxa(tmp_path / "a.vxa", **changes))


def test_xml_without_voxels_is_refused(tmp_path):
    (tmp_path / "a.vxa").write_text("<VXA><Simulator/></VXA>")
    with pytest.raises(FileError, match="no element <Structure>"):
        read_contents(tmp_path / "a.vxa")
    (tmp_path / "a.vxa").write_text("<VXA><Simulator>")
    with pytest.raises(FileError, match="is no XML"):
        read_contents(tmp_path / "a.vxa")


def test_labels_are_those_of_an_array_in_python(tmp_path):
    np.save(tmp_path / "a.npy", LABELS)
    mesh = read_mesh(tmp_path / "a.npy", unit="2 mm")
    expected = Voxels.from_array(LABELS, 2e-3).mesh()
    for part, label in ((1, 2), (2, 7)):
        volumes = (m.tet_volumes[m.tet_part == n] for m, n in ((mesh, part), (expected, label)))
        one, other = (each.sum() for each in volumes)
        assert one == pytest.approx(other)


@pytest.mark.parametrize("kind", [np.uint8, np.float64, bool])
def test_labels_of_matlab_are_parts_in_any_type(tmp_path, kind):
    """MATLAB calculates in doubles, and stores whole ones in as few bits as they need."""
    labels = LABELS.astype(kind)
    savemat(tmp_path / "a.mat", {"scan": labels, "spacing": 2.0, "name": "lung"})
    read = read_mesh_file(tmp_path / "a.mat", unit="2 mm")
    # Six tetrahedra in a cell; parts are numbered in the order of their labels.
    cells_of = [np.count_nonzero(labels == label) for label in np.unique(labels[labels > 0])]
    assert np.bincount(read.mesh.tet_part)[1:].tolist() == [6 * count for count in cells_of]
    # The box of the cells, with the axes in the order of the array.
    cells = np.argwhere(LABELS)
    np.testing.assert_allclose(read.mesh.vertices.min(axis=0), 2e-3 * cells.min(axis=0))
    np.testing.assert_allclose(read.mesh.vertices.max(axis=0), 2e-3 * (cells.max(axis=0) + 1))


@pytest.mark.parametrize(
    ("variables", "what"),
    [
        ({"a": np.ones((2, 3))}, "no array with three axes: a"),
        ({"a": np.ones((2, 3, 4)), "b": np.ones((2, 3, 4))}, "several arrays with three axes: a"),
        ({"a": np.full((2, 3, 4), 0.5)}, "a holds fractions.*compare with a threshold"),
        ({"a": np.full((2, 3, 4), 300.0)}, "a holds 300 to 300; parts are numbered 0"),
    ],
)
def test_other_variables_of_matlab_are_refused(tmp_path, variables, what):
    savemat(tmp_path / "a.mat", variables)
    with pytest.raises(FileError, match=what):
        read_contents(tmp_path / "a.mat")
