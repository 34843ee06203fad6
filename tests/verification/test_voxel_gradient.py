"""Derivatives by the fractions of voxels against differences of whole solutions."""

import lattice_families as families
import numpy as np
import pytest

from voxsoft import Objective, _core, gradient, gradient_by_voxel, mesh_of, simulate
from voxsoft.design.variation import number_of
from voxsoft.errors import SimulationError
from voxsoft.simulation import Setup
from voxsoft.simulation.setup.materials import core_materials

# As in `test_gradient.py`: 1e-8 of the residual over the step, 1e-12 of truncation.
TOLERANCE = 1e-11
STEP = 1e-3
CLOSE = 1e-6

SOFT = '{model="neo-hookean", young="30 kPa", poisson=0.49}'
LATTICE = '{model="lattice", edge="12 kPa", bulk="30 kPa"}'


def solved(design):
    result = simulate(design, method="statics", tolerance=TOLERANCE)
    assert result.status == "ok"
    return result


def partly_filled(material):
    """A short beam with voxels that are all partly filled, so that none warps."""
    design = families.beam(length="30 mm").with_values(f"parts.0.material={material}")
    mesh = mesh_of(design)
    fractions = 0.5 + 0.4 * np.sin(np.arange(len(mesh.tets) // 5)) ** 2
    return design, mesh, fractions


@pytest.mark.parametrize("material", [SOFT, LATTICE])
def test_one_fraction_for_both_against_whole_solutions(material):
    design, mesh, fractions = partly_filled(material)

    def result_of(numbers):
        return solved(Setup(design, mesh.with_fractions(numbers)))

    targets = {
        "sag": design.objectives["sag"],
        "mass": Objective(minimize="mass"),
        "energy": Objective(minimize="elastic_energy"),
    }
    found = gradient_by_voxel(result_of(fractions), targets)
    # Some direction in which all fractions change.
    way = np.cos(np.arange(len(fractions)))
    seen = {}
    for multiple in (-2, -1, 1, 2):
        result = result_of(fractions + multiple * STEP * way)
        for name, target in targets.items():
            seen[name, multiple] = result.metric(
                target.metric, probe=target.probe, axis=target.axis
            )
    for name in targets:
        near, far = (seen[name, n] - seen[name, -n] for n in (1, 2))
        expected = (8 * near - far) / (12 * STEP)
        assert found[name].total @ way == pytest.approx(expected, rel=CLOSE)


def test_fractions_of_all_voxels_are_the_modulus_and_the_density():
    design = families.beam(length="30 mm").with_values(f"parts.0.material={SOFT}")
    result = solved(design)
    paths = ["parts.0.material.young", "parts.0.material.density"]
    young, density = gradient(result, "sag", paths)["sag"].values()
    slopes = gradient_by_voxel(result, "sag")["sag"]
    young, density = (
        slope * number_of(design, path) for slope, path in zip((young, density), paths, strict=True)
    )
    assert slopes.stiffness.sum() == pytest.approx(young, rel=1e-7)
    assert slopes.mass.sum() == pytest.approx(density, rel=1e-7)


@pytest.mark.parametrize(
    ("metric", "what"),
    [("reaction", "depends on the material"), ("volume", "does not change")],
)
def test_a_metric_of_the_material_is_refused(metric, what):
    design = families.beam(length="30 mm").with_values(f"parts.0.material={SOFT}")
    result = solved(design)
    with pytest.raises(SimulationError, match=what):
        gradient_by_voxel(result, metric)


def test_other_materials_keep_the_fractions_of_a_problem():
    design, mesh, fractions = partly_filled(SOFT)
    setup = Setup(design, mesh)
    ones = np.ones_like(fractions)
    filled = _core.with_fractions(setup.problem, ones, fractions)
    again = filled.with_materials(core_materials(design, setup.materials, mesh, setup.origin))
    masses = _core.block_masses(setup.problem)
    assert filled.mass == pytest.approx(masses @ fractions, rel=1e-12)
    assert again.mass == pytest.approx(filled.mass, rel=1e-12)
    with pytest.raises(ValueError, match="fractions of the stiffness"):
        _core.with_fractions(setup.problem, ones[1:], fractions)
