"""Every sampler runs by name, follows its seed, and sees constraints and failures."""

import importlib.util
import warnings

import optuna
import pytest
from optuna.distributions import CategoricalDistribution, FloatDistribution, IntDistribution
from optuna.trial import TrialState

from voxsoft.errors import MissingPackageError, StudyError
from voxsoft.search.genes import value_of_gene
from voxsoft.search.genetic_sampler import GeneticSampler
from voxsoft.search.samplers import SAMPLERS, grid_values, sampler_named

SPACE = {"x": FloatDistribution(0.0, 1.0, step=0.05), "y": IntDistribution(1, 20)}
MULTI = {"tpe", "nsga-ii", "nsga-iii", "random", "grid"}
# Gradients need trials that tell their slopes: tests/unit/study/test_study_gradient.py.
RUNNABLE = sorted(
    set(SAMPLERS) - {"gradient"} - (set() if importlib.util.find_spec("torch") else {"gp"})
)


@pytest.fixture(autouse=True)
def quiet():
    optuna.logging.set_verbosity(optuna.logging.WARNING)


def bowl(x, y):
    return (x - 0.3) ** 2 + ((y - 7) / 20) ** 2


def search(name, trials=40, *, seed=0, directions=("minimize",), constraints=None):
    sampler = sampler_named(name, SPACE, seed=seed, constraints=constraints)
    study = optuna.create_study(sampler=sampler, directions=list(directions))
    for _ in range(trials):
        trial = study.ask(SPACE)
        value = bowl(**trial.params)
        study.tell(trial, [value, 1 - value][: len(directions)])
    return study


