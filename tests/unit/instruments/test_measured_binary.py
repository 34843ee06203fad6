"""Files of LabVIEW, motion capture and MATLAB: scales, rates, hidden markers, whole numbers."""

import sys

import numpy as np
import pytest
from scipy.io import savemat

import voxsoft as vs
from voxsoft.errors import FileError, MeasurementError, MissingPackageError


def linear(slope, start):
    """Properties of a scale of DAQmx, from counts to a unit."""
    return {
        "NI_Number_Of_Scales": 1,
        "NI_Scaling_Status": "unscaled",
        "NI_Scale[0]_Scale_Type": "Linear",
        "NI_Scale[0]_Linear_Slope": slope,
        "NI_Scale[0]_Linear_Y_Intercept": start,
        "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF,
    }


def waveform(start, increment, unit):
    return {
        "wf_start_time": np.datetime64(start),
        "wf_increment": increment,
        "wf_start_offset": 0.0,
        "unit_string": unit,
    }


def write_tdms(path, channels):
    nptdms = pytest.importorskip("nptdms")
    with nptdms.TdmsWriter(path) as file:
        file.write_segment(
            [nptdms.ChannelObject(group, name, v, properties=p) for group, name, v, p in channels]
        )
    return path


def test_channels_of_tdms_are_scaled_and_start_when_they_did(tmp_path):
    counts = np.arange(0, 500, 50, dtype=np.int16)
    path = write_tdms(
        tmp_path / "a.tdms",
        [
            (
                "Fast",
                "p",
                counts,
                waveform("2026-11-30T10:00:00.250", 1e-3, "kPa") | linear(0.5, 1.0),
            ),
            ("Slow", "T", np.arange(3.0), waveform("2026-11-30T10:00:00", 0.1, "degC")),
        ],
    )
    found = vs.measured(path)
    assert found.names == ("Fast/p", "Slow/T")
    # 0.5 kPa for each count, from 1 kPa on, and not the counts.
    np.testing.assert_allclose(found["p"].values, 1e3 * (0.5 * counts + 1.0), rtol=1e-15)
    # The two began a quarter of a second apart: both from 0 would shift them.
    np.testing.assert_allclose(found["p"].times, 0.25 + 1e-3 * np.arange(10), atol=1e-12)
    np.testing.assert_allclose(found["T"].times, 0.1 * np.arange(3), atol=1e-12)
    assert (found["p"].rate, found["T"].rate) == (1000.0, 10.0)
    assert "Fast/p: scaled as the file says" in found.notes
    assert "Times count from 2026-11-30T10:00:00.000000 UTC" in found.account


def test_a_group_of_tdms_may_have_its_times_in_a_channel(tmp_path):
    channels = [
        ("A", "Time", np.array([0.0, 0.5, 1.0]), {"unit_string": "s"}),
        ("A", "Force", np.array([1.0, 2.0, 3.0]), {"NI_UnitDescription": "N"}),
        ("B", "state", ["x", "y"], {}),
    ]
    found = vs.measured(write_tdms(tmp_path / "a.tdms", channels))
    assert found.names == ("A/Force",)
    assert found["Force"].times.tolist() == [0.0, 0.5, 1.0]
    assert "B/state holds no numbers, and is left out" in found.notes
    bare = [("A", "Time", np.array([0.0, 1.0]), {}), ("A", "Force", np.ones(2), {})]
    path = write_tdms(tmp_path / "b.tdms", bare)
    with pytest.raises(MeasurementError, match='channel "Time": is a time without a unit'):
        vs.measured(path)
    assert vs.measured(path, units={"Time": "ms"})["Force"].times.tolist() == [0.0, 1e-3]


