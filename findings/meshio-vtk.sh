#!/usr/bin/env bash
# meshio 5.3.5 and VTK: voxels are dropped, and a binary .vtk with an array on cells ends the program.
#
# Seen: of a .vtu of eight voxels no cell is read, after a warning on the terminal; a .vtk of version
# 5.1 with numbers on cells, as VTK writes it by default, raises SystemExit. VTK reads both. Exits 1
# where either has changed.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
  meshio==5.3.5 numpy==2.2.6 vtk==9.7.2
cd "$folder"

venv/bin/python - <<'SCRIPT'
import sys

import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

print("meshio", meshio.__version__, "and VTK", vtk.vtkVersion.GetVTKVersion())
image = vtk.vtkImageData()
image.SetDimensions(3, 3, 3)
labels = numpy_to_vtk(np.arange(8, dtype=np.int32))
labels.SetName("label")
image.GetCellData().AddArray(labels)
append = vtk.vtkAppendFilter()
append.SetInputData(image)
append.Update()
grid = append.GetOutput()

xml = vtk.vtkXMLUnstructuredGridWriter()
xml.SetFileName("voxels.vtu")
xml.SetInputData(grid)
xml.Write()
read = vtk.vtkXMLUnstructuredGridReader()
read.SetFileName("voxels.vtu")
read.Update()
cells = sum(len(block.data) for block in meshio.read("voxels.vtu").cells)
print(f"voxels.vtu: VTK reads {read.GetOutput().GetNumberOfCells()} cells, meshio {cells}")

legacy = vtk.vtkUnstructuredGridWriter()
legacy.SetFileName("voxels.vtk")
legacy.SetInputData(grid)
legacy.SetFileTypeToBinary()
legacy.Write()
again = vtk.vtkUnstructuredGridReader()
again.SetFileName("voxels.vtk")
again.Update()
try:
    meshio.read("voxels.vtk")
    answer = "read"
except SystemExit:
    answer = "SystemExit"
count = again.GetOutput().GetNumberOfCells()
print(f"voxels.vtk: VTK reads {count} cells, meshio ends with {answer}")
sys.exit(0 if cells == 0 and answer == "SystemExit" else 1)
SCRIPT
