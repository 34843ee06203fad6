"""One document after another: unsaved text stays, also over a restart."""

import signal

import pytest
from own_loop import run

from voxsoft.design import families

CYLINDER = families.family_text("paper-cylinder")
RADIUS = ["parameters", "radius", "value"]


def arm_and_leg(folder):
    files = folder / "arm.toml", folder / "leg.toml"
    for file in files:
        file.write_text(CYLINDER.replace('"cylinder"', f'"{file.stem}"', 1))
    return files


def test_undo_leads_back_to_the_document_before_with_its_own_file(make_studio, tmp_path):
    arm, leg = arm_and_leg(tmp_path)
    studio = make_studio(arm)

    async def scenario():
        async with studio.page() as page:
            await page.send("edit", rev=page.rev, path=RADIUS, value="20 mm")
            await page.until("document", lambda d: d.dirty)
            await page.send("open", what="file", name=str(leg))
            opened = await page.until("document", lambda d: d.name == "leg.toml")
            assert (opened.can_undo, opened.before) == (False, "arm.toml")
            # Undo stops at the start of a document: only a press of its own leads beyond it.
            await page.send("undo")
            edge = await page.until("edge")
            assert (edge.way, edge.name, edge.beyond) == ("undo", "leg.toml", "arm.toml")
            await page.send("undo", beyond=True)
            back = await page.until("document", lambda d: d.name == "arm.toml")
            assert '"20 mm"' in back.text
            assert (back.dirty, back.can_undo, back.can_redo) == (True, True, False)
            # A change made while looking back takes no way on.
            await page.send("edit", rev=page.rev, path=["voxel_size"], value="3.5 mm")
            changed = await page.until("document", lambda d: "3.5 mm" in d.text)
            assert changed.after == "leg.toml"
            await page.send("undo")
            await page.until("document", lambda d: "3.5 mm" not in d.text)
            await page.send("redo")
            await page.until("document", lambda d: "3.5 mm" in d.text)
            await page.send("undo")
            await page.send("save")
            await page.until("saved")
            await page.send("redo")
            await page.send("redo", beyond=True)
            again = await page.until("document", lambda d: d.name == "leg.toml")
            assert again.path == str(leg)

    run(scenario())
    assert '"20 mm"' in arm.read_text()
    assert leg.read_text() == CYLINDER.replace('"cylinder"', '"leg"', 1)


def test_undo_after_a_restart_leads_to_unsaved_changes(make_studio, tmp_path):
    arm, leg = arm_and_leg(tmp_path)
    first = make_studio(arm)

    async def change():
        async with first.page() as page:
            await page.send("edit", rev=page.rev, path=RADIUS, value="20 mm")
            await page.until("document", lambda d: d.dirty)

    run(change())
    first.stop()
    make_studio(leg).stop()  # a look at another file must not cost the draft
    second = make_studio(leg)

    async def look():
        async with second.page() as page:
            await page.until("log", lambda log: "undo offers the way back" in log.text)
            assert next(e for e in page.log if e["t"] == "document")["name"] == "leg.toml"
            await page.send("undo", beyond=True)
            back = await page.until("document", lambda d: d.name == "arm.toml")
            assert back.path == str(arm)
            assert '"20 mm"' in back.text

    run(look())


@pytest.mark.long
def test_a_killed_server_has_kept_typed_text(make_studio, in_own_process, tmp_path):
    arm, _ = arm_and_leg(tmp_path)
    first = in_own_process(arm)

    async def change():
        async with first.page() as page:
            await page.send("text", rev=page.rev, text=CYLINDER.replace("25 mm", "22 mm", 1))
            await page.until("document", lambda d: d.dirty)

    run(change())
    draft = tmp_path / "runs" / ".studio" / "draft.json"
    while not draft.exists():
        assert first.process.poll() is None
    first.end(signal.SIGKILL)
    second = make_studio(arm)

    async def look():
        async with second.page() as page:
            await page.until("log", lambda log: "not saved are back" in log.text)
            assert "22 mm" in next(e for e in page.log if e["t"] == "document")["text"]

    run(look())


@pytest.mark.parametrize("name", ["/etc/passwd", "notes.txt", "a\0b.toml", ""])
def test_only_design_files_are_shown(make_studio, tmp_path, name):
    (tmp_path / "notes.txt").write_text("a secret\n")
    studio = make_studio(arm_and_leg(tmp_path)[0])

    async def scenario():
        async with studio.page() as page:
            await page.send("open", what="file", name=str(tmp_path / name) if name else "")
            error = await page.until("error")
            assert "design" in error.what or "cannot be read" in error.what
            assert "secret" not in str(error)

    run(scenario())


def test_from_nothing_several_edits_are_one_step(fresh_studio):
    async def scenario():
        async with fresh_studio.page() as page:
            rev = page.rev
            await page.send("open", what="template", name="empty")
            await page.until("document", lambda d: d.rev > rev)
            empty = page.document
            sphere = {"kind": "sphere", "radius": "20 mm"}
            part = {"shape": "ball", "material": "ecoflex-00-30"}
            changes = [
                {"path": ["shapes", "ball"], "value": sphere},
                {"path": ["parts", 0], "value": part},
            ]
            await page.send("edits", rev=empty.rev, changes=changes)
            await page.until("document", lambda d: d.rev > empty.rev)
            made = page.document
            body = await page.until("body", lambda b: b.rev == made.rev)
            await page.send("undo")
            await page.until("document", lambda d: d.rev > made.rev)
            return empty, made, body, page.document

    empty, made, body, undone = run(scenario())
    assert not empty.valid
    assert empty.name == "robot.toml"
    assert made.valid
    # 5 mm voxels in a ball of 20 mm: 33.5 mL of 0.125 mL each, and cut ones at its surface.
    assert 268 < body.voxels < 268 * (1 + 5 / 20) ** 3
    assert undone.text == empty.text
