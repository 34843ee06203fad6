"""Files with bytes changed, lost or cut off are read or refused; no reader fails otherwise."""

import contextlib
from pathlib import Path

import numpy as np
import pytest

from voxsoft.errors import VoxSoftError
from voxsoft.shapes.surface_files import read_surface

FOLDER = Path(__file__).parents[2] / "data" / "files"
OWN = {".vtu", ".vtk", ".vtp", ".vti", ".vts", ".vtr", ".vtm", ".obj", ".stl", ".ply", ".glb"}
FILES = sorted(path for path in FOLDER.iterdir() if path.suffix in OWN)
TIMES = 6


def changed(content, random):
    """A copy that is cut short, lacks some bytes, or has other bytes or digits in places."""
    content = bytearray(content)
    way, place = random.integers(4), int(random.integers(1, len(content)))
    if way == 0:
        return content[:place]
    if way == 1:
        del content[place : place + int(random.integers(1, 20))]
        return content
    letters = bytes(range(256)) if way == 2 else b"0123456789 -\n"
    for at in random.integers(len(content), size=3):
        content[at] = letters[random.integers(len(letters))]
    return content


@pytest.mark.filterwarnings("error")
@pytest.mark.timeout(20)
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_a_changed_file_is_read_or_refused(tmp_path, path):
    random = np.random.default_rng(FILES.index(path))
    for _ in range(TIMES):
        file = tmp_path / path.name
        file.write_bytes(changed(path.read_bytes(), random))
        with contextlib.suppress(VoxSoftError):
            assert len(read_surface(file).triangles) > 0
