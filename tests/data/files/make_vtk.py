"""Makes the files of VTK, PyVista, trimesh, meshio and lib3mf in this folder, each by that program.

pip install pyvista==0.49.1 trimesh==5.2.0 meshio==5.3.5 lib3mf==2.5.0 networkx lxml
python tests/data/files/make_vtk.py

It prints the volume of each by its maker, which the table has.
"""

import re
from pathlib import Path

import lib3mf
import meshio
import numpy as np
import pyvista as pv
import trimesh
import vtk

HERE = Path(__file__).parent


def printed(name, volume):
    size = (HERE / name).stat().st_size
    print(f"{name:34} {volume:12.4f} {size:7,} bytes")


def mixed():
    """A brick, a pyramid upon it, a wedge beside it and a tetrahedron beside that."""
    corners = [[x, y, z] for z in (0, 10) for x, y in ((0, 0), (10, 0), (10, 10), (0, 10))]
    points = np.array([*corners, [5, 5, 16], [18, 0, 0], [18, 10, 0], [14, -5, 9]], float)
    cells = [
        (vtk.VTK_HEXAHEDRON, [0, 1, 2, 3, 4, 5, 6, 7]),
        (vtk.VTK_TETRA, [1, 9, 5, 11]),
        (vtk.VTK_PYRAMID, [4, 5, 6, 7, 8]),
        (vtk.VTK_WEDGE, [1, 5, 9, 2, 6, 10]),
    ]
    rows = np.concatenate([[len(nodes), *nodes] for _, nodes in cells])
    grid = pv.UnstructuredGrid(rows, [kind for kind, _ in cells], points)
    grid.cell_data["material"] = np.array([1, 1, 2, 2], np.int32)
    grid.cell_data["velocity"] = np.zeros((4, 3))
    grid.point_data["temperature"] = np.arange(len(points), dtype=float)
    return grid


def blocks():
    """Bricks of 10 x 10 x 5 mm, three, two and two: the labels of two bodies and of nothing."""
    image = pv.ImageData(dimensions=(4, 3, 3), spacing=(10, 10, 5), origin=(1, 2, 3))
    image.cell_data["label"] = np.array([1, 1, 0, 2, 2, 0, 1, 1, 0, 2, 2, 2], np.uint8)
    return image


def write_xml(name, data, mode="appended", compressor="", *, raw=True, bits=32, order="little"):
    kinds = {
        ".vtu": vtk.vtkXMLUnstructuredGridWriter,
        ".vtp": vtk.vtkXMLPolyDataWriter,
        ".vti": vtk.vtkXMLImageDataWriter,
        ".vts": vtk.vtkXMLStructuredGridWriter,
        ".vtr": vtk.vtkXMLRectilinearGridWriter,
        ".vtk": vtk.vtkXMLUnstructuredGridWriter,
    }
    writer = kinds[Path(name).suffix]()
    writer.SetFileName(str(HERE / name))
    writer.SetInputData(data)
    modes = {"ascii": writer.Ascii, "binary": writer.Binary, "appended": writer.Appended}
    writer.SetDataMode(modes[mode])
    kinds_of_compressor = {
        "": writer.NONE,
        "zlib": writer.ZLIB,
        "lzma": writer.LZMA,
        "lz4": writer.LZ4,
    }
    writer.SetCompressorType(kinds_of_compressor[compressor])
    writer.SetEncodeAppendedData(not raw)
    writer.SetHeaderType(writer.UInt64 if bits == 64 else writer.UInt32)
    writer.SetByteOrder(writer.BigEndian if order == "big" else writer.LittleEndian)
    # Several blocks of bytes in each array.
    writer.SetBlockSize(64)
    return writer


def xml(name, data, *how, volume=None, **settings):
    write_xml(name, data, *how, **settings).Write()
    printed(name, data.volume if volume is None else volume)


