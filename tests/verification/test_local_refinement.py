"""Voxels of two sizes against voxels of one."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft import Objective, gradient
from voxsoft.comparison.bars import error_bars
from voxsoft.design import FiberStrain, Refinement
from voxsoft.design.variation import number_of, with_number
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.49, density=1070.0)


def block(**changes):
    """A cube of 32 mm with a ball of 6 mm cut out of it."""
    whole = {"kind": "box", "size": ["32 mm", "32 mm", "32 mm"], "corner": [0, 0, 0]}
    room = {"kind": "sphere", "radius": "6 mm", "center": ["16 mm", "16 mm", "16 mm"]}
    return vs.Design(
        **{
            "name": "block",
            "voxel_size": 4 * mm,
            "fill": "fraction",
            "shapes": {
                "whole": whole,
                "room": room,
                "body": {"kind": "difference", "of": ["whole", "room"]},
            },
            "parts": [vs.Part(shape="body", material=RUBBER)],
            "clamps": [vs.Clamp(region=vs.Region(z=(0, 0)))],
            "loads": [vs.Pressure(value=10 * kPa), vs.Gravity()],
            "probes": {"top": vs.Probe(point=(16 * mm, 16 * mm, 32 * mm))},
            **changes,
        }
    )


AROUND = Refinement(region=vs.Region(center=(16 * mm, 16 * mm, 16 * mm), radius=7 * mm))


def growth(result):
    return result.cavity_volumes[0] - float(result.mesh.cavities[0].volume)


@pytest.fixture(scope="module")
def both():
    return vs.simulate(block(refine=[AROUND], solver={"error": "finer"}))


def test_uniform_strain_is_the_same_on_two_sizes():
    """Drawn by its ends with free sides: any mesh has one answer, to the residual of Newton."""
    cube = vs.Box(size=(32 * mm, 32 * mm, 32 * mm), corner=(0, 0, 0))
    pulled = vs.Motion(displacement=(0, 0, 16 * mm))
    faces = [vs.Region(x=(0, 0)), vs.Region(y=(0, 0)), vs.Region(z=(0, 0))]
    design = vs.Design(
        name="cube",
        voxel_size=8 * mm,
        parts=[vs.Part(shape=cube, material=RUBBER)],
        clamps=[
            *(vs.Clamp(region=face, axes=axis) for face, axis in zip(faces, "xyz", strict=True)),
            vs.Clamp(region=vs.Region(z=(32 * mm, 32 * mm)), axes="z", motion=pulled),
        ],
    )
    corner = Refinement(region=vs.Region(center=(0, 32 * mm, 32 * mm), radius=18 * mm))
    one, two = vs.simulate(design, refine=2), vs.simulate(design.replace(refine=[corner]))
    setup = Setup.of(two.design)
    assert 0 < len(setup.large_voxels) < 64
    assert two.status == "ok"
    # Both leave 1e-8 of the force, of which the strain is about as large a part.
    assert np.abs(two.positions - one.positions).max() < 1e-7 * 16 * mm
    stress = two.fields.von_mises
    assert np.ptp(stress) < 1e-6 * stress.max()


@pytest.mark.slow
def test_most_of_the_gain_for_a_part_of_the_unknowns(both):
    large, small = vs.simulate(block()), vs.simulate(block(), refine=2)
    off = abs(growth(large) - growth(small))
    assert abs(growth(both) - growth(small)) < 0.3 * off
    tied = int((Setup.of(both.design).problem.masses == 0.0).sum())
    assert len(both.mesh.vertices) - tied < 0.7 * len(small.mesh.vertices)


@pytest.mark.long
def test_the_support_carries_the_weight(both):
    assert both.status == "ok"
    weight = 9.81 * both.mass
    assert both.mass == pytest.approx(vs.simulate(block(), refine=2).mass, rel=1e-12)
    # The cavity is closed: its pressure pushes nothing along. Newton leaves 1e-8 of the load.
    assert both.reaction[2] == pytest.approx(weight, rel=1e-6)
    moment = np.cross(both.positions, both.reactions).sum(axis=0)
    assert np.allclose(moment, both.reaction_moment)


def test_tied_vertices_are_where_they_belong(both):
    setup = Setup.of(both.design)
    corners = setup.mesh.voxel_corners(setup.large_voxels.ravel().astype(np.int64)).reshape(
        -1, 8, 8
    )
    outer = both.positions[corners[:, np.arange(8), np.arange(8)]]
    middle = both.positions[corners[:, 0, 7]]
    assert np.allclose(outer.mean(axis=1), middle, rtol=0.0, atol=1e-12)


@pytest.mark.slow
def test_slopes_are_those_of_differences():
    """Slopes by the pressure and by Young's modulus, through the tied tangent and its transpose."""
    design = block(refine=[AROUND])
    targets = {
        "up": Objective(maximize="displacement", probe="top", axis="z"),
        "room": Objective(maximize="cavity_volume"),
        "energy": Objective(maximize="elastic_energy"),
    }

    def solved(changed):
        return vs.simulate(changed, method="statics", tolerance=1e-11)

    names = ("loads.0.value", "parts.0.material.young")
    found = gradient(solved(design), targets, names)
    for name in names:
        value = number_of(design, name)
        step = 1e-3 * value
        high, low = (solved(with_number(design, name, value + sign * step)) for sign in (1, -1))
        for key, target in targets.items():
            ends = [
                each.metric(target.metric, probe=target.probe, axis=target.axis)
                for each in (high, low)
            ]
            # Differences of second order leave 1e-6 of a smooth number.
            slope = (ends[0] - ends[1]) / (2.0 * step)
            assert found[key][name] == pytest.approx(slope, rel=1e-4), (key, name)


