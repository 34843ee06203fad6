#!/usr/bin/env bash
# meshio 5.3.5 and Abaqus input: a hybrid tetrahedron is refused, and two parts become another body.
#
# Seen: `type=C3D4H` raises KeyError 'tetra4', and of two parts, each numbered from 1, the element of
# the first is put on the nodes of the second: 62.5 for 208.33. Exits 1 where either has changed.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check meshio==5.3.5 numpy==2.2.6
cd "$folder"

cat > hybrid.inp <<'DECK'
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 0, 1, 0
4, 0, 0, 1
*ELEMENT, TYPE=C3D4H
1, 1, 2, 3, 4
DECK

cat > parts.inp <<'DECK'
*PART, NAME=FIRST
*NODE
1, 0, 0, 0
2, 10, 0, 0
3, 0, 10, 0
4, 0, 0, 10
*ELEMENT, TYPE=C3D4
1, 1, 2, 3, 4
*END PART
*PART, NAME=SECOND
*NODE
1, 100, 0, 0
2, 105, 0, 0
3, 100, 5, 0
4, 100, 0, 5
5, 105, 5, 5
*ELEMENT, TYPE=C3D4
1, 2, 3, 4, 5
*END PART
*ASSEMBLY, NAME=BOTH
*INSTANCE, NAME=A, PART=FIRST
*END INSTANCE
*INSTANCE, NAME=B, PART=SECOND
*END INSTANCE
*END ASSEMBLY
DECK

venv/bin/python - <<'SCRIPT'
import sys

import meshio
import numpy as np

print("meshio", meshio.__version__)
try:
    meshio.read("hybrid.inp")
    hybrid = "read"
except KeyError as error:
    hybrid = f"KeyError {error}"
print("C3D4H:", hybrid)

mesh = meshio.read("parts.inp")
tets = np.concatenate([block.data for block in mesh.cells if block.type == "tetra"])
a, b, c, d = (mesh.points[tets[:, corner]] for corner in range(4))
volume = abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)).sum() / 6
print(f"two parts: {len(tets)} tetrahedra of {volume:.2f} in all; the deck has 2 of 208.33")

sys.exit(0 if hybrid == "KeyError 'tetra4'" and abs(volume - 62.5) < 1e-9 else 1)
SCRIPT
