"""Designs whose body is the mesh of a file: its parts, regions and cavities."""

import json
import pickle
import shutil

import numpy as np
import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import Body, FileMesh, families
from voxsoft.design.discretization.discretize import mesh_of, voxels_of
from voxsoft.errors import DesignError
from voxsoft.files import load, read_mesh, save, write_mesh
from voxsoft.simulation.setup.setup import Setup
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.smooth import pack_smooth
from voxsoft.voxels import Voxels

SOFT, STIFF = (
    {"model": "lattice", "edge": f"{edge} kPa", "bulk": "20 kPa"} for edge in ("24", "240")
)


@pytest.fixture
def folder(tmp_path):
    """A bar of 40 x 10 x 10 mm in mm, its second half of another part, and its design."""
    cells = np.ones((8, 2, 2), np.uint8)
    cells[4:] = 2
    mesh = Voxels.from_array(cells, 5.0).mesh()
    x = mesh.vertices[:, 0]
    ends = {"FIX": np.flatnonzero(x == 0), "TIP": np.flatnonzero(x == 40)}
    for suffix in (".msh", ".inp", ".vtu"):
        write_mesh(tmp_path / f"bar{suffix}", mesh, regions=ends)
    (tmp_path / "bar.toml").write_text(
        """
        name = "bar"
        mesh = { path = "bar.msh", unit = "mm" }
        probes = { tip = { name = "TIP" } }
        clamps = [{ region = { name = "FIX" } }]
        [[parts]]
        shape = "part-2"
        material = { model = "lattice", edge = "240 kPa", bulk = "20 kPa" }
        [[parts]]
        shape = "all"
        material = { model = "lattice", edge = "24 kPa", bulk = "20 kPa" }
        [[loads]]
        kind = "force"
        region = { name = "TIP" }
        value = [0, 0, "-5 mN"]
        """
    )
    return tmp_path


@pytest.fixture
def design(folder):
    return load(folder / "bar.toml")


def like(design):
    """The design in Python, with shapes that nobody asks for and a mesh beside it."""
    box = vs.Box(size=(1, 1, 1))
    mesh = mesh_of(design)
    return Setup(
        vs.Design(
            name="bar",
            voxel_size=0.005,
            parts=[{"shape": box, "material": STIFF}, {"shape": box, "material": SOFT}],
            clamps=[{"region": {"x": (0, 0)}}],
            loads=[{"kind": "force", "region": {"x": (0.04, 0.04)}, "value": (0, 0, -0.005)}],
            probes={"tip": {"x": (0.04, 0.04)}},
        ),
        mesh,
    )


def test_parts_take_the_tetrahedra_that_the_file_gives_them(design):
    mesh = mesh_of(design)
    middle = mesh.vertices[mesh.tets].mean(axis=1)[:, 0]
    np.testing.assert_array_equal(mesh.tet_part, np.where(middle > 0.02, 1, 2))
    assert mesh.volume == pytest.approx(4e-6, rel=1e-12)


@pytest.mark.parametrize("suffix", [".msh", ".inp", ".vtu"])
def test_every_format_gives_one_body(design, folder, suffix):
    other = design.replace(mesh=FileMesh(path=folder / f"bar{suffix}", unit="mm"))
    assert mesh_of(other) == mesh_of(design)


def test_regions_of_the_file_clamp_load_and_probe_as_their_planes_do(design):
    tip = vs.simulate(design).probes["tip"]
    assert tip[2] < -1e-3
    np.testing.assert_array_equal(tip, vs.simulate(like(design)).probes["tip"])


def test_a_region_is_exactly_its_vertices_and_may_be_narrowed(design):
    low = design.with_values("clamps[0].region={name='FIX', z=['-1 mm', '1 mm']}")
    setup = Setup.of(low)
    assert len(setup.clamped[0]) == 3
    assert np.ptp(setup.mesh.vertices[setup.clamped[0]][:, 2]) == 0.0


def test_a_design_is_read_back_as_it_is_written(design):
    again = vs.Design.from_document(design.document)
    assert again == design
    assert again.hash == design.hash
    assert vs.Design.from_document(design.resolved) == design
    assert "voxel_size" not in design.to_toml(resolved=True)


