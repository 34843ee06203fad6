"""Writer of glTF binary: a mesh and a node for each surface."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

_MAGIC, _JSON, _BIN = b"glTF", b"JSON", b"BIN\0"
_FLOATS, _INDICES = 5126, 5125
_VERTEX_BUFFER, _INDEX_BUFFER = 34962, 34963
#: Quaternion that turns z up, which VoxSoft has, into y up, which glTF asks for.
_Y_UP: Final = (-(0.5**0.5), 0.0, 0.0, 0.5**0.5)


def write(
    path: Path, surfaces: Mapping[str, tuple[NDArray[np.float64], NDArray[np.int64]]]
) -> None:
    """Write surfaces, in m, below a root node that turns z up into y up."""
    binary = bytearray()
    views: list[dict[str, Any]] = []
    accessors: list[dict[str, Any]] = []
    for vertices, triangles in surfaces.values():
        points = vertices.astype("<f4")
        indices = triangles.astype("<u4").ravel()
        limits = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
        for array, target, entry in (
            (points, _VERTEX_BUFFER, {"componentType": _FLOATS, "type": "VEC3", **limits}),
            (indices, _INDEX_BUFFER, {"componentType": _INDICES, "type": "SCALAR"}),
        ):
            data = array.tobytes()
            view = {"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)}
            accessors.append({"bufferView": len(views), "count": len(array), **entry})
            views.append({**view, "target": target})
            binary += data
    count = len(surfaces)
    content = {
        "asset": {"version": "2.0", "generator": "VoxSoft"},
        "scene": 0,
        "scenes": [{"nodes": [count]}],
        "nodes": [
            *({"name": name, "mesh": number} for number, name in enumerate(surfaces)),
            {"name": "z up", "rotation": _Y_UP, "children": [*range(count)]},
        ],
        "meshes": [
            {
                "name": name,
                "primitives": [{"attributes": {"POSITION": 2 * number}, "indices": 2 * number + 1}],
            }
            for number, name in enumerate(surfaces)
        ],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}],
    }
    text = json.dumps(content, separators=(",", ":")).encode("utf-8")
    text += b" " * (-len(text) % 4)
    size = 12 + 8 + len(text) + 8 + len(binary)
    path.write_bytes(
        struct.pack("<4sII", _MAGIC, 2, size)
        + struct.pack("<I4s", len(text), _JSON)
        + text
        + struct.pack("<I4s", len(binary), _BIN)
        + bytes(binary)
    )