def legacy(name, data, version, *, is_text=False, volume=None):
    kinds = {
        pv.UnstructuredGrid: vtk.vtkUnstructuredGridWriter,
        pv.PolyData: vtk.vtkPolyDataWriter,
        pv.ImageData: vtk.vtkStructuredPointsWriter,
        pv.StructuredGrid: vtk.vtkStructuredGridWriter,
        pv.RectilinearGrid: vtk.vtkRectilinearGridWriter,
    }
    writer = kinds[type(data)]()
    writer.SetFileName(str(HERE / name))
    writer.SetInputData(data)
    writer.SetFileVersion(
        writer.VTK_LEGACY_READER_VERSION_4_2
        if version < 5
        else writer.VTK_LEGACY_READER_VERSION_5_1
    )
    writer.SetFileTypeToASCII() if is_text else writer.SetFileTypeToBinary()
    writer.Write()
    printed(name, data.volume if volume is None else volume)


def pieces(name, whole):
    """Write the cells of lower and higher x, as two processes have them, with ghosts in one."""
    x = whole.cell_centers().points[:, 0]
    found = []
    # Columns of bricks have their middles at 6, 16 and 26 mm; the second has ghosts of the middle.
    for chosen, own in ((x < 20, x < 20), (x > 10, x > 20)):
        part = whole.extract_cells(np.flatnonzero(chosen))
        part.clear_data()
        part.cell_data["label"] = whole.cell_data["label"][chosen]
        marks = np.where(own[chosen], 0, vtk.vtkDataSetAttributes.DUPLICATECELL)
        part.cell_data["vtkGhostType"] = marks.astype(np.uint8)
        write_xml(name, part, "ascii").Write()
        text = (HERE / name).read_text(encoding="utf-8")
        head, piece, foot = re.split(r"(<Piece.*</Piece>)", text, flags=re.DOTALL)
        found.append(piece)
    (HERE / name).write_text(head + "\n".join(found) + foot, encoding="utf-8")
    printed(name, whole.volume)


def unstructured():
    grid = mixed()
    xml("vtk-ascii.vtu", grid, "ascii")
    xml("vtk-base64.vtu", grid, "binary")
    xml("vtk-raw.vtu", grid)
    xml("vtk-appended-base64.vtu", grid, raw=False)
    xml("vtk-zlib-64.vtu", grid, "binary", "zlib", bits=64)
    for compressor in ("zlib", "lzma", "lz4"):
        xml(f"vtk-raw-{compressor}.vtu", grid, "appended", compressor)
    xml("vtk-base64-lz4.vtu", grid, "appended", "lz4", raw=False)
    xml("vtk-big-endian.vtu", grid, order="big")
    xml("vtk-xml-under-legacy.vtk", grid, "ascii")
    for version in (4.2, 5.1):
        number = f"{version:g}".replace(".", "_")
        legacy(f"vtk-mixed-{number}-text.vtk", grid, version, is_text=True)
        legacy(f"vtk-mixed-{number}-binary.vtk", grid, version)
    voxels = blocks().cast_to_unstructured_grid()
    assert set(voxels.celltypes) == {vtk.VTK_VOXEL}
    xml("vtk-voxels.vtu", voxels)
    legacy("vtk-voxels-5_1.vtk", voxels, 5.1)
    pieces("vtk-pieces.vtu", voxels)
    hidden = voxels.copy()
    marks = np.zeros(hidden.n_cells, np.uint8)
    marks[:2] = vtk.vtkDataSetAttributes.HIDDENCELL
    hidden.cell_data["vtkGhostType"] = marks
    xml("vtk-hidden-cells.vtu", hidden, volume=voxels.volume - 2 * 500)
    curved()


def curved():
    """Quadratic cells with straight edges, so that their corners have the whole volume."""
    ends = np.array([[0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, 10]], float)
    edges = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    points = np.concatenate([ends, [(ends[a] + ends[b]) / 2 for a, b in edges]])
    grid = pv.UnstructuredGrid(np.array([10, *range(10)]), [vtk.VTK_QUADRATIC_TETRA], points)
    xml("vtk-tetra10.vtu", grid, volume=1000 / 6)
    brick = vtk.vtkQuadraticHexahedron()
    places = np.array(brick.GetParametricCoords()[:60]).reshape(20, 3)
    grid = pv.UnstructuredGrid(
        np.array([20, *range(20)]), [vtk.VTK_QUADRATIC_HEXAHEDRON], 10 * places
    )
    legacy("vtk-hexahedron20-5_1.vtk", grid, 5.1, volume=1000)
    cube = pv.Cube(x_length=10, y_length=10, z_length=10).clean()
    faces = cube.regular_faces
    row = [len(faces), *(n for face in faces for n in (len(face), *face))]
    grid = pv.UnstructuredGrid(
        np.array([len(row), *row]), [vtk.VTK_POLYHEDRON], np.asarray(cube.points, float)
    )
    xml("vtk-polyhedron.vtu", grid, volume=1000)


