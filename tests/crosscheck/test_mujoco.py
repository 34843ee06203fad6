"""A beam under its weight: MuJoCo beside the same elements assembled here, and beside ours."""

import itertools

import mujoco
import numpy as np
import pytest
import scipy.sparse as sparse
from scipy.optimize import brentq
from scipy.sparse.linalg import spsolve

import voxsoft as vs
from voxsoft.design import Design
from voxsoft.files import write_scene
from voxsoft.files.scenes.scene import Scene
from voxsoft.simulation import Setup

# It writes its warnings into a file of the working directory.
mujoco.set_mju_user_warning(lambda message: None)

YOUNG, POISSON = 100e3, 0.3
#: Part of the height of the tip by which it moves in the last tenth of the time.
RESTING = 1e-4


RUBBER = {"model": "neo-hookean", "young": YOUNG, "poisson": POISSON, "density": 1070.0}
SPRINGS = {"model": "lattice", "edge": 40e3, "bulk": 80e3, "density": 1070.0}


def beam(voxel_size, gravity, material=RUBBER):
    """A beam of 10 x 10 mm, 50 mm long, with a modulus of 100 kPa and under a little weight."""
    return Design(
        name="beam",
        voxel_size=voxel_size,
        parts=[{"shape": {"kind": "box", "size": (0.05, 0.01, 0.01)}, "material": material}],
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


def tetrahedra(setup):
    """Slopes of the shape functions of linear tetrahedra (m, 1, 4, 3), weights (m, 1), corners."""
    points, tets = setup.mesh.vertices, setup.mesh.tets
    sides = np.stack([points[tets[:, k]] - points[tets[:, 0]] for k in (1, 2, 3)], axis=2)
    inner = np.linalg.inv(sides)
    slopes = np.concatenate([-inner.sum(axis=1, keepdims=True), inner], axis=1)
    return slopes[:, None], np.linalg.det(sides)[:, None] / 6.0, tets


def bricks(setup):
    """The same of trilinear bricks at eight Gauss points: (m, 8, 8, 3), (m, 8), corners."""
    size = setup.mesh.voxel_size
    corners = setup.mesh.voxel_corners(np.arange(len(setup.mesh.tets) // 5))
    signs = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    at = signs[:, None, :] * signs[None, :, :] / np.sqrt(3.0)  # points, corners, axes
    factors = 1.0 + at
    slopes = np.empty((8, 8, 3))
    for axis in range(3):
        others = np.delete(factors, axis, axis=2).prod(axis=2)
        slopes[:, :, axis] = signs[None, :, axis] * others / 8.0 * (2.0 / size)
    count = len(corners)
    return np.tile(slopes, (count, 1, 1, 1)), np.full((count, 8), size**3 / 8.0), corners


def linear(setup, elements):
    """Height of the tip [m] by linear elasticity on elements, assembled here."""
    slopes, weights, corners = elements(setup)
    moduli = [Scene(setup).moduli(part) for part in range(len(setup.materials))]
    parts = setup.mesh.tet_part[:: len(setup.mesh.tets) // len(corners)].astype(int) - 1
    young, poisson = np.array(moduli)[parts].T[:, :, None]
    mu = weights * young / (2 * (1 + poisson))
    lame = weights * young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    blocks = np.einsum("mq,mqai,mqbj->maibj", lame, slopes, slopes)
    blocks += np.einsum("mq,mqaj,mqbi->maibj", mu, slopes, slopes)
    blocks += np.einsum("mq,mqak,mqbk,ij->maibj", mu, slopes, slopes, np.eye(3))
    width = 3 * corners.shape[1]
    index = (3 * corners[:, :, None].astype(int) + np.arange(3)).reshape(len(corners), width)
    rows = np.repeat(index, width, axis=1).ravel()
    columns = np.tile(index, (1, width)).ravel()
    stiffness = sparse.coo_matrix((blocks.ravel(), (rows, columns))).tocsc()
    count = len(setup.mesh.vertices)
    free = np.ones((count, 3), dtype=bool)
    free[setup.clamped[0]] = False
    free = np.flatnonzero(free)
    forces = np.zeros((count, 3))
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


@pytest.mark.parametrize(
    ("material", "elements"), [(RUBBER, bricks), (SPRINGS, tetrahedra)], ids=["bricks", "tets"]
)
def test_a_beam_rests_where_its_own_elements_do(material, elements, tmp_path):
    design = beam(0.005, 0.05, material)
    found = settled(design, tmp_path / "beam.xml")
    # Large strain differs from linear elasticity by the strain.
    assert strain(found) < 3e-4
    assert found == pytest.approx(linear(Setup.of(design), elements), rel=2 * strain(found))


@pytest.mark.long
def test_a_hollow_body_of_two_parts_rests_where_its_own_bricks_do(tmp_path):
    # Its box of cells has empty ones, whose nodes are points of the world, and two parts share it.
    whole = beam(0.0025, 0.2)
    firm = {**RUBBER, "young": 3.0 * YOUNG}
    inner = {"kind": "box", "size": (0.04, 0.005, 0.005), "corner": (0.005, -0.0025, -0.0025)}
    outer = {"kind": "box", "size": (0.05, 0.01, 0.01)}
    half = {"kind": "box", "size": (0.0125, 0.01, 0.01), "corner": (0.0, -0.005, -0.005)}
    tube = {"kind": "difference", "of": [outer, inner]}
    root = {"kind": "difference", "of": [half, inner]}
    parts = [{"shape": root, "material": firm}, {"shape": tube, "material": RUBBER}]
    design = whole.replace(parts=parts)
    found = settled(design, tmp_path / "tube.xml")
    assert strain(found) < 1e-3
    assert found == pytest.approx(linear(Setup.of(design), bricks), rel=2 * strain(found))


@pytest.mark.long
def test_refined_bricks_go_to_our_beam(tmp_path):
    designs = {count: beam(0.01 / count, 0.5) for count in (2, 3, 4, 6)}
    found = {n: settled(each, tmp_path / f"{n}.xml") for n, each in designs.items()}
    ours = {n: vs.simulate(designs[n]).probes["tip"][2] for n in (4, 6)}
    # Such bricks are too stiff by a part that falls with the square of their size.
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
