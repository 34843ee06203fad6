"""Derivatives by parameters of the shape, through the filled parts of cut voxels."""

import lattice_families as families
import pytest

from voxsoft import Objective, gradient, simulate
from voxsoft.design.variation import number_of, with_number
from voxsoft.errors import DesignError

TARGETS = {
    "rise": Objective(maximize="displacement", probe="top", axis="z"),
    "mass": Objective(maximize="mass"),
    "volume": Objective(maximize="volume"),
    "cavity": Objective(maximize="cavity_volume"),
    "energy": Objective(maximize="elastic_energy"),
}
TOLERANCE = 1e-11
# Filled parts and the surface in a voxel are piecewise smooth, with kinks where the surface passes
# corners of the small cubes that they are sampled with: over a thousandth of a radius slopes
# change by 3 %. Solutions to 1e-11 leave 1e-6 of a difference over a ten-thousandth.
STEP = 1e-4
# Tolerance of the project for a shape; 1e-3 was the largest difference seen.
CLOSE = 1e-2


def cylinder():
    # A cap of one voxel would have its slope jump: there a layer of cut voxels begins.
    sizes = {"radius": "15.3 mm", "height": "20 mm", "wall": "5.6 mm", "cap": "5.3 mm"}
    rubber = '{model="neo-hookean", young="60 kPa", poisson=0.49}'
    return families.cylinder(**sizes).with_values(f"parts.0.material={rubber}", "fill=fraction")


def test_radius_wall_and_cap_of_a_cylinder():
    design = cylinder()
    names = ["radius", "wall", "cap"]
    found = gradient(simulate(design, method="statics", tolerance=TOLERANCE), TARGETS, names)
    for name in names:
        value = number_of(design, name)
        low, high = (
            simulate(
                with_number(design, name, value * (1 + sign * STEP)),
                method="statics",
                tolerance=TOLERANCE,
            )
            for sign in (-1, 1)
        )
        for key, target in TARGETS.items():
            before, after = (
                result.metric(target.metric, probe=target.probe, axis=target.axis)
                for result in (low, high)
            )
            expected = (after - before) / (2 * STEP * value)
            assert found[key][name] == pytest.approx(expected, rel=CLOSE), (key, name)


def test_a_voxel_size_has_no_derivative():
    result = simulate(cylinder().with_values("parameters.size=5 mm", "voxel_size== size"))
    with pytest.raises(DesignError, match="it changes the voxel size"):
        gradient(result, "mass", "size")
