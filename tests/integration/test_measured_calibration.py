"""A calibration from the TDMS and the C3D of one test, made from a known answer."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.files import load_measurements

YOUNG = 120e3
#: Forces of the three holds in N, and the second of the cell's clock at which each begins.
HOLDS = {0.05: 2.0, 0.1: 4.0, 0.15: 6.0}
#: Time of the camera's clock when that of the cell begins, in s.
LATE = 1.37

STRIP = """schema = "voxsoft/1"
name = "strip"
voxel_size = "5 mm"

[parameters]
pull = { value = "0.1 N", description = "force at the tip" }

[shapes]
body = { kind = "box", size = ["80 mm", "10 mm", "10 mm"] }

[materials]
rubber = { model = "neo-hookean", young = "%g Pa", poisson = 0.49 }

[[parts]]
shape = "body"
material = "rubber"

[[clamps]]
region = { x = [0, 0] }

[[loads]]
kind = "force"
region = { x = ["80 mm", "80 mm"] }
value = [0, 0, "= -pull"]

[probes]
middle = { point = ["40 mm", "5 mm", "5 mm"] }
tip = { point = ["80 mm", "5 mm", "5 mm"] }
"""

TEST = """schema = "voxsoft-test/1"
source = "made for a test, CC0"
# On the camera's clock: 1.37 s later than that of the cell.
rest = ["0 s", "3 s"]
loaded = [["3.9 s", "4.9 s"], ["5.9 s", "6.9 s"], ["7.9 s", "8.9 s"]]

[channels]
file = "cell.tdms"

[points]
file = "camera.c3d"
axes = { x = "x", y = "-z", z = "y" }
stations = { M1 = "middle", M2 = "tip" }
counted = ["x", "z"]

[synchronize]
by = "trigger"

[set]
pull = "force"
"""


def course(times, levels):
    """Levels of each hold over the cell's clock, with ramps of 0.2 s between them."""
    knots, values = [0.0], [levels[0] * 0.0]
    for begin, level in zip(HOLDS.values(), levels, strict=True):
        knots += [begin, begin + 0.2]
        values += [values[-1], level]
    return np.stack(
        [np.interp(times, knots, [np.ravel(v)[k] for v in values]) for k in range(values[0].size)]
    )


def trigger(times):
    """A lamp that both instruments record: pulses at seconds without a period."""
    return 5.0 * sum((np.abs(times - at) < 0.05).astype(float) for at in (0.6, 1.1, 3.7, 5.9))


def write_tdms(path, seed):
    """The cell at 2 kHz: counts of 0.1 mN with an offset in its scale, and noise of 2 mN."""
    nptdms = pytest.importorskip("nptdms")
    times = np.arange(0.0, 8.0, 1 / 2000)
    force = course(times, [np.array([level]) for level in HOLDS])[0]
    noisy = force + 2e-3 * np.random.default_rng(seed).standard_normal(len(times))
    clock = {
        "wf_start_time": np.datetime64("2026-11-30T10:00:00"),
        "wf_increment": 1 / 2000,
        "wf_start_offset": 0.0,
    }
    scale = {
        "NI_Number_Of_Scales": 1,
        "NI_Scaling_Status": "unscaled",
        "NI_Scale[0]_Scale_Type": "Linear",
        "NI_Scale[0]_Linear_Slope": 1e-4,
        "NI_Scale[0]_Linear_Y_Intercept": -0.3,
        "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF,
    }
    counts = np.round((noisy + 0.3) / 1e-4).astype(np.int16)
    channels = [
        nptdms.ChannelObject("Cell", "force", counts, {**clock, **scale, "unit_string": "N"}),
        nptdms.ChannelObject("Cell", "trigger", trigger(times), {**clock, "unit_string": "V"}),
    ]
    with nptdms.TdmsWriter(path) as file:
        file.write_segment(channels)


