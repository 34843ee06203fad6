"""Springs attached to a body: stiffness in series, balance in every solver, impossible ends."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.comparison.bricks import BrickModel
from voxsoft.errors import DesignError, SimulationError
from voxsoft.simulation import Setup, gradient, simulate
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.units import kPa, mm

YOUNG, SIDE, LENGTH, STIFFNESS = 60 * kPa, 2 * mm, 16 * mm, 0.5
#: One voxel thick: a mean over the end pulls it evenly, and so it stays straight.
BAR = vs.Box(size=(LENGTH, SIDE, SIDE))
OF_BAR = YOUNG * SIDE**2 / LENGTH
END, AT_END = vs.Probe(x=(LENGTH, LENGTH)), vs.Region(x=(LENGTH, LENGTH))
FAR = (60 * mm, SIDE / 2, SIDE / 2)
EXTEND = {"probe": "end", "axis": "x"}


def bar(springs, *, material=None, **changes):
    """A bar that is held at its foot, without Poisson's ratio: it stretches as one spring."""
    whole = {
        "name": "bar",
        "voxel_size": 2 * mm,
        "parts": [vs.Part(shape=BAR, material=material or vs.NeoHookean(young=YOUNG, poisson=0.0))],
        "clamps": [vs.Clamp(region=vs.Region(x=(0, 0)))],
        "springs": springs,
        "probes": {"end": END},
        "solver": {"tolerance": 1e-8},
    }
    return vs.Design(**(whole | changes))


def tie(**changes):
    return vs.Spring(**{"at": END, "anchor": FAR, "stiffness": STIFFNESS} | changes)


def test_a_bar_and_a_spring_share_the_stretch_in_series():
    stretch = 0.1 * mm
    pulled = bar([tie(length=FAR[0] - LENGTH - stretch)])
    expected = stretch * STIFFNESS / (STIFFNESS + OF_BAR)
    # The strain changes the bar's stiffness by about twice as much.
    assert expected / LENGTH < 3e-4
    extension = simulate(pulled).metric("displacement", **EXTEND)
    assert extension == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("material", "settings"),
    [
        (None, {"method": "statics"}),
        (vs.NeoHookean(young=YOUNG, poisson=0.45), {"method": "dynamics", "time_step": 0.01}),
        (vs.Lattice(edge=YOUNG, bulk=100 * kPa), {"method": "relaxation"}),
        (vs.Lattice(edge=YOUNG, bulk=100 * kPa), {"method": "statics"}),
        (vs.Lattice(edge=YOUNG, bulk=100 * kPa), {"method": "dynamics", "time_step": 0.01}),
    ],
)
def test_the_clamp_holds_the_force_of_the_spring(material, settings):
    away, stiffness, length = (30 * mm, 20 * mm, 2 * mm), 1.0, 10 * mm
    pulled = bar([tie(anchor=away, length=length, stiffness=stiffness)], material=material)
    thick = vs.Part(shape=vs.Box(size=(LENGTH, 4 * mm, 4 * mm)), material=pulled.parts[0].material)
    setup = Setup.of(pulled.replace(parts=[thick]))
    result = simulate(setup, **settings)
    place = setup.place(END, "")
    along = np.array(away) - place.weights @ result.positions[place.vertices]
    distance = np.linalg.norm(along)
    pull = stiffness * (distance - length) * along / distance
    assert result.status == "ok"
    assert np.linalg.norm(result.positions - setup.mesh.vertices, axis=1).max() > 1 * mm
    # At rest a residual of 1e-8 of the load is left, and dynamics has its own floor.
    assert result.reaction == pytest.approx(-pull, abs=2e-4 * np.linalg.norm(pull))
    assert result.load == pytest.approx(pull, abs=1e-9 * np.linalg.norm(pull))


def test_a_spring_within_the_body_leaves_no_reaction():
    fork = vs.Box(size=(20 * mm, 14 * mm, 4 * mm)) - vs.Box(
        size=(16 * mm, 6 * mm, 4 * mm), corner=(4 * mm, 4 * mm, 0)
    )
    tips = [vs.Probe(point=(20 * mm, y, 2 * mm)) for y in (4 * mm, 10 * mm)]
    closing = vs.Spring(at=tips[0], to=tips[1], stiffness=20.0, length=2 * mm)
    whole = bar([closing], parts=[vs.Part(shape=fork, material=vs.NeoHookean(young=YOUNG))])
    whole = whole.replace(probes={"a": tips[0], "b": tips[1]})
    result = simulate(whole)
    a, b = (result.probes[name] for name in "ab")
    assert a[1] > 0.05 * mm
    assert b[1] == pytest.approx(-a[1], rel=1e-6), "the fork is symmetric"
    pull = 20.0 * (4 * mm - 2 * a[1])
    assert np.linalg.norm(result.reaction) < 1e-6 * pull


