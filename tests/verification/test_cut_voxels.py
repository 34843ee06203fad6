"""Cut voxels against closed forms: plates of any thickness, spheres under pressure, sweeps."""

import numpy as np
import pytest
from round_walls import inner_pressure

import voxsoft as vs
from voxsoft.materials import NeoHookean
from voxsoft.units import mm

YOUNG, POISSON, DENSITY = 1e6, 0.3, 1000.0
STIFF = NeoHookean(young=YOUNG, poisson=POISSON, density=DENSITY)
GRAVITY = 0.01  # deflections of some micrometers: small strain


def strip(thickness, low=0.0, voxel=5 * mm):
    """A cantilever 100 x 10 mm whose root is free to change its thickness."""
    return vs.Design(
        name="strip",
        voxel_size=voxel,
        fill="fraction",
        parts=[
            {
                "shape": vs.Box(
                    size=(100 * mm, 10 * mm, thickness),
                    center=(50 * mm, 5 * mm, low + thickness / 2),
                ),
                "material": STIFF,
            }
        ],
        clamps=[{"region": {"x": (0, 0)}}],
        loads=[vs.Gravity(value=GRAVITY)],
        probes={"tip": vs.Probe(x=(100 * mm, 100 * mm))},
    )


def sag(design):
    result = vs.simulate(design, method="statics")
    assert result.status == "ok", result.message
    return -result.metric("displacement", axis="z")


def timoshenko(thickness):
    length, width = 100 * mm, 10 * mm
    weight = DENSITY * GRAVITY * width * thickness
    bending = weight * length**4 / (8 * YOUNG * width * thickness**3 / 12)
    shear_modulus = YOUNG / (2 * (1 + POISSON))
    return bending + weight * length**2 / (2 * 5 / 6 * shear_modulus * width * thickness)


@pytest.mark.parametrize("thickness", [5, 6, 7, 7.5, 8, 9, 12.5])
def test_strips_of_any_thickness_bend_as_beams(thickness):
    # One to two and a half voxels across. Whole ones miss by -0.9 (5 mm) and -1.6 % (10 mm), the
    # clamp's share; a material smeared over its cut voxels misses by -44 to +42 %.
    assert sag(strip(thickness * mm)) == pytest.approx(timoshenko(thickness * mm), rel=0.03)


@pytest.mark.slow
def test_the_sag_changes_smoothly_as_a_surface_crosses_a_voxel():
    thicknesses = np.linspace(10, 15, 26) * mm
    sags = np.array([sag(strip(t)) for t in thicknesses])
    ratios = sags / [timoshenko(t) for t in thicknesses]
    # Where the voxels of the upper layer begin to count (22 % full) the strip jumps a little, by
    # 0.5 %: less than the discretization's own error of 2 %.
    assert np.abs(np.diff(ratios)).max() < 0.01
    assert (np.diff(sags) < 0.0).all()


def test_the_place_of_the_lattice_does_not_matter():
    sags = [sag(strip(7.5 * mm, low * mm)) for low in (0.0, 1.25, 2.5, 3.0, 3.75)]
    assert max(sags) / min(sags) < 1.01  # measured 0.3 %; the clamp's share is 2 % of the sag


def hollow_sphere(voxel, fill="fraction"):
    """10 mm inside, 15 mm outside, free to grow from its center."""
    return vs.Design(
        name="sphere",
        voxel_size=voxel,
        fill=fill,
        parts=[
            {
                "shape": vs.Sphere(radius=15 * mm) - vs.Sphere(radius=10 * mm),
                "material": STIFF,
            }
        ],
        clamps=[{"region": {axis: (0, 0)}, "axes": axis} for axis in "xyz"],
        loads=[vs.Pressure(value=100.0)],
    )


def lame_growth():
    """Growth of the cavity: 4πa²u, u = pa/(E(b³ − a³)) ((1 − 2ν)a³ + (1 + ν)b³/2)."""
    a, b = 10 * mm, 15 * mm
    u = 100.0 * a / (YOUNG * (b**3 - a**3))
    u *= (1 - 2 * POISSON) * a**3 + (1 + POISSON) * b**3 / 2
    return 4 * np.pi * a**2 * u


