"""Reactions by clamp, region and object: closed forms, and that together they are all."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.errors import DesignError
from voxsoft.files.run_folder import write_run
from voxsoft.simulation import Setup

YOUNG = 100e3
STRETCH = 1e-4
LENGTH, SIDE = 40e-3, 10e-3
#: The force that stretches the bar by so little: E A e, to the first order in e.
PULL = YOUNG * SIDE**2 * STRETCH


def bar(**changes):
    """A bar along x between two clamps, free to thin; the right one pulls."""
    return vs.Design.model_validate(
        {
            "schema": "voxsoft/1",
            "name": "bar",
            "voxel_size": SIDE / 2,
            "shapes": {"bar": {"kind": "box", "size": [LENGTH, SIDE, SIDE], "corner": [0, 0, 0]}},
            "parts": [
                {
                    "shape": "bar",
                    "material": {"model": "neo-hookean", "young": "100 kPa", "poisson": 0.45},
                }
            ],
            "clamps": [
                {"region": {"x": [0, 0]}, "axes": "x", "name": "wall"},
                {"region": {"y": [0, 0]}, "axes": "y"},
                {"region": {"z": [0, 0]}, "axes": "z"},
                {
                    "region": {"x": [LENGTH, LENGTH]},
                    "axes": "x",
                    "name": "jaw",
                    "motion": {"displacement": [LENGTH * STRETCH, 0, 0]},
                },
            ],
            "solver": {"error": "off"},
            **changes,
        }
    )


def test_a_bar_pulls_at_both_of_its_clamps():
    result = vs.simulate(bar())
    found = result.clamp_reactions
    assert list(found) == ["wall", "clamps[1]", "clamps[2]", "jaw"]
    # The force of the support on the body, to the second order of the strain.
    assert found["jaw"][0] == pytest.approx(PULL, rel=5 * STRETCH)
    assert found["wall"][0] == pytest.approx(-PULL, rel=5 * STRETCH)
    assert abs(found["clamps[1]"][1]) < 1e-6 * PULL
    # All of them cancel: their sum is the reaction of all supports.
    assert np.abs(result.reaction).max() < 1e-6 * PULL


def test_metrics_are_of_a_clamp_or_of_a_region():
    targets = {
        "jaw": {"maximize": "reaction", "clamp": "jaw", "axis": "x"},
        "size": {"maximize": "reaction", "clamp": "wall"},
        "there": {"maximize": "reaction", "region": {"x": [LENGTH / 2, "inf"]}, "axis": "x"},
    }
    result = vs.simulate(bar(objectives=targets))
    assert result.metrics["jaw"] == result.clamp_reactions["jaw"][0]
    assert result.metrics["size"] == pytest.approx(PULL, rel=5 * STRETCH)
    assert result.metrics["there"] == pytest.approx(PULL, rel=5 * STRETCH)
    assert result.metric("reaction", clamp="jaw", axis="x") == result.metrics["jaw"]
    assert result.summary()["reactions"]["jaw"] == list(result.clamp_reactions["jaw"])


def test_a_vertex_that_two_clamps_hold_counts_once_for_the_last_of_them():
    twice = [
        {"region": {"x": [0, 0]}, "name": "all"},
        {"region": {"x": [0, 0], "z": [0, 5e-3]}, "name": "low", "axes": "xz"},
    ]
    gravity = [{"kind": "gravity"}]
    result = vs.simulate(bar(clamps=twice, loads=gravity))
    total = np.sum(list(result.clamp_reactions.values()), axis=0)
    weight = result.mass * 9.81
    assert total == pytest.approx([0.0, 0.0, weight], abs=1e-6 * weight)
    # Held along y by the first alone.
    assert result.clamp_reactions["low"][1] == 0.0
    assert result.clamp_reactions["low"][2] != 0.0 != result.clamp_reactions["all"][2]


def test_of_a_half_that_is_solved_the_whole_is_reported():
    whole = bar(
        clamps=[{"region": {"x": [0, 0]}, "name": "wall"}, {"region": {"x": [LENGTH, LENGTH]}}],
        loads=[{"kind": "gravity"}],
    )
    expected = vs.simulate(whole).clamp_reactions
    half = vs.simulate(whole.replace(symmetry=[{"plane": "y", "at": SIDE / 2}]))
    size = max(np.abs(force).max() for force in expected.values())
    for name, force in half.clamp_reactions.items():
        assert force == pytest.approx(expected[name], abs=1e-6 * size)


@pytest.mark.parametrize(
    ("target", "words"),
    [
        ({"clamp": "yaw"}, 'there is no clamp "yaw". Try: did you mean "jaw"?'),
        ({"clamp": "jaw", "region": {"x": [0, 0]}}, "region: stands beside clamp"),
    ],
)
def test_components_without_a_support_are_refused(target, words):
    with pytest.raises(DesignError) as refused:
        Setup.of(bar(objectives={"pull": {"maximize": "reaction", **target}}))
    assert words in str(refused.value)


def test_two_clamps_of_one_name_are_refused():
    clamps = [{"region": {"x": [0, 0]}, "name": "wall"}, {"region": {"x": [LENGTH, LENGTH]}}]
    clamps[1]["name"] = "wall"
    with pytest.raises(DesignError, match="is the name of clamps"):
        Setup.of(bar(clamps=clamps))


def test_an_object_and_the_clamps_carry_the_body_together():
    plate = {"kind": "box", "size": [SIDE, SIDE, 5e-3], "corner": [LENGTH - SIDE, 0, -5e-3]}
    design = bar(
        clamps=[{"region": {"x": [0, 0]}, "name": "wall"}],
        loads=[{"kind": "gravity"}],
        objects=[{"name": "plate", "shape": "plate"}],
        shapes={**bar().document["shapes"], "plate": plate},
        contact={"pairs": [{"of": ["body", "plate"], "kind": "bonded"}]},
    )
    result = vs.simulate(design)
    of_plate = result.metric("reaction", object="plate", axis="z")
    of_wall = result.metric("reaction", clamp="wall", axis="z")
    weight = result.mass * 9.81
    assert of_plate > 0.0 < of_wall
    # Forces that bonds may leave of their own are a thousandth.
    assert of_plate + of_wall == pytest.approx(weight, rel=1e-3)


def test_a_mesh_file_has_the_vertices_of_a_clamp_by_its_name(tmp_path):
    from voxsoft.files.meshes import read_mesh_file

    result = vs.simulate(bar())
    write_run(result, tmp_path)
    content = read_mesh_file(tmp_path / "result.vtu")
    held = content.regions["clamp_jaw"]
    assert content.point_data["reaction"][held].sum(axis=0)[0] == pytest.approx(PULL, rel=5e-4)
    assert "clamp_1" in content.regions


def test_the_card_of_a_result_in_the_studio_has_the_reactions():
    from voxsoft.studio.bodies.equilibrium import _force_in_words

    # Less than E A e by the second order of the strain.
    force = vs.simulate(bar()).clamp_reactions["jaw"]
    assert _force_in_words(force) == "(0.9999 mN, 0, 0)"


def cantilever(**changes):
    """A beam along x with a force across its tip that hardly bends it."""
    left, tip = {"x": [0, 0]}, {"x": [LENGTH, LENGTH]}
    clamps = [{"region": left, "name": "wall"}]
    loads = [{"kind": "force", "region": tip, "value": [0, 0, -1e-6]}]
    return bar(clamps=clamps, loads=loads, **changes)


def test_the_moment_of_a_cantilever_is_force_times_length():
    result = vs.simulate(cantilever())
    middle = (0.0, SIDE / 2, SIDE / 2)
    moment = 1e-6 * LENGTH
    # The wall turns the beam up, about -y; the tip sinks by a ten-thousandth of the length.
    at_wall = result.metric("reaction_moment", clamp="wall", axis="y", about=middle)
    assert at_wall == pytest.approx(-moment, rel=1e-4)
    assert result.metric("reaction_moment", about=("0 mm", "5 mm", "5 mm")) == pytest.approx(
        moment, rel=1e-4
    )
    # About the tip itself the force of the wall and its moment cancel.
    far = (LENGTH, SIDE / 2, SIDE / 2)
    assert abs(result.metric("reaction_moment", axis="y", about=far)) < 1e-3 * moment
    total = result.metric("reaction_moment", axis="x")
    assert total == pytest.approx(result.reaction_moment[0], abs=1e-6 * moment)


def test_a_moment_is_a_goal_with_bounds_in_newton_meters():
    limit = {
        "metric": "reaction_moment",
        "region": {"x": [0, 0]},
        "about": [0, "5 mm", "5 mm"],
        "max": "1 N*mm",
    }
    design = cantilever(constraints={"twist": limit})
    assert design.constraints["twist"].max == 1e-3
    assert vs.simulate(design).metrics["twist"] == pytest.approx(1e-6 * LENGTH, rel=1e-4)
    found = vs.check(cantilever(constraints={"twist": {**limit, "max": "1 N"}}))
    assert not found.valid
    with pytest.raises(DesignError, match="no lever about a point"):
        vs.simulate(cantilever()).metric("reaction", about=(0, 0, 0))
    with pytest.raises(DesignError, match='no clamp "roof"'):
        vs.simulate(cantilever()).metric("reaction_moment", clamp="roof")