def test_the_length_left_out_is_that_of_the_unloaded_body():
    result = simulate(bar([tie()], loads=[vs.Force(region=AT_END, value=(1e-6, 0, 0))]))
    free = simulate(bar([], loads=[vs.Force(region=AT_END, value=(1e-6, 0, 0))]))
    held, alone = (each.metric("displacement", **EXTEND) for each in (result, free))
    assert held / alone == pytest.approx(OF_BAR / (OF_BAR + STIFFNESS), rel=1e-3)


def test_a_body_that_moves_live_has_the_same_rest():
    pulled = bar([tie(length=40 * mm)], loads=[vs.Gravity()])
    rest = simulate(pulled)
    live = vs.Simulator(pulled, time_step=0.05, tolerance=1e-6)
    for _ in range(400):
        seen = live.step()
        if seen.status == "at-rest":
            break
    assert seen.status == "at-rest"
    assert seen.probes["end"] == pytest.approx(rest.probes["end"], abs=1e-3 * 5 * mm)


@pytest.mark.parametrize("name", ["springs.0.stiffness", "springs[0].length"])
def test_the_gradient_is_that_of_differences(name):
    from voxsoft.design.variation import number_of, with_number

    pulled = bar([tie(anchor=(30 * mm, 20 * mm, 0), length=20 * mm)])
    pulled = pulled.replace(solver={"method": "statics", "tolerance": 1e-10})
    target = {"way": vs.Objective(maximize="displacement", probe="end", axis="y")}
    found = gradient(simulate(pulled), target, name)["way"][name]
    value = number_of(pulled, name)
    step = 1e-4 * value
    ends = [simulate(with_number(pulled, name, value + d)).probes["end"][1] for d in (-step, step)]
    assert found == pytest.approx((ends[1] - ends[0]) / (2 * step), rel=1e-5)


def test_a_file_holds_springs():
    design = bar([tie(length=20 * mm, name="return"), tie(at=vs.Probe(point=(0.01, 0, 0)))])
    again = vs.Design.from_document(design.document)
    assert again == design
    assert "[[springs]]" in design.to_toml()
    assert design.hash != bar([]).hash


@pytest.mark.parametrize(
    ("changes", "where", "what"),
    [
        ({"at": vs.Probe(point=(1.0, 0, 0))}, "springs[0].at", "outside the body"),
        ({"to": vs.Probe(z=(0.5, 0.5)), "anchor": None}, "springs[0].to", "touches nothing"),
        ({"to": END, "anchor": None}, "springs[0]", "both ends are the same place"),
        ({"anchor": (LENGTH, SIDE / 2, SIDE / 2), "length": 0.01}, "springs[0]", "on one spot"),
    ],
)
def test_ends_that_cannot_be(changes, where, what):
    with pytest.raises(DesignError, match=what) as raised:
        Setup.of(bar([tie(**changes)]))
    assert raised.value.where == where


def test_a_region_of_very_many_vertices_is_refused():
    fine = bar([tie(at=vs.Probe(x=(0, 1)))], voxel_size=0.4 * mm)
    with pytest.raises(DesignError, match="at most 400"):
        Setup.of(fine)


def test_a_shape_that_an_end_names_must_exist():
    with pytest.raises(DesignError, match='there is no shape "tip"') as raised:
        bar([tie(at=vs.Probe(shape="tip"))])
    assert "springs[0].at.shape" in str(raised.value)


def test_outside_codes_are_not_given_springs():
    with pytest.raises(SimulationError, match="cannot be given to an outside code"):
        BrickModel.of(Setup.of(bar([tie()])))


def test_the_studio_draws_them_where_they_end():
    inner = vs.Spring(at=vs.Probe(point=(8 * mm, 2 * mm, 2 * mm)), to=END, stiffness=1.0)
    thick = vs.Part(
        shape=vs.Box(size=(LENGTH, 4 * mm, 4 * mm)), material=vs.NeoHookean(young=YOUNG)
    )
    lost = tie(at=vs.Probe(point=(1.0, 0, 0)))
    design = bar([tie(name="return"), inner, lost], parts=[thick])
    shown = StudioBody.of(design, rev=1, topology=1).event().attachments
    assert [(each.name, each.summary) for each in shown] == [
        ("return", "spring of 0.5 N/m"),
        ("spring 2", "spring of 1 N/m"),
    ], "a spring that ends nowhere is a finding, and is not drawn"
    assert [place.center for place in shown[0].places] == [(16 * mm, 2 * mm, 2 * mm), FAR]
    assert len(shown[0].places[0].vertices) == 9
    assert shown[0].places[1].vertices == []
    # The middle of the bar is not drawn: its end goes with the surface beside it.
    assert len(shown[1].places[0].vertices) == 1
