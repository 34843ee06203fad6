"""Jobs in processes of their own: studies, calibrations, runs, and the list of their folders."""

import os
import shutil
import signal
from pathlib import Path

import lattice_families as families
import own_loop
import pytest

from voxsoft.study import Study

BEAM = families.family_text("paper-beam")
DATA = Path(__file__).parents[3] / "examples" / "data" / "paper_beams" / "ecoflex-00-30.csv"


def run(scenario):
    return own_loop.run(scenario, 120)


def small_study(**changes):
    """Eight cylinders, in one process."""
    space = {"radius": [0.01, 0.015, 0.02, 0.025], "wall": [0.005, 0.01]}
    return {"kind": "study", "sampler": "grid", "workers": 1, "space": space, **changes}


async def ended(page, job=None):
    finals = ("done", "stopped", "failed")
    return await page.until(
        "job", lambda j: j.state in finals and (job is None or j.id == job), seconds=60
    )


@pytest.mark.long
def test_a_study_shows_its_trials_and_leaves_its_folder(fresh_studio):
    async def scenario():
        async with fresh_studio.page() as page:
            await page.send("job_start", spec=small_study())
            started = await page.until("job")
            trial = await page.until("trial")
            job = await ended(page)
            trials = next(e for e in reversed(page.log) if e["t"] == "trials")
            rows = (await page.until("runs", lambda r: r.rows and r.rows[0]["status"] == "ok")).rows
            best = next(t for t in reversed(trials["trials"]) if t["feasible"])
            await page.send("open", what="trial", name=f"{job.id}/{best['index']}")
            document = await page.until("document", lambda d: d.name.startswith(job.id))
            # It is shown as it ended, blown up, though nobody pressed a button.
            await page.shown(lambda stat: stat.state == "at-rest")
            await page.send("compare", a=f"{job.id}/0", b=f"{job.id}/{best['index']}")
            compared = await page.until("compared")
        assert started.kind == "study"
        assert set(trial.parameters) == {"radius", "wall"}
        assert (job.state, job.done, job.total) == ("done", 8, 8), job.message
        assert "best rise" in job.message
        assert len(trials["trials"]) == 8
        assert trials["kinds"] == {"radius": "length", "wall": "length", "rise": "length"}
        folder = fresh_studio.session.runs / "cylinder-study"
        for name in ("study.journal", "table.csv", "summary.json", "thumbnail.png"):
            assert (folder / name).is_file()
        assert rows[0]["trials"] == 8
        assert rows[0]["thumbnail"] == "/thumbnail/cylinder-study"
        radius = document.design["parameters"]["radius"]["value"]
        assert radius == pytest.approx(best["parameters"]["radius"])
        assert {d["where"] for d in compared.differences} >= {"parameters.radius.value"}

    run(scenario())


@pytest.mark.slow
def test_a_study_goes_on_while_no_tab_is_open(fresh_studio):
    async def begin():
        async with fresh_studio.page() as page:
            await page.send("job_start", spec=small_study())
            await page.until("trial")

    async def come_back():
        async with fresh_studio.page() as page:
            return await ended(page), [e for e in page.log if e["t"] in ("trial", "trials")]

    run(begin())
    job, reported = run(come_back())
    assert (job.state, job.done) == ("done", 8)
    assert len(next(e for e in reversed(reported) if e["t"] == "trials")["trials"]) == 8


@pytest.mark.slow
def test_a_study_waits_goes_on_and_stops(fresh_studio):
    async def scenario():
        async with fresh_studio.page() as page:
            await page.send("job_start", spec=small_study())
            job = await page.until("job", lambda j: j.done >= 1)
            await page.send("job_pause", id=job.id)
            held = await page.until("job", lambda j: j.state == "paused")
            await page.settled()
            assert all(e["done"] <= held.done for e in page.log if e["t"] == "job")
            await page.send("job_resume", id=job.id)
            await page.until("job", lambda j: j.state == "running" and j.done > held.done)
            await page.send("job_pause", id=job.id)
            await page.until("job", lambda j: j.state == "paused")
            await page.send("job_stop", id=job.id)
            stopped = await ended(page)
            assert stopped.state == "stopped"
            await page.send("job_resume", id=job.id)
            done = await page.until("job", lambda j: j.state == "done", seconds=60)
        assert done.done == 8
        assert "kept" in stopped.message

    run(scenario())


