"""Natural vibrations over the websocket: of an equilibrium, about it, until a load changes."""

import numpy as np
import pytest
from own_loop import run

import voxsoft as vs
from voxsoft.studio.motion.vibration import REACH

BEAM = """
schema = "voxsoft/1"
name = "beam"
voxel_size = "5 mm"
[[parts]]
shape = { kind = "box", size = ["40 mm", "5 mm", "10 mm"] }
material = "ecoflex-00-30"
[[clamps]]
region = { x = [0, 0] }
[[loads]]
kind = "gravity"
"""

BALL = """
[[objects]]
name = "ball"
shape = { kind = "sphere", radius = "5 mm", center = [0, 0, "-1 m"] }
"""
#: Straight under three times the load at which it buckles: nothing pushes it to a side.
BUCKLED = BEAM.replace(
    'kind = "gravity"',
    'kind = "force"\nregion = { x = ["40 mm", "40 mm"] }\nvalue = ["-30 mN", 0, 0]',
)


def positions_of(frame):
    """Positions of the points of a frame in m, (n, 3)."""
    origin = np.frombuffer(frame.bytes, "<f4", 3, 32).astype(float)
    scale = np.frombuffer(frame.bytes, "<f4", 3, 44).astype(float)
    steps = np.frombuffer(frame.bytes, "<u2", 4 * frame.n, 64).reshape(-1, 4)[:, :3]
    return origin + scale * steps / 65535


async def opened(page, file):
    """Open a design, and wait until its body is shown."""
    rev = page.rev
    await page.send("open", what="file", name=str(file))
    await page.until("document", lambda d: d.rev > rev)
    body = await page.until("body", lambda b: b.rev == page.rev)
    await page.shown(lambda s: s.state == "paused" and s.topology == body.topology)


def swings_both_ways(ways):
    """Check if the drawn swing has been as far on one side as on the other, nearly."""
    if not ways:
        return False
    farthest = max(ways, key=np.linalg.norm).ravel()
    along = [way.ravel() @ farthest for way in ways]
    return min(along) < -0.9 * max(along) and len(ways) > 60


def test_modes_are_drawn_about_the_equilibrium_until_another_action(fresh_studio, tmp_path):
    file = tmp_path / "beam.toml"
    file.write_text(BEAM)

    async def scenario():
        async with fresh_studio.page() as page:
            await opened(page, file)
            await page.send("vibrate", mode=0)
            refused = await page.until("error")
            assert refused.hint == "press Solve first"
            await page.send("rest")
            _, frame = await page.shown(lambda s: s.state == "at-rest")
            still = positions_of(frame)
            await page.send("vibrate", mode=1)
            found = await page.until("vibration", lambda v: v.frequencies)
            await page.send("vibrate", mode=99)
            assert "none of 6" in (await page.until("error")).what
            # The drawn swing reaches to both sides.
            ways = []
            while not swings_both_ways(ways):
                ways.append(positions_of(await page.until("frame")) - still)
            await page.send("load", index=0, value=5.0)
            ended = await page.until("vibration")
            assert ended.mode is None
            return found, ways

    found, ways = run(scenario())
    exact = vs.modes(vs.simulate(vs.load(file)))
    # The studio's equilibrium is the same to the tolerance of its solver.
    assert found.frequencies == pytest.approx(exact.frequencies.tolist(), rel=1e-4)
    assert found.mode == 1
    assert found.amplitude == pytest.approx(REACH * 0.04, rel=0.1)
    farthest = max(np.linalg.norm(way, axis=1).max() for way in ways)
    assert 0.9 * found.amplitude < farthest <= found.amplitude * (1.0 + 1e-3)


def test_a_buckled_body_says_why_it_has_no_modes(fresh_studio, tmp_path):
    files = tmp_path / "lying.toml", tmp_path / "buckled.toml"
    files[0].write_text(BEAM + BALL)
    files[1].write_text(BUCKLED)

    async def scenario():
        found = []
        async with fresh_studio.page() as page:
            for file in files:
                await opened(page, file)
                await page.send("rest")
                await page.shown(lambda s: s.state == "at-rest")
                await page.send("vibrate", mode=0)
                found.append(await page.until("vibration", lambda v: v.trouble or v.frequencies))
        return found

    swings, trouble = run(scenario())
    assert not swings.trouble
    assert swings.frequencies[0] > 0.0
    assert trouble.trouble == "modes: the body moves freely, or its equilibrium is not stable"
    assert "lower the load" in trouble.hint
    assert trouble.frequencies == []
