"""Bodies at rest for pictures beside the view, asked for by HTTP as the page asks."""

import json
import struct
import threading
import tomllib
from concurrent.futures import ThreadPoolExecutor

import httpx
import lattice_families as families
import numpy as np
import pytest
from gripped_ball import GRIPPER
from own_loop import run

from voxsoft import files
from voxsoft.design import Design
from voxsoft.design import families as cut_families
from voxsoft.simulation import simulate
from voxsoft.studio.outputs import stills
from voxsoft.study import Study

BAR = """
schema = "voxsoft/1"
name = "bar"
voxel_size = "5 mm"
[parameters]
length = { value = "40 mm", min = "1 um", max = "60 mm" }
[shapes]
body = { kind = "box", size = ["= length", "10 mm", "10 mm"] }
[[parts]]
shape = "body"
material = "ecoflex-00-30-lattice"
[[clamps]]
region = { x = [0, 0] }
[[loads]]
kind = "gravity"
[probes]
tip = { x = ["= length", "= length"] }
[objectives]
sag = { minimize = "displacement", probe = "tip", axis = "z" }
"""


def asked(studio, name):
    """Answer of the server to a page that wants a picture of a body."""
    params = {"of": name, "token": studio.token}
    return httpx.get(f"{studio.origin}/still", params=params, timeout=60)


def read(content):
    """Points at rest, and positions, largest value and flags by field, of an answer."""
    rest, frames, objects = parts_of(content)
    assert objects == b""
    return rest, frames


def parts_of(content):
    """Parts of the message, with the objects around the body behind the frames."""
    points, triangles, edges = struct.unpack_from("<3I", content, 24)
    rest = np.frombuffer(content, "<f4", 3 * points, 64).reshape(-1, 3)
    at = 64 + 12 * points + 12 * triangles + 8 * edges + triangles
    at += -at % 4
    frames = {}
    while at < len(content):
        kind, flags, field = struct.unpack_from("<BBH", content, at + 4)
        if kind == 1:
            break
        assert kind == 2
        origin, scale = np.frombuffer(content, "<f4", 6, at + 32).reshape(2, 3).astype(float)
        steps = np.frombuffer(content, "<u2", 4 * points, at + 64).reshape(-1, 4)
        largest = struct.unpack_from("<2f", content, at + 56)[1]
        frames[field] = (origin + scale * steps[:, :3] / 65535, largest, flags)
        at += 64 + 8 * points
    return rest, frames, content[at:]


def make_study(folder):
    """Three bars; one of them is too short to hold a voxel. As an older study it has no states."""
    bar = Design.from_document(tomllib.loads(BAR))
    Study(bar, {"length": [0.03, 0.05, 1e-5]}, folder=folder).grid(workers=1)
    (folder / "equilibria").rename(folder / "away")
    return folder


@pytest.fixture(scope="module")
def study(shared_studio):
    return make_study(shared_studio.session.runs / "bars")


def trial_of(folder, length):
    return next(
        trial
        for trial in stills.stored_study(folder).trials
        if trial.parameters["length"] == pytest.approx(length)
    )


def test_a_stored_run_is_shown_where_it_came_to_rest(studio):
    result = simulate(families.cylinder())
    folder = files.write_run(result, studio.session.runs / "rest")
    answer = asked(studio, "rest")
    rest, frames = read(answer.content)
    reported = json.loads((folder / "summary.json").read_text())
    assert len(rest) == 660
    assert sorted(frames) == [0, 1, 2, 3, 4, 5, 6, 7]
    positions, largest, flags = frames[0]
    assert largest == pytest.approx(reported["metrics"]["max_displacement"], rel=1e-6)
    assert flags == 1 | 4
    # To the 16 bits of a frame.
    assert positions[:, 2].max() == pytest.approx(result.positions[:, 2].max(), rel=1e-6)
    assert np.linalg.norm(positions - rest, axis=1).max() == pytest.approx(largest, rel=1e-4)


