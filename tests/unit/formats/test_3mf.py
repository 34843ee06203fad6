"""3MF: units, transforms, components, parts by name, and files that are refused by name."""

import zipfile

import numpy as np
import pytest
import trimesh
from typer.testing import CliRunner

from voxsoft.cli.app import app
from voxsoft.errors import FileError, ShapeError
from voxsoft.files import check_mesh, write_surfaces
from voxsoft.formats import threemf
from voxsoft.formats.read import read_contents
from voxsoft.formats.report import held_by
from voxsoft.shapes import TriangleMesh, voxelize

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
SCHEMAS = "http://schemas.microsoft.com/3dmanufacturing"
CUBE = trimesh.creation.box(bounds=((0, 0, 0), (1, 1, 1)))


def mesh_of(body=CUBE, more=lambda _: ""):
    """The text of a mesh; `more` gives further entries of a triangle by its number."""
    points = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in body.vertices)
    faces = "".join(
        f'<triangle v1="{a}" v2="{b}" v3="{c}"{more(n)}/>' for n, (a, b, c) in enumerate(body.faces)
    )
    return f"<mesh><vertices>{points}</vertices><triangles>{faces}</triangles></mesh>"


def thing(number, content=None, **entries):
    listed = "".join(f' {key}="{value}"' for key, value in entries.items())
    return f'<object id="{number}"{listed}>{content or mesh_of()}</object>'


def components(*each):
    listed = "".join(f'<component objectid="{n}"{transform(m)}/>' for n, m in each)
    return f"<components>{listed}</components>"


def transform(matrix):
    return "" if matrix is None else f' transform="{" ".join(map(str, matrix))}"'


def model(resources, *items, unit="millimeter", head=""):
    placed = "".join(f'<item objectid="{n}"{transform(m)}/>' for n, m in items)
    return (
        f'<?xml version="1.0"?><model unit="{unit}" xmlns="{CORE}"{head}>'
        f"<resources>{resources}</resources><build>{placed}</build></model>"
    )


def write(path, text, **others):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", text)
        for name, content in others.items():
            archive.writestr(name.replace("__", "/"), content)
    return path


def volume(contents, members=slice(None)):
    (block,) = contents.blocks
    a, b, c = contents.points[block.nodes[members]].transpose(1, 0, 2)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


MOVED = (1, 0, 0, 0, 1, 0, 0, 0, 1, 10, 20, 30)
TURNED = (0, 1, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0)
DOUBLED = (2, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0)
MIRRORED = (-1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0)


@pytest.mark.parametrize(
    ("unit", "meter"),
    [
        ("micron", 1e-6),
        ("millimeter", 1e-3),
        ("centimeter", 1e-2),
        ("inch", 0.0254),
        ("foot", 0.3048),
        ("meter", 1.0),
    ],
)
def test_the_unit_is_that_of_the_file(tmp_path, unit, meter):
    path = write(tmp_path / "a.3mf", model(thing(1), (1, None), unit=unit))
    assert read_contents(path).unit == meter
    low, high = TriangleMesh(path=str(path)).build().bounds()
    assert np.subtract(high, low) == pytest.approx(np.full(3, meter))


def test_millimeter_is_the_unit_of_a_model_that_says_none(tmp_path):
    text = model(thing(1), (1, None)).replace(' unit="millimeter"', "")
    assert read_contents(write(tmp_path / "a.3mf", text)).unit == 1e-3


def test_an_item_is_placed_by_rows_of_its_transform(tmp_path):
    path = write(tmp_path / "a.3mf", model(thing(1), (1, TURNED), (1, MOVED)))
    points = read_contents(path).points
    # x goes to y, and y to -x.
    assert points[:8].min(axis=0).tolist() == [-1, 0, 0]
    assert points[:8].max(axis=0).tolist() == [0, 1, 1]
    assert points[8:].min(axis=0).tolist() == [10, 20, 30]


def test_components_are_placed_first_and_their_object_after(tmp_path):
    inner = thing(2, components((1, MOVED)))
    outer = thing(3, components((2, DOUBLED), (1, None)))
    path = write(tmp_path / "a.3mf", model(thing(1) + inner + outer, (3, TURNED)))
    points = read_contents(path).points
    # Moved by (10, 20, 30), then doubled, then turned.
    assert points[:8].min(axis=0).tolist() == [-42, 20, 60]
    assert points[:8].max(axis=0).tolist() == [-40, 22, 62]
    assert points[8:].min(axis=0).tolist() == [-1, 0, 0]


