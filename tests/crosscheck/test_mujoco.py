"""A beam under its weight: MuJoCo beside linear tetrahedra assembled here, and beside ours."""

import mujoco
import numpy as np
import pytest
import scipy.sparse as sparse
from scipy.optimize import brentq
from scipy.sparse.linalg import spsolve

import voxsoft as vs
from voxsoft.design import Design
from voxsoft.files import write_scene
from voxsoft.simulation import Setup

# It writes its warnings into a file of the working directory.
mujoco.set_mju_user_warning(lambda message: None)

YOUNG, POISSON = 100e3, 0.3
#: Part of the height of the tip by which it moves in the last tenth of the time.
RESTING = 1e-4


def beam(voxel_size, gravity):
    """A beam of 10 x 10 mm, 50 mm long, with a modulus of 100 kPa and under a little weight."""
    rubber = {"model": "neo-hookean", "young": YOUNG, "poisson": POISSON, "density": 1070.0}
    return Design(
        name="beam",
        voxel_size=voxel_size,
        parts=[{"shape": {"kind": "box", "size": (0.05, 0.01, 0.01)}, "material": rubber}],
        clamps=[{"region": {"x": (0.0, 0.0)}}],
        loads=[{"kind": "gravity", "value": gravity}],
        probes={"tip": {"x": (0.05, 0.05)}},
    )


def settled(design, path):
    """Height of the tip [m] in MuJoCo after four seconds."""
    write_scene(path, design)
    model = mujoco.MjModel.from_xml_path(str(path))
    # Steps of 20 ms with damping of 100 ms come to the same rest sooner.
    model.opt.timestep, model.flex_damping[:] = 0.02, 0.1
    data = mujoco.MjData(model)
    path = []
    for _ in range(200):
        mujoco.mj_step(model, data)
        path.append(data.sensor("tip.z").data[0])
    assert np.ptp(path[-20:]) < RESTING * abs(path[-1])
    return path[-1]


def linear(setup):
    """Height of the tip [m] by linear elasticity on the same tetrahedra, assembled here."""
    points, tets = setup.mesh.vertices, setup.mesh.tets
    sides = np.stack([points[tets[:, k]] - points[tets[:, 0]] for k in (1, 2, 3)], axis=2)
    inner = np.linalg.inv(sides)
    slopes = np.concatenate([-inner.sum(axis=1, keepdims=True), inner], axis=1)
    mu = YOUNG / (2 * (1 + POISSON))
    lame = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    blocks = lame * np.einsum("mai,mbj->maibj", slopes, slopes)
    blocks += mu * np.einsum("maj,mbi->maibj", slopes, slopes)
    blocks += mu * np.einsum("mak,mbk,ij->maibj", slopes, slopes, np.eye(3))
    blocks *= (np.linalg.det(sides) / 6.0)[:, None, None, None, None]
    index = (3 * tets[:, :, None] + np.arange(3)).reshape(len(tets), 12)
    rows, columns = np.repeat(index, 12, axis=1).ravel(), np.tile(index, (1, 12)).ravel()
    stiffness = sparse.coo_matrix((blocks.ravel(), (rows, columns))).tocsc()
    free = np.ones((len(points), 3), dtype=bool)
    free[setup.clamped[0]] = False
    free = np.flatnonzero(free)
    forces = np.zeros((len(points), 3))
    forces[:, 2] = -setup.design.loads[0].value * setup.problem.masses
    moved = np.zeros(forces.size)
    moved[free] = spsolve(stiffness[free][:, free], forces.ravel()[free])
    place = setup.places["tip"]
    return place.weights @ moved.reshape(-1, 3)[place.vertices, 2]


def strain(tip):
    """Strain at the clamp of a beam that bends evenly to a height of its tip [m]."""
    return 0.005 * 2 * abs(tip) / 0.05**2


def corner(power):
    """Zero at the power of the displacement in a corner of 90°, held on one side (Williams 1952).

    In plane strain.
    """
    rest = (4.0 * (1.0 - POISSON) ** 2 - power**2) / (3.0 - 4.0 * POISSON)
    return np.sin(power * np.pi / 2.0) ** 2 - rest


def test_a_beam_rests_where_its_own_tetrahedra_do(tmp_path):
    design = beam(0.005, 0.05)
    found = settled(design, tmp_path / "beam.xml")
    # St Venant-Kirchhoff differs from linear elasticity by the strain.
    assert strain(found) < 2e-4
    assert found == pytest.approx(linear(Setup.of(design)), rel=2 * strain(found))


@pytest.mark.long
def test_refined_tetrahedra_go_to_our_beam(tmp_path):
    designs = {count: beam(0.01 / count, 0.5) for count in (2, 3, 4, 6)}
    found = {n: settled(each, tmp_path / f"{n}.xml") for n, each in designs.items()}
    ours = {n: vs.simulate(designs[n]).probes["tip"][2] for n in (4, 6)}
    # Linear tetrahedra are too stiff by a part that falls with the square of their size.
    stiff = {n: 1.0 / value for n, value in found.items()}
    order = np.log2((stiff[2] - 1.0 / ours[6]) / (stiff[4] - 1.0 / ours[6]))
    assert order == pytest.approx(2.0, abs=0.15)
    limits = [(4.0 * stiff[2 * n] - stiff[n]) / 3.0 for n in (2, 3)]
    # The limits still err by the singular edge of the clamp, whose energy is of the order 2 λ.
    power = 2.0 * brentq(corner, 0.5, 1.0)
    assert power == pytest.approx(1.42, abs=0.01)
    shrinks = (2.0 / 3.0) ** power  # from one pair to the other
    left = abs(limits[1] - limits[0]) * shrinks / (1.0 - shrinks)
    ours_alone = abs(1.0 / ours[6] - 1.0 / ours[4])
    others = (RESTING + strain(found[6])) * abs(stiff[6])  # not at rest, and of another law
    assert abs(limits[1] - 1.0 / ours[6]) < left + ours_alone + others
