"""Studies on families that cost nothing: suggestions, storage, sharing, ranking and refusals."""

import concurrent.futures
import signal
import subprocess
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import optuna
import pandas as pd
import pytest
from study_families import FALL, SPACE, block, bowl, moody, score, slow, two_sided

from voxsoft.design import Design
from voxsoft.design.families import cylinder
from voxsoft.errors import DesignError, MissingPackageError, StudyError
from voxsoft.search.optuna_bridge import StoredStudy
from voxsoft.study import Outcome, Study


@pytest.fixture
def threads():
    with ThreadPoolExecutor(2) as executor:
        yield executor


@pytest.fixture
def make(tmp_path):
    def make(space=SPACE, objectives=FALL, *, evaluate=bowl, folder="study", **options):
        place = {} if "storage" in options else {"folder": tmp_path / folder}
        return Study(block, space, objectives, evaluate=evaluate, **place, **options)

    return make


def test_a_grid_tries_every_point_once_and_finds_the_best(make, threads):
    study = make()
    result = study.grid(executor=threads)
    assert study.grid_size == len(result.trials) == 110
    assert len({tuple(trial.parameters.values()) for trial in result.trials}) == 110
    assert result.best.parameters == {"x": 0.3, "y": 7}
    assert result.best.objectives["fall"] == pytest.approx(0.0, abs=1e-12)
    values = [trial.objectives["fall"] for trial in result.ranking]
    assert values == sorted(values, reverse=True)


def test_a_finished_grid_evaluates_nothing_again(make, threads, monkeypatch):
    first = make().grid(executor=threads)
    monkeypatch.setattr("study_families.score", lambda x, y: pytest.fail("evaluated again"))
    again = make().grid(executor=threads)
    assert again.trials == first.trials


@pytest.mark.long
@pytest.mark.parametrize("sampler", ["random", "tpe", "cma-es", "nsga-ii", "genetic"])
def test_suggestions_depend_on_the_seed_and_not_on_the_workers(make, sampler):
    found = []
    for index, (seed, count) in enumerate([(1, 1), (1, 4), (2, 1)]):
        study = make(seed=seed, evaluate=slow if count > 1 else bowl, folder=str(index))
        # A slow evaluation finishes in another order.
        with ThreadPoolExecutor(count) as executor:
            result = study.optimize(sampler, 34, executor=executor, workers=count)
        found.append([trial.parameters for trial in result.trials])
    assert found[0] == found[1]
    assert found[0] != found[2]


@pytest.mark.parametrize("sampler", ["tpe", "genetic", "cma-es"])
def test_a_resumed_study_suggests_the_same_trials(make, threads, sampler):
    def stop(event):
        if event.done == 21:
            raise KeyboardInterrupt

    whole = make(folder="whole").optimize(sampler, 40, executor=threads)
    with pytest.raises(KeyboardInterrupt):
        make(folder="parts").optimize(sampler, 40, executor=threads, progress=stop)
    parts = make(folder="parts").optimize(sampler, 40, executor=threads)
    assert [t.parameters for t in parts.trials] == [t.parameters for t in whole.trials]


@pytest.mark.parametrize("sampler", ["tpe", "genetic", "nsga-ii"])
def test_adaptive_samplers_improve_on_their_start(make, threads, sampler):
    trials = make({"x": (0.0, 1.0), "y": (1, 10)}).optimize(sampler, 120, executor=threads).trials
    mean = [np.mean([t.objectives["fall"] for t in part]) for part in (trials[:30], trials[-30:])]
    assert mean[1] > 0.75 * mean[0]


def test_a_sampler_object_of_optuna_is_used_as_it_is(make, threads):
    sampler = optuna.samplers.TPESampler(seed=3, n_startup_trials=2)
    assert len(make().optimize(sampler, 5, executor=threads).trials) == 5


