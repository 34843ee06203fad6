"""Make the figures of docs/paper.md, and with ``--cylinders`` its table of cylinders.

``python examples/paper_figures.py [--cylinders]`` writes to docs/images; a calibration and a study
are run for it, which takes a minute or two.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from matplotlib.figure import Figure

import voxsoft as vs
from voxsoft.design import families
from voxsoft.plot import (
    plot_body,
    plot_fitness,
    plot_scatter,
    plot_shape,
)
from voxsoft.units import kPa, mm

ROOT = Path(__file__).parents[1]
IMAGES = ROOT / "docs" / "images"
DATA = ROOT / "examples" / "data" / "paper_beams" / "ecoflex-00-30.csv"


def save(figure: Figure, name: str) -> None:
    """Save one figure for the documentation."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    figure.savefig(IMAGES / f"{name}.png", dpi=110)
    print(f"wrote docs/images/{name}.png")


def gyroid() -> None:
    """Fig. 2: a gyroid sheet as a conforming mesh."""
    cube = vs.Box(size=(40 * mm, 40 * mm, 40 * mm))
    sheet = cube & vs.Gyroid(period=20 * mm, thickness=3 * mm)
    save(plot_body(vs.voxelize(sheet, 0.5 * mm).mesh()), "gyroid")


def cylinder() -> None:
    """The best actuator of the study, cut open under pressure."""
    result = vs.simulate(families.paper_cylinder())
    save(plot_body(result, section="y", title="4 kPa, cut open"), "cylinder")


def calibration() -> None:
    """Figs. 3 and 4: the genetic algorithm at work, and the beam it ends with."""
    measured = vs.Experiment(families.paper_beam(), vs.Measurement.read(DATA))
    answer = vs.calibrate(measured, "genetic", free_scale=True, seed=1)
    save(plot_fitness(answer), "calibration_fitness")
    save(plot_shape(answer), "calibration_shape")


def study() -> None:
    """Fig. 6: three sizes and the rise as color."""
    with tempfile.TemporaryDirectory() as folder:
        save(plot_scatter(vs.Study(families.paper_cylinder(), folder=folder).grid()), "scatter")


def cylinders() -> None:
    """Rise of the cap's center for three walls and voxel sizes."""
    material = vs.Lattice(edge=25.1 * kPa, bulk=100 * kPa)
    print(f"E = {material.young() / 1e3:.1f} kPa, nu = {material.poisson():.2f}")
    for wall in (5, 10, 15):
        for voxel in (5.0, 2.5, 1.25):
            design = families.paper_cylinder(wall=wall * mm).replace(
                voxel_size=voxel * mm,
                parts=(vs.Part(shape="body", material=material),),
                probes={"center": vs.Probe(point=(0, 0, 35 * mm))},
                objectives={},
            )
            rise = vs.simulate(design).metric("displacement", axis="z")
            print(f"wall {wall:2} mm, voxels {voxel:4} mm: {rise / mm:6.2f} mm")


if __name__ == "__main__":
    if "--cylinders" in sys.argv:
        cylinders()
    else:
        gyroid()
        cylinder()
        study()
        calibration()
