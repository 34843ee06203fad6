"""Voxels that are halved where the estimated error is."""

from __future__ import annotations

import dataclasses
import json
import tomllib

import numpy as np
import pytest
import trimesh
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.comparison import local_errors, refined
from voxsoft.design import Refinement, families
from voxsoft.errors import DesignError
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.49, density=1070.0)
SIDE, RADIUS = 32 * mm, 8 * mm


def block(**changes):
    """A block with a round chamber under pressure, on its foot."""
    middle = (SIDE / 2, SIDE / 2, SIDE / 2)
    return vs.Design(
        name="block",
        voxel_size=4 * mm,
        fill="fraction",
        shapes={
            "block": {"kind": "box", "size": [SIDE] * 3, "corner": [0, 0, 0]},
            "room": {"kind": "sphere", "radius": RADIUS, "center": middle},
            "body": {"kind": "difference", "of": ["block", "room"]},
        },
        parts=[vs.Part(shape="body", material=RUBBER)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Pressure(value=10 * kPa)],
    ).replace(**changes)


@pytest.fixture(scope="module")
def run():
    return vs.simulate(block())


def growth(result):
    return float(result.cavity_volumes[0] - result.mesh.cavities[0].volume)


def test_a_uniform_strain_has_no_error(run):
    # Deformation of any size and with any rotation: Green's strain is the same in each voxel.
    cosine, sine = np.cos(0.7), np.sin(0.7)
    rotation = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    stretched = run.mesh.vertices * [1.4, 0.8, 0.9] @ rotation.T
    uniform = dataclasses.replace(run, positions=stretched)
    # Positions are rounded to a part of themselves, which are up to ten voxels.
    rounding = (10 * 10 * np.finfo(float).eps) ** 2
    assert local_errors(uniform).max() < rounding * 60 * kPa * (4 * mm) ** 3
    assert local_errors(run).max() > 1e6 * local_errors(uniform).max()


def test_the_error_is_at_the_chamber(run):
    errors = local_errors(run)
    corners = run.mesh.voxel_corners(np.arange(len(errors)))
    middles = run.mesh.vertices[corners].mean(axis=1)
    far = np.linalg.norm(middles - SIDE / 2, axis=1)
    assert far[errors.argmax()] < RADIUS + 4 * mm
    # A fifth of the voxels, those next to the chamber, hold most of it.
    near = far < RADIUS + 6 * mm
    assert errors[near].sum() > 0.8 * errors.sum() > near.mean() * errors.sum()


@pytest.mark.slow
def test_refined_voxels_at_the_error_replace_uniformly_small_ones(run):
    small = growth(vs.simulate(Setup.of(block(), refine=2)))
    design = refined(run)
    found = vs.simulate(design)
    assert found.status == "ok"
    # Most is more than half; two thirds are measured.
    assert abs(growth(found) - small) < 0.5 * abs(growth(run) - small)
    assert Setup.of(design).elements < 0.6 * Setup.of(block(), refine=2).elements