def test_two_objectives_make_a_pareto_front(make, threads):
    objectives = {
        "near": {"minimize": "displacement", "probe": "tip"},
        "far": {"maximize": "displacement", "probe": "tip"},
    }
    study = make({"x": (0.0, 1.0, 0.1), "y": (4, 6)}, objectives, evaluate=two_sided)
    front = study.grid(executor=threads).pareto_front
    assert [trial.parameters for trial in front] == [
        {"x": x, "y": 5} for x in (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
    ]


@pytest.mark.slow
def test_constraints_mark_trials_and_reach_the_sampler(make, threads):
    light = {"mass": {"metric": "mass", "max": "4 kg"}}
    result = make(constraints=light).grid(executor=threads)
    assert {trial.parameters["y"] for trial in result.trials if trial.feasible} == {1, 2, 3, 4}
    assert result.best.parameters == {"x": 0.3, "y": 4}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        held = make(constraints=light, folder="held").optimize("tpe", 100, executor=threads)
    free = make(folder="free").optimize("tpe", 100, executor=threads)
    light_ones = [
        np.mean([trial.parameters["y"] <= 4 for trial in result.trials[-40:]])
        for result in (held, free)
    ]
    assert light_ones[0] > light_ones[1] + 0.3


def test_every_way_to_end_has_its_status_and_none_counts_as_zero(make, threads):
    result = make({"y": (1, 5)}, evaluate=moody).grid(executor=threads)
    assert [trial.status for trial in result.trials] == [
        "no-cavity",
        "not-at-rest",
        "failed",
        "failed",
        "ok",
    ]
    assert result.trials[1].metrics == {"mass": 2.0}
    assert result.trials[2].message == "ZeroDivisionError: a bug in the solver"
    assert result.trials[3].message == 'the objective "fall" is nan'
    assert result.counts == {
        "ok": 1,
        "no-cavity": 1,
        "disconnected": 0,
        "diverged": 0,
        "not-at-rest": 1,
        "failed": 2,
    }
    assert result.best.number == 4
    assert result.table()["fall"].isna().tolist() == [True, True, True, True, False]


@pytest.mark.parametrize("sampler", ["tpe", "cma-es", "genetic", "nsga-ii", "random"])
def test_samplers_live_with_failures(make, threads, sampler):
    result = make({"x": (0.0, 1.0), "y": (1, 6)}, evaluate=moody).optimize(
        sampler, 60, executor=threads
    )
    assert len(result.trials) == 60
    assert 0 < result.counts["ok"] < 60


def test_a_family_that_refuses_parameters_fails_that_trial_only(make, threads):
    result = make({"y": [5, 13]}).grid(executor=threads)
    assert [trial.status for trial in result.trials] == ["ok", "failed"]
    assert "bad luck" in result.trials[1].message
    assert result.trials[1].hash == ""


def test_a_family_that_returns_no_design_is_a_mistake(tmp_path, threads):
    study = Study(lambda y: None, {"y": (1, 3)}, FALL, folder=tmp_path / "study")
    with pytest.raises(TypeError, match="returned None; expected a Design"):
        study.grid(executor=threads)


def test_equal_designs_are_evaluated_once(tmp_path, threads):
    asked = []

    def remember(design):
        asked.append(design.hash)
        return bowl(design)

    def rounded(x, y):
        return block(round(x), y)

    space = {"x": (0.0, 1.0, 0.25), "y": (1, 3)}
    study = Study(rounded, space, FALL, folder=tmp_path / "study", evaluate=remember)
    result = study.grid(executor=threads)
    assert len(asked) == len(set(asked)) == 6
    shared = [trial for trial in result.trials if trial.same_as is not None]
    assert len(shared) == 9
    for trial in shared:
        source = result.trials[trial.same_as]
        assert (source.hash, source.objectives) == (trial.hash, trial.objectives)
        assert source.same_as is None
    assert all(trial.same_as is None for trial in result.pareto_front)


def test_progress_tells_of_every_trial_and_of_earlier_runs(make, threads):
    events = []
    make().optimize("random", 10, executor=threads)
    make().optimize("random", 25, executor=threads, progress=events.append)
    assert [event.done for event in events] == list(range(11, 26))
    assert {event.total for event in events} == {25}
    assert {event.status for event in events} == {"ok"}
    result = make().result()
    assert events[-1].best == result.best.objectives["fall"]
    assert events[0].objectives == result.trials[events[0].number].objectives


def test_results_are_readable_while_the_study_runs(make, threads):
    seen = []
    study = make()
    study.optimize(
        "random", 5, executor=threads, progress=lambda event: seen.append(study.result())
    )
    assert [len(result.trials) for result in seen] == [1, 2, 3, 4, 5]


def test_a_progress_hook_that_raises_stops_without_a_loss(make, threads):
    def stop(event):
        if event.done == 7:
            raise RuntimeError("enough")

    study = make()
    with pytest.raises(RuntimeError, match="enough"):
        study.grid(executor=threads, progress=stop)
    assert len(study.result().trials) == 7
    assert len(study.grid(executor=threads).trials) == 110


def test_ctrl_c_keeps_finished_trials_and_names_the_way_on(make, threads):
    study = make()

    def press(event):
        if event.done == 12:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt, match=r"after 12 of 110 trials.*run the same study"):
        study.grid(executor=threads, progress=press)
    assert len(study.result().trials) == 12
    assert len(study.grid(executor=threads).trials) == 110


