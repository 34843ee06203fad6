"""The state on the screen is kept, solved on and carried over, with loads and pulls."""

import json
import threading
from pathlib import Path
from types import SimpleNamespace

import httpx
import numpy as np
import pytest
from own_loop import run

import voxsoft as vs
from voxsoft.files.meshes import read_mesh_file

EXAMPLE = Path(__file__).parents[3] / "examples" / "cylinder.toml"
CYLINDER = EXAMPLE.read_text()
LIVE = 2e3  # Pa: the cylinder is written with 4 kPa
TOO_MUCH = 8e3  # it never comes to rest under so much


def positions_of(frame):
    """Positions of the points of a frame in m, (n, 3)."""
    origin = np.frombuffer(frame.bytes, "<f4", 3, 32).astype(float)
    scale = np.frombuffer(frame.bytes, "<f4", 3, 44).astype(float)
    steps = np.frombuffer(frame.bytes, "<u2", 4 * frame.n, 64).reshape(-1, 4)[:, :3]
    return origin + scale * steps / 65535


async def ready(page):
    stat, _ = await page.shown(lambda s: s.state in ("paused", "at-rest"))
    return stat


async def solved(page):
    """Solve for the equilibrium; gives its event, and its frame."""
    await page.send("rest")
    _, frame = await page.shown(lambda s: s.state == "at-rest")
    reported = [event for event in page.log if event["t"] == "equilibrium"]
    return SimpleNamespace(**reported[-1]) if reported else await page.until("equilibrium"), frame


async def kept(page):
    await page.send("keep")
    saved = await page.until("saved", lambda event: event.what == "run")
    return saved.path


def read(folder):
    """The design, the summary and the positions of a run folder."""
    folder = Path(folder)
    content = read_mesh_file(folder / "result.vtu")
    moved = np.asarray(content.point_data["displacement"])
    summary = json.loads((folder / "summary.json").read_text())
    return vs.load(folder / "design.toml"), summary, content.mesh.vertices + moved


def test_a_run_that_is_kept_is_the_state_on_the_screen(studio):
    async def scenario():
        async with studio.page() as page:
            await ready(page)
            await page.send("load", index=0, value=LIVE)
            equilibrium, frame = await solved(page)
            return equilibrium, positions_of(frame), await kept(page)

    equilibrium, shown, folder = run(scenario())
    design, summary, positions = read(folder)
    assert design.loads[0].value == pytest.approx(LIVE)
    assert summary["status"] == "ok"
    body = studio.session.engine._stage.playback.body
    # A frame holds sixteen bits of each coordinate.
    bits = np.ptp(shown, axis=0).max() / 6e4
    assert np.abs(positions[body.surface.vertices] - shown).max() < bits
    again = vs.simulate(design)
    reported = {metric["name"]: metric["value"] for metric in equilibrium.metrics}
    for name, value in reported.items():
        assert value == pytest.approx(again.metrics[name], rel=1e-3)
        assert summary["metrics"][name] == pytest.approx(value, rel=1e-6)
    as_written = vs.simulate(vs.load(EXAMPLE))
    assert again.metrics["max_displacement"] < 0.7 * as_written.metrics["max_displacement"]


def test_a_run_kept_under_a_pull_says_so_and_is_not_at_rest(studio):
    async def scenario():
        async with studio.page() as page:
            await ready(page)
            await page.send("grab", id=7, vertex=3, target=[0.0, 0.0, 0.2], stiffness=20.0)
            await page.send("step", n=5)
            stat, frame = await page.shown(lambda s: s.state == "paused" and s.time > 0)
            return stat, positions_of(frame), await kept(page)

    stat, shown, folder = run(scenario())
    _, summary, positions = read(folder)
    body = studio.session.engine._stage.playback.body
    bits = np.ptp(shown, axis=0).max() / 6e4
    assert np.abs(positions[body.surface.vertices] - shown).max() < bits
    assert summary["status"] == "not-at-rest"
    assert summary["time"] == stat.time
    assert [pull["id"] for pull in summary["pulls"]] == [7]
    assert summary["pulls"][0]["force"] == pytest.approx(stat.grabs[0]["force"])


