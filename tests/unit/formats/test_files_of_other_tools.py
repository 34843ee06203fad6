"""Files of other tools: each is read as its table says, as a mesh and as a surface alike."""

import tomllib
from pathlib import Path

import meshio
import numpy as np
import pytest

from voxsoft.errors import FileError, MeshError, ShapeError, UnitError
from voxsoft.files.meshes import read_mesh_file, write_mesh
from voxsoft.formats.contents import CellBlock, Contents
from voxsoft.formats.read import read_contents
from voxsoft.formats.report import held_by
from voxsoft.formats.split import tets_of
from voxsoft.mesh import Mesh
from voxsoft.shapes.surface_files import read_surface

FOLDER = Path(__file__).parents[2] / "data" / "files"
TABLE = tomllib.loads((FOLDER / "manifest.toml").read_text(encoding="utf-8"))["file"]
#: Rounding of text of 16 digits and sums of some tens of tetrahedra; the table has 4 decimals.
ROUNDING = 1e-4
#: Rounding of a volume of three coordinates of 24 bits each, as STL and PLY have them.
SINGLE = 3 * 2.0**-24


def rows(key):
    return [pytest.param(row, id=row["name"]) for row in TABLE if key in row]


def volume_within(path):
    surface = read_surface(path)
    a, b, c = (surface.points[surface.triangles[:, corner]] for corner in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def test_the_table_is_whole():
    listed = {row["name"] for row in TABLE}
    others = {"make.py", "make_vtk.py", "manifest.toml", "nodes.inc"}
    there = {path.name for path in FOLDER.iterdir()} - others
    assert there == listed
    assert all((FOLDER / name).stat().st_size < 20_000 for name in there)


@pytest.mark.parametrize("row", rows("read"))
def test_a_file_is_read_whole_or_the_difference_is_reported(row):
    path, expected = FOLDER / row["name"], row.get("read", {})
    found = read_mesh_file(path, unit="mm")
    report = found.report
    assert report.held["cells"] == row["holds"]
    assert found.mesh.volume * 1e9 == pytest.approx(expected["volume"], abs=ROUNDING)
    parts = {name: int((found.mesh.tet_part == n).sum()) for n, name in report.parts.items()}
    assert parts == expected["parts"]
    assert {name: len(v) for name, v in found.regions.items()} == expected["regions"]
    assert list(report.differences) == expected["differences"]
    assert len(np.unique(found.mesh.tets)) == len(found.mesh.vertices)
    assert found.mesh.quality.conforming


@pytest.mark.parametrize("row", rows("read"))
def test_a_file_is_one_body_as_a_mesh_and_as_a_surface(row):
    assert volume_within(FOLDER / row["name"]) == pytest.approx(row["read"]["volume"], abs=ROUNDING)


@pytest.mark.parametrize("row", rows("surface"))
def test_a_surface_is_read_whole_and_is_no_mesh(row):
    path, expected = FOLDER / row["name"], row["surface"]
    volume = pytest.approx(expected["volume"], abs=ROUNDING, rel=SINGLE)
    assert volume_within(path) == volume
    contents = read_contents(path)
    assert held_by(contents)["cells"] == row["holds"]
    assert {name: len(cells) for name, cells in contents.cell_sets.items()} == expected["sets"]
    assert list(contents.notes) == expected["notes"]
    with pytest.raises(FileError, match=r"holds (a surface|no volume cells)"):
        read_mesh_file(path, unit="mm")


@pytest.mark.parametrize("row", rows("refused"))
def test_a_file_that_cannot_be_followed_is_refused_with_its_cause(row):
    path = FOLDER / row["name"]
    place = r", line \d+" if path.suffix == ".inp" else ""
    with pytest.raises(FileError, match=rf"{row['name']}{place}") as caught:
        read_mesh_file(path, unit="mm")
    # Formats that are not known are followed by those that are.
    assert caught.value.what.partition("; known")[0] == row["refused"]
    assert caught.value.hint or path.suffix == ".inp"
    with pytest.raises(ShapeError, match=rf"{row['name']}{place}"):
        read_surface(path)


def test_instances_are_turned_after_they_are_moved():
    found = read_mesh_file(FOLDER / "turned-instance.inp", unit="m")
    # Moved to (0, 0, 70), then turned by 90 degrees about the y axis through (0, 0, 50).
    (tip,) = found.mesh.vertices[found.regions["TIP"]]
    np.testing.assert_allclose(tip, (20, 0, 50), atol=1e-12)


def test_elements_of_a_part_take_nodes_of_that_part():
    found = read_mesh_file(FOLDER / "two-parts.inp", unit="m")
    volumes = [found.mesh.tet_volumes[found.mesh.tet_part == part].sum() for part in (1, 2)]
    assert volumes == pytest.approx([1000 / 6, 250 / 6])
    assert found.report.parts == {1: "RUBBER", 2: "STEEL"}


def test_a_local_system_moves_and_turns_nodes():
    points = read_contents(FOLDER / "system.inp").points
    # Its origin lies at z = 5, its x along y, its y along -x; *SYSTEM without data ends it.
    np.testing.assert_allclose(
        points[[0, 1, 2, 4]], [(0, 0, 5), (0, 10, 5), (-10, 0, 5), (0, 0, 0)]
    )


@pytest.mark.parametrize("name", ["hybrid.inp", "gmsh-groups-4_1-text.msh", "gmsh-groups.mesh"])
def test_a_file_without_a_unit_is_asked_for_it(name):
    with pytest.raises(UnitError, match=r"not say its unit; .* give unit=, one of mm, cm"):
        read_mesh_file(FOLDER / name)


def test_a_file_that_says_its_unit_is_not_asked():
    found = read_mesh_file(FOLDER / "metric.inp")
    assert found.mesh.volume == pytest.approx(1e-6 / 6, rel=1e-12)
    given = read_mesh_file(FOLDER / "metric.inp", unit="cm")
    assert given.report.cautions == (
        "The file says 1 = 0.001 m; the given unit counts: 1 = 0.01 m",
    )


def test_an_unlikely_size_is_a_caution():
    cautions = read_mesh_file(FOLDER / "hybrid.inp", unit="m").report.cautions
    assert cautions == ("The body is 10 m long: is the unit right? In mm it would be 10 mm long",)
    assert read_mesh_file(FOLDER / "hybrid.inp", unit="mm").report.cautions == ()


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".inp"])
def test_written_files_say_their_unit(tmp_path, suffix):
    mesh = read_mesh_file(FOLDER / "gmsh-groups-4_1-text.msh", unit="mm").mesh
    write_mesh(tmp_path / f"again{suffix}", mesh)
    again = read_mesh_file(tmp_path / f"again{suffix}")
    assert again.report.meter == 1.0
    assert again.report.differences == () or suffix == ".vtu"
    assert again.mesh.volume == pytest.approx(2e-6, rel=1e-12)


