"""Exported computations in CalculiX beside `voxsoft compare` and our own answers with their error.

``python evidence/decks.py [--json] [--finer] [--only NAME]``. Each design is written in m and in um
by `write_computation`, and run by ``ccx NAME`` as it is. Rows, in mm: the probe there; the one of
CalculiX in a comparison; ours with the ends of its error bar. `--finer` splits voxels in two in
CalculiX, which takes an hour, and leaves out m and the comparison. Designs are templates of
`voxsoft new` and examples, without the entries that the files do not hold: `starfish` without
tendons, `cylinder` and `starfish` on full voxels.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

import contact_designs
from measure import Report

import voxsoft as vs
from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.deck import Deck
from voxsoft.design import Contact, Design, Object, Solver, families
from voxsoft.files import write_computation
from voxsoft.files.calculix import run_calculix
from voxsoft.units import kPa, mm

EXAMPLES = Path(__file__).parents[1] / "examples"
#: Seconds that a run of CalculiX may take.
TIME_LIMIT = 3600.0


def plate_on_block() -> Design:
    """A cube of 10 mm, pressed by 2 mm under a rough plate."""
    box = vs.Box(size=(10 * mm, 10 * mm, 10 * mm))
    plate = vs.Box(size=(30 * mm, 30 * mm, 4 * mm), center=(5 * mm, 5 * mm, 12 * mm))
    motion = vs.Motion(displacement=(0, 0, -2 * mm))
    return Design(
        name="plate-on-block",
        voxel_size=2.5 * mm,
        parts=[vs.Part(shape=box, material=vs.NeoHookean(young=60 * kPa, poisson=0.45))],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        objects=[Object(name="plate", shape=plate, motion=motion)],
        contact=Contact(friction=0.2),
        probes={"side": vs.Probe(point=(10 * mm, 5 * mm, 5 * mm))},
    )


def designs() -> Iterator[tuple[str, Design, str, str]]:
    """Every design with its name, and the probe and axis that are compared."""
    yield "beam", families.beam(), "station-9", "z"
    yield "cylinder", families.cylinder(), "top", "z"
    yield "pneunet, two materials", families.pneunet(), "tip", "z"
    yield "bender, a layer", vs.load(EXAMPLES / "bender.toml"), "tip", "z"
    yield "starfish", vs.load(EXAMPLES / "starfish.toml"), "tip", "z"
    yield "plate on a block, contact", plate_on_block(), "side", "x"
    blocks = contact_designs.two_blocks(2.0, 1.0).replace(solver=Solver())
    yield "two blocks, contact of walls", blocks, "lower", "z"


def printed(design: Design, unit: str, split: int) -> str:
    """Write a file, run CalculiX on it, and return its numbers."""
    with TemporaryDirectory() as folder:
        write_computation(Path(folder, "it.inp"), design, unit=unit, split=split)
        ended = subprocess.run(
            ["ccx", "it"],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=TIME_LIMIT,
            check=False,
        )
        if ended.returncode or "*ERROR" in ended.stdout:
            raise SystemExit(f"{design.name}: {ended.stdout[-1000:]}")
        return Path(folder, "it.dat").read_text(encoding="ascii")


def main() -> None:
    """Compare everything."""
    report = Report(
        "Exported computations in CalculiX",
        texts={"only": "names of designs begin with this"},
        finer="split each voxel in two",
    )
    split = 2 if report.options["finer"] else 1
    units = ("um",) if report.options["finer"] else ("m", "um")
    for name, design, probe, axis in designs():
        if not name.startswith(report.options["only"] or ""):
            continue
        column = "xyz".index(axis)
        decks = {unit: Deck.of(design, unit=unit, split=split) for unit in units}
        found = {
            unit: deck.displacements(printed(design, unit, split))[probe][column]
            for unit, deck in decks.items()
        }
        setup = decks["um"].setup
        rows = {f"file in {unit}": value for unit, value in found.items()}
        if not report.options["finer"]:
            answer = run_calculix(BrickModel.of(setup), time_limit=TIME_LIMIT)
            place = setup.places[probe]
            moved = place.weights @ answer.displacements[place.vertices]
            rows["compare"] = moved[column]
        digits = ", ".join(f"{title} {1e3 * float(each):.7g}" for title, each in rows.items())
        print(f"{name}, {probe} {axis} in mm: {digits}", file=sys.stderr, flush=True)
        result = vs.simulate(setup.design, method="statics", error="off")
        bar = vs.error_bars(result).probes[probe][column]
        inside = abs(found["um"] - bar.estimate) <= bar.error
        rows |= {
            "ours": bar.value,
            "error bar, lower end": bar.estimate - bar.error,
            "error bar, upper end": bar.estimate + bar.error,
        }
        for title, value in rows.items():
            report.add(f"{name}, {probe} {axis}: {title}", 1e3 * float(value), "mm")
        report.add(f"{name}, {probe} {axis}: within the bar", float(inside), "")
    report.show()


if __name__ == "__main__":
    sys.exit(main())
