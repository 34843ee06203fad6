"""Bonded pairs: hanging bodies, bonds that let go, refusals; objects that are separated."""

import json

import numpy as np
import pytest
from gripped import GRAVITY
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import Contact, Object, Solver
from voxsoft.errors import DesignError
from voxsoft.files import save
from voxsoft.simulation import simulate
from voxsoft.units import kPa, mm

SOFT = vs.NeoHookean(young=100 * kPa, poisson=0.45, density=1000)
SIDE = 12 * mm
MASS = 0.02


def ceiling(center, pair, motion="free", **changes):
    """A block that hangs from its top, and a smaller one below it."""
    weight = Object(
        name="weight",
        shape=vs.Box(size=(8 * mm, 8 * mm, 6 * mm), center=center),
        motion=motion,
        mass=MASS if motion == "free" else None,
        voxel_size=2 * mm,
    )
    whole = {
        "name": "ceiling",
        "voxel_size": 3 * mm,
        "parts": [vs.Part(shape=vs.Box(size=(SIDE, SIDE, SIDE)), material=SOFT)],
        "clamps": [vs.Clamp(region=vs.Region(z=(SIDE, SIDE)))],
        "loads": [vs.Gravity()],
        "objects": [weight],
        "contact": Contact(friction=0.5, pairs=[{"of": ["weight", "body"]} | pair]),
        "solver": Solver(method="statics"),
        "probes": {"tip": vs.Probe(z=(0, 0))},
    }
    return vs.Design(**(whole | changes))


BELOW = (6 * mm, 6 * mm, -3 * mm)


@pytest.mark.long
@pytest.mark.parametrize("gap", [0.0, 0.5 * mm, -0.5 * mm])
def test_a_bonded_object_hangs(gap):
    center = (6 * mm, 6 * mm, -3 * mm - gap)
    hanging = simulate(ceiling(center, {"kind": "bonded"}))
    assert (hanging.status, hanging.stable) == ("ok", True)
    (contact,) = hanging.contacts
    assert contact.of == ("body", "weight")
    assert contact.force == pytest.approx((0, 0, -MASS * GRAVITY), abs=1e-6 * MASS * GRAVITY)
    # The force over the weight, to half of the voxels' parts.
    assert contact.bonded == pytest.approx((8 * mm) ** 2, rel=0.5)
    assert contact.area == contact.bonded == hanging.summary()["contacts"][0]["bonded"]
    # The gap at rest stays: the weight goes down as the face does.
    fallen = center[2] - hanging.objects["weight"].position[2]
    assert fallen == pytest.approx(-hanging.probes["tip"][2], rel=0.3)
    assert 0.0 < fallen < 1 * mm


def test_over_time_it_hangs_too():
    swinging = simulate(
        ceiling(BELOW, {"kind": "bonded"}), method="dynamics", damping="critical", time_step="5 ms"
    )
    hanging = simulate(ceiling(BELOW, {"kind": "bonded"}))
    assert swinging.status == "ok"
    ends = [run.objects["weight"].position[2] for run in (swinging, hanging)]
    assert ends[0] == pytest.approx(ends[1], abs=1e-3 * mm)


@pytest.mark.slow
def test_a_weak_bond_lets_its_weight_fall():
    area = simulate(ceiling(BELOW, {"kind": "bonded"})).contacts[0].area
    mean = MASS * GRAVITY / area
    # The traction is larger at the rim of a rigid part.
    strong = simulate(ceiling(BELOW, {"kind": "bonded", "strength": 5 * mean}))
    assert strong.status == "ok"
    assert strong.contacts[0].bonded == pytest.approx(area)
    weak = simulate(ceiling(BELOW, {"kind": "bonded", "strength": 0.9 * mean}))
    assert weak.status == "not-at-rest"
    assert 'the object "weight" falls' in weak.message
    assert weak.contacts == ()


@pytest.mark.parametrize(
    ("center", "pair", "message"),
    [
        (
            (6 * mm, 6 * mm, -6 * mm),
            {"kind": "bonded"},
            r'contact.pairs\[0\]: bonds "body" and "weight", which are 3 mm apart',
        ),
        (BELOW, {"strength": "1 kPa"}, r'strength: is that of a bond, and the kind is "touching"'),
        (BELOW, {"kind": "bonded", "friction": 0.4}, "friction: is not used by what does not"),
        (BELOW, {"kind": "bonded", "of": ["body", "body"]}, "is one thing, and is not bonded"),
        (BELOW, {"kind": "bonded", "strength": "-1 kPa"}, "strength"),
        (BELOW, {"friction": -0.1}, "friction"),
        ((6 * mm, 6 * mm, -1 * mm), {"kind": "bonded"}, "is 2 mm deep in the body"),
    ],
)
def test_bonds_that_cannot_be_are_refused(center, pair, message):
    with pytest.raises(DesignError, match=message):
        simulate(ceiling(center, pair))


def test_held_things_are_not_bonded_to_each_other():
    post = Object(name="post", shape=vs.Box(size=(8 * mm, 8 * mm, 8 * mm), center=(0.1, 0, 0)))
    design = ceiling(BELOW, {}, motion="fixed")
    pairs = [{"of": ["weight", "post"], "kind": "bonded"}]
    with pytest.raises(DesignError, match="are held or moved, both of them"):
        design.replace(objects=[*design.objects, post], contact=Contact(pairs=pairs))


def test_objects_are_separated_where_that_is_asked(tmp_path):
    deep = ceiling((6 * mm, 6 * mm, -2 * mm), {}, motion="fixed")
    with pytest.raises(DesignError, match=r"is 1 mm deep .* or write separate = true"):
        simulate(deep)
    apart = deep.replace(contact=Contact(separate=True))
    save(apart, tmp_path / "apart.toml")
    ended = CliRunner().invoke(
        app, ["run", str(tmp_path / "apart.toml"), "--json", "--error", "off"]
    )
    assert ended.exit_code == 0, ended.output
    summary = json.loads(ended.stdout)
    (warning,) = (each for each in summary["warnings"] if each["where"] == "objects[0]")
    assert warning["what"].endswith("moved out of it by (0, 0, -1) mm")
    assert np.allclose(summary["objects"]["weight"]["position"], BELOW, atol=1e-5 * mm)
