#!/usr/bin/env bash
# trimesh 5.2.0 and OBJ: relative indices count back from the end of the file, not from their line.
#
# Seen: of two unit cubes, each followed by its faces with indices from -8 to -1, both are put on the
# vertices of the second: x runs from 20 to 21 for 0 to 21, and no message. OBJ counts a negative
# index back from the vertex before its line. Exits 1 where that has changed.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check trimesh==5.2.0 numpy==2.2.6
cd "$folder"

for x in 0 20; do
  for z in 0 1; do
    printf 'v %d %d %d\n' "$x" 0 "$z" $((x + 1)) 0 "$z" $((x + 1)) 1 "$z" "$x" 1 "$z"
  done
  printf 'f %d %d %d\n' -8 -6 -7 -8 -5 -6 -4 -3 -2 -4 -2 -1 -8 -7 -3 -8 -3 -4 \
    -7 -6 -2 -7 -2 -3 -6 -5 -1 -6 -1 -2 -5 -8 -4 -5 -4 -1
done > cubes.obj

venv/bin/python - <<'SCRIPT'
import sys

import trimesh

print("trimesh", trimesh.__version__)
mesh = trimesh.load_mesh("cubes.obj", process=False)
(low, *_), (high, *_) = mesh.bounds
print(f"two cubes at x = 0 to 1 and 20 to 21: {len(mesh.faces)} triangles, x {low:g} to {high:g}")
sys.exit(0 if (low, high) == (20, 21) and len(mesh.faces) == 24 else 1)
SCRIPT
