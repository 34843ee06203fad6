"""Bricks carry the same clamps, loads and cavities as the voxels they are split from."""

import lattice_families as families
import numpy as np
import pytest

import voxsoft as vs
from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.calculix_deck import calculix_deck
from voxsoft.comparison.calculix_output import read_printed
from voxsoft.comparison.scikit_fem import run_scikit_fem
from voxsoft.comparison.stretch_energy import stretch_derivatives, terms_of
from voxsoft.design import Contact
from voxsoft.errors import SimulationError
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.49)


def setup_of(loads, clamps=None, **changes):
    box = vs.Box(size=(20 * mm, 10 * mm, 10 * mm))
    clamps = clamps or [vs.Clamp(region=vs.Region(x=(0, 5 * mm)))]
    part = vs.Part(shape=box, material=RUBBER)
    design = vs.Design(
        name="bar", voxel_size=5 * mm, parts=[part], clamps=clamps, loads=loads, **changes
    )
    return Setup.of(design)


@pytest.mark.parametrize("nodes", [8, 20, 27])
@pytest.mark.parametrize("split", [1, 2, 3])
def test_vertices_weights_and_forces_are_those_of_the_voxels(nodes, split):
    force = vs.Force(region=vs.Region(x=(20 * mm, 20 * mm)), value=(0.1, 0, -0.2))
    setup = setup_of([vs.Gravity(), force])
    model = BrickModel.of(setup, split=split, nodes=nodes)
    np.testing.assert_allclose(model.nodes[model.vertex_nodes], setup.mesh.vertices, atol=1e-12)
    weight = -1070 * 2e-6 * 9.81
    np.testing.assert_allclose(model.weights.sum(axis=0), [0, 0, weight], atol=1e-12)
    np.testing.assert_allclose(model.forces.sum(axis=0), [0.1, 0, -0.2], atol=1e-12)
    # A force shared by the end face stays on it, and its line of action does not move.
    np.testing.assert_allclose(model.nodes[model.forces.any(axis=1), 0], 20 * mm)
    share = model.forces[:, 2] / -0.2
    np.testing.assert_allclose(share @ model.nodes, [20 * mm, 5 * mm, 5 * mm], atol=1e-12)


@pytest.mark.parametrize("split", [1, 2, 3])
def test_held_vertices_do_not_depend_on_the_split(split):
    model = BrickModel.of(setup_of([vs.Gravity()]), split=split)
    held = model.fixed.all(axis=1)
    np.testing.assert_array_equal(held, model.nodes[:, 0] <= 5 * mm + 1e-9)


@pytest.mark.parametrize("split", [1, 2])
@pytest.mark.parametrize("nodes", [8, 20, 27])
def test_a_traction_sums_to_its_area_and_stays_on_its_face(split, nodes):
    end = vs.Region(x=(20 * mm, 20 * mm))
    setup = setup_of([vs.Traction(region=end, value=(0, 0, 2 * kPa))])
    model = BrickModel.of(setup, split=split, nodes=nodes)
    assert model.forces[:, 2].sum() == pytest.approx(2 * kPa * 100 * mm**2)
    np.testing.assert_allclose(model.nodes[model.forces.any(axis=1), 0], 20 * mm)


@pytest.mark.parametrize("split", [1, 2])
def test_pressed_faces_cover_the_cavity_and_look_into_it(split):
    setup = Setup.of(families.cylinder())
    model = BrickModel.of(setup, split=split)
    (load,) = model.pressures
    assert len(load.faces) * model.edge**2 == pytest.approx(setup.mesh.cavities[0].area)
    nodes = model.face_nodes(load.faces)
    middle = model.nodes[nodes[:, :4]].mean(axis=1)
    inside = model.nodes[model.bricks[load.faces[:, 0], :8]].mean(axis=1)
    outward = middle - inside
    # The divergence theorem: outward faces of the solid enclose minus the cavity's volume.
    enclosed = -(middle * outward / (model.edge / 2)).sum() * model.edge**2 / 3
    assert enclosed == pytest.approx(setup.mesh.cavities[0].volume)


def test_prescribed_motion_is_interpolated():
    clamps = [
        vs.Clamp(region=vs.Region(x=(0, 0))),
        vs.Clamp(
            region=vs.Region(x=(20 * mm, 20 * mm)),
            motion=vs.Motion(
                displacement=(0, 0, 1 * mm), rotation=vs.Rotation(axis=(1, 0, 0), angle="90 deg")
            ),
        ),
    ]
    model = BrickModel.of(setup_of([], clamps), split=2)
    end = np.flatnonzero(model.fixed[:, 0] & (model.nodes[:, 0] > 10 * mm))
    x, y, z = model.nodes[end].T
    expected = np.column_stack((0 * x, -z - y, y - z + 1 * mm))
    np.testing.assert_allclose(model.values[end], expected, atol=1e-12)


