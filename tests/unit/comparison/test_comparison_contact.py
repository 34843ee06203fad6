"""Contact as an outside code is given it: walls that look at each other, objects, refusals."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.comparison.brick_contact import facing_walls, passed_through
from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.calculix_contact import shell_of
from voxsoft.comparison.calculix_deck import calculix_deck
from voxsoft.comparison.calculix_output import read_totals
from voxsoft.comparison.cautions import cautions_of_contact
from voxsoft.comparison.scikit_fem import run_scikit_fem
from voxsoft.design import Contact, ContactPair, Object
from voxsoft.errors import SimulationError
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

PLATE = Object(
    name="plate",
    shape=vs.Box(size=(20 * mm, 20 * mm, 4 * mm), center=(10 * mm, 10 * mm, 12 * mm)),
    motion=vs.Motion(displacement=(0, 0, -1 * mm)),
    voxel_size=2 * mm,
)


def slit_block(objects=(), **changes):
    """A block of 20 x 10 x 10 mm with a slit of 5 mm from above, voxels of 5 mm."""
    block = vs.Box(size=(20 * mm, 10 * mm, 10 * mm))
    slit = vs.Box(size=(5 * mm, 10 * mm, 5 * mm), corner=(5 * mm, 0, 5 * mm))
    rubber = vs.NeoHookean(young=100 * kPa, poisson=0.45)
    design = {
        "name": "slit",
        "voxel_size": 5 * mm,
        "parts": [vs.Part(shape=block - slit, material=rubber)],
        "clamps": [vs.Clamp(region=vs.Region(z=(0, 0)))],
        "objects": objects,
        "contact": Contact(),
    }
    return vs.Design(**(design | changes))


@pytest.mark.parametrize("split", [1, 2])
def test_the_walls_of_a_slit_are_a_pair(split):
    setup = Setup.of(slit_block())
    model = BrickModel.of(setup, split=split)
    ((left, right),) = model.contact.walls
    for faces, x in ((left, 5 * mm), (right, 10 * mm)):
        assert len(faces) == 2 * split**2
        corners = model.nodes[model.face_nodes(faces)]
        np.testing.assert_allclose(corners[..., 0], x, atol=1e-12)
        assert corners[..., 2].min() == pytest.approx(5 * mm)
    # All faces of the body: those of the block and both walls of the slit.
    area = len(model.contact.outer) * model.edge**2
    assert area == pytest.approx(setup.mesh.voxel_size**2 * len(setup.mesh.triangles) / 2)


def test_a_wall_behind_a_wall_is_no_pair():
    """Three plates behind each other: the outer two do not see each other."""
    plates = np.array([(x, y, z) for x in (0, 2, 4) for y in range(2) for z in range(2)])
    _, walls = facing_walls(plates)
    seen = sorted((int(plates[a[0, 0], 0]), int(plates[b[0, 0], 0])) for a, b in walls)
    assert seen == [(0, 2), (2, 4)]


def test_without_contact_of_the_body_with_itself_there_are_no_walls():
    apart = Contact(pairs=[ContactPair(of=("body", "body"), kind="none")])
    model = BrickModel.of(Setup.of(slit_block([PLATE], contact=apart)))
    assert model.contact.walls == ()
    assert [tool.name for tool in model.contact.tools] == ["plate"]


def test_each_triangle_of_an_object_has_a_tetrahedron_behind_it():
    (tool,) = BrickModel.of(Setup.of(slit_block([PLATE]))).contact.tools
    nodes, tets = shell_of(tool)
    a, b, c, inner = nodes[tets].transpose(1, 0, 2)
    # The order of CalculiX: positive volumes, and the first face looks outward.
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), inner - a) > 0.0).all()
    outward = (a + b + c) / 3 - PLATE.shape.center
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), outward) < 0.0).all()


def test_the_deck_has_each_friction_once():
    rough = Contact(friction=0.3, pairs=[ContactPair(of=("body", "plate"), friction=0.7)])
    deck = calculix_deck(BrickModel.of(Setup.of(slit_block([PLATE], contact=rough))))
    assert deck.count("*SURFACE INTERACTION") == deck.count("*FRICTION\n") == 2
    assert "*CONTACT PAIR, INTERACTION=FRICTION0, TYPE=SURFACE TO SURFACE\nWALL0A, WALL0B" in deck
    assert "*CONTACT PAIR, INTERACTION=FRICTION1, TYPE=SURFACE TO SURFACE\nBODY, TOOL0" in deck
    # The edge of a brick is the unit of length: the plate goes down by a fifth of it.
    assert "TOOL0, 3, 3, -0.2\n" in deck


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"motion": "free", "mass": 0.01}, r"objects\[0\].motion: is free"),
        (
            {"motion": vs.Motion(rotation=vs.Rotation(axis=(0, 0, 1), angle="5 deg"))},
            r"objects\[0\].motion: turns",
        ),
    ],
)
def test_objects_that_cannot_be_written_are_refused(change, where):
    design = slit_block([PLATE.replace(**change)])
    with pytest.raises(SimulationError, match=where):
        BrickModel.of(Setup.of(design))


def test_bonds_are_refused():
    bonded = Contact(pairs=[ContactPair(of=("body", "plate"), kind="bonded")])
    with pytest.raises(SimulationError, match=r"contact.pairs\[0\]: is a bond"):
        BrickModel.of(Setup.of(slit_block([PLATE], contact=bonded)))


def test_so_many_walls_that_no_code_would_end_are_refused():
    columns = np.array([(x, y, 0) for x in range(0, 32, 2) for y in range(0, 32, 2)])
    with pytest.raises(SimulationError, match="480 pairs of walls"):
        facing_walls(columns)


def test_the_code_with_scikit_fem_refuses_contact():
    pytest.importorskip("skfem")
    with pytest.raises(SimulationError, match="contact: is not known"):
        run_scikit_fem(BrickModel.of(Setup.of(slit_block()), nodes=27))


def test_overlapping_bodies_are_named():
    setup = Setup.of(slit_block([PLATE]))
    rest = setup.mesh.vertices
    assert passed_through(setup, rest) == ""  # the plate comes down by 1 mm to the top, no deeper
    through = rest.copy()
    through[rest[:, 0] <= 5 * mm] += (7 * mm, 1 * mm, 0)
    assert "deep in itself" in passed_through(setup, through)
    raised = rest + (0, 0, 2 * mm) * (rest[:, 2:] > 7 * mm)
    assert 'deep in "plate"' in passed_through(setup, raised)


def test_a_smooth_surface_that_is_not_that_of_the_voxels_is_a_warning():
    assert not list(cautions_of_contact(Setup.of(slit_block())))
    ball = vs.Part(shape=vs.Sphere(radius=12 * mm), material=vs.NeoHookean(young=100 * kPa))
    held = [vs.Clamp(region=vs.Region(z=(-12 * mm, -8 * mm)))]
    (warning,) = cautions_of_contact(Setup.of(slit_block(parts=[ball], clamps=held)))
    assert warning.where == "contact.surface"
    stairs = Contact(surface="voxels")
    assert not list(
        cautions_of_contact(Setup.of(slit_block(parts=[ball], clamps=held, contact=stairs)))
    )


def test_totals_of_sets_and_surfaces_are_read():
    text = (
        " statistics for slave set WALL0A, master set WALL0B and time  0.1000000E+01\n\n"
        "   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)\n\n"
        "    1.0E+00  0.0E+00 -2.0E+00  5.0E+00  6.0E+00  7.0E+00\n\n"
        "   center of gravity and mean normal\n\n             NaN NaN NaN NaN NaN NaN\n\n"
        " total force (fx,fy,fz) for set TOOL0 and time  0.1000000E+01\n\n"
        "        3.0E+00  4.0E+00  1.0-101\n"
    )
    found = read_totals(text)
    assert found["WALL0A", 1.0].tolist() == [1.0, 0.0, -2.0]
    assert found["TOOL0", 1.0].tolist() == [3.0, 4.0, 1e-101]