def polygons():
    prism = pv.Cylinder(resolution=5, radius=10, height=20, direction=(0, 0, 1)).clean()
    prism = pv.PolyData(prism.points.astype(float), prism.faces)
    volume = prism.triangulate().volume
    xml("vtk-polygons.vtp", prism, volume=volume)
    xml("vtk-polygons-lz4.vtp", prism, "binary", "lz4", volume=volume)
    legacy("vtk-polygons-4_2.vtk", prism, 4.2, is_text=True, volume=volume)
    legacy("vtk-polygons-5_1.vtk", prism, 5.1, volume=volume)
    ball = pv.Sphere(radius=10, theta_resolution=8, phi_resolution=8).clean()
    strips = ball.strip()
    assert strips.n_strips
    xml("vtk-strips.vtp", strips, volume=ball.volume)
    legacy("vtk-strips-4_2.vtk", strips, 4.2, volume=ball.volume)
    for suffix in (".stl", ".ply", ".obj"):
        ball.save(HERE / f"pyvista-ball{suffix}")
        printed(f"pyvista-ball{suffix}", pv.read(HERE / f"pyvista-ball{suffix}").volume)


def grids():
    image = blocks()
    full = 500.0 * int((image.cell_data["label"] > 0).sum())
    xml("vtk-labels.vti", image, volume=full)
    xml("vtk-labels-zlib.vti", image, "binary", "zlib", volume=full)
    legacy("vtk-labels-5_1.vtk", image, 5.1, volume=full)
    legacy("vtk-labels-4_2.vtk", image, 4.2, is_text=True, volume=full)
    turned = blocks()
    turned.direction_matrix = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]], float)
    xml("vtk-labels-turned.vti", turned, volume=full)
    points = pv.ImageData(dimensions=(3, 2, 2), spacing=(10, 10, 5))
    points.point_data["segmentation"] = np.array([0, 3, 3, 0, 3, 3, 0, 0, 0, 0, 0, 7], np.int16)
    xml("vtk-labels-at-points.vti", points, volume=5 * 500.0)
    gray = pv.ImageData(dimensions=(4, 3, 3))
    gray.point_data["density"] = np.linspace(-0.1, 1, 36)
    xml("vtk-gray.vti", gray, volume=0)
    legacy("vtk-gray-5_1.vtk", gray, 5.1, volume=0)
    radii, angles, heights = np.meshgrid(
        [5.0, 10.0], np.linspace(0, np.pi / 2, 5), [0.0, 10.0], indexing="ij"
    )
    sector = pv.StructuredGrid(radii * np.cos(angles), radii * np.sin(angles), heights)
    xml("vtk-sector.vts", sector)
    legacy("vtk-sector-5_1.vtk", sector, 5.1)
    stretched = pv.RectilinearGrid([0.0, 1, 3, 7], [0.0, 5, 6], [0.0, 2])
    stretched.cell_data["region"] = np.array([1, 1, 2, 1, 1, 2], np.int8)
    xml("vtk-stretched.vtr", stretched)
    legacy("vtk-stretched-4_2.vtk", stretched, 4.2, is_text=True)


def lists():
    both = pv.MultiBlock({"left": mixed(), "right": pv.Sphere()})
    both.save(HERE / "vtk-blocks.vtm")
    for part in (HERE / "vtk-blocks").iterdir():
        part.unlink()
    (HERE / "vtk-blocks").rmdir()
    printed("vtk-blocks.vtm", 0)


def two_boxes():
    first = trimesh.creation.box((10, 10, 10))
    second = trimesh.creation.box((4, 4, 4))
    second.apply_translation((20, 0, 0))
    return first, second


