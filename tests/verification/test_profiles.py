"""Activations that differ from place to place, beside closed forms."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Body, FiberStrain, History, Objective, Profile, Strain, Swelling, Thermal
from voxsoft.errors import DesignError
from voxsoft.simulation import gradient
from voxsoft.units import kPa, mm

LONG, THICK = 30 * mm, 6 * mm
THROUGH = Profile(axis="z", at=(0.0, THICK), factor=(-1, 1))


def strip(activation, voxel=THICK / 2, **changes):
    """A strip along x whose root is free to warp."""
    material = vs.NeoHookean(young=100 * kPa, poisson=0.45, density=1000.0)
    box = vs.Box(size=(LONG, 2 * THICK, THICK), corner=(0, -THICK, 0))
    design = vs.Design(
        name="strip",
        voxel_size=voxel,
        parts=[vs.Part(name="strip", shape=box, material=material)],
        activations=[activation],
        clamps=[
            vs.Clamp(region=vs.Region(x=(0, 0)), axes="x"),
            vs.Clamp(region=vs.Region(y=(0, 0)), axes="y"),
            vs.Clamp(region=vs.Region(x=(0, 0), y=(0, 0), z=(THICK, THICK)), axes="z"),
        ],
        probes={
            "tip": vs.Probe(x=(LONG, LONG)),
            "near": vs.Probe(x=(THICK, THICK)),
            "far": vs.Probe(x=(LONG - THICK,) * 2),
        },
    )
    return design.replace(**changes)


def turned(result):
    return result.metric("rotation", probe="tip", axis="y")


@pytest.mark.parametrize("voxel", [THICK, THICK / 2, THICK / 3])
def test_a_linear_profile_bends_to_an_arc_without_stress(voxel):
    # Strain that is linear in space is compatible: nothing is stressed, and the curvature is its
    # slope. One number for each voxel would give 25 % too little with two through the thickness.
    strain = 1e-3
    result = vs.simulate(strip(Strain(part="strip", value=strain, profile=THROUGH), voxel))
    curvature = 2.0 * strain / THICK
    assert turned(result) == pytest.approx(curvature * LONG, rel=5e-3)
    held = 0.5 * 100 * kPa * strain**2 / 3.0 * LONG * 2.0 * THICK * THICK
    assert result.metrics["elastic_energy"] < 1e-3 * held


def test_a_large_profile_bends_to_the_same_arc_at_any_voxel_size():
    def arc(voxel):
        activation = Strain(part="strip", value=0.15, profile=THROUGH)
        return turned(vs.simulate(strip(activation, voxel)))

    # To second order in the strain of a voxel, 0.05 here: the arc is one of 86 degrees.
    assert arc(THICK / 3) == pytest.approx(2.0 * 0.15 / THICK * LONG, rel=0.05**2 * 4)
    assert arc(THICK / 2) == pytest.approx(arc(THICK / 3), rel=0.075**2 * 4)


def test_heat_along_a_bar_makes_it_longer_by_its_mean():
    heat = Thermal(
        part="strip",
        value="353.15 K",
        expansion="3e-4 1/K",
        profile=Profile(axis="x", at=(0.0, LONG), factor=(0, 1)),
    )
    result = vs.simulate(strip(heat))
    # Free of all it has curved sections; at the root, which stays plane, it is shorter by 0.7 %.
    longer = result.probes["tip"][0]
    assert longer == pytest.approx(0.5 * 60.0 * 3e-4 * LONG, rel=0.01)


def test_a_parabola_stresses_a_strip_and_makes_it_longer_by_its_mean():
    # Its ends, where nothing pulls, are left out as far as the strip is thick.
    strain = 1e-3
    parabola = Profile(expression=f"(2 * z / {THICK} - 1)^2")
    activation = Strain(part="strip", value=strain, profile=parabola)
    errors = []
    for voxels in (2, 4):
        result = vs.simulate(strip(activation, THICK / voxels))
        assert abs(turned(result)) < 1e-3 * strain * LONG / THICK
        inner = result.probes["far"][0] - result.probes["near"][0]
        errors.append(abs(inner / (strain / 3.0 * (LONG - 2.0 * THICK)) - 1.0))
    # A factor at the center of a voxel is below its mean by h^2/24 of the second derivative, which
    # is 1/n^2 of the mean over the strip.
    assert errors[0] == pytest.approx(1.0 / 4.0, abs=0.05)
    assert errors[1] == pytest.approx(1.0 / 16.0, abs=0.02)


def test_cut_voxels_have_the_factor_where_their_material_is():
    # Three voxels of 2.5 mm hold 6 mm: the upper ones are filled by 40 %.
    strain = 1e-3
    design = strip(Strain(part="strip", value=strain, profile=THROUGH), 2.5 * mm)
    turn = turned(vs.simulate(design))
    assert turn == pytest.approx(2.0 * strain / THICK * LONG, rel=0.01)


@pytest.mark.slow
def test_a_profile_follows_its_history():
    ramp = History(time=("0 s", "1 s"), factor=(0, 1))
    activation = Swelling(part="strip", value=0.02, profile=THROUGH, history=ramp)
    end = turned(vs.simulate(strip(activation)))
    assert end == pytest.approx(turned(vs.simulate(strip(activation.replace(history=None)))))
    path = vs.follow(strip(activation), over="time=0..1 s/3")
    angles = [turned(each) for each in path.results]
    assert angles[0] == pytest.approx(0.0, abs=1e-9)
    assert angles[2] == pytest.approx(end, rel=1e-6)
    assert angles[1] == pytest.approx(end / 2.0, rel=0.01)
    slow = History(time=("0 s", "4 s"), factor=(0, 1))
    moving = strip(
        activation.replace(history=slow),
        solver={"end_time": "4.5 s", "damping": "critical", "time_step": "0.5 s"},
    )
    assert turned(vs.simulate(moving)) == pytest.approx(end, rel=0.05)


def test_half_of_a_symmetric_profile_is_half_of_all():
    profile = Profile(expression=f"z / {THICK} + (y / {THICK})^2")
    whole = strip(Strain(part="strip", value=0.02, profile=profile))
    half = whole.replace(symmetry=[vs.Symmetry(plane="y")])
    assert turned(vs.simulate(half)) == pytest.approx(turned(vs.simulate(whole)), rel=1e-6)
    crooked = Profile(expression=f"y / {THICK}")
    with pytest.raises(DesignError, match=r"mirrors activations\[0\]\.profile"):
        vs.simulate(half.replace(activations=[Strain(part="strip", value=0.02, profile=crooked)]))


def test_a_turned_body_and_its_image_have_the_profile_of_their_own_frame():
    alone = strip(
        Strain(part="strip", value=0.02, profile=Profile(expression="x * z / 0.0001")),
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
    )
    bodies = [
        Body(
            name="turned",
            design=alone,
            position=(0.2, 0, 0),
            rotation=vs.Rotation(axis=(1, 2, 3), angle="40 deg"),
        ),
        Body(name="image", design=alone, mirror="x", position=(-0.2, 0, 0)),
    ]
    both = vs.Design(name="both", voxel_size=alone.voxel_size, bodies=bodies)
    result = vs.simulate(both)
    straight = vs.simulate(alone)
    lengths = np.linalg.norm(straight.displacements, axis=1)
    for body in result.mesh.bodies:
        vertices = slice(body.first_vertex, body.first_vertex + len(body.mesh.vertices))
        own = np.linalg.norm(result.displacements[vertices], axis=1)
        assert np.sort(own) == pytest.approx(np.sort(lengths), rel=1e-4, abs=1e-7)


def test_fibers_contract_where_the_profile_says():
    fiber = vs.Fiber(direction=(1, 0, 0), modulus=400 * kPa, compression=True)
    activation = FiberStrain(part="strip", value=-0.02, profile=THROUGH)
    design = strip(activation)
    part = design.parts[0].replace(fibers=[fiber])
    # Turn of a uniform part, times the fibers' share of its stiffness: 400 of 500 kPa.
    turn = turned(vs.simulate(design.replace(parts=[part])))
    uniform = turned(vs.simulate(strip(Strain(part="strip", value=-0.02, profile=THROUGH))))
    assert 0.6 * uniform > turn > 0.9 * uniform  # both are negative: bent upward


def test_a_number_of_a_profile_has_its_derivative():
    design = strip(
        Strain(part="strip", value=0.05, profile=THROUGH),
        objectives={"turn": Objective(maximize="rotation", probe="tip", axis="y")},
    )
    name = "activations.0.value"
    found = gradient(vs.simulate(design, tolerance=1e-10), design.objectives, [name])

    def turn(value):
        tight = vs.Solver(tolerance=1e-10)
        changed = Strain(part="strip", value=value, profile=THROUGH)
        return turned(vs.simulate(design.replace(activations=[changed], solver=tight)))

    slope = found["turn"][name]
    assert slope == pytest.approx((turn(0.0502) - turn(0.0498)) / 0.0004, rel=1e-4)


@pytest.mark.parametrize(
    ("profile", "where", "what"),
    [
        ({"axis": "z", "at": [0.0], "factor": [1]}, "at", "of 2 places or more"),
        ({"axis": "z", "at": [0.0, 0.0], "factor": [1, 2]}, "at", "does not rise"),
        ({"axis": "z", "at": [0.0, 1.0], "factor": [1]}, "factor", "2 places and 1 factors"),
        ({"expression": "t"}, "expression", "t"),
        ({"axis": "z", "expression": "z"}, "", "a table and an expression"),
        ({}, "axis", "is missing"),
    ],
)
def test_a_profile_that_is_none_is_refused(profile, where, what):
    with pytest.raises(DesignError, match=what) as error:
        Profile(**profile)
    assert error.value.where == where


@pytest.mark.parametrize(
    ("text", "what"),
    [("1 / (x - x)", "has no value around"), ("-60 * z / 0.006", "nothing would be left there")],
)
def test_a_profile_that_leaves_nothing_somewhere_is_refused(text, what):
    activation = Strain(part="strip", value=0.02, profile=Profile(expression=text))
    with pytest.raises(DesignError, match=rf"activations\[0\]\.profile: .*{what}"):
        vs.simulate(strip(activation))
