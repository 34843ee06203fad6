"""Tests in TOML: points with a load over one clock, marks on a photograph, and slips in them."""

import numpy as np
import pytest

from voxsoft.errors import FileError, MeasurementError
from voxsoft.files import load_measurements
from voxsoft.jobs import MeasuredTable

TIMES = np.arange(0, 6, 0.1)
TEST = """schema = "voxsoft-test/1"
source = "me, CC0"
rest = ["0 s", "0.9 s"]
loaded = [["2 s", "3 s"], ["4 s", "5 s"]]
points = { file = "cam.csv", rate = "10 Hz", stations = { a = "tip" } }
channels = { file = "cell.csv" }
synchronize = { by = "lamp" }
set = { pull = "force" }
"""


def column_of(head, values):
    return [head, *(f"{value:.6g}" for value in values)]


def write(path, *columns):
    path.write_text("\n".join(",".join(row) for row in zip(*columns, strict=True)) + "\n")


def lamp(times):
    return sum((np.abs(times - at) < 0.16).astype(float) for at in (0.5, 1.4, 3.6))


@pytest.fixture
def folder(tmp_path):
    """A tip that sinks by 2 mm for each newton; the cell's clock is 0.7 s behind."""
    force = np.select([TIMES >= 3.5, TIMES >= 1.5], [3.0, 1.0], 0.0)
    z = column_of("a z_mm", 5.0 - 2.0 * force)
    write(tmp_path / "cam.csv", column_of("a x_mm", 0 * TIMES), z, column_of("lamp_V", lamp(TIMES)))
    late = TIMES + 0.7
    held = np.select([late >= 3.5, late >= 1.5], [3.0, 1.0], 0.0)
    write(
        tmp_path / "cell.csv",
        column_of("time_s", TIMES),
        column_of("force_N", held),
        column_of("lamp_V", lamp(late)),
    )
    (tmp_path / "test.toml").write_text(TEST)
    return tmp_path


def test_a_test_becomes_a_measurement_for_each_load(folder):
    first, second = load_measurements(folder / "test.toml")
    np.testing.assert_allclose(first.values, [[0.0, -0.002]], atol=1e-15)
    np.testing.assert_allclose(second.values, [[0.0, -0.006]], atol=1e-15)
    assert (first.changes, second.changes) == (("pull=1 N",), ("pull=3 N",))
    assert first.source.startswith("me, CC0 cam.csv + cell.csv: 2 s to 3 s less 0 s to 0.9 s")


def test_a_job_keeps_the_displacements_and_not_the_files(folder):
    tables = MeasuredTable.of_file(folder / "test.toml")
    for file in folder.iterdir():
        file.unlink()
    assert [table.name for table in tables] == ["test.toml, 1 of 2", "test.toml, 2 of 2"]
    seen = tables[1].read()
    np.testing.assert_allclose(seen.values, [[0.0, -0.006]], atol=1e-15)
    assert seen.changes == ("pull=3 N",)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("voxsoft-test/1", "voxsoft/1", "is no test: it has voxsoft/1"),
        ("rest =", "resting =", "resting"),
        ('rest = ["0 s", "0.9 s"]\n', "", "rest: is missing"),
        ('["2 s", "3 s"]', '["2", "3 s"]', 'loaded.*"2" has no unit'),
        ("cam.csv", "none.csv", "none.csv: no such file"),
        ('by = "lamp"', 'by = "flash"', 'has no column "flash"'),
        ('{ by = "lamp" }', "{}", "needs by=, a column of both, or step="),
        ('channels = { file = "cell.csv" }\n', "", r"needs \[channels\]"),
        ('a = "tip"', 'a = "tip", b = "knee"', 'has no point "b"'),
        ('pull = "force"', 'pull = "farce"', 'has no column "farce"'),
        (
            "points =",
            'picture = { file = "a", unit = "mm", stations = ["tip"] }\npoints =',
            "one of",
        ),
    ],
)
def test_slips_in_a_test_are_named(folder, old, new, words):
    (folder / "test.toml").write_text(TEST.replace(old, new))
    with pytest.raises((MeasurementError, FileError), match=words):
        load_measurements(folder / "test.toml")


PHOTO = """schema = "voxsoft-test/1"
line = "upper-edge"
set = { pull = "50 mN" }

[picture]
file = "Results.csv"
unit = "mm"
stations = ["0 mm", "20 mm", "40 mm"]
"""
RESULTS = " ,Area,X,Y\n1,0,10,20\n2,0,29.5,22\n3,0,47.5,31.7\n"


def test_marks_of_imagej_count_from_the_clamp_and_y_points_down(tmp_path):
    (tmp_path / "photo.toml").write_text(PHOTO)
    (tmp_path / "Results.csv").write_text(RESULTS)
    (seen,) = load_measurements(tmp_path / "photo.toml")
    assert (seen.quantities, seen.line, seen.changes) == (("x", "z"), "upper-edge", ("pull=50 mN",))
    np.testing.assert_allclose(seen.arcs, [0.02, 0.04])
    np.testing.assert_allclose(seen.values, [[0.0195, -0.002], [0.0375, -0.0117]], rtol=1e-12)


def test_marks_with_and_without_the_load_are_displacements_at_probes(tmp_path):
    text = PHOTO.replace('"0 mm", "20 mm", "40 mm"', '"a", "b", "c"')
    text = text.replace('unit = "mm"', 'unit = "px"\npixel = "0.5 mm"\nrest = "Rest.csv"')
    (tmp_path / "photo.toml").write_text(text)
    (tmp_path / "Results.csv").write_text(RESULTS)
    (tmp_path / "Rest.csv").write_text(" ,X,Y\n1,10,20\n2,30,20\n3,50,20\n")
    (seen,) = load_measurements(tmp_path / "photo.toml")
    assert seen.probes == ("a", "b", "c")
    np.testing.assert_allclose(
        seen.values, [[0, 0], [-0.25e-3, -1e-3], [-1.25e-3, -5.85e-3]], atol=1e-15
    )


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"20 mm", ', "", "lists 3 marks for 2 stations"),
        ('"0 mm"', '"10 mm"', 'no mark at the clamp face.*"0 mm"'),
        ('"0 mm"', '"tip"', "mix probes and distances"),
        ('unit = "mm"', 'unit = "px"', "X is in px.*a pixel"),
        ('unit = "mm"', 'unit = "mm"\naxes = { x = "XM" }', 'has no column "XM"'),
    ],
)
def test_slips_in_a_photograph_are_named(tmp_path, old, new, words):
    (tmp_path / "photo.toml").write_text(PHOTO.replace(old, new))
    (tmp_path / "Results.csv").write_text(RESULTS)
    with pytest.raises(MeasurementError, match=words):
        load_measurements(tmp_path / "photo.toml")
