"""Dielectric sheets between compliant electrodes, beside closed forms."""

import numpy as np
import pytest
from scipy.optimize import brentq, fsolve

import voxsoft as vs
from voxsoft.design import Body, Contact, Dielectric, Objective, Strain
from voxsoft.design.dielectric import VACUUM_PERMITTIVITY
from voxsoft.errors import DesignError
from voxsoft.simulation import Setup, gradient
from voxsoft.units import kPa, mm

YOUNG, PERMITTIVITY = 100 * kPa, 2.8
EPSILON = PERMITTIVITY * VACUUM_PERMITTIVITY
WIDE = 4 * mm


def field(part, shear):
    """The field in V/m whose ε E² is that part of a shear modulus in Pa."""
    return float(np.sqrt(part * shear / EPSILON))


def rubber(poisson):
    return vs.NeoHookean(young=YOUNG, poisson=poisson, density=1000.0)


def film(value, poisson=0.49, **changes):
    """A free square of one layer of voxels that is held by three planes."""
    shape = vs.Box(size=(WIDE, WIDE, 1 * mm))
    sheet = Dielectric(part="film", value=value, permittivity=PERMITTIVITY, normal=(0, 0, 2))
    design = vs.Design(
        name="film",
        voxel_size=1 * mm,
        parts=[vs.Part(name="film", shape=shape, material=rubber(poisson))],
        activations=[sheet],
        clamps=[vs.Clamp(region=vs.Region(**{axis: (0, 0)}), axes=axis) for axis in "xyz"],
        probes={"corner": vs.Probe(point=(WIDE, WIDE, 1 * mm))},
    )
    return design.replace(**changes)


def stretches(squared, poisson):
    """In the plane and across it, of the compressible material, by the forces on a free sheet.

    The energy C₁₀ (J^(−2/3) (2 λ² + n²) − 3) + K/2 (J − 1)² − ½ ε E² λ²/n has no slope.
    """
    c10, bulk = YOUNG / (4 * (1 + poisson)), YOUNG / (3 * (1 - 2 * poisson))

    def slopes(unknown):
        wide, thin = unknown
        volume = wide**2 * thin
        isochoric = volume ** (-2 / 3)
        trace = 2 * wide**2 + thin**2
        pressure = bulk * (volume - 1)
        by_wide = c10 * isochoric * (4 * wide - 4 / 3 * trace / wide)
        by_thin = c10 * isochoric * (2 * thin - 2 / 3 * trace / thin)
        return (
            by_wide + 2 * pressure * wide * thin - squared * wide / thin,
            by_thin + pressure * wide**2 + 0.5 * squared * (wide / thin) ** 2,
        )

    found, _, status, message = fsolve(slopes, (1.0, 1.0), xtol=1e-13, full_output=True)
    assert status == 1, message
    return found


@pytest.mark.parametrize("part", [0.05, 0.2, 0.4])
def test_a_free_sheet_becomes_as_thin_as_its_material_says(part):
    shear = YOUNG / (2 * 1.49)
    result = vs.simulate(film(field(part, shear)))
    assert result.status == "ok"
    wide, thin = stretches(part * shear, 0.49)
    # Uniform, so that voxels are exact, to the tolerance of statics over what is left to hold it.
    expected = np.array([(wide - 1) * WIDE, (wide - 1) * WIDE, (thin - 1) * mm])
    assert result.probes["corner"] == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("part", [0.1, 0.3, 0.44])
def test_an_incompressible_sheet_balances_maxwells_stress(part):
    # μ (λ² − λ⁻⁴) = ε E₀² λ⁴, that is ε E₀²/μ = λ⁻² − λ⁻⁸ below its largest value at λ⁶ = 4.
    poisson = 0.4999
    shear = YOUNG / (2 * (1 + poisson))
    expected = brentq(lambda s: s**-2 - s**-8 - part, 1.0, 4.0 ** (1 / 6))
    result = vs.simulate(film(field(part, shear), poisson))
    stretch = 1 + result.probes["corner"][0] / WIDE
    # The volume gives way by about μ/K, 2e-4, which counts the more the flatter the curve is.
    slope = -2 * expected**-3 + 8 * expected**-9
    assert stretch == pytest.approx(expected, abs=3e-4 / slope)


