"""Voxels that stay large beside refined ones, and their results."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Design, Refinement
from voxsoft.errors import DesignError
from voxsoft.simulation import Setup
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.outputs.html import page_of
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
    """Places along x at which large voxels begin, in voxels of 5 mm, each once."""
    setup = Setup.of(design)
    corners = setup.mesh.voxel_corners(setup.large_voxels[:, 0])
    places = setup.mesh.vertices[corners[:, 0], 0] / (5 * mm)
    assert np.allclose(places, np.rint(places))
    found, counts = np.unique(np.rint(places).astype(int), return_counts=True)
    assert set(counts) <= {4}
    return found.tolist()


def test_voxels_of_a_named_region_or_part_are_small():
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


BLOCK = {"kind": "box", "size": ["40 mm", "20 mm", "20 mm"], "corner": [0, "-10 mm", 0]}
SOFT = {"model": "neo-hookean", "young": "30 kPa", "poisson": 0.45, "density": "1070 kg/m^3"}
TENDON = {"through": [[0, 0, "14 mm"], ["40 mm", 0, "14 mm"]], "tension": "50 mN"}
PROFILE = {"axis": "z", "at": ["0 mm", "20 mm"], "factor": [0, 1]}
WOUND = {"axis": "x", "angle": "60 deg", "modulus": "0.2 MPa", "center": [0, 0, "10 mm"]}
HOLE = {"kind": "box", "size": ["20 mm", "10 mm", "10 mm"], "corner": ["10 mm", "-5 mm", "5 mm"]}
HOLLOW = {"outer": BLOCK, "hole": HOLE}
HOLLOW["whole"] = {"kind": "difference", "of": ["outer", "hole"]}
BORE = {"kind": "box", "size": ["40 mm", "10 mm", "10 mm"], "corner": [0, "-5 mm", "5 mm"]}
TUBE = {"outer": BLOCK, "bore": BORE}
TUBE["whole"] = {"kind": "difference", "of": ["outer", "bore"]}


def block(**changes):
    """A block of 8 x 4 x 4 voxels that sags."""
    return Design(
        **{
            "name": "block",
            "voxel_size": 5 * mm,
            "shapes": {"whole": BLOCK},
            "parts": [{"name": "soft", "shape": "whole", "material": SOFT}],
            "clamps": [{"region": {"x": [0, 0]}}],
            "loads": [{"kind": "gravity"}],
            "probes": {"tip": {"x": ["40 mm", "40 mm"]}},
            **changes,
        }
    )


def of_material(**changes):
    return [{"name": "soft", "shape": "whole", "material": {**SOFT, **changes}}]


@pytest.mark.long
@pytest.mark.parametrize(
    ("large_ones", "changes"),
    [
        (96, {"symmetry": [{"plane": "y"}]}),
        (20, {"floor": {"z": "-2 mm"}}),
        pytest.param(20, {"contact": {"friction": 0.2}}, marks=pytest.mark.slow),
        (72, {"tendons": [TENDON], "loads": []}),
        (0, {"parts": [{"shape": "whole", "material": "ecoflex-00-30-lattice"}]}),
        (0, {"parts": of_material(mullins={"r": 1.5, "m": "2 kPa", "beta": 0.1})}),
        (
            0,
            {
                "activations": [
                    {"part": "soft", "kind": "strain", "value": 0.01, "profile": PROFILE}
                ]
            },
        ),
        pytest.param(
            16,
            {
                "shapes": HOLLOW,
                "chambers": {"c": {"point": ["20 mm", 0, "10 mm"]}},
                "supplies": [{"chamber": "c", "kind": "volume", "value": "0.2 mL"}],
                "loads": [],
            },
            marks=pytest.mark.slow,
        ),
        (
            0,
            {
                "shapes": TUBE,
                "parts": [
                    {"name": "soft", "shape": "whole", "material": SOFT, "fibers": [WOUND]},
                ],
            },
        ),
    ],
    ids=[
        "symmetry",
        "floor",
        "contact",
        "tendons",
        "lattice",
        "softening",
        "profile",
        "supplies",
        "wound",
    ],
)
def test_refined_voxels_at_the_root_replace_uniformly_small_ones(large_ones, changes):
    found = {}
    for name, refine in (("none", []), ("root", [x(0, 5)]), ("all", [x(-1, 41)])):
        setup = Setup.of(block(**changes, refine=refine))
        result = vs.simulate(setup)
        assert result.status == "ok"
        found[name] = np.array(result.probes["tip"]), setup.large_count
    everywhere, count = found["all"]
    root, left = found["root"]
    assert (count, left) == (0, large_ones)
    off = np.linalg.norm(found["none"][0] - everywhere)
    # Large voxels within a block that only bends are right by themselves, to a thousandth.
    assert np.linalg.norm(root - everywhere) < max(0.6 * off, 1e-3 * np.linalg.norm(everywhere))
    if left == 0:
        assert np.allclose(root, everywhere, rtol=1e-9)


def test_small_voxels_of_one_body_of_two():
    part = {"shape": {**BLOCK, "corner": [0, "-10 mm", "30 mm"]}, "material": SOFT}
    turned = {"axis": [0, 0, 1], "angle": "30 deg"}
    two = block(
        bodies=[{"name": "main"}, {"name": "other", "parts": [part], "rotation": turned}],
        parts=[{"name": "soft", "body": "main", "shape": "whole", "material": SOFT}],
        clamps=[{"region": {"x": [0, 0], "body": name}} for name in ("main", "other")],
        probes={name: {"x": ["40 mm", "40 mm"], "body": name} for name in ("main", "other")},
        refine=[Refinement(region=vs.Region(x=(-1, 1), body="main"))],
    )
    setup = Setup.of(two)
    assert setup.large_count == 24  # the inner voxels of the other one
    found, every = vs.simulate(setup), vs.simulate(two.replace(refine=()), refine=2)
    assert np.allclose(found.probes["main"], every.probes["main"], rtol=1e-6)
    off = abs(found.probes["other"][2] / every.probes["other"][2] - 1.0)
    assert 1e-5 < off < 2e-3


@pytest.mark.slow
def test_uses_of_one_size_take_small_voxels_everywhere():
    design = bar([x(0, 0)], probes={"end": {"x": ["40 mm", "40 mm"]}})
    every = design.replace(refine=(), solver={"refine": 2})
    assert len(vs.Simulator(design).state.positions) == len(vs.Simulator(every).state.positions)
    for settings in ({"end_time": 0.02}, {"method": "relaxation"}):
        found, expected = vs.simulate(design, **settings), vs.simulate(every, **settings)
        assert np.array_equal(found.positions, expected.positions)
        assert found.probes["end"][2] < 0.0
    assert page_of(design).text.count("<html") == 1
    assert StudioBody.of(design, 0, 0).not_live == ""
