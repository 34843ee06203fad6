"""Measurements: columns of a table, and messages about a bad one."""

from pathlib import Path

import lattice_families as families
import numpy as np
import pytest

from voxsoft.calibration import Experiment, Measurement, read_measurement
from voxsoft.errors import FileError, MeasurementError

EXAMPLES = Path(__file__).parents[3] / "examples" / "data" / "paper_beams"
GOOD = "# someone, 2026\narc_position_from_clamp_mm,x_mm,dz_mm\n30,28,-9\n60,50,-31\n90,68,-58\n"


@pytest.fixture(scope="module")
def beam():
    return families.beam()


def test_units_comments_and_spaces():
    seen = read_measurement(
        "# by me\n# CC0\n\narc_position_from_clamp_cm, x_mm , dz_m\n 3, 28, -0.009\n"
    )
    assert seen.quantities == ("x", "dz")
    assert seen.source == "by me CC0"
    np.testing.assert_allclose(seen.arcs, [0.03])
    np.testing.assert_allclose(seen.values, [[0.028, -0.009]])


@pytest.mark.parametrize("separator", [";", "\t"])
def test_spreadsheets_with_decimal_commas_read_as_those_with_points(separator):
    text = "\ufeff ,probe,dz_mm,note\n1,tip,-12.5,1:2\n2,knee,-3e-1,\n"
    seen = read_measurement(text.replace(",", separator).replace(".", ","))
    expected = read_measurement(text)
    assert seen.probes == expected.probes == ("tip", "knee")
    np.testing.assert_array_equal(seen.values, expected.values)
    np.testing.assert_array_equal(seen.values[:, 0], [-0.0125, -0.0003])


def test_paper_beams_read_as_they_are():
    tips = {"00-20": 0.085266843, "00-30": 0.07699792, "00-50": 0.057872995}
    for name, sag in tips.items():
        seen = Measurement.read(EXAMPLES / f"ecoflex-{name}.csv")
        assert len(seen) == 9
        assert seen.name == f"Ecoflex {name}"
        assert "github.com/ismailHacks/VoxSoft" in seen.source
        assert -seen.values[:, 1].min() == sag