def test_the_content_of_the_file_is_part_of_the_hash(design, folder):
    shutil.copy(folder / "bar.msh", folder / "copy.msh")
    copied = design.replace(mesh=FileMesh(path=folder / "copy.msh", unit="mm"))
    assert copied.hash == design.hash
    mesh = read_mesh(folder / "bar.msh")
    write_mesh(
        folder / "copy.msh", type(mesh).from_tets(2 * mesh.vertices, mesh.tets, mesh.tet_part)
    )
    assert load(folder / "bar.toml").replace(mesh=copied.mesh, clamps=[], loads=[], probes={}).hash
    assert copied.hash != design.hash


@pytest.mark.parametrize(
    ("change", "where", "what"),
    [
        ({"voxel_size": "1 mm"}, "voxel_size", "needs voxels"),
        ({"fill": "fraction"}, "fill", "needs voxels"),
        ({"symmetry": [{"plane": "y"}]}, "symmetry", "needs voxels"),
        ({"refine": [{"region": {"x": (0, 0.01)}}]}, "refine", "needs voxels"),
        (
            {"layers": [{"region": {"z": (0, 0)}, "young": 1e6, "thickness": 1e-4}]},
            "layers",
            "needs voxels",
        ),
        ({"clamps": [{"region": {"name": "FIXX"}}]}, "clamps[0].region.name", "has no region"),
        ({"parts": [{"shape": "part-1", "material": SOFT}]}, "parts", 'the part "part-2"'),
        ({"parts": [{"shape": "art-1", "material": SOFT}]}, "parts[0].shape", "has no part"),
        (
            {"parts": [{"shape": "all", "material": "ecoflex-00-30"}]},
            "parts[0].material",
            "solved on voxels",
        ),
        (
            {"parts": [{"shape": name, "material": SOFT} for name in ("all", "part-1")]},
            "parts[1].shape",
            "nothing is left",
        ),
        ({"mesh": {"path": "none.msh", "unit": "mm"}}, "mesh.path", "No such file"),
    ],
)
def test_entries_impossible_with_a_mesh_are_refused_with_the_cause(design, change, where, what):
    with pytest.raises(DesignError) as caught:
        design.replace(**change)
    first = caught.value.problems[0]
    assert first.where == where
    assert what in first.what
    assert first.hint


def test_a_mesh_is_asked_for_its_unit_with_the_sizes_it_would_have(design, folder):
    with pytest.raises(DesignError, match=r"span 40 × 10 × 10.*mm: 40 mm long.*m: 40 m long") as e:
        design.replace(mesh={"path": str(folder / "bar.msh")})
    assert e.value.problems[0].where == "mesh.unit"


@pytest.mark.parametrize(("unit", "size"), [("m", "40 m"), ("um", "40 um")])
def test_a_body_of_a_doubtful_size_is_asked_about(design, folder, unit, size):
    other = design.replace(mesh={"path": str(folder / "bar.msh"), "unit": unit})
    found = [str(each) for each in vs.check(other).findings if "the body is" in each.what]
    assert found
    assert f"the body is {size.replace('um', 'µm')} long" in found[0].replace("um", "µm")
    assert f"bar.msh is read in {unit}" in found[0]


def test_a_region_of_a_file_needs_a_file():
    with pytest.raises(DesignError, match=r"clamps\[0\].region.name: is for regions of a mesh"):
        families.beam().replace(clamps=[{"region": {"name": "FIX"}}])


def test_voxels_and_several_bodies_name_the_mesh_as_the_cause(design):
    with pytest.raises(DesignError, match="it has no voxels"):
        voxels_of(design)
    with pytest.raises(DesignError, match="several bodies need voxels"):
        vs.Design(name="two", voxel_size=0.001, bodies=[Body(name="a", design=design)])
    with pytest.raises(DesignError, match="refine the mesh where it was made"):
        mesh_of(design, refine=2)


def test_cavities_are_those_that_the_surface_encloses(tmp_path):
    cells = np.ones((5, 5, 5), bool)
    cells[1:4, 1:4, 1:4] = False
    mesh = Voxels.from_array(cells, 2.0).mesh()
    inner = np.unique(mesh.cavities[0].triangles)
    write_mesh(tmp_path / "box.msh", mesh, regions={"ROOM": inner})
    design = vs.Design(
        name="box",
        mesh={"path": str(tmp_path / "box.msh"), "unit": "mm"},
        parts=[{"shape": "all", "material": SOFT}],
        chambers={"room": {"name": "ROOM"}},
        clamps=[{"region": {"z": (0, 0)}}],
        loads=[{"kind": "pressure", "cavity": "room", "value": 100.0}],
    )
    report = vs.check(design)
    assert report.valid
    assert report.chambers == ("room",)
    assert report.cavities[0].volume == pytest.approx(216e-9, rel=1e-12)
    assert vs.simulate(design).metrics["cavity_volume_change"] > 0.0