def test_there_is_no_equilibrium_beyond_pull_in():
    poisson = 0.4999
    shear = YOUNG / (2 * (1 + poisson))
    limit = 4.0 ** (-1 / 3) - 4.0 ** (-4 / 3)
    beyond = vs.simulate(film(1.05 * field(limit, shear), poisson))
    assert beyond.status == "not-at-rest"
    assert "no equilibrium" in beyond.message
    # The factor is that of the field; the limit of what gives way by μ/K is off by about as much.
    assert beyond.load_factor < 1 / 1.05 + 1e-3
    far = vs.simulate(film(3.0 * field(limit, shear), poisson))
    assert far.status == "not-at-rest"
    # Load steps are halved to 1/512, and the kept state is the last equilibrium before the limit.
    assert 1 / 3 - 1 / 256 < far.load_factor < 1 / 3 + 1e-3
    # Arc length goes past the limit and says where it was, which μ/K moves by some 1e-4.
    past = vs.simulate(film(1.05 * field(limit, shear), poisson), control="arc-length", steps=10)
    assert past.limit_factor == pytest.approx(1 / 1.05, rel=1e-3)
    near = vs.simulate(film(0.98 * field(limit, shear), poisson))
    assert near.status == "ok"


LONG, THICK = 100 * mm, 5 * mm


def unimorph(value, **changes):
    """A dielectric layer on a passive one of the same rubber and thickness."""

    def strip(low):
        return vs.Box(size=(LONG, THICK, THICK), corner=(0, 0, low))

    design = vs.Design(
        name="unimorph",
        voxel_size=THICK / 2,
        parts=[
            vs.Part(name="upper", shape=strip(THICK), material=rubber(0.3)),
            vs.Part(name="lower", shape=strip(0.0), material=rubber(0.3)),
        ],
        activations=[
            Dielectric(part="upper", value=value, permittivity=PERMITTIVITY, normal=(0, 0, 1))
        ],
        clamps=[
            vs.Clamp(region=vs.Region(x=(0, 0)), axes="x"),
            vs.Clamp(region=vs.Region(y=(THICK / 2, THICK / 2)), axes="y"),
            vs.Clamp(region=vs.Region(x=(0, 0), z=(THICK, THICK)), axes="z"),
        ],
        probes={"base": vs.Probe(x=(0, 0)), "tip": vs.Probe(x=(LONG, LONG))},
    )
    return design.replace(**changes)


def strained_by(strain):
    """The field whose squeeze ½ ε E² (1, 1, −1) makes a free sheet that much longer and wider."""
    return float(np.sqrt(2 * strain * YOUNG / EPSILON))


def test_a_unimorph_bends_as_a_bimetal():
    strain = 1e-3
    result = vs.simulate(unimorph(strained_by(strain)))
    curvature = result.metric("curvature", probe="tip", base="base", axis="y")
    # Timoshenko's equal layers: 3/2 strain over the whole thickness; ends as in test_activation.py.
    assert curvature == pytest.approx(1.5 * strain / (2 * THICK), rel=0.02)
    # The other way round it bends the other way, and no sign of the field matters.
    under = unimorph(-strained_by(strain)).activations[0].replace(part="lower")
    below = vs.simulate(unimorph(0.0, activations=[under]))
    other = below.metric("curvature", probe="tip", base="base", axis="y")
    assert other == pytest.approx(-curvature, rel=1e-3)


def test_the_derivative_by_a_field():
    value = strained_by(0.01)
    target = {"turn": Objective(maximize="rotation", probe="tip", axis="y")}
    found = gradient(vs.simulate(unimorph(value), tolerance=1e-12), target, ["activations.0.value"])
    step = 1e-4 * value
    high, low = (
        vs.simulate(unimorph(value + sign * step), tolerance=1e-12).metric(
            "rotation", probe="tip", axis="y"
        )
        for sign in (1, -1)
    )
    assert found["turn"]["activations.0.value"] == pytest.approx(
        (high - low) / (2 * step), rel=1e-5
    )


def test_fields_along_a_path_and_beside_a_strain():
    value = strained_by(0.01)
    more = [*unimorph(value).activations, Strain(part="lower", value=0.005)]
    design = unimorph(value, activations=more)
    path = vs.follow(design, "activations[0].value", [0.0, value / 2, value, value / 2])
    assert path.status == "ok"
    alone = vs.simulate(
        design.replace(activations=[more[0].replace(value=value / 2), more[1]])
    ).probes["tip"]
    assert path.results[1].probes["tip"] == pytest.approx(alone, rel=1e-5)
    assert path.results[3].probes["tip"] == pytest.approx(alone, rel=1e-5)
    assert path.results[1].design.activations[0].value == pytest.approx(value / 2)


