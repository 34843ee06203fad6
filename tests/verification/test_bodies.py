"""A body that is turned and moved with all that loads it gives the turned answer.

Voxels measure strain along their own edges, so that nothing in the answer depends on how they lie:
the two solutions differ by rounding and by what Newton's method leaves, 1e-9 of the load at most.
"""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import (
    Body,
    Chamber,
    Clamp,
    Contact,
    Design,
    Force,
    Gravity,
    Layer,
    Motion,
    Part,
    Pressure,
    Probe,
    Region,
    Rotation,
    Solver,
    Spring,
    Traction,
)
from voxsoft.geometry import rotation_matrix
from voxsoft.materials import Fiber, Lattice, NeoHookean
from voxsoft.units import kPa, mm

AXIS, ANGLE, AWAY = (1.0, 2.0, 0.5), 1.1, (30 * mm, -20 * mm, 50 * mm)
R = rotation_matrix(AXIS, ANGLE)
RUBBER = NeoHookean(young=100 * kPa, poisson=0.45)
#: Of the largest displacement: rounding of positions, 1e-17 m of 1e-3 m, by the condition of a
#: slender body (1e4), with room for what Newton's method leaves.
EXACT = 1e-9


def turned(vector):
    """A direction as the turned body has it."""
    return tuple((R @ np.asarray(vector)).tolist())


def bar(**entries):
    given = {
        "name": "bar",
        "voxel_size": 2 * mm,
        "shapes": {"bar": vs.Box(size=(20 * mm, 6 * mm, 4 * mm))},
        "parts": [Part(shape="bar", material=RUBBER)],
        "clamps": [Clamp(region=Region(x=(0, 0)))],
        "probes": {"tip": Probe(x=(20 * mm, 20 * mm)), "point": Probe(point=(13 * mm, 2 * mm, mm))},
        "solver": Solver(method="statics"),
    }
    return Design(**{**given, **entries})


def placed(design, **entries):
    """A design of one body, which is turned and moved."""
    body = Body(
        name="left", design=design, rotation=Rotation(axis=AXIS, angle=ANGLE), position=AWAY
    )
    return Design(name="one", voxel_size=1.0, bodies=[body], **entries)


def compare(alone, moved, tolerance=EXACT):
    """All vertices and probes of two results, one in the frame of the other's body."""
    assert alone.status == moved.status == "ok"
    size = np.abs(alone.displacements).max()
    assert size > 1e-4
    assert np.abs(alone.displacements @ R.T - moved.displacements).max() < tolerance * size
    for name, way in alone.probes.items():
        assert np.abs(R @ way - moved.probes[f"left.{name}"]).max() < tolerance * size
    for name in ("max_stress", "max_stretch", "elastic_energy", "mass", "reaction"):
        assert moved.metrics[name] == pytest.approx(alone.metrics[name], rel=1e-6)


DOWN = Gravity(value=20.0)


@pytest.mark.parametrize(
    "entries",
    [
        {},
        {"fill": "fraction", "shapes": {"bar": vs.Box(size=(19 * mm, 5.3 * mm, 3.1 * mm))}},
        {
            "parts": [
                Part(
                    shape="bar",
                    material=RUBBER,
                    fibers=[Fiber(direction=(1, 1, 0), modulus=200 * kPa)],
                )
            ]
        },
        {"parts": [Part(shape="bar", material=Lattice(edge="20 kPa", bulk="60 kPa"))]},
    ],
    ids=["rubber", "cut voxels", "fibers", "lattice"],
)
def test_gravity(entries):
    clamps = [Clamp(region=Region(x=(0, 0)))]
    alone = bar(loads=[DOWN], clamps=clamps, **entries)
    if "fill" in entries:
        alone = alone.replace(probes={"tip": Probe(x=(19 * mm, 19 * mm))})
    down = Gravity(value=20.0, direction=turned((0, 0, -1)))
    moved = placed(alone.replace(loads=[]), loads=[down], solver=alone.solver)
    compare(vs.simulate(alone), vs.simulate(moved))


