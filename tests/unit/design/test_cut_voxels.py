"""Voxels that the surface cuts: fractions, moments, voids, and meshes of them."""

import lattice_families as families
import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design.discretization import cut_cells
from voxsoft.design.discretization.cut_voxels import LEAST_FILLED, CutVoxels, fractions_of
from voxsoft.errors import DesignError, MeshError, ShapeError, SimulationError
from voxsoft.files import read_mesh, write_mesh
from voxsoft.materials import NeoHookean
from voxsoft.shapes.fractions import fill
from voxsoft.simulation import Setup, check
from voxsoft.units import mm

SOFT = NeoHookean(young=60e3, poisson=0.49)


def design(shape, size=1.0, **others):
    parts = [{"shape": shape, "material": SOFT}]
    return vs.Design(name="body", voxel_size=size, fill="fraction", parts=parts, **others)


def hollow_ball(inner, outer, size, center=(0, 0, 0)):
    shape = vs.Sphere(radius=outer, center=center) - vs.Sphere(radius=inner, center=center)
    return design(shape, size)


@pytest.mark.parametrize("at_once", [4096, 100])
def test_small_cubes_that_are_known_are_those_that_are_filled_again(monkeypatch, at_once):
    monkeypatch.setattr(cut_cells, "_CHUNK", at_once)
    ball = hollow_ball(3.2, 6.1, 1.0)
    assert cut_cells.cut_cells(ball, 1.0).cubes is not None
    cut = CutVoxels.of(ball)  # its cells near the surface are filled once
    again = cut.resampled(ball)
    for name in ("fractions", "moments", "surfaces"):
        assert np.array_equal(getattr(cut, name), getattr(again, name))
    (void,), (anew,) = cut.voids, again.voids
    assert all(np.array_equal(*pair) for pair in zip(void, anew, strict=True))


def test_overlapping_and_abutting_parts_are_not_counted_twice():
    left, right = vs.Box(size=(0.37, 1, 1)), vs.Box(size=(0.63, 1, 1), center=(0.685, 0.5, 0.5))
    slanted = vs.HalfSpace(point=(0.5, 0.5, 0.5), normal=(2, 1, 0))
    other_side = vs.HalfSpace(point=(0.5, 0.5, 0.5), normal=(-2, -1, 0))
    whole = vs.Box(size=(1, 1, 1))
    for first, second, share in ((left, right, 0.37), (left, whole, 0.37), (slanted, whole, 0.5)):
        _, _, shares = fill([first.build(), second.build()], np.zeros((1, 3)), 1.0)
        # A corner of a box is met by one plane in its small cube: 0.02/64 each.
        assert shares[0] == pytest.approx([share, 1 - share], abs=4e-3)
    filled, _, _ = fill([slanted.build(), other_side.build()], np.zeros((1, 3)), 1.0)
    assert filled.min() == pytest.approx(1.0, abs=1e-9)
    filled, _, _ = fill([slanted.build(), slanted.build()], np.zeros((1, 3)), 1.0)
    assert filled.mean() == pytest.approx(0.5, abs=1e-9)


def test_a_body_along_the_lattice_is_the_same_either_way():
    binary = families.beam()
    fraction = binary.replace(fill="fraction")
    cut = CutVoxels.of(fraction)
    assert cut.voxels.count == vs.voxels_of(binary).count
    assert cut.fractions == pytest.approx(1.0, abs=4e-4)  # its corners, as above
    assert cut.lost == pytest.approx(0.0, abs=1e-15)


def test_fractions_stand_in_the_order_of_the_tets():
    mesh = CutVoxels.of(hollow_ball(1.1, 2.6, 1.0)).mesh()
    centers = mesh.vertices[mesh.tets].mean(axis=1).reshape(-1, 5, 3).mean(axis=1)
    radii = np.linalg.norm(centers, axis=1)
    # A full voxel has its center at least half an edge under the surfaces, a cut one above that.
    assert (mesh.fractions[np.abs(radii - 1.85) < 0.1] > 0.7).all()
    assert (mesh.fractions[radii > 2.6] < 0.75).all()
    assert np.array_equal(mesh.tet_voxel, np.repeat(np.arange(len(mesh.fractions)), 5))