@pytest.mark.slow
def test_error_bars_come_from_two_sizes_of_both(both):
    bars = error_bars(both)
    assert bars.voxel_sizes == pytest.approx((4 * mm, 2 * mm))
    assert bars.voxels[0] == len(both.mesh.tets) // 5 - 7 * len(Setup.of(both.design).large_voxels)
    bar = bars.probes["top"][2]
    truth = vs.simulate(block(voxel_size=1 * mm)).probes["top"][2]
    assert abs(bar.estimate - truth) < bar.error


@pytest.mark.long
def test_small_voxels_everywhere_are_the_same_bits():
    everywhere = Refinement(region=vs.Region(z=(0, 32 * mm)))
    local = vs.simulate(block(refine=[everywhere]))
    whole = vs.simulate(block(), refine=2)
    assert np.array_equal(local.positions, whole.positions)


def test_a_body_swells_uniformly_along_and_across_its_fibers():
    """Free of stress it has one stretch along the fibers and one across; no size is another's."""
    muscle = vs.Part(
        shape=vs.Box(size=(32 * mm, 16 * mm, 16 * mm), corner=(0, 0, 0)),
        material=RUBBER,
        fibers=[{"direction": (0.6, 0.8, 0), "modulus": 300 * kPa, "compression": True}],
        name="muscle",
    )
    design = vs.Design(
        name="muscle",
        voxel_size=4 * mm,
        parts=[muscle],
        activations=[FiberStrain(part="muscle", value="-10 %")],
        clamps=[
            vs.Clamp(region=vs.Region(center=(0, 0, 0), radius=0.1 * mm)),
            vs.Clamp(region=vs.Region(center=(32 * mm, 0, 0), radius=0.1 * mm), axes="yz"),
            vs.Clamp(region=vs.Region(center=(0, 16 * mm, 0), radius=0.1 * mm), axes="z"),
        ],
        refine=[Refinement(region=vs.Region(center=(32 * mm, 16 * mm, 16 * mm), radius=9 * mm))],
    )
    result = vs.simulate(design)
    assert len(Setup.of(design).large_voxels) > 10
    assert result.status == "ok"
    rest = result.mesh.vertices
    affine = np.linalg.lstsq(np.c_[rest, np.ones(len(rest))], result.positions, rcond=None)[0]
    off = np.c_[rest, np.ones(len(rest))] @ affine - result.positions
    # Newton leaves 1e-8 of what holds it, of a body that grew by 3 mm.
    assert np.abs(off).max() < 1e-6 * 3 * mm
    assert np.abs(affine[:3] - np.eye(3)).max() > 0.03


def test_a_bar_with_a_layer_and_a_spring_sags_alike():
    """Voxels bend right from one across, so that the sizes differ by little."""
    sheet = vs.Layer(region=vs.Region(z=(0, 0)), young="1 MPa", thickness="0.2 mm")
    end = vs.Probe(x=(60 * mm, 60 * mm))
    tie = vs.Spring(at=end, anchor=(60 * mm, 5 * mm, 50 * mm), stiffness="0.5 N/m")
    bar = vs.Design(
        name="bar",
        voxel_size=5 * mm,
        parts=[
            vs.Part(
                shape=vs.Box(size=(60 * mm, 10 * mm, 10 * mm), corner=(0, 0, 0)), material=RUBBER
            )
        ],
        layers=[sheet],
        springs=[tie],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[vs.Gravity()],
        probes={"end": end},
    )
    part = bar.replace(refine=[Refinement(region=vs.Region(x=(0, 20 * mm)))])
    assert len(Setup.of(part).large_voxels) > 4
    found, expected = vs.simulate(part), vs.simulate(bar, refine=2)
    # Large voxels everywhere are 0.8 % off, these 0.03 %.
    assert found.probes["end"][2] == pytest.approx(expected.probes["end"][2], rel=0.01)


@pytest.mark.slow
def test_a_path_and_both_other_controls_meet_the_same_state(both):
    design = both.design
    path = vs.follow(design, "loads[0].value=0..10 kPa/2", error="off")
    assert path.results[-1].cavity_volumes[0] == pytest.approx(both.cavity_volumes[0], rel=1e-6)
    arc = vs.simulate(design, control="arc-length")
    assert arc.cavity_volumes[0] == pytest.approx(both.cavity_volumes[0], rel=1e-6)