@pytest.mark.parametrize("voxel", [3.75, 2.5])
def test_a_hollow_sphere_grows_as_lame_says(voxel):
    grown = {}
    for fill in ("binary", "fraction"):
        result = vs.simulate(hollow_sphere(voxel * mm, fill), method="statics")
        grown[fill] = abs(result.metric("cavity_volume_change") / lame_growth() - 1)
    # One and a half voxels across the wall, and two. Measured: -1.5 and -0.7 %, against +33 and
    # +18 % of binary voxels.
    assert grown["fraction"] < 0.02
    assert grown["fraction"] < 0.3 * grown["binary"]


def swelling(design, volume, stretch, power):
    """Growth of the one cavity over the exact one, minus 1."""
    result = vs.simulate(design, method="statics")
    assert result.status == "ok", result.message
    return result.metric("cavity_volume_change") / (volume * (stretch**power - 1)) - 1


def rubber(poisson):
    return NeoHookean(young=YOUNG, poisson=poisson, density=DENSITY)


# Measured with 2.5 mm: +0.6 and 0.0 % at small stretch, -1.1 and -1.8 % at large, where growth
# answers to pressure four times as strongly. Of errors that near to zero no order can be told.
# Triangles that load nodes 2 : 1 in a checkerboard gave +5 to +14 and +5 to +9 %.
@pytest.mark.slow
@pytest.mark.parametrize(("poisson", "stretch"), [(0.3, 1.1), (0.49, 1.1), (0.3, 1.4), (0.49, 1.4)])
def test_a_thick_sphere_of_rubber_swells_as_it_should(poisson, stretch):
    inner, outer = 10 * mm, 20 * mm
    pressure = inner_pressure(YOUNG, poisson, stretch, inner, outer, sphere=True)
    design = vs.Design(
        name="sphere",
        voxel_size=2.5 * mm,
        fill="fraction",
        parts=[
            {
                "shape": vs.Sphere(radius=outer) - vs.Sphere(radius=inner),
                "material": rubber(poisson),
            }
        ],
        clamps=[{"region": {axis: (0, 0)}, "axes": axis} for axis in "xyz"],
        loads=[vs.Pressure(value=pressure)],
    )
    volume = 4 / 3 * np.pi * inner**3
    coarse = swelling(design, volume, stretch, 3)
    fine = swelling(design.replace(voxel_size=1.25 * mm), volume, stretch, 3)
    assert abs(coarse) < (0.02 if stretch < 1.2 else 0.03)
    assert abs(fine) < 0.01