@pytest.mark.long
@pytest.mark.parametrize("shift", [0.31])
def test_volume_cavity_and_center_converge_with_second_order(shift):
    errors = []
    center = np.full(3, shift) * mm
    for size in (5, 2.5, 1.25):
        cut = CutVoxels.of(hollow_ball(10 * mm, 16 * mm, size * mm, tuple(center)))
        mesh = cut.mesh()
        # Material given away stays in the sum, so only curvature remains.
        solid, hole = (16**3 - 10**3) * 4e-9 / 3 * np.pi, 1e-6 * 4 / 3 * np.pi
        assert cut.lost == pytest.approx(0.0, abs=1e-12 * solid)
        cells = mesh.vertices[mesh.tets].mean(axis=1).reshape(-1, 5, 3).mean(axis=1)
        places = cells + mesh.moments[:, :3] * size * mm / 2
        middle = np.average(places, axis=0, weights=mesh.fractions)
        assert middle == pytest.approx(center, abs=2e-4 * size * mm)
        assert mesh.cavities[0].volume_at(mesh.vertices) == pytest.approx(mesh.cavities[0].volume)
        errors.append((mesh.volume / solid - 1, mesh.cavities[0].volume / hole - 1))
    coarse, middle, fine = np.abs(errors)
    # A sphere is met w²/12R too far out, w = h/4: the ball gains (h/R)²/64, 0.15 and 0.4 % at 5 mm.
    assert (coarse < [3e-3, 5e-3]).all()
    assert (np.log2(coarse / fine) / 2 > 1.8).all(), (coarse, middle, fine)


def test_slivers_are_given_to_neighbors_with_their_place():
    cut = CutVoxels.of(design(vs.Box(size=(4, 4, 1.2))))
    assert cut.voxels.count == 16
    # Edges again: 16 of them around the top, (1/4)²/3 each.
    assert cut.fractions.sum() == pytest.approx(4 * 4 * 1.2, abs=16 / 48)
    inner = cut.fractions.reshape(4, 4)[1:3, 1:3]
    assert inner == pytest.approx(1.2, abs=1e-9)
    # Material from 0 to 1.2 about the middle 0.5 of a voxel, in halves of its edge.
    moments = cut.moments.reshape(4, 4, 9)[1:3, 1:3]
    assert moments[..., 2] == pytest.approx(0.2, abs=1e-9)
    assert moments[..., 5] == pytest.approx(1.2, abs=1e-9)
    assert moments[..., 6:] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("beyond", "kept"),
    [
        ((0.15, 0.15, 0.15), 0),  # 0.28 in edges and 0.39 in the corner: more than the least part
        ((0.15, 0.15, 0.0), 0),
        ((0.3, 0.15, 0.0), 16),  # a wall of voxels with its edge, but not the sliver
        ((0.3, 0.3, 0.0), 28),
    ],
)
def test_no_brace_stands_where_slivers_meet(beyond, kept):
    room = 4 - np.array(beyond)
    box, inner = vs.Box(size=(6, 6, 6), corner=(0, 0, 0)), tuple(room.tolist())
    cut = CutVoxels.of(design(box - vs.Box(size=inner, corner=(1, 1, 1))))
    assert np.count_nonzero(cut.voxels.array[2:6, 2:6, 2:6]) == kept
    # Sharp edges: small cubes of a quarter are wrong by a third at most, along 12 and 3 edges.
    assert cut.fractions.sum() == pytest.approx(216 - room.prod(), abs=(12 * 6 + 3 * 4) / 48)


def test_means_of_products_are_those_of_the_material():
    # A prism whose slanted side cuts cells into halves and eighths, which their neighbors get.
    low, leg, height = -1.0, 4.5, 4.0
    slanted = vs.HalfSpace(point=(low + leg, low, 0), normal=(1, 1, 0))
    box = vs.Box(size=(8, 8, height), corner=(low, low, 0))
    mesh = CutVoxels.of(design(box & slanted)).mesh()
    assert mesh.fractions.max() > 1.05
    x, y, _ = mesh.vertices[mesh.tets].mean(axis=1).reshape(-1, 5, 3).mean(axis=1).T
    to_x, to_y, products = mesh.moments[:, 0] / 2, mesh.moments[:, 1] / 2, mesh.moments[:, 8] / 4
    found = mesh.fractions @ (x * y + x * to_y + y * to_x + products)
    # Over the triangle, from its corner: 1, x and xy have a²/2, a³/6 and a⁴/24.
    first, second = leg**3 / 6, leg**4 / 24
    exact = height * (second + 2 * low * first + low**2 * leg**2 / 2)
    # Halves across a diagonal have a center 6 % off; the products are a fiftieth of the whole.
    assert found == pytest.approx(exact, rel=5e-3)


