"""Parts that swell, grow warm or shrink, beside closed forms."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.comparison.bricks import BrickModel
from voxsoft.design import (
    Body,
    Contact,
    FiberStrain,
    Objective,
    ShapeMemory,
    Strain,
    Swelling,
    Thermal,
)
from voxsoft.errors import DesignError, SimulationError
from voxsoft.simulation import Setup, gradient
from voxsoft.units import kPa, mm

LONG, THICK = 100 * mm, 5 * mm
YOUNG = 100 * kPa
ABOUT_Y = {"probe": "tip", "axis": "y"}


def rubber(young, poisson=0.3):
    return vs.NeoHookean(young=young, poisson=poisson, density=1000.0)


def bilayer(value, ratio=1.0, layers=2, **changes):
    """Two strips of equal thickness, the upper `ratio` times as stiff; the root may warp."""

    def strip(low):
        return vs.Box(size=(LONG, THICK, THICK), corner=(0, 0, low))

    design = vs.Design(
        name="bilayer",
        voxel_size=THICK / layers,
        parts=[
            vs.Part(name="upper", shape=strip(THICK), material=rubber(ratio * YOUNG)),
            vs.Part(name="lower", shape=strip(0.0), material=rubber(YOUNG)),
        ],
        activations=[Strain(part="upper", value=value)],
        clamps=[
            vs.Clamp(region=vs.Region(x=(0, 0)), axes="x"),
            vs.Clamp(region=vs.Region(y=(THICK / 2, THICK / 2)), axes="y"),
            vs.Clamp(region=vs.Region(x=(0, 0), z=(THICK, THICK)), axes="z"),
        ],
        probes={"base": vs.Probe(x=(0, 0)), "tip": vs.Probe(x=(LONG, LONG))},
    )
    return design.replace(**changes)


def timoshenko(strain, ratio):
    """Curvature of a bimetal of equal thicknesses (Timoshenko 1925, doi 10.1364/JOSA.11.000233)."""
    return 24.0 * strain / (2.0 * THICK * (12.0 + (1.0 + ratio) * (1.0 + 1.0 / ratio)))


@pytest.mark.parametrize("ratio", [1.0, 4.0])
def test_a_bilayer_bends_as_a_bimetal(ratio):
    strain = 1e-3
    result = vs.simulate(bilayer(strain, ratio))
    assert result.status == "ok"
    # Measured: -0.5 and -0.1 % with two voxels through a layer, -0.3 and +0.2 % with four; at the
    # free ends the layers meet as no beam does.
    turned = result.metric("rotation", **ABOUT_Y)
    assert turned == pytest.approx(timoshenko(strain, ratio) * LONG, rel=0.01)
    assert result.metric("curvature", probe="tip", base="base", axis="y") == pytest.approx(
        timoshenko(strain, ratio), rel=0.02
    )


def test_free_parts_swell_without_stress():
    block = vs.Design(
        name="gel",
        voxel_size=5 * mm,
        parts=[
            vs.Part(name="gel", shape=vs.Box(size=("10 mm",) * 3), material=rubber(YOUNG, 0.49))
        ],
        activations=[Swelling(part="gel", value=0.728)],
        clamps=[vs.Clamp(region=vs.Region(**{axis: (0, 0)}), axes=axis) for axis in "xyz"],
        probes={"corner": vs.Probe(point=(10 * mm,) * 3)},
    )
    result = vs.simulate(block)
    assert result.probes["corner"] == pytest.approx(np.full(3, 0.2 * 10 * mm), rel=1e-6)
    assert result.fields.percentile("von_mises") < 1e-6 * YOUNG
    assert result.elastic_energy < 1e-12 * YOUNG * 1e-6
    # The dry mass.
    assert result.mass == pytest.approx(1000.0 * 1e-6)


def test_a_part_held_all_round_is_pressed_by_its_bulk_modulus():
    strain, poisson = 0.01, 0.3
    held = vs.Design(
        name="held",
        voxel_size=5 * mm,
        parts=[
            vs.Part(name="a", shape=vs.Box(size=("10 mm",) * 3), material=rubber(YOUNG, poisson))
        ],
        activations=[Strain(part="a", value=strain)],
        clamps=[
            vs.Clamp(region=vs.Region(**{axis: (side, side)}), axes=axis)
            for axis in "xyz"
            for side in (0.0, 10 * mm)
        ],
        probes={"side": vs.Probe(x=(10 * mm, 10 * mm))},
    )
    result = vs.simulate(held)
    bulk = YOUNG / (3 * (1 - 2 * poisson))
    # W = λ³ K/2 (J/λ³ − 1)² at J = 1, per volume at rest.
    stretch = 1.01
    energy = 0.5 * bulk * stretch**3 * (stretch**-3 - 1) ** 2
    assert result.elastic_energy == pytest.approx(energy * 1e-6, rel=1e-9)


def test_a_large_strain_comes_on_in_steps_and_along_a_path():
    design = bilayer(0.2)
    result = vs.simulate(design)
    assert result.status == "ok"
    path = vs.follow(design, "activations[0].value=0..0.2/5")
    assert path.status == "ok"
    angles = [each.metric("rotation", **ABOUT_Y) for each in path.results]
    assert np.all(np.diff(angles) > 0.5)
    assert angles[-1] == pytest.approx(result.metric("rotation", **ABOUT_Y), rel=1e-6)
    assert path.results[2].design.activations[0].value == pytest.approx(0.1)


def test_the_derivative_by_a_strain():
    design = bilayer(0.02)
    target = {"turn": Objective(maximize="rotation", **ABOUT_Y)}
    found = gradient(vs.simulate(design, tolerance=1e-12), target, ["activations.0.value"])
    step = 1e-5
    high, low = (
        vs.simulate(bilayer(0.02 + sign * step), tolerance=1e-12).metric("rotation", **ABOUT_Y)
        for sign in (1, -1)
    )
    assert found["turn"]["activations.0.value"] == pytest.approx(
        (high - low) / (2 * step), rel=1e-5
    )


def test_two_activations_of_a_part_multiply():
    once = vs.simulate(bilayer(1.01 * 1.02 - 1))
    both = [Strain(part="upper", value=0.01), Strain(part="upper", value=0.02)]
    twice = vs.simulate(bilayer(0.0, activations=both))
    assert twice.positions == pytest.approx(once.positions, abs=1e-9)


def test_a_part_of_a_body_of_its_own_design():
    pair = vs.Design(
        name="pair",
        voxel_size=THICK / 2,
        bodies=[Body(name="left", design=bilayer(1e-3))],
        contact=Contact(),
        solver={"method": "statics"},
    )
    alone = vs.simulate(bilayer(1e-3))
    assert [each.part for each in Setup.of(pair).design.activations] == ["left.upper"]
    tip = vs.simulate(pair).probes["left.tip"]
    assert tip == pytest.approx(alone.probes["tip"], rel=1e-4, abs=1e-8)


@pytest.mark.parametrize(
    ("activation", "words"),
    [
        (Strain(part="uper", value=0.1), 'no part "uper".*upper'),
        ({"kind": "strain", "part": "upper", "value": -1.0}, "nothing would be left"),
        ({"kind": "warm", "part": "upper", "value": 1.0}, "kind"),
    ],
)
def test_bad_activations_are_refused(activation, words):
    with pytest.raises(DesignError, match=words):
        bilayer(0.1, activations=[activation])


def test_outside_codes_are_refused():
    with pytest.raises(SimulationError, match="outside code"):
        BrickModel.of(Setup.of(bilayer(0.1)))


def test_lattices_and_paths_in_contact_are_refused():
    lattice = vs.Lattice(edge=20 * kPa, bulk=40 * kPa)
    parts = [part.replace(material=lattice) for part in bilayer(0.1).parts]
    with pytest.raises(DesignError, match="acts on hyperelastic parts"):
        vs.simulate(bilayer(0.1, parts=parts))
    with pytest.raises(DesignError, match="path of activations"):
        vs.follow(bilayer(0.1, contact=Contact()), "activations[0].value=0..0.1/3")


def test_a_warm_layer_bends_as_timoshenko_says():
    # 3e-4 1/K of silicone, 40 K: 1.2 %.
    warm = Thermal(part="upper", value="333.15 K", expansion="3e-4 1/K")
    assert warm.stretch == pytest.approx(1.012)
    result = vs.simulate(bilayer(0.0, activations=[warm]))
    assert result.metric("curvature", probe="tip", base="base", axis="y") == pytest.approx(
        timoshenko(0.012, 1.0), rel=0.02
    )
    half = warm.share(0.5)
    assert (half.value, half.reference) == (313.15, 293.15)


def test_an_impossible_temperature_is_refused():
    with pytest.raises(DesignError, match="value"):
        Thermal(part="upper", value="-5 K", expansion="3e-4 1/K")
    with pytest.raises(DesignError, match="does not count from zero"):
        Thermal(part="upper", value="80 °C", expansion="3e-4 1/K")
    with pytest.raises(DesignError, match="leaves nothing"):
        Thermal(part="upper", value="300 K", expansion="-1 1/K")


def muscle(value, *, compression=False):
    """A free bar of rubber with fibers along it."""
    fiber = vs.Fiber(direction=(1, 0, 0), modulus=3 * YOUNG, compression=compression)
    box = vs.Box(size=(20 * mm, 10 * mm, 10 * mm))
    part = vs.Part(name="muscle", shape=box, material=rubber(YOUNG), fibers=[fiber])
    return vs.Design(
        name="muscle",
        voxel_size=5 * mm,
        parts=[part],
        activations=[FiberStrain(part="muscle", value=value)],
        clamps=[vs.Clamp(region=vs.Region(**{axis: (0, 0)}), axes=axis) for axis in "xyz"],
        probes={"tip": vs.Probe(x=(20 * mm, 20 * mm))},
    )


def test_fibers_that_are_shorter_by_themselves_draw_the_bar_together():
    # E ε + E_f (ε - s) = 0. To second order of the strain: both laws are curved, 2 % at 1 %.
    strain = vs.simulate(muscle(-0.01)).probes["tip"][0] / (20 * mm)
    assert strain == pytest.approx(-0.01 * 3.0 / 4.0, rel=0.02)


def test_fibers_at_their_own_length_carry_nothing_at_any_strain():
    # Held at 0.7 of its length the bar carries the force of rubber: fibers of that length too.
    def held(design):
        end = vs.Clamp(
            region=vs.Region(x=(20 * mm, 20 * mm)),
            axes="x",
            motion=vs.Motion(displacement=(-6 * mm, 0, 0)),
        )
        return vs.simulate(design.replace(clamps=[*design.clamps, end]))

    plain = muscle(-0.3)
    plain = plain.replace(activations=[], parts=[plain.parts[0].replace(fibers=[])])
    for fibers in (muscle(-0.3), muscle(-0.3, compression=True)):
        assert held(fibers).metric("elastic_energy") == pytest.approx(
            held(plain).metric("elastic_energy"), rel=1e-6
        )
    tight = held(muscle(-0.4)).metric("elastic_energy")
    # Energy of the fibers alone, E_f/8 ((λ/λ₀)² - 1)² V.
    own = 3 * YOUNG / 8.0 * ((0.7 / 0.6) ** 2 - 1.0) ** 2 * 2e-6
    assert tight - held(plain).metric("elastic_energy") == pytest.approx(own, rel=1e-6)


def test_longer_fibers_are_slack_unless_they_push():
    assert abs(vs.simulate(muscle(0.01)).probes["tip"][0]) < 1e-9
    pushed = vs.simulate(muscle(0.01, compression=True)).probes["tip"][0] / (20 * mm)
    assert pushed == pytest.approx(0.01 * 3.0 / 4.0, rel=0.02)


def test_a_part_without_fibers_has_none_that_shorten():
    with pytest.raises(DesignError, match=r"activations\[0\].part: is for the fibers of a part"):
        vs.simulate(bilayer(0.01, activations=[FiberStrain(part="upper", value=-0.1)]))


RAMP = vs.History(time=("0 s", "1 s"), factor=(0, 1))


def free_block(*activations, end, poisson=0.49, **settings):
    """A block that is held by three planes only, and moves to `end` s."""
    return vs.Design(
        name="gel",
        voxel_size=5 * mm,
        parts=[
            vs.Part(name="gel", shape=vs.Box(size=("10 mm",) * 3), material=rubber(YOUNG, poisson))
        ],
        activations=activations,
        clamps=[vs.Clamp(region=vs.Region(**{axis: (0, 0)}), axes=axis) for axis in "xyz"],
        probes={"corner": vs.Probe(point=(10 * mm,) * 3)},
        solver={"end_time": end, **settings},
    )


# Slow beside a wave, which crosses the block in 2 ms: the bound on what inertia leaves of stress is
# ρ L² d²λ/dt² over E, below 1e-5 where the stretch is linear in time.
@pytest.mark.parametrize("contact", [None, Contact()], ids=["explicit", "implicit"])
def test_a_free_block_swells_by_its_history_without_stress(contact):
    grown = [
        Swelling(part="gel", value=0.331, history=RAMP),
        Strain(part="gel", value=0.1, history=vs.History(time=("0 s", "2 s"), factor=(1, 0))),
    ]
    result = vs.simulate(free_block(*grown, end="0.5 s", damping=200.0).replace(contact=contact))
    stretch = (1 + 0.5 * 0.331) ** (1 / 3) * (1 + 0.75 * 0.1)
    assert result.time == pytest.approx(0.5)
    assert result.probes["corner"] == pytest.approx(np.full(3, (stretch - 1) * 10 * mm), rel=1e-3)
    # That of the size at that time, which the result's design has, though the history goes on.
    assert result.design.activations[0].stretch == pytest.approx((1 + 0.5 * 0.331) ** (1 / 3))
    assert result.fields.percentile("von_mises") < 1e-3 * YOUNG
    assert result.elastic_energy < 1e-6 * YOUNG * 1e-6
    assert result.mass == pytest.approx(1000.0 * 1e-6)


@pytest.mark.parametrize("contact", [None, Contact()], ids=["explicit", "implicit"])
def test_grown_bodies_come_to_rest_as_statics_says(contact):
    # Held at its foot, so that it has stress, and at rest before anything has happened.
    foot = [vs.Clamp(region=vs.Region(z=(0, 0)))]
    later = vs.History(time=("0.1 s", "0.3 s"), factor=(0, 1))
    grown = Swelling(part="gel", value=0.2, history=later)
    block = free_block(grown, end=None, poisson=0.3).replace(clamps=foot)
    still = vs.simulate(block.replace(solver={}))
    moving = block.replace(contact=contact, solver={"method": "dynamics"})
    moved = vs.simulate(moving)
    assert moved.status == "ok"
    assert moved.time >= 0.3
    # The residual at rest is 1e-4 of the reactions, which several modes share.
    assert moved.probes["corner"] == pytest.approx(still.probes["corner"], rel=1e-3)
    assert moved.elastic_energy == pytest.approx(still.elastic_energy, rel=1e-3)


@pytest.mark.slow
def test_a_bilayer_that_is_heated_slowly_follows_statics():
    # Its first mode has 1.6 Hz by E I and ρ A. With critical damping it is late by some 0.2 s, a
    # hundredth of the 20 s of heating.
    end = 20.0
    warm = Thermal(
        part="upper",
        value="333.15 K",
        expansion="3e-4 1/K",
        history=vs.History(time=("0 s", f"{end} s", f"{2 * end} s"), factor=(0, 1, 0)),
    )
    moving = bilayer(0.0, activations=[warm], contact=Contact())
    moved = vs.simulate(
        moving.replace(solver={"end_time": end, "time_step": 0.5, "damping": "critical"}),
        record_interval=end / 4,
    )
    along = vs.follow(bilayer(0.0, activations=[warm]), "time=0..20 s/5")
    still = [each.probes["tip"][2] for each in along.results]
    # Half of it is there after half the time, and the recorded motion is the same curve.
    assert still[2] == pytest.approx(still[4] / 2, rel=0.05)
    assert moved.recording.probes["tip"][:, 2] == pytest.approx(still, abs=0.01 * abs(still[4]))


def test_fibers_shorten_over_time():
    shorten = FiberStrain(part="muscle", value=-0.02, history=RAMP)
    design = muscle(0.0).replace(activations=[shorten])
    still = vs.simulate(muscle(-0.01)).probes["tip"][0]
    moved = vs.simulate(design, end_time="0.5 s", damping=200.0).probes["tip"][0]
    # Waves cross it in 2 ms, and it is damped over 5 ms: late by a hundredth of half a second.
    assert moved == pytest.approx(still, rel=0.02)
    path = vs.follow(design, "time=0..1 s/3")
    assert path.results[1].probes["tip"][0] == pytest.approx(still, rel=1e-6)


def test_a_history_that_leaves_nothing_is_refused():
    fall = vs.History(time=("0 s", "1 s"), factor=(0, -2))
    with pytest.raises(DesignError, match=r"history: has the factor -2: nothing would be left"):
        Strain(part="gel", value=0.6, history=fall)
    with pytest.raises(DesignError, match=r"history: has the factor -2: that is -1"):
        Thermal(part="gel", value="500 K", expansion="3e-4 1/K", history=fall)


HEATING, COOLING = (340.0, 350.0), (330.0, 310.0)


def wire(value, **changes):
    """A material that recovers a strain of -4 % and loses it again, over unlike spans."""
    return ShapeMemory(
        **{
            "part": "gel",
            "value": value,
            "strain": -0.04,
            "heating": HEATING,
            "cooling": COOLING,
            **changes,
        }
    )


def shares(*temperatures):
    """Transformed part at temperatures in their order: branches, and level between them."""
    found, share = [], 0.0
    for temperature in temperatures:
        up = np.clip((temperature - 340.0) / 10.0, 0.0, 1.0)
        down = np.clip((temperature - 310.0) / 20.0, 0.0, 1.0)
        share = min(max(share, up), down)
        found.append(share)
    return found


#: Round the major loop by its corners and the middles of its sides, then a minor loop.
ROUND = (300.0, 335.0, 340.0, 345.0, 350.0, 360.0, 335.0, 330.0, 320.0, 310.0, 300.0)
MINOR = (344.0, 335.0, 318.0, 316.0, 325.0, 343.0, 344.0)


def free_wire(activation):
    """A free part, which is as long as it would be by itself."""
    return free_block(activation, end=None).replace(solver={})


def test_a_loop_of_strain_over_temperature():
    temperatures = (*ROUND, *MINOR)
    expected = [0, 0, 0, 0.5, 1, 1, 1, 1, 0.5, 0, 0, 0.4, 0.4, 0.4, 0.3, 0.3, 0.3, 0.4]
    assert shares(*temperatures) == pytest.approx(expected)
    design = free_wire(wire("300 K"))
    path = vs.follow(design, "activations[0].value", temperatures)
    moved = [each.probes["corner"][0] / (10 * mm) for each in path.results]
    # Exact by itself; statics finds it to its tolerance.
    assert moved == pytest.approx(-0.04 * np.array(expected), abs=1e-8)
    # Each state is shown with all that it depends on.
    again = vs.simulate(path.results[13].design)
    assert again.probes["corner"] == pytest.approx(path.results[13].probes["corner"], abs=1e-10)


def test_a_loop_is_the_same_over_time():
    temperatures = (*ROUND, *MINOR)
    # Once each second, and with all that lies between them.
    history = vs.History(
        time=tuple(range(len(temperatures))),
        factor=tuple((t - 300.0) / 60.0 for t in temperatures),
    )
    timed = wire("360 K", reference="300 K", history=history)
    path = vs.follow(free_wire(timed), f"time=0..{len(temperatures) - 1} s/{len(temperatures)}")
    moved = [each.probes["corner"][0] / (10 * mm) for each in path.results]
    assert moved == pytest.approx(-0.04 * np.array(shares(*temperatures)), abs=1e-8)
    # Between the instants too: 345.5 K on the way down, long past the way up.
    assert timed.at(5.58).stretch == pytest.approx(0.96)
    for instant in np.linspace(0.0, len(temperatures) - 1, 157):
        so_far = [t for t in range(len(temperatures)) if t <= instant]
        here = 300.0 + 60.0 * history.at(instant)
        expected = shares(*(temperatures[t] for t in so_far), here)[-1]
        assert timed.at(instant).stretch == pytest.approx(1 - 0.04 * expected, abs=1e-12)
    growth = timed.growth
    assert np.interp(5.58, growth.times, growth.bases) == pytest.approx(0.96)


def test_a_warm_wire_moves_by_its_history():
    # Up to all of it in 0.5 s, then down: at 328 K a tenth of it has gone back.
    history = vs.History(time=("0 s", "0.5 s", "1 s"), factor=(0, 1, 20 / 60))
    timed = wire("360 K", reference="300 K", history=history)
    result = vs.simulate(free_block(timed, end="0.9 s", damping=200.0))
    # Damping leaves it late by 5 ms, a hundredth of the time in which it goes back.
    assert result.probes["corner"][0] == pytest.approx(-0.036 * 10 * mm, rel=0.01)
    assert result.design.activations[0].transformed == pytest.approx(0.9)
    # Its temperature alone would make it cold.
    assert vs.simulate(free_wire(wire("328 K"))).probes["corner"][0] == pytest.approx(0.0, abs=1e-9)


def test_fibers_that_remember():
    fibers = wire("350 K", part="muscle", strain=-0.01, fibers=True)
    warm = vs.simulate(muscle(0.0).replace(activations=[fibers]))
    assert warm.probes["tip"] == pytest.approx(vs.simulate(muscle(-0.01)).probes["tip"], rel=1e-9)
    cold = fibers.replace(value="300 K")
    path = vs.follow(
        muscle(0.0).replace(activations=[cold]), "activations[0].value", [300.0, 350.0, 335.0]
    )
    assert path.results[2].probes["tip"] == pytest.approx(warm.probes["tip"], rel=1e-6)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"heating": (350.0, 340.0)}, "heating: does not rise"),
        ({"cooling": (320.0, 330.0)}, "cooling: does not fall"),
        ({"cooling": (345.0, 341.0)}, "crosses the branch of heating"),
        ({"cooling": (351.0, 330.0)}, "crosses the branch of heating"),
        ({"value": "-5 K"}, "value"),
        ({"cooling": ("60 °C", "40 °C")}, "does not count from zero"),
        ({"strain": -1}, "nothing would be left"),
        ({"transformed": 1.5}, "transformed"),
        ({"history": {"time": ["0 s"], "factor": [-50]}}, "history: has the factor -50: that is"),
    ],
)
def test_a_loop_that_does_not_close_is_refused(changes, words):
    with pytest.raises(DesignError, match=words):
        wire(**{"value": 300.0, **changes})


def test_a_path_of_values_has_no_history():
    timed = wire("360 K", history=vs.History(time=("0 s", "1 s"), factor=(0, 1)))
    with pytest.raises(DesignError, match=r"activations\[0\].history: would be gone through"):
        vs.follow(free_wire(timed), "activations[0].value=300..360 K/3")


def test_the_derivative_by_a_temperature_where_there_is_one():
    warming = free_wire(wire("345 K"))
    target = {"way": Objective(maximize="displacement", probe="corner", axis="x")}
    result = vs.simulate(warming, tolerance=1e-12)
    slope = gradient(result, target, ["activations.0.value"])["way"]["activations.0.value"]
    # -4 % over 10 K, on 10 mm.
    assert slope == pytest.approx(-0.04 / 10 * 10 * mm, rel=1e-6)
    # Warmed to 345 K it stays when it is cooled a little.
    turned = vs.follow(warming, "activations[0].value", [345.0, 345.0], tolerance=1e-12)
    with pytest.raises(DesignError, match="has another slope up than down"):
        gradient(turned.results[-1], target, ["activations.0.value"])


@pytest.mark.slow
def test_half_a_body_grows_over_time_as_the_whole():
    ramp = vs.History(time=("0 s", "0.2 s"), factor=(0, 1))
    whole = bilayer(0.0, activations=[Strain(part="upper", value=0.02, history=ramp)])
    clamps = [clamp for clamp in whole.clamps if clamp.axes != "y"]
    half = whole.replace(clamps=clamps, symmetry=[{"plane": "y", "at": THICK / 2}])
    tips = [
        vs.simulate(design, end_time="0.1 s", damping=20.0).probes["tip"]
        for design in (whole, half)
    ]
    # Substeps of unlike length end the same to 5e-5, as measured.
    assert tips[1] == pytest.approx(tips[0], abs=1e-3 * abs(tips[0][2]))
