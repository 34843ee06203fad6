"""CalculiX and VoxSoft agree on contact: a plate, friction, walls of one body, a bellows."""

import csv
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.comparison import compare
from voxsoft.comparison.bricks import BrickModel
from voxsoft.design import Contact, Object, Solver
from voxsoft.files.calculix import run_calculix
from voxsoft.simulation import Setup, simulate
from voxsoft.units import kPa, mm

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "evidence"))

import contact_designs as designs  # noqa: E402

pytestmark = pytest.mark.skipif(
    shutil.which("ccx") is None, reason="CalculiX is not installed (apt install calculix-ccx)"
)


def test_a_block_under_a_plate_has_the_stress_of_the_closed_form():
    design, stress = designs.block_under_plate(4.0, 1.2, 4.0)
    answer = run_calculix(BrickModel.of(Setup.of(design)))
    force = -stress * (12 * mm) ** 2
    # The penalty leaves 0.385 E/(1000 E/4 mm) = 0.0015 mm of the way of 1.2 mm, 0.13 %, and the
    # stress grows by 1.1 times the growth of the way; the rest is the tolerance of the residual.
    assert answer.contacts["plate"][2] == pytest.approx(-force, rel=2e-3)
    # The forces that hold the plate and the block are one.
    held = answer.reaction
    assert held[2] == pytest.approx(force, rel=2e-3)
    np.testing.assert_allclose(held, -answer.contacts["plate"], atol=1e-4 * force)


def slid(friction):
    """A block of 8 mm under a plate that goes down by 1.2 mm and aside by 3 mm."""
    block = vs.Box(size=(8 * mm, 8 * mm, 8 * mm))
    plate = vs.Box(size=(24 * mm, 20 * mm, 4 * mm), center=(4 * mm, 4 * mm, 10.5 * mm))
    down = vs.Motion(displacement=(3 * mm, 0, -1.7 * mm))
    return vs.Design(
        name="slid",
        voxel_size=4 * mm,
        parts=[vs.Part(shape=block, material=vs.NeoHookean(young=100 * kPa, poisson=0.45))],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        objects=[Object(name="plate", shape=plate, motion=down)],
        contact=Contact(friction=friction),
        probes={"top": vs.Probe(z=(8 * mm, 8 * mm))},
    )


@pytest.mark.slow
def test_sliding_has_coulomb_friction_in_both():
    found = compare(slid(0.1), solvers=["statics"], voxel_sizes=[], splits=[1, 2])
    own, outside = found.base, found.yardstick
    assert own.ok
    assert outside is not None
    forces = {
        run.label: np.array([run.quantities[f"contact with plate {axis}"].value for axis in "xyz"])
        for run in (own, outside)
    }
    # All of it slips in the end: at each sample friction is its bound, but for 1 % at most.
    field = simulate(slid(0.1), method="statics", error="off").contact_field
    size = np.linalg.norm(field.friction, axis=1) @ field.area
    assert size == pytest.approx(0.1 * field.pressure @ field.area, rel=0.01)
    # The top bulges while it slides, up to 0.45 · 0.15 · 4 mm = 0.3 mm at its rims beside some
    # 1.6 mm of slip, and is pressed hardest there: directions differ by up to 20 degrees, so that
    # up to 1 - cos 20° = 6 % of the friction cancels; 2 % do, alike in both codes.
    shares = [-force[0] / (0.1 * force[2]) for force in forces.values()]
    assert all(0.94 < share < 1.0 for share in shares)
    assert shares[0] == pytest.approx(shares[1], rel=0.005)
    assert all(force[2] < 0.0 for force in forces.values())
    # On two voxels across ours is 5 % above, by the singular edge of the clamp: estimates say so.
    assert found.agrees("contact with plate z")


def test_two_blocks_of_one_body_press_each_other_alike():
    design = designs.two_blocks(2.0, 1.0).replace(solver=Solver())
    setup = Setup.of(design)
    own = simulate(setup)
    answer = run_calculix(BrickModel.of(setup))
    assert own.status == answer.status == "ok"
    # 1.8 % apart: ours is 2.7 % above the converged force on these voxels, by the singular corners
    # of the upper block (`docs/method/contact.md`), and the quadratic bricks are 0.9 % above it.
    assert answer.pressed == pytest.approx(force_within(own), rel=0.03)
    reference = row("two_blocks", friction=0, press_mm=1)["force_N_per_mm"]
    assert answer.pressed == pytest.approx(reference, rel=0.015)  # half of it for 2 mm


def force_within(result):
    """The force between the walls of the body in N."""
    return sum(contact.pressed for contact in result.contacts)


def row(name, **where):
    """A row of a reference of `tests/data/contact`."""
    path = ROOT / "tests" / "data" / "contact" / f"{name}.csv"
    with path.open(newline="", encoding="utf-8") as lines:
        rows = [{k: float(v or "nan") for k, v in each.items()} for each in csv.DictReader(lines)]
    return next(r for r in rows if all(abs(r[k] - v) < 1e-9 for k, v in where.items()))


@pytest.mark.slow
def test_a_bellows_closes_alike():
    """Two minutes of CalculiX; the blocks above are the quick one."""
    design = designs.bellows(1.0, 1.0).replace(solver=Solver())
    setup = Setup.of(design)
    own = simulate(setup)
    answer = run_calculix(BrickModel.of(setup))
    assert own.status == answer.status == "ok"
    expected = row("bellows", contact=1, pressure_kPa=1)
    # With two voxels a wall ours has 83 % of the converged force of the walls, which grows from
    # nothing as they meet; the quadratic bricks have 93 %. Displacements are within 0.5 % in both.
    assert 1e3 * answer.pressed == pytest.approx(1e3 * expected["force_N_per_mm"], rel=0.1)
    tip = setup.places["tip"]
    theirs = answer.displacements[tip.vertices].T @ tip.weights
    np.testing.assert_allclose(
        theirs[[0, 2]], own.probes["tip"][[0, 2]], atol=0.005 * abs(theirs[2])
    )
