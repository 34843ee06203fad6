"""The one module that stores trials with Optuna, through Optuna's public names only.

All trials, studies and storages of Optuna are taken from here; samplers and distributions,
which hold nothing, are imported where they are used. `tests/architecture` checks both. Optuna's
study hides the number of a trial in its storage, which this module asks of the storage itself,
made here or given.
"""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import inf
from typing import Any, Final, Literal

import optuna
from optuna.distributions import BaseDistribution
from optuna.exceptions import ExperimentalWarning, StorageInternalError
from optuna.samplers import (
    BaseSampler,
    GPSampler,
    NSGAIIISampler,
    NSGAIISampler,
    RandomSampler,
)
from optuna.storages import BaseStorage, JournalStorage, RDBStorage
from optuna.storages.journal import BaseJournalBackend
from optuna.study import StudyDirection
from optuna.trial import FrozenTrial, TrialState, create_trial

from voxsoft.errors import StudyError

__all__ = [
    "BaseJournalBackend",
    "BaseStorage",
    "FrozenTrial",
    "PlacingSampler",
    "StorageInternalError",
    "StoredStudy",
    "StudyDirection",
    "TrialState",
    "ask_in_memory",
    "journal_storage",
    "study_names",
]

Distributions = Mapping[str, BaseDistribution]
Direction = Literal["maximize", "minimize"]
#: Samplers that look at completed trials only. CMA-ES does too, and is better without unsolved
#: ones: a generation without a solved design has no best, and its mean would walk at random.
_LEARN_FROM_COMPLETED: Final = (GPSampler, NSGAIISampler, NSGAIIISampler)
#: Position of a trial in the search of a sampler: a generation or start, and an index in it.
Place = list[int]


class PlacingSampler(BaseSampler):
    """Sampler that gives each trial a place in its search, and finds it again.

    Places are stored, so that a study that was stopped goes on as if it had not been: in a
    :class:`StoredStudy` with the trials, in any other study of Optuna as attributes of the study.

    Attributes
    ----------
    place_key
        Attribute of a trial under which its place is stored.
    """

    place_key: str

    def __init__(self) -> None:
        self._store: Callable[[int, str, Place], None] | None = None

    def store_with(self, store: Callable[[int, str, Place], None]) -> None:
        """Set the function that stores places: it takes a trial's number, the key and the place."""
        self._store = store

    def give_place(self, study: optuna.Study, trial: FrozenTrial, place: Place) -> None:
        """Store the place of a trial."""
        if self._store is not None:
            self._store(trial.number, self.place_key, place)
        else:
            study.set_user_attr(f"{self.place_key}:{trial.number}", place)

    def trials_by_place(self, study: optuna.Study) -> dict[int, dict[int, FrozenTrial]]:
        """Find the trials of each generation or start, by index."""
        found: dict[int, dict[int, FrozenTrial]] = {}
        beside = study.user_attrs if self._store is None else {}
        for trial in study.get_trials(deepcopy=False):
            place = trial.system_attrs.get(self.place_key)
            place = place or beside.get(f"{self.place_key}:{trial.number}")
            if place is not None:
                found.setdefault(place[0], {})[place[1]] = trial
        return found


