"""The studio tells while the shown body is in itself, live and solved, and when it no longer is."""

from pathlib import Path

import numpy as np
import pytest
from own_loop import run

import voxsoft as vs
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.overlap_event import overlap_of

PUSHED = Path(__file__).parents[2] / "data" / "pushed.toml"


def test_a_solved_body_in_itself_is_reported_with_its_places(make_studio):
    studio = make_studio(PUSHED)

    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda stat: stat.state == "paused")
            await page.send("rest")
            found = await page.until("overlap", lambda reported: reported.places, seconds=60.0)
            equilibrium = await page.until("equilibrium")
            async with studio.page() as other:
                again = await other.until("overlap")
            await page.send("reset")
            free = await page.until("overlap", lambda reported: not reported.places)
        assert found.depth == pytest.approx(0.002, abs=3e-6)
        assert found.sentence == "bar and slab: overlap by 2 mm: contact is not simulated"
        assert found.places[0]["now"][2] == pytest.approx(0.008, abs=1e-5)
        assert found.places[0]["rest"][2] == pytest.approx(0.02, abs=1e-9)
        assert again.places == found.places
        assert (free.depth, free.sentence) == (0.0, "")
        warning = next(each for each in equilibrium.warnings if "overlap" in each["what"])
        assert warning["at"] == found.places[0]["rest"]

    run(scenario())


def test_a_body_that_moves_is_looked_over_as_it_does(make_studio, tmp_path):
    rubber = 'rubber = { model = "neo-hookean", young = "1 MPa", poisson = 0.4 }'
    text = PUSHED.read_text()
    assert rubber in text
    springs = 'rubber = { model = "lattice", edge = "1 MPa", bulk = "1 MPa" }'
    file = tmp_path / "springs.toml"
    file.write_text(text.replace(rubber, springs))
    studio = make_studio(file)

    async def scenario():
        async with studio.page() as page:
            await page.until("body")
            await page.send("play")
            await page.until("overlap", lambda reported: reported.places, seconds=60.0)
            states = [each["state"] for each in page.log if each["t"] == "stat"]
        assert "playing" in states
        assert not any("overlap" in each for each in page.log if each["t"] == "error")

    run(scenario())


def test_other_places_are_counted_in_whole_words():
    # Two bars, far from each other, are moved into the slab below them.
    bars = [
        vs.Part(
            shape=vs.Box(size=("10 mm", "10 mm", "10 mm"), corner=(x, 0, "20 mm")),
            material="ecoflex-00-30",
        )
        for x in (0, "40 mm", "80 mm")
    ]
    slab = vs.Part(
        shape=vs.Box(size=("90 mm", "10 mm", "10 mm"), corner=(0, 0, 0)), material="ecoflex-00-30"
    )
    for count, words in [(2, " and at 1 more place:"), (3, " and at 2 more places:")]:
        design = vs.Design(name="bars", voxel_size="5 mm", parts=(slab, *bars[:count]))
        mesh = StudioBody.of(design, rev=1, topology=1).mesh
        positions = np.array(mesh.vertices)
        positions[positions[:, 2] > 0.015, 2] -= 0.012
        assert words in overlap_of(design, mesh, positions, 1).sentence
