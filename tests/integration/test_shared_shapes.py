"""Meshes of real soft robots, closed and broken, at three voxel sizes each.

The files are not part of this repository: VOXSOFT_SHARED names the folder that holds data/shapes
(default: ../shared beside the repository). Without it these tests are skipped.
"""

import csv
import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from voxsoft import check
from voxsoft.errors import ShapeError
from voxsoft.shapes import TriangleMesh, voxelize

SHARED = Path(os.environ.get("VOXSOFT_SHARED", Path(__file__).parents[2].parent / "shared"))
FOLDER = SHARED / "data" / "shapes"
CELLS_ALONG = (12, 20, 32)
SOUP = "18_soup.stl"


@dataclass(frozen=True)
class Specimen:
    """One row of the manifest, in SI units; the volume is None where overlaps or holes spoil it."""

    file: str
    unit: str
    longest: float
    volume: float | None
    area: float

    @property
    def shape(self):
        return TriangleMesh(path=str(FOLDER / self.file), unit=self.unit)


def read_manifest():
    manifest = FOLDER / "manifest.csv"
    if not manifest.exists():
        return []
    with manifest.open(newline="", encoding="utf-8") as lines:
        return [specimen_of(row) for row in csv.DictReader(lines)]


def specimen_of(row):
    unit = row["unit_guess"].rstrip("?").replace("unitless", "mm")
    meter = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 0.0254}[unit]
    volume = row["tet_volume"] or row["signed_volume"]
    plain = row["watertight"] == "1" and int(row["self_intersecting_faces"]) == 0
    return Specimen(
        file=row["file"],
        unit=unit,
        longest=meter * max(float(row[f"bbox_{axis}"]) for axis in "xyz"),
        volume=abs(float(volume)) * meter**3 if plain and volume else None,
        area=float(row["surface_area"]) * meter**2,
    )


SPECIMENS = read_manifest()
SOLIDS = [specimen for specimen in SPECIMENS if specimen.file != SOUP]
needs_data = pytest.mark.skipif(not SPECIMENS, reason=f"no meshes at {FOLDER} (VOXSOFT_SHARED)")


@cache
def voxels_of(specimen, cells):
    return voxelize(specimen.shape, specimen.longest / cells)


@pytest.mark.long
@needs_data
@pytest.mark.parametrize(
    "cells", [pytest.param(n, marks=[pytest.mark.slow] * (n != 20)) for n in CELLS_ALONG]
)
@pytest.mark.parametrize("specimen", SOLIDS, ids=lambda each: each.file)
def test_a_real_mesh_becomes_a_sound_body(specimen, cells):
    try:
        voxels = voxels_of(specimen, cells)
    except ShapeError as error:
        # A wall thinner than a voxel may lie between all centers, and the message says so.
        assert "no cell of" in str(error)  # noqa: PT017
        assert "smaller voxel_size" in str(error)  # noqa: PT017
        assert cells < CELLS_ALONG[-1]
        return
    mesh, report = voxels.mesh(), check(voxels)
    assert report.valid, report.findings
    assert report.voxels == voxels.count
    assert mesh.quality.conforming
    assert mesh.quality.smallest_tet > 0
    assert mesh.quality.watertight
    assert np.isclose(mesh.quality.volume, voxels.volume, rtol=1e-12)
    assert np.isclose(mesh.surface_volume, voxels.volume, rtol=1e-9)
    # A cell's center lies inside the file's box, so its far side is half a cell outside at most.
    reach = (0.5 + 1e-6) * voxels.voxel_size
    low, high = specimen.shape.bounds()
    assert (voxels.bounds[0] >= np.array(low) - reach).all()
    assert (voxels.bounds[1] <= np.array(high) + reach).all()


@pytest.mark.long
@needs_data
@pytest.mark.parametrize(
    "specimen", [each for each in SOLIDS if each.volume], ids=lambda each: each.file
)
def test_the_voxels_have_the_volume_of_the_mesh(specimen):
    voxels = voxels_of(specimen, CELLS_ALONG[-1])
    # Centers decide: only cells that the surface cuts are wrong, each by half a cell at most, and
    # both ways. A quarter of a cell all over the surface is the bound; errors mostly cancel.
    assert abs(voxels.volume - specimen.volume) < 0.25 * specimen.area * voxels.voxel_size


@needs_data
@pytest.mark.parametrize("cells", CELLS_ALONG)
def test_a_soup_of_triangles_is_a_clear_problem(cells):
    (soup,) = (each for each in SPECIMENS if each.file == SOUP)
    with pytest.raises(ShapeError, match=r"encloses nothing: 300 of 300 edges .* Try: export a"):
        voxelize(soup.shape, soup.longest / cells)


@pytest.mark.slow
@needs_data
def test_the_chamber_of_a_pneunet_file_is_found():
    (body,) = (each for each in SPECIMENS if each.file == "01_pneunetCut.stl")
    # The walls of the chamber lie on multiples of 0.5 mm: cells of that size hold it exactly.
    voxels = voxelize(body.shape, 0.5e-3)
    (chamber,) = voxels.cavities
    assert chamber.volume == pytest.approx(8887.5e-9, rel=1e-9)