def test_one_of_several_materials():
    header = "material,probe,dz_mm\n"
    table = header + "A,tip,-1\nB,tip,-2\n"
    assert read_measurement(table, select="b").values[0, 0] == -0.002
    with pytest.raises(MeasurementError, match=r'several materials: "A", "B"'):
        read_measurement(table)
    with pytest.raises(MeasurementError, match=r'no material "C".*holds "A", "B"'):
        read_measurement(table, select="C")
    with pytest.raises(MeasurementError, match=r'no column "material"'):
        read_measurement(GOOD, select="A")


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("", "holds no table"),
        ("# only a comment\n", "holds no table"),
        ("probe,dz_mm\n", "header and no rows"),
        ("probe,dz_mm\ntip,nan\n", r"line 2, dz_mm: nan is not a finite number"),
        ("probe,dz_mm\ntip,inf\n", "inf is not a finite number"),
        ("probe,dz_mm\ntip,\n", r"line 2, dz_mm: the cell is empty"),
        ("probe,dz_mm\ntip,-3 mm\n", r'"-3 mm" is not a number'),
        ("probe,dz_mm\na,-1\nb\n", r"line 3: has 1 cells.*may have been cut off"),
        ("probe,dz_mm\na,-1,5\nb,-2\n", r"line 2: has 3 cells.*decimal points"),
        ("probe;dz_mm\na;-1,5,2\n", '"-1,5,2" is not a number'),
        (" ,X,Y\n1,12.5,40.1\n", r"X and Y are places in a picture.*picture's Y points down"),
        ("probe,dz\ntip,-1\n", r'has no unit. Try: write "dz_mm"'),
        ("probe,dz_kPa\ntip,-1\n", r'"kPa" is not a unit of length'),
        ("probe,sag_mm\ntip,-1\n", r"column sag_mm: is not known"),
        ("probe,dzz_mm\ntip,-1\n", r"dzz_mm: is not known"),
        ("probe,note\ntip,fine\n", "no measured quantity"),
        ("dz_mm\n-1\n", r"no column for the station. Try: columns are probe or"),
        ("probe,arc_position_from_clamp_mm,dz_mm\na,1,-1\n", "both probe and arc"),
        ("probe,dz_mm,dz_m\na,1,1\n", '"dz" comes twice'),
        ("probe,z_mm,dz_mm\na,1,1\n", "z is measured twice"),
        ("probe,dz_mm\na,1\na,1\n", r"a: comes twice. Try: average"),
        (GOOD + "60,50,-31\n", r"arc 60 mm: comes twice"),
        ("arc_position_from_clamp_mm,dz_mm\n-10,1\n", "not a positive length"),
        ("probe,dz_mm\n\0\1\n", "not a text file"),
    ],
)
def test_bad_tables(table, message):
    with pytest.raises(MeasurementError, match=message) as caught:
        read_measurement(table, name="t.csv")
    assert str(caught.value).startswith("t.csv")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("_mm", "_m", r"are the numbers in mm\?"),
        ("_mm", "_cm", r"beyond the body.*numbers in mm under _cm"),
        ("arc_position_from_clamp_mm", "arc_position_from_clamp_m", "beyond the body, which is fr"),
        ("x_mm,dz_mm", "x_m,dz_m", "too far for a body of 101 mm. Try: are the numbers in mm"),
        ("90,68", "190,68", "station arc 190 mm: lies beyond the body, which is free for 90 mm"),
    ],
)
def test_numbers_that_do_not_fit_the_body(beam, old, new, message):
    with pytest.raises(MeasurementError, match=message):
        Experiment(beam, read_measurement(GOOD.replace(old, new)))


def test_numbers_too_small_for_the_body(beam):
    in_meters = "arc_position_from_clamp_mm,x_mm,dz_mm\n0.03,0.028,-0.009\n0.09,0.068,-0.058\n"
    with pytest.raises(MeasurementError, match="in m under _mm"):
        Experiment(beam, read_measurement(in_meters))
    shape_in_meters = "arc_position_from_clamp_mm,x_mm,dz_mm\n30,0.028,-0.009\n90,0.068,-0.058\n"
    with pytest.raises(MeasurementError, match="in m under _mm"):
        Experiment(beam, read_measurement(shape_in_meters))


def test_unknown_probe_names_the_known_ones(beam):
    with pytest.raises(MeasurementError, match=r'probe station-10: .*did you mean "station-1"'):
        Experiment(beam, read_measurement("probe,dz_mm\nstation-10,-5\n"))


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(FileError, match="no such file"):
        Measurement.read(tmp_path / "missing.csv")
    binary = tmp_path / "photo.csv"
    binary.write_bytes(b"\x89PNG\xff\xfe")
    with pytest.raises(MeasurementError, match="not text in UTF-8"):
        Measurement.read(binary)


def test_values_of_python_are_checked_too():
    with pytest.raises(MeasurementError, match="arc 90 mm: dz is nan"):
        Measurement(quantities=["dz"], values=[[np.nan]], arcs=[0.09])
    with pytest.raises(MeasurementError, match=r"shape \(1, 1\); expected 2 rows"):
        Measurement(quantities=["dz"], values=[[1.0]], arcs=[0.05, 0.09])
    with pytest.raises(MeasurementError, match="either arc positions or probes"):
        Measurement(quantities=["dz"], values=[[1.0]])
    with pytest.raises(MeasurementError, match='"sag" is not a quantity'):
        Measurement(quantities=["sag"], values=[[1.0]], arcs=[0.05])


