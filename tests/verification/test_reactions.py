"""Reactions hold the loads that were reached, in force and moment: on any way, however far."""

from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.simulation import Setup, simulate
from voxsoft.units import kPa, mm

BENDER = Path(__file__).parents[2] / "examples/bender.toml"
RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.49)
LATTICE = vs.Lattice(edge=60 * kPa, bulk=60 * kPa)
FOOT = vs.Clamp(region=vs.Region(z=(0, 0)))
SIDE = 20 * mm
ALL = {"control": "volume", "volume_ratio": 1.1, "steps": 2}


def block(loads, clamps=(FOOT,), material=RUBBER, **more):
    """A block with a chamber that is not in its middle, so that moments do not vanish."""
    hole = vs.Box(size=(8 * mm, 8 * mm, 12 * mm), corner=(4 * mm, 8 * mm, 4 * mm))
    return vs.Design(
        name="block",
        voxel_size=4 * mm,
        parts=[vs.Part(shape=vs.Box(size=(SIDE, SIDE, SIDE)) - hole, material=material)],
        clamps=clamps,
        loads=loads,
        **more,
    )


WALL = {"x": ["8 mm", "72 mm"], "y": ["8 mm", "8 mm"], "z": ["8 mm", "16 mm"]}
INFLATED = vs.Pressure(value=5 * kPa)
TOP = vs.Region(z=(SIDE, SIDE))
PULLED = vs.Force(region=TOP, value=(0.02, 0.01, 0.05))
PUSHED = vs.Traction(region=TOP, value=2 * kPa)
SHEARED = vs.Traction(region=TOP, value=(100.0, 50.0, 0.0))
TURNED = vs.Clamp(
    region=TOP,
    motion=vs.Motion(rotation=vs.Rotation(axis=(0, 0, 1), angle=0.3, center=(0, 0, 0))),
)
#: Bodies on a floor without friction may slide and turn, and have no one place for statics.
SIDEWAYS = [
    vs.Clamp(region=vs.Region(x=(0, 0), y=(0, 0), z=(0, 0)), axes="xy"),
    vs.Clamp(region=vs.Region(x=(SIDE, SIDE), y=(0, 0), z=(0, 0)), axes="y"),
]
BALLOON = vs.Sphere(radius=15 * mm) - vs.Sphere(radius=10 * mm)
#: Name: the design, its settings, and whether the loads that are reached are those asked for.
CASES = {
    "weight beside a volume": (lambda: block([INFLATED, vs.Gravity(), PULLED]), ALL, False),
    "a pressed top beside a volume": (lambda: block([INFLATED, PUSHED]), ALL, False),
    "shear beside a volume": (lambda: block([INFLATED, SHEARED]), ALL, False),
    "an arc that ends early": (
        lambda: block([vs.Pressure(value=40 * kPa), PULLED]),
        {"control": "arc-length", "steps": 2, "first_step": 0.05},
        False,
    ),
    "an arc to its end": (lambda: block([INFLATED, PULLED]), {"control": "arc-length"}, True),
    "a limit met by load": (
        lambda: vs.Design(
            name="ball",
            voxel_size=5 * mm,
            parts=[vs.Part(shape=BALLOON, material=RUBBER)],
            clamps=[vs.Clamp(region=vs.Region(z=("-inf", -14.9 * mm)))],
            loads=[vs.Pressure(value=15 * kPa), vs.Gravity()],
        ),
        {},
        False,
    ),
    "a turned top": (lambda: block([INFLATED], [FOOT, TURNED]), {}, True),
    "half of a history": (
        lambda: block(
            [
                vs.Pressure(value=5 * kPa, history=vs.History(time=(0, 1), factor=(0, 0.5))),
                vs.Gravity(),
            ]
        ),
        {},
        True,
    ),
    "a lattice, relaxed": (
        lambda: block([INFLATED, PULLED], material=LATTICE),
        {"method": "xpbd", "tolerance": 1e-7},
        True,
    ),
    "a floor under a weight": (
        lambda: block([INFLATED, vs.Gravity()], SIDEWAYS, floor=vs.Floor()),
        {"method": "statics"},
        True,
    ),
}


def reached(result):
    """The sum of forces that do not depend on the shape, at the factors that were reached."""
    total = np.zeros(3)
    by_volume = result.solver["way"] == "volume"
    for load in result.design.loads:
        factor = 1.0 if by_volume else result.load_factor
        if load.kind == "gravity":
            total += factor * result.mass * load.value * np.asarray(load.direction)
        elif load.kind == "force":
            total += factor * np.asarray(load.value)
    return total


@pytest.mark.parametrize("name", CASES)
def test_reactions_balance_the_loads_that_were_reached(name):
    make, settings, whole = CASES[name]
    result = simulate(make(), **settings)
    assert (result.load_factor == 1.0) is whole, result.message
    check_balance(result)


def check_balance(result):
    # Forces on free vertices are a part `residual` of the loads, whose norm is below the sum of
    # the sizes of all forces; moments take them at the length of the body.
    setup = Setup(result.design, result.mesh)
    size = np.abs(setup.problem.elastic(result.positions)[1]).sum()
    slack = 10 * max(result.residual, 1e-12) * size
    length = np.abs(result.positions).max()
    assert np.abs(np.add(result.reaction, result.load)).max() < slack
    assert np.abs(np.add(result.reaction_moment, result.load_moment)).max() < slack * length
    assert np.allclose(result.reactions.sum(axis=0), result.reaction, atol=slack, rtol=0)
    moments = np.cross(result.positions, result.reactions).sum(axis=0)
    assert np.allclose(moments, result.reaction_moment, atol=slack * length, rtol=0)
    if not any(load.kind == "traction" for load in result.design.loads):
        # A closed chamber pushes on itself only.
        assert np.allclose(result.load, reached(result), atol=slack, rtol=0)
    assert result.metric("reaction") == pytest.approx(np.linalg.norm(result.reaction))


def test_inner_pressure_alone_leaves_no_reaction():
    """One chamber wall held sideways: 9.76 N were told for the whole 20 kPa, of 0 N."""
    design = vs.load(BENDER)
    clamps = [*design.document["clamps"], {"region": WALL, "axes": "y"}]
    held = vs.Design.from_document({**design.document, "clamps": clamps})
    result = simulate(held, control="volume", volume_ratio=1.05)
    assert result.load_factor < 0.9
    check_balance(result)
    assert result.metric("reaction") < 1e-6


def test_a_path_that_has_not_begun_carries_nothing():
    loose = block([vs.Force(region=TOP, value=(0.0, 0.0, 1.0))], [vs.Clamp(
        region=vs.Region(z=(0, 0)), axes="xy")])  # fmt: skip
    result = simulate(loose, method="statics")
    assert (result.status, result.load_factor) == ("not-at-rest", 0.0)
    assert result.load == (0.0, 0.0, 0.0)
    assert result.reaction == (0.0, 0.0, 0.0)
