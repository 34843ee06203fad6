"""Versions of the document: when they are kept, how they differ, and how one comes back."""

import pytest
from own_loop import run

from voxsoft.errors import FileError
from voxsoft.studio.documents.line_difference import line_differences
from voxsoft.studio.documents.versions import MOST, MOST_FILES, Versions

BOX = """
schema = "voxsoft/1"
name = "box"
voxel_size = "5 mm"
[parameters]
length = "40 mm"
[shapes]
body = { kind = "box", size = ["= length", "10 mm", "10 mm"] }
[[parts]]
shape = "body"
material = "ecoflex-00-30-lattice"
[[clamps]]
region = { x = [0, 0] }
"""


async def listed(page):
    await page.send("versions")
    return (await page.until("versions")).versions


async def edited(page, value):
    rev = page.rev
    await page.send("edit", rev=rev, path=["parameters", "length"], value=value)
    await page.until("document", lambda d: d.rev > rev)


async def saved(page):
    await page.send("save")
    await page.until("saved")


@pytest.fixture
def boxed(make_studio, tmp_path):
    file = tmp_path / "box.toml"
    file.write_text(BOX)
    return make_studio(file), file


def test_every_save_is_a_version_and_so_is_the_earlier_file(boxed):
    studio, file = boxed

    async def scenario():
        async with studio.page() as page:
            assert await listed(page) == []
            await edited(page, "50 mm")
            await saved(page)
            await edited(page, "60 mm")
            await saved(page)
            await saved(page)  # nothing has changed since
            reasons = [each["reason"] for each in await listed(page)]
            assert reasons == ["saved", "saved", "in the file before"]
            # Another program wrote the file: its text is not lost.
            file.write_text(BOX.replace("40 mm", "99 mm"))
            await edited(page, "70 mm")
            await saved(page)
            reasons = [each["reason"] for each in await listed(page)]
            assert reasons[:3] == ["saved", "in the file before", "saved"]

    run(scenario())


def test_edited_work_is_a_version_when_something_else_is_opened(boxed):
    studio, file = boxed

    async def scenario():
        async with studio.page() as page:
            await edited(page, "55 mm")
            await page.send("open", what="template", name="beam")
            await page.until("document", lambda d: d.name == "beam.toml")
            await page.send("open", what="file", name=str(file))
            await page.until("document", lambda d: d.name == "box.toml")
            (version,) = await listed(page)
            assert version["reason"] == "before beam.toml was opened"
            await page.send("version_restore", id=version["id"])
            back = await page.until("document", lambda d: "55 mm" in d.text)
            assert back.dirty

    run(scenario())


def test_a_version_comes_back_as_one_step_and_nothing_is_lost(boxed):
    studio, _ = boxed

    async def scenario():
        async with studio.page() as page:
            await edited(page, "50 mm")
            await saved(page)
            await edited(page, "60 mm")
            before = page.document.text
            old = (await listed(page))[-1]
            await page.send("version_show", id=old["id"])
            shown = await page.until("version_difference")
            changed = {each["mark"]: each["text"] for each in shown.lines}
            assert changed["gone"] == 'length = "40 mm"'
            assert changed["new"] == 'length = "60 mm"'
            await page.send("version_restore", id=old["id"])
            await page.until("document", lambda d: d.text == BOX)
            newest = (await listed(page))[0]
            assert newest["reason"] == "before another was restored"
            await page.send("undo")
            await page.until("document", lambda d: d.text == before)
            await page.send("version_show", id=newest["id"])
            assert (await page.until("version_difference")).lines == []
            await page.send("version_show", id="77")
            assert "has no version" in (await page.until("error")).what

    run(scenario())


def test_only_the_newest_are_kept(tmp_path):
    versions, file = Versions(tmp_path), tmp_path / "a.toml"
    for number in range(MOST + 7):
        assert versions.keep(file, f"a = {number}", "saved")
    found = versions.of(file)
    assert [each.text for each in found[:2]] == [f"a = {MOST + 6}", f"a = {MOST + 5}"]
    assert len(found) == MOST
    assert versions.one(file, found[-1].id).text == "a = 7"
    for bad in ("", "../x", "0", "99999999"):
        with pytest.raises(FileError, match="no version"):
            versions.one(file, bad)


def test_versions_of_few_files_are_kept(tmp_path):
    versions = Versions(tmp_path)
    for number in range(MOST_FILES + 2):
        versions.keep(tmp_path / f"{number}.toml", "a = 1", "saved")
    kept = [bool(versions.of(tmp_path / f"{number}.toml")) for number in range(MOST_FILES + 2)]
    assert sum(kept) == MOST_FILES
    assert kept[-1]


def test_damaged_and_empty_versions_are_left_out(tmp_path):
    versions, file = Versions(tmp_path), tmp_path / "a.toml"
    assert not versions.keep(file, " \n", "saved")
    versions.keep(file, "a = 1", "saved")
    versions.keep(file, "a = 2", "saved")
    (newest,) = tmp_path.rglob("00000002.json")
    newest.write_text("{")
    assert [each.text for each in versions.of(file)] == ["a = 1"]
    assert versions.keep(file, "a = 3", "saved")
    assert [each.text for each in versions.of(file)] == ["a = 3", "a = 1"]


def test_lines_far_from_changes_are_left_out():
    before = "\n".join(f"line {number}" for number in range(40))
    after = before.replace("line 5\n", "").replace("line 30", "line 30 changed")
    found = line_differences(before, after)
    assert [each.mark for each in found].count("gap") == 1
    assert [(each.text, each.before) for each in found if each.mark == "gone"] == [
        ("line 5", 6),
        ("line 30", 31),
    ]
    assert [(each.text, each.after) for each in found if each.mark == "new"] == [
        ("line 30 changed", 30)
    ]
    assert line_differences(before, before) == []
    assert line_differences("a\n" * 30_000, "b") is None
