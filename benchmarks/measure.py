"""What every benchmark needs: the machine, medians, peak memory, text and JSON."""

from __future__ import annotations

import argparse
import json
import os
import platform
import resource
import statistics
import sys
import time
from collections.abc import Callable, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table


def machine() -> dict[str, Any]:
    """The machine and the versions a figure belongs to."""
    model = platform.processor() or platform.machine()
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="ascii", errors="replace").splitlines()
        model = next(line.split(":")[1].strip() for line in lines if "model name" in line)
    except (OSError, StopIteration):
        pass
    return {
        "processor": model,
        "cores": os.cpu_count(),
        "system": platform.platform(terse=True),
        "python": platform.python_version(),
        "voxsoft": version("voxsoft"),
    }


def median_seconds(
    task: Callable[[], object], repeats: int = 5, clock: Callable[[], float] = time.perf_counter
) -> float:
    """Median time of a task in seconds by the wall clock; run it once before to warm up.

    `time.process_time` as the clock gives processor time, which a busy machine does not inflate
    as much.
    """
    times = []
    for _ in range(repeats):
        start = clock()
        task()
        times.append(clock() - start)
    return statistics.median(times)


def peak_bytes() -> int:
    """The largest memory this process has held so far."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024


class Report:
    """Rows of a benchmark, printed as text or, with ``--json``, as one object.

    `flags` are further switches of the command line, each with its help, `values` those that take
    a whole number, each with its default and its help, and `texts` those that take a text;
    `options` has what was given.
    """

    def __init__(
        self,
        description: str,
        values: Mapping[str, tuple[int | None, str]] | None = None,
        texts: Mapping[str, str] | None = None,
        **flags: str,
    ) -> None:
        parser = argparse.ArgumentParser(description=description)
        parser.add_argument("--json", action="store_true", help="print one JSON object")
        parser.add_argument("--save", type=Path, help="write that object to a file beside the text")
        for flag, meaning in flags.items():
            parser.add_argument(f"--{flag}", action="store_true", help=meaning)
        for name, (default, meaning) in (values or {}).items():
            parser.add_argument(f"--{name}", type=int, default=default, help=meaning)
        for name, meaning in (texts or {}).items():
            parser.add_argument(f"--{name}", help=meaning)
        self.options = vars(parser.parse_args())
        self._json = self.options["json"]
        self._title = description
        self.rows: list[dict[str, Any]] = []

    def add(self, name: str, value: float, unit: str, ratio: float | None = None) -> None:
        """Add a figure; `ratio` compares it with what its name says."""
        self.rows.append({"name": name, "value": value, "unit": unit, "ratio": ratio})
        if not self._json:
            print(f"{name}: {value:.4g} {unit}", file=sys.stderr, flush=True)

    def show(self) -> None:
        """Print everything, and save it if asked to."""
        text = json.dumps({"machine": machine(), "rows": self.rows}, indent=2)
        if self.options["save"] is not None:
            self.options["save"].parent.mkdir(parents=True, exist_ok=True)
            self.options["save"].write_text(text + "\n", encoding="utf-8")
        if self._json:
            print(text)
            return
        table = Table(title=self._title, title_justify="left")
        table.add_column("figure")
        for column in ("value", "unit", "ratio"):
            table.add_column(column, justify="right")
        for row in self.rows:
            ratio = "" if row["ratio"] is None else f"{row['ratio']:.3g}"
            table.add_row(row["name"], f"{row['value']:.4g}", row["unit"], ratio)
        console = Console()
        console.print(table)
        console.print(", ".join(f"{key} {value}" for key, value in machine().items()))
