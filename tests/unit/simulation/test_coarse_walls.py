"""Walls and chambers that whole voxels make thinner or thicker than they are written."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import families
from voxsoft.shapes import Box, Cylinder, Rotate
from voxsoft.simulation import check
from voxsoft.simulation.checks import coarse_walls as walls
from voxsoft.simulation.checks.coarse_walls import coarse_walls
from voxsoft.simulation.checks.vanished import vanished_shapes
from voxsoft.simulation.results.warnings import warnings_at

MM = 1e-3
HOLE = Cylinder(radius=5.3 * MM, height=0.014, base=(0, 0, 0.003))


def hollow(side, wall, size, **changes):
    room = Box(size=((side - 2 * wall) * MM,) * 3, corner=(wall * MM,) * 3)
    block = Box(size=(side * MM,) * 3, corner=(0, 0, 0))
    shapes = {"body": block - room}
    whole = {"shapes": shapes, "voxel_size": size * MM, "fill": "binary"}
    return families.beam().replace(**(whole | changes))


def found(design):
    return list(coarse_walls(design, vs.mesh_of(design)))


@pytest.mark.parametrize(
    "design",
    [
        hollow(22.5, 3.75, 2.5),
        hollow(12, 1.3, 1.0),
        hollow(20, 3.0, 2.5, shapes={"body": Cylinder(radius=9 * MM, height=0.02) - HOLE}),
        families.paper_cylinder(radius="17 mm", height="26 mm", wall="6 mm"),
        families.sphere().replace(fill="binary"),
    ],
)
def test_rows_that_the_first_line_clears_are_not_doubtful_on_all(design):
    mesh = vs.mesh_of(design)
    cells = walls.GridRegions.of(mesh, mesh.voxel_size)
    shapes = walls.built_parts(design)
    for axis in range(3):
        for rows in walls._rows(cells.rooms, axis):
            flat = walls._flat(rows, shapes, cells, len(rows.number))
            points = walls._points(flat, shapes, cells, walls._ASIDE)
            expected = walls._picked(flat, walls._may_differ(flat, points))
            doubted = walls._doubted(rows, shapes, cells)
            assert np.array_equal(doubted.first, expected.first)
            assert np.array_equal(doubted.number, expected.number)


@pytest.mark.parametrize(
    ("side", "wall", "size"),
    [(22.5, 3.75, 2.5), (20, 3.0, 2.0), (10, 3.8, 2.0), (12, 1.3, 1.0), (20, 4.0, 2.0)],
)
def test_shapes_lost_on_voxels_are_named_with_the_solved_ones(side, wall, size):
    design = hollow(side, wall, size)
    voxels = vs.voxels_of(design)
    (cavity,), (thinnest,) = voxels.cavities, voxels.cavity_walls
    room = round(cavity.count ** (1 / 3))
    texts = " and ".join(each.what for each in found(design))
    for number, described, words in (
        (thinnest.thickness, wall, f"walls {wall:g} mm thick"),
        (room, side - 2 * wall, f"chambers {side - 2 * wall:g} mm wide"),
    ):
        # More than six voxels are off by less than is named.
        is_off = number <= 6 and abs(number * size / described - 1) >= 0.15
        assert (f"{words} are solved as {number * size:g} mm ({number} voxel" in texts) == is_off
    assert all('fill = "fraction"' in each.hint for each in found(design))


def test_the_voxel_size_that_is_offered_holds_the_walls():
    # 3.75 mm are two voxels of 1.875 mm, and the room of 7.5 mm is four.
    (first, *_) = found(hollow(15, 3.75, 2.5))
    assert 'voxel_size = "1.875 mm"' in first.hint
    assert found(hollow(15, 3.75, 1.875)) == []


def test_cut_voxels_and_oblique_or_round_walls_are_left_to_volumes():
    assert found(hollow(22.5, 3.75, 2.5, fill="fraction")) == []
    tube = Cylinder(radius=20 * MM, height=60 * MM) - Cylinder(
        radius=10.6 * MM, height=40 * MM, base=(0, 0, 10 * MM)
    )
    assert (
        found(families.beam().replace(shapes={"body": tube}, voxel_size=2.5 * MM, fill="binary"))
        == []
    )
    box = hollow(22.5, 3.75, 2.5).shapes["body"]
    turned = Rotate(of=box, axis=(0, 0, 1), angle=0.5)
    texts = [each.what for each in found(hollow(22.5, 3.75, 2.5).replace(shapes={"body": turned}))]
    assert all("3.75 mm" in each for each in texts)  # floor and ceiling stay on the grid


def test_check_command_and_results_say_it_for_the_bending_finger(tmp_path):
    walls = families.pneunet().with_values("parameters.wall.value=3.75 mm")
    assert not [each for each in check(walls).findings if "solved as" in each.what]
    design = walls.replace(fill="binary")
    words = "walls 3.75 mm thick are solved as"
    assert any(words in each.what for each in check(design).findings)
    mesh = vs.mesh_of(design)
    assert any(words in each.what for each in warnings_at(design, mesh, mesh.vertices))
    file = tmp_path / "finger.toml"
    vs.save(design, file)
    outcome = CliRunner().invoke(app, ["check", str(file), "--json"])
    assert any(words in each["what"] for each in json.loads(outcome.stdout)["problems"])


def test_a_chamber_without_width_is_named():
    design = families.pneunet().with_values("parameters.wall.value=5 mm")
    assert [each.where for each in vanished_shapes(design)] == ["shapes.row", "shapes.chamber"]
    assert any(each.where == "shapes.chamber" for each in check(design).findings)
    assert list(vanished_shapes(families.pneunet())) == []
