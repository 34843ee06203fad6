"""Pictures of designs, and equilibria that are known when a design is opened."""

import struct
import threading
import tomllib
import zlib
from concurrent.futures import ThreadPoolExecutor

import httpx
import msgspec
import numpy as np
import pytest
from gripped_ball import GRIPPER
from own_loop import run

from voxsoft.design import Design, families
from voxsoft.simulation import simulate
from voxsoft.studio.bodies.equilibrium import equilibrium_of
from voxsoft.studio.motion import rest
from voxsoft.studio.outputs.thumbnails import Thumbnails
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


def picture(studio, of):
    params = {"of": of, "token": studio.token}
    return httpx.get(f"{studio.origin}/picture", params=params, timeout=60)


def pixels(png):
    """Red, green, blue and opacity of a picture, (h, w, 4)."""
    at, data = 8, b""
    while at < len(png):
        (size,) = struct.unpack_from(">I", png, at)
        if png[at + 4 : at + 8] == b"IHDR":
            width, height = struct.unpack_from(">II", png, at + 8)
        elif png[at + 4 : at + 8] == b"IDAT":
            data += png[at + 8 : at + 8 + size]
        at += 12 + size
    rows = np.frombuffer(zlib.decompress(data), np.uint8).reshape(height, 1 + 4 * width)
    return rows[:, 1:].reshape(height, width, 4)


@pytest.fixture
def barred(make_studio, tmp_path):
    """A studio with a bar open, and a study of bars: one is too short to hold a voxel."""
    file = tmp_path / "bar.toml"
    file.write_text(BAR)
    studio = make_studio(file)
    design = Design.from_document(tomllib.loads(BAR))
    with ThreadPoolExecutor(1) as threads:
        study = Study(design, {"length": [0.03, 0.05, 1e-5]}, folder=studio.session.runs / "bars")
        result = study.grid(executor=threads)
    return studio, result


def number_of(result, length):
    return next(
        trial.number
        for trial in result.trials
        if trial.parameters["length"] == pytest.approx(length)
    )


@pytest.fixture
def searches(monkeypatch):
    """Number of searches for an equilibrium by the studio."""
    begun = []
    solve = rest.simulate
    monkeypatch.setattr(rest, "simulate", lambda *a, **k: begun.append(1) or solve(*a, **k))
    return begun


async def opened(page, what, name):
    rev = page.rev
    await page.send("open", what=what, name=name)
    await page.until("document", lambda d: d.rev > rev)
    stat, frame = await page.shown(lambda s: s.state == "at-rest")
    return stat, frame


def test_a_design_of_a_study_is_pictured_at_rest_and_to_scale(barred):
    studio, result = barred
    answers = {
        length: picture(studio, f"trial/bars/{number_of(result, length)}")
        for length in (0.03, 0.05)
    }
    for length, answer in answers.items():
        assert answer.status_code == 200, answer.text
        assert answer.headers["x-voxsoft-state"] == "rest"
        drawn = pixels(answer.content)
        # Nothing but the body is there, so that it stands on any color.
        assert drawn[0, 0, 3] == 0
        assert drawn[..., 3].max() == 255
        assert max(drawn.shape) in range(235, 246)
        per_meter = float(answer.headers["x-voxsoft-pixels-per-meter"])
        assert 0.5 * length < max(drawn.shape) / per_meter < 1.5 * length
    scale = [float(each.headers["x-voxsoft-pixels-per-meter"]) for each in answers.values()]
    assert scale[0] > 1.2 * scale[1]  # the shorter bar fills its picture as well


def test_cut_voxels_are_pictured_as_the_shape_that_cuts_them(tmp_path):
    ball = families.sphere()
    found = Thumbnails(tmp_path).of("ball", lambda: ball, [], threading.Event())
    covered = pixels(found.content)[..., 3] > 127
    rows, columns = covered.any(axis=1), covered.any(axis=0)
    share = covered.sum() / (rows.sum() * columns.sum())
    # A disc from every side, but for the facets: whole voxels cover 4 % less of a rectangle.
    assert share == pytest.approx(np.pi / 4, rel=0.03)