def test_loads_springs_and_clamps_of_the_body_come_along():
    """Forces, tractions and pressures of regions, springs, a moved clamp, a layer."""
    end = Region(x=(20 * mm, 20 * mm))
    alone = bar(
        clamps=[
            Clamp(
                region=Region(x=(0, 0)),
                motion=Motion(
                    displacement=(0, mm, 0),
                    rotation=Rotation(axis=(0, 1, 1), angle="5 deg", center=(mm, 0, 0)),
                ),
            )
        ],
        layers=[Layer(region=Region(z=(0, 0)), young="1 MPa", thickness="0.1 mm")],
        springs=[
            Spring(
                at=Probe(point=(15 * mm, 3 * mm, 2 * mm)),
                anchor=(15 * mm, 20 * mm, 9 * mm),
                stiffness="5 N/m",
            ),
            Spring(at=Probe(point=(5 * mm, 3 * mm, 2 * mm)), to=Probe(**dict(end)), stiffness=3.0),
        ],
        loads=[
            Force(region=end, value=(0, 3e-3, -5e-3)),
            Traction(region=end, value=(50.0, 0, 20.0)),
            Traction(region=Region(z=(4 * mm, 4 * mm)), value=100.0),
        ],
    )
    moved = placed(alone, solver=alone.solver)
    assert [load.kind for load in moved.assembled.loads] == ["force", "traction", "traction"]
    compare(vs.simulate(alone), vs.simulate(moved))


def test_pressure_in_chambers_that_layers_close():
    shell = vs.Box(size=(12 * mm, 12 * mm, 8 * mm)) - vs.Box(
        size=(6 * mm, 6 * mm, 6 * mm), corner=(3 * mm, 3 * mm, 0)
    )
    film = Layer(region=Region(z=(0, 0)), young="1 MPa", thickness="0.2 mm", seal=True)
    alone = bar(
        voxel_size=1.5 * mm,
        shapes={"bar": shell},
        layers=[film],
        chambers={"inner": Chamber(point=(6 * mm, 6 * mm, 3 * mm))},
        loads=[Pressure(value="2 kPa", cavity="inner")],
        probes={"tip": Probe(z=(8 * mm, 8 * mm)), "point": Probe(point=(6 * mm, 6 * mm, 7.5 * mm))},
        # The default residual of 1e-8 moves so soft a film by 3e-9 of the largest displacement.
        solver=Solver(method="statics", tolerance=1e-11),
    )
    moved = placed(alone, solver=alone.solver)
    first, second = vs.simulate(alone), vs.simulate(moved)
    assert [cavity.name for cavity in second.mesh.cavities] == ["left.inner"]
    compare(first, second)
    volume = first.metrics["cavity_volume"]
    assert second.metrics["cavity_volume"] == pytest.approx(volume, rel=1e-9)


def test_a_floating_clamp_along_one_axis_follows_a_quarter_turn():
    alone = bar(
        clamps=[
            Clamp(region=Region(x=(0, 0))),
            Clamp(region=Region(x=(20 * mm, 20 * mm)), axes="z"),
        ],
        loads=[Force(region=Region(x=(10 * mm, 10 * mm)), value=(0, 4e-3, 5e-3))],
    )
    quarter = Rotation(axis=(1, 0, 0), angle="90 deg")
    body = Body(name="left", design=alone, rotation=quarter, position=AWAY)
    moved = Design(name="one", voxel_size=1.0, bodies=[body], solver=alone.solver)
    assert moved.assembled.clamps[1].axes == "y"
    first, second = vs.simulate(alone), vs.simulate(moved)
    turn = rotation_matrix((1, 0, 0), np.pi / 2)
    size = np.abs(first.displacements).max()
    assert np.abs(first.displacements @ turn.T - second.displacements).max() < EXACT * size


