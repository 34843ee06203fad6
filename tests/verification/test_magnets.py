"""Hard magnets in a uniform field: closed forms, cut voxels, turned bodies, bad input."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_bvp

import voxsoft as vs
from voxsoft.design import Body, MagneticField, Objective, Rotation, Symmetry
from voxsoft.design.mirrored import mirrored_part
from voxsoft.errors import DesignError
from voxsoft.materials import NeoHookean
from voxsoft.simulation import Setup, gradient
from voxsoft.simulation.loads.magnets import VACUUM_PERMEABILITY
from voxsoft.units import kPa, mm

YOUNG, REMANENCE = 300 * kPa, 0.1
LENGTH, HEIGHT = 60 * mm, 2 * mm
# Without Poisson's ratio the beam has the modulus E at its clamp and across its width too.
RUBBER = NeoHookean(young=YOUNG, poisson=0.0, density=1000)


def cantilever(flux: float, voxel: float = 1 * mm, **changes):
    """A beam along x, magnetized along x, in a field along z."""
    return vs.Design(
        name="magnet",
        voxel_size=voxel,
        parts=[
            vs.Part(
                name="arm",
                shape=vs.Box(size=(LENGTH, HEIGHT, HEIGHT)),
                material=RUBBER,
                remanence=(REMANENCE, 0, 0),
            )
        ],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[MagneticField(value=(0, 0, flux))],
        probes={"tip": vs.Probe(x=(LENGTH, LENGTH))},
    ).replace(**changes)


def elastica(flux: float) -> tuple[float, float]:
    """Angle in rad and height of the tip: E I θ'' + (A B Bʳ/μ₀) cos θ = 0, θ(0) = 0, θ'(L) = 0.

    The potential of a length ds is −(A B Bʳ/μ₀) sin θ, as Bʳ is carried along the tangent.
    """
    couple = HEIGHT**2 * flux * REMANENCE / VACUUM_PERMEABILITY
    load = couple * LENGTH**2 / (YOUNG * HEIGHT**4 / 12)

    def slopes(_, y):
        return np.array([y[1], -load * np.cos(y[0]), np.sin(y[0])])

    def ends(low, high):
        return np.array([low[0], low[2], high[1]])

    s = np.linspace(0, 1, 50)
    found = solve_bvp(slopes, ends, s, np.array([s, 1 - s, s**2]), tol=1e-9)
    assert found.success
    return float(found.y[0, -1]), float(found.y[2, -1]) * LENGTH


@pytest.mark.parametrize("flux", [0.2e-3, 1e-3, 4e-3])
def test_a_beam_bends_as_the_elastica(flux):
    result = vs.simulate(cantilever(flux), tolerance=1e-6)
    angle, height = elastica(flux)
    # 30 times as long as high: shear and the stretch of the axis leave 1e-3.
    assert -result.metric("rotation", probe="tip", axis="y") == pytest.approx(angle, rel=0.01)
    assert result.probes["tip"][2] == pytest.approx(height, rel=0.01)


def test_forces_sum_to_zero_and_turn_with_the_magnetic_moment():
    """The torque on the whole body at rest is m × B, also where the surface cuts the voxels."""
    part = vs.Part(
        name="ball",
        shape=vs.Sphere(radius="8.3 mm"),
        material=RUBBER,
        remanence=(0.03, -0.05, 0.07),
    )
    ball = vs.Design(
        name="ball",
        voxel_size=2 * mm,
        parts=[part],
        fill="fraction",
        clamps=[vs.Clamp(region=vs.Region(x=("-10 mm", 0)))],
        loads=[MagneticField(value=(0.01, 0.04, -0.02))],
    )
    setup = Setup.of(ball)
    action = setup.loads[0].actions[0]
    assert action.value.sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-12)
    places = setup.mesh.vertices[action.vertices]
    torque = np.cross(places, action.value).sum(axis=0)
    moment = np.array(part.remanence) * setup.mesh.volume / VACUUM_PERMEABILITY
    assert torque == pytest.approx(np.cross(moment, ball.loads[0].value), rel=1e-9)


def test_each_body_has_the_remanence_of_its_own_part_along_its_own_axes():
    def arm(name, remanence):
        box = vs.Box(size=(20 * mm, 4 * mm, 4 * mm))
        return vs.Part(name=name, body=name, shape=box, material=RUBBER, remanence=remanence)

    turn = Rotation(axis=(0, 0, 1), angle="90 deg")
    pair = vs.Design(
        name="pair",
        voxel_size=2 * mm,
        bodies=[Body(name="along"), Body(name="turned", position=(0, 30 * mm, 0), rotation=turn)],
        parts=[arm("along", (0.1, 0, 0)), arm("turned", (0.05, 0, 0))],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0), body=name)) for name in ("along", "turned")],
        loads=[MagneticField(value=(0, 0, 0.02))],
    )
    setup = Setup.of(pair)
    action = setup.loads[0].actions[0]
    for body, moment in zip(setup.mesh.bodies, ([0.1, 0, 0], [0, 0.05, 0]), strict=True):
        own = (action.vertices >= body.vertices.start) & (action.vertices < body.vertices.stop)
        places = setup.mesh.vertices[action.vertices[own]]
        torque = np.cross(places, action.value[own]).sum(axis=0)
        due = np.cross(moment, [0, 0, 0.02]) * body.mesh.volume / VACUUM_PERMEABILITY
        assert torque == pytest.approx(due, abs=1e-9 * np.linalg.norm(due))


def test_the_mirror_image_of_a_magnet_has_the_image_of_its_arrow():
    part = cantilever(0.0).parts[0].replace(remanence=(0.1, 0.2, 0.3))
    assert mirrored_part(part, "x").remanence == (-0.1, 0.2, 0.3)


def test_the_derivative_by_the_field_and_the_remanence():
    design = cantilever(1e-3, voxel=2 * mm)
    target = {"tip": Objective(maximize="displacement", probe="tip", axis="z")}
    names = ["loads.0.value.2", "parts.0.remanence.0"]
    found = gradient(vs.simulate(design, tolerance=1e-12), target, names)["tip"]
    step = 1e-7
    ends = [
        vs.simulate(cantilever(1e-3 + sign * step, voxel=2 * mm), tolerance=1e-12)
        for sign in (1, -1)
    ]
    high, low = (each.probes["tip"][2] for each in ends)
    slope = (high - low) / (2 * step)
    assert found["loads.0.value.2"] == pytest.approx(slope, rel=1e-5)
    # The force is their product.
    assert found["parts.0.remanence.0"] == pytest.approx(slope * 1e-3 / REMANENCE, rel=1e-5)


def test_a_field_comes_on_over_a_path_and_over_time():
    path = vs.follow(cantilever(0.0, voxel=2 * mm), "loads[0].value[2]=0..4 mT/4")
    assert path.status == "ok"
    heights = [each.probes["tip"][2] for each in path.results]
    # It approaches the direction of the field: each step brings less.
    assert np.all(np.diff(heights, 2) < 0)
    moving = cantilever(1e-3, voxel=2 * mm, solver={"method": "dynamics", "end_time": "0.2 s"})
    assert vs.simulate(moving).probes["tip"][2] > 1 * mm


def test_half_a_body_bends_as_the_whole():
    whole = vs.simulate(cantilever(1e-3), tolerance=1e-9)
    half = cantilever(1e-3, symmetry=[Symmetry(plane="y", at=HEIGHT / 2)])
    assert vs.simulate(half, tolerance=1e-9).probes["tip"] == pytest.approx(
        whole.probes["tip"], abs=1e-7
    )


def test_a_part_that_no_field_acts_on_is_refused():
    bare = cantilever(1e-3)
    with pytest.raises(DesignError, match=r"loads\[0\].*no part of the mesh has a remanence"):
        vs.simulate(bare.replace(parts=[bare.parts[0].replace(remanence=None)]))
    across = cantilever(1e-3, symmetry=[Symmetry(plane="y", at=HEIGHT / 2)])
    across = across.replace(loads=[MagneticField(value=(0, "1 mT", 0))])
    with pytest.raises(DesignError, match=r"loads\[0\].value: points across the plane"):
        vs.simulate(across)
    with pytest.raises(DesignError, match="magnetic field"):
        MagneticField(value=(0, 0, "20 kPa"))


def test_a_magnet_without_a_field_is_named():
    still = cantilever(1e-3, loads=[vs.Gravity()])
    warnings = [str(each) for each in vs.check(still).findings]
    assert any("parts[0].remanence" in each for each in warnings)