@pytest.mark.parametrize("times", [1, 2])
def test_a_mirrored_body_stays_outward(tmp_path, times):
    half = thing(2, components((1, MIRRORED)))
    path = write(tmp_path / "a.3mf", model(thing(1) + half, (2, MIRRORED if times == 2 else None)))
    assert volume(read_contents(path)) == pytest.approx(1.0)


@pytest.mark.parametrize("kind", ["support", "solidsupport", "other", "surface"])
def test_supports_and_unplaced_objects_are_no_part(tmp_path, kind):
    things = thing(1, name="arm") + thing(2, type=kind) + thing(3, name="spare")
    path = write(tmp_path / "a.3mf", model(things, (1, None), (2, None)))
    found = read_contents(path)
    assert len(found.points) == 8
    assert found.notes == (
        f"1 object of type {kind}: no material of the body, left out",
        "1 object that no item places: left out",
    )


def test_objects_are_parts_by_their_names(tmp_path):
    things = (
        thing(1, name="skin") + thing(2, name="core") + thing(3, components((1, None), (2, MOVED)))
    )
    path = write(tmp_path / "a.3mf", model(things, (3, None), (1, DOUBLED)))
    found = read_contents(path)
    assert {name: len(cells) for name, cells in found.cell_sets.items()} == {"skin": 24, "core": 12}
    assert volume(found, found.cell_sets["skin"]) == pytest.approx(9.0)


def test_base_materials_and_colors_name_objects_without_a_name(tmp_path):
    bases = '<basematerials id="7"><base name="Soft" displaycolor="#FF0000"/>'
    bases += '<base name="Stiff" displaycolor="#00FF00"/></basematerials>'
    colors = '<m:colorgroup id="8"><m:color color="#0000FF"/></m:colorgroup>'
    things = thing(1, pid=7, pindex=1) + thing(2, mesh_of(more=lambda _: ' pid="7" p1="0"'))
    things += thing(3, pid=8, pindex=0)
    head = f' xmlns:m="{SCHEMAS}/material/2015/02"'
    text = model(bases + colors + things, (1, None), (2, MOVED), (3, DOUBLED), head=head)
    assert set(read_contents(write(tmp_path / "a.3mf", text)).cell_sets) == {
        "Soft",
        "Stiff",
        "#0000FF",
    }


def test_materials_divide_an_object_where_each_encloses_a_body(tmp_path):
    bases = '<basematerials id="7"><base name="Soft"/><base name="Stiff"/></basematerials>'
    two = trimesh.util.concatenate([CUBE, CUBE.copy().apply_translation((3, 0, 0))])
    split = thing(1, mesh_of(two, lambda n: f' pid="7" p1="{n // 12}"'), name="both")
    path = write(tmp_path / "a.3mf", model(bases + split, (1, None)))
    assert set(read_contents(path).cell_sets) == {"Soft", "Stiff"}
    painted = thing(1, mesh_of(more=lambda n: f' pid="7" p1="{n // 6}"'), name="both")
    path = write(tmp_path / "b.3mf", model(bases + painted, (1, None)))
    assert read_contents(path).cell_sets == {}


def test_objects_in_further_files_of_the_production_extension_are_read(tmp_path):
    head = f' xmlns:p="{SCHEMAS}/production/2015/06" requiredextensions="p"'
    inside = '<components><component p:path="/3D/Objects/a.model" objectid="5"/></components>'
    text = model(thing(1, inside, name="arm"), (1, MOVED), head=head)
    part = model(thing(5, name="finger"))
    path = write(tmp_path / "a.3mf", text, **{"3D__Objects__a.model": part})
    assert read_contents(path).points.min(axis=0).tolist() == [10, 20, 30]
    with pytest.raises(FileError, match=r"holds no 3D/Objects/a\.model"):
        read_contents(write(tmp_path / "b.3mf", text))


def test_the_model_is_found_by_the_relationships(tmp_path):
    relations = (
        '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        f'<Relationship Target="/other.model" Id="a" Type="{SCHEMAS}/2013/01/3dmodel"/>'
        "</Relationships>"
    )
    path = tmp_path / "a.3mf"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("_rels/.rels", relations)
        archive.writestr("other.model", model(thing(1), (1, None)))
    assert len(read_contents(path).points) == 8


