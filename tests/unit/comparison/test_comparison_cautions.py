"""An error estimate that may say too little says so where it is shown, and only there."""

import pytest

import voxsoft as vs
from voxsoft.cli.compare import _show
from voxsoft.comparison.cautions import cautions_of, steps_of_wall
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.files import write_comparison
from voxsoft.units import kPa, mm

SPHERE = vs.Sphere(radius=20 * mm) - vs.Sphere(radius=10 * mm)
TUBE = vs.Cylinder(radius=16 * mm, height=40 * mm) - vs.Cylinder(
    radius=8 * mm, height=30 * mm, base=(0, 0, 5 * mm)
)
BOX = vs.Box(size=(30 * mm,) * 3) - vs.Box(size=(20 * mm,) * 3, corner=(5 * mm,) * 3)
BETWEEN = vs.Box(size=(30 * mm,) * 3) - vs.Box(size=(18 * mm,) * 3, corner=(6 * mm,) * 3)
ROUNDED = vs.Box(size=(30 * mm,) * 3) - vs.RoundedBox(
    size=(20 * mm,) * 3, corner=(5 * mm,) * 3, radius=2 * mm
)
LEANING = vs.Box(size=(40 * mm,) * 3, corner=(-20 * mm,) * 3) - vs.Rotate(
    of=vs.Box(size=(20 * mm,) * 3, corner=(-10 * mm,) * 3), axis=(0, 0, 1), angle=0.5
)


def design(shape, fill, *loads):
    return vs.Design(
        name="chamber",
        voxel_size=2.5 * mm,
        fill=fill,
        parts=[vs.Part(shape=shape, material=vs.NeoHookean(young=60 * kPa))],
        clamps=[vs.Clamp(region=vs.Region(x=("-inf", 0)))],
        loads=loads or [vs.Pressure(value=0.1 * kPa)],
        probes={"top": vs.Probe(z=("10 mm", "inf"))},
    )


@pytest.mark.long
@pytest.mark.parametrize("fill", ["binary", "fraction"])
@pytest.mark.parametrize(
    ("shape", "round"),
    [
        pytest.param(SPHERE, True, id="sphere"),
        pytest.param(TUBE, True, id="tube"),
        pytest.param(LEANING, True, id="leaning box"),
        pytest.param(BOX, False, id="box"),
        pytest.param(BETWEEN, False, id="box between voxels"),
        pytest.param(ROUNDED, False, id="rounded box"),
    ],
)
def test_stairs_under_pressure_are_distinguished_from_boxes(shape, round, fill):
    body = design(shape, fill)
    mesh = mesh_of(body)
    found = list(cautions_of(body, mesh))
    assert bool(found) is round, steps_of_wall(body, mesh, mesh.cavities[0])
    assert not list(cautions_of(design(shape, fill, vs.Gravity()), mesh))
    for warning in found:
        assert (warning.where, warning.severity) == ("cavity 0", "warning")
        assert "may be low by up to two times" in warning.what
        assert max(map(abs, warning.at)) < 20 * mm


@pytest.mark.slow
def test_it_is_reported_where_the_estimates_are_shown(tmp_path, capsys):
    body = design(SPHERE, "binary").replace(voxel_size=5 * mm)
    found = vs.compare(body, solvers=["statics"], outside="none", voxel_sizes=[], splits=[1, 2])
    words = "may be low by up to two times"
    assert words in found.summary()["warnings"][0]["what"]
    page = write_comparison(found, tmp_path / "report.html").read_text(encoding="utf-8")
    assert words in page
    _show(found, tmp_path)
    assert words in capsys.readouterr().err.replace("\n", " ")
