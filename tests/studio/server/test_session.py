"""The studio driven over its websocket, as a page would.

Long because one session with its document, body and time is driven through all that it does.
"""

import json
import socket
import tomllib

import httpx
import lattice_families as families
import numpy as np
import pytest
import websockets
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from own_loop import run

import voxsoft as vs
from voxsoft.simulation import simulate
from voxsoft.studio.protocol.wire import PROTOCOL, CloseCode
from voxsoft.studio.server.app import MOST_WRONG

CYLINDER = families.family_text("paper-cylinder")


def positions_of(frame):
    """Positions of the points of a frame in m, (n, 3)."""
    origin = np.frombuffer(frame.bytes, "<f4", 3, 32).astype(float)
    scale = np.frombuffer(frame.bytes, "<f4", 3, 44).astype(float)
    steps = np.frombuffer(frame.bytes, "<u2", 4 * frame.n, 64).reshape(-1, 4)[:, :3]
    return origin + scale * steps / 65535


def test_a_tab_is_shown_the_design_and_its_body(fresh_studio):
    async def scenario():
        async with fresh_studio.page(hello=False) as page:
            await page.send("hello", protocol=PROTOCOL)
            hello = await page.until("hello")
            document = await page.until("document")
            body = await page.until("body")
            # The shape may come before its report.
            topology = page.topology or await page.until("topology")
            _, frame = await page.shown(lambda s: s.state == "paused")
            smooth = page.smooth or await page.until("smooth")
        points, triangles = smooth.n, smooth.seq
        assert len(smooth.bytes) == 64 + 12 * points + 12 * triangles + -(-triangles // 4) * 4
        assert np.ptp(np.frombuffer(smooth.bytes, "<f4", 3 * points, 64)[2::3]) == pytest.approx(
            0.035, abs=1e-5
        )
        assert hello.design_schema["$id"] == "voxsoft/1"
        assert len([field for field in hello.fields if not field["contact"]]) == 9
        of_contact = [field["name"] for field in hello.fields if field["contact"]]
        assert of_contact == ["contact_pressure", "contact_friction", "contact_gap"]
        assert document.valid
        assert [p["name"] for p in document.parameters] == ["radius", "height", "wall", "cap"]
        assert body.voxels == 300
        assert body.cavities[0]["volume"] == pytest.approx(32.5e-6)
        assert (topology.magic, topology.topology, topology.n) == (0x31465856, 1, 660)
        # Header, points, triangles, edges, one byte for each triangle.
        triangles, edges = topology.seq, np.frombuffer(topology.bytes, "<u4", 1, 32)[0]
        assert len(topology.bytes) == 64 + 12 * 660 + 12 * triangles + 8 * edges + triangles
        assert np.ptp(positions_of(frame), axis=0) == pytest.approx([0.05, 0.05, 0.035], abs=1e-6)

    run(scenario())


@pytest.mark.long
def test_a_body_with_a_layer_is_played_to_its_rest(studio):
    bare = families.beam().with_values("voxel_size=10 mm").to_toml()
    layer = (
        '[[layers]]\nregion = { z = ["10 mm", "10 mm"] }\nyoung = "30 MPa"\nthickness = "0.1 mm"\n'
    )
    text = bare + layer
    design = vs.Design.from_document(tomllib.loads(text))

    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            before = page.rev
            await page.send("text", rev=before, text=text)
            await page.until("body", lambda b: b.rev > before)
            await page.send("play")
            _, frame = await page.shown(lambda s: s.state == "at-rest", seconds=60.0)
        return frame

    frame = run(scenario())
    due = simulate(design).positions[:, 2].min()
    assert positions_of(frame)[:, 2].min() == pytest.approx(due, rel=1e-3)


@pytest.mark.long
def test_played_and_solved_bodies_come_to_the_same_rest(studio):
    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            await page.send("play")
            played, frame = await page.shown(lambda s: s.state == "at-rest")
            await page.send("reset")
            await page.shown(lambda s: s.state == "paused" and s.frame == 0)
            await page.send("rest")
            solved, other = await page.shown(lambda s: s.state == "at-rest")
        assert "At rest after" in played.sentence
        assert "residual" in solved.sentence
        due = simulate(families.cylinder()).positions[:, 2].max()
        # Live motion stops at a residual of 1e-4, ten times that of the solver: 0.2 % of the rise
        # was the largest difference on the paper's cylinders.
        assert positions_of(frame)[:, 2].max() == pytest.approx(due, rel=1e-3)
        assert positions_of(other)[:, 2].max() == pytest.approx(due, rel=1e-5)

    run(scenario())


@pytest.mark.long
def test_a_grab_pulls_its_vertex_and_lets_go(studio):
    async def scenario():
        async with studio.page() as page:
            _, rest = await page.shown(lambda s: s.state == "paused")
            top = int(positions_of(rest)[:, 2].argmax())
            await page.send("play")
            _, before = await page.shown(lambda s: s.state == "at-rest")
            free = positions_of(before)[top]
            # A gentle pull: a strong one turns voxels inside out, and the wall stays dented.
            target = [free[0] + 0.01, free[1], free[2]]
            await page.send("grab", id=3, vertex=top, target=target, stiffness=20.0)
            held, during = await page.shown(lambda s: s.state == "at-rest" and s.grabs)
            pulled = positions_of(during)[top]
            await page.send("release", id=3)
            _, after = await page.shown(lambda s: s.state == "at-rest" and not s.grabs)
            back = positions_of(after)[top]
        grab = held.grabs[0]
        assert grab["vertex"] == top
        assert pulled[0] > free[0] + 5e-4
        # The spring's law, to the 16 bits of a frame.
        assert grab["force"][0] == pytest.approx(20.0 * (target[0] - pulled[0]), rel=1e-2)
        # Friction-free and elastic: it comes back, within the tolerance of rest.
        assert back == pytest.approx(free, abs=1e-4)

    run(scenario())


@pytest.mark.long
def test_a_load_is_changed_while_time_runs(studio):
    async def scenario():
        async with studio.page() as page:
            await page.send("play")
            full = await page.until("stat", lambda s: s.state == "at-rest")
            await page.send("load", index=0, value=2000.0)
            half = await page.until("stat", lambda s: s.state == "at-rest" and s.loads == [2000.0])
            await page.send("rest")
            solved = await page.until(
                "stat", lambda s: s.state == "at-rest" and "res" in s.sentence
            )
            await page.send("load", index=7, value=1.0)
            error = await page.until("error")
        assert half.elastic < 0.5 * full.elastic
        assert solved.elastic == pytest.approx(half.elastic, rel=1e-2)
        assert "there are 1 loads" in error.what

    run(scenario())


def test_stored_frames_can_be_looked_at_again(studio):
    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            await page.send("step", n=3)
            last, now = await page.shown(lambda s: s.frame >= 2 and s.state != "playing")
            await page.send("seek", frame=1)
            stat, past = await page.shown(lambda s: s.state == "past")
            await page.send("live")
            _, again = await page.shown(lambda s: s.state != "past")
        assert last.frames_stored == last.frame
        assert stat.sentence == f"Frame 1 of {last.frame}"
        assert past.time < now.time
        assert positions_of(again) == pytest.approx(positions_of(now), abs=1e-8)

    run(scenario())


@pytest.mark.long
def test_a_body_that_rests_too_soon_to_be_seen_is_shown_slowly(studio):
    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            await page.send("play")
            slow = await page.until("stat", lambda s: s.state == "playing" and s.frame > 5)
            rest, _ = await page.shown(lambda s: s.state == "at-rest")
            rows = [row for event in page.log if event["t"] == "plot" for row in event["rows"]]
        assert slow.pace == 1 / 50
        assert slow.pace_chosen is None
        assert "Shown 50 times slower than real time, as it comes to rest" in slow.sentence
        # Looking ahead has changed nothing: time begins at zero, and each step is there to see.
        assert rows[0][0] < 1e-3
        assert rest.frames_stored == len(rows) > 100
        assert rest.sentence.endswith("forces balance within 0.01 % of the load.")

    run(scenario())


def test_a_chosen_pace_holds_and_ends_the_automatic_one(studio):
    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            await page.send("pace", factor=0.1)
            await page.send("play")
            chosen = await page.until("stat", lambda s: s.state == "playing")
            rest, _ = await page.shown(lambda s: s.state == "at-rest")
            await page.send("reset")
            await page.send("pace")
            await page.send("play")
            slow = await page.until("stat", lambda s: s.pace_chosen is None and s.pace < 1)
            await page.send("load", index=0, value=3000.0)
            quick = await page.until("stat", lambda s: s.loads == [3000.0])
            await page.send("pace", factor=2.0)
            error = await page.until("error")
        assert (chosen.pace, chosen.pace_chosen) == (0.1, 0.1)
        assert chosen.sentence == "Shown 10 times slower than real time."
        assert rest.frames_stored > 20
        assert slow.pace == 1 / 50
        assert quick.pace == 1.0
        assert "factor" in error.what

    run(scenario())


def test_a_stored_frame_is_found_by_time_after_a_change_of_pace(studio):
    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            await page.send("pace", factor=1 / 200)
            await page.send("step", n=10)
            begun, _ = await page.shown(lambda s: s.frame >= 10 and s.state != "playing")
            await page.send("pace", factor=1.0)
            await page.send("play")
            await page.shown(lambda s: s.state == "at-rest")
            await page.send("seek", time=begun.time)
            stat, past = await page.shown(lambda s: s.state == "past")
        # The first ten frames span no more than one of the later ones.
        assert begun.time < 1 / 60
        assert stat.frame == 10
        assert past.time == begun.time

    run(scenario())


def test_a_slider_gives_a_new_body_and_a_bad_value_keeps_the_old_one(studio):
    async def scenario():
        async with studio.page() as page:
            before = await page.until("topology")
            await page.send(
                "edit", rev=page.rev, path=["parameters", "radius", "value"], value="20 mm"
            )
            body = await page.until("body", lambda b: b.topology == before.topology + 1)
            await page.send("edit", rev=page.rev, path=["parameters", "wall", "value"], value="1 m")
            document = await page.until("document", lambda d: not d.valid)
            await page.send("undo")
            good = await page.until("document", lambda d: d.valid)
        assert body.voxels == 204
        assert "above max" in document.diagnostics[0]["what"]
        assert document.design["parameters"]["radius"]["value"] == pytest.approx(0.02)
        assert '"20 mm"' in good.text

    run(scenario())


def test_a_body_too_large_for_the_memory_is_refused_with_the_estimate(studio, monkeypatch):
    monkeypatch.setattr("voxsoft.studio.bodies.body.memory_limit", lambda: 5_000_000)

    async def scenario():
        async with studio.page() as page:
            await page.send("edit", rev=page.rev, path=["voxel_size"], value="2.5 mm")
            document = await page.until("document", lambda d: d.diagnostics)
        found = document.diagnostics[0]
        assert "would need about 0.014 GB" in found["what"]
        assert document.text.splitlines()[found["line"] - 1].startswith("voxel_size")

    run(scenario())


def test_two_tabs_see_the_same_and_have_views_of_their_own(studio):
    async def scenario():
        async with studio.page() as one, studio.page() as two:
            await one.until("frame")
            await two.until("frame")
            await two.send("view", field=3)
            old = one.rev
            await one.send("edit", rev=one.rev, path=["parameters", "wall", "value"], value="10 mm")
            first = await one.until("document", lambda d: d.rev == old + 1)
            second = await two.until("document", lambda d: d.rev == old + 1)
            assert first.text == second.text
            await two.send("play")
            assert (await one.until("frame", lambda f: f.flags & 4)).field == 0
            assert (await two.until("frame", lambda f: f.flags & 4)).field == 3
            # Typed in an older text than the other tab's: not taken, and said.
            await two.send("text", rev=old, text="old = 1")
            assert "another tab" in (await two.until("error")).what
            await one.send("text", rev=one.rev, text=first.text + "\n# mine")
            assert (await two.until("document", lambda d: d.rev == old + 2)).text.endswith("# mine")

    run(scenario())


@pytest.mark.long
def test_a_tab_that_takes_no_frames_gets_two_and_then_the_newest(studio):
    async def scenario():
        async with studio.page() as page:
            await page.until("topology", ack=False)
            await page.send("step", n=500)
            last = await page.until("stat", lambda s: s.state == "at-rest", ack=False)
            await page.settled()
            assert len(page.frames) == 2
            await page.send("ack", frame=page.frames[-1].frame)
            assert (await page.until("frame", ack=False)).frame == last.frame

    run(scenario())


@pytest.mark.long
def test_a_hidden_tab_gets_no_frames(studio):
    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            await page.send("view", field=0, visible=False)
            await page.settled()
            before = len(page.frames)
            await page.send("play")
            await page.until("stat", lambda s: s.state == "at-rest")
            await page.settled()
            assert len(page.frames) == before
            await page.send("view", field=0, visible=True)
            assert (await page.until("frame")).flags & 4

    run(scenario())


def test_another_version_of_the_protocol_is_refused_in_words(studio):
    async def scenario():
        async with studio.page(hello=False) as page:
            await page.send("hello", protocol=PROTOCOL + 1)
            error = await page.until("error")
            assert "reload the page" in error.hint
            with pytest.raises(websockets.ConnectionClosed) as closed:
                await page.until("document")
            assert closed.value.rcvd.code == CloseCode.OTHER_PROTOCOL

    run(scenario())


@pytest.mark.parametrize(
    ("first", "code"),
    [
        ('{"t": "play", "seq": 1}', CloseCode.OTHER_PROTOCOL),
        ("ünïcödé " * 100, CloseCode.WRONG_MESSAGES),
        ('{"t": "%s"}' % ("x" * 500), CloseCode.WRONG_MESSAGES),
    ],
    ids=["no hello", "no json", "a long answer"],
)
def test_who_says_no_hello_learns_why_it_is_sent_away(studio, first, code):
    async def scenario():
        async with studio.page(hello=False) as page:
            await page.send_raw(first)
            assert (await page.until("error")).where == "hello"
            with pytest.raises(websockets.ConnectionClosed) as closed:
                await page.until("document")
            assert closed.value.rcvd.code == code
            assert closed.value.rcvd.reason

    run(scenario())


def test_many_wrong_messages_end_the_visit_in_words(studio):
    async def scenario():
        async with studio.page() as page:
            for _ in range(MOST_WRONG):
                await page.send_raw("{")
            with pytest.raises(websockets.ConnectionClosed) as closed:
                await page.until("saved")
            assert closed.value.rcvd.code == CloseCode.WRONG_MESSAGES
            assert f"{MOST_WRONG} messages in a row" in closed.value.rcvd.reason

    run(scenario())


def test_whatever_is_sent_is_answered_or_closed_and_the_session_lives(fresh_studio):
    tags = st.sampled_from(
        [
            "open",
            "text",
            "edit",
            "undo",
            "save",
            "play",
            "step",
            "seek",
            "load",
            "grab",
            "release",
            "view",
            "pick",
            "probe",
            "ack",
            "solver",
            "job_start",
            "compare",
            "nothing",
        ]
    )
    values = st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
        lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner),
        max_leaves=6,
    )
    names = st.sampled_from(
        [
            "rev",
            "path",
            "value",
            "text",
            "what",
            "name",
            "n",
            "frame",
            "index",
            "id",
            "vertex",
            "target",
            "stiffness",
            "field",
            "mode",
            "method",
            "spec",
        ]
    )
    wrong = st.builds(
        lambda tag, fields: json.dumps({"t": tag, "seq": 1, **fields}, default=str),
        tags,
        st.dictionaries(names, values, max_size=4),
    )
    messages = st.lists(wrong | st.binary(max_size=64) | st.text(max_size=64), max_size=12)

    async def send_all(batch):
        async with fresh_studio.page() as page:
            for message in batch:
                await page.send_raw(message)
            await page.send("pause")
            await page.until("stat")

    @settings(
        max_examples=4, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
    )
    @given(messages)
    def fuzz(batch):
        try:
            run(send_all(batch))
        except websockets.ConnectionClosed as closed:
            assert closed.rcvd.code in (1000, 1002, 1003, 1007, 1008)  # noqa: PT017

    fuzz()
    assert fresh_studio.session.engine.is_alive()

    async def still_there():
        async with fresh_studio.page() as page:
            await page.until("body")

    run(still_there())