def test_a_run_of_cut_voxels_is_shown_as_the_shape_that_cuts_them(studio):
    ball = cut_families.sphere()
    files.write_run(simulate(ball), studio.session.runs / "ball")
    content = asked(studio, "ball").content
    at = content.rindex(struct.pack("<IB", struct.unpack_from("<I", content)[0], 3))
    points, triangles = struct.unpack_from("<2I", content, at + 24)
    shape = np.frombuffer(content, "<f4", 3 * points, at + 64).reshape(-1, 3)
    outside = ball.shapes["body"].build(ball.shapes).evaluate(shape.astype(float))
    assert np.abs(outside).max() < 0.01 * ball.voxel_size
    assert triangles == struct.unpack_from("<I", content, 28)[0]
    # A body on the grid has no other shape.
    files.write_run(simulate(families.beam()), studio.session.runs / "beam")
    read(asked(studio, "beam").content)


def test_a_design_of_a_study_is_solved_as_the_study_did(studio, study):
    trial = trial_of(study, 0.05)
    rest, frames = read(asked(studio, f"bars/{trial.number}").content)
    assert np.ptp(rest[:, 0]) == pytest.approx(0.05)
    tip = rest[:, 0] > 0.0499
    sag = (frames[0][0] - rest)[tip, 2]
    assert sag.min() == pytest.approx(trial.objectives["sag"], rel=0.05)
    assert frames[3][0][:, 2].min() == frames[0][0][:, 2].min()


def test_a_study_is_shown_by_its_best_design(studio, study):
    best = stills.stored_study(study).best
    assert asked(studio, "bars").content == asked(studio, f"bars/{best.number}").content


def test_a_design_that_was_solved_is_not_solved_again(studio, study, monkeypatch):
    number = trial_of(study, 0.03).number
    first = asked(studio, f"bars/{number}")
    monkeypatch.setattr(stills, "simulate", lambda *_, **__: pytest.fail("solved again"))
    assert asked(studio, f"bars/{number}").content == first.content


def test_a_design_whose_state_the_study_has_is_not_solved(fresh_studio, monkeypatch):
    folder = make_study(fresh_studio.session.runs / "bars")
    (folder / "away").rename(folder / "equilibria")
    monkeypatch.setattr(stills, "simulate", lambda *_, **__: pytest.fail("solved again"))
    trial = trial_of(folder, 0.05)
    rest, frames = read(asked(fresh_studio, f"bars/{trial.number}").content)
    tip = rest[:, 0] > 0.0499
    sag = (frames[0][0] - rest)[tip, 2]
    assert sag.min() == pytest.approx(trial.objectives["sag"], rel=0.05)


def test_the_view_is_left_alone(studio, study):
    async def scenario():
        async with studio.page() as page:
            # The smooth shape is the last that comes of a body.
            await page.shown(lambda s: s.state == "paused")
            assert page.smooth or await page.until("smooth")
            await page.settled()
            known = events_of(page)
            assert asked(studio, "bars").status_code == 200
            await page.settled()
            assert events_of(page) == known

    def events_of(page):
        return [event for event in page.log if event["t"] != "picked"], len(page.frames)

    run(scenario())


def test_designs_that_cannot_be_shown_are_reported(studio, study):
    runs = studio.session.runs
    (runs / "begun").mkdir()
    (runs / "begun" / "design.toml").write_text(BAR)
    (runs / "alien").mkdir()
    files.write_run(simulate(families.beam()), runs / "hurt")
    (runs / "hurt" / "result.vtu").write_text("<VTKFile")
    files.write_run(simulate(families.beam()), runs / "gone")
    assert asked(studio, "gone").status_code == 200

    async def delete():
        async with studio.page() as page:
            await page.send("run_delete", id="gone")
            await page.until("runs", lambda r: r.trash)

    run(delete())
    for name, words in {
        "gone": "is not in the list of runs any more",
        "begun": "holds no result",
        "alien": "neither a run nor a study",
        "hurt": "result.vtu",
        f"bars/{trial_of(study, 1e-5).number}": "is empty",
        "bars/77": "is no trial of that study",
        "../runs": "is no name for a folder",
        "": "is no name for a folder",
    }.items():
        answer = asked(studio, name)
        reported = answer.json()
        assert answer.status_code == 422, name
        assert words in f"{reported['where']}: {reported['what']}", name
        assert "Traceback" not in answer.text


def test_only_the_page_of_this_studio_may_ask(studio, study):
    assert httpx.get(f"{studio.origin}/still", params={"of": "bars"}).status_code == 403


