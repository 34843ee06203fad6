"""Calibrations of synthetic data: known moduli come back, and doubt is said."""

import json

import lattice_families as families
import numpy as np
import pytest

from voxsoft.calibration import Experiment, Measurement, calibrate
from voxsoft.calibration.misfit import Deviation
from voxsoft.calibration.result import Fit
from voxsoft.design import Design
from voxsoft.errors import MeasurementError, SimulationError, StudyError
from voxsoft.files.calibrations import write_calibration
from voxsoft.files.cards import load_card_file
from voxsoft.materials import Lattice
from voxsoft.simulation import simulate

BEAM = {"edge": 12e3, "bulk": 30e3}
BLOCK = {"edge": 15e3, "bulk": 20e3}


def observed(design, truth, quantities, noise, line="lower-edge", **stations):
    """Measure a simulated body with Gaussian noise (in m)."""
    material = {"model": "lattice", "edge": truth["edge"], "bulk": truth["bulk"]}
    document = design.document
    document["parts"][0]["material"] = material
    true = Design.from_document(document, from_file=False)
    count = len(next(iter(stations.values())))
    blank = Measurement(
        quantities=quantities, values=np.zeros((count, len(quantities))), **stations
    )
    probe = Experiment(true, _plausible(blank), line)
    seen = probe.seen_at(simulate(probe.setup, tolerance=1e-6).positions)
    seen = seen + noise * np.random.default_rng(0).normal(size=seen.shape)
    return Experiment(
        true, Measurement(quantities=quantities, values=seen, name="synthetic", **stations)
    )


def _plausible(blank):
    """Zeros are no positions of a beam; arcs pass for them until the body has been simulated."""
    if blank.arcs is None:
        return blank
    values = np.where(blank.are_positions, blank.arcs[:, None], blank.values)
    return Measurement(quantities=blank.quantities, values=values, arcs=blank.arcs)


@pytest.fixture(scope="module")
def bent():
    """A sagging beam seen on a photograph: bending, and next to no change of volume."""
    beam = families.beam().with_parameters(length="60 mm")
    arcs = np.arange(1, 6) * 10e-3
    return observed(beam, BEAM, ("x", "dz"), noise=2e-4, arcs=arcs)


@pytest.mark.parametrize(("line", "caution"), [("lower-edge", ""), ("centerline", "deviate alike")])
def test_marks_on_another_line_than_assumed_are_cautioned_of(line, caution):
    beam = families.beam().with_parameters(length="60 mm")
    arcs = np.arange(1, 10) * 5e-3
    right = observed(beam, BEAM, ("x", "dz"), noise=2e-4, line=line, arcs=arcs)
    assumed = Experiment(right.design, right.measurement)
    found = calibrate(assumed, "gradient", parameters={"edge": (6e3, 24e3)}, identify=False)
    (fit,) = found.fits
    assert caution in fit.caution
    assert fit.is_systematic == bool(caution)
    assert caution in found.card("x").caution
    if caution:
        assert "the marks were on the lower edge" in fit.caution


@pytest.mark.parametrize(
    ("share", "alike", "is_missed"),
    [(0.2, True, True), (0.2, False, True), (0.02, True, True), (0.02, False, False)],
)
def test_a_model_that_misses_more_than_marks_are_misread_says_where(share, alike, is_missed):
    arcs = np.arange(1, 10) * 5e-3
    values = np.column_stack([arcs, -10.0 * arcs**2])
    seen = Measurement(quantities=["x", "dz"], values=values, arcs=arcs, name="coupon")
    tested = Experiment(families.beam().with_parameters(length="60 mm"), seen)
    signs = np.ones(9) if alike else np.where(np.arange(9) % 2, -1.0, 1.0)
    off = np.column_stack([np.zeros(9), share * tested.sag * signs])
    off[6] *= 1.5
    fit = Fit(tested, Deviation(values + off, values, 1.0, np.zeros((0, 3))))
    assert bool(fit.miss) == is_missed
    if is_missed:
        assert "coupon: the model misses by up to" in fit.miss
        assert "at arc 35 mm: try finer voxels" in fit.miss


