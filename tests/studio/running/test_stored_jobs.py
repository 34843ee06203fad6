"""Studies and calibrations of the past are told as they were when they ran."""

import os
import signal

import lattice_families as families
import own_loop
import pytest

from voxsoft import files
from voxsoft.calibration import Experiment, calibrate, read_measurement
from voxsoft.errors import FileError
from voxsoft.studio.protocol import events
from voxsoft.studio.running.job_journal import JOURNAL, JobJournal, read_journal
from voxsoft.studio.running.stored_job import stored_job

KINDS = ("generation", "overlay", "calibrated")
TABLE = "arc_position_from_clamp_mm,dz_mm\n30,-15\n60,-44\n90,-75\n"
FIT = {
    "kind": "calibrate",
    "data": [{"name": "tip.csv"}],
    "method": "cma-es",
    "bounds": {"edge": [5e3, 80e3]},
    "generations": 3,
    "population": 4,
}


def run(scenario):
    return own_loop.run(scenario, 120)


@pytest.fixture
def beam(tmp_path):
    file = tmp_path / "beam.toml"
    file.write_text(families.family_text("paper-beam"))
    return file


async def begin(page, **changes):
    await page.send("measurement", name="tip.csv", text=TABLE)
    await page.until("measured", lambda m: not m.problems)
    await page.send("job_start", spec={**FIT, **changes})
    return await page.until("job")


async def shown(page, name):
    """Events of a past job for the tab."""
    before = len(page.log)
    await page.send("job_show", id=name)
    await page.settled()
    return [e for e in page.log[before:] if e["t"] in (*KINDS, "trials", "job", "error")]


@pytest.mark.slow
def test_a_past_calibration_is_reported_as_it_was_also_under_another_name(make_studio, beam):
    first = make_studio(beam)

    async def fit():
        async with first.page() as page:
            job = await begin(page)
            await page.until("job", lambda j: j.state == "done", seconds=60)
            return job.id, [e for e in page.log if e["t"] in KINDS]

    name, live = run(fit())
    first.stop()
    second = make_studio(beam)

    async def look():
        async with second.page() as page:
            as_it_was = await shown(page, name)
            await page.send("run_rename", id=name, name="tuesday")
            await page.until("runs")
            return as_it_was, await shown(page, "tuesday")

    as_it_was, renamed = run(look())
    assert [e["t"] for e in live].count("generation") == 3
    assert [e for e in as_it_was if e["t"] in KINDS] == live
    (state,) = [e for e in as_it_was if e["t"] == "job"]
    assert (state["state"], state["done"], state["total"]) == ("done", 3, 3)
    assert "Mean error" in state["message"]
    assert {e["job"] for e in renamed if e["t"] in KINDS} == {"tuesday"}
    assert [e["id"] for e in renamed if e["t"] == "job"] == ["tuesday"]
    assert renamed[-1]["card"] == live[-1]["card"]


@pytest.mark.slow
def test_a_stopped_or_killed_calibration_shows_its_generations(make_studio, beam):
    first = make_studio(beam)

    async def scenario():
        async with first.page() as page:
            stopped = await begin(page, generations=5000)
            await page.until("generation", lambda g: g.index == 2)
            await page.send("job_stop", id=stopped.id)
            await page.until("job", lambda j: j.state == "stopped", seconds=60)
            await begin(page, generations=5000, name="killed")
            await page.until("generation", lambda g: g.job == "killed" and g.index == 2)
            os.kill(first.session.jobs.known("killed").process.pid, signal.SIGKILL)
            await page.until("job", lambda j: j.id == "killed" and j.state == "failed")
            return stopped.id

    stopped = run(scenario())
    first.stop()
    second = make_studio(beam)

    async def look(name):
        async with second.page() as page:
            return await shown(page, name)

    for name, state, words in (
        (stopped, "stopped", "kept"),
        ("killed", "failed", "killed by signal 9"),
    ):
        reported = run(look(name))
        assert [e["index"] for e in reported if e["t"] == "generation"][:2] == [1, 2]
        assert any(e["t"] == "overlay" for e in reported)
        (job,) = [e for e in reported if e["t"] == "job"]
        assert job["state"] == state
        assert words in job["message"]


def test_a_calibration_of_the_command_line_is_reported_from_its_files(tmp_path):
    design = families.beam()
    found = calibrate(
        Experiment(design, read_measurement(TABLE, name="tip")),
        "cma-es",
        parameters={"edge": ("5 kPa", "80 kPa")},
        generations=2,
        population=4,
    )
    files.write_calibration(found, tmp_path / "fit", "soft")
    first, second, calibrated = stored_job(tmp_path / "fit")
    assert (first.index, second.index) == (1, 2)
    assert second.best == found.history[1].best_fitness
    assert calibrated.parameters[0].sentence == found.profiles[0].sentence
    assert calibrated.table[2].station == "arc 90 mm"
    assert calibrated.material["edge"] == calibrated.parameters[0].text
    (tmp_path / "fit" / "soft.toml").unlink()
    with pytest.raises(FileError, match="no material card"):
        stored_job(tmp_path / "fit")


@pytest.mark.slow
def test_a_study_is_reported_again_after_a_restart(make_studio):
    first = make_studio()

    async def study():
        async with first.page() as page:
            spec = {"kind": "study", "sampler": "grid", "workers": 1}
            await page.send("job_start", spec={**spec, "space": {"radius": [0.01, 0.015]}})
            await page.until("job", lambda j: j.state == "done", seconds=60)

    run(study())
    first.stop()
    second = make_studio()

    async def look():
        async with second.page() as page:
            return await shown(page, "cylinder-study"), await shown(page, "never")

    (job, trials), (error,) = run(look())
    assert (job["state"], job["done"]) == ("done", 2)
    assert [trial["index"] for trial in trials["trials"]] == [0, 1]
    assert "not in the list of runs" in error["what"]


def state(**changes):
    fields = {"id": "a", "kind": "calibrate", "name": "a", "state": "running", "done": 0}
    return events.Job(
        **{**fields, "total": 9, "elapsed": 0.0, "left": None, "best": "", "folder": ""} | changes,
        message="",
    )


def test_the_journal_ignores_cut_off_and_repeated_lines(tmp_path):
    journal = JobJournal(tmp_path)
    for done in range(5):
        journal.keep(state(done=done))
    journal.keep(state(state="stopping"))
    with (tmp_path / JOURNAL).open("a") as file:
        file.write('{"t":"generation","job":"a","ind')
    reported = read_journal(tmp_path)
    assert [each.state for each in reported] == ["running", "stopping"]
    assert reported[0].id == tmp_path.name
    assert not journal.trouble


def test_a_journal_that_cannot_be_written_says_so_and_costs_nothing(tmp_path):
    journal = JobJournal(tmp_path / "gone")
    journal.keep(state())
    assert "No such file" in journal.trouble
