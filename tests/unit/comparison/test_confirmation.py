"""Sentence about a study's ranking after its best designs were solved again."""

import lattice_families as families
import pytest

import voxsoft as vs
from voxsoft.comparison.confirmation import Confirmation, Confirmed, as_rubber, confirm
from voxsoft.comparison.richardson import discretization_error
from voxsoft.study import Trial

SIZES = (2e-3, 1e-3)


def trial(number, value):
    return Trial(number, {"w": number}, "ok", "", {"rise": value}, {}, True, f"{number}", None, 0.0)


def found(*pairs, message=""):
    """Trials 0, 1, ... of falling value in the study, and their values on both sizes."""
    designs = [
        Confirmed(trial(index, 1.0 - 0.1 * index), discretization_error(SIZES, pair))
        for index, pair in enumerate(pairs)
    ]
    if message:
        designs.append(Confirmed(trial(len(pairs), 0.0), None, message))
    return Confirmation("rise", {}, SIZES, tuple(designs), maximize=True)


@pytest.mark.parametrize(
    ("pairs", "message", "sentence"),
    [
        (([1, 1], [0.8, 0.8], [0.6, 0.6]), "", "the ranking is the same"),
        (([1, 1], [2, 2], [0.6, 0.6]), "", "the ranking differs: now 2, 1, 3"),
        # The errors are three times the changes of 0.1 and 0.01, and the values 0.2 apart.
        (
            ([0.9, 1.0], [0.79, 0.8]),
            "",
            "the ranking is the same; the first two are within their errors of each other",
        ),
        (
            ([1, 1], [2, 2]),
            "it did not come to rest",
            "the ranking differs: now 2, 1; 1 could not be solved again",
        ),
        (([1, 1],), "too thin", "too few of the designs could be solved again to rank them"),
    ],
)
def test_the_sentence_describes_the_new_ranking(pairs, message, sentence):
    confirmation = found(*pairs, message=message)
    assert confirmation.sentence == sentence
    assert confirmation.summary()["sentence"] == sentence


def test_every_lattice_of_a_card_becomes_its_rubber_and_others_stay():
    pneunet = families.pneunet()
    rubber, exchanged = as_rubber(pneunet)
    assert exchanged == {"ecoflex-00-30-lattice": "ecoflex-00-30"}
    assert [part.material for part in rubber.parts] == ["firm", "ecoflex-00-30"]


def test_a_study_of_lattices_is_confirmed_as_rubber_on_halved_voxels(tmp_path):
    beam = families.beam(length="30 mm")
    study = vs.Study(beam, {"length": ["30 mm", "40 mm"]}, folder=tmp_path).grid(workers=1)
    calls = []
    again = confirm(beam, study, count=2, progress=lambda done, total: calls.append((done, total)))
    assert again.voxel_sizes == (5e-3, 2.5e-3)
    assert calls == [(0, 4), (1, 4), (2, 4), (3, 4)]
    best = again.designs[0]
    alone = vs.simulate(
        families.beam(**best.trial.parameters).with_values(
            "parts.0.material=ecoflex-00-30", "voxel_size=2.5 mm"
        )
    )
    assert best.value == alone.metrics["sag"]
    assert best.estimate.error > 0
    assert not again.maximize


def test_a_design_that_cannot_be_solved_again_says_why(tmp_path):
    beam = families.beam(length="30 mm")
    study = vs.Study(beam, {"length": ["30 mm", "40 mm"]}, folder=tmp_path).grid(workers=1)
    nowhere = beam.with_values('probes.station-9={ point = ["1 m", 0, 0] }')
    again = confirm(nowhere, study, count=1)
    assert "station-9" in again.designs[0].message
    assert again.designs[0].value is None
