"""Tests of instruments on the page: their files lie beside the design, and nowhere else."""

import lattice_families as families
import numpy as np
import own_loop
import pytest

from voxsoft.studio.documents.tables import is_test, measured_test
from voxsoft.studio.protocol import commands

TEST = """schema = "voxsoft-test/1"
rest = [0, "1 s"]
loaded = [["2 s", "3 s"], ["4 s", "5 s"]]
points = { file = "cam.csv" }
"""
CAMERA = "t_s,tip x_mm,tip z_mm\n0,0,1\n1,0,1\n2,1,-4\n3,1,-4\n4,2,-9\n5,2,-9\n"


@pytest.fixture
def folder(tmp_path):
    inside = tmp_path / "designs"
    inside.mkdir()
    (inside / "cam.csv").write_text(CAMERA)
    (tmp_path / "secret.csv").write_text(CAMERA)
    return inside


def test_a_test_beside_the_design_has_a_measurement_for_each_load(folder):
    event, found = measured_test("test.toml", TEST, folder)
    assert is_test("Test.TOML")
    assert (event.stations, event.problems, event.columns) == (2, [], [])
    assert event.points[0] == pytest.approx((1e-3, 0.0, -5e-3))
    # Rounding of one difference.
    values = np.concatenate([each.values for each in found])
    np.testing.assert_allclose(values, [[1e-3, -5e-3], [2e-3, -10e-3]], rtol=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("cam.csv", "../secret.csv", "names ../secret.csv, which is outside of the folder"),
        ("cam.csv", "none.csv", "no such file"),
        ("rest =", "rust =", "is not known here"),
        ("voxsoft-test/1", "voxsoft/1", "is no test"),
    ],
)
def test_a_test_that_cannot_be_used_says_why(folder, old, new, words):
    event, found = measured_test("test.toml", TEST.replace(old, new), folder)
    assert found == ()
    assert any(words in problem.what for problem in event.problems)


@pytest.mark.long
def test_a_calibration_takes_each_load_of_a_test(make_studio, folder):
    design = folder / "beam.toml"
    design.write_text(families.family_text("paper-beam"))
    studio = make_studio(design)

    async def scenario():
        async with studio.page() as page:
            await page.send("measurement", name="test.toml", text=TEST)
            return await page.until("measured")

    assert own_loop.run(scenario(), 60).stations == 2
    tables = studio.session._measured_tables(commands.MeasuredData(name="test.toml"))
    assert [table.name for table in tables] == ["test.toml, 1 of 2", "test.toml, 2 of 2"]
    assert tables[1].read().values[0].tolist() == pytest.approx([2e-3, -10e-3])
