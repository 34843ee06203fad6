"""Scoreboard of all predictions: share inside their intervals, and mean width of the intervals."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from voxsoft.errors import FileError
from voxsoft.scoreboard.prediction import Prediction

#: Columns of the CSV form, in which other programs enter their predictions.
COLUMNS: Final = ("case", "name", "kind", "measured", "predicted", "low", "high", "scale")


@dataclass(frozen=True)
class Scoreboard:
    """Predictions of measured robots.

    Attributes
    ----------
    predictions
        All predictions.
    failed
        Error that kept a case from being predicted, by its name.
    """

    predictions: tuple[Prediction, ...]
    failed: Mapping[str, str]

    @property
    def coverage(self) -> float:
        """Share of measurements inside their interval; NaN without any."""
        return float(np.mean([float(each.inside) for each in self.predictions] or [np.nan]))

    @property
    def width(self) -> float:
        """Mean width of an interval over the size of its number; NaN without any."""
        return float(np.mean([each.width for each in self.predictions] or [np.nan]))

    @property
    def cases(self) -> list[str]:
        """Names of the cases, in their order."""
        return list(dict.fromkeys(each.case for each in self.predictions))

    def of(self, case: str) -> Scoreboard:
        """Select the predictions of one case."""
        return Scoreboard(tuple(each for each in self.predictions if each.case == case), {})

    def summary(self) -> dict[str, Any]:
        """Plain data in SI units (the ``--json`` of ``verify``)."""
        return {
            "coverage": self.coverage,
            "width": self.width,
            "cases": [each.summary() for each in self.predictions],
            "failed": dict(self.failed),
        }

    def csv(self) -> str:
        """Write the CSV form that :func:`read_scores` reads, in SI units."""
        text = io.StringIO()
        rows = csv.writer(text, lineterminator="\n")
        rows.writerow(COLUMNS)
        for each in self.predictions:
            numbers = (each.measured, each.predicted, each.low, each.high)
            scale = "" if each.scale is None else f"{each.scale:.9g}"
            rows.writerow((each.case, each.name, each.kind, *(f"{n:.9g}" for n in numbers), scale))
        return text.getvalue()


def score(predictions: Iterable[Prediction]) -> Scoreboard:
    """Put predictions on a scoreboard.

    Examples
    --------
    >>> board = score([Prediction("beam", "sag", "length", 0.01, 0.0101, material=2e-4)])
    >>> board.coverage, round(board.width, 3)
    (1.0, 0.04)
    """
    return Scoreboard(tuple(predictions), {})


def read_scores(path: Path) -> Scoreboard:
    """Read the predictions of another program: a CSV file with the columns of :data:`COLUMNS`.

    Parameters
    ----------
    path
        Path of the file. The interval must lie around the prediction; ``scale`` may be empty or
        left out.

    Raises
    ------
    FileError
        It cannot be read, a column is missing, or a number is none, with its line.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(str(path), f"cannot be read: {error}", "name a CSV file") from None
    rows = csv.DictReader(lines)
    missing = [name for name in COLUMNS[:-1] if name not in (rows.fieldnames or ())]
    if missing:
        what = f"has no column {', '.join(missing)}"
        raise FileError(str(path), what, f"write the columns {', '.join(COLUMNS)}")
    found = []
    for number, row in enumerate(rows, start=2):
        try:
            measured, predicted, low, high = (
                float(row[name]) for name in ("measured", "predicted", "low", "high")
            )
            scale = float(row["scale"]) if row.get("scale") else None
            # Only the whole interval is known: it counts as one part.
            half = max(predicted - low, high - predicted)
            each = Prediction(
                *(row["case"], row["name"], row["kind"], measured, predicted),
                numerics=half,
                scale=scale,
            )
        except (TypeError, ValueError) as error:
            what = f"line {number}: {error}"
            raise FileError(str(path), what, "write numbers in SI units") from None
        if not low <= predicted <= high:
            what = f"line {number}: {predicted:g} is not between {low:g} and {high:g}"
            raise FileError(str(path), what, "give an interval around the prediction")
        found.append(each)
    return Scoreboard(tuple(found), {})
