"""Rigid motions that no clamp stops, and materials that relax: reported before and after a run."""

import csv

import pytest

import voxsoft as vs
from voxsoft.files.run_folder import write_run
from voxsoft.simulation import Setup, check
from voxsoft.simulation.setup.freedom import free_motion
from voxsoft.units import mm

SOFT = vs.NeoHookean(young="60 kPa", poisson=0.45, density=1070.0)
RELAXING = {"model": "neo-hookean", "young": "60 kPa", "prony": [{"g": 0.3, "tau": "100 s"}]}
LOW = vs.Region(z=(0, 0))
EDGE = vs.Region(x=(0, 0), z=(0, 0))
CORNER = vs.Region(x=(0, 0), y=(0, 0), z=(0, 0))


def block(*clamps, material=SOFT, **changes):
    return vs.Design(
        name="block",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=vs.Box(size=("20 mm", "10 mm", "10 mm")), material=material)],
        clamps=clamps,
        loads=[vs.Force(region=vs.Region(x=("20 mm", "20 mm")), value=("1 mN", 0, "2 mN"))],
        solver={"error": "off"},
        **changes,
    )


@pytest.mark.parametrize(
    ("clamps", "words"),
    [
        ([vs.Clamp(region=LOW)], ""),
        ([vs.Clamp(region=LOW, axes="z")], "move along x and y and to turn about z"),
        ([vs.Clamp(region=LOW, axes="xz")], "move along y"),
        ([vs.Clamp(region=EDGE)], "turn about y"),
        ([vs.Clamp(region=CORNER)], "turn about x, y and z"),
        ([vs.Clamp(region=CORNER), vs.Clamp(region=LOW, axes="z")], "turn about z"),
    ],
)
def test_motions_that_clamps_leave_free_are_named(clamps, words):
    design = block(*clamps)
    assert free_motion(Setup.of(design)) == words
    found = [each for each in check(design).findings if each.where == "clamps"]
    assert [each.what for each in found] == ([f"leave the body free to {words}"] if words else [])


def test_a_plane_of_symmetry_holds_too():
    held = vs.Clamp(region=vs.Region(x=(0, 0)), axes="xz")
    assert free_motion(Setup.of(block(held))) == "move along y"
    assert free_motion(Setup.of(block(held, symmetry=[{"plane": "y", "at": "5 mm"}]))) == ""


def test_a_run_names_free_motions_and_not_another_control():
    result = vs.simulate(block(vs.Clamp(region=LOW, axes="z")))
    assert result.status == "not-at-rest"
    assert "free to move along x and y and to turn about z" in result.message
    assert "arc-length" not in result.message


def test_motion_over_time_may_be_free():
    design = block(vs.Clamp(region=LOW, axes="z")).replace(solver={"end_time": "1 ms"})
    assert not [each for each in check(design).findings if each.where == "clamps"]


def test_equilibria_of_relaxing_rubber_name_the_long_term_stiffness():
    design = block(vs.Clamp(region=LOW), material=RELAXING)
    words = "long-term stiffness, and a sudden load meets 1.43 times that"
    assert any(words in each.what for each in check(design).findings)
    assert any(words in each.what for each in vs.simulate(design).warnings)
    load = design.loads[0].replace(history={"time": [0, 1], "factor": [0, 1]})
    upward = design.loads[0].replace(value=(0, 0, "2 mN"))
    over = vs.follow(design.replace(loads=[upward]), "loads[0].value[2]=0..2 mN/2")
    assert all(any(words in each.what for each in found.warnings) for found in over.results)
    over = vs.follow(design.replace(loads=[load]), "time=0..1 s/2")
    assert not any(words in each.what for found in over.results for each in found.warnings)


def test_motion_of_relaxing_rubber_has_no_such_warning():
    design = block(vs.Clamp(region=LOW), material=RELAXING).replace(solver={"end_time": "1 ms"})
    for found in (check(design).findings, vs.simulate(design).warnings):
        assert not any("relaxes" in each.what for each in found)


def test_the_history_has_where_objects_are(tmp_path):
    cube = vs.Box(size=("5 mm", "5 mm", "5 mm"), corner=("5 mm", "5 mm", "12 mm"))
    design = block(vs.Clamp(region=LOW)).replace(
        loads=[vs.Gravity()],
        shapes={"cube": cube},
        objects=[{"name": "cube", "shape": "cube", "density": "500 kg/m^3", "motion": "free"}],
        solver={"method": "dynamics", "end_time": "20 ms", "time_step": "5 ms", "error": "off"},
    )
    result = vs.simulate(design, record_interval="10 ms")
    write_run(result, tmp_path)
    with (tmp_path / "history.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    heights = [float(row["cube_z_m"]) for row in rows]
    assert heights == pytest.approx(result.recording.objects["cube"][0][:, 2], rel=1e-8)
    # Free fall from the first step on; the cube is 2 mm over the block.
    assert heights[0] - heights[-1] == pytest.approx(9.81 * 0.02**2 / 2, rel=1e-5)
