"""A design with planes of symmetry is solved in part; all that is shown of it is of the whole."""

import numpy as np
import pytest
import trimesh
from pressed import RUBBER, SIDE

import voxsoft as vs
from voxsoft import files
from voxsoft.design import Contact, Floor, Object, Symmetry
from voxsoft.files.meshes import read_mesh_file
from voxsoft.plot import plot_body
from voxsoft.plot.body import body_image
from voxsoft.plot.cutout import cutout
from voxsoft.plot.objects import Surroundings
from voxsoft.simulation import Setup
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.outputs.stills import Still
from voxsoft.units import mm

HALF = SIDE / 2
BLOCK = vs.Box(size=(SIDE, SIDE, SIDE), center=(0, 0, HALF))
PLATE = vs.Box(size=(20 * mm, 20 * mm, 4 * mm), center=(0, 0, 14.5 * mm))
DOWN = vs.Motion(displacement=(0, 0, -2 * mm), history=vs.History(time=(0, 0.02), factor=(0, 1)))
QUARTER = vs.Design(
    name="quarter",
    voxel_size=3 * mm,
    parts=[vs.Part(shape=BLOCK, material=RUBBER)],
    clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
    objects=[Object(name="plate", shape=PLATE, motion=DOWN)],
    floor=Floor(z=-0.1 * mm),
    contact=Contact(friction=0.5),
    symmetry=[Symmetry(plane="x"), Symmetry(plane="y")],
    solver=vs.Solver(method="dynamics", time_step=0.005, end_time=0.02),
)


@pytest.fixture(scope="module")
def result():
    found = vs.simulate(QUARTER, frames=True, record_interval="5 ms")
    assert "a quarter of the body" in found.message
    return found


def is_whole(points, widest=None):
    """Check if points are on both sides of both planes, as far away on each."""
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    least = HALF if widest is None else widest
    return np.allclose(low, -high, atol=1e-6) and (high >= least - 1e-6).all()


def test_the_result_and_its_frames_are_of_the_whole(result):
    assert is_whole(result.mesh.vertices)
    assert is_whole(result.positions, 1.02 * HALF)
    assert len(result.recording.frames) > 2
    for frame in result.recording.frames:
        assert frame.shape == result.positions.shape
        assert is_whole(frame)
    pressed = result.contact_field.pressure > 0.0
    assert is_whole(result.mesh.vertices[pressed])


def drawn(figure):
    return np.asarray(figure.axes[0].images[0]._A)[..., :3]


@pytest.mark.long
@pytest.mark.parametrize(
    "field",
    [
        pytest.param("displacement", marks=pytest.mark.slow),
        pytest.param("von_mises", marks=pytest.mark.slow),
        "contact_pressure",
    ],
)
def test_pictures_show_the_whole(result, field):
    picture = drawn(plot_body(result, field, view=(-90.0, 0.0), ghost=False, frame=None))
    shown = (picture < 0.99).any(axis=2)
    # Seen along y, the outline is its own mirror image.
    assert np.mean(shown != shown[:, ::-1]) < 0.01


@pytest.mark.parametrize("view", [(-90.0, 0.0), (0.0, 0.0), (-90.0, 90.0)])
def test_small_pictures_show_the_whole(result, view):
    around = Surroundings.of(result.design, result.objects)
    alpha = cutout(result.mesh, result.positions, view=view, around=around).pixels[..., 3] > 0
    assert np.mean(alpha != alpha[:, ::-1]) < 0.01
    image = (body_image(result, view=view) < 250).any(axis=2)
    assert np.mean(image != image[:, ::-1]) < 0.01


@pytest.mark.parametrize("name", ["x.stl", "x.obj", "x.vtu", "x.msh", "x.inp"])
@pytest.mark.parametrize("deformed", [False, True])
def test_files_hold_the_whole(result, tmp_path, name, deformed):
    run = files.write_run(result, tmp_path / "run")
    target = tmp_path / name
    files.export(run, target, deformed=deformed)
    read = trimesh.load if target.suffix in (".stl", ".obj") else read_mesh_file
    found = read(target)
    vertices = np.asarray(found.mesh.vertices if hasattr(found, "mesh") else found.vertices)
    assert is_whole(vertices, 1.02 * HALF if deformed else None)


def test_the_page_and_bodies_beside_it_show_the_whole(result):
    body = StudioBody.of(QUARTER, rev=1, topology=1)
    event = body.event()
    assert is_whole(np.array(event.bounds))
    assert [plane.axis for plane in event.planes] == [0, 1]
    # An exported page plays all of the body too.
    assert len(body.played.masses) >= len(result.mesh.vertices)
    still = Still(Setup(QUARTER, result.mesh), result.positions, poses=result.objects).packed()
    count = np.frombuffer(still, "<u4", 1, 24)[0]
    assert is_whole(np.frombuffer(still, "<f4", 3 * count, 64).reshape(-1, 3))