BEAMS = f' xmlns:b="{SCHEMAS}/beamlattice/2017/02" requiredextensions="b"'
LATTICE = (
    '<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/></vertices><triangles/>'
    '<b:beamlattice minlength="0.1" radius="0.2"><b:beams><b:beam v1="0" v2="1"/></b:beams>'
    "</b:beamlattice></mesh>"
)
CYCLE = thing(1, components((2, None))) + thing(2, components((1, None)))
NESTED = thing(1) + "".join(thing(n, components(*[(n - 1, None)] * 4)) for n in range(2, 40))


@pytest.mark.parametrize(
    ("text", "match"),
    [
        (model(thing(1, LATTICE), (1, None), head=BEAMS), "lattice of beams alone"),
        (model(CYCLE, (1, None)), "a component of itself"),
        (model(NESTED, (39, None)), "places [0-9,]+ triangles; at most 20,000,000"),
        (model(thing(1), (9, None)), "object 9, which is missing"),
        (model(thing(1)), "its build has no items"),
        (model(thing(1, type="support"), (1, None)), "no solid: its placed objects are of type s"),
        (model(thing(1), (1, None), unit="yard"), "the unit 'yard'"),
        (model(thing(1), (1, MOVED[:9])), "a transform has 9 numbers"),
        (model(thing(1), (1, [0] * 12)), "makes an object flat"),
        (model(thing(1), (1, None)).replace('v1="0"', 'v1="80"', 1), "a vertex that is missing"),
        (model(thing(1), (1, None)).replace('x="0.0"', 'x="nan"', 1), "a coordinate is nan"),
        (
            model(thing(1), (1, None)).replace('x="0.0"', 'w="0.0"', 1),
            "in line 1 of its model: 'x'",
        ),
        (model(thing(1) + thing(1), (1, None)), "two objects 1"),
        (model(thing(1), (1, None))[:-20], "no XML"),
        ("<a/>", "no element <model>"),
        (
            model(
                thing(1),
                (1, None),
                head=f' xmlns:s="{SCHEMAS}/slice/2015/07" requiredextensions="s"',
            ),
            "requires the extension s of 3MF, slices",
        ),
        (
            model(
                thing(1),
                (1, None),
                head=f' xmlns:sc="{SCHEMAS}/securecontent/2019/04" requiredextensions="sc"',
            ),
            "encryption",
        ),
        (
            model(thing(1), (1, None)).replace(
                "<model", '<!DOCTYPE model [<!ENTITY a "aaaa">]><model'
            ),
            "has a document type",
        ),
    ],
)
def test_a_file_that_cannot_be_read_is_refused_with_its_reason(tmp_path, text, match):
    with pytest.raises(FileError, match=match):
        read_contents(write(tmp_path / "a.3mf", text))


def test_nested_components_without_triangles_end_soon(tmp_path):
    hollow = thing(1, "<mesh><vertices/><triangles/></mesh>")
    nested = "".join(thing(n, components(*[(n - 1, None)] * 4)) for n in range(2, 60))
    with pytest.raises(FileError, match="holds no triangles"):
        read_contents(write(tmp_path / "a.3mf", model(hollow + nested, (59, None))))


def test_an_archive_that_unpacks_to_far_more_is_refused_unread(tmp_path, monkeypatch):
    monkeypatch.setattr(threemf, "_ANY_RATIO", 1000)
    text = model(thing(1), (1, None)) + " " * 3_000_000
    with pytest.raises(FileError, match=r"to 3,00[0-9,]+: it is no model"):
        read_contents(write(tmp_path / "a.3mf", text))


@pytest.mark.parametrize("content", [b"no archive", b"PK\x03\x04 cut"])
def test_other_files_are_no_archive(tmp_path, content):
    (tmp_path / "a.3mf").write_bytes(content)
    with pytest.raises(FileError, match="is no archive"):
        read_contents(tmp_path / "a.3mf")


def test_an_encrypted_archive_is_refused_by_name(tmp_path):
    path = write(tmp_path / "a.3mf", model(thing(1), (1, None)))
    data = bytearray(path.read_bytes())
    data[data.rindex(b"PK\x01\x02") + 8] |= 1  # the flag in the list of entries
    path.write_bytes(data)
    with pytest.raises(FileError, match=r"is encrypted: 3D/3dmodel\.model"):
        read_contents(path)