def test_a_picture_is_drawn_once_unloaded_where_no_more_is_known(barred):
    studio, result = barred
    number = number_of(result, 0.05)
    folder = studio.session.runs / "bars"
    for file in (folder / "equilibria").iterdir():
        file.rename(file.with_suffix(".away"))
    unloaded = picture(studio, f"trial/bars/{number}")
    assert unloaded.headers["x-voxsoft-state"] == "unloaded"
    for file in (folder / "equilibria").iterdir():
        file.rename(file.with_suffix(".npz"))
    at_rest = picture(studio, f"trial/bars/{number}")
    assert at_rest.headers["x-voxsoft-state"] == "rest"
    assert at_rest.content != unloaded.content
    (kept,) = (folder / "thumbnails").glob("*-rest.png")
    kept.write_bytes(unloaded.content)  # the kept picture is sent from now on
    assert picture(studio, f"trial/bars/{number}").content == unloaded.content


@pytest.mark.parametrize(
    ("of", "says"),
    [
        ("trial/bars/99", "no trial"),
        ("trial/bars/../0", "no name"),
        ("trial/none/0", "not in the list"),
        ("file//etc/passwd", "not known"),
        ("version/1", "no version"),
        ("", "not known"),
    ],
)
def test_missing_pictures_are_reported(barred, of, says):
    answer = picture(barred[0], of)
    assert answer.status_code == 422
    assert says in answer.json()["what"]


def test_recent_files_and_versions_have_pictures(barred):
    studio, _ = barred

    async def scenario():
        async with studio.page() as page:
            await page.settled()
            (start, *_) = [each for each in page.log if each["t"] == "start"]
            await page.send("edit", rev=page.rev, path=["name"], value="other")
            await page.until("document", lambda d: d.dirty)
            await page.send("save")
            await page.until("saved")
            await page.send("versions")
            versions = (await page.until("versions")).versions
            return start["recent"], versions

    recent, versions = run(scenario())
    for url in (recent[0]["picture"], versions[0]["picture"]):
        answer = httpx.get(f"{studio.origin}{url}&token={studio.token}", timeout=60)
        assert answer.status_code == 200, answer.text
        assert answer.headers["content-type"] == "image/png"
    # A file that is no design has none; the page shows it without.
    studio.session.document.path.write_text("name = 1")
    answer = httpx.get(f"{studio.origin}{recent[0]['picture']}&token={studio.token}")
    assert answer.status_code == 204


def test_a_design_of_a_study_opens_at_rest_without_being_solved_again(barred, searches):
    studio, result = barred
    number = number_of(result, 0.05)

    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            stat, frame = await opened(page, "trial", f"bars/{number}")
            assert stat.sentence == "At rest, as it was solved before."
            found = await page.until("equilibrium")
            sag = next(each for each in found.metrics if each["name"] == "sag")
            trial = next(each for each in result.trials if each.number == number)
            assert sag["value"] == pytest.approx(trial.objectives["sag"], rel=1e-9)
            assert frame.flags & 4

    run(scenario())
    assert searches == []


def test_a_body_solved_on_opening_is_not_solved_again(barred, searches):
    studio, result = barred
    number = number_of(result, 0.03)
    for file in (studio.session.runs / "bars" / "equilibria").iterdir():
        file.unlink()

    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            first, _ = await opened(page, "trial", f"bars/{number}")
            assert "solved before" not in first.sentence
            await page.send("open", what="template", name="beam")
            await page.shown(lambda s: s.state == "paused")
            second, _ = await opened(page, "trial", f"bars/{number}")
            assert "solved before" in second.sentence

    run(scenario())
    assert searches == [1]


def test_a_state_that_is_not_that_of_the_design_is_solved_again(barred, searches):
    studio, result = barred
    number = number_of(result, 0.05)
    folder = studio.session.runs / "bars" / "equilibria"
    trial = next(each for each in result.trials if each.number == number)
    file = folder / f"{trial.hash}.npz"
    with np.load(file) as content:
        positions, mesh = content["positions"], content["mesh"]
    np.savez(file, positions=1.01 * positions, mesh=mesh)

    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            stat, _ = await opened(page, "trial", f"bars/{number}")
            assert "solved before" not in stat.sentence

    run(scenario())
    assert searches == [1]


def test_a_run_opens_at_rest_without_being_solved_again(barred, searches):
    studio, _ = barred

    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            await page.send("rest")
            await page.shown(lambda s: s.state == "at-rest")
            await page.send("keep", name="kept")
            await page.until("saved", lambda s: s.what == "run")
            searches.clear()
            for file in (studio.session.own / "equilibria").iterdir():
                file.unlink()
            await page.send("open", what="template", name="beam")
            await page.shown(lambda s: s.state == "paused")
            stat, _ = await opened(page, "run", "kept")
            assert "solved before" in stat.sentence

    run(scenario())
    assert searches == []


