"""Layers, fibers and rigid parts against closed forms."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.errors import DesignError, MaterialError, SimulationError
from voxsoft.simulation import Setup, simulate
from voxsoft.units import kPa, mm

LENGTH, SIDE = 20 * mm, 4 * mm
AREA = SIDE**2
YOUNG = 100 * kPa
# Closed forms are linear: at a strain of 1e-5 quadratic terms count about 1e-5 of them.
STRAIN = 1e-5
LINEAR = 1e-4
#: The stiffest against the softest material.
CONTRAST = 1e5


def rubber(poisson=0.3, young=YOUNG):
    return vs.NeoHookean(young=young, poisson=poisson)


def sliding(axis):
    """Hold a face along its normal, a line of it across, and so every rigid motion."""
    return [
        vs.Clamp(region=vs.Region(x=(0, 0)), axes="x"),
        vs.Clamp(region=vs.Region(x=(0, 0), y=(0, 0)), axes="y"),
        vs.Clamp(region=vs.Region(x=(0, 0), z=(0, 0)), axes="z"),
    ][axis]


def bar(parts, *, strain=STRAIN, layers=()):
    """A bar along x that is pulled by a prescribed strain, free across."""
    pull = vs.Clamp(
        region=vs.Region(x=(LENGTH, LENGTH)),
        axes="x",
        motion=vs.Motion(displacement=(strain * LENGTH, 0, 0)),
    )
    return vs.Design(
        name="bar",
        voxel_size=2 * mm,
        parts=parts,
        layers=layers,
        clamps=[*map(sliding, range(3)), pull],
    )


def stiffness(design, strain=STRAIN):
    """Force over strain in N, from the forces that the moved face takes."""
    result = simulate(design, method="statics")
    assert result.status == "ok"
    moved = result.mesh.vertices[:, 0] > LENGTH - 1e-9
    return float(result.reactions[moved, 0].sum()) / strain


def box(length=LENGTH, width=SIDE, corner=(0, 0, 0)):
    return vs.Box(size=(length, width, SIDE), corner=corner)


def test_layers_on_both_faces_of_a_bar_pull_beside_it():
    # Equal Poisson's ratios, so that they contract alike and each carries its own share.
    layers = [
        vs.Layer(region=vs.Region(z=(z, z)), young=50e6, thickness=0.1 * mm, poisson=0.3)
        for z in (0, SIDE)
    ]
    expected = YOUNG * AREA + 2 * 50e6 * 0.1 * mm * SIDE
    design = bar([vs.Part(shape=box(), material=rubber())], layers=layers)
    assert stiffness(design) == pytest.approx(expected, rel=LINEAR)


def test_a_layer_inside_pulls_like_one_outside():
    layer = vs.Layer(region=vs.Region(z=(SIDE / 2, SIDE / 2)), young=50e6, thickness=0.1 * mm)
    expected = YOUNG * AREA + 50e6 * 0.1 * mm * SIDE
    design = bar([vs.Part(shape=box(), material=rubber())], layers=[layer])
    assert stiffness(design) == pytest.approx(expected, rel=LINEAR)


@pytest.mark.parametrize(
    ("compression", "strain", "taut"),
    [(False, STRAIN, True), (False, -STRAIN, False), (True, -STRAIN, True)],
    ids=["pulled", "pushed, slack", "pushed, stiff"],
)
def test_fibers_add_their_modulus_along_their_direction(compression, strain, taut):
    fiber = {"direction": (3, 0, 0), "modulus": 500 * kPa, "compression": compression}
    design = bar([vs.Part(shape=box(), material=rubber(), fibers=[fiber])], strain=strain)
    expected = (YOUNG + (500 * kPa if taut else 0.0)) * AREA
    assert stiffness(design, strain) == pytest.approx(expected, rel=LINEAR)


def test_fibers_across_a_bar_do_not_stiffen_it():
    # Fibers across are pushed together by the contraction, and slack.
    fiber = vs.Fiber(direction=(0, 1, 0), modulus=500 * kPa)
    design = bar([vs.Part(shape=box(), material=rubber(), fibers=[fiber])])
    assert stiffness(design) == pytest.approx(YOUNG * AREA, rel=LINEAR)


def test_bars_in_series_at_the_largest_contrast():
    # With ν = 0 nothing hinders the other across: the compliances add exactly.
    soft, hard = rubber(0.0), rubber(0.0, CONTRAST * YOUNG)
    half = LENGTH / 2
    parts = [
        vs.Part(shape=box(half), material=soft),
        vs.Part(shape=box(half, corner=(half, 0, 0)), material=hard),
    ]
    expected = 2.0 * YOUNG * AREA / (1.0 + 1.0 / CONTRAST)
    assert stiffness(bar(parts)) == pytest.approx(expected, rel=LINEAR)


def test_bars_side_by_side_at_the_largest_contrast():
    soft, hard = rubber(0.0), rubber(0.0, CONTRAST * YOUNG)
    parts = [
        vs.Part(shape=box(width=SIDE / 2), material=soft),
        vs.Part(shape=box(width=SIDE / 2, corner=(0, SIDE / 2, 0)), material=hard),
    ]
    expected = YOUNG * AREA * (1.0 + CONTRAST) / 2.0
    assert stiffness(bar(parts)) == pytest.approx(expected, rel=LINEAR)


def test_bars_side_by_side_lie_between_voigt_and_reuss():
    soft, hard = rubber(0.49), rubber(0.2, 20 * YOUNG)
    half = LENGTH / 2
    parts = [
        vs.Part(shape=box(half), material=soft),
        vs.Part(shape=box(half, corner=(half, 0, 0)), material=hard),
    ]
    reuss = 2.0 / (1.0 / YOUNG + 1.0 / (20 * YOUNG)) * AREA
    voigt = (YOUNG + 20 * YOUNG) / 2.0 * AREA
    # The hard half hinders the contraction of the soft one: a little above Reuss.
    assert reuss * (1 + LINEAR) < stiffness(bar(parts)) < 0.5 * voigt


def capped(material):
    cap = vs.Box(size=(8 * mm, 8 * mm, 8 * mm), corner=(24 * mm, 0, 0))
    return vs.Design(
        name="capped",
        voxel_size=4 * mm,
        parts=[
            vs.Part(shape=cap, material=material),
            vs.Part(shape=vs.Box(size=(24 * mm, 8 * mm, 8 * mm)), material=rubber(0.49)),
        ],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[vs.Force(region=vs.Region(x=(32 * mm, 32 * mm), z=(0, 0)), value=(0, 0, -0.03))],
    )


def distortion(result):
    """Distance of the cap from its best rigid motion, over the largest displacement."""
    cap = result.mesh.vertices[:, 0] > 24 * mm - 1e-9
    both = (result.mesh.vertices, result.positions)
    rest, now = (points[cap] - points[cap].mean(axis=0) for points in both)
    left, _, right = np.linalg.svd(rest.T @ now)
    return np.abs(now - rest @ left @ right).max() / np.abs(result.displacements).max()


def test_a_rigid_cap_moves_as_one():
    result = simulate(capped(vs.Rigid()))
    assert result.status == "ok"
    assert result.solver["method"] == "statics"
    assert np.abs(result.displacements).max() > 2 * mm  # it is bent, and turned by degrees
    assert distortion(result) < 1e-3
    # And the same cap cast of the soft material does not.
    assert distortion(simulate(capped(rubber(0.49)))) > 1e-3


def test_a_rigid_part_has_its_stated_weight():
    light, heavy = (Setup.of(capped(vs.Rigid(density=d))).problem.mass for d in (1000.0, 3000.0))
    assert heavy - light == pytest.approx(2000.0 * (8 * mm) ** 3)


def braided_tube(degrees):
    """A closed square tube; in each wall two families of fibers at an angle to its axis z."""
    side, wall, height = 16 * mm, 4 * mm, 32 * mm
    along, across = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    inner = vs.Box(size=(8 * mm, 8 * mm, 24 * mm), corner=(wall, wall, wall))
    ends = [
        vs.Part(shape=vs.Box(size=(side, side, wall), corner=(0, 0, z)), material=vs.Rigid())
        for z in (0, height - wall)
    ]
    walls = []
    for axis, offset in ((0, 0), (0, side - wall), (1, 0), (1, side - wall)):
        size, corner = [side, side, height], [0, 0, 0]
        size[axis], corner[axis] = wall, offset
        around = (0, across) if axis == 0 else (across, 0)
        fibers = [
            vs.Fiber(direction=(*(sign * a for a in around), along), modulus=2e6)
            for sign in (1, -1)
        ]
        shape = vs.Box(size=size, corner=corner) - inner
        walls.append(vs.Part(shape=shape, material=rubber(0.49), fibers=fibers))
    return vs.Design(
        name="tube",
        voxel_size=4 * mm,
        parts=[*ends, *walls],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Pressure(value=10 * kPa)],
        probes={"top": vs.Probe(z=(height, height))},
    )


def test_a_braid_changes_sign_at_the_magic_angle():
    # In a thin tube under pressure the stress around is twice that along: stiff fibers turn to
    # the angle atan(√2) = 54.7 degrees to the axis. From nearer to the axis they shorten the tube
    # on the way there, from nearer to the hoop they lengthen it.
    rise = {angle: simulate(braided_tube(angle)).probes["top"][2] for angle in (30, 75)}
    assert rise[30] < 0.0 < rise[75]


def test_invalid_fibers_and_rigid_parts_are_refused():
    with pytest.raises(MaterialError, match="direction: is missing"):
        vs.Fiber(modulus=1 * kPa)
    with pytest.raises(DesignError, match=r"fibers\[0\].direction: has no direction"):
        vs.Part(shape="a", material="b", fibers=[{"direction": (0, 0, 0), "modulus": 1 * kPa}])
    with pytest.raises(MaterialError, match="modulus: -1 kPa is not positive"):
        vs.Fiber(direction=(1, 0, 0), modulus=-1 * kPa)
    fibers = [vs.Fiber(direction=(1, 0, 0), modulus=1 * kPa)]
    lattice = vs.Part(shape=box(), material="ecoflex-00-30-lattice", fibers=fibers)
    with pytest.raises(DesignError, match=r"parts\[0\].fibers: need a hyperelastic"):
        simulate(bar([lattice]))
    with pytest.raises(DesignError, match="parts: all are rigid"):
        simulate(bar([vs.Part(shape=box(), material=vs.Rigid())]))


def test_outside_codes_refuse_layers_that_seal_and_fibers():
    from voxsoft.comparison.bricks import BrickModel

    film = vs.Layer(region=vs.Region(z=(0, 0)), young=50e6, thickness=0.1 * mm, seal=True)
    layered = Setup.of(bar([vs.Part(shape=box(), material=rubber())], layers=[film]))
    with pytest.raises(SimulationError, match=r"layers\[0\].seal: spans openings"):
        BrickModel.of(layered)
    fibers = [vs.Fiber(direction=(1, 0, 0), modulus=1 * kPa)]
    setup = Setup.of(bar([vs.Part(shape=box(), material=rubber(), fibers=fibers)]))
    with pytest.raises(SimulationError, match=r"parts\[0\].fibers: cannot be given"):
        BrickModel.of(setup)
