"""Calibration along exact slopes, and of hyperelastic materials."""

import json

import lattice_families as families
import numpy as np
import pytest

from voxsoft.calibration import Experiment, Measurement, calibrate
from voxsoft.calibration.misfit import Misfit
from voxsoft.calibration.space import Space
from voxsoft.errors import MaterialError, VoxSoftError
from voxsoft.files.calibrations import write_calibration
from voxsoft.files.cards import load_card_file
from voxsoft.materials import MooneyRivlin, NeoHookean, Ogden, constants_of, with_constants
from voxsoft.simulation import simulate

RUBBER = '{model="neo-hookean", young="30 kPa", poisson=0.49}'
OGDEN = '{model="ogden", mu=["9 kPa", "1 kPa"], alpha=[1.7, 5.0], poisson=0.49}'
LATTICE = '{model="lattice", edge="12 kPa", bulk="30 kPa"}'
ARCS = (10e-3, 20e-3, 30e-3)


def observed(material, scale=1.0):
    """Measurement of a beam of 40 mm, without noise."""
    design = families.beam(length="40 mm").with_values(f"parts.0.material={material}")
    quantities = ("x", "dz")
    blank = [[arc, 0.0] for arc in ARCS]
    probe = Experiment(design, Measurement(quantities=quantities, values=blank, arcs=ARCS))
    seen = probe.seen_at(simulate(probe.setup, method="statics", tolerance=1e-8).positions)
    return Experiment(
        design,
        Measurement(quantities=quantities, values=scale * seen, arcs=ARCS, name="synthetic"),
    )


@pytest.mark.parametrize(
    ("material", "ranges"),
    [
        (OGDEN, {"young": ("10 kPa", "90 kPa"), "alpha.1": (2, 9)}),
        (LATTICE, {"edge": ("5 kPa", "50 kPa"), "bulk": ("5 kPa", "200 kPa")}),
    ],
)
def test_slopes_are_those_of_whole_solutions(material, ranges):
    experiment = observed(material)
    space = Space.of(ranges, experiment.material)
    misfit = Misfit([experiment], space, statics=True, tolerance=1e-11)
    genes = np.array([0.4, 0.6])
    slopes = misfit.linearized(genes).slopes[0]
    for index, span in enumerate(space.spans()):
        step = np.eye(2)[index] * 1e-2 / span
        away = {m: misfit.compare(genes + m * step)[0].simulated for m in (-2, -1, 1, 2)}
        expected = (8 * (away[1] - away[-1]) - (away[2] - away[-2])) / (12 * 1e-2)
        # Differences of fourth order over 1 %: 1e-8 of truncation; residuals of 1e-11 over 1e-2.
        largest = np.abs(expected).max()
        np.testing.assert_allclose(slopes[:, :, index], expected, rtol=1e-5, atol=1e-6 * largest)


@pytest.mark.parametrize(
    ("material", "name", "truth", "scale"),
    [(RUBBER, "young", 30e3, 1.0), (RUBBER, "young", 30e3, 1.1), (LATTICE, "edge", 12e3, 1.0)],
)
def test_a_modulus_comes_back_in_a_dozen_evaluations(material, name, truth, scale):
    found = calibrate(
        observed(material, scale),
        "gradient",
        parameters={name: ("5 kPa", "500 kPa")},
        free_scale=scale != 1.0,
        refine=False,
        identify=False,
    )
    # Data without noise: the residual of the solutions remains, 1e-6.
    assert found.parameters[name] == pytest.approx(truth, rel=1e-4)
    assert found.scale == pytest.approx(scale, rel=1e-4)
    assert found.settings["solver"] == "statics"
    assert found.evaluations <= 20
    errors = [generation.best_error for generation in found.history]
    assert errors[-1] < 1e-3 * errors[0]


def test_other_methods_fit_hyperelastic_constants_too(tmp_path):
    found = calibrate(
        observed(RUBBER),
        parameters={"young": ("15 kPa", "60 kPa")},
        generations=2,
        population=4,
        seed=1,
        identify=False,
    )
    # The simplex stops at 0.02 %.
    assert found.parameters["young"] == pytest.approx(30e3, rel=1e-3)
    assert isinstance(found.material, NeoHookean)
    assert (found.young, found.poisson) == (found.parameters["young"], 0.49)
    path, *_ = write_calibration(found, tmp_path / "run", "my-rubber")
    assert load_card_file(path).material.young() == pytest.approx(30e3, rel=1e-3)
    record = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert record["parameters"] == dict(found.parameters)


def test_young_keeps_the_shape_of_the_curve():
    soft = Ogden(mu=[9e3, 1e3], alpha=[1.7, 5.0], poisson=0.49)
    stiff = with_constants(soft, {"young": 3 * soft.young(), "alpha.1": 4.0})
    assert stiff.mu == pytest.approx((27e3, 3e3))
    assert stiff.alpha == (1.7, 4.0)
    assert "young" in constants_of(soft)


@pytest.mark.parametrize(
    ("bounds", "message"),
    [
        ({"c01": (1, 2), "c11": (1, 2)}, r'c11: is not a constant of "mooney-rivlin".*c10'),
        ({"c10": ("5 kPa", "1 kPa")}, "range 5 kPa to 1 kPa is empty"),
        ({"c01": ("-1 kPa", "1 kPa")}, "is not positive"),
        ({"poisson": ("1 kPa", "2 kPa")}, "number"),
    ],
)
def test_bad_ranges(bounds, message):
    with pytest.raises(VoxSoftError, match=message):
        Space.of(bounds, MooneyRivlin(c10=4e3, c01=1e3))


def test_young_beside_another_modulus():
    with pytest.raises(MaterialError, match=r"scales all moduli, mu\.0 among them"):
        with_constants(Ogden(mu=[9e3], alpha=[2.0]), {"young": 1e4, "mu.0": 1e3})


def test_constants_that_do_not_go_together_are_a_failed_candidate():
    experiment = observed(RUBBER)
    space = Space.of({"poisson": (0.3, 0.6)}, experiment.material)
    assert Misfit([experiment], space, statics=True).at([1.0]).status == "failed"
