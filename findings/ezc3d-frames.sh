#!/usr/bin/env bash
# ezc3d 1.7.2 and C3D: a recording of 70,000 frames is written whole, and read back as 65,535.
#
# Seen: POINT:FRAMES has 16 bits and holds 65,535; the file has the data of all 70,000 frames, and
# the reader returns the first 65,535 of them without a message (c3d 0.6.0 stops there too).
# Exits 1 where that has changed.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check ezc3d==1.7.2 numpy==2.2.6
cd "$folder"

venv/bin/python - <<'SCRIPT'
import sys
from importlib.metadata import version
from pathlib import Path

import ezc3d
import numpy as np

print("ezc3d", version("ezc3d"))
frames = 70_000
points = np.ones((4, 1, frames))
points[0, 0] = np.arange(frames)
file = ezc3d.c3d()
file["parameters"]["POINT"]["RATE"]["value"] = [100.0]
file["parameters"]["POINT"]["LABELS"]["value"] = ["tip"]
file["data"]["points"] = points
file.write("long.c3d")
held = Path("long.c3d").stat().st_size // 16
read = ezc3d.c3d("long.c3d")["data"]["points"][0, 0]
print(f"{frames:,} frames of 16 bytes: {held:,} times 16 bytes in the file, {len(read):,} read, the last is {read[-1]:,.0f}")
sys.exit(0 if held >= frames and len(read) == 65_535 else 1)
SCRIPT
