"""Draw the picture of the how-to on molds: ``python docs/make_picture.py``.

The cylinder of the paper's study is made, and its sheet becomes docs/images/make_sheet.png.
Chromium takes the picture.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Final

import numpy as np

import voxsoft as vs
from voxsoft.fabrication import make
from voxsoft.files.fabrication import write_fabrication

ROOT: Final = Path(__file__).parents[1]
IMAGE: Final = ROOT / "docs" / "images" / "make_sheet.png"
WIDTH, HEIGHT = 900, 2600


def main() -> None:
    """Make the molds, and take the picture."""
    from matplotlib.image import imread, imsave

    chromium = shutil.which("chromium")
    if chromium is None:
        raise SystemExit("chromium is not installed")
    made = make(vs.load(ROOT / "examples" / "cylinder.toml"))
    with tempfile.TemporaryDirectory() as folder:
        sheet = write_fabrication(made, folder) / "sheet.html"
        shot = Path(folder, "shot.png")
        options = ("--headless", "--no-sandbox", "--hide-scrollbars")
        size = f"--window-size={WIDTH},{HEIGHT}"
        command = [chromium, *options, size, f"--screenshot={shot}", sheet.as_uri()]
        subprocess.run(command, check=True, capture_output=True, timeout=120)
        picture = imread(shot)
    rows = np.flatnonzero((picture[..., :3] < 0.99).any(axis=(1, 2)))
    imsave(IMAGE, picture[: rows[-1] + 20])


if __name__ == "__main__":
    main()
