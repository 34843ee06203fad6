"""Molds of ten bodies: way, parts, volumes, deviation, air, and the time they take.

``python benchmarks/make.py [--json] [--folder FOLDER]``. Examples and templates are made
at samples of 0.5 mm; times are processor times of `make`, without imports. Volumes of molds are
relative to those of the design; problems are the number of proofs that fail. With ``--folder`` the
molds are written there, with their sheets.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

from measure import Report

import voxsoft as vs
from voxsoft.fabrication import make
from voxsoft.files.fabrication import write_fabrication

ROOT = Path(__file__).parents[1]
TRUNK = ROOT / "python/voxsoft/design/robots/tendon_trunk.toml"
EXAMPLES = (
    *("cylinder", "beam", "bender", "pneunet", "bellows", "finger", "starfish"),
    *("gripper_finger", "wound_tube"),
)


def main() -> None:
    """Make each body, and report."""
    report = Report("Molds of ten bodies", texts={"folder": "write the molds there"})
    folder = report.options["folder"]
    for path in [*(ROOT / "examples" / f"{name}.toml" for name in EXAMPLES), TRUNK]:
        design = vs.load(path)
        start = time.process_time()
        made = make(design)
        seconds = time.process_time() - start
        name = path.stem
        report.add(f"{name} ({made.way}): parts to print", len(made.surfaces()), "")
        if made.described > 0.0:
            report.add(f"{name}: volume", made.described * 1e6, "mL")
            report.add(f"{name}: of the molds", made.poured / made.described, "of it")
            report.add(f"{name}: largest deviation", made.deviation * 1e3, "mm")
            report.add(f"{name}: trapped air", made.trapped_air * 1e9, "mm³")
        report.add(f"{name}: problems", len(made.problems), "")
        report.add(f"{name}: processor time", seconds, "s")
        for problem in made.problems:
            print(f"{name}: {problem}", file=sys.stderr)
        if folder is not None and not made.problems:
            write_fabrication(made, Path(folder) / name)
    report.show()


if __name__ == "__main__":
    main()