@pytest.mark.parametrize("how", ["2_2-text", "2_2-binary", "4_1-text", "4_1-binary"])
def test_a_msh_file_that_is_cut_short_says_so(tmp_path, how):
    content = (FOLDER / f"gmsh-groups-{how}.msh").read_bytes()
    (tmp_path / "cut.msh").write_bytes(content[: int(0.8 * len(content))])
    with pytest.raises(FileError, match=r"is cut short: \$(Nodes|Elements) has no end"):
        read_mesh_file(tmp_path / "cut.msh", unit="mm")


def test_a_vertex_without_a_tet_is_refused():
    with pytest.raises(MeshError, match="vertices: 1 belong to no tet, the first is 4"):
        Mesh.from_tets([*np.eye(3), [0, 0, 0], [9, 9, 9]], [[3, 0, 1, 2]])


CUBE = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)


def test_bricks_in_any_numbering_are_cut_alike_on_both_sides():
    # Two bricks that share a face, their points in 40 random orders: conforming each time.
    random = np.random.default_rng(5)
    points = np.concatenate([CUBE, CUBE[4:] + np.array([0, 0, 1])])
    cells = np.array([[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]])
    for _ in range(40):
        order = random.permutation(12)
        moved = np.empty_like(points)
        moved[order] = points
        cut = tets_of(Contents(moved, (CellBlock("hexahedron", order[cells]),)), "two")
        mesh = Mesh.from_tets(moved, cut.tets)
        assert mesh.quality.conforming
        assert mesh.quality.euler_number == 1
        # Six tets of a sixth each: exact but for rounding.
        assert mesh.tet_volumes.min() == pytest.approx(1 / 6, rel=1e-14)
        assert mesh.surface_volume == pytest.approx(2, rel=1e-14)


