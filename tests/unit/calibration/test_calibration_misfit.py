"""The misfit: the paper's fitness, the free scale, memory and threads."""

import math

import lattice_families as families
import numpy as np
import pytest

from voxsoft.calibration import Experiment, Measurement
from voxsoft.calibration.methods import method_named
from voxsoft.calibration.misfit import Misfit, best_scale
from voxsoft.calibration.space import DEFAULT_BOUNDS, Space
from voxsoft.errors import MaterialError, StudyError
from voxsoft.materials import CompliantLattice, Lattice


def experiment(stations=3, sag=1.0):
    arcs = np.linspace(0.0, 0.04, stations + 1)[1:]
    values = np.column_stack([arcs, -sag * arcs**2])
    return Experiment(
        families.beam().with_parameters(length="50 mm"),
        Measurement(quantities=["x", "dz"], values=values, arcs=arcs),
    )


def misfit(**settings):
    tested = experiment()
    return Misfit([tested], Space.of(None, tested.material), **settings)


@pytest.mark.parametrize(
    ("mean_error", "logged"), [(9.9e-3, 0.4106), (5.7e-3, 0.6001), (3.7e-3, 0.7152)]
)
def test_fitness_of_the_papers_logs(mean_error, logged):
    """Nine stations: the logged fitness is exp(-10 times the sum of the error vectors in m)."""
    tested = experiment(stations=9)
    found = Misfit([tested], Space.of(None, tested.material)).fitness(mean_error)
    assert found == pytest.approx(math.exp(-10 * 9 * mean_error), rel=1e-12)
    # The mean errors are known to 0.05 mm, which is 0.45 % of fitness.
    assert found == pytest.approx(logged, rel=5e-3)


def test_error_and_fitness_of_one_candidate():
    tested = misfit()
    (comparison,) = tested.compare([0.4, 0.3])
    lengths = np.hypot(*(comparison.simulated - comparison.measured).T)
    candidate = tested.at([0.4, 0.3])
    assert candidate.error == pytest.approx(lengths.mean(), rel=1e-12)
    assert candidate.fitness == pytest.approx(math.exp(-10 * lengths.sum()), rel=1e-12)


def test_experiments_weigh_the_same_whatever_their_stations():
    few, many = experiment(stations=2), experiment(stations=8, sag=4.0)
    space = Space.of(None, few.material)
    genes = [0.4, 0.3]
    apart = [Misfit([each], space).at(genes).error for each in (few, many)]
    assert apart[0] != pytest.approx(apart[1], rel=0.1)
    assert Misfit([few, many], space).at(genes).error == pytest.approx(np.mean(apart), rel=1e-12)


def test_scale_minimizes_the_sum_of_lengths():
    random = np.random.default_rng(4)
    simulated = random.normal(size=(9, 2))
    measured = 1.2 * simulated + 0.1 * random.normal(size=(9, 2))
    scale = best_scale(simulated, measured)

    def total(s):
        return np.linalg.norm(s * simulated - measured, axis=1).sum()

    assert all(total(scale) <= total(scale + step) for step in (-1e-4, -1e-6, 1e-6, 1e-4))


def test_free_scale_is_never_worse():
    genes = [0.4, 0.3]
    fixed, free = misfit().at(genes), misfit(free_scale=True).at(genes)
    assert fixed.scales == (1.0,)
    assert free.scales != (1.0,)
    assert free.error < fixed.error


def test_equal_genes_are_simulated_once_and_threads_change_nothing():
    genes = np.random.default_rng(1).random((6, 2))
    genes[5] = genes[0]
    alone, threaded = misfit(workers=1), misfit(workers=4)
    with alone.pool(), threaded.pool():
        first, second = alone.many(genes), threaded.many(genes)
    assert first == second
    assert first[5] is first[0]
    assert alone.evaluations == threaded.evaluations == 5


def test_candidate_that_fails_has_fitness_zero(monkeypatch):
    tested = misfit(lanes=False)
    monkeypatch.setattr("voxsoft.calibration.misfit._MAX_STEPS", 3)
    candidate = tested.at([0.4, 0.3])
    assert (candidate.status, candidate.fitness) == ("not-at-rest", 0.0)
    assert candidate.error == math.inf


def test_space_is_logarithmic_and_keeps_its_bounds():
    space = Space.of({"edge": ("1 kPa", "1 MPa")}, Lattice(edge=5e3, bulk=7e3))
    assert space.values([0.5])[0] == pytest.approx(10**4.5)
    assert space.values([0.0])[0] == 1e3
    assert space.values([1.0])[0] == 1e6
    assert space.material_at([1.0]) == Lattice(edge=1e6, bulk=7e3)
    assert set(Space.of(None, Lattice(edge=1.0, bulk=1.0)).names) == set(DEFAULT_BOUNDS)


@pytest.mark.parametrize(
    ("bounds", "message"),
    [
        ({}, "none is named"),
        ({"edg": (1, 2)}, r'edg: is not a modulus.*did you mean "edge"'),
        ({"edge": ("5 kPa", "1 kPa")}, "range 5 kPa to 1 kPa is empty"),
    ],
)
def test_bad_spaces(bounds, message):
    with pytest.raises(MaterialError, match=message):
        Space.of(bounds, Lattice(edge=1.0, bulk=1.0))


def test_only_the_lattice_is_calibrated():
    raw = CompliantLattice(edge_compliance=0.2, volume_compliance=0.05)
    with pytest.raises(MaterialError, match="lattice-compliance"):
        Space.of(None, raw)


def test_unknown_method_names_the_closest():
    with pytest.raises(StudyError, match='did you mean "genetic"'):
        method_named("genetics")
    with pytest.raises(StudyError, match='"grid" is not known'):
        method_named("grid")