def test_a_tdms_file_that_ends_early_says_so(tmp_path):
    nptdms = pytest.importorskip("nptdms")
    clock = waveform("2026-11-30T10:00:00", 0.1, "N")
    path = tmp_path / "a.tdms"
    with nptdms.TdmsWriter(path) as file:
        for part in range(3):
            values = np.arange(100.0) + 100 * part
            file.write_segment([nptdms.ChannelObject("A", "F", values, properties=clock)])
    whole = path.read_bytes()
    assert not any("short" in note for note in vs.measured(path).notes)
    path.write_bytes(whole[:-400])
    found = vs.measured(path)
    assert "The file is cut short in its last segment: rows up to there are read" in found.notes
    # 400 bytes are 50 rows.
    np.testing.assert_array_equal(found["F"].values, np.arange(250.0))
    last = whole.rindex(b"TDSm")
    path.write_bytes(whole[: last + 12] + b"\xff" * 8 + whole[last + 20 : -400])
    assert any("writer was stopped" in note for note in vs.measured(path).notes)


def write_c3d(path, points, *, labels, unit="mm", rate=100.0, residuals=None, analogs=None):
    """Write markers, (3, n, frames), and volts of one channel at ten times the rate."""
    ezc3d = pytest.importorskip("ezc3d")
    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [rate]
    file["parameters"]["POINT"]["LABELS"]["value"] = list(labels)
    file["parameters"]["POINT"]["UNITS"]["value"] = [unit]
    file["data"]["points"] = np.concatenate([points, np.ones((1, *points.shape[1:]))])
    if residuals is not None:
        file["data"]["meta_points"]["residuals"] = residuals
    if analogs is not None:
        file["parameters"]["ANALOG"]["RATE"]["value"] = [10.0 * rate]
        file["parameters"]["ANALOG"]["LABELS"]["value"] = ["valve"]
        file["parameters"]["ANALOG"]["UNITS"]["value"] = ["V"]
        file["data"]["analogs"] = analogs[None, None, :]
    file.write(str(path))
    return path


def test_markers_of_c3d_have_their_unit_and_hidden_ones_are_gaps(tmp_path):
    frames = np.arange(20)
    points = np.zeros((3, 3, 20))
    points[0] = 1.0 + frames
    points[1] = [[10.0], [20.0], [30.0]]
    points[:, 1, 5:8] = np.nan
    points[:, 2, 3] = 0.0
    volts = np.sin(np.arange(200))
    path = write_c3d(
        tmp_path / "a.c3d", points, labels=("tip", "knee", "toe"), unit="cm", analogs=volts
    )
    found = vs.measured(path)
    assert found.tracks == ("tip", "knee", "toe")
    times, tip = found.track("tip")
    # The file holds 32-bit floats.
    np.testing.assert_allclose(tip[:, 0], 0.01 * (1.0 + frames), rtol=1e-6)
    np.testing.assert_allclose(times, frames / 100, atol=1e-9)
    assert np.flatnonzero(np.isnan(found["knee x"].values)).tolist() == [5, 6, 7]
    assert np.flatnonzero(np.isnan(found["toe y"].values)).tolist() == [3]
    assert any("toe: 1 frames are at exactly 0, 0, 0" in note for note in found.notes)
    np.testing.assert_allclose(found["valve"].values, volts, atol=1e-6)
    assert (found["valve"].rate, found["valve"].kind) == (1000.0, "voltage")


def test_a_negative_residual_hides_a_marker(tmp_path):
    points = np.ones((3, 2, 10))
    residuals = np.zeros((1, 2, 10))
    residuals[0, 1, 2:4] = -1.0
    path = write_c3d(tmp_path / "a.c3d", points, labels=("a", "b"), residuals=residuals)
    found = vs.measured(path)
    assert np.flatnonzero(np.isnan(found["b z"].values)).tolist() == [2, 3]
    assert not found["a z"].gaps


def test_markers_without_a_unit_are_asked_for_it(tmp_path):
    path = write_c3d(tmp_path / "a.c3d", np.ones((3, 1, 4)), labels=("tip",), unit="")
    with pytest.raises(MeasurementError, match="tip x has no unit"):
        vs.measured(path).track("tip")
    assert vs.measured(path, unit="mm").track("tip").positions[0].tolist() == [1e-3] * 3
    turned = vs.measured(path, unit="mm", axes={"x": "y", "y": "-x", "z": "z"})
    assert turned.track("tip").positions[0].tolist() == [1e-3, -1e-3, 1e-3]


