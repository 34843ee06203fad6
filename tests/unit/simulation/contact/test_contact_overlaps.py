"""Reported overlaps where contact keeps surfaces apart."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Contact
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.simulation.checks.overlaps import overlap_warnings, penetration_of
from voxsoft.units import kPa, mm

SIDE = 10 * mm


def blocks(contact):
    """One voxel below another, with room for one more between them."""
    lower = vs.Box(size=(SIDE,) * 3, corner=(0, 0, 0))
    upper = vs.Box(size=(SIDE,) * 3, corner=(0, 0, 2 * SIDE))
    return vs.Design(
        name="blocks",
        voxel_size=SIDE,
        parts=[vs.Part(shape=lower | upper, material=vs.NeoHookean(young=100 * kPa, poisson=0.4))],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0))), vs.Clamp(region=vs.Region(z=(0.03, 0.03)))],
        contact=contact,
    )


def placed(design, depth, warp=0.0):
    """The upper block so deep in the lower one, a corner of it over the middle of a warped face."""
    mesh = mesh_of(design)
    positions = mesh.vertices.copy()
    is_upper = mesh.vertices[:, 2] > 1.5 * SIDE
    positions[is_upper] += [0.5 * SIDE, 0.5 * SIDE, -SIDE - depth]
    top = ~is_upper & (mesh.vertices[:, 2] > 0.5 * SIDE)
    across = np.where(mesh.vertices[top, 0] > 0.5 * SIDE, 1.0, -1.0)
    along = np.where(mesh.vertices[top, 1] > 0.5 * SIDE, 1.0, -1.0)
    positions[top, 2] += warp * across * along
    return mesh, positions


def warnings_of(design, mesh, positions):
    return [str(each) for each in overlap_warnings(design, mesh, positions)]


@pytest.mark.parametrize("surface", ["smooth", "voxels"])
def test_overlap_despite_contact_is_reported(surface):
    design = blocks(Contact(surface=surface))
    mesh, positions = placed(design, depth=3 * mm)
    (warning,) = warnings_of(design, mesh, positions)
    assert "overlap by 3 mm" in warning
    assert "contact has not kept them apart" in warning


@pytest.mark.parametrize(
    "contact", [None, Contact(pairs=[{"of": ["body", "body"], "kind": "none"}])]
)
def test_overlap_without_contact_is_reported_at_any_depth(contact):
    design = blocks(contact)
    mesh, positions = placed(design, depth=0.1 * mm)
    (warning,) = warnings_of(design, mesh, positions)
    assert "overlap by 0.1 mm" in warning
    assert "contact is not simulated" in warning


@pytest.mark.parametrize("surface", ["smooth", "voxels"])
def test_triangles_that_a_warped_face_is_not_are_no_overlap(surface):
    # The face warps down where the upper block is above it, by nothing at its corner, over the
    # middle of the face. The diagonal along which the face is two triangles passes that above it.
    design = blocks(Contact(surface=surface))
    mesh, positions = placed(design, depth=-0.02 * mm, warp=-0.4 * mm)
    assert penetration_of(blocks(None), mesh, positions).depth > 0.3 * mm
    assert penetration_of(design, mesh, positions).depth == 0.0
