"""Layers: their faces, the chambers they close, and invalid ones."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.errors import DesignError
from voxsoft.geometry import enclosed_volume
from voxsoft.simulation import Setup, check, simulate
from voxsoft.simulation.setup.volumes import volumes_of
from voxsoft.units import GPa, kPa, mm

SOFT = vs.NeoHookean(young=60 * kPa, poisson=0.49)
SIZE = (14 * mm, 10 * mm, 8 * mm)
TURNS = {0: (2, 0, 1), 1: (1, 2, 0), 2: (0, 1, 2)}  # where x, y, z go so that z goes to the axis


def turned(values, axis):
    return tuple(values[i] for i in TURNS[axis])


def film(region, **changes):
    return vs.Layer(**{"region": region, "young": 1 * GPa, "thickness": 0.1 * mm} | changes)


def block(shape, layers, **changes):
    whole = {
        "name": "block",
        "voxel_size": 2 * mm,
        "parts": [vs.Part(shape=shape, material=SOFT)],
        "layers": layers,
        "clamps": [vs.Clamp(region=vs.Region(x=(0, 0)))],
        "loads": [vs.Gravity()],
    }
    return vs.Design(**(whole | changes))


def open_below(axis=2):
    """A block whose two chambers and the tunnel between them are open to one side."""
    body = vs.Box(size=turned(SIZE, axis))
    for size, corner in (
        ((2 * mm, 6 * mm, 6 * mm), (2 * mm, 2 * mm, 0)),
        ((4 * mm, 6 * mm, 4 * mm), (8 * mm, 2 * mm, 0)),
        ((4 * mm, 2 * mm, 2 * mm), (4 * mm, 4 * mm, 0)),
    ):
        body -= vs.Box(size=turned(size, axis), corner=turned(corner, axis))
    return body


#: Volume of the chambers above, m³.
CHAMBERS = (2 * 6 * 6 + 4 * 6 * 4 + 4 * 2 * 2) * mm**3


def plane(axis, height):
    return vs.Region(**{"xyz"[axis]: (height, height)})


def area(mesh, triangles):
    a, b, c = mesh.vertices[triangles].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0


@pytest.mark.parametrize("height", [0, 2 * mm, 8 * mm], ids=["below", "inside", "above"])
def test_a_plane_takes_the_faces_of_voxels_in_it(height):
    setup = Setup.of(block(vs.Box(size=SIZE), [film(vs.Region(z=(height, height)))]))
    triangles = setup.layers[0].bonded
    assert np.allclose(setup.mesh.vertices[triangles, 2], height)
    assert area(setup.mesh, triangles) == pytest.approx(SIZE[0] * SIZE[1])


def test_other_regions_take_the_surface():
    setup = Setup.of(block(vs.Box(size=SIZE), [film(vs.Region(x=("-inf", "inf")))]))
    assert np.array_equal(setup.layers[0].bonded, setup.mesh.triangles)


def test_a_layer_adds_its_mass():
    plain, layered = (
        Setup.of(block(vs.Box(size=SIZE), layers)).problem.mass
        for layers in ([], [film(vs.Region(z=(0, 0)), density=1300.0)])
    )
    assert layered - plain == pytest.approx(1300.0 * 0.1 * mm * SIZE[0] * SIZE[1])


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("refine", [1, 2])
def test_a_sealing_layer_closes_the_chambers(axis, refine):
    layers = [film(plane(axis, 0), seal=True)]
    clamp = vs.Clamp(region=plane((axis + 1) % 3, 0))
    load = vs.Pressure(value=1 * kPa)
    design = block(open_below(axis), layers, clamps=[clamp], loads=[load])
    setup = Setup.of(design, refine=refine)
    (cavity,) = setup.mesh.cavities
    assert cavity.volume == pytest.approx(CHAMBERS)
    # The triangles enclose that volume, so they are turned into the chamber everywhere.
    assert enclosed_volume(cavity.triangles, setup.mesh.vertices) == pytest.approx(CHAMBERS)
    # They are closed: a pressure has no resultant, up to rounding of 500 sums.
    closed = np.zeros_like(setup.mesh.vertices)
    a, b, c = setup.mesh.vertices[cavity.triangles].transpose(1, 0, 2)
    for corner in range(3):
        np.add.at(closed, cavity.triangles[:, corner], np.cross(b - a, c - a) / 6.0)
    assert np.abs(closed.sum(axis=0)).max() < 1e-12 * cavity.area
    # The film covers the whole face of the block.
    assert area(setup.mesh, setup.layers[0].all) == pytest.approx(SIZE[0] * SIZE[1])
    report = check(design)
    assert report.valid
    assert [found.volume for found in report.cavities] == [pytest.approx(CHAMBERS)]
    assert not report.leaks


def test_without_seal_the_chambers_stay_open():
    design = block(open_below(), [film(plane(2, 0))], loads=[vs.Pressure(value=1 * kPa)])
    with pytest.raises(DesignError, match="no enclosed cavity"):
        Setup.of(design)


def test_an_opening_in_the_side_stays_open():
    hole = vs.Box(size=(2 * mm, 2 * mm, 2 * mm), corner=(0, 4 * mm, 2 * mm))
    design = block(open_below() - hole, [film(plane(2, 0), seal=True)])
    assert Setup.of(design).mesh.cavities == ()


def test_a_film_between_two_chambers_bounds_both():
    chamber = vs.Box(size=(6 * mm, 6 * mm, 4 * mm), corner=(4 * mm, 2 * mm, 2 * mm))
    design = block(vs.Box(size=SIZE) - chamber, [film(plane(2, 4 * mm), seal=True)])
    mesh = Setup.of(design).mesh
    half = 6 * 6 * 2 * mm**3
    assert [cavity.volume for cavity in mesh.cavities] == [pytest.approx(half)] * 2
    for cavity in mesh.cavities:
        assert enclosed_volume(cavity.triangles, mesh.vertices) == pytest.approx(half)


def test_a_sealed_chamber_can_be_inflated():
    load = vs.Pressure(value=2 * kPa)
    layers = [film(plane(2, 0), seal=True, young=10e6)]
    result = simulate(block(open_below(), layers, loads=[load]))
    assert result.status == "ok"
    assert result.metric("cavity_volume_change") > 0.0


def test_chambers_that_layers_close_are_compared_with_no_shape():
    chamber = vs.Box(size=(2 * mm, 6 * mm, 2 * mm), corner=(10 * mm, 2 * mm, 4 * mm))
    open_chamber = vs.Box(size=(4 * mm, 6 * mm, 4 * mm), corner=(2 * mm, 2 * mm, 0))
    load = vs.Pressure(value=1 * kPa)
    design = block(
        vs.Box(size=SIZE) - chamber - open_chamber,
        [film(plane(2, 0), seal=True, young=10e6)],
        loads=[load],
    )
    result = simulate(design, error="off")
    own = [c.volume for c in result.mesh.cavities]
    assert own == pytest.approx([4 * 6 * 4 * mm**3, 2 * 6 * 2 * mm**3])
    volumes = result.summary()["volumes"]["cavities"]
    assert volumes.keys() == {"cavity 1"}
    assert volumes["cavity 1"]["described"] == pytest.approx(2 * 6 * 2 * mm**3)
    assert not [each for each in result.warnings if "in voxels" in each.what]


def test_halves_of_a_chamber_divided_by_a_film_have_no_shape_to_compare():
    chamber = vs.Box(size=(6 * mm, 6 * mm, 4 * mm), corner=(4 * mm, 2 * mm, 2 * mm))
    design = block(vs.Box(size=SIZE) - chamber, [film(plane(2, 4 * mm), seal=True)])
    volumes = volumes_of(design, Setup.of(design).mesh)
    assert not volumes.cavities
    assert len(volumes.parts) == 1


@pytest.mark.parametrize(
    ("region", "what"),
    [
        (vs.Region(z=(1.0, 1.0)), r"layers\[0\].region: touches nothing"),
        (vs.Region(x=(0, 0), y=(0, 0)), r"layers\[0\].region: holds no face"),
    ],
)
def test_a_layer_that_holds_no_face(region, what):
    design = block(vs.Box(size=SIZE), [film(region)])
    with pytest.raises(DesignError, match=what):
        simulate(design)
    assert not check(design).valid


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"thickness": -1 * mm}, "thickness: -1 mm is not positive"),
        ({"young": 0.0}, "young: 0 is not positive"),
        ({"poisson": 0.6}, "poisson: 0.6 is outside -1 to 0.5"),
        ({"seal": True}, "seal: a layer that closes openings must lie in a plane"),
    ],
)
def test_invalid_layers_are_refused(changes, what):
    with pytest.raises(DesignError, match=what):
        film(vs.Region(x=("-inf", "inf")), **changes)


@pytest.mark.parametrize("material", [SOFT, vs.Lattice(edge=60 * kPa, bulk=400 * kPa)], ids=str)
@pytest.mark.parametrize("way", [{"time_step": 5e-3}, {}], ids=["over time", "by relaxation"])
def test_every_way_leads_to_the_rest_of_statics(material, way):
    beam = vs.Box(size=(32 * mm, 8 * mm, 8 * mm))
    silk = film(vs.Region(z=(0, 0)), young=30e6)
    part = vs.Part(shape=beam, material=material)
    design = block(beam, [silk], voxel_size=4 * mm, parts=[part])
    still = simulate(design, method="statics")
    moved = simulate(design, method="xpbd", tolerance=1e-5, **way)
    bare = simulate(design.replace(layers=()), method="statics")
    assert (still.status, moved.status) == ("ok", "ok")
    assert moved.solver["way"] == ("dynamics" if way else "relaxation")

    def sag(result):
        return -(result.positions - result.mesh.vertices)[:, 2].min()

    # Tolerance of the solvers; the layer makes ten times that, or it would not be seen.
    assert sag(moved) == pytest.approx(sag(still), rel=1e-3)
    assert sag(bare) > 1.01 * sag(still)


def test_a_layer_survives_the_file(tmp_path):
    design = block(open_below(), [film(plane(2, 0), seal=True, name="silk")])
    design.save(tmp_path / "film.toml")
    assert vs.load(tmp_path / "film.toml").layers == design.layers
