"""The paper's beams and six reference beams with hyperelastic voxels and one modulus."""

import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
#: Mean errors in mm that were hoped for: one modulus; one modulus and one scale.
ALONE = {"00-20": 4.7, "00-30": 4.5, "00-50": 2.2}
#: Seen are 1.57, 1.20 and 0.83: a beam theory reaches 1.3, 1.0 and 0.7.
SCALED = {"00-20": 1.6, "00-30": 1.2, "00-50": 0.85}


def imported(folder, name):
    sys.path.insert(0, str(ROOT / folder))
    try:
        return __import__(name)
    finally:
        sys.path.remove(str(ROOT / folder))


@pytest.fixture(scope="module")
def paper():
    return imported("examples/validation", "paper_beams")


@pytest.fixture(scope="module")
def accuracy():
    return imported("evidence", "accuracy")


def test_elements_of_5_mm_already_beat_the_paper(paper):
    """Voxels of 5 mm alone fit as well as two sizes, extrapolated: 2.16 and 2.18 mm."""
    found = paper.fit("00-50", free_scale=False, extrapolate=False)
    assert 1e3 * found.error < 2.4 < paper.PAPER["00-50"]
    assert found.scale == 1.0


@pytest.mark.slow
@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", ["00-20", "00-30", "00-50"])
def test_one_modulus_fits_each_beam(paper, name):
    alone, scaled = (paper.fit(name, free_scale=free) for free in (False, True))
    assert 1e3 * alone.error < ALONE[name]
    assert 1e3 * scaled.error < SCALED[name]
    # Beam theory reads 32.8, 61.4 and 121.5 kPa from the same marks.
    theory = {"00-20": 32.8e3, "00-30": 61.4e3, "00-50": 121.5e3}[name]
    assert alone.young == pytest.approx(theory, rel=0.04)


def test_six_beams_need_no_extrapolation(accuracy):
    """Voxels of 5 mm, two or four across, and nothing fitted: 2 % of the tip's displacement.

    Seen are 1.8, 0.8, 0.5, 0.2, 1.0 and 0.6 %, with voxels of 2.5 mm 1.5, 0.4, 0.6, 0.3, 0.7 and
    0.3 %. Without what voxels at a clamp draw in it was 3.6, 2.3, 3.4, 6.4, 6.0 and 6.0 %. The
    references themselves move by up to 0.3 % on refinement.
    """
    for beam in accuracy.beams():
        moved = accuracy.seen(accuracy.vs.simulate(beam.setup(accuracy.SOFT)), beam)
        assert np.linalg.norm(moved[-1] - beam.moved[-1]) < 0.02 * beam.reach, beam.name


@pytest.mark.parametrize("poisson", [0.3, 0.4999])
def test_short_beams_do_not_lock_at_their_clamps(accuracy, poisson):
    """Voxels of 5 and 2.5 mm are up to 0.94 % apart, and without the clamp's modes 3.6 %."""
    material = accuracy.vs.NeoHookean(young=60e3, poisson=poisson)
    for beam in accuracy.beams():
        if beam.name in "df":
            coarse, fine = (
                accuracy.seen(accuracy.vs.simulate(beam.setup(material, refine)), beam)[-1]
                for refine in (1, 2)
            )
            assert np.linalg.norm(coarse - fine) < 0.012 * np.linalg.norm(fine), beam.name


@pytest.mark.parametrize("poisson", [0.3, 0.499])
def test_elements_are_of_second_order_where_nothing_is_singular(accuracy, poisson):
    material = accuracy.vs.NeoHookean(young=60e3, poisson=poisson)
    errors = [accuracy.smooth_error(cells, material) for cells in (4, 8)]
    # Halving the size leaves a quarter; 1.8 is what the coarsest grid must not fall below.
    assert np.log2(errors[0] / errors[1]) > 1.8


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_the_cylinder_agrees_with_the_reading_of_soft_caps(paper):
    """2.3 mm were measured; the beam's 61 kPa predict it for soft caps and not for rigid ones."""
    soft, rigid = (paper.cylinder(61.3e3, rigid_caps=caps, voxel=2.5e-3) for caps in (False, True))
    assert soft == pytest.approx(paper.MEASURED_RISE, rel=0.12)
    assert rigid < 0.25 * paper.MEASURED_RISE