def test_material_too_thin_for_any_voxel_is_reported():
    # A rod that stands alone, a fifteenth of the cells it runs through.
    thin = vs.Box(size=(4, 0.26, 0.26), center=(2, 2.62, 5.62)) | vs.Box(size=(4, 4, 2))
    report = check(design(thin, clamps=[{"region": {"z": (0, 0)}}]))
    assert any("too thin" in finding.what for finding in report.findings)
    with pytest.raises(ShapeError, match="22% full"):
        CutVoxels.of(design(vs.Box(size=(4, 0.2, 0.2))))  # one small cube thick


def test_voids_on_both_sides_of_a_wall_go_to_their_own_side():
    # One cell across, cut on both sides: 0.1 outside, 0.2 inside.
    shape = vs.Box(size=(5.8,) * 3, center=(3,) * 3) - vs.Box(size=(4.4,) * 3, center=(3,) * 3)
    mesh = CutVoxels.of(design(shape)).mesh()
    # 4 x 4 x 4 empty cells and 0.2 of a cell around. A small cube with an edge in it is met by one
    # plane, which is wrong by a third of it at most: (1/4)²/3 along 12 edges. The other side's void
    # would be 20 cells.
    edges = 12 / 48
    assert mesh.cavities[0].volume == pytest.approx(4.4**3, abs=4.4 * edges)
    assert mesh.volume == pytest.approx(5.8**3 - 4.4**3, abs=(4.4 + 5.8) * edges)


def test_other_parameters_on_the_same_voxels_vary_smoothly():
    ball = families.sphere().replace(fill="fraction")
    cut = CutVoxels.of(ball)
    radius = ball.parameters["radius"].value
    step = 1e-4 * radius

    def other(sign):
        return ball.with_parameters(radius=radius + sign * step)

    up, down = (cut.resampled(other(sign)) for sign in (1, -1))
    assert np.array_equal(fractions_of(other(1), cut), up.fractions)
    slope = (up.fractions.sum() - down.fractions.sum()) / (2 * step) * ball.voxel_size**3
    wall = ball.parameters["wall"].value
    # The wall keeps its thickness: both radii grow. Second order, 0.2 % at 5 voxels of radius.
    exact = 4 * np.pi * (radius**2 - (radius - wall) ** 2)
    assert slope == pytest.approx(exact, rel=0.01)
    kinks = np.abs(up.fractions + down.fractions - 2 * cut.fractions)
    assert kinks.max() < 0.05 * np.abs(up.fractions - down.fractions).max()
    with pytest.raises(DesignError, match="voxel_size"):
        cut.resampled(ball.with_values("voxel_size=3.3 mm"))


def test_refined_voxels_are_filled_anew():
    ball = families.sphere().replace(fill="fraction")
    fine = vs.mesh_of(ball, refine=2)
    assert fine.voxel_size == ball.voxel_size / 2
    assert np.unique(np.round(fine.fractions, 6)).size > 20
    coarse = vs.mesh_of(ball)
    assert fine.volume == pytest.approx(coarse.volume, rel=5e-3)


def test_a_clamp_and_a_probe_at_a_surface_inside_a_voxel():
    short = families.beam(length="98 mm").replace(
        fill="fraction",
        clamps=(vs.Clamp(region=vs.Region(x=(98 * mm, 98 * mm))),),
        probes={"top": vs.Probe(z=(10 * mm, 10 * mm)), "end": vs.Probe(x=(0, 0))},
        objectives={},
    )
    setup = Setup.of(short)
    held = setup.mesh.vertices[setup.clamped[0]]
    # The voxel from 95 to 100 mm is 60 % full: its outer corners carry the surface.
    assert np.unique(held[:, 0]) == pytest.approx([0.1])
    assert len(held) == 9


@pytest.mark.parametrize("end", [97.0, 95.9, 95.1, 94.0])
def test_probes_in_front_of_the_last_voxel_move_with_the_material(end):
    # 95.1 and 95.9 mm end in cells too empty to be voxels, 0.1 and 0.9 mm in front of the last.
    body = vs.Box(size=(end * mm, 10.4 * mm, 10 * mm), corner=(0, -0.2 * mm, 0))
    clamps = (vs.Clamp(region=vs.Region(x=(0, 0))),)
    short = families.beam().replace(
        fill="fraction",
        clamps=clamps,
        shapes={"body": body},
        probes={
            "point": vs.Probe(point=(end * mm, 10.2 * mm, 3 * mm)),
            "plane": vs.Probe(x=(end * mm, end * mm)),
            "edge": vs.Probe(x=(end * mm, end * mm), y=(10.2 * mm, 10.2 * mm)),
        },
        objectives={},
    )
    setup = Setup.of(short)
    slopes = np.random.default_rng(3).normal(size=(3, 3))
    expected = {"point": (end, 10.2, 3), "plane": (end, 5, 5), "edge": (end, 10.2, 5)}
    for name, place in setup.places.items():
        moved = place.weights @ (setup.mesh.vertices @ slopes)[place.vertices]
        exact = np.array(expected[name]) * mm @ slopes
        np.testing.assert_allclose(moved, exact, atol=1e-12)