@pytest.mark.long
def test_more_frames_than_c3d_counts_are_refused_and_not_cut(tmp_path):
    points = np.ones((3, 1, 70_000))
    path = write_c3d(tmp_path / "long.c3d", points, labels=("tip",))
    with pytest.raises(FileError, match=r"counts 65,535 frames.*holds about 70,0"):
        vs.measured(path)
    most = write_c3d(tmp_path / "most.c3d", points[:, :, :65_535], labels=("tip",))
    assert len(vs.measured(most)["tip x"].values) == 65_535


@pytest.mark.parametrize("missing", [1, 16, 4000])
def test_a_c3d_file_that_ends_within_its_frames_is_refused(tmp_path, missing):
    """Its reader returns the frames before the end, without a word."""
    path = write_c3d(tmp_path / "a.c3d", np.ones((3, 1, 500)), labels=("tip",))
    whole = path.read_bytes()
    # Frames of 16 bytes from the block that word 9 names.
    end = (whole[16] - 1) * 512 + 500 * 16
    path.write_bytes(whole[: end - missing])
    with pytest.raises(FileError, match="500 frames end at"):
        vs.measured(path)
    path.write_bytes(whole[:end])
    assert len(vs.measured(path)["tip x"].values) == 500


def test_a_file_that_is_no_c3d_is_refused(tmp_path):
    pytest.importorskip("ezc3d")
    path = tmp_path / "a.c3d"
    path.write_text("time,tip\n0,1\n")
    with pytest.raises(FileError, match="begins otherwise"):
        vs.measured(path)


def test_whole_numbers_of_matlab_are_floats_and_rows_are_columns(tmp_path):
    path = tmp_path / "a.mat"
    # MATLAB writes doubles that are whole in eight bits; their sum would wrap.
    savemat(
        path,
        {
            "time_ms": np.array([[0, 100, 200]], np.uint8),
            "force_N": np.array([[100], [200], [250]], np.uint8),
            "tip": np.array([[1, 2, 3], [4, 5, 6]], np.uint8),
            "empty": np.zeros((0, 0)),
            "test": {"p_kPa": np.array([1.5, 2.5, 3.5]), "name": "strip"},
            "gain": 2.0,
        },
    )
    found = vs.measured(path)
    assert found.names == ("force", "tip 1", "tip 2", "test/p")
    force = found["force"]
    assert (force.values + force.values).tolist() == [200.0, 400.0, 500.0]
    np.testing.assert_allclose(force.times, [0.0, 0.1, 0.2])
    assert found["tip 2"].values.tolist() == [4.0, 5.0, 6.0]
    assert found["p"].values.tolist() == [1500.0, 2500.0, 3500.0]
    assert "empty is empty, and is left out" in found.notes
    assert "tip: its rows are taken for columns, (2, 3)" in found.notes
    assert "gain = 2 is one number, and no column" in found.notes
    assert "test/name holds no numbers, and is left out" in found.notes


def test_matlab_of_version_7_3_is_refused_with_a_way_out(tmp_path):
    path = tmp_path / "a.mat"
    path.write_bytes(b"MATLAB 7.3 MAT-file" + bytes(600))
    with pytest.raises(FileError, match=r"version 7\.3, which is HDF5.*'-v7'"):
        vs.measured(path)


@pytest.mark.parametrize("suffix", [".tdms", ".c3d", ".mat"])
def test_damaged_files_are_named(suffix, tmp_path):
    library = {".tdms": "nptdms", ".c3d": "ezc3d", ".mat": "scipy"}[suffix]
    pytest.importorskip(library)
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"nothing of the kind" * 40)
    with pytest.raises(FileError, match=f"a{suffix}: cannot be read as {suffix[1:].upper()}"):
        vs.measured(path)


@pytest.mark.parametrize(("suffix", "library"), [(".tdms", "nptdms"), (".c3d", "ezc3d")])
def test_a_missing_library_is_named_with_its_extra(suffix, library, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, library, None)
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"")
    with pytest.raises(MissingPackageError, match=r"pip install 'voxsoft\[measured\]'"):
        vs.measured(path)
