"""Random bodies squeezed to half their height: no crash, no NaN, no hang, and nothing in a plate.

The squeezed bodies, and the judges, are those of `evidence/squeeze.py`, whose figures are in
`docs/method/contact.md`: walls of a body may still pass through each other, which it counts.
"""

import sys
from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.simulation import Setup
from voxsoft.simulation.checks.crossed_surfaces import crossed_surfaces

EVIDENCE = Path(__file__).parents[2] / "evidence"
# So small that one takes a second or two.
SMALL = (20, 60)
# They came to half their height without any faces through each other when this was written.
SOUND = (2, 10)


@pytest.fixture(autouse=True)
def beside_the_evidence(monkeypatch):
    monkeypatch.syspath_prepend(str(EVIDENCE))
    monkeypatch.setattr(sys, "argv", ["benchmark"])


def assert_orderly(verdict):
    # No numbers, a hang, an exception, and faces that one judge alone sees are never excused.
    allowed = {"penetrates, called at rest", "penetrates, ends early", "ends early"}
    assert verdict.kind in allowed or verdict.kind.startswith("at half its height"), verdict
    assert verdict.plates == 0, verdict
    assert verdict.points > 0


@pytest.mark.long
@pytest.mark.parametrize(
    "seed", [14, *(pytest.param(n, marks=pytest.mark.slow) for n in (2, 3, 6, 10, 17))]
)
def test_a_random_body_is_squeezed(seed):
    from squeeze_bodies import judged

    verdict = judged(seed, SMALL)
    assert_orderly(verdict)
    if seed in SOUND:
        assert verdict.kind == "at half its height"


#: Iterations by which a body is given up: four times the 511 that it takes.
MOST = 2000


@pytest.mark.long
def test_iterations_of_a_body_in_contact_end():
    from squeeze_bodies import squeezed

    def count(iterations, _time, _residual):
        assert iterations < MOST

    # Exact first rounds at a point where nothing touched for a moment went in circles without end.
    result = vs.simulate(squeezed(37), progress=count)
    assert result.status == "ok"
    assert result.load_factor == 1.0


def warned(seed):
    from squeeze_bodies import squeezed

    result = vs.simulate(squeezed(seed, SMALL))
    assert result.status == "ok"
    return result, [str(each) for each in result.warnings]


@pytest.mark.slow
def test_snapping_is_reported():
    # It buckles on its way.
    result, warnings = warned(7)
    assert result.snaps
    assert all(0.5 < snap < 1.0 for snap in result.snaps)
    assert any("snapped to another one" in each for each in warnings)


@pytest.mark.long
def test_folding_into_itself_is_reported():
    # A crease is in itself, as both judges of `judged` find.
    from squeeze_bodies import judged

    _, warnings = warned(14)
    assert any("is folded into itself" in each for each in warnings)
    assert judged(14, SMALL).folds > 0


def test_a_body_that_is_folded_onto_itself_passes_through_itself():
    from squeeze_bodies import squeezed

    setup = Setup.of(squeezed(3, SMALL))
    rest = setup.mesh.vertices
    assert not list(crossed_surfaces(setup.design, setup.mesh, rest))
    middle = rest[:, 2].mean()
    over = np.where(rest[:, 2:] > middle, 2 * middle - rest[:, 2:], rest[:, 2:])
    shifted = np.hstack([rest[:, :2] + 0.002 * (over != rest[:, 2:]), over])
    (warning,) = crossed_surfaces(setup.design, setup.mesh, shifted)
    assert "pass through each other near" in str(warning)


def test_walls_a_voxel_apart_that_have_passed_through_each_other_are_seen():
    # A "U" whose slit is one voxel wide, nearer than a crease but far along the surface.
    size = 0.001
    block = vs.Box(size=(5 * size, 4 * size, 8 * size), center=(2.5 * size, 2 * size, 4 * size))
    slit = vs.Box(size=(size, 4 * size, 6 * size), center=(2.5 * size, 2 * size, 5 * size))
    design = vs.Design(
        name="slit",
        voxel_size=size,
        parts=[vs.Part(shape=block - slit, material=vs.NeoHookean(young=1e5, poisson=0.45))],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Gravity()],
        contact={},
    )
    mesh = Setup.of(design).mesh
    x, z = mesh.vertices[:, 0], mesh.vertices[:, 2]
    # Both walls lean over the slit; at their ends, by 0.7 voxels each.
    lean = 0.7 * size * (z / (8 * size)) ** 2 * np.where(x < 2.5 * size, 1.0, -1.0)
    leaned = mesh.vertices + np.stack([lean, 0 * lean, 0 * lean], axis=1)
    (warning,) = crossed_surfaces(design, mesh, leaned)
    assert "pass through each other near" in str(warning)
    assert not list(crossed_surfaces(design, mesh, mesh.vertices + (leaned - mesh.vertices) * 0.6))


@pytest.mark.slow
@pytest.mark.timeout(4 * 3600)
def test_a_thousand_random_bodies_are_squeezed():
    from squeeze import squeeze

    for verdict in squeeze(range(1000), SMALL, jobs=2, limit=120.0):
        assert_orderly(verdict)


def test_both_judges_see_a_body_in_a_plate_and_in_itself():
    from crossing_faces import Faces
    from squeeze_bodies import squeezed

    setup = Setup.of(squeezed(3, SMALL))
    faces, rest = Faces(setup), setup.mesh.vertices
    assert faces.crossings(faces.at(rest, 0.0))[0] == 0
    assert not faces.crosses_by_ipctk(faces.at(rest, 0.0))
    sunk = faces.at(rest - [0.0, 0.0, 0.2 * setup.design.voxel_size], 0.0)
    assert faces.crossings(sunk)[1] > 0
    assert faces.crosses_by_ipctk(sunk)
    # The upper half turned over onto the lower one.
    middle = rest[:, 2].mean()
    over = np.where(rest[:, 2:] > middle, 2 * middle - rest[:, 2:], rest[:, 2:])
    shifted = np.hstack([rest[:, :2] + 0.3 * setup.design.voxel_size * (over != rest[:, 2:]), over])
    folded = faces.at(shifted, 0.0)
    assert sum(faces.crossings(folded)[:3]) > 0
    assert faces.crosses_by_ipctk(folded)


@pytest.mark.long
def test_the_two_sides_of_a_thin_wall_do_not_meet():
    # Thinner than the quarter of a voxel that a sample may be behind the surface it meets.
    sheet = vs.Box(size=(0.02, 0.01, 0.0002), center=(0.01, 0.005, 0.0005))
    result = vs.simulate(
        vs.Design(
            name="sheet",
            voxel_size=0.001,
            fill="binary",
            parts=[vs.Part(shape=sheet, material=vs.NeoHookean(young=1e5, poisson=0.45))],
            clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
            loads=[vs.Gravity()],
            contact={},
        )
    )
    assert result.status == "ok"
    assert result.contacts == ()
