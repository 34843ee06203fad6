"""Shells of triangle surfaces: turned, doubled, nested, and messages about them."""

import json

import numpy as np
import pytest
import trimesh
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import families
from voxsoft.files.checks import check_mesh
from voxsoft.shapes import TriangleMesh, voxelize
from voxsoft.simulation import check
from voxsoft.simulation.results.warnings import warnings_at


def box(size, at=(0.0, 0.0, 0.0), *, inward=False):
    body = trimesh.creation.box(size)
    body.apply_translation(at)
    if inward:
        body.invert()
    return body


def saved(folder, *shells, nested=None):
    path = folder / "part.stl"
    trimesh.util.concatenate(shells).export(path)
    return TriangleMesh(path=str(path), unit="mm", nested=nested)


def cavities(shape, size=0.001):
    voxels = voxelize(shape, size)
    return voxels.count, [cavity.count for cavity in voxels.cavities]


OUTER, INNER = (40, 20, 20), (30, 10, 10)


@pytest.mark.long
@pytest.mark.parametrize("turned", [False, True])
def test_a_shell_of_the_same_sense_is_material_and_is_reported(tmp_path, turned):
    both = [box(OUTER, inward=turned), box(INNER, inward=turned)]
    assert cavities(saved(tmp_path, *both)) == (16_000, [])
    (finding,) = warnings_at_check(tmp_path)
    assert "a closed shell lies within another of the same sense, near (0, 0, 0) mm" in finding.what
    assert "solid 16 mL, hollow 13 mL" in finding.what
    assert 'nested = "void"' in finding.hint
    assert cavities(saved(tmp_path, *both, nested="void")) == (13_000, [3_000])
    assert warnings_at_check(tmp_path, nested="void") == []
    assert cavities(saved(tmp_path, *both, nested="solid")) == (16_000, [])
    assert warnings_at_check(tmp_path, nested="solid") == []


def warnings_at_check(folder, nested=None):
    report = check_mesh(folder / "part.stl", unit="mm", voxel_size="1 mm", nested=nested)
    assert report.valid
    return list(report.findings)


@pytest.mark.parametrize("turned", [False, True])
def test_a_shell_of_the_other_sense_is_a_chamber_without_a_word(tmp_path, turned):
    shape = saved(tmp_path, box(OUTER, inward=turned), box(INNER, inward=not turned))
    assert cavities(shape) == (13_000, [3_000])
    assert warnings_at_check(tmp_path) == []


def test_an_inverted_body_keeps_its_overlap_with_another(tmp_path):
    first, second = box(OUTER), box(OUTER, (30, 0, 0), inward=True)
    voxels = voxelize(saved(tmp_path, first, second), 0.002)
    assert voxels.count == 3_500
    assert len(voxels.components("face")) == 1
    (finding,) = warnings_at_check(tmp_path)
    assert "1 of 2 closed shells faced inward beside others that do not" in finding.what


@pytest.mark.parametrize("copies", [(False, True), (True, False), (True, False, True, False)])
def test_a_body_and_its_inverted_copy_are_the_body(tmp_path, copies):
    assert cavities(saved(tmp_path, *(box(OUTER, inward=inward) for inward in copies))) == (
        16_000,
        [],
    )
    (finding,) = warnings_at_check(tmp_path)
    assert "12 faces occur twice with opposite sense" in finding.what


def test_a_body_that_is_written_twice_is_the_body(tmp_path):
    assert cavities(saved(tmp_path, box(OUTER), box(OUTER))) == (16_000, [])
    assert warnings_at_check(tmp_path) == []


@pytest.mark.parametrize("turned", [False, True])
def test_bodies_that_meet_in_a_wall_are_one(tmp_path, turned):
    first, second = box((20, 20, 20)), box((20, 20, 20), (20, 0, 0), inward=turned)
    assert cavities(saved(tmp_path, first, second)) == (16_000, [])


def test_a_face_that_is_written_twice_leaves_no_hole(tmp_path):
    body = box(OUTER)
    body.faces = np.vstack([body.faces, body.faces[:1]])
    shape = saved(tmp_path, body)
    assert shape.state().holes == ()
    assert cavities(shape) == (16_000, [])


def test_an_open_surface_stays_as_it_is(tmp_path):
    body = box(OUTER)
    body.faces = body.faces[1:]
    state = saved(tmp_path, body, box(INNER)).state()
    assert (len(state.holes), state.nest.shells, state.nest.alike) == (1, 1, 0)


def test_the_warning_is_in_designs_checks_results_and_the_command(tmp_path):
    shape = saved(tmp_path, box(OUTER), box(INNER))
    design = families.beam().replace(shapes={"body": shape})
    words = "within another of the same sense"
    assert any(words in finding.what for finding in check(design).findings)
    mesh = vs.mesh_of(design)
    found = [each for each in warnings_at(design, mesh, mesh.vertices) if words in each.what]
    assert [(each.where, each.at) for each in found] == [("shapes.body.path", (0.0, 0.0, 0.0))]
    name, options = str(tmp_path / "part.stl"), ["--unit", "mm", "--voxel-size", "1 mm", "--json"]
    reports = [
        json.loads(CliRunner().invoke(app, ["check", name, *options, *more]).stdout)
        for more in ([], ["--nested", "void"])
    ]
    assert [any(words in each["what"] for each in report["problems"]) for report in reports] == [
        True,
        False,
    ]
    assert reports[1]["cavities"][0]["volume"] == pytest.approx(3e-6)