@pytest.mark.slow
def test_a_restart_of_the_server_costs_no_trial(make_studio, tmp_path):
    first = make_studio()

    async def begin():
        async with first.page() as page:
            await page.send("job_start", spec=small_study())
            await page.until("job", lambda j: j.done >= 2)

    run(begin())
    first.stop()
    folder = first.session.runs / "cylinder-study"
    kept = (folder / "study.journal").read_bytes()

    second = make_studio()

    async def go_on():
        async with second.page() as page:
            rows = (await page.until("runs")).rows
            assert rows[0]["id"] == "cylinder-study"
            await page.send("job_resume", id="cylinder-study")
            return await ended(page)

    assert run(go_on()).done == 8
    assert (folder / "study.journal").read_bytes().startswith(kept)


@pytest.mark.slow
def test_a_process_that_is_killed_is_reported_and_its_trials_are_kept(fresh_studio):
    async def scenario():
        async with fresh_studio.page() as page:
            await page.send("job_start", spec=small_study())
            job = await page.until("job", lambda j: j.done >= 2)
            os.kill(fresh_studio.session.jobs.known(job.id).process.pid, signal.SIGKILL)
            failed = await ended(page)
            assert failed.state == "failed"
            assert "killed by signal 9" in failed.message
            assert "resume to go on" in failed.message
            await page.send("job_resume", id=job.id)
            first = await page.until("trials")
            assert len(first.trials) >= 2
            assert (await page.until("job", lambda j: j.state == "done", seconds=60)).done == 8

    run(scenario())


@pytest.mark.long
@pytest.mark.parametrize(
    ("spec", "words"),
    [
        ({"kind": "study", "space": {"radios": [1]}}, "is not a parameter"),
        ({"kind": "study", "sampler": "magic", "budget": 3}, "magic"),
        ({"kind": "study", "space": {"wall": {"low": 2, "high": 1}}}, "low < high"),
        ({"kind": "study", "objectives": {"a": {"maximize": "nothing"}}}, "nothing"),
        ({"kind": "run", "solver": {"method": "magic"}}, "magic"),
        ({"kind": "calibrate", "data": [{"name": "x.csv"}]}, "was not sent"),
    ],
)
def test_a_job_that_cannot_be_is_reported_in_words(studio, spec, words):
    async def scenario():
        async with studio.page() as page:
            await page.settled()  # the jobs of other tests were told
            await page.send("job_start", spec=spec)
            while True:
                message = await page.receive()
                if message.t == "error":
                    return message.what
                if message.t == "job" and message.state == "failed":
                    return message.message

    assert words in run(scenario())


@pytest.mark.long
def test_a_run_leaves_its_folder_and_its_picture(studio):
    async def scenario():
        async with studio.page() as page:
            await page.settled()  # the jobs of other tests were told
            await page.send("job_start", spec={"kind": "run", "name": "first"})
            job = await ended(page)
            assert job.state == "done", job.message
            await page.send("open", what="run", name="first")
            document = await page.until("document", lambda d: d.name == "first.toml")
        assert "At rest after" in job.message
        assert "= radius - wall" in document.text
        assert (studio.session.runs / "first" / "result.vtu").is_file()

    run(scenario())


