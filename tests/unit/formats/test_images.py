"""Images of scanners: place, size, unit and labels, each with the usual trap."""

import numpy as np
import pytest

from voxsoft.errors import FileError
from voxsoft.files import check_mesh, read_mesh
from voxsoft.formats.read import read_contents
from voxsoft.shapes import TriangleMesh, voxelize

#: Labels (4, 3, 2) without a symmetry: 7 in a row along x, 3 beside its end.
LABELS = np.zeros((4, 3, 2), np.uint8)
LABELS[:, 0, 0] = 7
LABELS[3, 1, 0] = 3
#: Spacings of the voxels along x, y, z, and the middle of the first one.
STEPS, FIRST = np.array([1.0, 2.0, 4.0]), np.array([10.0, 20.0, 30.0])


def box_of(contents, value):
    """Lowest and highest corner of the cells with a label."""
    (block,) = contents.blocks
    points = contents.points[block.nodes[contents.arrays["label"] == value]].reshape(-1, 3)
    return points.min(axis=0).tolist(), points.max(axis=0).tolist()


def assert_in_place(contents):
    assert box_of(contents, 7) == ([9.5, 19, 28], [13.5, 21, 32])
    assert box_of(contents, 3) == ([12.5, 21, 28], [13.5, 23, 32])


@pytest.fixture
def nrrd():
    return pytest.importorskip("nrrd")


@pytest.fixture
def nibabel():
    return pytest.importorskip("nibabel")


@pytest.fixture
def tifffile():
    return pytest.importorskip("tifffile")


def header(**changes):
    made = {
        "space": "right-anterior-superior",
        "space directions": np.diag(STEPS),
        "space origin": FIRST,
        "space units": ["mm", "mm", "mm"],
    }
    return {key: value for key, value in (made | changes).items() if value is not None}