@pytest.fixture(scope="module")
def squeezed():
    """A block under pressure between greased plates: its sides tell its volume."""
    points = {
        f"p{index}": {"point": [f"{x} mm", f"{y} mm", f"{z} mm"]}
        for index, (x, y, z) in enumerate([(10, 5, 10), (10, 10, 5), (5, 10, 10), (10, 10, 10)])
    }
    block = Design.from_document(
        {
            "name": "block",
            "voxel_size": "5 mm",
            "shapes": {"body": {"kind": "box", "size": ["10 mm", "10 mm", "10 mm"]}},
            "parts": [{"shape": "body", "material": "ecoflex-00-30-lattice"}],
            "clamps": [{"region": {axis: [0, 0]}, "axes": axis} for axis in "xyz"],
            "loads": [
                {
                    "kind": "traction",
                    "region": {"z": ["10 mm", "10 mm"]},
                    "value": [0, 0, "-6 kPa"],
                }
            ],
            "probes": points,
        }
    )
    return observed(block, BLOCK, ("dx", "dy", "dz"), noise=2e-5, probes=tuple(points))


@pytest.mark.parametrize("method", ["genetic", "cma-es", "tpe"])
def test_the_modulus_of_a_beam_comes_back(bent, method):
    found = calibrate(
        bent,
        method,
        parameters={"edge": ("1 kPa", "1 MPa")},
        generations=4,
        population=8,
        seed=3,
        identify=False,
    )
    # Noise of 0.2 mm on a sag of 20 mm, and bulk held at its true value.
    assert found.parameters["edge"] == pytest.approx(BEAM["edge"], rel=0.02)
    assert found.material.bulk == BEAM["bulk"]
    assert found.mean_error < 4e-4
    assert found.mean_error <= found.search.error


def test_bending_does_not_identify_bulk(bent):
    # The ends of the range are far from the truth, and cost nothing to search.
    ranges = {"edge": ("4 kPa", "40 kPa"), "bulk": ("2 kPa", "300 kPa")}
    found = calibrate(bent, "cma-es", parameters=ranges, generations=8, population=6, seed=1)
    assert found.identifiable == {"edge": True, "bulk": False}
    edge, _ = found.profiles
    assert edge.low < BEAM["edge"] < edge.high
    assert edge.low < found.parameters["edge"] < edge.high


def test_a_squeezed_block_identifies_both(squeezed):
    found = calibrate(squeezed, "cma-es", generations=15, population=6, seed=1)
    assert found.identifiable == {"edge": True, "bulk": True}
    for profile in found.profiles:
        assert profile.low < BLOCK[profile.name] < profile.high
        assert found.parameters[profile.name] == pytest.approx(BLOCK[profile.name], rel=0.05)
        # The error rises away from the optimum, on both sides.
        best = int(np.argmin(profile.errors))
        assert (np.diff(profile.errors[: best + 1]) < 0).all()
        assert (np.diff(profile.errors[best:]) > 0).all()


def test_two_experiments_share_one_material(bent, squeezed):
    both = calibrate(
        [bent, observed(squeezed.design, BEAM, ("dx", "dy", "dz"), 2e-5, probes=("p0", "p1"))],
        "cma-es",
        parameters={"edge": ("4 kPa", "40 kPa"), "bulk": ("2 kPa", "300 kPa")},
        generations=6,
        population=6,
        identify=False,
    )
    assert both.parameters["edge"] == pytest.approx(BEAM["edge"], rel=0.03)
    assert [len(fit.errors) for fit in both.fits] == [5, 2]