def upload(studio, name, content):
    return httpx.post(
        f"{studio.origin}/upload",
        params={"name": name, "token": studio.token},
        content=content,
        headers={"origin": studio.origin},
        timeout=60,
    )


def test_an_upload_of_a_gigabyte_is_refused_after_64_mb(studio):
    sent = 0

    def parts():
        nonlocal sent
        for _ in range(1024):
            sent += 1
            yield bytes(2**20)

    try:
        answer = upload(studio, "large.stl", parts())
    except (httpx.WriteError, httpx.ReadError, httpx.RemoteProtocolError):
        answer = None  # refused while the rest was still being sent
    assert sent < 1024
    if answer is not None:
        assert answer.status_code == 413
        assert "larger than 64 MB" in answer.json()["what"]


def test_a_length_that_is_declared_is_refused_before_anything_is_read(studio):
    head = (
        f"POST /upload?name=a.stl&token={studio.token} HTTP/1.1\r\n"
        f"Host: 127.0.0.1:{studio.port}\r\n"
        f"Origin: {studio.origin}\r\nContent-Length: {2**30}\r\n\r\n"
    )
    with socket.create_connection(("127.0.0.1", studio.port)) as line:
        line.sendall(head.encode())
        assert line.recv(100).startswith(b"HTTP/1.1 413")


