"""Predict six beams with one calibrated card, and compare with finite elements.

The card ``ecoflex-00-30-lattice`` was fitted to one beam, 100 mm long with a section of 10 mm by
10 mm.
The paper then asks what it says about beams of twice the width, twice the height and half the
length. The reference here is a finite-element solution of a neo-Hookean material of 60 kPa; a beam
theory reads 61 kPa from the measured beam that the card was fitted to: both describe one silicone.

Run it with ``python examples/predict_beams.py``.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft.calibration import Deviation, Experiment, Measurement
from voxsoft.design import Design, families
from voxsoft.materials import load_card
from voxsoft.simulation import simulate
from voxsoft.units import mm

REFERENCE = Path(__file__).parents[1] / "tests" / "data" / "beams_gravity_E60.csv"
CLAMPED = 10 * mm


class Prediction(NamedTuple):
    """One beam: its size in mm, and what is simulated and expected at its stations."""

    beam: str
    size: tuple[float, float, float]
    comparison: Deviation

    @property
    def tip(self) -> tuple[float, float]:
        """Sag of the tip in mm, simulated and expected."""
        simulated, expected = self.comparison.simulated[-1, 1], self.comparison.measured[-1, 1]
        return -1e3 * float(simulated), -1e3 * float(expected)


def references() -> dict[str, list[dict[str, str]]]:
    """Read the finite-element solutions: rows of stations for each beam."""
    lines = [line for line in REFERENCE.read_text().splitlines() if not line.startswith("#")]
    beams: dict[str, list[dict[str, str]]] = {}
    for row in csv.DictReader(lines):
        beams.setdefault(row["beam"], []).append(row)
    return beams


def predictions(
    card: str = "ecoflex-00-30-lattice", voxel_size: str = "5 mm"
) -> Iterator[Prediction]:
    """Simulate each beam of the reference with a card."""
    for beam, rows in references().items():
        size = tuple(float(rows[0][f"{side}_mm"]) for side in ("length", "width", "height"))
        free = [row for row in rows if float(row["station_mm_from_clamped_end"]) > 10.0]
        measurement = Measurement(
            quantities=["dx", "dz"],
            values=_column(free, "ux_mm", "uz_mm"),
            arcs=_column(free, "station_mm_from_clamped_end")[:, 0] - CLAMPED,
            name=f"beam {beam}",
            source="finite elements, E = 60 kPa",
        )
        experiment = Experiment(_beam(size, card, voxel_size), measurement, line="centerline")
        result = simulate(experiment.setup)
        seen = experiment.seen_at(result.positions)
        yield Prediction(beam, size, Deviation(seen, measurement.values, 1.0, result.positions))


def _column(rows: list[dict[str, str]], *names: str) -> NDArray[np.float64]:
    return np.array([[float(row[name]) * mm for name in names] for row in rows])


def _beam(size: tuple[float, ...], card: str, voxel_size: str) -> Design:
    length, width, height = (f"{side:g} mm" for side in size)
    beam = families.paper_beam().with_parameters(length=length, width=width, height=height)
    return beam.with_values(f"voxel_size={voxel_size}", f"parts.0.material={card}")


def main() -> None:
    """Print a line for each beam."""
    print(load_card("ecoflex-00-30-lattice").material)
    print("beam  size (mm)      tip sag (mm)          difference   mean error of the shape")
    for prediction in predictions():
        size = " x ".join(f"{side:g}" for side in prediction.size)
        simulated, expected = prediction.tip
        error = prediction.comparison.errors.mean() * 1e3
        print(
            f"{prediction.beam:4}  {size:13}  {simulated:6.2f} (FE {expected:6.2f})  "
            f"{100 * (simulated / expected - 1):+7.1f} %   {error:6.2f} mm "
            f"({100 * error / expected:.1f} % of the tip)"
        )


if __name__ == "__main__":
    main()