def test_another_material_leaves_loads_and_pulls_as_they_are(studio):
    async def scenario():
        async with studio.page() as page:
            await ready(page)
            await page.send("load", index=0, value=LIVE)
            await page.send("grab", id=2, vertex=3, target=[0.0, 0.0, 0.1], stiffness=20.0)
            pulled = (await page.until("stat", lambda s: s.grabs)).grabs[0]
            before = page.topology.topology
            other = CYLINDER.replace("ecoflex-00-30-lattice", "ecoflex-00-50-lattice")
            assert other != CYLINDER
            await page.send("text", rev=page.rev, text=other)
            stat = await page.until("stat", lambda s: s.topology > before and s.state == "paused")
            assert stat.loads[0] == pytest.approx(LIVE)
            assert [(g["id"], g["vertex"], g["target"]) for g in stat.grabs] == [
                (2, pulled["vertex"], pulled["target"])
            ]
            # A load that is written anew has the written value.
            before = stat.topology
            await page.send("edit", rev=page.rev, path=["loads", 0, "value"], value="3 kPa")
            stat = await page.until("stat", lambda s: s.topology > before and s.state == "paused")
            assert stat.loads[0] == pytest.approx(3e3)
            before = stat.topology
            await page.send("open", what="template", name="cylinder")
            stat = await page.until("stat", lambda s: s.topology > before and s.state == "paused")
            assert stat.loads[0] == pytest.approx(6e3)
            assert stat.grabs == []

    run(scenario())


def test_an_equilibrium_is_reported_in_numbers_and_as_a_table(studio):
    async def scenario():
        async with studio.page() as page:
            await ready(page)
            equilibrium, _ = await solved(page)
            return equilibrium

    equilibrium = run(scenario())
    found = vs.simulate(vs.load(EXAMPLE))
    probe = equilibrium.probes[0]
    assert probe["displacement"] == pytest.approx(found.probes[probe["name"]], abs=1e-5)
    chamber = equilibrium.chambers[0]
    assert chamber["pressure"] == pytest.approx(4e3)
    assert chamber["volume"] == pytest.approx(found.cavity_volumes[0], rel=1e-3)
    assert chamber["volume"] > chamber["rest_volume"]
    assert equilibrium.largest_strain == pytest.approx(found.metrics["max_stretch"] - 1, rel=1e-2)
    assert equilibrium.residual.endswith("%")
    answer = httpx.post(
        f"{studio.origin}/export?token={studio.token}",
        json={"format": "csv"},
        headers={"origin": studio.origin},
    )
    assert answer.status_code == 200, answer.text
    table = httpx.get(f"{studio.origin}{answer.json()['url']}?token={studio.token}").text
    assert len(table.splitlines()) == 2


def test_play_goes_on_from_the_equilibrium(studio):
    async def scenario():
        async with studio.page() as page:
            await ready(page)
            _, frame = await solved(page)
            rest = studio.session.engine._stage.playback.body
            unloaded = rest.mesh.vertices[rest.surface.vertices]
            moved = np.abs(positions_of(frame) - unloaded).max()
            page.frames.clear()
            await page.send("play")
            await page.shown(lambda s: s.state in ("playing", "at-rest") and s.time > 0)
            least = min(np.abs(positions_of(each) - unloaded).max() for each in page.frames)
            # It is at rest already: the two solvers agree within their tolerances.
            assert least > 0.98 * moved

    run(scenario())


def test_a_search_for_equilibrium_can_be_canceled(studio):
    async def scenario():
        async with studio.page() as page:
            await ready(page)
            await page.send("load", index=0, value=TOO_MUCH)
            await page.send("rest")
            await page.until("stat", lambda s: s.state == "solving" and "residual" in s.sentence)
            await page.send("pause")
            stat = await page.until("stat", lambda s: s.state != "solving")
            assert stat.state == "paused"
            assert "Canceled" in stat.sentence
            assert stat.progress is None

    run(scenario())
    # The work ends too, at the next word it would have said.
    for thread in threading.enumerate():
        if thread.name == "studio-rest":
            thread.join(60)
            assert not thread.is_alive()
