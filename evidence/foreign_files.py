"""Files that other programs write: volume, unit and parts by those programs, and as we read.

``python evidence/foreign_files.py [--json]``. Each file is written by the library of its format,
in several units, orders, encodings and arrangements, and handed to ``voxsoft check`` as a stranger
would. A row is the volume by its library, in mL, with the ratio of ours to it; rows after
it are the numbers of parts, where there are several. The volume of images is that of their labeled
voxels. A hundred files more, of Abaqus, Gmsh and VTK, lie in ``tests/data/files`` with their table.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import lib3mf
import meshio
import nibabel
import nrrd
import numpy as np
import tifffile
import trimesh

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

from voxsoft.files import read_mesh

#: Body: a bent block with a hole, about 40 mm long, in mm.
BODY = trimesh.creation.annulus(r_min=6.0, r_max=12.0, height=20.0)
BODY.apply_transform(trimesh.transformations.rotation_matrix(0.3, (1, 2, 3), (5, 0, 0)))
#: Second body beside it.
BLOCK = trimesh.creation.box((10.0, 8.0, 6.0))
BLOCK.apply_translation((40.0, 0.0, 0.0))
#: Units by the names of 3MF, in m.
UNITS = {
    "MicroMeter": 1e-6,
    "MilliMeter": 1e-3,
    "CentiMeter": 1e-2,
    "Inch": 0.0254,
    "Foot": 0.3048,
    "Meter": 1.0,
}


@dataclass(frozen=True)
class File:
    """File of another program, and what that program reports: mL, parts, and flags for us."""

    path: Path
    volume: float
    parts: int = 1
    flags: tuple[str, ...] = ()


def surfaces(folder: Path) -> Iterator[File]:
    """Files of triangles by trimesh, in mm unless their format says another."""
    volume = BODY.volume * 1e-3
    mm = ("--unit", "mm")
    for name, kind in (
        ("binary.stl", "stl"),
        ("text.stl", "stl_ascii"),
        ("plain.obj", "obj"),
        ("binary.ply", "ply"),
        ("plain.off", "off"),
    ):
        BODY.export(folder / name, file_type=kind)
        yield File(folder / name, volume, 1, mm)
    BODY.export(folder / "text.ply", encoding="ascii")
    yield File(folder / "text.ply", volume, 1, mm)
    inverted = BODY.copy()
    inverted.invert()
    inverted.export(folder / "inverted.stl")
    yield File(folder / "inverted.stl", volume, 1, mm)
    inch = BODY.copy()
    inch.apply_scale(1.0 / 25.4)
    inch.export(folder / "inch.stl")
    yield File(folder / "inch.stl", volume, 1, ("--unit", "inch"))
    both = trimesh.Scene({"ring": BODY, "block": BLOCK})
    both.export(folder / "groups.obj")
    yield File(folder / "groups.obj", volume + BLOCK.volume * 1e-3, 2, mm)
    # glTF is in m, with y up; trimesh writes coordinates as they are.
    meters = trimesh.Scene()
    for name, body in (("ring", BODY), ("block", BLOCK)):
        own = body.copy()
        own.apply_scale(1e-3)
        meters.add_geometry(own, node_name=name, geom_name=name)
    meters.export(folder / "scene.glb")
    yield File(folder / "scene.glb", volume + BLOCK.volume * 1e-3, 2)


def prints(folder: Path) -> Iterator[File]:
    """Files of 3MF by lib3mf: units, transforms, mirrors, components, objects without an item."""
    wrapper = lib3mf.get_wrapper()

    def mesh(model, body: trimesh.Trimesh, name: str, scale: float):
        made = model.AddMeshObject()
        made.SetName(name)
        points = [lib3mf.Position() for _ in body.vertices]
        for point, place in zip(points, body.vertices * scale, strict=True):
            point.Coordinates[:] = [float(each) for each in place]
        faces = [lib3mf.Triangle() for _ in body.faces]
        for face, corners in zip(faces, body.faces, strict=True):
            face.Indices[:] = [int(each) for each in corners]
        made.SetGeometry(points, faces)
        return made

    def placed(matrix: np.ndarray):
        found = lib3mf.Transform()
        for row in range(4):
            for column in range(3):
                found.Fields[row][column] = float(matrix[column, row])
        return found

    def write(model, name: str) -> Path:
        model.QueryWriter("3mf").WriteToFile(str(folder / name))
        return folder / name

    volume = BODY.volume * 1e-3
    for unit, meter in UNITS.items():
        model = wrapper.CreateModel()
        model.SetUnit(getattr(lib3mf.ModelUnit, unit))
        model.AddBuildItem(mesh(model, BODY, "ring", 1e-3 / meter), wrapper.GetIdentityTransform())
        # lib3mf writes six decimals: in meters a micrometer of the place is left.
        yield File(write(model, f"{unit}.3mf"), volume)
    for name, matrix, count in (
        ("turned", trimesh.transformations.rotation_matrix(0.7, (1, 1, 0)), 1),
        ("mirrored", np.diag([-1.0, 1.0, 1.0, 1.0]), 1),
        ("twice", trimesh.transformations.translation_matrix((50.0, 0.0, 0.0)), 2),
    ):
        model = wrapper.CreateModel()
        body = mesh(model, BODY, "ring", 1.0)
        model.AddBuildItem(body, placed(matrix))
        if count == 2:
            model.AddBuildItem(body, wrapper.GetIdentityTransform())
        # Two items of one object are one part.
        yield File(write(model, f"{name}.3mf"), count * volume)
    model = wrapper.CreateModel()
    group = model.AddComponentsObject()
    group.AddComponent(mesh(model, BODY, "ring", 1.0), wrapper.GetIdentityTransform())
    group.AddComponent(mesh(model, BLOCK, "block", 1.0), wrapper.GetIdentityTransform())
    model.AddBuildItem(group, wrapper.GetIdentityTransform())
    yield File(write(model, "components.3mf"), volume + BLOCK.volume * 1e-3, 2)
    model = wrapper.CreateModel()
    mesh(model, BLOCK, "spare", 1.0)
    model.AddBuildItem(mesh(model, BODY, "ring", 1.0), wrapper.GetIdentityTransform())
    yield File(write(model, "unplaced.3mf"), volume)


def labels() -> np.ndarray:
    """Labels of a body of two parts in a scan of 24 by 16 by 12 voxels."""
    found = np.zeros((24, 16, 12), np.uint8)
    found[3:21, 4:12, 2:10] = 1
    found[9:15, 4:12, 2:5] = 2
    return found


def images(folder: Path) -> Iterator[File]:
    """Label images by the libraries of NRRD, NIfTI, TIFF and NumPy."""
    values, steps = labels(), np.array([1.0, 1.25, 1.5])
    volume = float((values > 0).sum() * steps.prod()) * 1e-3
    for name, space, encoding, scale in (
        ("ras.nrrd", "right-anterior-superior", "raw", 1.0),
        ("lps.nrrd", "left-posterior-superior", "gzip", 1.0),
        ("micrometers.nrrd", "right-anterior-superior", "bzip2", 1e3),
    ):
        header = {
            "space": space,
            "space directions": np.diag(steps * scale),
            "space origin": [5.0, 6.0, 7.0],
            "space units": ["um" if scale > 1.0 else "mm"] * 3,
            "encoding": encoding,
        }
        nrrd.write(str(folder / name), values, header)
        yield File(folder / name, volume, 2)
    for name, unit, scale in (
        ("plain.nii", "mm", 1.0),
        ("packed.nii.gz", "mm", 1.0),
        ("meters.nii", "meter", 1e-3),
        ("micrometers.nii", "micron", 1e3),
    ):
        image = nibabel.Nifti1Image(values, np.diag([*steps * scale, 1.0]))
        image.header.set_xyzt_units(unit)
        nibabel.save(image, folder / name)
        yield File(folder / name, volume, 2)
    sheared = np.diag([*steps, 1.0])
    turned = trimesh.transformations.rotation_matrix(0.4, (0, 0, 1)) @ sheared
    image = nibabel.Nifti1Image(values, turned)
    image.header.set_xyzt_units("mm")
    nibabel.save(image, folder / "turned.nii")
    yield File(folder / "turned.nii", volume, 2)
    for name, unit, scale in (("imagej.tif", "mm", 1.0), ("micrometers.tif", "um", 1e3)):
        tifffile.imwrite(
            folder / name,
            values.transpose(2, 1, 0),
            imagej=True,
            resolution=(1.0 / (steps[0] * scale), 1.0 / (steps[1] * scale)),
            metadata={"spacing": steps[2] * scale, "unit": unit, "axes": "ZYX"},
        )
        yield File(folder / name, volume, 2)
    np.save(folder / "labels.npy", values)
    cubes = float((values > 0).sum()) * 8.0 * 1e-3
    yield File(folder / "labels.npy", cubes, 2, ("--voxel-size", "2 mm"))


def cells(folder: Path) -> Iterator[File]:
    """Files of bricks and tetrahedra by meshio, in mm."""
    grid = np.stack(np.meshgrid(*[np.arange(n) for n in (9, 4, 3)], indexing="ij"), axis=-1)
    points = grid.reshape(-1, 3) * np.array([5.0, 4.0, 3.0])
    number = np.arange(len(points)).reshape(9, 4, 3)
    corners = [
        (0, 0, 0),
        (1, 0, 0),
        (1, 1, 0),
        (0, 1, 0),
        (0, 0, 1),
        (1, 0, 1),
        (1, 1, 1),
        (0, 1, 1),
    ]
    bricks = np.stack(
        [number[i : i + 8, j : j + 3, k : k + 2].ravel() for i, j, k in corners], axis=1
    )
    volume = 40.0 * 12.0 * 6.0 * 1e-3
    mesh = meshio.Mesh(points, [("hexahedron", bricks)])
    for name, kind in (
        ("bricks.vtu", {}),
        ("bricks.vtk", {}),
        ("bricks.msh", {"file_format": "gmsh22"}),
        ("bricks-4.msh", {"file_format": "gmsh"}),
        ("bricks.inp", {}),
        ("bricks.mesh", {}),
    ):
        mesh.write(folder / name, **kind)
        yield File(folder / name, volume, 1, ("--unit", "mm"))


def read(file: File) -> tuple[float, int]:
    """Volume [mL] and number of parts that ``voxsoft check`` reports."""
    command = [sys.executable, "-m", "voxsoft", "check", str(file.path), "--json", *file.flags]
    # lib3mf leaves the locale of this process at C.
    done = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
    try:
        reported = json.loads(done.stdout)
        parts = reported["volumes"]["parts"]
        volume = sum(each["described"] for each in parts.values())
    except (ValueError, KeyError):
        raise SystemExit(f"{file.path.name}: {done.stdout}{done.stderr}") from None
    held = reported["file"]["held"]
    count = max(len(held["sets"]), 1)
    if "label" in held["arrays"]:
        unit = file.flags[-1] if file.flags else None
        count = len(np.unique(read_mesh(file.path, unit=unit).tet_part))
    return volume * 1e6, count


def main() -> None:
    """Write all files, read them, and print both sides."""
    report = Report("Files of other programs")
    worst = 0.0
    with TemporaryDirectory() as name:
        folder = Path(name)
        for kind in (surfaces, prints, images, cells):
            for file in kind(folder):
                volume, parts = read(file)
                worst = max(worst, abs(volume / file.volume - 1.0))
                report.add(file.path.name, file.volume, "mL", volume / file.volume)
                if file.parts > 1 or parts > 1:
                    report.add(f"{file.path.name}, parts", file.parts, "", parts / file.parts)
    report.add("largest difference of volumes", worst, "")
    report.show()


if __name__ == "__main__":
    main()
