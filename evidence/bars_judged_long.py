"""Width of error bars beside true errors, on bodies that were fixed before one was solved.

``python evidence/bars_judged.py --results FILE [--set second] [--kinds KIND ...] [--again]
[--table]``. Bodies are those of `evidence/bar_bodies.py`. Each is run with its error bar as
``voxsoft run`` does, and again on smaller voxels, the smallest below those of the bar; the truth is
the extrapolation of three sizes. A bar holds where the truth, give or take a quarter of the
extrapolated part, is within it. FILE holds a line for each body and question that is done, and a
run goes on from there; `--again` asks for the bars anew and keeps the truths, `--table` prints
alone.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import sys
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

import voxsoft as vs
from voxsoft.comparison import error_bars
from voxsoft.errors import VoxSoftError
from voxsoft.simulation import Setup

sys.path.insert(0, str(Path(__file__).parent))

from bar_bodies import EACH, KINDS, ROUND, SETS, TOUCHING, Case, case

#: Voxels that the finest size of a truth may have, in the part that symmetry leaves.
MOST: Final = 45_000
#: Sizes of a truth, as parts of the voxels of the run.
FACTORS: Final = (
    (2.0, 4.0, 6.0),
    (1.0, 2.0, 4.0),
    (1.0, 2.0, 3.0),
    (1.0, 1.5, 2.0),
)
#: Seconds after which a run is given up.
PATIENCE: Final = 600.0

Row = dict[str, Any]


class TooSlowError(Exception):
    """A run that takes longer than `PATIENCE`."""


def impatient() -> Callable[[int, float, float], None]:
    """A listener to progress that ends a run after a while."""
    started = time.monotonic()

    def report(*_: float) -> None:
        if time.monotonic() - started > PATIENCE:
            raise TooSlowError(f"not done after {PATIENCE:.0f} s")

    return report


def bar_of(each: Case) -> Row:
    """Run a body with its error bar."""
    started = time.monotonic()
    result = vs.simulate(each.design, progress=impatient())
    own = time.monotonic() - started
    row: Row = {"status": result.status, "seconds": own}
    if result.status != "ok":
        return row | {"missing": result.message}
    value = float(result.metrics["number"])
    bars = error_bars(result, progress=impatient())
    row |= {"value": value, "sizes": list(bars.voxel_sizes), "voxels": list(bars.voxels)}
    row |= {"regular": bars.regular, "doubt": bars.doubt, "missing": bars.missing}
    row["seconds_of_bars"] = time.monotonic() - started - own
    bar = bars.metrics.get("number")
    if bar is not None and not bar.unknown:
        row |= {"estimate": bar.estimate, "error": bar.error}
    elif bar is not None:
        row["missing"] = bar.unknown
    return row


def truth_of(each: Case) -> Row:
    """Solve a body on ever smaller voxels, and extrapolate."""
    started = time.monotonic()
    plain = each.quick or each.design
    part = Setup.of(plain).elements / 2 ** len(plain.symmetry)
    # Halved voxels keep their places; others are taken where these are too many.
    factors = next((few for few in FACTORS if part * few[-1] ** 3 <= MOST), FACTORS[-1])
    values: list[float] = []
    why, coarser = "", None
    for factor in factors:
        finer = plain.replace(voxel_size=plain.voxel_size / factor)
        twice = coarser if factor == 4.0 else None
        try:
            result = vs.simulate(finer, progress=impatient(), coarser=twice)
        except (VoxSoftError, TooSlowError) as error:
            why = str(error)
            break
        if result.status != "ok":
            why = result.message
            break
        coarser = result if factor == 2.0 else None
        values.append(float(result.metrics["number"]))
    sizes = [1.0 / factor for factor in factors[: len(values)]]
    row: Row = {"sizes": sizes, "values": values, "why": why}
    if len(values) > 2:
        row["truth"] = limit_of(sizes, values)
        row["unsure"] = 0.25 * abs(row["truth"] - values[-1])
    return row | {"seconds": time.monotonic() - started}


def limit_of(sizes: list[float], values: list[float]) -> float:
    """The limit of a number by the order between 1 and 2 that fits it best."""
    fits = []
    for order in np.linspace(1.0, 2.0, 101):
        terms = np.stack([np.ones(len(sizes)), np.power(sizes, order)], axis=1)
        found = np.linalg.lstsq(terms, np.array(values), rcond=None)[0]
        left = float(np.square(terms @ found - values).sum())
        fits.append((left, float(found[0])))
    return min(fits)[1]


QUESTIONS: Final[dict[str, Callable[[Case], Row]]] = {"bar": bar_of, "truth": truth_of}


def answered(file: Path, drawn: str) -> dict[tuple[str, int, str], Row]:
    """The lines of a set by kind, number and question; the last truth that was found counts."""
    lines = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
    known: dict[tuple[str, int, str], Row] = {}
    for row in map(json.loads, lines):
        if row["set"] != drawn:
            continue
        key = row["kind"], row["number"], row["question"]
        if "truth" in row or "truth" not in known.get(key, {}):
            known[key] = row
        elif row["question"] == "truth":
            known[key]["tried"] = True
    return known


def is_finer(truth: Row, bar: Row | None, each: Case) -> bool:
    """Whether a truth has smaller voxels than the bar, or there is nothing to compare."""
    if not bar or not bar.get("sizes") or not truth.get("sizes"):
        return True
    voxel_size = (each.quick or each.design).voxel_size
    return bool(truth["sizes"][-1] * voxel_size < 0.99 * bar["sizes"][-1])


def ask(file: Path, drawn: str, kinds: Iterable[str], *, again: bool) -> None:
    """Answer what is not answered yet, a line for each question."""
    for kind in kinds:
        for number in range(EACH):
            each = case(kind, number, drawn)
            for question, answer in QUESTIONS.items():
                known = answered(file, drawn).get((kind, number, question))
                bar = answered(file, drawn).get((kind, number, "bar"))
                if known is not None and (
                    not again
                    if question == "bar"
                    else known.get("tried") or is_finer(known, bar, each)
                ):
                    continue
                try:
                    row = answer(each)
                except (VoxSoftError, TooSlowError) as error:
                    row = {"missing": str(error), "why": str(error)}
                row |= {"set": drawn, "kind": kind, "number": number, "question": question}
                with file.open("a", encoding="utf-8", newline="\n") as lines:
                    lines.write(json.dumps(row) + "\n")
                print(json.dumps(row), flush=True)


# --- Table ----------------------------------------------------------------------------------------


class Judged(NamedTuple):
    """A bar beside the truth, as parts of the truth."""

    held: bool
    off: float
    width: float
    regular: bool
    #: Whether the truth has smaller voxels than the bar.
    apart: bool

    @property
    def ratio(self) -> float:
        """Width of the bar over the error of the run."""
        return self.width / max(self.off, 1e-12)


def judged(bar: Row | None, truth: Row | None, each: Case) -> Judged | str:
    """Hold a bar against the truth; a text where one of them is missing."""
    if bar is None or truth is None:
        return "not done"
    finer = is_finer(truth, bar, each)
    if not finer and not truth.get("tried"):
        return "not done"
    if "error" not in bar:
        return f"no bar: {bar.get('missing')}"
    if "truth" not in truth:
        return f"no truth: {truth.get('why')}"
    true = truth["truth"]
    held = abs(true - bar["estimate"]) <= bar["error"] + truth["unsure"]
    size = max(abs(true), 1e-300)
    off, width = abs(bar["value"] - true) / size, bar["error"] / size
    return Judged(held, off, width, bar["regular"], finer)


def show(file: Path, drawn: str) -> None:
    """Print how many bars hold, and their width, by kind."""
    known = answered(file, drawn)
    found = {
        (kind, number): judged(
            known.get((kind, number, "bar")),
            known.get((kind, number, "truth")),
            case(kind, number, drawn),
        )
        for kind in KINDS
        for number in range(EACH)
    }
    groups: dict[str, Callable[[str, Judged], bool]] = {
        kind: lambda own, _, kind=kind: own == kind  # type: ignore[misc]
        for kind in KINDS
    }
    groups |= {
        "round, thin": lambda kind, _: kind in ROUND,
        "in contact": lambda kind, _: kind in TOUCHING,
        "on the grid": lambda kind, _: kind not in (*ROUND, *TOUCHING),
        "regular": lambda _, each: each.regular,
        "wide": lambda _, each: not each.regular,
        "all": lambda *_: True,
        "truth as coarse": lambda _, each: not each.apart,
    }
    print(f"{'':16}{'held':>9}{'width/error':>13}{'error':>9}{'width':>9}  (medians; %)")
    for name, belongs in groups.items():
        rows = [each for (kind, _), each in found.items() if isinstance(each, Judged)
                and belongs(kind, each)]  # fmt: skip
        if not rows:
            continue
        ratio, off, width = (
            statistics.median(getattr(each, key) for each in rows)
            for key in ("ratio", "off", "width")
        )
        held = f"{sum(each.held for each in rows)} of {len(rows)}"
        print(f"{name:16}{held:>9}{ratio:>13.2g}{100 * off:>9.2g}{100 * width:>9.2g}")
    for (kind, number), each in found.items():
        if isinstance(each, str):
            if each != "not done":
                print(f"{kind} {number}: {each}")
        elif not each.held:
            print(
                f"{kind} {number}: MISSED, {100 * each.off:.2g} % off, "
                f"width {100 * each.width:.2g} %, regular {each.regular}"
            )
    left = sum(each == "not done" for each in found.values())
    seconds = math.fsum(row.get("seconds", 0.0) for row in known.values())
    print(f"{left} not done; {seconds:.0f} s")


def main() -> None:
    """Solve the bodies that are left, and print the table."""
    parser = argparse.ArgumentParser(description="Error bars beside true errors on 72 bodies")
    parser.add_argument("--results", type=Path, required=True, help="file of lines to go on with")
    parser.add_argument("--set", choices=list(SETS), default="first", help="set of 72 bodies")
    parser.add_argument("--kinds", nargs="*", choices=list(KINDS), help="only these kinds")
    parser.add_argument("--again", action="store_true", help="ask for the bars anew")
    parser.add_argument("--table", action="store_true", help="print the table alone")
    given = parser.parse_args()
    if not given.table:
        ask(given.results, given.set, given.kinds or KINDS, again=given.again)
    show(given.results, given.set)


if __name__ == "__main__":
    main()
