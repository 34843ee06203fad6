"""The journal of a study after a kill, a torn line, a full disk, a second writer."""

import os

import optuna
import pytest
from optuna.storages import JournalStorage
from optuna.storages.journal import JournalFileBackend

from voxsoft.errors import StudyError
from voxsoft.study.journal import StudyJournal


@pytest.fixture
def path(tmp_path):
    return tmp_path / "study.journal"


def write(path, *numbers):
    with StudyJournal(path, write=True) as journal:
        for number in numbers:
            journal.append_logs([{"number": number}])


def read(path):
    with StudyJournal(path, write=False) as journal:
        return [line["number"] for line in journal.read_logs(0)]


def test_written_events_are_read_back_from_any_number_on(path):
    write(path, 1, 2)
    write(path, 3)
    assert read(path) == [1, 2, 3]
    with StudyJournal(path, write=False) as journal:
        assert journal.read_logs(2) == [{"number": 3}]


@pytest.mark.parametrize("torn", [b'{"num', b'{"number":9}', b"\0\0\0\0"])
def test_a_torn_last_line_is_dropped_and_writing_goes_on(path, torn):
    write(path, 1, 2)
    with path.open("ab") as file:
        file.write(torn)
    assert read(path) == [1, 2]
    write(path, 3)
    assert read(path) == [1, 2, 3]


def test_a_damaged_line_in_the_middle_is_named(path):
    path.write_bytes(b'{"number":1}\nnonsense\n{"number":3}\n')
    with pytest.raises(StudyError, match=r"study\.journal, line 2: is damaged"):
        read(path)


def test_a_second_writer_is_refused_and_a_reader_is_not(path):
    with StudyJournal(path, write=True) as journal:
        journal.append_logs([{"number": 1}])
        with pytest.raises(StudyError, match="being written by another process"):
            StudyJournal(path, write=True)
        assert read(path) == [1]
    write(path, 2)
    assert read(path) == [1, 2]


def test_a_reader_cannot_write(path):
    write(path, 1)
    with StudyJournal(path, write=False) as journal, pytest.raises(StudyError, match="reading"):
        journal.append_logs([{"number": 2}])


def test_a_full_disk_names_the_file_and_leaves_no_half_line(path, monkeypatch):
    room = 20

    def limited(file, data, *, _write=os.write):
        left = room - os.fstat(file).st_size
        if left <= 0:
            raise OSError(28, "No space left on device")
        return _write(file, data[:left])

    with StudyJournal(path, write=True) as journal:
        journal.append_logs([{"number": 1}])
        with monkeypatch.context() as patched:
            patched.setattr("voxsoft.study.journal.os.write", limited)
            with pytest.raises(StudyError, match=r"study\.journal: cannot be written: No space"):
                journal.append_logs([{"number": 2}])
        assert journal.read_logs(0) == [{"number": 1}]
        journal.append_logs([{"number": 3}])
    assert read(path) == [1, 3]


def test_a_folder_that_is_not_there_is_named(tmp_path):
    with pytest.raises(StudyError, match=r"missing.study\.journal: cannot be opened"):
        StudyJournal(tmp_path / "missing" / "study.journal", write=True)


def test_optuna_opens_the_same_file(path):
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    with StudyJournal(path, write=True) as journal:
        study = optuna.create_study(storage=JournalStorage(journal), study_name="bowl")
        study.optimize(lambda trial: trial.suggest_float("x", -1, 1) ** 2, n_trials=5)
    storage = JournalStorage(JournalFileBackend(str(path)))
    again = optuna.load_study(study_name="bowl", storage=storage)
    assert [trial.params for trial in again.trials] == [trial.params for trial in study.trials]