def test_the_command_line_checks_runs_and_repeats_it_from_a_copy(folder, monkeypatch):
    monkeypatch.chdir(folder)
    run = CliRunner().invoke
    checked = json.loads(run(app, ["check", "bar.toml", "--json"]).stdout)
    assert checked["valid"]
    assert (checked["voxels"], checked["tets"]) == (0, 160)
    found = run(app, ["run", "bar.toml", "--out", "runs/bar", "--json"])
    assert found.exit_code == 0, found.output
    assert json.loads(found.stdout)["probes"]["tip"]["displacement"][2] < -1e-3
    copies = list((folder / "runs/bar/inputs").glob("bar-*.msh"))
    assert len(copies) == 1
    (folder / "bar.msh").unlink()
    assert load(folder / "runs/bar/design.toml").mesh.path == str(copies[0])
    again = run(app, ["again", "runs/bar"])
    assert "the same to the bit" in again.output


def test_the_studio_shows_and_checks_it(design):
    body = StudioBody.of(design, rev=1, topology=1)
    shown = body.event(body.report())
    assert body.refusal is None
    assert (shown.voxels, shown.tets) == (0, 160)
    assert [clamp.vertices for clamp in shown.clamps] == [9]
    assert [part.name for part in shown.parts] == ["part-2", "all"]
    assert pack_smooth(design, body.voxels, 1) is None


def of_voxels(folder, **changes):
    """The bar of rubber: its parts and regions as shapes, on voxels."""
    file = {"kind": "mesh", "path": str(folder / "bar.msh"), "unit": "mm"}
    return vs.Design(
        name="bar",
        voxel_size=0.005,
        shapes={
            "soft": {**file, "part": "part-1"},
            "stiff": {**file, "part": "part-2"},
            "end": {**file, "region": "FIX"},
        },
        parts=[
            {"shape": "soft", "material": "ecoflex-00-30"},
            {"shape": "stiff", "material": "dragon-skin-20"},
        ],
        clamps=[{"region": {"shape": "end"}}],
        loads=[{"kind": "gravity"}],
    ).replace(**changes)


def test_parts_of_a_file_fill_voxels(folder):
    array = voxels_of(of_voxels(folder)).array
    np.testing.assert_array_equal(
        array, np.repeat([1, 2], 4)[:, None, None].repeat(2, 1).repeat(2, 2)
    )


@pytest.mark.parametrize("voxel_size", [0.005, 0.0025])
def test_a_region_of_a_file_catches_the_vertices_near_it(folder, voxel_size):
    setup = Setup.of(of_voxels(folder, voxel_size=voxel_size))
    (clamped,) = setup.clamped
    assert len(clamped) == (0.01 / voxel_size + 1) ** 2
    assert not setup.mesh.vertices[clamped][:, 0].any()
    assert vs.simulate(of_voxels(folder)).status == "ok"


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"part": "part-3"}, 'bar.msh has no part "part-3"'),
        ({"region": "FUX"}, 'bar.msh has no region "FUX"'),
        ({"part": "part-1", "region": "FIX"}, "there is a part too"),
    ],
)
def test_a_part_or_region_that_the_file_has_not_is_refused(folder, change, problem):
    shape = {"kind": "mesh", "path": str(folder / "bar.msh"), "unit": "mm", **change}
    with pytest.raises(vs.VoxSoftError, match=problem):
        mesh_of(of_voxels(folder, shapes={**of_voxels(folder).shapes, "soft": shape}))


@pytest.mark.parametrize("unit", ["mm", "m", "inch"])
def test_a_body_of_a_file_is_saved_and_loaded_as_it_is(design, folder, unit):
    given = design.replace(mesh={"path": design.mesh.path, "unit": unit})
    save(given, folder / "again.toml")
    again = load(folder / "again.toml")
    assert again == given
    assert (again.hash, again.document) == (given.hash, given.document)
    assert again.clamps[0].region.name == "FIX"
    assert pickle.loads(pickle.dumps(given)) == given
    assert given.replace() == given
