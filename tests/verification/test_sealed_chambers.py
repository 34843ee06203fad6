"""Chambers with cut voxels in their walls that layers close: volumes, pressure, derivatives."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft import Objective, gradient, simulate
from voxsoft.design.variation import number_of, with_number
from voxsoft.errors import DesignError
from voxsoft.simulation import Setup, check
from voxsoft.units import mm

SOFT = vs.NeoHookean(young=60e3, poisson=0.49)
SOFT_DATA = {"model": "neo-hookean", "young": "60 kPa", "poisson": 0.49}
TURNS = {0: (2, 0, 1), 1: (1, 2, 0), 2: (0, 1, 2)}  # where x, y, z go so that z goes to the axis
BORE, DEEP = 6.0 * mm, 12.0 * mm
AREA = np.pi * BORE**2
# Small cubes meet a curved wall by planes, an error of second order. Bores of 5 and 10 voxels were
# seen to miss by 1.2e-3 and 2e-4, and off the grid by 1.8e-3 and 3e-4.
CLOSE = 2.5e-3


def turned(values, axis):
    return tuple(values[i] for i in TURNS[axis])


def film(axis, height, **changes):
    region = vs.Region(**{"xyz"[axis]: (height, height)})
    whole = {"region": region, "young": 10e6, "thickness": 0.1 * mm, "seal": True}
    return vs.Layer(**(whole | changes))


def cylinder(radius, low, high, axis=2, center=(0.0, 0.0), along=0.0):
    base = turned((*center, low + along), axis)
    return vs.Cylinder(radius=radius, height=high - low, axis="xyz"[axis], base=base)


def cup(size=2 * mm, axis=2, shift=(0.0, 0.0, 0.0), bottom=0.0, **changes):
    """A round cup with its open side down, closed by a film."""
    where = {"axis": axis, "center": shift[:2], "along": shift[2]}
    body = cylinder(10 * mm, bottom, 16 * mm, **where) - cylinder(BORE, -9 * mm, DEEP, **where)
    low, top = bottom + shift[2], 16 * mm + shift[2]
    whole = {
        "name": "cup",
        "voxel_size": size,
        "parts": [vs.Part(shape=body, material=SOFT)],
        "layers": [film(axis, low)],
        "clamps": [vs.Clamp(region=vs.Region(**{"xyz"[axis]: (top, top)}))],
        "loads": [vs.Pressure(value=1e3)],
    }
    return vs.Design(**(whole | changes))


def volumes(design, refine=1):
    return [cavity.volume for cavity in Setup.of(design, refine=refine).mesh.cavities]


@pytest.mark.long
@pytest.mark.parametrize("shift", [(0, 0, 0), (0.6 * mm, 1.4 * mm, 1.0 * mm)], ids=["on", "off"])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_round_chamber_has_its_volume(axis, shift):
    errors = []
    for size in (2.4 * mm, 1.2 * mm):
        (volume,) = volumes(cup(size, axis, shift))
        errors.append(abs(volume / (AREA * DEEP) - 1.0))
    assert errors[0] < CLOSE
    assert errors[1] < 0.4 * errors[0]  # second order: a quarter


def test_a_quick_round_chamber_has_its_volume_in_run_and_check():
    design = cup()
    (volume,) = volumes(design)
    assert volume == pytest.approx(AREA * DEEP, rel=CLOSE)
    report = check(design)
    assert report.valid
    assert [each.volume for each in report.cavities] == [volume]


@pytest.mark.long
def test_refined_voxels_close_their_chamber():
    (volume,) = volumes(cup(4 * mm), refine=2)
    assert volume == pytest.approx(volumes(cup(2 * mm))[0], rel=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("part", [0.15, 0.4, 0.5, 0.7, 0.9])
def test_a_chamber_ends_at_a_film_beside_the_faces_that_stand_for_it(part):
    """The faces lie up to a voxel beyond the film, or the film beyond them."""
    bottom = -part * 2 * mm
    design = cup(bottom=bottom)
    setup = Setup.of(design)
    assert setup.layers[0].gap != 0.0
    (cavity,) = setup.mesh.cavities
    assert cavity.volume == pytest.approx(AREA * (DEEP - bottom), rel=CLOSE)
    # One level of faces is the film, with the stairs of a round rim; two would be a double film.
    a, b, c = setup.mesh.vertices[setup.layers[0].all].transpose(1, 0, 2)
    covered = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0
    assert covered == pytest.approx(np.pi * (10 * mm) ** 2, rel=0.15)


def on_a_floor(stiff_floor):
    """A cup held at the plane z = 0, closed there by a film or by a floor of one voxel."""
    body = cylinder(10 * mm, -2 * mm if stiff_floor else 0.0, 16 * mm)
    body -= cylinder(BORE, 0.0 if stiff_floor else -9 * mm, DEEP)
    region = vs.Region(z=(-2 * mm, 0)) if stiff_floor else vs.Region(z=(0, 0))
    return cup(
        parts=[vs.Part(shape=body, material=SOFT)],
        layers=[] if stiff_floor else [film(2, 0.0, young=1e9)],
        clamps=[vs.Clamp(region=region)],
        loads=[vs.Pressure(value=2e3)],
    )


@pytest.mark.long
def test_a_film_closes_a_chamber_as_a_stiff_floor_does():
    films, floors = (Setup.of(on_a_floor(stiff)) for stiff in (False, True))
    # The edge of the floor is met by one plane in each small cube; the film has no such edge.
    assert films.mesh.cavities[0].volume == pytest.approx(floors.mesh.cavities[0].volume, rel=1e-3)
    growths = [
        simulate(setup.design, method="statics", error="off").metric("cavity_volume_change")
        for setup in (films, floors)
    ]
    # A wall of two voxels between outside and closed chamber keeps its material where it is,
    # without the lever of oblique walls: 1.1e-2; the edge of the floor has 2e-3 of the other sign.
    assert growths[0] == pytest.approx(growths[1], rel=1.5e-2)


@pytest.mark.long
@pytest.mark.parametrize("bottom", [0.0, -0.8 * mm, -1.8 * mm])
def test_pressure_works_on_a_sealed_chamber_and_has_no_resultant(bottom):
    setup = Setup.of(cup(bottom=bottom))
    (cavity,) = setup.mesh.cavities
    rng = np.random.default_rng(1)
    rest = setup.mesh.vertices
    positions = rest + 0.05 * mm * rng.normal(size=rest.shape)
    direction = rng.normal(size=rest.shape)
    pressure = setup.problem.net_forces(positions) - setup.problem.elastic(positions)[1]
    step = 1e-6 * mm
    change = cavity.volume_at(positions + step * direction) - cavity.volume_at(
        positions - step * direction
    )
    # Volumes of 1e-6 m³, rounded to 1e-16 of that, change by 1e-12 m³ in these steps.
    assert (pressure * direction).sum() == pytest.approx(1e3 * change / (2 * step), rel=1e-5)
    assert np.abs(pressure.sum(axis=0)).max() < 1e-12 * 1e3 * cavity.area
    # An even motion of the walls changes the volume as that of a body.
    stretched = cavity.volume_at(rest * 1.01)
    assert stretched == pytest.approx(1.01**3 * cavity.volume, rel=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("height", [6 * mm, 5.3 * mm])
def test_a_film_between_two_chambers_ends_both(height):
    body = cylinder(10 * mm, -4 * mm, 16 * mm) - cylinder(BORE, 0.0, DEEP)
    design = cup(parts=[vs.Part(shape=body, material=SOFT)], layers=[film(2, height)])
    found = volumes(design)
    expected = sorted([AREA * height, AREA * (DEEP - height)], reverse=True)
    assert found == pytest.approx(expected, rel=2 * CLOSE)
    whole = volumes(design.replace(layers=[]))
    # Nothing is lost between the two, and nothing counts twice.
    assert sum(found) == pytest.approx(sum(whole), rel=1e-12 if height == 6 * mm else CLOSE)


@pytest.mark.long
def test_two_chambers_with_a_thin_wall_between_them_keep_their_own():
    body = vs.Box(size=(28 * mm, 16 * mm, 16 * mm), corner=(-14 * mm, -8 * mm, 0.0))
    for x, radius in ((-6.2, 5.4), (5.9, 5.0)):
        body -= cylinder(radius * mm, -9 * mm, DEEP, center=(x * mm, 0.0))
    found = volumes(cup(parts=[vs.Part(shape=body, material=SOFT)]))
    expected = [np.pi * (radius * mm) ** 2 * DEEP for radius in (5.4, 5.0)]
    assert found == pytest.approx(expected, rel=2 * CLOSE)


@pytest.mark.long
def test_a_closed_chamber_beside_the_film_keeps_its_volume():
    body = vs.Box(size=(36 * mm, 20 * mm, 20 * mm), corner=(-10 * mm, -10 * mm, 0.0))
    body -= cylinder(BORE, -9 * mm, DEEP)
    ball = vs.Sphere(radius=5 * mm, center=(16 * mm, 0.0, 10 * mm))
    design = cup(parts=[vs.Part(shape=body - ball, material=SOFT)])
    alone = volumes(design.replace(layers=[]))
    found = volumes(design)
    assert found == pytest.approx([AREA * DEEP, *alone], rel=CLOSE)
    assert found[1] == alone[0]


def varied_cup(base="0 mm"):
    """A cup with parameters; sizes away from those where small cubes have kinks."""
    sizes = {"inner": "6.4 mm", "wall": "4.3 mm", "deep": "10.2 mm", "cap": "4.6 mm", "base": base}
    outer = {
        "kind": "cylinder",
        "radius": "= inner + wall",
        "height": "= deep + cap - base",
        "base": [0, 0, "= base"],
    }
    bore = {
        "kind": "cylinder",
        "radius": "= inner",
        "height": "= deep + 5 mm",
        "base": [0, 0, "-5 mm"],
    }
    plane = {"z": ["= base", "= base"]}
    return vs.Design.from_document(
        {
            "schema": "voxsoft/1",
            "name": "cup",
            "voxel_size": "3 mm",
            "parameters": {name: {"value": value} for name, value in sizes.items()},
            "shapes": {
                "outer": outer,
                "bore": bore,
                "cup": {"kind": "difference", "of": ["outer", "bore"]},
            },
            "parts": [{"shape": "cup", "material": SOFT_DATA}],
            "layers": [{"region": plane, "young": "2 MPa", "thickness": "0.1 mm", "seal": True}],
            "clamps": [{"region": plane}],
            "loads": [{"kind": "pressure", "value": "2 kPa"}],
            "probes": {"top": {"z": ["= deep + cap", "= deep + cap"]}},
        }
    )


TARGETS = {
    "rise": Objective(maximize="displacement", probe="top", axis="z"),
    "cavity": Objective(maximize="cavity_volume"),
    "growth": Objective(maximize="cavity_volume_change"),
    "energy": Objective(maximize="elastic_energy"),
}
# Differences over 1e-5 stay between kinks of the small cubes; those of 1e-4 cross some, here and
# in closed cavities alike. Results to 1e-11 leave 1e-6 of them, and 3e-3 was the largest seen.
STEP, NEAR = 1e-5, 1e-2


@pytest.mark.long
@pytest.mark.parametrize("base", ["0 mm", "-0.9 mm"], ids=["on the grid", "off"])
def test_slopes_by_the_shape_of_a_sealed_chamber(base):
    design = varied_cup(base)
    settings = {"method": "statics", "tolerance": 1e-11, "error": "off"}
    result = simulate(design, **settings)
    names = ["inner", "wall", "deep", "cap"]
    found = gradient(result, TARGETS, names)
    for name in names:
        value = number_of(design, name)
        low, high = (
            simulate(with_number(design, name, value * (1 + sign * STEP)), **settings)
            for sign in (-1, 1)
        )
        for key, target in TARGETS.items():
            before, after = (
                each.metric(target.metric, probe=target.probe, axis=target.axis)
                for each in (low, high)
            )
            expected = (after - before) / (2 * STEP * value)
            assert found[key][name] == pytest.approx(expected, rel=NEAR), (key, name)
    with pytest.raises(DesignError, match=r"base: cannot be varied: it moves layers\[0\]"):
        gradient(result, "mass", "base")
