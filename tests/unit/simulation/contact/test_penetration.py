"""Reports of results about a body that is in itself, in its films or in its floor."""

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

from voxsoft import files
from voxsoft.design import Design, families
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.errors import MeshError
from voxsoft.simulation import Setup, find_penetration, simulate
from voxsoft.simulation.checks.overlaps import overlap_warnings, penetration_of
from voxsoft.study.outcome import Outcome, evaluate_design
from voxsoft.study.trial import outcome_of, record_of
from voxsoft.voxels import Voxels

EXAMPLES = sorted(Path("examples").glob("*.toml"))

#: Examples of many voxels.
LARGE = {"bellows", "starfish", "wound_bender", "wound_tube"}
PUSHED = Path(__file__).parents[3] / "data" / "pushed.toml"


def design(text: str) -> Design:
    return Design.from_document(tomllib.loads(text))


@pytest.fixture(scope="module")
def pressed():
    return simulate(files.load(PUSHED))


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, marks=pytest.mark.slow if path.stem in LARGE else (), id=path.stem)
        for path in EXAMPLES
    ],
)
def test_no_shipped_example_is_in_itself_unloaded(path):
    setup = Setup.of(files.load(path), allow_loose=True)
    found = penetration_of(setup.design, setup.mesh, setup.mesh.vertices)
    assert found.overlaps == ()
    assert len(found.pairs) == 0


def test_bodies_of_hinges_and_full_cavities_are_not_in_themselves():
    """Voxels at random touch along edges and at corners in all ways there are."""
    random = np.random.default_rng(7)
    for density in (0.2, 0.5, 0.8):
        cells = (random.random((8, 8, 8)) < density).astype(np.uint8)
        mesh = Voxels.from_array(cells, voxel_size=0.01).mesh()
        assert find_penetration(mesh, mesh.vertices).overlaps == ()


def test_a_result_tells_depth_and_place(pressed):
    assert pressed.status == "ok"
    # The slab gives way to its weight by about rho g h^2 / E, 1e-6 m.
    assert pressed.penetration.depth == pytest.approx(0.002, abs=3e-6)
    deepest = pressed.penetration.overlaps[0]
    assert deepest.at_now[2] == pytest.approx(0.008, abs=1e-5)
    assert deepest.parts == (2, 1)
    assert deepest.at_rest[2] == pytest.approx(0.02, abs=1e-9)
    assert deepest.against[2] == pytest.approx(0.008, abs=1e-5)


def test_summary_metrics_and_warnings_say_the_same(pressed):
    depth = pressed.penetration.depth
    reported = json.loads(json.dumps(pressed.summary()))
    assert (
        reported["penetration"]
        == reported["metrics"]["penetration"]
        == depth
        == pressed.metric("penetration")
    )
    warning = next(each for each in reported["warnings"] if "overlap" in each["what"])
    assert warning["where"] in ("bar and slab", "slab and bar")
    assert warning["what"].startswith(f"overlap by {depth * 1e3:.2g} mm near (")
    assert warning["what"].endswith("contact is not simulated")
    assert warning["severity"] == "warning"
    assert warning["at"] == list(pressed.penetration.overlaps[0].at_rest)


def test_a_body_that_is_free_of_itself_has_no_warning_and_no_depth():
    result = simulate(files.load(PUSHED, assignments=["push=9 mm"]))
    assert result.penetration.depth == 0.0
    assert result.warnings == ()


def test_a_trial_and_its_record_keep_doubts(pressed):
    outcome = evaluate_design(pressed.design)
    assert outcome.status == "ok"
    assert outcome.metrics["penetration"] == pytest.approx(pressed.penetration.depth)
    assert outcome.warnings == tuple(map(str, pressed.warnings))
    record = json.loads(json.dumps(record_of(outcome, "", None)))
    assert outcome_of(record) == outcome
    del record["warnings"]  # as journals of 0.1.0 are
    assert outcome_of(record) == Outcome("ok", outcome.message, outcome.metrics, outcome.seconds)


def test_a_design_can_ask_that_its_walls_stay_apart(pressed):
    asked = pressed.design.replace(
        constraints={"apart": {"metric": "penetration", "max": "0.1 mm"}}
    )
    assert simulate(asked).metrics["apart"] == pytest.approx(pressed.penetration.depth)


