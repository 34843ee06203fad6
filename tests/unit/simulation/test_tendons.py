"""Tendons: balance, slack, friction with memory, possible paths, and refusals."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.comparison.bricks import BrickModel
from voxsoft.design import Body, Object
from voxsoft.errors import DesignError, SimulationError
from voxsoft.simulation import Setup, gradient, simulate
from voxsoft.units import kPa, mm

YOUNG, SIDE, LENGTH = 100 * kPa, 4 * mm, 20 * mm
OF_BAR = YOUNG * SIDE**2 / LENGTH
#: A stiff end that the anchor cannot dent, so that the bar stays a bar.
CAP = vs.Box(size=(2 * mm, SIDE, SIDE), corner=(LENGTH, 0, 0))
MIDDLE = (SIDE / 2, SIDE / 2)
AXIS = [(0, *MIDDLE), (LENGTH + 1 * mm, *MIDDLE)]


def bar(tendons, *, poisson=0.0, **changes):
    """A bar along x that is held at its foot, of two voxels in thickness."""
    soft = vs.NeoHookean(young=YOUNG, poisson=poisson)
    stiff = vs.NeoHookean(young=1e4 * YOUNG, poisson=0.0)
    whole = {
        "name": "bar",
        "voxel_size": 2 * mm,
        "parts": [
            vs.Part(shape=vs.Box(size=(LENGTH, SIDE, SIDE)), material=soft),
            vs.Part(shape=CAP, material=stiff),
        ],
        "clamps": [vs.Clamp(region=vs.Region(x=(0, 0)))],
        "tendons": tendons,
        "probes": {"end": vs.Probe(x=(LENGTH, LENGTH))},
        "solver": {"tolerance": 1e-9},
    }
    return vs.Design(**(whole | changes))


def along(**changes):
    """A tendon along the axis of the bar."""
    return vs.Tendon(**{"through": AXIS, "name": "t"} | changes)


def moved(result):
    return float(result.probes["end"][0])


def test_a_tension_along_the_axis_compresses_the_bar():
    tension = 1e-4 * YOUNG * SIDE**2
    result = simulate(bar([along(tension=tension)]))
    # The strain of 1e-4 changes the stiffness by as much again.
    assert moved(result) == pytest.approx(-tension / OF_BAR, rel=5e-4)
    state = result.tendons["t"]
    assert (state.tension, state.anchor_tension, state.slack) == (tension, tension, 0.0)
    assert state.shortening == pytest.approx(-moved(result), rel=1e-3), "the cap hardly gives way"
    assert result.metric("tendon_tension") == tension
    assert result.metric("tendon_length", tendon="t") == state.length
    with pytest.raises(DesignError, match='no tendon "u"'):
        result.metric("tendon_length", tendon="u")


@pytest.mark.parametrize("drive", ["shortening", "length"])
def test_a_shortened_tendon_stretches_in_series_with_the_bar(drive):
    drawn, stiffness = 1e-3 * mm, 0.5 * OF_BAR * LENGTH
    own = LENGTH + 1 * mm
    value = drawn if drive == "shortening" else own - drawn
    result = simulate(bar([along(**{drive: value}, stiffness=stiffness)]))
    of_line = stiffness / own
    pull = drawn / (1 / OF_BAR + 1 / of_line)
    assert result.tendons["t"].tension == pytest.approx(pull, rel=1e-3)
    assert moved(result) == pytest.approx(-pull / OF_BAR, rel=1e-3)
    assert result.tendons["t"].length == pytest.approx(own + moved(result), abs=1e-3 * drawn)


def test_a_line_that_is_too_long_is_slack_until_the_bar_reaches_it():
    spare, force = 0.02 * mm, 3e-3
    pull = [vs.Force(region=vs.Region(x=(LENGTH + 1 * mm, 1)), value=(force, 0, 0))]
    line = along(shortening=-spare, stiffness=OF_BAR * LENGTH)
    loose = simulate(bar([along(shortening=-spare)]))
    assert moved(loose) == 0.0
    assert loose.tendons["t"].slack == pytest.approx(spare, rel=1e-9)
    assert loose.tendons["t"].tension == 0.0
    of_line = OF_BAR * LENGTH / (LENGTH + 1 * mm + spare)
    taut = simulate(bar([line], loads=pull))
    stretch = (force + of_line * spare) / (OF_BAR + of_line)
    assert stretch > spare
    # The strain of a thousandth changes the bar's stiffness by about twice as much.
    assert moved(taut) == pytest.approx(stretch, rel=3e-3)
    assert taut.tendons["t"].tension == pytest.approx(force - OF_BAR * stretch, rel=2e-2)
    assert taut.tendons["t"].slack == 0.0


@pytest.mark.parametrize(
    "settings",
    [{"method": "statics"}, {"method": "dynamics", "time_step": 0.005, "tolerance": 1e-5}],
)
@pytest.mark.parametrize("drive", [{"tension": 0.02}, {"shortening": 1 * mm}])
def test_the_clamp_holds_the_force_of_the_motor(settings, drive):
    motor = (-10 * mm, 0, 20 * mm)
    through = [{"fixed": motor}, {"fixed": (30 * mm, 2 * mm, 10 * mm)}, AXIS[1]]
    design = bar([along(through=through, **drive)], poisson=0.3)
    result = simulate(design.replace(solver={}), **settings)
    assert result.status == "ok"
    state = result.tendons["t"]
    way = state.points[-2] - state.points[-1]
    pull = state.tension * way / np.linalg.norm(way)
    assert state.tension > 0.0
    assert result.load == pytest.approx(pull, abs=1e-9)
    assert result.reaction == pytest.approx(-pull, abs=2e-4 * state.tension)


@pytest.mark.long
@pytest.mark.parametrize("drive", [{"tension": 0.1}, {"shortening": 2 * mm}])
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_body_that_moves_live_has_the_same_rest(drive, friction):
    high = [(0, 2 * mm, 3 * mm), (LENGTH + 1 * mm, 2 * mm, 3 * mm)]
    # Pulled slowly: a bar that swings past its rest slides back there, and comes to another one.
    slowly = {"time": [0, 0.5], "factor": [0, 1]}
    tendon = along(through=high, friction=friction, history=slowly, **drive)
    design = bar([tendon], poisson=0.3)
    rest = simulate(design)
    live = simulate(design.replace(solver={}), method="dynamics", time_step=0.02, tolerance=1e-5)
    assert live.status == "ok"
    size = np.linalg.norm(rest.probes["end"])
    assert size > 1 * mm
    # Dynamics leaves 1e-5 of the forces; with friction it stops where it gets in the way of more.
    allowed = 1e-3 if friction == 0.0 else 1e-2
    assert live.probes["end"] == pytest.approx(rest.probes["end"], abs=allowed * size)


def wrapped(angle, friction, **changes):
    """A line from a motor over a round post that does not move, to a stiff block."""
    radius, count = 10 * mm, 48
    turns = angle * np.arange(count + 1) / count
    # From above to the left, around the middle (0, 0, 0), and on along the tangent to the cap.
    post = [(LENGTH, SIDE / 2 + radius * np.sin(a), radius * np.cos(a)) for a in turns]
    last = turns[-1]
    heading = np.array([0.0, np.cos(last), -np.sin(last)])
    first = np.array(post[0]) - 20 * mm * np.array([0.0, 1.0, 0.0])
    tail = np.array(post[-1]) + 5 * mm * heading
    through = [{"fixed": tuple(at)} for at in (first, *post, tail)]
    return vs.Tendon(through=[*through, AXIS[1]], friction=friction, name="t", **changes)


@pytest.mark.parametrize("turns", [0.25, 0.5, 0.75, 1.0])
def test_a_belt_has_the_tension_of_the_capstan(turns):
    friction, angle = 0.2, 2 * np.pi * turns
    tendon = wrapped(angle, friction, tension=0.2)
    result = simulate(bar([tendon]))
    state = result.tendons["t"]
    # On the post alone; the polygon turns by the whole angle, and by no more.
    on_post = state.tensions[-2]
    assert on_post / state.tension == pytest.approx(np.exp(-friction * angle), rel=1e-9)


@pytest.mark.long
def test_a_line_that_is_eased_keeps_its_tension_until_it_slides_back():
    friction, angle = 0.3, np.pi
    ratio = np.exp(friction * angle)
    seen = []
    for eased in (1.0, 0.6, 0.2, 0.05):
        history = {"time": [0, 1, 2, 3], "factor": [0, 1, 1, eased]}
        tendon = wrapped(angle, friction, tension=0.2, history=history)
        design = bar([tendon]).replace(solver={})
        result = simulate(design, end_time=3.5, time_step=0.02, damping="critical")
        state = result.tendons["t"]
        seen.append(state.tensions[-2] / 0.2)
        assert state.tension == pytest.approx(0.2 * eased)
    pulled, sticks, back, farther = seen
    assert pulled == pytest.approx(1 / ratio, rel=5e-3)
    # It is inside the cones of 0.6 and 0.2 e^(±μθ). The body had half a percent of its way to go.
    assert sticks == pytest.approx(1 / ratio, rel=1e-2)
    assert back == pytest.approx(1 / ratio, rel=1e-2)
    assert farther == pytest.approx(0.05 * ratio, rel=1e-6)


def test_two_antagonists_cancel():
    low, high = ([(0, 2 * mm, z), (LENGTH + 1 * mm, 2 * mm, z)] for z in (1 * mm, 3 * mm))
    one = along(through=high, tension=0.1)
    both = simulate(bar([one.replace(name="a"), one.replace(through=low, name="b")]))
    alone = simulate(bar([one]))
    assert abs(alone.probes["end"][2]) > 1 * mm
    assert abs(both.probes["end"][2]) < 1e-6 * mm


def test_a_channel_bends_with_the_body_and_a_line_through_eyelets_does_not():
    ends = [(0, 2 * mm, 3 * mm), (LENGTH + 1 * mm, 2 * mm, 3 * mm)]
    bent = simulate(bar([along(through=ends, tension=0.1)], poisson=0.3)).tendons["t"]
    bow = simulate(bar([along(through=ends, tension=0.1, guide="eyelets")], poisson=0.3))
    assert len(bent.points) == 11, "a point in about every voxel"
    straight = bow.tendons["t"]
    assert len(straight.points) == 2
    chord = np.linalg.norm(bent.points[-1] - bent.points[0])
    assert bent.length > 1.02 * chord
    assert straight.length == pytest.approx(
        np.linalg.norm(straight.points[-1] - straight.points[0]), rel=1e-12
    )


def test_an_anchor_with_a_radius_pulls_at_a_mean():
    at = {"point": (LENGTH / 2, *MIDDLE), "radius": 1.5 * mm}
    (tendon,) = Setup.of(bar([along(through=[AXIS[0], at], tension=0.01)])).tendons
    place = tendon.places[-1]
    assert len(place["vertices"]) == 3 * 9
    assert sum(place["weights"]) == pytest.approx(1.0)
    assert tendon.points[-1] == pytest.approx(at["point"])


def test_an_anchor_at_a_point_that_pulls_too_hard_is_a_finding():
    soft = (LENGTH / 2, *MIDDLE)
    weak, strong = (along(through=[AXIS[0], soft], tension=pull) for pull in (0.1, 0.3))
    spread = along(through=[AXIS[0], {"point": soft, "radius": 1.5 * mm}], tension=0.3)
    for tendon, found in ((weak, False), (strong, True), (spread, False)):
        warned = [each for each in vs.check(bar([tendon])).findings if "tendons" in each.where]
        assert bool(warned) == found, warned
        if found:
            assert warned[0].where == "tendons[0].through[1]"
            assert "carries 0.2 N" in warned[0].what


def test_a_line_over_an_object_pulls_it():
    post = Object(
        name="post", shape=vs.Box(size=(4 * mm, 4 * mm, 4 * mm), corner=(26 * mm, 0, 10 * mm))
    )
    over = {"object": "post", "point": (28 * mm, 2 * mm, 10 * mm)}
    tendon = along(through=[{"fixed": (0, 2 * mm, 20 * mm)}, over, AXIS[1]], tension=0.05)
    held = bar([tendon], objects=[post], solver={})
    fixed = bar([tendon.replace(through=[tendon.through[0], {"fixed": over["point"]}, AXIS[1]])])
    a, b = simulate(held), simulate(fixed)
    assert a.probes["end"] == pytest.approx(b.probes["end"], abs=1e-4 * abs(b.probes["end"]).max())
    lifted = post.replace(motion={"displacement": (0, 0, 2 * mm)})
    up = simulate(bar([tendon.replace(tension=None, shortening=0)], objects=[lifted], solver={}))
    assert up.tendons["t"].tension > 0.0, "a post that moves pulls a line of one length"


def test_bodies_have_their_own_tendons():
    finger = bar(
        [along(through=[(0, 2 * mm, 3 * mm), (LENGTH + 1 * mm, 2 * mm, 3 * mm)], tension=0.1)]
    )
    finger = finger.replace(solver={})
    pair = vs.Design(
        name="pair",
        voxel_size=2 * mm,
        bodies=[
            Body(name="left", design=finger),
            Body(
                name="right",
                design=finger,
                position=(0, 40 * mm, 0),
                rotation={"axis": (1, 0, 0), "angle": "90 deg"},
            ),
        ],
    )
    alone = simulate(finger).probes["end"]
    result = simulate(pair)
    assert set(result.tendons) == {"left.t", "right.t"}
    size = np.linalg.norm(alone)
    assert result.probes["left.end"] == pytest.approx(alone, abs=1e-4 * size)
    x, y, z = alone
    assert result.probes["right.end"] == pytest.approx((x, -z, y), abs=1e-4 * size)


def test_a_file_holds_tendons():
    through = [{"fixed": (0, 0, -0.01)}, AXIS[0], {"point": AXIS[1], "radius": "1 mm"}]
    design = bar([along(through=through, length=20 * mm, friction=0.1), along(name="u", tension=1)])
    again = vs.Design.from_document(design.document)
    assert again == design
    assert "[[tendons]]" in design.to_toml()
    assert design.hash != bar([]).hash
    table = simulate(bar([along(tension=0.01)])).summary()["tendons"]["t"]
    assert set(table) == {"tension", "anchor_tension", "length", "slack", "shortening"}


@pytest.mark.parametrize(
    ("changes", "where", "what"),
    [
        ({"tension": -1.0}, "tension", "negative"),
        ({"tension": None}, "", "is not pulled"),
        ({"shortening": 0.001}, "", 'both "tension" and "shortening"'),
        ({"stiffness": 1e3}, "stiffness", "changes nothing"),
        ({"history": {"time": [0, 1], "factor": [1, -1]}}, "history", "cannot be pushed"),
        ({"friction": -0.1}, "friction", "negative"),
        ({"through": [AXIS[0]]}, "through", "1"),
        ({"through": [AXIS[0], {"object": "post"}]}, "through[1]", "says nowhere"),
        ({"through": [AXIS[0], {"fixed": AXIS[1], "radius": 0.01}]}, "through[1].radius", "rigid"),
    ],
)
def test_tendons_that_cannot_be(changes, where, what):
    with pytest.raises(DesignError, match=what) as raised:
        along(**{"tension": 1.0} | changes)
    assert raised.value.where == where


@pytest.mark.parametrize(
    ("changes", "where", "what"),
    [
        ({"through": [AXIS[0], (0.1, *MIDDLE)]}, "tendons[0].through[1]", "outside the body"),
        ({"through": [AXIS[0], AXIS[0]]}, "tendons[0].through", "two points at"),
        (
            {"through": [AXIS[0], {"object": "post", "point": (0, 0, 0)}]},
            "tendons[0].through[1].object",
            "there is no object",
        ),
        (
            {"through": [AXIS[0], AXIS[1], (8 * mm, 1 * mm, 2 * mm), (8 * mm, 3 * mm, 2 * mm)]},
            "tendons[0]",
            "crosses itself",
        ),
        ({"tension": None, "shortening": 21 * mm}, "tendons[0].shortening", "leaves nothing of it"),
        (
            {
                "through": [{"fixed": (0, 0, 1)}, {"fixed": (0, 0, 0.5)}, AXIS[1]],
                "tension": None,
                "length": 0.4,
            },
            "tendons[0].length",
            "fixed points are 500 mm apart",
        ),
    ],
)
def test_ways_that_cannot_be(changes, where, what):
    with pytest.raises(DesignError, match=what) as raised:
        Setup.of(bar([along(**{"tension": 1.0} | changes)]))
    assert raised.value.where == where


def test_a_way_through_a_void_is_refused_but_through_eyelets():
    wide = vs.Box(size=(LENGTH, 12 * mm, 12 * mm))
    bored = wide - vs.Box(size=(6 * mm, 6 * mm, 6 * mm), corner=(6 * mm, 0, 0))
    soft = vs.NeoHookean(young=YOUNG)
    through = [(0, 2 * mm, 2 * mm), (LENGTH, 2 * mm, 2 * mm)]
    tendon = along(through=through, tension=0.01)
    design = bar([tendon], parts=[vs.Part(shape=bored, material=soft)])
    with pytest.raises(DesignError, match="leaves the body at") as raised:
        Setup.of(design)
    assert raised.value.where == "tendons[0].through[0] to through[1]"
    Setup.of(design.replace(tendons=[tendon.replace(guide="eyelets")]))


def test_two_tendons_have_two_names():
    with pytest.raises(DesignError, match="is taken"):
        Setup.of(bar([along(tension=1.0), along(tension=2.0)]))


@pytest.mark.parametrize("settings", [{"method": "xpbd"}, {"method": "relaxation"}])
def test_explicit_ways_are_refused(settings):
    with pytest.raises(SimulationError, match="is pulled by statics"):
        simulate(bar([along(tension=0.01)], solver={}), **settings)


def test_planes_of_symmetry_and_outside_codes_are_not_given_tendons():
    with pytest.raises(DesignError, match="not known together with planes of symmetry yet"):
        simulate(bar([along(tension=0.01)], symmetry=[{"plane": "y", "at": SIDE / 2}]))
    with pytest.raises(SimulationError, match="cannot be given to an outside code"):
        BrickModel.of(Setup.of(bar([along(tension=0.01)])))


def routed(**changes):
    """A line that bends inside of a body, and before it."""
    through = [
        {"fixed": (-10 * mm, 2 * mm, 2.4 * mm)},
        (0, 1.7 * mm, 2.9 * mm),
        (9 * mm, 1.4 * mm, 3.3 * mm),
        {"point": (17.1 * mm, 2.33 * mm, 2.71 * mm), "radius": 1 * mm},
    ]
    return bar([along(through=through, **changes)], poisson=0.3, solver={"tolerance": 1e-10})


@pytest.mark.long
@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"tension": 0.05}, "tendons.0.through.2.1"),
        pytest.param({"tension": 0.05}, "tendons.0.through.2.2", marks=pytest.mark.slow),
        pytest.param({"tension": 0.05}, "tendons.0.tension", marks=pytest.mark.slow),
        ({"shortening": 1 * mm}, "tendons.0.through.1.2"),
        pytest.param({"length": 26 * mm}, "tendons.0.through.0.fixed.2", marks=pytest.mark.slow),
        ({"length": 26 * mm}, "tendons.0.length"),
        ({"length": 26 * mm, "stiffness": 50.0}, "tendons.0.stiffness"),
        pytest.param(
            {"tension": 0.05, "friction": 0.3}, "tendons.0.through.2.2", marks=pytest.mark.slow
        ),
        ({"tension": 0.05, "friction": 0.3}, "tendons.0.friction"),
        ({"shortening": 1 * mm, "friction": 0.3}, "tendons.0.through.3.point.0"),
    ],
)
def test_the_gradient_by_routing_is_that_of_differences(changes, name):
    from voxsoft.design.variation import number_of, with_number

    design = routed(**changes)
    target = {"rise": vs.Objective(maximize="displacement", probe="end", axis="z")}
    found = gradient(simulate(design), target, name)["rise"][name]
    value = number_of(design, name)
    # Differences of fourth order; steps so small that no bend becomes straight on the way.
    step = 2e-3 * mm if "through" in name else 1e-3 * value
    low, less, more, high = (
        simulate(with_number(design, name, value + many * step)).probes["end"][2]
        for many in (-2, -1, 1, 2)
    )
    differences = (8 * (more - less) - (high - low)) / (12 * step)
    # Forces of a stiff line are left with 1e-10 of their size, over steps of 2 µm.
    assert found == pytest.approx(differences, rel=2e-5)


def test_a_parameter_reaches_the_routing():
    document = routed(tension=0.05).document
    document["parameters"] = {"offset": {"value": "2.9 mm", "min": "1 mm", "max": "3 mm"}}
    document["tendons"][0]["through"][1][2] = "= offset"
    design = vs.Design.from_document(document)
    target = {"rise": vs.Objective(maximize="displacement", probe="end", axis="z")}
    by_name = gradient(simulate(design), target, "offset")["rise"]["offset"]
    name = "tendons.0.through.1.2"
    by_place = gradient(simulate(routed(tension=0.05)), target, name)["rise"][name]
    assert by_name == pytest.approx(by_place, rel=1e-9)
