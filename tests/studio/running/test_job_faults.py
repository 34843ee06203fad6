"""Faults around jobs are reported in plain words, and cost no finished work."""

import asyncio
import os
import shutil
import signal
import sys
from pathlib import Path

import own_loop
import pytest

from voxsoft.study.storage import JOURNAL_NAME

linux = pytest.mark.skipif(sys.platform != "linux", reason="looks at processes in /proc")


def run(scenario):
    return own_loop.run(scenario, 120)


def study(**changes):
    """Eight cylinders."""
    space = {"radius": [0.01, 0.015, 0.02, 0.025], "wall": [0.005, 0.01]}
    return {"kind": "study", "sampler": "grid", "workers": 1, "space": space, **changes}


async def ended(page, job):
    finals = ("done", "stopped", "failed")
    return await page.until("job", lambda j: j.id == job and j.state in finals, seconds=90)


def below(pid):
    """Processes that a process started, and those that they did."""
    parents = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                stat = (entry / "stat").read_text()
            except OSError:  # it has just ended
                continue
            parents[int(entry.name)] = int(stat.rpartition(")")[2].split()[1])
    found = [pid]
    for each in found:
        found += [child for child, parent in parents.items() if parent == each]
    return found[1:]


@pytest.mark.slow
@linux
def test_a_worker_of_a_study_that_is_killed_costs_time_only(fresh_studio):
    async def scenario():
        async with fresh_studio.page() as page:
            await page.send("job_start", spec=study(workers=2))
            job = await page.until("job", lambda j: j.done >= 1)
            # The last processes that were started are those that solve designs.
            os.kill(below(fresh_studio.session.jobs.known(job.id).process.pid)[-1], signal.SIGKILL)
            done = await ended(page, job.id)
            trials = next(e for e in reversed(page.log) if e["t"] == "trials")["trials"]
        assert (done.state, done.done) == ("done", 8), done.message
        # If the wall is as thick as the radius there is no chamber; nothing failed.
        assert {trial["status"] for trial in trials} == {"ok", "no-cavity"}

    run(scenario())


@pytest.mark.slow
@linux
def test_a_full_disk_is_reported_and_the_study_goes_on_once_there_is_room(fresh_studio):
    import resource

    async def scenario():
        async with fresh_studio.page() as page:
            await page.send("job_start", spec=study())
            job = await page.until("job", lambda j: j.done >= 2)
            journal = Path(job.folder) / JOURNAL_NAME
            room = journal.stat().st_size + 100
            pid = fresh_studio.session.jobs.known(job.id).process.pid
            resource.prlimit(pid, resource.RLIMIT_FSIZE, (room, room))
            failed = await ended(page, job.id)
            kept = journal.read_bytes()
            assert failed.state == "failed"
            assert "cannot be written" in failed.message
            assert "make room" in failed.message
            await page.send("job_resume", id=job.id)
            first = await page.until("trials")
            assert len(first.trials) >= 2
            assert (await ended(page, job.id)).done == 8
            assert journal.read_bytes().startswith(kept)

    run(scenario())


@pytest.mark.slow
def test_a_job_does_not_start_if_its_folder_cannot_be_written(fresh_studio):
    runs = fresh_studio.session.runs
    shutil.rmtree(runs, ignore_errors=True)
    runs.write_text("a file where a folder is due")

    async def scenario():
        async with fresh_studio.page() as page:
            await page.send("job_start", spec=study())
            error = await page.until("error")
            assert error.where.startswith(str(runs))
            assert "cannot be made a folder" in error.what
            assert not [e for e in page.log if e["t"] == "job"]
            runs.unlink()
            await page.send("job_start", spec=study())
            job = await page.until("job")
            assert (await ended(page, job.id)).state == "done"

    run(scenario())


@pytest.mark.slow
def test_two_tabs_that_start_a_job_at_once_start_two(fresh_studio):
    async def scenario():
        async with fresh_studio.page() as one, fresh_studio.page() as other:
            spec = study(space={"radius": [0.01, 0.015]})
            await asyncio.gather(
                one.send("job_start", spec=spec), other.send("job_start", spec=spec)
            )
            for page in (one, other):
                seen = {}
                while len(seen) < 2 or set(seen.values()) != {"done"}:
                    job = await page.until("job", seconds=90)
                    seen[job.id] = job.state
                assert set(seen) == {"cylinder-study", "cylinder-study-2"}
                assert not [e for e in page.log if e["t"] == "error"]

    run(scenario())


@pytest.mark.slow
def test_two_tabs_that_resume_a_job_at_once_resume_it_once(fresh_studio):
    async def scenario():
        async with fresh_studio.page() as one, fresh_studio.page() as other:
            await one.send("job_start", spec=study())
            job = await one.until("job", lambda j: j.done >= 1)
            await one.send("job_stop", id=job.id)
            assert (await ended(one, job.id)).state == "stopped"
            await ended(other, job.id)
            await asyncio.gather(
                one.send("job_resume", id=job.id), other.send("job_resume", id=job.id)
            )
            for page in (one, other):
                assert (await ended(page, job.id)).done == 8
                assert not [e for e in page.log if e["t"] == "error"]

    run(scenario())