def test_below_the_floor_is_reported():
    low = files.load(PUSHED).replace(floor={"z": "-20 mm"})
    mesh = mesh_of(low)
    assert list(overlap_warnings(low, mesh, mesh.vertices - [0.0, 0.0, 0.02])) == []
    sunk = mesh.vertices - [0.0, 0.0, 0.023]
    (found,) = overlap_warnings(low, mesh, sunk)
    assert (found.where, found.what[:32]) == ("slab", "is below the floor by 3 mm near ")
    assert penetration_of(low, mesh, sunk).overlaps[0].parts == (1, -1)


def test_films_over_openings_count():
    """A cup, its mouth closed by a film, and a loose block above that comes down through it."""
    text = """
        schema = "voxsoft/1"
        name = "cup"
        voxel_size = "5 mm"
        [shapes]
        block = { kind = "box", size = ["30 mm", "30 mm", "20 mm"], corner = [0, 0, 0] }
        room.kind = "box"
        room.size = ["20 mm", "20 mm", "15 mm"]
        room.corner = ["5 mm", "5 mm", "5 mm"]
        cup   = { kind = "difference", of = ["block", "room"] }
        plug.kind = "box"
        plug.size = ["10 mm", "10 mm", "10 mm"]
        plug.corner = ["10 mm", "10 mm", "25 mm"]
        both  = { kind = "union", of = ["cup", "plug"] }
        [[parts]]
        shape = "both"
        material = { model = "neo-hookean", young = "100 kPa", poisson = 0.4 }
        [[layers]]
        region = { z = ["20 mm", "20 mm"], x = [0, "30 mm"], y = [0, "30 mm"] }
        young = "1 GPa"
        thickness = "0.1 mm"
        seal = true
        [[clamps]]
        region = { x = [0, "30 mm"] }
    """
    cup = design(text)
    setup = Setup(cup, mesh_of(cup))
    plug = setup.mesh.vertices[:, 2] > 0.024
    moved = setup.mesh.vertices.copy()
    assert penetration_of(cup, setup.mesh, moved).overlaps == ()
    moved[plug] -= [0.0, 0.0, 0.007]
    found = penetration_of(cup, setup.mesh, moved)
    assert find_penetration(setup.mesh, moved).overlaps == ()
    assert 0 in found.overlaps[0].parts
    assert found.depth == pytest.approx(0.002)


def test_cut_voxels_count_by_their_shape():
    """The voxels of two balls of 9.3 mm reach 0.7 mm out of them at the poles."""
    text = """
        schema = "voxsoft/1"
        name = "balls"
        voxel_size = "2 mm"
        fill = "fraction"
        [shapes]
        low  = { kind = "sphere", radius = "9.3 mm", center = [0, 0, 0] }
        high = { kind = "sphere", radius = "9.3 mm", center = [0, 0, "30 mm"] }
        both = { kind = "union", of = ["low", "high"] }
        [[parts]]
        shape = "both"
        material = { model = "neo-hookean", young = "100 kPa", poisson = 0.4 }
        [[clamps]]
        region = { x = [0, 0] }
    """
    balls = design(text)
    mesh = mesh_of(balls)

    def lowered(by):
        moved = mesh.vertices.copy()
        moved[mesh.vertices[:, 2] > 0.015] -= [0.0, 0.0, by]
        return moved

    near = lowered(0.0113)
    assert find_penetration(mesh, near).depth > 0.0005  # the voxels are in each other
    assert penetration_of(balls, mesh, near).depth == 0.0
    # 1 mm past touching; vertices 2 mm apart do not hit the deepest point.
    assert penetration_of(balls, mesh, lowered(0.0124)).depth == pytest.approx(0.001, rel=0.2)


def test_positions_are_checked():
    mesh = mesh_of(families.beam())
    with pytest.raises(MeshError, match="one row for each vertex"):
        find_penetration(mesh, mesh.vertices[1:])
    lost = mesh.vertices.copy()
    lost[0, 0] = np.nan
    with pytest.raises(MeshError, match="finite"):
        find_penetration(mesh, lost)
    assert list(overlap_warnings(families.beam(), mesh, lost)) == []