def test_a_region_on_a_side_does_not_catch_the_vertices_of_cut_sides():
    column = design(vs.Cylinder(radius=2.3, height=6), clamps=[{"region": {"z": (0, 0)}}])
    setup = Setup.of(column)
    assert (setup.mesh.vertices[setup.clamped[0], 2] == 0.0).all()


def test_masses_and_metrics_take_the_fractions():
    ball = families.sphere().replace(fill="fraction", objectives={})
    setup = Setup.of(ball)
    material = ball.material_of(ball.parts[0])
    assert setup.problem.mass == pytest.approx(material.density * setup.mesh.volume)
    report = check(ball)
    assert report.mass == pytest.approx(setup.problem.mass)
    assert report.cavities[0].volume == setup.mesh.cavities[0].volume


def test_pressure_works_on_the_cavity_with_its_voids():
    ball = hollow_ball(1.6, 2.7, 1.0).replace(
        loads=(vs.Pressure(value=100.0),), clamps=(vs.Clamp(region=vs.Region(z=(-2.7, -2.7))),)
    )
    setup = Setup.of(ball)
    rng = np.random.default_rng(1)
    rest = setup.mesh.vertices
    positions = rest + 0.05 * rng.normal(size=rest.shape)
    direction = rng.normal(size=rest.shape)
    elastic = setup.problem.elastic(positions)[1]
    pressure = setup.problem.net_forces(positions) - elastic
    cavity, step = setup.mesh.cavities[0], 1e-6
    change = cavity.volume_at(positions + step * direction) - cavity.volume_at(
        positions - step * direction
    )
    # Central differences of a cubic: exact up to rounding and step².
    assert (pressure * direction).sum() == pytest.approx(100.0 * change / (2 * step), rel=1e-6)
    assert pressure.sum(axis=0) == pytest.approx(0.0, abs=1e-9)


def test_a_mesh_file_keeps_fractions(tmp_path):
    mesh = CutVoxels.of(hollow_ball(1.1, 2.6, 1.0)).mesh()
    write_mesh(tmp_path / "ball.vtu", mesh)
    again = read_mesh(tmp_path / "ball.vtu")
    assert np.array_equal(again.fractions, mesh.fractions)
    assert np.array_equal(again.moments, mesh.moments)


def test_bad_fractions_are_refused():
    mesh = vs.Voxels.from_array([[[1, 1]]], voxel_size=1.0).mesh()
    with pytest.raises(MeshError, match="2 positive"):
        mesh.with_fractions([1.0, 0.0])
    with pytest.raises(MeshError, match="moments"):
        mesh.with_fractions([1.0, 0.5], moments=np.zeros((2, 9)))
    with pytest.raises(MeshError, match=r"expected \(n, 9\)"):
        mesh.with_fractions([1.0, 0.5], moments=np.ones((2, 7)))


def test_six_moments_have_the_products_of_their_centers():
    mesh = vs.Voxels.from_array([[[1]]], voxel_size=1.0).mesh()
    filled = mesh.with_fractions([0.5], moments=[[0.1, -0.2, 0.3, 1.0, 0.9, 0.8]])
    expected = [0.1, -0.2, 0.3, 1.0, 0.9, 0.8, -0.06, 0.03, -0.02]
    assert filled.moments[0] == pytest.approx(expected, rel=1e-12)
    with pytest.raises(DesignError, match="fill"):
        families.beam().with_values("fill=half")


def test_the_resolved_design_says_its_default_fill():
    springs = families.beam()
    assert springs.resolved["fill"] == "binary"
    beam = springs.with_values("parts.0.material=ecoflex-00-30")
    assert beam.resolved["fill"] == "fraction"
    assert beam.with_values("fill=fraction").hash == beam.hash
    assert beam.with_values("fill=binary").hash != beam.hash


def test_outside_codes_say_no():
    from voxsoft.comparison.bricks import BrickModel

    ball = Setup.of(hollow_ball(1.1, 2.6, 1.0).replace(clamps=_held()))
    with pytest.raises(SimulationError, match="partly filled"):
        BrickModel.of(ball)


def _held():
    return (vs.Clamp(region=vs.Region(z=(-2.6, -2.6))),)


def test_the_least_part_lies_between_fifths_and_quarters():
    assert 0.2 < LEAST_FILLED < 0.25