@pytest.mark.parametrize("contact", [None, Contact()], ids=["explicit", "implicit"])
def test_a_field_over_time(contact):
    shear = YOUNG / (2 * 1.3)
    ramp = vs.History(time=("0 s", "0.2 s", "0.4 s"), factor=(0, 1, 0))
    strong = film(field(0.2, shear), 0.3)
    timed = strong.replace(
        activations=[strong.activations[0].replace(history=ramp)],
        contact=contact,
        solver={"end_time": "0.3 s", "damping": 2000.0},
    )
    moved = vs.simulate(timed).probes["corner"]
    # Half of the field is a quarter of its squeeze. Waves cross the sheet in half a millisecond,
    # and damping leaves it late by about as much: a hundredth of the 0.1 s of the ramp at most.
    wide, thin = stretches(0.2 * shear / 4, 0.3)
    expected = np.array([(wide - 1) * WIDE, (wide - 1) * WIDE, (thin - 1) * mm])
    assert moved == pytest.approx(expected, rel=0.02)
    path = vs.follow(timed.replace(solver={}), "time=0..0.3 s/3")
    assert path.results[-1].probes["corner"] == pytest.approx(expected, rel=1e-5)


def test_a_sheet_of_a_turned_body_and_of_its_mirror_image():
    shear = YOUNG / (2 * 1.49)
    alone = vs.simulate(film(field(0.2, shear)))
    skew = film(field(0.2, shear)).activations[0].replace(normal=(0.1, 0, 1))
    turned = vs.Design(
        name="two",
        voxel_size=1 * mm,
        bodies=[
            Body(
                name="turned",
                design=film(field(0.2, shear)),
                rotation={"axis": (0, 1, 0), "angle": "90 deg"},
            ),
            Body(
                name="plain",
                design=film(0.0, activations=[skew]),
                position=("20 mm", 0, 0),
            ),
            Body(
                name="image",
                design=film(0.0, activations=[skew]),
                mirror="x",
                position=("40 mm", 0, 0),
            ),
        ],
        contact=Contact(),
        solver={"method": "statics"},
    )
    assert Setup.of(turned).design.activations[2].normal == pytest.approx((-0.1, 0, 1))
    found = vs.simulate(turned).probes
    x, y, z = alone.probes["corner"]
    assert found["turned.corner"] == pytest.approx([z, y, -x], rel=1e-5)
    x, y, z = found["plain.corner"]
    assert found["image.corner"] == pytest.approx([-x, y, z], rel=1e-5)


def test_a_field_that_breaks_through_is_warned_of():
    shear = YOUNG / (2 * 1.49)
    value = field(0.3, shear)
    design = film(value)
    wide, thin = stretches(0.3 * shear, 0.49)
    for strength, warned in [(1.01 * value / thin, False), (0.99 * value / thin, True)]:
        sheet = design.activations[0].replace(breakdown=strength)
        result = vs.simulate(design.replace(activations=[sheet]))
        found = [each for each in result.warnings if each.where == "activations[0].value"]
        assert bool(found) == warned, strength
        assert all("breaks down at" in each.what for each in found)
    assert wide > 1.0


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"permittivity": 0.5}, "permittivity: is 0.5, less than that of the vacuum"),
        ({"normal": (0, 0, 0)}, "normal: has no direction"),
        ({"value": "3 kV"}, "value"),
        ({"breakdown": 0}, "breakdown"),
    ],
)
def test_a_bad_sheet_is_refused(changes, words):
    good = {"part": "film", "value": "1 MV/m", "permittivity": 2.8, "normal": (0, 0, 1)}
    with pytest.raises(DesignError, match=words):
        Dielectric(**{**good, **changes})


def test_an_impossible_sheet_is_refused():
    other = film(1e6).activations[0].replace(part="fim")
    with pytest.raises(DesignError, match=r'no part "fim".*film'):
        vs.simulate(film(0.0, activations=[other]))
    lattice = [film(1e6).parts[0].replace(material=vs.Lattice(edge=20 * kPa, bulk=40 * kPa))]
    with pytest.raises(DesignError, match="acts on hyperelastic parts"):
        vs.simulate(film(1e6, parts=lattice))
    clamps = [clamp for clamp in film(1e6).clamps if clamp.axes != "y"]
    with pytest.raises(DesignError, match="planes of symmetry"):
        vs.simulate(film(1e6, clamps=clamps, symmetry=[{"plane": "y", "at": WIDE / 2}]))
