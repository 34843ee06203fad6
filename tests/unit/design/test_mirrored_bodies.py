"""Bodies mirrored, turned and moved: the entries of their designs go along."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import (
    Body,
    Clamp,
    Design,
    Force,
    Layer,
    Motion,
    Part,
    Pressure,
    Probe,
    Region,
    Rotation,
    Spring,
)
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.design.isometry import Isometry
from voxsoft.errors import DesignError
from voxsoft.files import load
from voxsoft.materials import Fiber
from voxsoft.shapes import Box, Difference, Union
from voxsoft.units import kPa, mm

RUBBER = {"model": "neo-hookean", "young": "100 kPa", "poisson": 0.4}
LATTICE = {"model": "lattice", "edge": "60 kPa", "bulk": "400 kPa"}


def hook(material=RUBBER, fibers=()):
    """Something unlike all of its mirror images, with one of everything that a design says."""
    return Design(
        name="hook",
        voxel_size=2 * mm,
        shapes={
            "bar": Box(size=(20 * mm, 8 * mm, 8 * mm), corner=(2 * mm, 2 * mm, 0)),
            "tooth": Box(size=(6 * mm, 12 * mm, 4 * mm), corner=(14 * mm, 2 * mm, 4 * mm)),
            "hole": Box(size=(6 * mm, 4 * mm, 4 * mm), corner=(6 * mm, 4 * mm, 2 * mm)),
            "whole": Union(of=("bar", "tooth")),
            "body": Difference(of=("whole", "hole")),
        },
        parts=[Part(shape="body", material=material, fibers=fibers)],
        layers=[Layer(region=Region(z=(0, 0), shape="bar"), young="1 MPa", thickness="0.1 mm")],
        springs=[
            Spring(
                at=Probe(center=(20 * mm, 12 * mm, 6 * mm), radius=3 * mm),
                anchor=(30 * mm, 20 * mm, 10 * mm),
                stiffness="5 N/m",
                length="5 mm",
            )
        ],
        clamps=[
            Clamp(
                region=Region(x=(0, 2 * mm)),
                motion=Motion(
                    displacement=(0.2 * mm, 0.3 * mm, 0.1 * mm),
                    rotation=Rotation(axis=(1, 0.5, 0.2), angle="5 deg", center=(0, 5 * mm, 0)),
                ),
            )
        ],
        loads=[
            Pressure(value=1 * kPa, cavity="air"),
            Force(region=Region(x=(21 * mm, 23 * mm)), value=("1 mN", "2 mN", "3 mN")),
        ],
        chambers={"air": {"point": (8 * mm, 6 * mm, 4 * mm)}},
        probes={"tip": Probe(point=(18 * mm, 12 * mm, 6 * mm))},
    )


def alone(inner, **pose):
    return Design(name="one", voxel_size=2 * mm, bodies=[Body(name="it", design=inner, **pose)])


def frame(body):
    """From the design of a body to where it is: a matrix, and a shift."""
    rotation, position = body.pose
    return rotation @ Isometry.mirror(body.mirror).matrix if body.mirror else rotation, position


def order(vertices, among):
    """Indices of some vertices among others, which are the same but for their order."""
    keys = {tuple(np.rint(at / 1e-9).astype(int)): i for i, at in enumerate(among)}
    return np.array([keys[tuple(np.rint(at / 1e-9).astype(int))] for at in vertices])


@pytest.mark.parametrize("axis", ["x", "y", "z"])
@pytest.mark.parametrize("material", [RUBBER, LATTICE], ids=["rubber", "lattice"])
def test_the_mesh_of_a_mirror_image_is_the_mirror_image_of_the_mesh(axis, material):
    mesh, image = mesh_of(alone(hook(material))), mesh_of(alone(hook(material), mirror=axis))
    assert len(mesh.vertices) == len(image.vertices)
    there = order(mesh.vertices @ Isometry.mirror(axis).matrix, image.vertices)
    edges = {tuple(sorted(edge)) for edge in there[mesh.edges].tolist()}
    assert edges == {tuple(sorted(edge)) for edge in image.edges.tolist()}
    # Not the same body, or this test could not fail.
    assert not np.allclose(np.sort(mesh.vertices, axis=0), np.sort(image.vertices, axis=0))


@pytest.mark.parametrize("axis", ["x", "y"])
def test_the_state_of_a_mirror_image_is_the_mirror_image_of_the_state(axis):
    wound = Fiber(axis=(1, 2, 0), angle="30 deg", center=(0, 0, "-40 mm"), modulus="200 kPa")
    inner = hook(fibers=[Fiber(direction=(1, 0.7, 0.3), modulus="200 kPa"), wound])
    state, image = vs.simulate(alone(inner)), vs.simulate(alone(inner, mirror=axis))
    mirror = Isometry.mirror(axis).matrix
    there = order(state.mesh.vertices @ mirror, image.mesh.vertices)
    moved = (state.positions - state.mesh.vertices) @ mirror
    largest = np.abs(moved).max()
    assert largest > 1 * mm
    found = (image.positions - image.mesh.vertices)[there]
    # Both are at rest to a residual of 1e-6 of their loads or less; displacements follow that.
    assert found == pytest.approx(moved, abs=1e-5 * largest)
    [[name, chamber]] = [(each.name, each) for each in image.mesh.cavities]
    assert name == "it.air"
    assert chamber.volume == pytest.approx(state.mesh.cavities[0].volume)


def test_the_fibers_of_a_mirror_image_are_mirrored():
    wound = Fiber(axis=(0, 1, 0), angle=0.5, center=(0, 1, 2), modulus="200 kPa")
    inner = hook(fibers=[Fiber(direction=(1, 2, 3), modulus="200 kPa"), wound])
    [part] = alone(inner, mirror="y").assembled.parts
    straight, image = part.fibers
    assert straight.direction == (1.0, -2.0, 3.0)
    assert (image.axis, image.angle, image.center) == ((0.0, -1.0, 0.0), -0.5, (0.0, -1.0, 2.0))
    assert part.name == "it.body"


def test_a_design_of_several_bodies_is_mirrored_whole():
    turned = Rotation(axis=(1, 2, 3), angle="40 deg", center=(1 * mm, 0, 0))
    pair = Design(
        name="pair",
        voxel_size=2 * mm,
        bodies=[
            Body(name="a", design=hook(), position=(0, 0, 50 * mm)),
            Body(name="b", design=hook(), mirror="z", rotation=turned, position=(0, 60 * mm, 0)),
        ],
    )
    outer = Rotation(axis=(0, 0, 1), angle="25 deg")
    mesh, image = mesh_of(alone(pair, rotation=outer)), mesh_of(alone(pair, mirror="x"))
    turn = Isometry.turn(outer.axis, -outer.angle)
    order(mesh.vertices @ turn.matrix.T @ Isometry.mirror("x").matrix, image.vertices)


def test_bodies_are_copied_in_mirrors_and_around_axes():
    inner = hook().replace(clamps=[Clamp(region=Region(x=(0, 2 * mm)))])
    pose = {
        "rotation": Rotation(axis=(1, 1, 0), angle="30 deg", center=(5 * mm, 0, 0)),
        "position": (40 * mm, 0, 3 * mm),
        "motion": Motion(displacement=(1 * mm, 0, 2 * mm)),
    }
    for mirror in (None, "y"):
        first = Body(name="it", design=inner, mirror=mirror, **pose)
        mesh = mesh_of(Design(name="one", voxel_size=2 * mm, bodies=[first]))
        for axis in ("x", "y", "z"):
            image = first.mirrored("image", axis, 7 * mm)
            other = mesh_of(Design(name="other", voxel_size=2 * mm, bodies=[image]))
            there = Isometry.mirror(axis, 7 * mm)
            order(mesh.vertices @ there.matrix.T + there.shift, other.vertices)
            assert image.motion.displacement == there.vector((1 * mm, 0, 2 * mm))
            # Twice is not at all, whichever axis of the body is mirrored.
            back = image.mirrored("it", axis, 7 * mm)
            for once, twice in zip(frame(first), frame(back), strict=True):
                # Through two pairs of axis and angle: a few units in the last place.
                assert twice == pytest.approx(once, abs=1e-14)
        center = (1 * mm, 2 * mm, 3 * mm)
        copies = first.arranged(["two", "three"], (0, 0, 2), center)
        assert [copy.name for copy in copies] == ["it", "two", "three"]
        for number, copy in enumerate(copies):
            other = mesh_of(Design(name="other", voxel_size=2 * mm, bodies=[copy]))
            there = Isometry.turn((0, 0, 1), number * 2 * np.pi / 3, center)
            order(mesh.vertices @ there.matrix.T + there.shift, other.vertices)


def test_entries_that_cannot_be_mirrored_are_refused_by_name(tmp_path):
    with pytest.raises(DesignError, match="mirror: is for the design of a body"):
        Body(name="pad", parts=[Part(shape="a", material="dragon-skin-10")], mirror="x")
    (tmp_path / "hook.toml").write_text(hook().to_toml())
    text = 'name = "two"\nvoxel_size = "2 mm"\n[[bodies]]\nname = "a"\ndesign = "hook.toml"\n'
    file = tmp_path / "two.toml"
    file.write_text(f'{text}mirror = "w"\n')
    with pytest.raises(DesignError, match=r"bodies\[0\].mirror"):
        load(file)
    file.write_text(f'{text}mirror = "y"\n')
    assert load(file).bodies[0].mirror == "y"
    assert 'mirror = "y"' in load(file).to_toml()
