"""A design whose body is the mesh of a file, on the page."""

import numpy as np
from own_loop import run

from voxsoft.files import write_mesh
from voxsoft.voxels import Voxels


def test_a_mesh_of_a_file_is_opened_drawn_played_and_solved(make_studio, tmp_path):
    mesh = Voxels.from_array(np.ones((6, 2, 2), np.uint8), 5.0).mesh()
    fixed = np.flatnonzero(mesh.vertices[:, 0] == 0)
    write_mesh(tmp_path / "bar.msh", mesh, regions={"FIX": fixed})
    file = tmp_path / "bar.toml"
    file.write_text(
        """
        name = "bar"
        mesh = { path = "bar.msh", unit = "mm" }
        clamps = [{ region = { name = "FIX" } }]
        parts = [{ shape = "part-1", material = "ecoflex-00-30-lattice" }]
        loads = [{ kind = "gravity" }]
        probes = { tip = { x = ["30 mm", "30 mm"] } }
        """
    )
    studio = make_studio(file)

    async def scenario():
        async with studio.page() as page:
            body = await page.until("body")
            assert (body.voxels, body.tets) == (0, len(mesh.tets))
            await page.send("play")
            played, _ = await page.shown(lambda s: s.state == "at-rest")
            await page.send("rest")
            solved, frame = await page.shown(lambda s: s.state == "at-rest")
            assert frame.topology == body.topology
        assert "At rest after" in played.sentence
        assert solved.sentence

    run(scenario())