@pytest.mark.parametrize("across", [False, True])
def test_tets_across_a_brick_face_are_refused(across):
    points = np.concatenate([CUBE, [[0.5, 0.5, 2.0]]])
    # The brick cuts its upper face from vertex 4 to 6.
    halves = ((4, 5, 7, 8), (5, 6, 7, 8)) if across else ((4, 5, 6, 8), (4, 6, 7, 8))
    blocks = (CellBlock("hexahedron", np.arange(8)[None]), CellBlock("tetra", np.array(halves)))
    contents = Contents(points, blocks)
    if across:
        with pytest.raises(FileError, match="1 quadrilateral face"):
            tets_of(contents, "house")
    else:
        mesh = Mesh.from_tets(points, tets_of(contents, "house").tets)
        assert mesh.volume == pytest.approx(1 + 1 / 3)
        assert mesh.quality.conforming


def test_folded_bricks_are_refused():
    points = CUBE.copy()
    points[6] = (-1.0, -1.0, -1.0)
    with pytest.raises(FileError, match="1 hexahedron, cut into tetrahedra, would overlap"):
        tets_of(Contents(points, (CellBlock("hexahedron", np.arange(8)[None]),)), "folded")


@pytest.mark.parametrize(
    ("name", "values", "parts"),
    [
        ("part", [0, 1], {1: "part 0", 2: "part 1"}),
        ("part", [3, 300], {1: "part 3", 2: "part 300"}),
        ("part", [2, 7], {2: "part 2", 7: "part 7"}),
        ("Material", [1.0, 2.0], {1: "Material 1", 2: "Material 2"}),
        ("gmsh:physical", [302, 301], {1: "gmsh:physical 301", 2: "gmsh:physical 302"}),
        ("material", [0.25, 0.5], {}),
        ("temperature", [1, 2], {}),
    ],
)
@pytest.mark.parametrize("suffix", [".vtu", ".vtk"])
def test_arrays_of_whole_numbers_are_parts_in_every_format(tmp_path, suffix, name, values, parts):
    points = np.concatenate([CUBE, [[0.5, 0.5, 2.0], [5, 5, 5]]])
    cells = [("hexahedron", [[*range(8)]]), ("pyramid", [[4, 5, 6, 7, 8]])]
    data = {name: [[values[0]], [values[1]]]}
    meshio.Mesh(points, cells, cell_data=data).write(tmp_path / f"house{suffix}")
    found = read_mesh_file(tmp_path / f"house{suffix}", unit="cm")
    assert found.report.parts == parts
    assert found.mesh.volume == pytest.approx((1 + 1 / 3) * 1e-6, rel=1e-12)
    assert "1 point that no volume cell uses: left out" in found.report.differences
    if parts:
        volumes = {n: found.mesh.tet_volumes[found.mesh.tet_part == n].sum() for n in parts}
        order = sorted(parts, reverse=values[0] > values[1])
        assert [volumes[n] for n in order] == pytest.approx([1e-6, 1e-6 / 3], rel=1e-12)


@pytest.mark.parametrize(
    ("named", "match"),
    [
        ("../secret.inc", "outside of the deck's folder"),
        ("absent.inc", "which is missing"),
        ("deck.inp", "include each other in a circle"),
    ],
)
def test_included_files_that_cannot_be_followed_are_named(tmp_path, named, match):
    (tmp_path / "secret.inc").write_text("*NODE\n1, 0, 0, 0\n")
    deck = tmp_path / "own" / "deck.inp"
    deck.parent.mkdir()
    deck.write_text(f"** A deck\n*INCLUDE, INPUT={named}\n")
    with pytest.raises(FileError, match=rf"deck.inp, line 2: \*INCLUDE.*{match}"):
        read_contents(deck)


def test_sets_that_differ_by_case_alone_are_written_apart(tmp_path):
    mesh = read_mesh_file(FOLDER / "hybrid.inp", unit="mm").mesh
    write_mesh(tmp_path / "a.inp", mesh, regions={"tip": [0], "Tip": [1]})
    # Abaqus and CalculiX would join sets that differ by case alone.
    lines = (tmp_path / "a.inp").read_text().upper().splitlines()
    assert len({line for line in lines if line.startswith("*NSET")}) == 2
    assert read_mesh_file(tmp_path / "a.inp").regions.keys() == {"tip", "Tip"}