def test_ctrl_c_stores_finished_trials_not_yet_read(make, threads, monkeypatch):
    def interrupted(run, *_):
        concurrent.futures.wait(run._running)
        raise KeyboardInterrupt

    monkeypatch.setattr("voxsoft.study.run.StudyRun._wait", interrupted)
    study = make()
    with pytest.raises(KeyboardInterrupt, match="4 of"):
        study.grid(executor=threads, workers=2)  # hands out twice as many as run at once
    assert len(study.result().trials) == 4


def test_another_definition_in_the_same_folder_is_refused(make, threads):
    make(seed=1)
    with pytest.raises(StudyError, match="holds another study: seed was 1 and is now 2"):
        make(seed=2)
    with pytest.raises(StudyError, match=r"space\.y\.high was 10 and is now 9"):
        make({**SPACE, "y": (1, 9)}, seed=1)
    with pytest.raises(StudyError, match=r"evaluate\.function was"):
        make(seed=1, evaluate=slow)
    other = {"fall": {"minimize": "displacement", "probe": "tip", "axis": "z"}}
    with pytest.raises(StudyError, match=r"objectives\.fall\.maximize"):
        make(objectives=other, seed=1)


def test_a_changed_design_in_the_same_folder_is_refused(tmp_path):
    folder = tmp_path / "study"
    Study(cylinder(), folder=folder)
    document = cylinder().document
    document["loads"][0]["value"] = "5 kPa"
    with pytest.raises(StudyError, match=r"family\.loads"):
        Study(Design.from_document(document), folder=folder)


def test_the_definition_lies_beside_the_trials(tmp_path):
    Study(folder=tmp_path / "study", seed=4)
    assert '"seed": 4' in (tmp_path / "study" / "study.json").read_text()


@pytest.mark.slow
def test_an_optuna_storage_takes_the_place_of_the_folder(make, threads, tmp_path):
    url = f"sqlite:///{tmp_path / 'studies.db'}"
    first = make({"y": (1, 5)}, storage=url).grid(executor=threads)
    study = make({"y": (1, 5)}, storage=url)
    assert study.folder is None
    assert study.result().trials == first.trials
    with pytest.raises(StudyError, match='study "block": holds another study'):
        make({"y": (1, 6)}, storage=url)


def test_a_storage_that_cannot_be_reached_is_named(make, tmp_path):
    with pytest.raises(StudyError, match=r"the storage failed: .*unable to open database"):
        make(storage=f"sqlite:///{tmp_path / 'missing' / 'studies.db'}")


def test_names_that_are_taken_get_their_role_in_the_table(tmp_path, threads):
    def family(number):
        return block(y=number)

    study = Study(family, {"number": (4, 6)}, FALL, folder=tmp_path / "s", evaluate=bowl)
    table = study.grid(executor=threads).table()
    assert table["number"].tolist() == [0, 1, 2]
    assert table["number (parameter)"].tolist() == [4, 5, 6]


@pytest.mark.parametrize("sampler", ["cma-es", "genetic"])
def test_samplers_for_one_objective_refuse_two(make, sampler):
    two = {**FALL, "light": {"minimize": "mass"}}
    with pytest.raises(StudyError, match=f'"{sampler}" takes one objective, and there are 2'):
        make(objectives=two).optimize(sampler, 5)


def test_trials_of_others_are_not_touched(make):
    storage = optuna.storages.InMemoryStorage()
    foreign = optuna.create_study(storage=storage, study_name="block")
    foreign.optimize(lambda trial: trial.suggest_float("x", 0, 1), n_trials=1)
    with pytest.raises(StudyError, match="that VoxSoft did not write"):
        make(storage=storage)


def test_trials_of_an_interrupted_run_are_taken_up_first(make, threads):
    study = make()
    with study._storage.open(write=True) as stored:
        _, parameters = stored.ask(study._distributions)
        stored.ask({})  # stopped before its parameters were written
    result = study.optimize("random", 4, executor=threads)
    assert [trial.number for trial in result.trials] == [0, 1, 2, 3]
    # Parameters are rounded to 12 significant digits on their way through a design.
    assert result.trials[0].parameters == pytest.approx(parameters)
    assert result.trials[1].status == "ok"


def test_an_outcome_stored_before_its_state_is_not_evaluated_again(make, threads, monkeypatch):
    study = make({"y": [5]})
    tell = StoredStudy.tell
    monkeypatch.setattr(StoredStudy, "tell", lambda *a, **k: pytest.fail("stopped here"))
    with pytest.raises(BaseException, match="stopped here"):
        study.grid(executor=threads)
    monkeypatch.setattr(StoredStudy, "tell", tell)
    monkeypatch.setattr("study_families.score", lambda x, y: pytest.fail("evaluated again"))
    result = study.grid(executor=threads)
    assert [trial.status for trial in result.trials] == ["ok"]