@pytest.mark.parametrize("encoding", ["raw", "gzip"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_nrrd_is_in_place(tmp_path, nrrd, encoding, order):
    values = LABELS if order == "F" else LABELS.transpose()
    entries = header() | {"encoding": encoding}
    nrrd.write(str(tmp_path / "a.nrrd"), values, entries, index_order=order)
    found = read_contents(tmp_path / "a.nrrd")
    assert_in_place(found)
    assert found.unit == 1e-3


def test_nrrd_of_a_left_posterior_space_changes_two_signs(tmp_path, nrrd):
    turned = header(**{"space": "left-posterior-superior", "space origin": FIRST * (-1, -1, 1)})
    turned["space directions"] = np.diag(STEPS * (-1, -1, 1))
    nrrd.write(str(tmp_path / "a.nrrd"), LABELS, turned)
    found = read_contents(tmp_path / "a.nrrd")
    assert_in_place(found)
    assert "left-posterior-superior are turned" in " ".join(found.notes)


def test_a_left_handed_grid_has_a_positive_volume(tmp_path, nrrd):
    entries = header(**{"space directions": np.diag(STEPS * (-1, 1, 1))})
    nrrd.write(str(tmp_path / "a.nrrd"), LABELS, entries)
    assert read_mesh(tmp_path / "a.nrrd").surface_volume == pytest.approx(5 * 8e-9)
    found = read_contents(tmp_path / "a.nrrd")
    assert box_of(found, 3) == ([6.5, 21, 28], [7.5, 23, 32])
    (block,) = found.blocks
    first, *sides = found.points[block.nodes[:, [0, 1, 3, 4]]].transpose(1, 0, 2)
    assert np.linalg.det(np.stack([side - first for side in sides], axis=1)) == pytest.approx(8.0)


def test_nrrd_takes_spacings_and_asks_for_a_missing_size(tmp_path, nrrd):
    alone = {"space": None, "space directions": None, "space origin": None, "space units": None}
    entries = header(**alone) | {"spacings": STEPS}
    nrrd.write(str(tmp_path / "a.nrrd"), LABELS, entries)
    found = read_contents(tmp_path / "a.nrrd")
    assert box_of(found, 7) == ([-0.5, -1, -2], [3.5, 1, 2])
    assert found.unit is None
    nrrd.write(str(tmp_path / "b.nrrd"), LABELS, header(**alone))
    with pytest.raises(FileError, match="how large its voxels are"):
        read_contents(tmp_path / "b.nrrd")


@pytest.mark.parametrize("suffix", [".nii", ".nii.gz"])
@pytest.mark.parametrize(
    ("unit", "meter"), [("mm", 1e-3), ("meter", 1.0), ("micron", 1e-6), ("unknown", None)]
)
def test_nifti_is_in_place_in_its_unit(tmp_path, nibabel, suffix, unit, meter):
    affine = np.diag([*STEPS, 1.0])
    affine[:3, 3] = FIRST
    image = nibabel.Nifti1Image(LABELS[..., None], affine)
    image.header.set_xyzt_units(xyz=unit)
    nibabel.save(image, tmp_path / f"a{suffix}")
    found = read_contents(tmp_path / f"a{suffix}")
    assert_in_place(found)
    assert found.unit == meter


def test_nifti_labels_are_those_that_are_stored(tmp_path, nibabel):
    image = nibabel.Nifti1Image(LABELS, np.eye(4))
    image.header.set_slope_inter(0.988, 0.0)
    nibabel.save(image, tmp_path / "a.nii")
    assert nibabel.load(tmp_path / "a.nii").get_fdata().max() == pytest.approx(7 * 0.988)
    found = read_contents(tmp_path / "a.nii")
    assert set(found.arrays["label"].tolist()) == {3, 7}
    assert any("scaled by 0.988" in note for note in found.notes)


def test_tiff_of_imagej_is_in_place_from_the_lowest_layer_up(tmp_path, tifffile):
    stack = LABELS.transpose(2, 1, 0)
    tifffile.imwrite(
        tmp_path / "a.tif",
        stack,
        imagej=True,
        resolution=(1 / STEPS[0], 1 / STEPS[1]),
        metadata={"axes": "ZYX", "spacing": STEPS[2], "unit": "mm"},
    )
    found = read_contents(tmp_path / "a.tif")
    assert found.unit == 1e-3
    assert box_of(found, 7) == ([-0.5, -1, -2], [3.5, 1, 2])
    assert box_of(found, 3) == ([2.5, 1, -2], [3.5, 3, 2])


def test_tiff_of_colors_or_without_a_size_is_refused(tmp_path, tifffile):
    three = np.concatenate([LABELS, LABELS[:, :, :1]], axis=2).transpose(2, 1, 0)
    tifffile.imwrite(tmp_path / "a.tif", three, photometric="rgb", planarconfig="separate")
    with pytest.raises(FileError, match="holds colors"):
        read_contents(tmp_path / "a.tif")
    tifffile.imwrite(tmp_path / "b.tif", three, photometric="minisblack")
    with pytest.raises(FileError, match="how large its voxels are"):
        read_contents(tmp_path / "b.tif")


@pytest.mark.parametrize(
    ("values", "match"),
    [
        (np.linspace(0, 1, 24).reshape(4, 3, 2), "a body needs labels"),
        (LABELS.astype(np.int16) * -100, "negative numbers"),
        (LABELS * 0, "0 everywhere"),
        (np.stack([LABELS] * 3), "has three axes"),
    ],
)
def test_an_image_that_is_no_labels_is_refused(tmp_path, nrrd, values, match):
    directions = np.diag(STEPS) if values.ndim == 3 else np.vstack([[np.nan] * 3, np.diag(STEPS)])
    entries = header(**{"space directions": directions})
    nrrd.write(str(tmp_path / "a.nrrd"), values, entries)
    with pytest.raises(FileError, match=match):
        read_contents(tmp_path / "a.nrrd")


@pytest.mark.parametrize("suffix", [".nrrd", ".nii", ".tif"])
def test_a_damaged_image_is_refused_with_its_format(tmp_path, suffix):
    pytest.importorskip({".nrrd": "nrrd", ".nii": "nibabel", ".tif": "tifffile"}[suffix])
    (tmp_path / f"a{suffix}").write_bytes(b"no image of this format" * 20)
    with pytest.raises(FileError, match="cannot be read as"):
        read_contents(tmp_path / f"a{suffix}")


def test_labels_are_parts_of_a_shape_and_of_a_check(tmp_path, nrrd):
    nrrd.write(str(tmp_path / "a.nrrd"), LABELS, header(**{"space directions": np.eye(3)}))
    part = TriangleMesh(path=str(tmp_path / "a.nrrd"), part="label 7")
    assert voxelize(part, 1e-3).count == 4
    found = check_mesh(tmp_path / "a.nrrd", voxel_size="1 mm")
    assert found.volumes.parts["a.nrrd"].simulated == pytest.approx(5e-9)