def by_trimesh():
    body = trimesh.creation.annulus(r_min=5, r_max=10, height=10, sections=12)
    for name, settings in (
        ("trimesh-ring.stl", {}),
        ("trimesh-ring-text.stl", {"file_type": "stl_ascii"}),
        ("trimesh-ring.ply", {}),
        ("trimesh-ring-text.ply", {"encoding": "ascii"}),
        ("trimesh-ring.off", {}),
        ("trimesh-ring.obj", {}),
    ):
        body.export(HERE / name, **settings)
        printed(name, body.volume)
    first, second = two_boxes()
    scene = trimesh.Scene()
    scene.add_geometry(first, node_name="soft", geom_name="soft")
    turn = trimesh.transformations.rotation_matrix(0.3, (0, 1, 0))
    scene.add_geometry(second, node_name="stiff", geom_name="stiff", transform=turn)
    scene.export(HERE / "trimesh-scene.glb")
    printed("trimesh-scene.glb", first.volume + second.volume)
    scene.export(HERE / "trimesh-scene.obj")
    printed("trimesh-scene.obj", first.volume + second.volume)
    hollow = trimesh.creation.box((10, 10, 10))
    inner = trimesh.creation.box((6, 6, 6))
    inner.invert()
    hollow = trimesh.util.concatenate([hollow, inner])
    hollow.export(HERE / "trimesh-hollow.stl")
    printed("trimesh-hollow.stl", hollow.volume)


def by_meshio():
    grid = mixed()
    points = np.asarray(grid.points)
    names = {10: "tetra", 12: "hexahedron", 13: "wedge", 14: "pyramid"}
    blocks_ = [(names[kind], rows) for kind, rows in grid.cells_dict.items()]
    material = [np.array([1 + (kind > 12)]) for kind in grid.cells_dict]
    mesh = meshio.Mesh(points, blocks_, cell_data={"material": material})
    for suffix, kind in ((".bdf", "nastran"), (".su2", "su2"), (".avs", "avsucd")):
        meshio.write(HERE / f"meshio-mixed{suffix}", mesh, file_format=kind)
        printed(f"meshio-mixed{suffix}", grid.volume)
    meshio.write(HERE / "meshio-mixed.vtu", mesh)
    printed("meshio-mixed.vtu", grid.volume)
    medit = meshio.Mesh(points, [b for b in blocks_ if b[0] != "pyramid"])
    meshio.write(HERE / "meshio-three.mesh", medit)
    printed("meshio-three.mesh", grid.volume - grid.extract_cells([2]).volume)


def by_hand():
    """Cubes whose faces count vertices back from the last one, each cube's behind its own."""
    lines = ["# Two cubes, one group each"]
    ring = [(0, 0), (10, 0), (10, 10), (0, 10)]
    faces = [(4, 3, 2, 1), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8)]
    for number, name in enumerate(("left", "right")):
        lines += [f"v {x + 20 * number} {y} {z}" for z in (0, 10) for x, y in ring]
        lines += [f"g {name} both", f"usemtl rubber {number}"]
        lines += ["f " + " ".join(f"{corner - 9}//-1" for corner in face) for face in faces]
    # One line goes on in the next.
    lines[-1] = lines[-1].replace(" -4", " \\\n-4")
    (HERE / "hand-relative.obj").write_text("\n".join(lines) + "\n", encoding="utf-8")
    printed("hand-relative.obj", 2000)


def by_lib3mf():
    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    body = model.AddMeshObject()
    box = trimesh.creation.box((10, 10, 10))
    for place in box.vertices:
        position = lib3mf.Position()
        position.Coordinates[:] = place
        body.AddVertex(position)
    for face in box.faces:
        triangle = lib3mf.Triangle()
        triangle.Indices[:] = face
        body.AddTriangle(triangle)
    model.AddBuildItem(body, wrapper.GetIdentityTransform())
    model.QueryWriter("3mf").WriteToFile(str(HERE / "lib3mf-box.3mf"))
    printed("lib3mf-box.3mf", box.volume)


if __name__ == "__main__":
    unstructured()
    polygons()
    grids()
    lists()
    by_trimesh()
    by_meshio()
    by_hand()
    by_lib3mf()