def test_a_wrong_photo_scale_is_found(bent):
    stretched = Measurement(
        quantities=("x", "dz"), values=1.1 * bent.measurement.values, arcs=bent.measurement.arcs
    )
    found = calibrate(
        Experiment(bent.design, stretched),
        "cma-es",
        parameters={"edge": ("4 kPa", "40 kPa")},
        free_scale=True,
        generations=5,
        population=6,
        identify=False,
    )
    assert found.scale == pytest.approx(1.1, rel=0.01)
    assert found.parameters["edge"] == pytest.approx(BEAM["edge"], rel=0.04)


def test_workers_do_not_change_the_answer(bent):
    def run(workers):
        return calibrate(
            bent,
            generations=3,
            population=6,
            seed=5,
            workers=workers,
            parameters={"edge": ("5 kPa", "50 kPa")},
        )

    alone, threaded = run(1).summary(), run(3).summary()
    assert alone == threaded


def test_generations_are_kept(bent):
    events = []
    found = calibrate(
        bent,
        generations=6,
        population=5,
        seed=2,
        refine=False,
        identify=False,
        progress=events.append,
    )
    assert [event.done for event in events if event.stage == "search"] == [1, 2, 3, 4, 5, 6]
    assert len(found.history) == 6
    best = [generation.best_fitness for generation in found.history]
    # Two elites stay, so the best never gets worse.
    assert best == sorted(best)
    for generation in found.history:
        assert generation.mean_fitness <= generation.best_fitness
        assert set(generation.parameters) == {"edge", "bulk"}
    assert found.search.fitness == best[-1]
    assert found.search.evaluations <= 5 + 5 * 3


def test_without_refinement_the_search_is_the_answer(bent):
    found = calibrate(bent, generations=2, population=5, refine=False, identify=False)
    assert dict(found.search.parameters) == dict(found.parameters)
    assert found.search.error == found.mean_error
    assert found.profiles == ()


def test_percent_is_of_the_measured_sag(bent):
    found = calibrate(bent, generations=1, population=5, refine=False, identify=False)
    (fit,) = found.fits
    sag = -bent.measurement.values[:, 1].min()
    np.testing.assert_allclose(fit.percent, 100 * fit.errors / sag)


def test_a_folder_holds_card_record_and_tables(bent, tmp_path):
    found = calibrate(bent, generations=2, population=5, refine=False, identify=False)
    path, *_ = write_calibration(found, tmp_path / "run", "my-silicone")
    card = load_card_file(path)
    assert card.name == "my-silicone"
    assert card.material.edge == pytest.approx(found.parameters["edge"], rel=1e-3)
    assert isinstance(card.material, Lattice)
    assert card.calibration["voxel_size"] == ["5 mm"]
    assert card.calibration["seed"] == 0
    record = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert record["mean_error"] == found.mean_error
    assert len((tmp_path / "run" / "history.csv").read_text().splitlines()) == 3
    shapes = (tmp_path / "run" / "shapes.csv").read_text().splitlines()
    assert len(shapes) == 1 + 5 * 2


def test_fewer_stations_than_parameters(bent):
    one = Measurement(quantities=("x", "dz"), values=[[0.03, -0.02]], arcs=[0.04])
    with pytest.raises(MeasurementError, match="there are 1 for 2 parameters"):
        calibrate(Experiment(bent.design, one))
    two = Measurement(quantities=("dz",), values=[[-0.01], [-0.02]], arcs=[0.03, 0.04])
    with pytest.raises(MeasurementError, match="2 for 3 parameters and scales"):
        calibrate(Experiment(bent.design, two), free_scale=True)
    with pytest.raises(MeasurementError, match="there are none"):
        calibrate([])


def test_impossible_budgets(bent):
    with pytest.raises(StudyError, match="0 generations"):
        calibrate(bent, generations=0)
    with pytest.raises(StudyError, match="-1 cannot work"):
        calibrate(bent, workers=-1)


def test_nothing_comes_to_rest(bent, monkeypatch):
    monkeypatch.setattr("voxsoft.calibration.misfit._MAX_STEPS", 3)
    with pytest.raises(SimulationError, match=r"no candidate came to rest.*not-at-rest"):
        calibrate(bent, generations=1, population=4, lanes=False)