def test_images_of_each_other_are_taken_together(run):
    found = Setup.of(refined(run, 0.6))
    large = np.zeros(len(found.mesh.tets) // 5, dtype=bool)
    large[found.large_voxels.ravel()] = True
    corners = found.mesh.voxel_corners(np.arange(len(large)))
    middles = found.mesh.vertices[corners].mean(axis=1)
    keys = np.rint(middles / mm).astype(int)
    size = dict(zip(map(tuple, keys), large, strict=True))
    assert 0.1 < large.mean() < 0.9
    for (x, y, z), is_large in size.items():
        assert size[y, x, z] == is_large
        assert size[round(SIDE / mm) - x, y, z] == is_large


@pytest.mark.slow
def test_more_of_the_error_takes_more_voxels(run):
    counts = [Setup.of(refined(run, share)).elements for share in (0.3, 0.6, 0.9)]
    assert counts == sorted(counts)
    # Rounding of the sum leaves no share without a voxel that reaches it.
    assert Setup.of(refined(run, 1.0 - 2.0**-53)).elements >= counts[-1]
    assert counts[0] > Setup.of(block()).elements


def test_a_body_of_many_places_has_boxes_that_a_text_has_room_for():
    finger = families.pneunet(chambers=2)
    design = refined(vs.simulate(finger), 0.7)
    assert 1 < len(design.refine) <= 120


@pytest.mark.parametrize("share", [0.0, 1.0, -0.5, 90.0])
def test_a_share_is_a_part(run, share):
    with pytest.raises(DesignError, match=r"share: is .*between 0 and 1"):
        refined(run, share)


@pytest.mark.slow
def test_two_sizes_are_not_refined_again():
    twice = block(refine=[Refinement(region=vs.Region(z=(0, 8 * mm)))])
    with pytest.raises(DesignError, match="refine: is there already"):
        refined(vs.simulate(twice))


@pytest.mark.slow
def test_the_command_adds_to_earlier_refinement(run, tmp_path):
    first = Refinement(region=vs.Region(z=(0, 8 * mm)))
    vs.save(block(refine=[first]), tmp_path / "twice.toml")
    outcome = CliRunner().invoke(app, ["refine", str(tmp_path / "twice.toml")])
    assert outcome.exit_code == 0, outcome.output
    written = vs.load(tmp_path / "twice-refined.toml")
    assert written.refine == (first, *refined(run).refine)


@pytest.mark.long
def test_the_command_keeps_the_text_and_adds_boxes(tmp_path):
    file = tmp_path / "block.toml"
    vs.save(block(), file)
    text = file.read_text().replace('name = "block"', 'name = "block" # mine')
    file.write_text(text)
    outcome = CliRunner().invoke(app, ["refine", str(file), "--share", "80 %", "--json"])
    assert outcome.exit_code == 0, outcome.output
    summary = json.loads(outcome.stdout)
    written = (tmp_path / "block-refined.toml").read_text()
    assert written.startswith(text.rstrip()[:200])
    assert "# mine" in written
    assert len(tomllib.loads(written)["refine"]) == summary["boxes"]
    again = vs.load(tmp_path / "block-refined.toml")
    assert Setup.of(again).elements == summary["refined_voxels"] < summary["everywhere"]
    assert again.replace(refine=()) == vs.load(file)


@pytest.mark.parametrize(("share", "most"), [("97 %", True), ("40 %", False)])
def test_the_command_says_where_small_voxels_everywhere_are_as_quick(tmp_path, share, most):
    vs.save(families.pneunet(chambers=2), tmp_path / "finger.toml")
    outcome = CliRunner().invoke(app, ["refine", str(tmp_path / "finger.toml"), "--share", share])
    assert outcome.exit_code == 0, outcome.output
    assert ("refine = 2 under [solver]" in " ".join(outcome.output.split())) == most


def test_the_command_replaces_no_file_unasked_and_knows_the_fineness(tmp_path):
    fine = families.beam(length="40 mm").replace(solver={"refine": 2})
    vs.save(fine, tmp_path / "my beam.toml")
    call = ["refine", str(tmp_path / "my beam.toml"), "--share", "99.9 %"]
    first = CliRunner().invoke(app, call)
    assert first.exit_code == 0, first.output
    assert "refine = 4 under [solver]" in " ".join(first.output.split())
    made = tmp_path / "my beam-refined.toml"
    made.write_text(made.read_text() + "# mine")
    again = CliRunner().invoke(app, call)
    assert again.exit_code != 0
    assert "is there already" in " ".join(again.output.split())
    assert made.read_text().endswith("# mine")
    assert CliRunner().invoke(app, [*call, "--out", str(made)]).exit_code == 0
    assert not made.read_text().endswith("# mine")


BAR = """
schema = "voxsoft/1"
name = "bar"
voxel_size = "5 mm"
shapes = { bar = { kind = "mesh", path = "bar.stl", unit = "m" } }
clamps = [{ region = { x = [0, 0] } }]
loads = [{ kind = "gravity" }]
probes = { tip = { point = ["40 mm", "5 mm", "5 mm"] } }

[[parts]]
shape = "bar"
material = "ecoflex-00-30"
"""


def test_the_command_keeps_paths_relative_to_the_design(tmp_path):
    beside, elsewhere = tmp_path / "mine", tmp_path / "other"
    beside.mkdir()
    elsewhere.mkdir()
    bar = trimesh.creation.box(extents=(0.04, 0.02, 0.02))
    bar.apply_translation((0.02, 0.01, 0.01))
    bar.export(beside / "bar.stl")
    (beside / "bar.toml").write_text(BAR, encoding="utf-8")
    for out in (beside / "fine.toml", elsewhere / "fine.toml"):
        outcome = CliRunner().invoke(app, ["refine", str(beside / "bar.toml"), "--out", str(out)])
        assert outcome.exit_code == 0, outcome.output
        assert vs.load(out).refine
    assert 'path = "bar.stl"' in (beside / "fine.toml").read_text(encoding="utf-8")
