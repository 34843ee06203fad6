"""Contact over the surface: its pressure, its sums, and where it goes."""

from dataclasses import replace

import numpy as np
import pytest
from pressed import BLOCK, PLATE, SIDE, pressed, slit
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import Contact
from voxsoft.errors import MeshError
from voxsoft.files import save, write_run
from voxsoft.files.meshes import read_mesh_file
from voxsoft.plot import plot_body
from voxsoft.simulation import simulate
from voxsoft.simulation.results.contact_field import ContactField
from voxsoft.units import kPa, mm


def top_of(result):
    return result.mesh.vertices[:, 2] > SIDE - 1e-9


@pytest.fixture(scope="module")
def dragged():
    """A block that is pressed, and dragged along x by sticking friction."""
    way = vs.Motion(displacement=(0.5 * mm, 0, -1.5 * mm))
    plate = PLATE.replace(motion=way)
    return simulate(pressed(objects=[plate], contact=Contact(friction=0.8)))


def test_an_even_pressure_is_even_to_the_corners():
    """A block that hardly bulges, 1 mm of 12 mm shorter."""
    foam = vs.Part(shape=BLOCK, material=vs.NeoHookean(young=100 * kPa, poisson=0.0))
    plate = PLATE.replace(motion=vs.Motion(displacement=(0, 0, -1.5 * mm)))
    found = simulate(pressed(parts=[foam], objects=[plate]))
    (contact,), field, top = found.contacts, found.contact_field, top_of(found)
    # Points on both sides share the force; bilinear faces make that even to half a percent.
    wide, deep, _ = np.ptp(found.positions[top], axis=0)
    even = -contact.force[2] / (wide * deep)
    assert field.pressure[top] == pytest.approx(np.full(16, even), rel=5e-3)
    assert not field.pressure[~top].any()
    assert field.area[top].sum() == pytest.approx(wide * deep, rel=1e-4)
    assert field.gap[top].max() < 1e-3 * 4 * mm
    assert np.isinf(field.gap[~top]).all()


def test_pressure_and_friction_over_the_surface_are_the_force(dragged):
    (contact,), field = dragged.contacts, dragged.contact_field
    pressed_by = (field.pressure * field.area).sum()
    assert pressed_by == pytest.approx(-contact.force[2], rel=1e-6)
    rubbed = field.area @ field.friction
    # The normals of body and plate lean from each other by parts of the clearance over a voxel, so
    # that pressure has a share along the plate, as friction has one across it below.
    assert rubbed[0] == pytest.approx(contact.force[0], abs=1e-6 * pressed_by)
    assert rubbed[0] > 0.05 * pressed_by
    # The plate is flat: the component along it is friction, and that across it is pressure.
    assert abs(rubbed[2]) < 1e-6 * pressed_by
    bound = 0.8 * field.pressure
    assert (np.linalg.norm(field.friction, axis=1) <= 1.01 * bound + 1.0).all()


def test_both_sides_of_a_body_that_touches_itself_are_pressed():
    found = simulate(slit(contact=Contact()))
    (contact,), field = found.contacts, found.contact_field
    assert (field.pressure * field.area).sum() == pytest.approx(2 * contact.pressed, rel=1e-6)
    where = found.mesh.vertices[field.pressure > 0.0]
    assert set(np.round(where[:, 2] / mm)) == {4, 6}  # of the lips, which is all that meets


def test_the_field_is_in_the_file_for_other_programs(dragged, tmp_path):
    read = read_mesh_file(write_run(dragged, tmp_path) / "result.vtu").point_data
    field = dragged.contact_field
    assert np.array_equal(read["contact_pressure"], field.pressure)
    assert np.array_equal(read["contact_friction"], field.friction)
    top = top_of(dragged)
    assert np.array_equal(read["contact_gap"][top], field.gap[top])
    assert np.isnan(read["contact_gap"][~top]).all()


def test_a_design_without_contact_has_no_such_field(tmp_path):
    found = simulate(pressed(objects=[], loads=[vs.Gravity()]))
    assert found.contact_field is None
    read = read_mesh_file(write_run(found, tmp_path) / "result.vtu").point_data
    assert not [name for name in read if name.startswith("contact")]
    with pytest.raises(MeshError, match=r"nothing touches.*\[contact\]"):
        plot_body(found, "contact_pressure")


@pytest.mark.slow
def test_the_command_line_tells_and_draws_it(dragged, tmp_path):
    file = tmp_path / "dragged.toml"
    save(dragged.design, file)
    ran = CliRunner().invoke(
        app, ["run", str(file), "--error", "off", "--figure", "--out", str(tmp_path / "run")]
    )
    assert ran.exit_code == 0, ran.stderr
    assert "body touches plate with" in ran.stderr + ran.stdout
    assert (tmp_path / "run" / "contact.png").stat().st_size > 10_000


@pytest.mark.slow
def test_colors_go_up_to_the_largest_pressure_of_a_small_place():
    """Most of a body is pressed by nothing; 99 % of its area end far below that."""
    fine = simulate(pressed(voxel_size=1 * mm, objects=[], loads=[vs.Gravity()]))
    count = len(fine.mesh.vertices)
    one, none = np.zeros(count), np.full(count, np.inf)
    one[np.flatnonzero(top_of(fine))[84]] = 10 * kPa
    field = ContactField(one, np.zeros((count, 3)), none, np.zeros(count))
    bar = plot_body(replace(fine, contact_field=field), "contact_pressure").axes[1]
    assert bar.get_ylabel() == "contact pressure (kPa)"
    assert bar.get_ylim()[1] == pytest.approx(10.0)
