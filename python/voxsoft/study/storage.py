"""Storage of the trials of a study: a folder, or a database that Optuna can reach."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from voxsoft.errors import StorageError, StudyError
from voxsoft.search.optuna_bridge import (
    BaseStorage,
    Direction,
    StorageInternalError,
    StoredStudy,
    journal_storage,
    study_names,
)
from voxsoft.study.definition import require_same
from voxsoft.study.journal import StudyJournal

JOURNAL_NAME: Final = "study.journal"
DEFINITION_NAME: Final = "study.json"

_DEFINITION_KEY: Final = "definition"


class TrialStorage:
    """Stored trials of one study.

    Parameters
    ----------
    name
        Name of the study in the storage.
    directions
        ``maximize`` or ``minimize`` for each objective.
    definition
        Definition of the study; a storage that holds another one is refused.
    place
        Folder, or Optuna storage: its URL or the object.

    Raises
    ------
    StudyError
        The place cannot be used, or holds a study that was defined otherwise.
    """

    def __init__(
        self,
        name: str,
        directions: Sequence[Direction],
        definition: Mapping[str, Any],
        place: Path | str | BaseStorage,
    ) -> None:
        self._name, self._directions, self._place = name, list(directions), place
        self._define(definition)

    @property
    def where(self) -> str:
        """Folder, or the name of the study in its database."""
        return str(self._place) if isinstance(self._place, Path) else f'study "{self._name}"'

    @contextlib.contextmanager
    def open(self, *, write: bool) -> Iterator[StoredStudy]:
        """Open the study; for writing, no other process may write it until the end.

        A study in a database is not locked: let one process at a time run it.
        """
        if isinstance(self._place, Path):
            with StudyJournal(self._place / JOURNAL_NAME, write=write) as journal:
                yield StoredStudy(self._name, journal_storage(journal))
        else:
            with _database_errors(self.where):
                yield StoredStudy(self._name, self._place)

    def _define(self, definition: Mapping[str, Any]) -> None:
        stored = self._stored_definition()
        if stored is not None:
            require_same(stored, definition, self.where)
            return
        if isinstance(self._place, Path):
            self._write_definition(self._place, definition)
            with StudyJournal(self._place / JOURNAL_NAME, write=True) as journal:
                self._create(journal_storage(journal), definition)
        else:
            with _database_errors(self.where):
                self._create(self._place, definition)

    def _create(self, storage: str | BaseStorage, definition: Mapping[str, Any]) -> None:
        attributes = {_DEFINITION_KEY: dict(definition)}
        StoredStudy.create(self._name, storage, self._directions, attributes)

    def _stored_definition(self) -> dict[str, Any] | None:
        if isinstance(self._place, Path) and not (self._place / JOURNAL_NAME).exists():
            return None
        try:
            with self.open(write=False) as study:
                stored = study.attributes.get(_DEFINITION_KEY)
                trials = len(study.trials())
        except KeyError:  # no study of this name yet
            self._refuse_a_folder_of_another_name()
            return None
        if stored is None and trials:
            raise StudyError(
                self.where, "holds trials that VoxSoft did not write", "use another study name"
            )
        return stored

    def _refuse_a_folder_of_another_name(self) -> None:
        """Raise if the folder holds the tables and pictures of a study of another name."""
        if not isinstance(self._place, Path):
            return
        with StudyJournal(self._place / JOURNAL_NAME, write=False) as journal:
            names = study_names(journal_storage(journal))
        if names:
            what = f'holds the study "{names[0]}"; this one is "{self._name}"'
            raise StudyError(self.where, what, "give each study a folder of its own")

    @staticmethod
    def _write_definition(folder: Path, definition: Mapping[str, Any]) -> None:
        """Write a copy of the definition for people; the journal holds the valid one."""
        text = json.dumps(definition, indent=2, ensure_ascii=False) + "\n"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            (folder / DEFINITION_NAME).write_text(text, encoding="utf-8")
        except OSError as error:
            where = str(error.filename or folder)
            raise StorageError(where, f"cannot be written: {error.strerror}") from None


@contextlib.contextmanager
def _database_errors(where: str) -> Iterator[None]:
    """Convert the errors of a database to StorageError or StudyError."""
    # Optuna brings SQLAlchemy along; it is slow to import and studies in a folder do without.
    from sqlalchemy.exc import SQLAlchemyError

    try:
        yield
    except (StorageInternalError, SQLAlchemyError) as error:
        cause = str(error.__cause__ or error).splitlines()[0]
        hint = "check the address of the storage; finished trials are kept"
        raise StorageError(where, f"the storage failed: {cause}", hint) from error
    except ImportError as error:
        hint = "install the driver of that database with pip"
        raise StudyError(where, f"the storage needs a package: {error}", hint) from error
