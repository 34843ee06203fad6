"""Makes the files of Gmsh in this folder, by Gmsh itself; the decks beside them are typed by hand.

pip install gmsh && python tests/data/files/make.py
"""

from contextlib import chdir
from pathlib import Path

import gmsh

HERE = Path(__file__).parent


def two_boxes(size=10.0):
    """Two boxes side by side that share a face; return their volumes."""
    gmsh.model.add("two")
    first = gmsh.model.occ.addBox(0, 0, 0, size, size, size)
    second = gmsh.model.occ.addBox(size, 0, 0, size, size, size)
    gmsh.model.occ.fragment([(3, first)], [(3, second)])
    gmsh.model.occ.synchronize()
    return [tag for _, tag in gmsh.model.getEntities(3)]


def end_faces():
    """The faces at the lowest and highest x."""
    faces = gmsh.model.getEntities(2)
    center = {tag: gmsh.model.occ.getCenterOfMass(2, tag)[0] for _, tag in faces}
    return min(center, key=center.get), max(center, key=center.get)


def group(dimension, tags, number, name=""):
    gmsh.model.addPhysicalGroup(dimension, tags, number)
    if name:
        gmsh.model.setPhysicalName(dimension, number, name)


def save(name, version=4.1, binary=0, every=0, order=1):
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.option.setNumber("Mesh.SaveAll", every)
    gmsh.option.setNumber("Mesh.SaveGroupsOfNodes", 1)
    # Headings hold the path as it is given.
    with chdir(HERE):
        gmsh.write(name)
    print(name, order, (HERE / name).stat().st_size)


def named_groups():
    soft, stiff = two_boxes()
    low, high = end_faces()
    group(3, [soft], 301, "soft")
    group(3, [stiff], 302, "stiff rubber")
    group(2, [low], 7, "fix")
    group(2, [high], 8)
    gmsh.model.mesh.generate(3)
    for version in (2.2, 4.1):
        for binary in (0, 1):
            how = "binary" if binary else "text"
            save(f"gmsh-groups-{version:g}-{how}.msh".replace(".", "_", 1), version, binary)
    save("gmsh-groups.inp")
    save("gmsh-groups.mesh")
    save("gmsh-groups.vtk")


def overlapping_groups():
    soft, stiff = two_boxes()
    low, _ = end_faces()
    group(3, [soft, stiff], 1, "all")
    group(3, [stiff], 2, "stiff")
    group(2, [low], 3, "fix")
    group(2, [low], 4, "also fix")
    gmsh.model.mesh.generate(3)
    save("gmsh-overlap-2_2.msh", 2.2)
    save("gmsh-overlap-2_2-binary.msh", 2.2, 1)
    save("gmsh-overlap-4_1.msh")


def save_all():
    soft, _ = two_boxes()
    low, high = end_faces()
    group(3, [soft], 1, "soft")
    group(2, [low], 2, "low")
    group(2, [high], 3, "high")
    gmsh.model.mesh.generate(3)
    save("gmsh-save-all-4_1.msh", every=1)
    save("gmsh-save-all-2_2.msh", 2.2, every=1)


def no_groups():
    gmsh.model.add("arc")
    points = [gmsh.model.geo.addPoint(x, y, 0, 6) for x, y in ((5, 0), (0, 5), (-5, 0), (0, -5))]
    center = gmsh.model.geo.addPoint(0, 0, 0, 6)
    arcs = [gmsh.model.geo.addCircleArc(points[i], center, points[(i + 1) % 4]) for i in range(4)]
    disk = gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(arcs)])
    gmsh.model.geo.extrude([(2, disk)], 0, 0, 10)
    gmsh.model.geo.synchronize()
    gmsh.model.mesh.generate(3)
    save("gmsh-arcs-4_1.msh")
    save("gmsh-arcs-2_2.msh", 2.2)


def bricks(recombine, name):
    gmsh.model.add("bricks")
    face = gmsh.model.occ.addRectangle(0, 0, 0, 20, 10)
    gmsh.model.occ.extrude([(2, face)], 0, 0, 10, [2], recombine=True)
    gmsh.model.occ.synchronize()
    for _, curve in gmsh.model.getEntities(1):
        gmsh.model.mesh.setTransfiniteCurve(curve, 3)
    gmsh.model.mesh.setTransfiniteSurface(1)
    for _, surface in gmsh.model.getEntities(2):
        gmsh.model.mesh.setTransfiniteSurface(surface)
    if recombine:
        gmsh.model.mesh.setRecombine(2, 1)
    group(3, [1], 1, "block")
    gmsh.model.mesh.generate(3)
    save(f"{name}.msh")
    save(f"{name}.inp")


def quadratic():
    two_boxes()
    group(3, [1, 2], 1, "both")
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(2)
    save("gmsh-tetra10-4_1.msh")
    save("gmsh-tetra10.inp")


if __name__ == "__main__":
    for make in (
        named_groups,
        overlapping_groups,
        save_all,
        no_groups,
        lambda: bricks(True, "gmsh-bricks"),
        lambda: bricks(False, "gmsh-wedges"),
        quadratic,
    ):
        gmsh.initialize()
        gmsh.option.setNumber("General.Verbosity", 2)
        gmsh.option.setNumber("Mesh.MeshSizeMin", 10)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 10)
        make()
        gmsh.finalize()