class StoredStudy:
    """Study of Optuna in a storage, written by this process alone.

    Parameters
    ----------
    name
        Name of the study, which :meth:`create` made.
    storage
        URL of a database, or a storage.

    Raises
    ------
    KeyError
        The storage holds no study of this name.

    Examples
    --------
    >>> from optuna.distributions import IntDistribution
    >>> from optuna.storages import InMemoryStorage
    >>> storage = InMemoryStorage()
    >>> StoredStudy.create("walls", storage, ["minimize"], {"definition": {}})
    >>> study = StoredStudy("walls", storage)
    >>> number = study.add({"count": IntDistribution(1, 3)}, {"count": 2})
    >>> study.write(number, "outcome", {"status": "ok"})
    >>> study.tell(number, [0.5])
    >>> study.trial(number).user_attrs
    {'outcome': {'status': 'ok'}}
    """

    def __init__(self, name: str, storage: str | BaseStorage) -> None:
        self._storage = _opened(storage)
        # Any sampler but Optuna's default, which would warn where it does not fit.
        self._unused = RandomSampler()
        with _quiet():
            self._study = optuna.load_study(
                study_name=name, storage=self._storage, sampler=self._unused
            )
        self._id = self._storage.get_study_id_from_name(name)
        self._held = len(self.trials())

    @staticmethod
    def create(
        name: str,
        storage: str | BaseStorage,
        directions: Sequence[Direction],
        attributes: Mapping[str, Any],
    ) -> None:
        """Make a study, or take the one of this name, and write its attributes."""
        with _quiet():
            study = optuna.create_study(
                study_name=name,
                storage=_opened(storage),
                directions=list(directions),
                load_if_exists=True,
            )
        for key, value in attributes.items():
            study.set_user_attr(key, value)

    @property
    def attributes(self) -> dict[str, Any]:
        """Attributes that :meth:`create` wrote."""
        attributes: dict[str, Any] = self._study.user_attrs
        return attributes

    def trials(self, *states: TrialState) -> list[FrozenTrial]:
        """Return the trials in these states, or all, by number; not to be changed."""
        trials: list[FrozenTrial] = self._study.get_trials(deepcopy=False, states=states or None)
        return trials

    def trial(self, number: int) -> FrozenTrial:
        """Return one trial."""
        return self._storage.get_trial(self._trial_id(number))

    def use(self, sampler: BaseSampler) -> None:
        """Set the sampler of :meth:`ask`, and store the places it gives."""
        if isinstance(sampler, PlacingSampler):
            sampler.store_with(self._store_place)
        self._study.sampler = sampler

    def room(self, room: Callable[[optuna.Study], int]) -> int:
        """Return a sampler's room, the trials that it can suggest now, in the study."""
        return room(self._study)

    def ask(self, space: Distributions) -> tuple[int, dict[str, Any]]:
        """Make a trial that the sampler suggests; return its number and parameters."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ExperimentalWarning)
            # The infinity of a design that could not be solved; see tell_unsolved.
            warnings.filterwarnings("ignore", message="Clip non-finite values")
            trial = self._study.ask(dict(space))
        self._held = trial.number + 1
        return trial.number, trial.params

    def add(self, space: Distributions, parameters: Mapping[str, Any]) -> int:
        """Make a trial of given parameters with a single write; return its number.

        Raises
        ------
        StudyError
            Another process has added a trial meanwhile.
        """
        running, number = TrialState.RUNNING, self._held
        template = create_trial(state=running, params=dict(parameters), distributions=dict(space))
        made = self._storage.create_new_trial(self._id, template)
        if made != self._trial_id(number):
            what = "got a trial from another process"
            raise StudyError(self._study.study_name, what, "let one process at a time run it")
        self._held += 1
        return number

    def complete(self, number: int, space: Distributions) -> dict[str, Any]:
        """Give a trial the parameters that it lacks; return all.

        Missing parameters of a trial stopped during its setup are suggested one by one.
        """
        trial = optuna.Trial(self._study, self._trial_id(number))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ExperimentalWarning)
            return {name: _suggested(trial, name, domain) for name, domain in space.items()}

    def write(self, number: int, key: str, value: object) -> None:
        """Write an attribute of a running trial."""
        self._storage.set_trial_user_attr(self._trial_id(number), key, value)

    def tell(self, number: int, values: Sequence[float]) -> None:
        """End a trial with its values."""
        self._tell(number, values, TrialState.COMPLETE)

    def tell_unsolved(self, number: int) -> None:
        """End a trial without values so that the sampler in use learns from it.

        TPE and the samplers of VoxSoft learn from pruned trials; CMA-ES fills its generations with
        designs that were solved. The others forget all but completed trials, and get the worst
        value of each objective: infinity, which they rank last whatever the scale.
        """
        if isinstance(self._study.sampler, _LEARN_FROM_COMPLETED):
            minimize = StudyDirection.MINIMIZE
            worst = [inf if each == minimize else -inf for each in self._study.directions]
            self._tell(number, worst, TrialState.COMPLETE)
        else:
            self._tell(number, None, TrialState.PRUNED)

    def _tell(self, number: int, values: Sequence[float] | None, state: TrialState) -> None:
        """End a trial; Optuna's own way serves samplers, and takes as long as all of the rest."""
        if self._study.sampler is not self._unused:
            self._study.tell(number, values, state)
        elif values is None:
            self._storage.set_trial_state_values(self._trial_id(number), state)
        else:
            plain = [float(value) for value in values]
            self._storage.set_trial_state_values(self._trial_id(number), state, plain)

    def _store_place(self, number: int, key: str, place: Place) -> None:
        self._storage.set_trial_system_attr(self._trial_id(number), key, place)

    def _trial_id(self, number: int) -> int:
        return int(self._storage.get_trial_id_from_study_id_trial_number(self._id, number))


def ask_in_memory(
    sampler: BaseSampler, space: Distributions
) -> tuple[
    Callable[[int], list[tuple[int, dict[str, Any]]]], Callable[[Mapping[int, float]], None]
]:
    """Make a study of one objective that is stored nowhere.

    Returns
    -------
    tuple
        Function to ask for a number of trials, and function to set the value of each by its number;
        less is better.

    Examples
    --------
    >>> from optuna.distributions import FloatDistribution
    >>> ask, tell = ask_in_memory(RandomSampler(seed=1), {"x": FloatDistribution(0.0, 1.0)})
    >>> trials = ask(2)
    >>> tell({number: parameters["x"] for number, parameters in trials})
    """
    with _quiet():
        study = optuna.create_study(sampler=sampler)

    def ask(count: int) -> list[tuple[int, dict[str, Any]]]:
        trials = [study.ask(dict(space)) for _ in range(count)]
        return [(trial.number, trial.params) for trial in trials]

    def tell(values: Mapping[int, float]) -> None:
        for number, value in values.items():
            study.tell(number, value)

    return ask, tell


def journal_storage(journal: BaseJournalBackend) -> BaseStorage:
    """Make a storage of a journal."""
    return JournalStorage(journal)


def study_names(storage: BaseStorage) -> list[str]:
    """List the studies of a storage."""
    return [study.study_name for study in storage.get_all_studies()]


def _suggested(trial: optuna.Trial, name: str, domain: BaseDistribution) -> object:
    """Suggest one parameter of a trial; one that it has stays as it is."""
    if isinstance(domain, optuna.distributions.CategoricalDistribution):
        return trial.suggest_categorical(name, domain.choices)
    if isinstance(domain, optuna.distributions.IntDistribution):
        low, high, step = domain.low, domain.high, domain.step
        return trial.suggest_int(name, low, high, step=step, log=domain.log)
    assert isinstance(domain, optuna.distributions.FloatDistribution)
    return trial.suggest_float(name, domain.low, domain.high, step=domain.step, log=domain.log)


def _opened(storage: str | BaseStorage) -> BaseStorage:
    return RDBStorage(storage) if isinstance(storage, str) else storage


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Silence Optuna's message about a new study."""
    before = optuna.logging.get_verbosity()
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    try:
        yield
    finally:
        optuna.logging.set_verbosity(before)