def test_tables_go_to_files_and_back(make, threads, tmp_path):
    result = make({"y": (1, 5)}, evaluate=moody).grid(executor=threads)
    result.to_csv(tmp_path / "trials.csv")
    result.to_parquet(tmp_path / "trials.parquet")
    table = result.table()
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "trials.parquet"), table)
    csv = pd.read_csv(tmp_path / "trials.csv")
    assert csv["fall"].isna().tolist() == table["fall"].isna().tolist()
    assert csv.columns[:4].tolist() == ["number", "status", "y", "fall"]


def test_parquet_without_pyarrow_names_the_command(make, threads, tmp_path, monkeypatch):
    result = make({"y": [5]}).grid(executor=threads)
    monkeypatch.setattr("voxsoft.study.result.find_spec", lambda name: None)
    with pytest.raises(MissingPackageError, match=r"pip install pyarrow"):
        result.to_parquet(tmp_path / "trials.parquet")


def test_a_table_that_cannot_be_written_names_the_file(make, threads, tmp_path):
    result = make({"y": [5]}).grid(executor=threads)
    with pytest.raises(StudyError, match=r"missing.*cannot be written"):
        result.to_csv(tmp_path / "missing" / "trials.csv")


def test_scatter_and_history_hold_the_data_of_plots(make, threads):
    result = make().grid(executor=threads)
    points, values = result.scatter()
    assert points.shape == (110, 2)
    assert values == pytest.approx([score(x, y) for x, y in points])
    numbers, values, best = result.history()
    assert numbers.tolist() == list(range(110))
    assert best.tolist() == np.maximum.accumulate(values).tolist()


def test_choices_that_are_no_numbers_are_numbered_for_the_scatter(tmp_path, threads):
    def named(kind):
        return block(y={"soft": 2, "stiff": 4}[kind])

    study = Study(named, {"kind": ["soft", "stiff"]}, FALL, folder=tmp_path / "s", evaluate=bowl)
    assert study.grid(executor=threads).scatter()[0].tolist() == [[0.0], [1.0]]


def test_an_empty_study_has_a_result(make):
    result = make().result()
    assert (result.best, result.trials, result.pareto_front) == (None, (), ())
    assert len(result.table()) == 0
    assert result.scatter()[0].shape == (0, 2)
    assert result.summary()["best"] is None


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda s: s.optimize("tpee", 5), 'sampler: "tpee" is not known.*did you mean "tpe"'),
        (lambda s: s.optimize("tpe", 0), "budget: expected at least 1"),
        (lambda s: s.optimize("tpe", 5, batch=0), "batch: expected at least 1"),
        (lambda s: s.grid(workers=0), "workers: 0 is not possible"),
        (lambda s: s.result().ranked_by("fal"), 'did you mean "fall"'),
    ],
)
def test_wrong_calls_are_named(make, call, message):
    with pytest.raises(StudyError, match=message):
        call(make())


def test_a_grid_over_a_range_without_a_step_is_refused(make):
    study = make({"x": (0.0, 1.0)})
    with pytest.raises(StudyError, match=r"space\.x: has no step"):
        study.grid()


def test_a_function_needs_a_space_and_objectives(tmp_path):
    with pytest.raises(StudyError, match="space: is missing"):
        Study(block, None, FALL, folder=tmp_path)
    with pytest.raises(StudyError, match="objectives: are missing"):
        Study(block, SPACE, folder=tmp_path)
    with pytest.raises(DesignError, match="maximise: is not known"):
        Study(block, SPACE, {"fall": {"maximise": "mass"}}, folder=tmp_path)


def test_without_a_folder_trials_go_to_the_name_of_the_design(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert str(Study().folder) == "studies/cylinder"
    assert (tmp_path / "studies" / "cylinder" / "study.json").exists()


def test_a_missing_metric_fails_the_trial(make, threads):
    def empty(design):
        return Outcome("ok")

    result = make({"y": [5]}, evaluate=empty).grid(executor=threads)
    assert result.trials[0].message == 'the objective "fall" is missing'


def test_a_worker_process_imports_neither_optuna_nor_pandas():
    heavy = "{'optuna', 'pandas', 'sqlalchemy'} & set(sys.modules)"
    code = f"import sys, voxsoft.study.outcome; print(sorted({heavy}))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


def test_a_folder_holds_one_study(make):
    first = make(name="one")
    with pytest.raises(StudyError, match='holds the study "one"; this one is "two"'):
        make(name="two")
    assert make(name="one").grid_size == first.grid_size