def pair(friction=0.0, **entries):
    """A rounded block that is pressed from above by a slab of other voxels."""
    block = vs.RoundedBox(size=(8 * mm, 8 * mm, 6 * mm), radius=2 * mm)
    slab = vs.Box(size=(12 * mm, 12 * mm, 3 * mm))
    below = Motion(displacement=(0, 0, -0.5 * mm))
    given = {
        "name": "pair",
        "voxel_size": 2 * mm,
        "bodies": [
            Body(name="block", parts=[Part(shape=block, material=RUBBER)]),
            Body(
                name="slab",
                voxel_size=1.5 * mm,
                position=(-2.13 * mm, -1.79 * mm, 6 * mm),
                parts=[Part(shape=slab, material=RUBBER)],
            ),
        ],
        "clamps": [
            Clamp(region=Region(body="block", z=(0, 0))),
            Clamp(region=Region(body="slab", z=(3 * mm, 3 * mm)), motion=below),
        ],
        "probes": {"inside": Probe(body="block", point=(4 * mm, 4 * mm, 4 * mm))},
        "contact": Contact(friction=friction),
    }
    return Design(**{**given, **entries})


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_two_bodies_that_touch(friction):
    alone = pair(friction)
    nested = placed(alone.replace(contact=None), contact=alone.contact)
    assert nested.body_names == ("left.block", "left.slab")
    first, second = vs.simulate(alone), vs.simulate(nested)
    assert first.status == second.status == "ok"
    (one,), (other,) = first.contacts, second.contacts
    assert one.of == ("block", "slab")
    assert other.of == ("left.block", "left.slab")
    # Contact is settled where no sample is deeper than nine tenths of the clearance, 1e-4 voxels of
    # the smaller size, 1.5 mm: over a way of 0.5 mm.
    settled = 0.9e-4 * 1.5 / 0.5
    assert np.abs(R @ one.force - other.force).max() < settled * one.pressed
    size = np.abs(first.displacements).max()
    assert np.abs(first.displacements @ R.T - second.displacements).max() < settled * size


def test_the_forces_of_two_bodies_balance():
    """The clamps of the block and of the slab each carry the force of the slab."""
    result = vs.simulate(pair())
    (contact,) = result.contacts
    block, slab = (body.vertices for body in result.mesh.bodies)
    # Reactions are right to the residual, at most 1e-3 of what the clamps carry.
    carried = result.reactions[block].sum(axis=0)
    assert carried[2] > 0.0
    assert np.abs(carried + contact.force).max() < 1e-3 * contact.pressed
    assert np.abs(result.reactions[slab].sum(axis=0) - contact.force).max() < 1e-3 * contact.pressed


def test_rims_that_lie_on_each_other_do_not_roll_off():
    """Two mirrored pads face to face bulge by the same: nothing slides, up to the last edge.

    What friction there is is what Newton's method leaves, and the contact is as large as a face.
    """
    length, width, height = 20 * mm, 10 * mm, 10 * mm
    pad = Design(
        name="pad",
        voxel_size=5 * mm,
        parts=[Part(shape=vs.Box(size=(length, width, height)), material=RUBBER)],
        clamps=[Clamp(region=Region(z=(0, 0)))],
    )
    upper = Body(
        name="upper",
        design=pad,
        position=(0, 0, 2 * height + 0.5 * mm),
        mirror="z",
        motion=Motion(displacement=(0, 0, -1.5 * mm)),
    )
    stack = Design(
        name="stack",
        voxel_size=5 * mm,
        bodies=[Body(name="lower", design=pad), upper],
        contact=Contact(friction=0.5),
        solver=Solver(method="statics"),
    )
    result = vs.simulate(stack)
    assert result.status == "ok"
    assert not result.warnings
    (touch,) = result.contacts
    assert touch.force[2] < 0
    assert np.linalg.norm(touch.friction) < 1e-6 * touch.pressure
    assert touch.slipping == 0.0
    assert touch.area == pytest.approx(length * width, rel=1e-9)