def two_boxes():
    made = [
        trimesh.creation.box(bounds=b) for b in (((0, 0, 0), (6, 4, 4)), ((6, 0, 0), (8, 4, 4)))
    ]
    return {
        name: (1e-3 * np.array(body.vertices), np.array(body.faces))
        for name, body in zip(("soft part", "tip"), made, strict=True)
    }


@pytest.mark.parametrize("suffix", [".3mf", ".stl", ".obj", ".glb"])
def test_parts_that_were_written_are_shapes_by_their_names(tmp_path, suffix):
    path = tmp_path / f"two{suffix}"
    write_surfaces(path, two_boxes())
    unit = None if suffix in (".3mf", ".glb") else "mm"
    name = "soft_part" if suffix == ".obj" else "soft part"
    one = TriangleMesh(path=str(path), unit=unit, part=name)
    whole = TriangleMesh(path=str(path), unit=unit)
    assert voxelize(one, 1e-3).count == 96
    assert voxelize(whole, 1e-3).count == 128
    with pytest.raises(ShapeError, match='has no part "tap"'):
        TriangleMesh(path=str(path), unit=unit, part="tap").build()


def test_a_file_that_says_no_unit_is_asked_for_it(tmp_path):
    write_surfaces(tmp_path / "two.stl", two_boxes())
    with pytest.raises(ShapeError, match="does not say its unit; its numbers span 8 × 4 × 4"):
        TriangleMesh(path=str(tmp_path / "two.stl")).build()


def test_check_takes_a_3mf_without_a_unit(tmp_path):
    write_surfaces(tmp_path / "two.3mf", two_boxes())
    found = check_mesh(tmp_path / "two.3mf", voxel_size="1 mm")
    assert found.volumes.parts["two.3mf"].simulated == pytest.approx(128e-9)
    assert found.file.format == "3MF"
    outcome = CliRunner().invoke(app, ["check", str(tmp_path / "two.3mf"), "--voxel-size", "1 mm"])
    assert outcome.exit_code == 0


def test_files_of_trimesh_are_read_at_their_places(tmp_path):
    pytest.importorskip("networkx")
    pytest.importorskip("lxml")
    scene = trimesh.Scene()
    turn = trimesh.transformations.rotation_matrix(0.7, (1, 2, 3), point=(4, 5, 6))
    for name, matrix in (("skin", np.eye(4)), ("core", turn)):
        scene.add_geometry(CUBE, node_name=name, geom_name=name, transform=matrix)
    scene.export(tmp_path / "a.3mf")
    found = read_contents(tmp_path / "a.3mf")
    assert found.points[8:] == pytest.approx(
        trimesh.transformations.transform_points(CUBE.vertices, turn), abs=1e-6
    )
    assert set(found.cell_sets) == {"skin", "core"}


def test_our_files_are_read_by_trimesh(tmp_path):
    pytest.importorskip("networkx")
    pytest.importorskip("lxml")
    write_surfaces(tmp_path / "a.3mf", two_boxes())
    bodies = trimesh.load_scene(tmp_path / "a.3mf").dump()
    assert sorted(body.volume for body in bodies) == pytest.approx([32.0, 96.0])


def test_files_of_lib3mf_are_read_at_their_places(tmp_path, lib3mf):
    wrapper = lib3mf.get_wrapper()
    made = wrapper.CreateModel()
    made.SetUnit(lib3mf.ModelUnit.Inch)
    body = made.AddMeshObject()
    body.SetName("arm")
    points = [lib3mf.Position((lib3mf.ctypes.c_float * 3)(*map(float, p))) for p in CUBE.vertices]
    faces = [lib3mf.Triangle((lib3mf.ctypes.c_uint32 * 3)(*map(int, f))) for f in CUBE.faces]
    body.SetGeometry(points, faces)
    made.AddBuildItem(body, wrapper.GetTranslationTransform(10.0, 20.0, 30.0))
    made.QueryWriter("3mf").WriteToFile(str(tmp_path / "a.3mf"))
    found = read_contents(tmp_path / "a.3mf")
    assert found.unit == 0.0254
    assert found.points.min(axis=0).tolist() == [10, 20, 30]
    assert held_by(found)["cells"] == {"triangle": 12}
