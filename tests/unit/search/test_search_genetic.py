"""The paper's genetic algorithm: its elite, its selection, and that it finds an optimum."""

import numpy as np
import pytest

from voxsoft.errors import StudyError
from voxsoft.search import Genetic


def fitness_near(target, candidates):
    return np.exp(-10 * np.linalg.norm(candidates - target, axis=1))


def run(search, generations, target=(0.3, 0.7)):
    for _ in range(generations):
        search.tell(fitness_near(np.asarray(target), search.ask()))
    return search


def test_paper_settings_find_the_optimum_of_a_peak():
    best = [run(Genetic(genes=2, seed=seed), 50).best.genes for seed in range(20)]
    distances = np.linalg.norm(np.array(best) - [0.3, 0.7], axis=1)
    # About 100 different values per gene are ever drawn, so that the nearest one is 0.005 away.
    assert np.median(distances) < 0.02
    assert distances.max() < 0.1


def test_it_beats_blind_search_where_genes_are_many():
    target = np.full(8, 0.4)
    bred = [run(Genetic(genes=8, seed=seed), 50, target).best.fitness for seed in range(5)]
    blind = [
        fitness_near(target, np.random.default_rng(seed).random((1500, 8))).max()
        for seed in range(5)
    ]
    assert min(bred) > max(blind)


def test_defaults_are_those_of_algorithm_4():
    search = Genetic(genes=2, seed=0)
    assert (search.ask().shape, search.elites, search.mutation) == ((30, 2), 2, 0.05)


def test_elites_come_first_unchanged():
    search = Genetic(genes=3, population=6, elites=2, seed=3)
    before, fitness = search.ask(), np.array([0.1, 0.9, 0.3, 0.9, 0.2, 0.0])
    search.tell(fitness)
    assert np.array_equal(search.ask()[:2], before[[1, 3]])


def test_the_best_is_remembered_even_without_elites():
    search = Genetic(genes=1, population=4, elites=0, seed=0)
    first = search.ask()
    search.tell([0.0, 5.0, 1.0, 0.0])
    search.tell([0.1, 0.2, 0.0, 0.0])
    assert search.best.fitness == 5.0
    assert np.array_equal(search.best.genes, first[1])


def test_children_take_each_gene_from_one_of_two_fit_parents():
    search = Genetic(genes=40, population=20, elites=0, mutation=0.0, seed=5)
    before, fitness = search.ask(), np.zeros(20)
    fitness[[4, 9]] = 1.0
    search.tell(fitness)
    from_four, from_nine = search.ask() == before[4], search.ask() == before[9]
    assert (from_four | from_nine).all()
    mixed = from_four.any(axis=1) & from_nine.any(axis=1)
    # Both parents the same has probability 1/2.
    assert 3 <= mixed.sum() <= 17
    assert 0.3 < from_four[mixed].mean() < 0.7


def test_selection_is_in_proportion_to_fitness():
    search = Genetic(genes=1, population=20_000, elites=0, mutation=0.0, seed=8)
    before = search.ask()[:, 0]
    fitness = np.where(before < 0.5, 3.0, 1.0)
    search.tell(fitness)
    share = (search.ask()[:, 0] < 0.5).mean()
    expected = fitness[before < 0.5].sum() / fitness.sum()
    assert share == pytest.approx(expected, abs=4 * np.sqrt(0.25 * 0.75 / 20_000))


def test_genes_mutate_at_the_given_rate_and_stay_within_bounds():
    search = Genetic(genes=50, population=400, elites=0, mutation=0.05, seed=2)
    before, only_first = search.ask()[0], np.eye(1, 400)[0]
    search.tell(only_first)
    changed = search.ask() != before
    assert changed.mean() == pytest.approx(0.05, abs=4 * np.sqrt(0.05 * 0.95 / 20_000))
    assert search.ask().min() >= 0.0
    assert search.ask().max() <= 1.0


def test_all_zero_fitness_picks_parents_uniformly():
    search = Genetic(genes=1, population=5000, elites=0, mutation=0.0, seed=0)
    before = search.ask()[:, 0]
    search.tell(np.zeros(5000))
    after = search.ask()[:, 0]
    assert np.isin(after, before).all()
    # Drawing n of n with replacement leaves out a share of 1/e.
    assert len(np.unique(after)) / 5000 == pytest.approx(1 - np.exp(-1), abs=0.03)


def test_the_extremes_of_floats_do_not_spoil_the_wheel():
    search = Genetic(genes=1, population=4, elites=1, seed=0)
    search.tell([1e308, 1e308, 1e308, 1e308])
    search.tell([5e-324, 0.0, 0.0, 0.0])
    assert np.isfinite(search.ask()).all()


def test_the_seed_decides_everything():
    one, same, other = (run(Genetic(genes=2, seed=s), 5).ask() for s in (7, 7, 8))
    assert np.array_equal(one, same)
    assert not np.array_equal(one, other)


def test_asking_again_changes_nothing_and_the_answer_is_a_copy():
    search = Genetic(genes=2, seed=0)
    asked = search.ask()
    asked[:] = -1.0
    assert search.ask().min() >= 0.0


@pytest.mark.parametrize("bad", [np.nan, np.inf, -1e-9])
def test_impossible_fitness_names_the_individual(bad):
    search = Genetic(genes=2, population=3, elites=1, seed=0)
    with pytest.raises(StudyError, match="individual 1 of generation 0"):
        search.tell([0.5, bad, 0.5])
    assert search.generation == 0


def test_fitness_of_another_shape_is_refused():
    with pytest.raises(StudyError, match=r"\(2,\); expected one number for each of the 3"):
        Genetic(genes=2, population=3, elites=1).tell([1.0, 2.0])


@pytest.mark.parametrize(
    ("settings", "name"),
    [
        ({"genes": 0}, "genes"),
        ({"genes": 1, "population": 1}, "population"),
        ({"genes": 1, "population": 4, "elites": 4}, "elites"),
        ({"genes": 1, "mutation": 1.5}, "mutation"),
        ({"genes": 1, "mutation": float("nan")}, "mutation"),
    ],
)
def test_settings_outside_their_range_are_named(settings, name):
    with pytest.raises(StudyError, match=f"^{name}: "):
        Genetic(**settings)


def test_best_before_any_fitness_gives_a_remedy():
    with pytest.raises(StudyError, match=r"tell\(fitness\)"):
        _ = Genetic(genes=1).best
