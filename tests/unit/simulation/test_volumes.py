"""Volumes of parts and chambers beside closed forms."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest
import trimesh

import voxsoft as vs
from voxsoft.design import families
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.files.checks import check_mesh
from voxsoft.simulation.setup.volumes import LARGE, QUICK, doubtful_volumes, volumes_of

RUBBER = {"model": "neo-hookean", "young": "1 MPa", "poisson": 0.45, "density": "1070 kg/m^3"}


def design(size: str, *parts: vs.Shape, fill: str = "binary") -> vs.Design:
    return vs.Design.model_validate(
        {
            "schema": "voxsoft/1",
            "name": "body",
            "voxel_size": size,
            "fill": fill,
            "parts": [{"shape": part, "material": RUBBER} for part in parts],
        }
    )


def tube(outer: float, inner: float, height: float) -> vs.Shape:
    room = vs.Cylinder(radius=inner, height=height - 0.01, base=(0, 0, 0.005))
    return vs.Cylinder(radius=outer, height=height) - room


@pytest.mark.parametrize("fill", ["binary", "fraction"])
def test_described_volumes_are_those_of_the_shapes(fill: str):
    body = design("2.5 mm", tube(0.02, 0.01, 0.06), fill=fill)
    found = volumes_of(body, mesh_of(body))
    # The promise of docs/method/voxels.md.
    room = math.pi * 0.01**2 * 0.05
    (part,), (cavity,) = found.parts.values(), found.cavities.values()
    assert part.described == pytest.approx(math.pi * 0.02**2 * 0.06 - room, rel=1e-3)
    assert cavity.described == pytest.approx(room, rel=2e-3)
    if fill == "fraction":
        assert abs(part.difference) < 0.005


def test_turned_boxes_and_the_share_of_the_first_part():
    box = vs.Box(size=(0.03, 0.02, 0.01)).rotate(0.7, (1, 2, 3))
    ball = vs.Sphere(radius=0.008)
    body = design("1 mm", ball & box, box)
    first, second = volumes_of(body, mesh_of(body)).parts.values()
    assert first.described + second.described == pytest.approx(0.03 * 0.02 * 0.01, rel=1e-3)


def test_a_quick_look_is_within_a_fifth_of_the_doubt():
    for shape in (tube(0.02, 0.01, 0.06), tube(0.015, 0.011, 0.04), vs.Sphere(radius=0.02)):
        body = design("2.5 mm", shape)
        quick = volumes_of(body, mesh_of(body), points=QUICK)
        precise = volumes_of(body, mesh_of(body))
        for kind in ("parts", "cavities"):
            for name, volume in getattr(precise, kind).items():
                near = getattr(quick, kind)[name].described
                assert near == pytest.approx(volume.described, rel=LARGE / 5)


def test_doubts_name_the_part_or_the_chamber_and_the_way_out():
    ball, beam = families.sphere().replace(fill="binary"), families.beam()
    warned = {found.where: found for found in doubtful_volumes(ball, mesh_of(ball))}
    assert set(warned) == {"cavity 0"}
    # 4/3 π 15³ mm³ = 14.14 mL, which a quick look knows to 1 %.
    assert re.search(
        r"17 mL in voxels; its shapes have 14(\.\d)? mL \(\+2[01]%\)", str(warned["cavity 0"])
    )
    assert not [*doubtful_volumes(beam, mesh_of(beam))]
    thin = design("2 mm", tube(0.02, 0.0137, 0.06))
    (found, *_) = doubtful_volumes(thin, mesh_of(thin))
    assert 'fill = "fraction"' in found.hint


def test_a_run_says_both_volumes(tmp_path: Path):
    loads = [{"kind": "pressure", "value": "10 Pa"}]
    result = vs.simulate(families.sphere().replace(loads=loads, fill="binary"))
    summary = json.loads(json.dumps(result.summary()))
    volumes = summary["volumes"]["cavities"]["cavity 0"]
    assert volumes["simulated"] == pytest.approx(summary["cavities"][0]["rest_volume"])
    assert volumes["described"] == pytest.approx(4 / 3 * math.pi * 0.015**3, rel=2e-3)
    assert any(warning["where"] == "cavity 0" for warning in summary["warnings"])
    assert summary["phase"] == [0, 0, 0]


def test_a_mesh_file_is_compared_too(tmp_path: Path):
    trimesh.creation.icosphere(subdivisions=4, radius=10.0).export(tmp_path / "ball.stl")
    report = check_mesh(tmp_path / "ball.stl", unit="mm", voxel_size="2 mm")
    volume = report.volumes.parts["ball.stl"]
    exact = trimesh.load(tmp_path / "ball.stl").volume * 1e-9
    assert volume.described == pytest.approx(exact, rel=3e-3)
    assert report.summary()["volumes"]["parts"]["ball.stl"]["described"] == volume.described


def test_each_body_is_compared_in_its_own_frame(tmp_path: Path):
    bodies = vs.load(Path(__file__).parents[3] / "examples" / "gripper_three.toml").assembled
    parts = volumes_of(bodies, mesh_of(bodies)).parts
    assert set(parts) == {"first.body", "second.body", "third.body"}
    for volume in parts.values():
        assert volume.simulated == pytest.approx(volume.described, rel=1e-9)