@pytest.mark.parametrize("name", ["a.exe", "", "..", "a.py", "design"])
def test_an_unknown_kind_of_file_is_refused(studio, name):
    answer = upload(studio, name, b"x")
    assert answer.status_code == 422
    assert "no kind of file" in answer.json()["what"]


def test_uploads_are_opened_as_data(studio, tmp_path):
    import meshio

    cube = meshio.Mesh(
        np.array([[x, y, z] for x in (0, 20.0) for y in (0, 20.0) for z in (0, 40.0)]),
        [
            (
                "quad",
                np.array(
                    [
                        [0, 1, 3, 2],
                        [4, 6, 7, 5],
                        [0, 4, 5, 1],
                        [2, 3, 7, 6],
                        [0, 2, 6, 4],
                        [1, 5, 7, 3],
                    ]
                ),
            )
        ],
    )
    cube.write(tmp_path / "cube.obj")
    np.save(tmp_path / "voxels.npy", np.ones((4, 3, 5), dtype=np.uint8))
    open_mesh = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n"

    async def scenario():
        async with studio.page() as page:
            for file, voxels in (("cube.obj", None), ("voxels.npy", 60)):
                assert upload(studio, file, (tmp_path / file).read_bytes()).status_code == 200
                await page.send("open", what="upload", name=file)
                document = await page.until("document", lambda d, f=file: f[:4] in d.name)
                assert document.valid, document.diagnostics
                body = await page.until("body", lambda b, d=document: b.rev == d.rev)
                assert voxels is None or body.voxels == voxels
                await page.send("play")
                await page.until("stat", lambda s: s.state in ("playing", "at-rest"))
                await page.send("pause")
            upload(studio, "soup.obj", open_mesh)
            await page.send("open", what="upload", name="soup.obj")
            assert "encloses nothing" in (await page.until("error")).what
            upload(studio, "broken.toml", b"\xff\xfe")
            await page.send("open", what="upload", name="broken.toml")
            assert "UTF-8" in (await page.until("error")).what
            upload(studio, "bad.npy", b"\x93NUMPY garbage")
            await page.send("open", what="upload", name="bad.npy")
            assert "no array of NumPy" in (await page.until("error")).what
            await page.send("open", what="upload", name="never.toml")
            assert "was not uploaded" in (await page.until("error")).what

    run(scenario())


