#!/usr/bin/env bash
# meshio 5.3.5 and Gmsh 4.1: of two physical groups of one volume only the first is kept.
#
# Seen: Gmsh counts the tetrahedra of the groups "all" (two boxes) and "stiff" (one of them), meshio
# has no tetrahedron in "stiff". Exits 1 where that has changed. Gmsh's wheel needs libGLU and
# libXft of the system.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
  meshio==5.3.5 numpy==2.2.6 gmsh==4.15.2
cd "$folder"

venv/bin/python - <<'SCRIPT'
import sys

import gmsh
import meshio

gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 0)
gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
gmsh.model.occ.addBox(1, 0, 0, 1, 1, 1)
gmsh.model.occ.fragment([(3, 1)], [(3, 2)])
gmsh.model.occ.synchronize()
gmsh.model.addPhysicalGroup(3, [1, 2], 1, "all")
gmsh.model.addPhysicalGroup(3, [2], 2, "stiff")
gmsh.model.mesh.generate(3)
held = {}
for tag in (1, 2):
    entities = gmsh.model.getEntitiesForPhysicalGroup(3, tag)
    found = [gmsh.model.mesh.getElementsByType(4, entity)[0] for entity in entities]
    held[gmsh.model.getPhysicalName(3, tag)] = sum(map(len, found))
gmsh.write("groups.msh")
gmsh.finalize()

mesh = meshio.read("groups.msh")
read = {name: 0 for name in held}
for name in held:
    tag = mesh.field_data[name][0]
    for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
        if block.type == "tetra":
            read[name] += int((tags == tag).sum())
print("meshio", meshio.__version__, "gmsh", gmsh.__version__)
print("tetrahedra of each group by Gmsh:  ", held)
print("tetrahedra of each group by meshio:", read)
sys.exit(0 if held["stiff"] > 0 and read["stiff"] == 0 else 1)
SCRIPT