def test_taking_a_design_writes_its_parameters_as_one_step(barred, searches):
    studio, result = barred
    number = number_of(result, 0.05)

    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            before = page.document.text
            await page.send("take", trial=f"bars/{number}")
            taken = await page.until("taken")
            assert (taken.trial, taken.changed) == (f"bars/{number}", True)
            assert page.document.text == before.replace('value = "40 mm"', 'value = "50 mm"')
            assert page.document.path is not None  # it is still the open document
            # It is the design of the trial now, whose equilibrium is known.
            await page.shown(lambda s: s.state == "at-rest")
            await page.send("reset")
            await page.shown(lambda s: s.state == "paused")
            await page.send("take", trial=f"bars/{number}")
            assert (await page.until("taken")).changed is False
            await page.shown(lambda s: s.state == "at-rest")
            await page.send("undo")
            await page.until("document", lambda d: d.text == before)

    run(scenario())
    assert searches == []


def test_a_design_without_those_parameters_takes_none(barred):
    studio, _ = barred

    async def scenario():
        async with studio.page() as page:
            await page.send("open", what="template", name="sphere")
            await page.until("document", lambda d: d.name == "sphere.toml")
            before = page.document.text
            await page.send("take", trial="bars/0")
            error = await page.until("error")
            assert "varies length" in error.what
            assert "document of its own" in error.hint
            await page.settled()
            assert page.document.text == before

    run(scenario())


@pytest.fixture
def gripping(make_studio, tmp_path):
    """A studio with a bar open, and a study of grippers with a ball."""
    file = tmp_path / "bar.toml"
    file.write_text(BAR)
    studio = make_studio(file)
    design = Design.from_document(tomllib.loads(GRIPPER))
    with ThreadPoolExecutor(1) as threads:
        study = Study(design, {"squeeze": [0.5e-3]}, folder=studio.session.runs / "grips")
        (trial,) = study.grid(executor=threads).trials
    return studio, design.with_parameters(**trial.parameters)


@pytest.mark.slow
def test_a_gripper_of_a_study_opens_with_its_numbers_unsolved(gripping, searches):
    studio, design = gripping

    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            stat, _ = await opened(page, "trial", "grips/0")
            assert "as it was solved before" in stat.sentence
            assert stat.time == pytest.approx(0.15)
            card = await page.until("equilibrium")
            moments = next(each for each in reversed(page.log) if each["t"] == "moments")
            assert searches == []
            await page.send("rest")
            again, _ = await page.shown(lambda s: s.state == "at-rest" and s.frame > stat.frame)
            full = await page.until("equilibrium", lambda e: e.frame == again.frame)
            film = next(each for each in reversed(page.log) if each["t"] == "moments")
            return card, moments, full, film

    card, moments, full, film = run(scenario(), 120)
    solved = equilibrium_of(simulate(design), card.topology, card.frame)
    for name in ("residual", "probes", "metrics", "chambers", "largest_strain", "warnings"):
        assert plain(getattr(card, name)) == plain(getattr(solved, name)), name
        assert plain(getattr(card, name)) == plain(getattr(full, name)), name
    assert plain(card.grips) == plain(solved.grips) == plain(full.grips)
    assert card.grips[0]["verdict"] == "held"
    assert "Only the end" in card.missing
    assert full.missing == ""
    (end,) = moments["moments"]
    last = film["moments"][-1]
    assert len(film["moments"]) > 5
    for name in ("poses", "contacts", "time", "fields"):
        assert end[name] == last[name], name
    assert end["fields"] is True


def plain(value):
    return msgspec.json.decode(msgspec.json.encode(value))


@pytest.mark.slow
def test_a_gripper_of_a_study_is_pictured_with_its_ball(gripping):
    studio, _ = gripping
    answer = picture(studio, "trial/grips/0")
    assert answer.status_code == 200, answer.text
    assert answer.headers["x-voxsoft-state"] == "rest"
    drawn = pixels(answer.content).astype(int)
    ball = (np.ptp(drawn[..., :3], axis=2) <= 3) & (drawn[..., 3] > 100)
    assert ball.sum() > 500  # gray, between the pads that have the color of their part