@pytest.mark.slow
def test_a_calibration_overlays_its_shapes_and_leaves_a_card(make_studio, tmp_path):
    beam = tmp_path / "beam.toml"
    beam.write_text(BEAM)
    studio = make_studio(beam)
    spec = {
        "kind": "calibrate",
        "data": [{"name": "tip.csv", "select": None}],
        "method": "cma-es",
        "bounds": {"edge": [5e3, 80e3]},
        "generations": 3,
        "population": 4,
        "identify": True,
    }
    table = "s (mm);drop [cm];remark\n30;-1,5;a\n60;-4,4;b\n90;-7,5;c\n"
    columns = [
        {"column": "s (mm)", "quantity": "arc", "unit": "mm"},
        {"column": "drop [cm]", "quantity": "dz", "unit": "cm"},
    ]

    async def scenario():
        async with studio.page() as page:
            await page.send("measurement", name="tip.csv", text=table)
            guessed = await page.until("measured")
            assert guessed.problems
            assert guessed.columns[0]["quantity"] == "arc"
            await page.send("measurement", name="tip.csv", text=table, columns=columns)
            seen = await page.until("measured")
            assert not seen.problems
            assert seen.points[1] == pytest.approx([0, 0, -0.044])
            await page.send("job_start", spec=spec)
            generation = await page.until("generation")
            overlay = await page.until("overlay")
            job = await ended(page)
            assert job.state == "done", job.message
            done = next(e for e in page.log if e["t"] == "calibrated")
            await page.send("card_save", job=job.id, name="my-silicone")
            saved = await page.until("saved")
        assert generation.spread["edge"][0] <= generation.parameters["edge"]
        experiment = overlay.experiments[0]
        assert len(experiment["measured"]) == len(experiment["simulated"]) == 3
        # Free beam of 90 mm on the lower edge: the station at 30 mm sagged by 15 mm.
        assert experiment["measured"][0][2] == pytest.approx(-0.015, abs=1e-6)
        assert done["parameters"][0]["name"] == "edge"
        assert done["parameters"][0]["text"].endswith("kPa")
        assert len(done["table"]) == 3
        assert 'model = "lattice"' in done["card"]
        assert 'name = "my-silicone"' in Path(saved.path).read_text()

    run(scenario())


def test_runs_are_renamed_deleted_and_restored_and_broken_ones_listed(fresh_studio, tmp_path):
    runs = fresh_studio.session.runs
    study = Study(families.cylinder(), {"wall": ("5 mm", "10 mm", "5 mm")}, folder=runs / "old")
    assert study.grid_size == 2
    (runs / "broken").mkdir(parents=True)
    (runs / "broken" / "design.toml").write_text(BEAM)
    (runs / "broken" / "summary.json").write_text('{"status": "ok"')
    (runs / "alien").mkdir()

    async def scenario():
        async with fresh_studio.page() as page:
            rows = {row["id"]: row for row in (await page.until("runs")).rows}
            assert rows["old"]["status"] == "interrupted"
            assert "is damaged" in rows["broken"]["message"]
            assert rows["alien"]["kind"] == "unknown"
            await page.send("run_rename", id="old", name="new")
            assert {r["id"] for r in (await page.until("runs")).rows} == {"new", "broken", "alien"}
            await page.send("run_delete", id="broken")
            reported = await page.until("runs")
            assert [r["id"] for r in reported.trash] == ["broken"]
            await page.send("run_restore", id="broken")
            assert "broken" in {r["id"] for r in (await page.until("runs")).rows}
            for tag, fields in (
                ("run_rename", {"id": "new", "name": "../../out"}),
                ("run_rename", {"id": "new", "name": "broken"}),
                ("run_delete", {"id": "../runs"}),
                ("run_delete", {"id": ".studio"}),
                ("run_restore", {"id": "never"}),
                ("open", {"what": "run", "name": "alien"}),
                ("open", {"what": "trial", "name": "new/77"}),
                ("compare", {"a": "new", "b": "alien"}),
            ):
                await page.send(tag, **fields)
                assert (await page.until("error")).what
            await page.send("open", what="run", name="new")
            assert (await page.until("document", lambda d: d.name == "new.toml")).valid

    run(scenario())
    assert (runs / "new" / "study.journal").is_file()


def test_an_archived_run_folder_is_unpacked_among_the_runs(studio, tmp_path):
    import httpx

    source = tmp_path / "packed" / "arm"
    source.mkdir(parents=True)
    (source / "design.toml").write_text(BEAM)
    archive = shutil.make_archive(str(tmp_path / "arm"), "zip", source.parent)
    answer = httpx.post(
        f"{studio.origin}/upload",
        params={"name": "arm.zip", "token": studio.token},
        content=Path(archive).read_bytes(),
        headers={"origin": studio.origin},
    )
    assert answer.status_code == 200

    async def scenario():
        async with studio.page() as page:
            await page.send("open", what="upload", name="arm.zip")
            assert (await page.until("document", lambda d: d.name == "arm.toml")).valid

    run(scenario())
