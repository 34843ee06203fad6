"""Which voxels stay large where others are refined, and who refuses local refinement."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Design, Refinement
from voxsoft.errors import DesignError, SimulationError
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.49, density=1070.0)


def bar(refine, **changes):
    """A bar of 8 x 2 x 2 voxels of 5 mm, the first half of another part."""
    left = {"kind": "box", "size": ["20 mm", "10 mm", "10 mm"], "corner": [0, 0, 0]}
    right = {**left, "corner": ["20 mm", 0, 0]}
    return Design(
        **{
            "name": "bar",
            "voxel_size": 5 * mm,
            "shapes": {"left": left, "right": right},
            "parts": [vs.Part(shape=name, material=RUBBER) for name in ("left", "right")],
            "clamps": [vs.Clamp(region=vs.Region(x=(0, 0)))],
            "loads": [vs.Gravity()],
            "refine": refine,
            **changes,
        }
    )


def x(low, high):
    return Refinement(region=vs.Region(x=(low * mm, high * mm)))


def large(design):
    """Where large voxels begin along x, in voxels of 5 mm, each once."""
    setup = Setup.of(design)
    corners = setup.mesh.voxel_corners(setup.large_voxels[:, 0])
    places = setup.mesh.vertices[corners[:, 0], 0] / (5 * mm)
    assert np.allclose(places, np.rint(places))
    found, counts = np.unique(np.rint(places).astype(int), return_counts=True)
    assert set(counts) <= {4}
    return found.tolist()


def test_what_the_region_or_the_part_names_is_small():
    assert large(bar([x(9, 11)])) == [0, 3, 4, 5, 6, 7]
    assert large(bar([x(0, 0), x(40, 40)])) == [1, 2, 3, 4, 5, 6]
    assert large(bar([Refinement(part="right")])) == [0, 1, 2, 3]
    both = Refinement(part="right", region=vs.Region(x=(0, 23 * mm)))
    assert large(bar([both])) == [0, 1, 2, 3, 5, 6, 7]


def test_regions_catch_within_half_a_small_voxel():
    assert large(bar([x(21.3, 23.7)])) == [0, 1, 2, 3, 5, 6, 7]
    assert large(bar([x(21.3, 23.8)])) == [0, 1, 2, 3, 6, 7]


def test_voxels_at_layers_and_springs_are_small():
    sheet = vs.Layer(region=vs.Region(z=(0, 0)), young="1 MPa", thickness="0.1 mm")
    layered = Setup.of(bar([x(0, 0)], layers=[sheet]))
    low = layered.mesh.voxel_corners(layered.large_voxels[:, 0])[:, 0]
    assert np.allclose(layered.mesh.vertices[low, 2], 5 * mm)
    tie = vs.Spring(
        at=vs.Probe(point=(31 * mm, 1 * mm, 1 * mm)), anchor=(31 * mm, 0, -1), stiffness=1.0
    )
    tied = Setup.of(bar([x(0, 0)], springs=[tie]))
    # Its small voxel has a face in that between two large ones.
    assert len(tied.large_voxels) == 7 * 4 - 2


def test_a_clamp_that_ends_within_a_large_voxel_makes_it_small():
    half = vs.Clamp(region=vs.Region(x=(0, 0), z=(0, 7.5 * mm)))
    setup = Setup.of(bar([x(40, 40)], clamps=[half]))
    low = setup.mesh.vertices[setup.mesh.voxel_corners(setup.large_voxels[:, 0])[:, 0]]
    beside = low[low[:, 0] == 0.0]
    assert len(beside) == 2
    assert np.all(beside[:, 2] == 0.0)
    assert vs.simulate(setup).status == "ok"


def test_cut_voxels_are_small():
    ball = Design(
        name="ball",
        voxel_size=5 * mm,
        fill="fraction",
        parts=[vs.Part(shape=vs.Sphere(radius=21 * mm), material=RUBBER)],
        clamps=[vs.Clamp(region=vs.Region(z=("-inf", -15 * mm)))],
        loads=[vs.Gravity()],
        refine=[Refinement(region=vs.Region(center=(0, 0, 0), radius=1 * mm))],
    )
    setup = Setup.of(ball)
    assert len(setup.large_voxels) > 50
    assert np.allclose(setup.mesh.fractions[setup.large_voxels], 1.0)


def test_nothing_is_caught():
    nowhere = r"refine\[0\].region: touches nothing"
    with pytest.raises(DesignError, match=nowhere):
        _ = Setup.of(bar([x(60, 70)])).problem
    other = Refinement(part="left", region=vs.Region(x=(30 * mm, 40 * mm)))
    with pytest.raises(DesignError, match=r"refine\[0\]: catches no voxel"):
        _ = Setup.of(bar([other])).problem
    with pytest.raises(DesignError, match=r'refine\[0\].part: there is no part "midle"'):
        bar([Refinement(part="midle")])


@pytest.mark.parametrize(
    "changes",
    [
        {"symmetry": [{"plane": "y", "at": 5 * mm}]},
        {"floor": {"z": -1.0}},
        {"contact": {}},
        {"tendons": [{"through": [[1e-3, 5e-3, 5e-3], [3e-2, 5e-3, 5e-3]], "tension": 0.1}]},
        {"parts": [vs.Part(shape="left", material="ecoflex-00-30-lattice")]},
        {
            "activations": [
                {
                    "part": "left",
                    "kind": "strain",
                    "value": 0.01,
                    "profile": {"expression": "x"},
                }
            ]
        },
    ],
    ids=lambda changes: next(iter(changes)),
)
def test_what_it_is_not_known_with_is_refused(changes):
    with pytest.raises((DesignError, SimulationError), match="refine"):
        vs.simulate(bar([x(0, 0)], **changes))


def test_who_does_not_know_it_says_so():
    design = bar([x(0, 0)])
    with pytest.raises(SimulationError, match="refine: is known to statics"):
        vs.simulate(design, method="xpbd", end_time=1.0)
    with pytest.raises(DesignError, match="not known to exported pages"):
        design.show()
    with pytest.raises(DesignError, match="several bodies"):
        Design(
            name="two",
            voxel_size=5 * mm,
            bodies=[{"name": "a", "design": bar([])}],
            refine=[x(0, 0)],
        )