@pytest.mark.slow
def test_solving_ends_when_nobody_waits(fresh_studio, monkeypatch):
    make_study(fresh_studio.session.runs / "bars")
    solving, ended = threading.Event(), threading.Event()

    def endless(setup, progress):
        solving.set()
        while True:
            try:
                progress(1, 0.0, 1.0)
            except stills.StillCancelledError:
                ended.set()
                raise

    monkeypatch.setattr(stills, "simulate", endless)
    params = {"of": "bars", "token": fresh_studio.token}
    with pytest.raises(httpx.ReadTimeout):
        httpx.get(f"{fresh_studio.origin}/still", params=params, timeout=0.5)
    assert solving.is_set()
    assert ended.wait(20)


@pytest.mark.slow
def test_the_specimen_of_a_calibration_stands_where_its_stations_are(make_studio, tmp_path):
    beam = tmp_path / "beam.toml"
    beam.write_text(families.family_text("paper-beam"))
    studio = make_studio(beam)
    spec = {
        "kind": "calibrate",
        "name": "fit",
        "data": [{"name": "tip.csv"}],
        "method": "cma-es",
        "bounds": {"edge": [5e3, 80e3]},
        "generations": 2,
        "population": 4,
        "refine": False,
        "identify": False,
    }

    async def scenario():
        async with studio.page() as page:
            table = "arc_mm,dz_mm\n30,-15\n60,-44\n90,-75\n"
            await page.send("measurement", name="tip.csv", text=table)
            await page.send("job_start", spec=spec)
            first = await page.until("overlay", seconds=60)
            during = asked(studio, "fit")
            job = await page.until("job", lambda j: j.state in ("done", "failed"), seconds=60)
            assert job.state == "done", job.message
            last = next(e for e in reversed(page.log) if e["t"] == "overlay")
            return first.experiments[0], during, last["experiments"][0]

    first, during, last = run(scenario(), 120)
    assert during.status_code == 200
    _rest, frames = read(asked(studio, "fit").content)
    assert list(frames) == [0]
    positions, largest, _ = frames[0]
    for at, (measured, simulated) in enumerate(
        zip(last["measured"], last["simulated"], strict=True)
    ):
        # A missing measurement lies at the simulated station: the line is the error.
        assert measured[:2] == pytest.approx(simulated[:2])
        assert abs(measured[2] - simulated[2]) == pytest.approx(last["error"][at])
        near = np.linalg.norm(positions - simulated, axis=1).min()
        assert near < 0.006  # on the edge of a voxel of 10 mm
    assert measured[2] - positions[:, 2].max() < 0
    assert first["error"] != []
    assert largest > 0.01


def test_a_damaged_specimen_is_reported(studio):
    folder = studio.session.runs / "fit"
    folder.mkdir(parents=True)
    (folder / "design.toml").write_text(families.family_text("paper-beam"))
    (folder / "shapes.csv").write_text("")
    assert "holds no shape of its specimen" in asked(studio, "fit").json()["what"]
    for content in (b"", b"PK", b"\x93NUMPY"):
        (folder / "specimen.npz").write_bytes(content)
        assert "is damaged" in asked(studio, "fit").json()["what"]
    np.savez(folder / "specimen.npz", positions=np.zeros((3, 3)))
    assert "is not of this design" in asked(studio, "fit").json()["what"]


@pytest.mark.long
@pytest.mark.parametrize("what", ["run", pytest.param("study", marks=pytest.mark.slow)])
def test_objects_stand_where_they_are_at_the_end(studio, what, monkeypatch):
    design = Design.from_document(tomllib.loads(GRIPPER.replace("0.15 s", "0.08 s")))
    result = simulate(design)
    lifted = result.objects["ball"].position
    assert lifted[2] > 0.001
    folder = studio.session.runs / f"grip-{what}"
    if what == "run":
        files.write_run(result, folder)
    else:
        with ThreadPoolExecutor(1) as threads:
            Study(design, {"squeeze": [0.5e-3]}, folder=folder).grid(executor=threads)
        monkeypatch.setattr(stills, "simulate", lambda *_, **__: pytest.fail("solved again"))
    rest, frames, objects = parts_of(asked(studio, folder.name).content)
    assert struct.unpack_from("<I", objects, 8) == (2,)
    (count,) = struct.unpack_from("<I", objects, 24)
    points = np.frombuffer(objects, "<f4", 3 * count, 64).reshape(-1, 3)
    assert (points.min(axis=0) + points.max(axis=0)) / 2 == pytest.approx(lifted, abs=2e-5)
    assert frames[0][0][:, 2].max() - rest[:, 2].max() == pytest.approx(0.002, abs=2e-4)
