"""Bad designs, broken files, full memory, rude clients: said in words, and nothing lost."""

import json
import re
import signal
import threading
import tomllib
from contextlib import suppress
from pathlib import Path

import httpx
import lattice_families as families
import meshio
import numpy as np
import pytest
import tomlkit
from bad_designs import NO_DESIGN, NO_TEXT, NOT_SOLVABLE
from own_loop import run

from voxsoft.design.document.assignment import set_values
from voxsoft.studio.server.session import OWN_FOLDER

CYLINDER = families.family_text("paper-cylinder")
RADIUS = ["parameters", "radius", "value"]
WALL = ["parameters", "wall", "value"]


def changed(change):
    return tomlkit.dumps(set_values(tomllib.loads(CYLINDER), [change]))


def upload(port, token, name, content):
    origin = f"http://127.0.0.1:{port}"
    params = {"name": name, "token": token}
    return httpx.post(
        f"{origin}/upload", params=params, content=content, headers={"origin": origin}, timeout=60
    )


@pytest.mark.long
@pytest.mark.parametrize(("change", "words"), NO_DESIGN)
def test_an_invalid_design_is_reported_at_its_line(studio, change, words):
    async def scenario():
        async with studio.page() as page:
            good = await page.until("body")
            await page.send("text", rev=page.rev, text=changed(change))
            document = await page.until("document", lambda d: d.diagnostics)
            found = [f"{each['what']} {each['hint']}" for each in document.diagnostics]
            assert any(words in each for each in found), found
            assert all(each["line"] >= 1 and each["where"] for each in document.diagnostics)
            assert document.design["name"] == "cylinder"
            await page.send("play")
            stat = await page.until("stat", lambda s: s.state == "playing")
            assert stat.topology == good.topology

    run(scenario())


@pytest.mark.parametrize(("change", "words"), NOT_SOLVABLE)
def test_unsolvable_designs_are_shown_all_the_same(studio, change, words):
    async def scenario():
        async with studio.page() as page:
            before = await page.until("topology")
            await page.send("text", rev=page.rev, text=changed(change))
            body = await page.until("body", lambda b: b.topology > before.topology)
            await page.until("frame", lambda f: f.topology == body.topology)
            await page.send("play")
            error = await page.until("error")
        assert any(words in f"{each['what']} {each['hint']}" for each in body.findings)
        assert words in f"{error.what} {error.hint}"

    run(scenario())


@pytest.mark.parametrize("content", NO_TEXT.values(), ids=NO_TEXT)
def test_undo_recovers_from_a_broken_design_file(studio, content):
    assert upload(studio.port, studio.token, "broken.toml", content).status_code == 200

    async def scenario():
        async with studio.page() as page:
            await page.send("edit", rev=page.rev, path=RADIUS, value="20 mm")
            await page.until("document", lambda d: d.dirty)
            await page.send("open", what="upload", name="broken.toml")
            while True:
                message = await page.receive()
                if message.t == "error":  # it is no text at all
                    assert message.what
                    return
                if message.t == "document" and message.name == "broken.toml":
                    break
            assert not message.valid
            assert all(each["line"] >= 1 and each["what"] for each in message.diagnostics)
            await page.send("undo", beyond=True)
            good = await page.until("document", lambda d: d.valid)
            assert '"20 mm"' in good.text

    run(scenario())


def test_a_mesh_with_a_hole_is_shown_with_a_warning_and_a_cure(studio, tmp_path):
    corners = 0.02 * np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)])
    squares = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    triangles = [half for a, b, c, d in squares for half in ((a, b, c), (a, c, d))]
    meshio.Mesh(1e3 * corners, [("triangle", np.array(triangles[:-1]))]).write(tmp_path / "a.stl")
    upload(studio.port, studio.token, "a.stl", (tmp_path / "a.stl").read_bytes())

    def of_the_hole(finding):
        return "is open" in finding["what"] or "hole" in finding["what"]

    async def scenario():
        async with studio.page() as page:
            await page.send("open", what="upload", name="a.stl")
            await page.until("document", lambda d: d.name == "a.toml")
            # The body that was open before may come first, with findings of its own.
            body = await page.until("body", lambda b: any(map(of_the_hole, b.findings)))
        found = next(filter(of_the_hole, body.findings))
        assert found["severity"] == "warning"
        assert found["where"] == "shapes.body.path"
        assert "close the surface" in found["hint"]

    run(scenario())


def memory_of(studio):
    """The largest memory that a server ever took [MB]."""
    status = Path(f"/proc/{studio.process.pid}/status").read_text(encoding="ascii")
    return int(re.search(r"VmHWM:\s+(\d+)", status).group(1)) / 1024


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="tells no memory of processes")
@pytest.mark.parametrize(
    ("path", "value"),
    [
        (["voxel_size"], "20 um"),
        pytest.param(["shapes", "outer", "height"], "1000 km", marks=pytest.mark.slow),
    ],
)
def test_a_design_larger_than_the_memory_is_refused_at_once(in_own_process, tmp_path, path, value):
    source = tmp_path / "cylinder.toml"
    source.write_text(CYLINDER)
    studio = in_own_process(source)

    async def scenario():
        async with studio.page() as page:
            await page.until("body")
            before = memory_of(studio)
            await page.send("edit", rev=page.rev, path=path, value=value)
            document = await page.until("document", lambda d: d.diagnostics, seconds=120)
            assert "of memory" in document.diagnostics[0]["what"]
            # A look with larger voxels takes some 20 MB, the grid itself more than 10 GB.
            assert memory_of(studio) - before < 500
            await page.send("undo")
            await page.until("document", lambda d: d.valid)

    run(scenario())


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="tells no memory of processes")
def test_a_file_of_a_gigabyte_takes_no_memory(in_own_process, tmp_path):
    source = tmp_path / "cylinder.toml"
    source.write_text(CYLINDER)
    studio = in_own_process(source)
    before = memory_of(studio)
    try:
        parts = (bytes(2**20) for _ in range(1024))
        assert upload(studio.port, "token", "large.stl", parts).status_code == 413
    except (httpx.WriteError, httpx.ReadError, httpx.RemoteProtocolError):
        pass  # refused while the rest was still being sent: the answer may be lost in part
    # 64 MB are taken before it is known to be too large.
    assert memory_of(studio) - before < 300


