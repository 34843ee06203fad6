"""Content of the start screen, when it opens by itself, and the files of before."""

import urllib.error
import urllib.request

import pytest
from own_loop import run

from voxsoft.design import families, robots
from voxsoft.studio.documents.recent import MOST, RecentFiles
from voxsoft.studio.server.security import cookie_name

LENGTH = ["parameters", "length", "value"]


def logged(page):
    return [event for event in page.log if event["t"] == "start"]


def test_it_opens_by_itself_until_something_is_opened(make_studio):
    studio = make_studio(None)

    async def scenario():
        async with studio.page() as page:
            await page.settled()
            assert logged(page)[-1]["fresh"] is True
            assert [each["name"] for each in logged(page)[-1]["robots"]] == [
                each.name for each in robots.ROBOTS
            ]
            await page.send("open", what="robot", name="tendon_finger")
            opened = await page.until("document", lambda d: d.name == "tendon_finger.toml")
            assert opened.text == robots.robot_text("tendon_finger")
            assert (opened.dirty, opened.path, opened.diagnostics) == (False, None, [])
            assert logged(page)[-1]["fresh"] is False
        async with studio.page() as page:  # a reload
            await page.settled()
            assert logged(page)[-1]["fresh"] is False

    run(scenario())


def test_it_stays_away_where_a_design_is_given_or_a_draft_was_left(make_studio, tmp_path):
    file = tmp_path / "arm.toml"
    file.write_text(families.family_text("beam"))

    async def fresh(studio, edit=False):
        async with studio.page() as page:
            await page.settled()
            if edit:
                await page.send("edit", rev=page.rev, path=LENGTH, value="90 mm")
                await page.until("document", lambda d: d.dirty)
            return logged(page)[0]["fresh"]

    given = make_studio(file)
    assert run(fresh(given)) is False
    given.stop()
    bare = make_studio(None)
    assert run(fresh(bare)) is True  # the given document was not changed
    bare.stop()
    edited = make_studio(file)
    assert run(fresh(edited, edit=True)) is False
    edited.stop()
    assert run(fresh(make_studio(None))) is False


def test_files_that_were_opened_or_saved_are_offered_after_a_restart(make_studio, tmp_path):
    arm, leg = tmp_path / "arm.toml", tmp_path / "leg.toml"
    arm.write_text(families.family_text("beam"))
    first = make_studio(arm)

    async def save():
        async with first.page() as page:
            await page.send("save", path="leg.toml")
            start = await page.until("start", lambda s: len(s.recent) == 2)
            await page.until("saved")
            assert [each["path"] for each in start.recent] == [str(leg), str(arm)]

    async def recent(studio):
        async with studio.page() as page:
            await page.settled()
            return [each["name"] for each in logged(page)[-1]["recent"]]

    run(save())
    first.stop()
    second = make_studio(None)
    assert run(recent(second)) == ["leg.toml", "arm.toml"]
    second.stop()
    leg.unlink()
    assert run(recent(make_studio(None))) == ["arm.toml"]


def test_a_new_design_that_was_left_unsaved_is_offered_until_it_is_saved(make_studio):
    first = make_studio(None)

    async def begin():
        async with first.page() as page:
            await page.send("open", what="template", name="beam")
            await page.until("document", lambda d: d.name == "beam.toml")
            await page.send("edit", rev=page.rev, path=LENGTH, value="90 mm")
            await page.until("document", lambda d: d.dirty)
            await page.send("open", what="template", name="empty")
            start = await page.until("start", lambda s: s.recent)
            assert [(each["name"], each["path"]) for each in start.recent] == [("beam.toml", "")]

    run(begin())
    first.stop()
    second = make_studio(None)

    async def go_on():
        async with second.page() as page:
            await page.settled()
            (listed,) = logged(page)[-1]["recent"]
            await page.send("open", what="unsaved", name=listed["unsaved"])
            opened = await page.until("document", lambda d: d.name == "beam.toml")
            assert '"90 mm"' in opened.text
            assert (opened.dirty, opened.path) == (True, None)
            await page.send("save", path="arm.toml")
            start = await page.until("start", lambda s: len(s.recent) == 1)
            assert start.recent[0]["path"].endswith("arm.toml")
            refused = await page.send("open", what="unsaved", name=listed["unsaved"])
            error = await page.until("error", lambda e: e.seq == refused)
            assert "not kept" in error.what

    run(go_on())


def test_three_answers_open_a_robot_with_values_of_its_own(make_studio):
    studio = make_studio(None)

    async def scenario():
        async with studio.page() as page:
            await page.send("open", what="start", name="pressure-cylinder-extend")
            opened = await page.until("document", lambda d: d.name == "wound_tube.toml")
            wind = next(each for each in opened.parameters if each["name"] == "wind")
            assert wind["text"] == "75 deg"
            refused = await page.send("open", what="start", name="heat-trunk-grip")
            error = await page.until("error", lambda e: e.seq == refused)
            assert "no robot" in error.what
            refused = await page.send("open", what="robot", name="../../secret")
            assert (await page.until("error", lambda e: e.seq == refused)).where == "robot"

    run(scenario())


def test_pictures_come_from_the_server(make_studio):
    studio = make_studio(None)

    def get(path):
        request = urllib.request.Request(
            studio.origin + path, headers={"cookie": f"{cookie_name(studio.port)}={studio.token}"}
        )
        return urllib.request.urlopen(request, timeout=20)

    with get("/robot/bellows") as answer:
        assert answer.headers["content-type"] == "image/webp"
        assert answer.read() == robots.robot_picture("bellows")
    with get("/robot/pneunet?moving=1") as answer:
        assert answer.read() == robots.robot_picture("pneunet", moving=True)
    for path in ("/robot/nobody", "/robot/bellows?moving=1", "/robot/..%2f__init__.py"):
        with pytest.raises(urllib.error.HTTPError) as caught:
            get(path)
        assert caught.value.code == 404


def test_a_damaged_list_of_recent_files_counts_as_none(tmp_path):
    recent = RecentFiles(tmp_path)
    files = [tmp_path / f"{i}.toml" for i in range(MOST + 3)]
    for file in files:
        file.write_text("")
        recent.note(file)
    assert [each.name for each in RecentFiles(tmp_path).files()] == [
        file.name for file in reversed(files[3:])
    ]
    (tmp_path / "recent.json").write_text("{")
    assert RecentFiles(tmp_path).files() == []
