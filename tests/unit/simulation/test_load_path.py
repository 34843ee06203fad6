"""Paths of equilibria: over a load, a motion, a parameter, and the time of histories."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.comparison import path_error_bars
from voxsoft.design.contact import Contact
from voxsoft.errors import DesignError, SimulationError
from voxsoft.jobs import RunSpec, run_job
from voxsoft.jobs.events import Progress
from voxsoft.simulation import Over
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.45, density=1070.0)


def beam(**changes):
    """A strip that its weight and a force at its end bend."""
    design = vs.Design(
        name="beam",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=vs.Box(size=("40 mm", "10 mm", "10 mm")), material=RUBBER)],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[
            vs.Gravity(),
            vs.Force(region=vs.Region(x=("40 mm", "40 mm")), value=(0, 0, "-10 mN")),
        ],
        probes={"tip": vs.Probe(x=("40 mm", "40 mm"))},
    )
    return design.replace(**changes)


def rubbed(friction):
    """A block that is pressed on a floor, and then pushed along it by its top."""
    top = vs.Region(z=("10 mm", "10 mm"))
    down, along = vs.Motion(displacement=(0, 0, -0.5 * mm)), vs.Motion(displacement=(2 * mm, 0, 0))
    return vs.Design(
        name="block",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=vs.Box(size=("10 mm", "10 mm", "10 mm")), material=RUBBER)],
        clamps=[
            vs.Clamp(region=top, axes="xy", motion=along),
            vs.Clamp(region=top, axes="z", motion=down),
        ],
        floor=vs.Floor(z=0.0),
        contact=Contact(friction=friction),
        probes={"foot": vs.Probe(z=(0, 0))},
        solver={"method": "statics"},
    )


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("loads[0].value=0..30 kPa/4", (0, 10e3, 20e3, 30e3)),
        ("loads[0].value = 0 .. 9.81 m/s^2 / 2", (0, 9.81)),
        ("time=0..1..0 s/5", (0, 0.5, 1, 0.5, 0)),
        ("factor=-1..1/3", (-1, 0, 1)),
        # The way is 0.6 + 4.5 mm long, and its parts of 1.7 mm do not end at the turn.
        ("a.b=1e-1..-.5e0..4.0 mm/4", (0.1e-3, 0.6e-3, 2.3e-3, 4e-3)),
    ],
)
def test_ranges_are_read(text, values):
    over = Over.read(text)
    assert over.values == pytest.approx(values, abs=1e-12)


@pytest.mark.parametrize(
    "text",
    [
        "loads[0].value",
        "loads[0].value=3 kPa",
        "x=0..1 kPa",
        "x=0..1 kPa/1",
        "=0..1/2",
        "x=1..1/5",
        "time=0..1 mm/3",
        "x=0..1 nonsense/3",
    ],
)
def test_ranges_that_are_none_are_refused(text):
    with pytest.raises((SimulationError, DesignError, vs.VoxSoftError)) as caught:
        Over.read(text)
    assert "Try:" in str(caught.value)


def test_a_path_ends_where_the_load_alone_ends():
    path = vs.follow(beam(), "loads[1].value[2]=0..-20 mN/5")
    assert path.status == "ok"
    for number in (0, 2, 4):
        alone = vs.simulate(beam().with_values(f"loads[1].value[2]={-5 * number} mN"))
        # Newton's method ends at 1e-8 of the load.
        assert path.results[number].probes["tip"] == pytest.approx(alone.probes["tip"], rel=1e-6)
    assert path.results[2].design.loads[1].value == (0.0, 0.0, pytest.approx(-0.01))
    assert path.results[2].load == pytest.approx(
        vs.simulate(beam()).load, rel=1e-9
    )  # gravity is there from the start


def test_a_parameter_that_only_loads_use_varies_them_all(tmp_path):
    file = tmp_path / "beam.toml"
    text = (
        beam()
        .to_toml()
        .replace('"9.81 m/s^2"', '"= pull"')
        .replace('"-10 mN"', '"= -pull*1e-3 kg"')
    )
    file.write_text(f'{text}\n[parameters]\npull = "9.81 m/s^2"\n')
    design = vs.load(file)
    path = vs.follow(design, "pull=0..9.81 m/s^2/3")
    alone = vs.simulate(design.with_values(pull="9.81 m/s^2"))
    assert path.results[-1].probes["tip"] == pytest.approx(alone.probes["tip"], rel=1e-6)
    assert np.abs(path.results[0].probes["tip"]).max() < 1e-12


def test_a_path_over_time_has_the_loads_of_each_instant():
    ramp = vs.History(time=("0 s", "1 s", "3 s"), factor=(0, 1, 0.5))
    gravity, force = beam().loads
    timed = beam(loads=[gravity, force.replace(history=ramp)])
    path = vs.follow(timed, "time=0..4 s/5")
    for instant, result in zip(path.values, path.results, strict=True):
        still = force.replace(value=tuple(ramp.at(instant) * v for v in force.value))
        alone = vs.simulate(beam(loads=[gravity, still]))
        assert result.probes["tip"] == pytest.approx(alone.probes["tip"], rel=1e-6, abs=1e-12)


def test_friction_makes_a_loop_and_none_makes_no_loop():
    over = "clamps[0].motion.displacement[0]=0..2..-2 mm/13"
    shares = {}
    for friction in (0.0, 0.4):
        path = vs.follow(rubbed(friction), over)
        assert path.status == "ok", path.message
        touches = [result.contacts[0] for result in path.results]
        shares[friction] = np.array([-touch.friction[0] / touch.pressure for touch in touches])
    assert np.abs(shares[0.0]).max() < 1e-3  # residual of Newton's method
    # A sliding body carries friction times pressure, one way and the other.
    assert shares[0.4][4] == pytest.approx(0.4, rel=0.01)
    assert shares[0.4][-1] == pytest.approx(-0.4, rel=0.01)
    # The body, first without friction, is held back on the way back: a loop.
    assert path.values[8] == pytest.approx(0.0, abs=1e-12)
    assert shares[0.4][0] == pytest.approx(0.0, abs=1e-3)
    assert shares[0.4][8] < -0.3


def test_a_symmetric_body_follows_its_path_as_a_part():
    ball = vs.Design(
        name="ball",
        voxel_size=2.5 * mm,
        parts=[
            vs.Part(
                shape=vs.Box(size=("20 mm",) * 3, corner=("-10 mm",) * 3)
                - vs.Box(size=("10 mm",) * 3, corner=("-5 mm",) * 3),
                material=RUBBER,
            )
        ],
        symmetry=[{"plane": axis} for axis in "xyz"],
        loads=[vs.Pressure(value=5 * kPa)],
    )
    path = vs.follow(ball, "loads[0].value=1..5 kPa/3")
    alone = vs.simulate(ball)
    assert path.results[-1].cavity_volumes == pytest.approx(alone.cavity_volumes, rel=1e-8)
    assert len(path.results[0].positions) == len(alone.positions)


def test_a_lost_path_keeps_its_states():
    pressed = beam(
        loads=[vs.Force(region=vs.Region(x=("40 mm", "40 mm")), value=("-1 mN", 0, 0))],
        solver={"method": "statics"},
    )
    path = vs.follow(pressed, "loads[0].value[0]=0..-1e4 N/3")
    assert path.status != "ok"
    assert len(path.results) == 2
    assert "after 1 of 3 equilibria" in path.message


def test_error_bars_go_along():
    path = vs.follow(beam(), "loads[1].value[2]=0..-20 mN/3")
    bars = path_error_bars(path)
    whole = vs.error_bars(vs.simulate(beam().with_values("loads[1].value[2]=-20 mN")))
    assert bars[-1].probes["tip"][2].estimate == pytest.approx(
        whole.probes["tip"][2].estimate, rel=1e-6
    )
    assert all(bar.voxel_sizes == whole.voxel_sizes for bar in bars)


@pytest.mark.parametrize(
    ("over", "words"),
    [
        ("voxel_size=4..5 mm/2", "keeps the body"),
        ("parts[0].shape.size[0]=40..50 mm/2", "keeps the body"),
        ("loads[1].value[1]=0..10 mN/3", "changes the direction"),
        ("nothing=0..10 mN/3", "nothing"),
        ("loads[7].value=0..1 kPa/3", "loads"),
    ],
)
def test_invalid_paths_are_refused(over, words):
    with pytest.raises(vs.VoxSoftError) as caught:
        vs.follow(beam(), over)
    assert words in str(caught.value)


def test_other_ways_are_refused():
    with pytest.raises(SimulationError, match="motion over time"):
        vs.follow(beam(), "loads[1].value[2]=0..-20 mN/3", end_time="1 s")
    with pytest.raises(SimulationError, match="looks for the load"):
        vs.follow(beam(), "loads[1].value[2]=0..-20 mN/3", method="statics", control="arc-length")


@pytest.mark.long
def test_the_command_writes_the_table_and_the_picture(tmp_path):
    file = tmp_path / "beam.toml"
    vs.save(beam(), file)
    folder = tmp_path / "run"
    arguments = ["run", str(file), "--over", "loads[1].value[2]=0..-20 mN/3", "--out", str(folder)]
    answer = CliRunner().invoke(app, [*arguments, "--figure", "--json"])
    assert answer.exit_code == 0, answer.stderr
    found = json.loads(answer.stdout)
    assert [row["value"] for row in found["path"]] == pytest.approx([0, -0.01, -0.02])
    assert found["probes"] == found["path"][-1]["probes"]
    assert found["path"][1]["error_bars"]["probes"]["tip"]["z"]["error"] > 0.0
    table = (folder / "path.csv").read_text().splitlines()
    assert len(table) == 4
    assert "tip.z.error" in table[0]
    assert (folder / "path.png").stat().st_size > 1000
    shown = CliRunner().invoke(app, arguments)
    assert "Along loads[1].value[2]" in shown.output


def test_a_path_that_is_interrupted_leaves_its_equilibria(tmp_path):
    def stop(event):
        if isinstance(event, Progress) and event.of == "equilibria" and event.done == 2:
            raise KeyboardInterrupt

    spec = RunSpec(design=beam(), over="loads[1].value[2]=0..-20 mN/5")
    with pytest.raises(KeyboardInterrupt):
        run_job(spec, tmp_path / "run", stop)
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert [row["value"] for row in summary["path"]] == pytest.approx([0, -0.005])
    assert len((tmp_path / "run" / "path.csv").read_text().splitlines()) == 3


def test_a_path_is_repeated_as_it_was(tmp_path):
    spec = RunSpec(design=beam(), over="loads[1].value[2]=0..-20 mN/3")
    run_job(spec, tmp_path / "run")
    answer = CliRunner().invoke(app, ["again", str(tmp_path / "run"), "--out", str(tmp_path / "b")])
    assert answer.exit_code == 0, answer.output
    first, second = ((tmp_path / name / "path.csv").read_text() for name in ("run", "b"))
    assert first == second


def test_chambers_have_columns():
    hollow = vs.Box(size=("20 mm",) * 3) - vs.Box(size=("10 mm",) * 3, corner=("5 mm",) * 3)
    part = vs.Part(shape=hollow, material=RUBBER)
    filled = beam(parts=[part], loads=[vs.Pressure(value="2 kPa")], probes={})
    columns = vs.follow(filled, "loads[0].value=0..2 kPa/3").columns
    assert columns["cavity 0.pressure"] == ("pressure", pytest.approx((0.0, 1e3, 2e3)))
    small, middle, large = columns["cavity 0.volume"][1]
    assert small < middle < large


@pytest.mark.slow
def test_tendons_pull_along_a_path_and_friction_makes_a_loop():
    def arm(friction):
        bends = [("40 mm", 0, "10 mm"), ("80 mm", 0, "10 mm")]
        return vs.Design(
            name="arm",
            voxel_size=5 * mm,
            parts=[vs.Part(shape=vs.Box(size=("80 mm", "10 mm", "10 mm")), material=RUBBER)],
            clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
            tendons=[
                vs.Tendon(
                    name="flexor",
                    through=[{"fixed": (0, 0, "10 mm")}, *bends],
                    tension="0.2 N",
                    friction=friction,
                )
            ],
            probes={"tip": vs.Probe(x=("80 mm", "80 mm"))},
        )

    smooth = vs.follow(arm(0.0), "tendons[0].tension=0..0.2..0 N/9")
    assert smooth.status == "ok", smooth.message
    rise = np.array([result.probes["tip"][2] for result in smooth.results])
    assert rise[4] == pytest.approx(vs.simulate(arm(0.0)).probes["tip"][2], rel=1e-5)
    assert rise[2] == pytest.approx(rise[6], rel=1e-6)
    rough = vs.follow(arm(0.5), "tendons[0].tension=0..0.2..0 N/9")
    there, back = (rough.results[number].probes["tip"][2] for number in (2, 6))
    assert there < 0.98 * rise[2] < 0.98 * back


def test_histories_of_supplies_are_refused_along_a_path_of_values():
    hollow = vs.Box(size=("20 mm",) * 3) - vs.Box(size=("10 mm",) * 3, corner=("5 mm",) * 3)
    filled = beam(
        parts=[vs.Part(shape=hollow, material=RUBBER)],
        loads=[vs.Gravity()],
        probes={},
        chambers={"room": {"point": ("10 mm",) * 3}},
        supplies=[
            {
                "kind": "volume",
                "chamber": "room",
                "value": "0.1 mL",
                "history": {"time": ["0 s", "1 s"], "factor": [0, 1]},
            }
        ],
    )
    with pytest.raises(SimulationError, match=r"supplies\[0\].history"):
        vs.follow(filled, "supplies[0].value=0..0.1 mL/3")