def test_a_design_is_read_and_never_run(studio, tmp_path):
    trap = tmp_path / "trap"
    text = CYLINDER.replace('"= radius - wall"', f"\"= __import__('os').system('touch {trap}')\"")

    async def scenario():
        async with studio.page() as page:
            await page.send("text", rev=page.rev, text=text)
            assert not (await page.until("document", lambda d: d.diagnostics)).valid

    run(scenario())
    assert not trap.exists()


def test_unsaved_changes_are_there_after_a_restart(make_studio, tmp_path):
    file = tmp_path / "arm.toml"
    file.write_text(CYLINDER)
    first = make_studio(file)

    async def change():
        async with first.page() as page:
            await page.send(
                "edit", rev=page.rev, path=["parameters", "radius", "value"], value="20 mm"
            )
            await page.until("document", lambda d: d.dirty)

    run(change())
    first.stop()
    second = make_studio(file)

    async def look():
        async with second.page() as page:
            await page.until("log", lambda log: "not saved are back" in log.text)
            document = next(e for e in page.log if e["t"] == "document")
            assert '"20 mm"' in document["text"]
            assert document["can_undo"]
            await page.send("save")
            await page.until("saved")

    run(look())
    assert '"20 mm"' in file.read_text()
    assert not (tmp_path / "runs" / ".studio" / "draft.json").exists()


