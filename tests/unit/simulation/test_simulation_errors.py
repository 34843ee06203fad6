"""Designs that cannot be simulated give place, reason and remedy."""

import sys

import lattice_families as families
import numpy as np
import pytest

import voxsoft as vs
from voxsoft.errors import (
    DesignError,
    DisconnectedError,
    NoCavityError,
    ShapeError,
    SimulationError,
)
from voxsoft.simulation import check, simulate
from voxsoft.units import kPa, mm

BOX = vs.Box(size=(20 * mm, 10 * mm, 10 * mm))
GROUND = vs.Clamp(region=vs.Region(x=(0, 0)))


def design(**changes):
    whole = {
        "name": "box",
        "voxel_size": 5 * mm,
        "parts": [vs.Part(shape=BOX, material="ecoflex-00-30")],
        "clamps": [GROUND],
        "loads": [vs.Gravity()],
    }
    return vs.Design(**(whole | changes))


def message(error_type, **changes):
    with pytest.raises(error_type) as caught:
        simulate(design(**changes))
    problem = caught.value.problems[0]
    assert problem.where
    assert problem.what
    return str(caught.value)


def test_a_floating_body():
    assert "nothing holds the body" in message(DesignError, clamps=[])


def test_a_loose_body_may_move_or_lie():
    assert simulate(design(clamps=[]), end_time=0.01).status == "ok"
    assert simulate(design(clamps=[], floor=vs.Floor(z=0.0))).status == "ok"


def test_a_clamp_that_catches_nothing():
    far = vs.Clamp(region=vs.Region(x=(1.0, 2.0)))
    text = message(DesignError, clamps=[far])
    assert text.startswith("clamps[0].region: touches nothing; the body spans x 0")


def test_a_probe_that_catches_nothing():
    assert "probes.far" in message(DesignError, probes={"far": vs.Probe(z=(1.0, 1.0))})
    assert "outside the body" in message(DesignError, probes={"far": vs.Probe(point=(1, 0, 0))})


def test_a_pressure_without_a_cavity():
    text = message(NoCavityError, loads=[vs.Pressure(value=4 * kPa)])
    assert "no enclosed cavity" in text
    assert "the parts enclose no void" in text


def test_a_pressure_in_a_cavity_that_is_not_there():
    cylinder = families.cylinder()
    second = cylinder.replace(loads=(vs.Pressure(value=1 * kPa, cavity=1),))
    with pytest.raises(NoCavityError, match="past the last of 1"):
        simulate(second)


def test_a_loose_piece():
    far = vs.Box(size=(10 * mm, 10 * mm, 10 * mm), corner=(40 * mm, 0, 0))
    text = message(DisconnectedError, parts=[vs.Part(shape=BOX | far, material="ecoflex-00-30")])
    assert "touches no clamp" in text


def test_a_piece_on_a_hinge_is_loose():
    corner = vs.Box(size=(10 * mm, 10 * mm, 10 * mm), corner=(20 * mm, 10 * mm, 0))
    part = vs.Part(shape=BOX | corner, material="ecoflex-00-30")
    message(DisconnectedError, parts=[part])
    report = check(design(parts=[part]))
    assert any("hinge" in finding.what for finding in report.findings)
    assert not report.valid


def test_a_body_thinner_than_a_voxel():
    thin = vs.Box(size=(20 * mm, 10 * mm, 1 * mm))
    parts = [vs.Part(shape=thin, material="ecoflex-00-30")]
    text = message(ShapeError, parts=parts, fill="binary")
    assert "no cell of 5 mm has its center inside" in text


def test_a_setting_of_the_other_solver():
    with pytest.raises(SimulationError, match="setting of dynamics"):
        simulate(families.beam(), method="statics", substeps=4)
    with pytest.raises(SimulationError, match="setting of statics"):
        simulate(families.beam(), method="xpbd", control="volume")
    with pytest.raises(SimulationError, match="no pressure load"):
        simulate(families.beam(), control="volume")


def test_a_load_too_large_diverges_and_says_where():
    cylinder = families.cylinder(height="25 mm", radius="15 mm")
    result = simulate(cylinder.replace(loads=(vs.Pressure(value=500 * kPa),)))
    assert result.status == "diverged"
    assert "mm" in result.message
    assert np.isfinite(result.positions).all()


def test_ctrl_c_ends_a_run():
    def press(steps, time, residual):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulate(families.beam(), end_time=1e4, progress=press)


def test_check_never_raises_and_names_leaks():
    tube = vs.Cylinder(radius=15 * mm, height=30 * mm) - vs.Cylinder(
        radius=10 * mm, height=25 * mm, base=(0, 0, 5 * mm)
    )
    hole = vs.Box(size=(5 * mm, 5 * mm, 5 * mm), corner=(10 * mm, 0, 10 * mm))
    lid = vs.Cylinder(radius=15 * mm, height=5 * mm, base=(0, 0, 30 * mm))
    leaky = design(
        parts=[vs.Part(shape=(tube | lid) - hole, material="ecoflex-00-30")],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Pressure(value=1 * kPa)],
    )
    report = check(leaky)
    assert not report.valid
    assert report.leaks
    assert any("open through" in finding.what for finding in report.findings)
    assert report.summary()["problems"][0]["severity"] == "error"


def test_a_tangent_too_large_for_memory_is_refused_with_the_estimate(monkeypatch):
    monkeypatch.setattr("voxsoft.simulation.solving.equilibrium.memory_limit", lambda: 10_000)
    rubber = vs.NeoHookean(young=60 * kPa)
    box = design(parts=[vs.Part(shape=BOX, material=rubber)])
    with pytest.raises(SimulationError, match=r"takes about .* GB, and .* are free") as refused:
        simulate(box, method="statics")
    assert "larger voxels" in str(refused.value)


def test_so_is_the_tangent_of_a_gradient(monkeypatch):
    rubber = vs.NeoHookean(young=60 * kPa)
    box = design(parts=[vs.Part(shape=BOX, material=rubber)])
    result = simulate(box, method="statics")
    module = sys.modules["voxsoft.simulation.solving.adjoint"]
    monkeypatch.setattr(module, "memory_limit", lambda: 10_000)
    with pytest.raises(SimulationError, match=r"takes about .* GB, and .*larger voxels"):
        vs.gradient(result, "max_displacement", "parts.0.material.young")