@pytest.mark.parametrize("split", [1, 2])
@pytest.mark.parametrize("nodes", [8, 20])
@pytest.mark.parametrize("level", [0.0, 5 * mm])
def test_layers_cover_their_faces_with_their_weight(split, nodes, level):
    film = vs.Layer(
        region=vs.Region(z=(level, level)), young=50e6, thickness=0.1 * mm, density=2000.0
    )
    model = BrickModel.of(setup_of([vs.Gravity()], layers=[film]), split=split, nodes=nodes)
    (layer,) = model.layers
    corners = model.nodes[model.face_nodes(layer.faces)]
    assert len(layer.faces) * model.edge**2 == pytest.approx(20 * mm * 10 * mm)
    np.testing.assert_allclose(corners[..., 2], level, atol=1e-12)
    mass = 1070 * 2e-6 + 2000 * 0.1 * mm * 2e-4
    np.testing.assert_allclose(model.weights.sum(axis=0), [0, 0, -9.81 * mass], atol=1e-12)


def test_the_code_with_scikit_fem_refuses_layers():
    pytest.importorskip("skfem")
    film = vs.Layer(region=vs.Region(z=(0, 0)), young=50e6, thickness=0.1 * mm)
    with pytest.raises(SimulationError, match="layers: are not known to the code with scikit-fem"):
        run_scikit_fem(BrickModel.of(setup_of([], layers=[film]), nodes=27))


@pytest.mark.parametrize("contact", [None, Contact(friction=0.4)])
def test_a_floor_is_a_plane_below_the_body(contact):
    setup = setup_of([vs.Gravity()], floor=vs.Floor(z=-0.01), contact=contact)
    model = BrickModel.of(setup)
    (floor,) = model.contact.tools
    assert (floor.name, floor.friction) == ("floor", 0.0 if contact is None else 0.4)
    a, b, c = floor.vertices[floor.triangles].transpose(1, 0, 2)
    assert (np.cross(b - a, c - a)[:, 2] > 0.0).all()
    np.testing.assert_allclose(floor.vertices[:, 2], -0.01)
    low, high = floor.vertices.min(axis=0), floor.vertices.max(axis=0)
    assert (low[:2] < model.nodes.min(axis=0)[:2]).all()
    assert (high[:2] > model.nodes.max(axis=0)[:2]).all()
    pytest.importorskip("skfem")
    with pytest.raises(SimulationError, match="floor: is not known to the code with scikit-fem"):
        run_scikit_fem(BrickModel.of(setup, nodes=27))


def test_the_deck_refuses_bricks_of_another_element():
    with pytest.raises(SimulationError, match="C3D20R has 20 nodes"):
        calculix_deck(BrickModel.of(setup_of([]), nodes=8))


def test_printed_blocks_that_break_off_keep_complete_rows():
    head = " displacements (vx,vy,vz) for set {} and time  {}\n\n"
    rows = "         1  1.0E+00  0.0E+00  2.0E-01\n         2  1.0E+00 -1.0-100  2.0E-01\n"
    text = head.format("A", "0.5") + rows + "\n" + head.format("A", "1.0") + rows[:50]
    first, second = read_printed(text)
    assert (first.time, second.time) == (0.5, 1.0)
    assert (len(first.nodes), len(second.nodes)) == (2, 1)
    assert first.values[1, 1] == -1e-100
    assert read_printed("*ERROR in something\n 1 2 3 4\n") == []


MODELS = {
    "neo-hookean": [8e3],
    "mooney-rivlin": [8e3, 2e3],
    "yeoh": [8e3, -2e2, 3e2],
    "ogden": [24e3, 1.7, 67.0, 7.1, 454.0, -3.4],
    "gent": [20e3, 30.0],
}


@pytest.mark.parametrize("name", MODELS)
def test_derivatives_by_stretches_are_those_of_the_energy(name):
    terms = terms_of(name, MODELS[name])
    stretches = np.array([1.7, 0.8, 0.95])
    step = 1e-5
    _, gradient, hessian = stretch_derivatives(terms, stretches)
    for axis in range(3):
        shift = step * np.eye(3)[axis]
        above, below = (stretch_derivatives(terms, stretches + s * shift) for s in (1, -1))
        # Central differences: an error of about step² times the third derivative, 1e-9 of it.
        assert (above[0] - below[0]) / (2 * step) == pytest.approx(gradient[axis], rel=1e-6)
        np.testing.assert_allclose(
            (above[1] - below[1]) / (2 * step), hessian[axis], rtol=1e-6, atol=1e-4
        )


@pytest.mark.parametrize("name", MODELS)
def test_energies_are_those_of_the_library(name):
    """The uniaxial stress of an incompressible bar, from this energy and from the library's."""
    models = {
        "neo-hookean": vs.NeoHookean(young=6 * 8e3, poisson=0.4999999),
        "mooney-rivlin": vs.MooneyRivlin(c10=8e3, c01=2e3),
        "yeoh": vs.Yeoh(c=(8e3, -2e2, 3e2)),
        "ogden": vs.Ogden(mu=(24e3, 67.0, 454.0), alpha=(1.7, 7.1, -3.4)),
        "gent": vs.Gent(shear=20e3, jm=30.0),
    }
    for stretch in (0.7, 1.3, 2.5):
        sides = np.array([stretch, stretch**-0.5, stretch**-0.5])
        _, slope, _ = stretch_derivatives(terms_of(name, MODELS[name]), sides)
        nominal = slope[0] - slope[1] * sides[1] / sides[0]
        expected = vs.materials.nominal_stress(models[name], stretch)
        assert nominal == pytest.approx(float(expected), rel=1e-6)