def test_a_body_that_takes_its_time_is_announced(studio, monkeypatch):
    monkeypatch.setattr("voxsoft.studio.bodies.mesher.SLOW", 0.0)

    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            await page.send("edit", rev=page.rev, path=["voxel_size"], value="1.25 mm")
            await page.until("stat", lambda s: s.state == "meshing")
            await page.shown(lambda s: s.state == "paused")

    run(scenario())


def test_a_panic_of_the_core_is_reported_and_the_next_body_comes(studio, monkeypatch):
    class Panic(BaseException):
        pass

    def panic(*_):
        raise Panic("index out of bounds")

    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda s: s.state == "paused")
            with monkeypatch.context() as broken:
                broken.setattr("voxsoft.studio.bodies.mesher.StudioBody.of", panic)
                await page.send("edit", rev=page.rev, path=["voxel_size"], value="2.5 mm")
                document = await page.until("document", lambda d: d.diagnostics)
            assert "index out of bounds" in document.diagnostics[0]["what"]
            await page.send("undo")
            await page.until("body", lambda b: b.voxels == 300)

    run(scenario())


def test_a_file_of_another_design_is_replaced_only_when_that_is_meant(fresh_studio, tmp_path):
    other = tmp_path / "other.toml"
    other.write_text("# mine\n")

    async def scenario():
        async with fresh_studio.page() as page:
            await page.send("open", what="template", name="sphere")
            document = await page.until("document", lambda d: d.name == "sphere.toml")
            assert (document.path, document.folder, document.dirty) == (None, str(tmp_path), False)
            await page.send("save", path="other.toml")
            assert (await page.until("file_exists")).path == str(other)
            assert other.read_text() == "# mine\n"
            await page.send("save", path="other.toml", overwrite=True)
            assert (await page.until("saved")).path == str(other)
            assert "sphere" in other.read_text()
            # Its own file is not asked about.
            await page.send("save", path="other.toml")
            assert (await page.until("saved")).path == str(other)

    run(scenario())
