"""A part of a symmetric body, solved alone, is the whole body."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Layer, Symmetry
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.errors import DesignError
from voxsoft.simulation import Setup
from voxsoft.simulation.runs.symmetric_body import SectorSetup
from voxsoft.simulation.setup.freedom import free_motion
from voxsoft.units import kPa, mm

#: Both systems are solved to a residual of 1e-8, which Newton's last step squares.
SOLVED = 1e-10
#: Substeps go through the constraints one after the other, in an order that the mesh decides. Five
#: times in each they agree within 2e-7; once, within 3e-4.
IN_ORDER = 1e-6

RUBBER = vs.NeoHookean(young=100 * kPa, poisson=0.49)
BAR = vs.Design(
    name="bar",
    voxel_size=5 * mm,
    parts=[
        vs.Part(
            shape=vs.Box(size=(40 * mm, 10 * mm, 10 * mm), corner=(0, 5 * mm, 0)), material=RUBBER
        )
    ],
    clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
    loads=[vs.Gravity(), vs.Force(region=vs.Region(x=(40 * mm, 40 * mm)), value=(0.02, 0, 0))],
    probes={"side": vs.Probe(point=(40 * mm, 7 * mm, 0)), "end": vs.Probe(x=(40 * mm, 40 * mm))},
)
ALONG = [Symmetry(plane="y", at=10 * mm)]


def ball(fill: str, **more: object) -> vs.Design:
    """A thick ball under pressure that stands on its lower cap."""
    shape = vs.Sphere(radius=20 * mm) - vs.Sphere(radius=10 * mm)
    entries = {
        "voxel_size": 5 * mm,
        "parts": [vs.Part(shape=shape, material=RUBBER)],
        "clamps": [vs.Clamp(region=vs.Region(z=("-inf", -18 * mm)))],
        "loads": [vs.Pressure(value=10 * kPa)],
        "probes": {"top": vs.Probe(point=(0, 0, 20 * mm))},
    }
    return vs.Design(name="ball", fill=fill, **(entries | more))


def require_same(part: vs.Result, whole: vs.Result, within: float) -> None:
    """Everything that a result says, in parts of its largest entry."""
    assert (part.status, whole.status) == ("ok", "ok")
    assert part.solver["symmetry"]
    force = np.abs(whole.reactions).max()
    arm = np.abs(whole.mesh.vertices).max()
    moved = np.abs(whole.displacements).max()
    # Sums over the vertices of the whole, each as good as the state.
    many = len(whole.mesh.vertices)
    for name, size in (
        ("positions", moved),
        ("velocities", max(np.abs(whole.velocities).max(), moved)),
        ("reactions", force),
        ("reaction", many * force),
        ("reaction_moment", many * force * arm),
        ("load", many * force),
        ("load_moment", many * force * arm),
        ("elastic_energy", whole.elastic_energy),
        ("mass", whole.mass),
    ):
        mine, its = (np.asarray(getattr(each, name)) for each in (part, whole))
        assert np.abs(mine - its).max() <= within * size, name
    for name, records in whole.recording.probes.items():
        assert np.abs(part.recording.probes[name] - records).max(initial=0.0) <= within * moved
        assert np.abs(part.probes[name] - whole.probes[name]).max() <= within * moved
    assert np.allclose(part.cavity_volumes, whole.cavity_volumes, rtol=within, atol=0.0)


def test_half_a_bar_is_the_bar() -> None:
    require_same(vs.simulate(BAR.replace(symmetry=ALONG)), vs.simulate(BAR), SOLVED)


BY_VOLUME = {"control": "volume", "volume_ratio": 1.3, "steps": 3}


@pytest.mark.parametrize(
    ("fill", "control"),
    [
        ("binary", {}),
        ("fraction", BY_VOLUME),
        pytest.param("fraction", {}, marks=pytest.mark.slow),
        pytest.param("binary", BY_VOLUME, marks=pytest.mark.slow),
    ],
)
def test_a_quarter_of_a_chamber_is_the_chamber(fill: str, control: dict[str, object]) -> None:
    whole = ball(fill)
    quarter = whole.replace(symmetry=[Symmetry(plane="x"), Symmetry(plane="y")])
    require_same(vs.simulate(quarter, **control), vs.simulate(whole, **control), SOLVED)


def test_an_eighth_needs_no_clamp() -> None:
    planes = [Symmetry(plane=plane) for plane in "xyz"]
    middle = {axis: vs.Region(**{axis: (0, 0)}) for axis in "xyz"}
    held = [vs.Clamp(region=region, axes=axis) for axis, region in middle.items()]
    part = vs.simulate(ball("fraction", clamps=[], symmetry=planes))
    whole = vs.simulate(ball("fraction", clamps=held))
    assert part.solver["way"] == "load"
    assert np.abs(part.positions - whole.positions).max() <= SOLVED * 20 * mm
    assert np.abs(part.reactions).max() == 0.0


def test_half_a_bar_lies_on_its_floor() -> None:
    whole = BAR.replace(floor=vs.Floor(), loads=[vs.Gravity()])
    half = whole.replace(symmetry=ALONG)
    part, its = vs.simulate(half), vs.simulate(whole)
    require_same(part, its, SOLVED)
    # Without the floor the end hangs lower.
    assert vs.simulate(half.replace(floor=None)).probes["end"][2] < 2 * part.probes["end"][2]


def test_planes_hold_the_vertices_they_cut() -> None:
    planes = [Symmetry(plane=plane) for plane in "xyz"]
    free = ball("binary", clamps=[])
    assert free_motion(Setup(free, mesh_of(free)))
    for count, held in ((2, False), (3, True)):
        cut = free.replace(symmetry=planes[:count])
        part = SectorSetup.part_of(Setup(cut, mesh_of(cut)))
        assert part is not None
        assert bool(free_motion(part)) is not held


def test_half_a_bar_moves_as_the_bar_does() -> None:
    part = BAR.parts[0].replace(material="ecoflex-00-30-lattice")
    whole = BAR.replace(parts=[part])
    half = whole.replace(symmetry=ALONG)
    rest = {"method": "relaxation", "tolerance": 1e-9}
    require_same(vs.simulate(half, **rest), vs.simulate(whole, **rest), IN_ORDER)
    ways = {"end_time": 0.1, "frames": True, "iterations": 5}
    moving, its = vs.simulate(half, **ways), vs.simulate(whole, **ways)
    require_same(moving, its, IN_ORDER)
    off = np.abs(moving.recording.frames - its.recording.frames).max()
    assert off <= IN_ORDER * np.abs(its.displacements).max()


def test_a_layer_spans_an_opening_across_the_plane() -> None:
    """Mean of both ways to cut the opening, of which each alone is not symmetric."""
    tray = vs.Box(size=(40 * mm, 20 * mm, 15 * mm)) - vs.Box(
        size=(30 * mm, 10 * mm, 10 * mm), corner=(5 * mm, 5 * mm, 0)
    )
    film = {"region": vs.Region(z=(0, 0)), "young": "100 MPa"}
    sealed = BAR.replace(
        parts=[vs.Part(shape=tray, material=RUBBER)],
        loads=[vs.Pressure(value=2 * kPa)],
        layers=[Layer(**film, thickness="0.2 mm", seal=True)],
        probes={},
    )
    part = vs.simulate(sealed.replace(symmetry=ALONG))
    half = Layer(**film, thickness="0.1 mm")
    twice = Setup.of(sealed.replace(layers=[half.replace(seal=True), half]))
    one, other = twice.layers
    sector = Setup.of(sealed.replace(symmetry=ALONG)).sector
    assert sector is not None
    [image] = sector.images
    mirrored = image[one.spanning][:, ::-1].astype(np.int32)
    twice.__dict__["layers"] = (one, replace(other, spanning=mirrored))
    [chamber] = twice.mesh.cavities
    rim = set(map(frozenset, one.spanning.tolist()))
    spans = np.array([frozenset(each) in rim for each in chamber.other_triangles.tolist()])
    surface = np.concatenate([chamber.other_triangles[~spans], mirrored])
    cavities = (replace(chamber, other_triangles=surface),)
    object.__setattr__(twice, "mesh", replace(twice.mesh, cavities=cavities))
    whole = vs.simulate(twice)
    assert np.abs(part.positions - whole.positions).max() <= SOLVED * 40 * mm
    assert part.mass == pytest.approx(whole.mass, rel=1e-12)


def test_error_bars_are_those_of_the_whole() -> None:
    part, whole = (vs.error_bars(vs.simulate(each)) for each in (BAR.replace(symmetry=ALONG), BAR))
    assert part.voxels == whole.voxels
    for axis in (0, 2):
        mine, its = (bars.probes["end"][axis] for bars in (part, whole))
        assert (mine.estimate, mine.error) == pytest.approx((its.estimate, its.error), rel=1e-6)


LEFT = vs.Region(y=("-inf", 6 * mm))


@pytest.mark.parametrize(
    ("changes", "where", "what"),
    [
        ({"symmetry": [Symmetry(plane="y")]}, "symmetry[0]", "the body's middle is at 10 mm"),
        ({"symmetry": [Symmetry(plane="x", at=20 * mm)]}, "clamps[0]", "has no image across x"),
        ({"symmetry": [Symmetry(plane="z", at=5 * mm)]}, "loads[0]", "its acceleration points"),
        ({"clamps": [*BAR.clamps, vs.Clamp(region=LEFT)]}, "clamps[1]", "what it holds has no"),
        ({"loads": [vs.Force(region=LEFT, value=(0, 0, 1))]}, "loads[0]", "its force has no image"),
        (
            {"loads": [vs.Force(region=vs.Region(x=(40 * mm, 40 * mm)), value=(0, 1, 0))]},
            "loads[0]",
            "its force has no image across y",
        ),
        (
            {"loads": [vs.Traction(region=vs.Region(y=(5 * mm, 5 * mm)), value=1 * kPa)]},
            "loads[0]",
            "has no image across y",
        ),
        (
            {
                "layers": [
                    Layer(region=vs.Region(y=(5 * mm, 5 * mm)), young="1 MPa", thickness="1 mm")
                ]
            },
            "layers[0]",
            "the layer has no image across y",
        ),
        (
            {
                "layers": [
                    Layer(region=vs.Region(y=(10 * mm, 10 * mm)), young="1 MPa", thickness="1 mm")
                ]
            },
            "layers[0]",
            "lies in the plane of symmetry across y",
        ),
        (
            {
                "clamps": [
                    vs.Clamp(
                        region=vs.Region(x=(0, 0)),
                        motion=vs.Motion(rotation=vs.Rotation(axis=(1, 0, 0), angle="10 deg")),
                    )
                ]
            },
            "clamps[0]",
            "its motion has no image across y",
        ),
        (
            {
                "springs": [
                    vs.Spring(
                        at=vs.Probe(point=(0.04, 0.01, 0)), anchor=(0.04, 0.01, 1), stiffness=1
                    )
                ]
            },
            "springs[0]",
            "is not known together with planes of symmetry yet",
        ),
    ],
)
def test_asymmetric_designs_are_refused(changes: dict[str, object], where: str, what: str) -> None:
    with pytest.raises(vs.VoxSoftError) as caught:
        Setup.of(BAR.replace(**({"symmetry": ALONG} | changes)))
    assert what in str(caught.value)
    assert caught.value.problems[0].where == where


def test_a_part_and_a_fraction_need_an_image() -> None:
    for fill, off, what in (
        ("binary", 2 * mm, "has no image"),
        ("fraction", 0.3 * mm, "is not as full as its image"),
    ):
        whole = vs.Sphere(radius=10 * mm) - vs.Sphere(radius=4 * mm, center=(0, off, 0))
        body = ball(fill, parts=[vs.Part(shape=whole, material=RUBBER)], voxel_size=2.5 * mm)
        lone = body.replace(
            clamps=[vs.Clamp(region=vs.Region(z=("-inf", -8 * mm)))],
            probes={},
            symmetry=[Symmetry(plane="y")],
        )
        with pytest.raises(DesignError, match=what):
            Setup.of(lone)
    stiff = vs.Part(
        shape=vs.Box(size=(40 * mm, 5 * mm, 10 * mm), corner=(0, 5 * mm, 0)), material=RUBBER
    )
    with pytest.raises(DesignError, match="is of another part than its image"):
        Setup.of(BAR.replace(parts=[stiff, *BAR.parts], symmetry=ALONG))


def test_one_plane_for_each_axis() -> None:
    with pytest.raises(DesignError, match=r"symmetry\[1\].plane"):
        BAR.replace(symmetry=[*ALONG, *ALONG])
