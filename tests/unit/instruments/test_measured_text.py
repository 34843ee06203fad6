"""Logs, exports of machines, and points that a camera tracked, as text."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.errors import FileError, MeasurementError
from voxsoft.instruments import Column


def file_of(folder, text, name="log.csv"):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_a_pressure_log_has_units_times_and_gaps(tmp_path):
    text = (
        "Logger PX-7;channel 2\n\nTimestamp;p (mbar);Temp [°C];state\n"
        "2026-11-30 12:00:00,000;0,0;20,5;closed\n"
        "2026-11-30 12:00:00,250;---;20,5;open\n"
        "2026-11-30 12:00:00,500;1.000,5;;open\n"
        "2026-11-30 12:00:00,750;250,0;21,0;open\n"
    )
    found = vs.measured(file_of(tmp_path, text))
    assert found.names == ("p", "Temp")
    press, warmth = found.columns
    # Rounding of one product and one sum.
    np.testing.assert_allclose(press.values, [0.0, np.nan, 100050.0, 25000.0], rtol=1e-15)
    np.testing.assert_allclose(warmth.values, [293.65, 293.65, np.nan, 294.15], rtol=1e-15)
    assert (press.kind, warmth.kind, press.rate) == ("pressure", "temperature", 4.0)
    assert press.gaps == ((0.25, 0.25),)
    assert found.gaps.keys() == {"p", "Temp"}
    assert '"state" holds text, and is left out' in found.notes
    assert "Times count from 2026-11-30 12:00:00,000" in found.account


def test_columns_may_stand_apart_by_spaces(tmp_path):
    text = "Logger 7, channel 2\n  Time (s)   p [kPa]  T_degC\n 0.0   1.5  20\n 0.5  -2.5e1  21\n"
    found = vs.measured(file_of(tmp_path, text, "a.dat"))
    assert found.names == ("p", "T")
    assert found["p"].values.tolist() == [1500.0, -25000.0]
    assert found["p"].times.tolist() == [0.0, 0.5]


def test_an_export_of_a_machine_has_the_units_of_its_second_row(tmp_path):
    rows = "".join(f'"{i / 10}","{1000.5 * i:,.1f}","{i}"\n' for i in range(4))
    head = '"Specimen 1"\n"Time","Force","Stroke"\n"sec","N","mm"\n'
    found = vs.measured(file_of(tmp_path, head + rows, "a.txt"))
    np.testing.assert_allclose(found["force"].values, [0.0, 1000.5, 2001.0, 3001.5])
    np.testing.assert_allclose(found["Stroke"].values, 1e-3 * np.arange(4))
    assert found["Force"].rate == 10.0


def test_units_rates_and_times_can_be_given(tmp_path):
    path = file_of(tmp_path, "clock,load,tip_x\n0,1,2\n20,3,4\n40,5,6\n")
    found = vs.measured(path, units={"load": "kN", "clock": "ms"}, unit="cm", time="clock")
    assert found["load"].values.tolist() == [1000.0, 3000.0, 5000.0]
    assert found["tip x"].values.tolist() == [0.02, 0.04, 0.06]
    assert found["load"].rate == 50.0
    assert vs.measured(path, rate="5 Hz")["load"].times.tolist() == [0.0, 0.2, 0.4]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        ("0,1\n1,2\n", "line 1: names no columns"),
        ("time,p_kPa\n0,1\n1,2\n", "column time: has no unit"),
        ("time_kPa,p_kPa\n0,1\n1,2\n", '"kPa" is no unit of time'),
        ("time_s,t_s,p_kPa\n0,0,1\n1,1,2\n", '"time" and "t" are both times'),
        ("time_s,p_kPa\n0,1\n0,2\n", "row 2 is at 0 s, after 0 s"),
        ("time,p_kPa\nnoon,1\nlater,2\n", 'line 2, time: "noon" is no time'),
        ("time_s,p_kPa\n0,1\n,2\n", "line 3, time_s: is no time"),
        ("time_s,p [kPb]\n0,1\n1,2\n", 'there is no unit "kPb"'),
        ("time_s,state\n0,open\n1,shut\n", "holds no column of numbers"),
        ("time_s,p_kPa,p_kPa\n0,1,1\n1,2,2\n", '"p" comes twice'),
        ("time_s,p_kPa\n0,1,5\n1,2,5\n", "line 2: has 3 cells"),
    ],
)
def test_logs_that_cannot_be_read_say_why(tmp_path, text, words):
    with pytest.raises(MeasurementError, match=words):
        vs.measured(file_of(tmp_path, text))


def test_other_files_are_refused_with_a_way_out(tmp_path):
    with pytest.raises(FileError, match=r"\.zs2 is not read.*testXpert as text"):
        vs.measured(file_of(tmp_path, "x", "a.zs2"))
    with pytest.raises(FileError, match=r"\.xlsx is not read.*export it as CSV"):
        vs.measured(file_of(tmp_path, "x", "a.xlsx"))
    with pytest.raises(FileError, match="no such file"):
        vs.measured(tmp_path / "none.csv")


DEEPLABCUT = """scorer,net,net,net,net,net,net
bodyparts,tip,tip,tip,knee,knee,knee
coords,x,y,likelihood,x,y,likelihood
0,100,40,0.99,50,40,0.99
1,100,45,0.30,50,41,0.99
2,102,50,0.95,,,0.01
"""


def test_points_of_deeplabcut_are_gaps_where_they_are_unlikely(tmp_path):
    path = file_of(tmp_path, DEEPLABCUT)
    raw = vs.measured(path)
    assert raw.tracks == ("tip", "knee")
    assert raw["tip x"].kind == "pixels"
    with pytest.raises(MeasurementError, match=r'is in pixels.*pixel="0.2 mm"'):
        raw.track("tip")
    axes = {"x": "x", "z": "-y"}
    found = vs.measured(path, pixel="0.5 mm", rate=25, axes=axes)
    times, tip = found.track("tip")
    assert times.tolist() == [0.0, 0.04, 0.08]
    # A hidden frame is a gap in both; nobody saw the depth.
    np.testing.assert_allclose(tip[[0, 2]], [[0.05, np.nan, -0.02], [0.051, np.nan, -0.025]])
    assert np.isnan(tip[1]).all()
    assert "tip: 1 of 3 frames have a likelihood below 0.6, and are gaps" in found.notes
    assert "y points down" in found.account
    assert np.isfinite(vs.measured(path, likelihood=0.2)["tip x"].values).all()
    with pytest.raises(MeasurementError, match=r"has no times.*rate of the camera"):
        vs.measured(path, pixel="0.5 mm").track("tip")


def test_several_animals_of_deeplabcut_keep_their_names(tmp_path):
    text = "scorer,n,n\nindividuals,left,right\nbodyparts,tip,tip\ncoords,x,x\n0,1,2\n"
    assert vs.measured(file_of(tmp_path, text)).names == ("left tip x", "right tip x")


def test_trajectories_of_kinovea_are_read_in_both_its_forms(tmp_path):
    old = (
        "#Kinovea Trajectory data export\n#T X Y\n"
        "0:00:00:00 866.00 320.00 \n0:00:00:04 847.00 321.00 \n\n0:00:00:00 118.00 45.00 \n"
    )
    found = vs.measured(file_of(tmp_path, old, "old.txt"), unit="px", pixel="1 mm")
    assert found.tracks == ("point 1", "point 2")
    np.testing.assert_allclose(found["point 1 x"].values, [0.866, 0.847])
    np.testing.assert_allclose(found["point 1 x"].times, [0.0, 0.04])
    new = "#Kinovea Trajectory data export\n#T X Y\n\n# tip\n0 1,5 -2\n40 1,25 -2,5\n\n"
    path = file_of(tmp_path, new, "new.txt")
    found = vs.measured(path, units={"time": "ms"}, unit="cm")
    np.testing.assert_allclose(
        found.track("tip").positions[:, :2], [[0.015, -0.02], [0.0125, -0.025]]
    )
    with pytest.raises(MeasurementError, match="does not say the unit of its times"):
        vs.measured(path, unit="cm")
    with pytest.raises(MeasurementError, match=r"tip x has no unit.*unit=\"mm\""):
        vs.measured(path, rate=25).track("tip")


def test_a_column_is_found_by_its_end_and_in_any_case():
    times = [0.0, 1.0]
    data = vs.Measured(
        "t",
        (Column("A/Force", "N", [1, 2], times), Column("B/Force", "N", [3, 4], times)),
    )
    assert data["a/force"].values.tolist() == [1.0, 2.0]
    with pytest.raises(MeasurementError, match='"force" may be "A/Force" and "B/Force"'):
        data["force"]
    with pytest.raises(MeasurementError, match='no column "Fource"'):
        data["Fource"]


KVA = """<?xml version="1.0"?><KinoveaVideoAnalysis><Tracks>
<Track name="tip"><TrackPointList>
<TrackPoint UserX="1.50" UserY="-2.00" UserTime="0:00:00:00">10;20;0</TrackPoint>
<TrackPoint UserX="1.25" UserY="-2.50" UserTime="0:00:00:04">9;22;1</TrackPoint>
</TrackPointList></Track>
<Track><TrackPointList>
<TrackPoint UserX="3" UserY="4" UserTime="0:00:01:00">1;2;25</TrackPoint>
</TrackPointList></Track></Tracks></KinoveaVideoAnalysis>"""


def test_tracks_of_kinovea_s_own_file_are_read(tmp_path):
    found = vs.measured(file_of(tmp_path, KVA, "a.kva"), unit="cm")
    assert found.tracks == ("tip", "point 2")
    times, tip = found.track("tip")
    np.testing.assert_allclose(tip[:, :2], [[0.015, -0.02], [0.0125, -0.025]], rtol=1e-12)
    np.testing.assert_allclose(times, [0.0, 0.04])
    with pytest.raises(FileError, match=r"without coordinates.*Export to spreadsheet"):
        vs.measured(file_of(tmp_path, KVA.replace("UserX", "X"), "b.kva"))
    with pytest.raises(FileError, match="is no XML"):
        vs.measured(file_of(tmp_path, "tip 1 2", "c.kva"))