@pytest.mark.parametrize(
    ("line", "height"), [("lower-edge", 0.0), ("centerline", 5e-3), ("upper-edge", 10e-3)]
)
def test_stations_lie_on_the_line(beam, line, height):
    experiment = Experiment(beam, read_measurement(GOOD), line=line)
    expected = [[0.04, 0.005, height], [0.07, 0.005, height], [0.1, 0.005, height]]
    np.testing.assert_allclose(experiment.points, expected, atol=1e-12)
    # Undeformed, x is the arc itself and dz is zero.
    expected = [[0.03, 0.0], [0.06, 0.0], [0.09, 0.0]]
    np.testing.assert_allclose(experiment.offsets, expected, atol=1e-12)


def test_clamp_at_the_other_end():
    document = families.beam().document
    document["clamps"][0]["region"] = {"x": ["= length - clamped", "= length"]}
    design = type(families.beam()).from_document(document)
    line = Experiment(
        design,
        read_measurement(
            GOOD.replace("x_mm,", "").replace(",28", "").replace(",50", "").replace(",68", "")
        ),
    ).station_line
    assert (line.axis, line.direction) == (0, -1)
    assert line.face == pytest.approx(0.09)
    np.testing.assert_allclose(line.points(np.array([0.09])), [[0.0, 0.005, 0.0]], atol=1e-12)


def test_sag_is_along_gravity(beam):
    assert Experiment(beam, read_measurement(GOOD)).sag == pytest.approx(0.058)


@pytest.mark.parametrize(
    "text",
    [
        "Camera 2;strip 7\n\nprobe;x [mm];dz [mm]\ntip;1.250,5;-12,5\n",
        "probe;x;dz\n;mm;mm\ntip;1250,5;-12,5\n",
        'probe,x (mm),dz / cm\ntip,"1,250.5",-1.25\n',
        "Probe\tX (mm)\tdZ in m\ntip\t1 250.5\t-0.0125\n",
        "probe,x_m,dz_inch,\ntip,1.2505,-0.49212598425196846,\n",
    ],
)
def test_tables_of_spreadsheets_and_machines_read_alike(text):
    seen = read_measurement(text)
    assert (seen.probes, seen.quantities) == (("tip",), ("x", "dz"))
    # Rounding of one product.
    np.testing.assert_allclose(seen.values, [[1.2505, -0.0125]], rtol=1e-15)


def test_a_table_in_the_coding_of_a_machine_is_read(tmp_path):
    path = tmp_path / "maß.csv"
    text = "# Prüfung für Ä\nprobe;dz_mm\ntip;-12,5\n"
    for coding in ("cp1252", "utf-8-sig", "utf-16"):
        path.write_bytes(text.encode(coding))
        seen = Measurement.read(path)
        assert (seen.source, float(seen.values[0, 0])) == ("Prüfung für Ä", -0.0125)


def test_a_table_says_the_line_of_its_marks(beam):
    table = f"# Line: upper edge\n{GOOD}"
    seen = read_measurement(table)
    assert (seen.line, seen.source) == ("upper-edge", "someone, 2026")
    experiment = Experiment(beam, seen)
    assert experiment.line == "upper-edge"
    assert not experiment.caution
    assert Experiment(beam, seen, line="centerline").line == "centerline"
    with pytest.raises(MeasurementError, match=r'"middle".*name one of lower-edge, centerline'):
        read_measurement(f"# line: middle\n{GOOD}")
    with pytest.raises(MeasurementError, match='"centerline" and "upper-edge"'):
        read_measurement(f"{table}# line: centerline\n")


def test_a_line_that_nobody_named_is_warned_about(beam):
    experiment = Experiment(beam, read_measurement(GOOD, name="strip.csv"))
    assert experiment.line == "lower-edge"
    assert experiment.caution.startswith("strip.csv: arc positions are taken for marks on the low")
    probes = Measurement(quantities=["dz"], values=[[-0.01]], probes=["station-9"])
    assert not Experiment(beam, probes).caution