def write_c3d(path, moved, seed):
    """Two markers at 100 Hz in the laboratory's axes, y up, with 0.05 mm of noise and hidden."""
    ezc3d = pytest.importorskip("ezc3d")
    random = np.random.default_rng(seed)
    times = np.arange(0.0, 10.0, 0.01) - LATE
    rest = np.array([[0.04, 0.005, 0.005], [0.08, 0.005, 0.005]])
    seen = course(times, [level.ravel() for level in moved]).reshape(2, 3, -1)
    x, y, z = (rest[:, :, None] + seen).transpose(1, 0, 2)
    # Axes of the laboratory, and its zero.
    points = 1e3 * np.stack([x + 0.3, z + 0.9, -y + 0.05])
    points += 0.05 * random.standard_normal(points.shape)
    points[:, random.random(points.shape[1:]) < 0.1] = np.nan
    points[:, 1, 450:520] = np.nan
    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [100.0]
    file["parameters"]["POINT"]["LABELS"]["value"] = ["M1", "M2"]
    file["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    file["parameters"]["ANALOG"]["RATE"]["value"] = [1000.0]
    file["parameters"]["ANALOG"]["LABELS"]["value"] = ["trigger"]
    file["parameters"]["ANALOG"]["UNITS"]["value"] = ["V"]
    file["data"]["points"] = np.concatenate([points, np.ones((1, *points.shape[1:]))])
    volts = trigger(np.arange(0.0, 10.0, 1e-3) - LATE)
    file["data"]["analogs"] = volts[None, None, :]
    file.write(str(path))


@pytest.fixture(scope="module")
def moved():
    """Displacements of the middle and the tip in m under each force, of the true modulus."""
    design = vs.Design.from_document(vs.files.designs.read_document(STRIP % YOUNG, "strip.toml"))
    found = []
    for force in HOLDS:
        result = vs.simulate(design.with_values(pull=force))
        assert result.status == "ok"
        found.append(np.stack([result.probes["middle"], result.probes["tip"]]))
    return found


@pytest.fixture
def folder(moved, tmp_path, request):
    seed = getattr(request, "param", 1)
    write_tdms(tmp_path / "cell.tdms", seed)
    write_c3d(tmp_path / "camera.c3d", moved, seed + 1)
    (tmp_path / "strip.toml").write_text(STRIP % 400e3)
    (tmp_path / "test.toml").write_text(TEST)
    return tmp_path


def test_a_test_of_two_instruments_gives_the_displacements_under_each_force(folder, moved):
    for measurement, force, true in zip(
        load_measurements(folder / "test.toml"), HOLDS, moved, strict=True
    ):
        assert measurement.probes == ("middle", "tip")
        assert measurement.quantities == ("dx", "dz")
        # The mean of some 50 frames with 0.05 mm of noise, less such a mean: five of its errors.
        np.testing.assert_allclose(
            measurement.values, true[:, [0, 2]], atol=5 * 0.05e-3 * np.sqrt(2 / 30)
        )
        (change,) = measurement.changes
        key, _, value = change.partition("=")
        assert key == "pull"
        # Means of 2000 rows with 2 mN of noise.
        assert vs.units.parse(value, "force") == pytest.approx(force, abs=5 * 2e-3 / np.sqrt(2000))


# Noise of seed 20 puts the forces off alike: an interval of twelve independent numbers leaves the
# truth out, as it does for 8 of 18 seeds; the one of the calibration leaves it out for 1 of 20.
@pytest.mark.long
@pytest.mark.parametrize("folder", [1, 20], indirect=True)
def test_the_modulus_comes_back_within_its_interval(folder):
    design, test, out = (str(folder / name) for name in ("strip.toml", "test.toml", "fit"))
    called = ["calibrate", design, test, "--method", "gradient", "--out", out, "--json"]
    outcome = CliRunner().invoke(app, called)
    assert outcome.exit_code == 0, outcome.output
    found = json.loads(outcome.stdout)
    interval = found["intervals"]["young"]
    assert interval["low"] <= YOUNG <= interval["high"]
    # An interval that holds everything would hold the truth as well.
    assert interval["high"] - interval["low"] < 0.05 * YOUNG
    assert len(found["experiments"]) == 3
    assert Path(out, "test.toml").is_file()