# Measured: -0.5 to -1.4 % with 2 mm, -0.2 to -0.4 % with 1 mm, a third. Triangles of unlike shares
# gave +2.6 to +5.3 %.
@pytest.mark.long
@pytest.mark.parametrize(
    ("voxel", "error"), [(2.0, 0.018), pytest.param(1.0, 0.006, marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("poisson", [0.3, 0.49])
@pytest.mark.parametrize("stretch", [1.1, 1.4])
def test_a_thick_tube_in_plane_strain_swells_as_it_should(voxel, error, poisson, stretch):
    inner, outer, size = 8 * mm, 16 * mm, voxel * mm
    height = 2 * size
    pressure = inner_pressure(YOUNG, poisson, stretch, inner, outer, sphere=False)

    def disk(radius, low, high):
        return vs.Cylinder(radius=radius, base=(0, 0, low), height=high - low)

    wall = disk(outer, 0, height) - disk(inner, -height, 2 * height)
    caps = disk(outer, -size, height + size) - disk(2 * outer, 0, height)
    # A hundred thousandth of the wall, the caps only keep the cavity closed.
    skin = NeoHookean(young=1e-5 * YOUNG, poisson=0.0, density=DENSITY)
    design = vs.Design(
        name="tube",
        voxel_size=size,
        fill="fraction",
        parts=[
            {"shape": wall, "material": rubber(poisson)},
            {"shape": caps, "material": skin},
        ],
        clamps=[
            {"region": {"x": (0, 0)}, "axes": "x"},
            {"region": {"y": (0, 0)}, "axes": "y"},
            {"region": {"z": (-height, 2 * height)}, "axes": "z"},
        ],
        loads=[vs.Pressure(value=pressure)],
    )
    volume = np.pi * inner**2 * height
    assert abs(swelling(design, volume, stretch, 2)) < error


# Without the mean gradient over the material the cavity was 1 and 13 % off, corners 1.1 and
# 1.8 p h/E.
@pytest.mark.parametrize(
    ("poisson", "pressure"),
    [
        (0.49, 0.1 * YOUNG),
        pytest.param(0.3, 1e-4 * YOUNG, marks=pytest.mark.slow),
        pytest.param(0.3, 0.1 * YOUNG, marks=pytest.mark.slow),
        pytest.param(0.49, 1e-4 * YOUNG, marks=pytest.mark.slow),
    ],
)
def test_the_same_pressure_inside_and_outside_shrinks_a_body_uniformly(poisson, pressure):
    size = 2.5 * mm
    outside = [
        vs.Traction(value=pressure, region={axis: (side, side)})
        for axis in "xyz"
        for side in (-20 * mm, 20 * mm)
    ]
    design = vs.Design(
        name="cube",
        voxel_size=size,
        fill="fraction",
        parts=[
            {
                "shape": vs.Box(size=(40 * mm,) * 3, center=(0, 0, 0)) - vs.Sphere(radius=10 * mm),
                "material": rubber(poisson),
            }
        ],
        clamps=[{"region": {axis: (0, 0)}, "axes": axis} for axis in "xyz"],
        loads=[vs.Pressure(value=pressure), *outside],
    )
    result = vs.simulate(design, method="statics")
    assert result.status == "ok", result.message
    bulk = YOUNG / (3 * (1 - 2 * poisson))
    volume_ratio = 1 - pressure / bulk
    exact = volume_ratio ** (1 / 3) * result.mesh.vertices
    # Exact where material and room make whole voxels. Their second moments are approximate in small
    # cubes that are cut: measured are 1e-3 p h/E, 7e-4 p, and 2e-7 of what the cavity shrinks by.
    assert np.abs(result.positions - exact).max() < 3e-3 * pressure * size / YOUNG
    uniform = -pressure * np.array([1, 1, 1, 0, 0, 0])
    assert np.abs(result.fields.stress - uniform).max() < 2e-3 * pressure
    (cavity,) = result.mesh.cavities
    shrunk = 1 - cavity.volume_at(result.positions) / cavity.volume
    assert shrunk == pytest.approx(pressure / bulk, rel=1e-5)


@pytest.mark.long
def test_slivers_in_a_bore_do_not_give_way():
    """Corners of voxels in a bore move with its wall under a pressure of a ninth of the modulus."""
    size, height = 1.25 * mm, 5 * mm
    outside = vs.Cylinder(radius=20 * mm, height=2 * height)
    bore = vs.Cylinder(radius=10 * mm, height=height, base=(0, 0, height / 2))
    ends = [{"region": {"z": (z, z)}, "axes": "z"} for z in (0, 2 * height)]
    design = vs.Design(
        name="ring",
        voxel_size=size,
        fill="fraction",
        parts=[{"shape": outside - bore, "material": rubber(0.49)}],
        clamps=ends,
        symmetry=[{"plane": "x"}, {"plane": "y"}],
        loads=[vs.Pressure(value=0.115 * YOUNG)],
        solver={"error": "off"},
    )
    result = vs.simulate(design, method="statics")
    assert result.status == "ok", result.message
    places, moved = result.mesh.vertices, result.displacements
    radius = np.hypot(places[:, 0], places[:, 1])
    wall = (np.abs(places[:, 2] - height) < size / 2) & (np.abs(radius - 10 * mm) < size / 2)
    # At constant volume a vertex moves by 1/r: the innermost is √2 voxels inside the bore. Where a
    # voxel kept 11 % it moved by 3.6 times the wall, after 111 iterations.
    inmost = 10 * mm / (10 * mm - np.sqrt(2) * size)
    largest = np.linalg.norm(moved, axis=1).max()
    assert largest < 1.1 * inmost * np.linalg.norm(moved[wall], axis=1).mean()
    assert result.steps <= 10