@pytest.mark.parametrize("name", RUNNABLE)
def test_the_seed_decides_the_suggestions(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error", optuna.exceptions.ExperimentalWarning)
        one, same, other = (
            [trial.params for trial in search(name, seed=s).trials] for s in (3, 3, 4)
        )
    assert one == same
    assert one != other
    assert all(0 <= p["x"] <= 1 and 1 <= p["y"] <= 20 for p in one)


@pytest.mark.parametrize("name", sorted(set(RUNNABLE) - {"grid", "random"}))
def test_adaptive_samplers_come_closer_than_their_first_draws(name):
    study = search(name, trials=150)
    early, late = study.trials[:30], study.trials[-30:]
    mean = [sum(trial.value for trial in part) / 30 for part in (early, late)]
    assert mean[1] < 0.7 * mean[0]


@pytest.mark.parametrize("name", sorted(MULTI & set(RUNNABLE)))
def test_samplers_for_several_objectives_take_two(name):
    assert len(search(name, directions=("minimize", "maximize")).best_trials) >= 1


@pytest.mark.long
@pytest.mark.parametrize("name", ["genetic", "nsga-ii", "tpe"])
def test_constraints_keep_the_search_feasible(name):
    def at_most_half(trial):
        return [trial.params["x"] - 0.15]

    free = search(name, trials=200)
    held = search(name, trials=200, constraints=at_most_half)
    allowed = [sum(t.params["x"] <= 0.15 for t in study.trials[-60:]) for study in (free, held)]
    assert allowed[1] > allowed[0] + 15


@pytest.mark.parametrize(
    ("space", "message"),
    [
        ({"x": SPACE["x"]}, "at least two parameters"),
        ({**SPACE, "m": CategoricalDistribution(["a", "b"])}, "m is a list of choices"),
    ],
)
def test_cma_es_refuses_spaces_in_which_it_would_draw_at_random(space, message):
    with pytest.raises(StudyError, match=message):
        sampler_named("cma-es", space)


def test_an_unknown_sampler_gets_a_suggestion():
    with pytest.raises(StudyError, match='did you mean "genetic"'):
        sampler_named("genetc", SPACE)


def test_gaussian_process_without_torch_names_the_command(monkeypatch):
    monkeypatch.setattr("voxsoft.search.samplers.find_spec", lambda name: None)
    with pytest.raises(MissingPackageError, match=r"pip install torch"):
        sampler_named("gp", SPACE)


def test_a_grid_needs_steps():
    with pytest.raises(StudyError, match=r"space\.x: has no step"):
        grid_values({"x": FloatDistribution(0, 1)})


def test_grid_values_are_round_numbers():
    space = {"x": FloatDistribution(0.1, 0.3, step=0.1), "m": CategoricalDistribution(["a", "b"])}
    assert grid_values(space) == {"x": [0.1, 0.2, 0.3], "m": ["a", "b"]}


@pytest.mark.parametrize(
    ("distribution", "low", "high"),
    [
        (FloatDistribution(2.0, 8.0), 2.0, 8.0),
        (FloatDistribution(0.01, 100.0, log=True), 0.01, 100.0),
        (FloatDistribution(0.005, 0.025, step=0.005), 0.005, 0.025),
        (IntDistribution(1, 1000, log=True), 1, 1000),
        (IntDistribution(2, 10, step=4), 2, 10),
        (CategoricalDistribution(["a", "b", "c"]), "a", "c"),
    ],
)
def test_genes_reach_both_ends_of_a_range(distribution, low, high):
    assert (value_of_gene(distribution, 0.0), value_of_gene(distribution, 1.0)) == (low, high)


def test_stepped_values_have_equal_shares():
    drawn = [value_of_gene(IntDistribution(1, 4), (i + 0.5) / 400) for i in range(400)]
    assert [drawn.count(value) for value in (1, 2, 3, 4)] == [100] * 4


def genetic_study(storage=None, **settings):
    sampler = GeneticSampler(SPACE, population=6, elites=2, seed=1, **settings)
    return optuna.create_study(
        sampler=sampler, storage=storage, study_name="s", load_if_exists=True
    )


def evaluate(study, trials):
    for _ in range(trials):
        trial = study.ask(SPACE)
        study.tell(trial, bowl(**trial.params))


def test_elites_are_not_evaluated_again():
    study = genetic_study()
    evaluate(study, 6 + 4 + 4)
    places = study.sampler.trials_by_place(study)
    tags = [[generation, i] for generation in sorted(places) for i in sorted(places[generation])]
    numbers = [places[generation][i].number for generation, i in tags]
    assert numbers == [*range(14)]
    first, later = [[0, i] for i in range(6)], [2, 3, 4, 5]
    assert tags == first + [[1, i] for i in later] + [[2, i] for i in later]


def test_a_new_sampler_goes_on_from_the_stored_trials():
    whole, storage = genetic_study(), optuna.storages.InMemoryStorage()
    evaluate(whole, 20)
    evaluate(genetic_study(storage), 9)
    evaluate(genetic_study(storage), 11)
    assert [t.params for t in genetic_study(storage).trials] == [t.params for t in whole.trials]


def test_room_counts_candidates_that_need_no_answers():
    study = genetic_study()
    assert study.sampler.room(study) == 6
    pending = [study.ask(SPACE) for _ in range(6)]
    assert study.sampler.room(study) == 0
    extra = study.ask(SPACE)
    placed = study.sampler.trials_by_place(study)[0].values()
    assert extra.number not in [trial.number for trial in placed]
    for trial in pending:
        study.tell(trial, bowl(**trial.params))
    assert study.sampler.room(study) == 4


def test_failed_trials_breed_nothing_if_others_finished():
    study = genetic_study(mutation=0.0)
    for index in range(6):
        trial = study.ask(SPACE)
        if index == 2:
            study.tell(trial, 1.0)
            survivor = trial.params
        else:
            study.tell(trial, state=TrialState.FAIL if index % 2 else TrialState.PRUNED)
    children = [study.ask(SPACE).params for _ in range(4)]
    assert children == [survivor] * 4


def test_genetic_refuses_two_objectives():
    with pytest.raises(StudyError, match="nsga-ii"):
        search("genetic", directions=("minimize", "maximize"))


def test_genetic_needs_a_space():
    with pytest.raises(StudyError, match="space: is empty"):
        GeneticSampler({})