def test_a_request_after_sync_reads_all_edits_before_it(studio):
    """A request of its own connection may overtake commands, unless it waits for `synced`."""

    async def scenario():
        async with studio.page() as page:
            for size in ("20 mm", "15 mm", "22 mm"):
                await page.send("edit", rev=page.rev, path=RADIUS, value=size)
                asked = await page.send("sync")
                assert (await page.until("synced")).seq == asked
                assert f'"{size}"' in studio.session.document.text

    run(scenario())


def test_two_tabs_edit_at_once_and_each_sees_all(studio):
    async def scenario():
        async with studio.page() as left, studio.page() as right:
            await left.send("edit", rev=left.rev, path=RADIUS, value="20 mm")
            await right.send("edit", rev=right.rev, path=WALL, value="10 mm")
            for page in (left, right):
                both = await page.until(
                    "document", lambda d: '"20 mm"' in d.text and 'value = "10 mm",' in d.text
                )
            # Two edits of one value: the last wins.
            await left.send("edit", rev=both.rev, path=RADIUS, value="15 mm")
            await left.until("document", lambda d: '"15 mm"' in d.text)
            await right.send("edit", rev=both.rev, path=RADIUS, value="22 mm")
            for page in (left, right):
                await page.until("document", lambda d: '"22 mm"' in d.text)
            # Undo goes back through the changes of both, newest first, to the file.
            while True:
                await left.send("undo")
                document = await left.until("document", ack=False)
                if not document.can_undo:
                    break
            assert document.text == CYLINDER
            await right.until("document", lambda d: d.text == CYLINDER)

    run(scenario())


@pytest.mark.parametrize(
    "name",
    ["../out", "/etc", "", " ", "..", ".hidden", "a/b", "a\\b", "a\0b", "x" * 200, "line\nbreak"],
)
def test_a_run_is_not_given_a_name_that_no_folder_should_have(studio, name):
    folder = studio.session.runs / "first"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "design.toml").write_text(CYLINDER)

    async def scenario():
        async with studio.page() as page:
            await page.send("run_rename", id="first", name=name)
            error = await page.until("error")
            assert "no name for a folder" in error.what
            await page.send("run_delete", id=name)
            assert (await page.until("error")).what

    run(scenario())
    folders = {each.name for each in studio.session.runs.iterdir() if each.is_dir()}
    assert folders - {OWN_FOLDER} == {"first"}


def test_a_run_may_have_a_name_of_any_language(fresh_studio):
    folder = fresh_studio.session.runs / "first"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "design.toml").write_text(CYLINDER)

    async def scenario():
        async with fresh_studio.page() as page:
            await page.send("run_rename", id="first", name="Greifer größer 二")
            await page.until("runs", lambda r: any("二" in row["id"] for row in r.rows))

    run(scenario())


def test_a_runs_folder_that_cannot_be_written_is_reported(make_studio, tmp_path):
    runs = tmp_path / "runs"
    runs.write_text("a file stands where the folder should be")
    studio = make_studio(runs=runs)

    async def scenario():
        async with studio.page() as page:
            await page.until("body")
            await page.send("job_start", spec={"kind": "run"})
            assert "cannot be" in (await page.until("error")).what
            await page.send("edit", rev=page.rev, path=RADIUS, value="20 mm")
            await page.until("body", lambda b: b.voxels == 204)

    run(scenario())
    answer = upload(studio.port, studio.token, "a.toml", b"")
    assert answer.status_code == 422
    assert answer.json()["what"]


@pytest.mark.long
@pytest.mark.parametrize(
    "doing",
    [
        pytest.param("meshing", marks=pytest.mark.slow),
        "solving",
        pytest.param("exporting", marks=pytest.mark.slow),
    ],
)
def test_ctrl_c_ends_the_studio_whatever_it_does(in_own_process, tmp_path, doing):
    source = tmp_path / "cylinder.toml"
    source.write_text(CYLINDER)
    studio = in_own_process(source)

    async def scenario():
        async with studio.page() as page:
            await page.until("body")
            await page.send("edit", rev=page.rev, path=["voxel_size"], value="1 mm")
            if doing == "meshing":
                await page.until("document", lambda d: d.rev == 2)
                return
            await page.until("body", lambda b: b.rev == 2)
            if doing == "solving":
                await page.send("rest")
                await page.until("stat", lambda s: s.state == "solving")

    run(scenario())
    if doing == "exporting":
        origin = f"http://127.0.0.1:{studio.port}"
        request = {"format": "inp", "options": {}}

        def export():
            with suppress(httpx.TransportError):  # the server is ended before it can answer
                httpx.post(
                    f"{origin}/export?token=token",
                    content=json.dumps(request),
                    headers={"origin": origin},
                    timeout=60,
                )

        waiting = threading.Thread(target=export)
        waiting.start()
        exports = tmp_path / "runs" / ".studio" / "exports"
        while not exports.exists():
            assert waiting.is_alive()
    code, reported = studio.end(signal.SIGINT)
    assert code == 0
    assert "Traceback" not in reported
    assert "1 mm" in (tmp_path / "runs" / ".studio" / "draft.json").read_text()
