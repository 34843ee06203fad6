"""Spread of answers over the place of a body on the grid, whole and cut voxels beside each other.

``python evidence/places.py [--json] [--one] [--few]``. The grid follows these bodies where they
are shifted, so surfaces are moved through the voxels by 12 voxel sizes within 10 percent, and by
6 turns about the axis of a tube, a bender and a segment of three chambers. The table gives the mean
of growth and motion of the tip, and the largest difference of a place from that mean, in percent.
Walls are two voxels thick, or a little less; `--one` takes voxels twice as large, `--few` three
sizes and two turns.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, Final

import numpy as np

import voxsoft as vs
from voxsoft.errors import VoxSoftError
from voxsoft.units import mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

#: Voxel sizes as parts of the first one.
SIZES: Final = tuple(1.0 + 0.1 * part / 12 for part in range(12))
TURNS: Final = (7.5, 15.0, 22.5, 30.0, 37.5, 45.0)
RUBBER: Final = {"model": "neo-hookean", "young": "100 kPa", "poisson": 0.49}


def _round(radius: float, height: float, at: tuple[float, float, float]) -> dict[str, Any]:
    """An upright cylinder; lengths in mm."""
    return {
        "kind": "cylinder",
        "radius": radius * mm,
        "height": height * mm,
        "base": [x * mm for x in at],
    }


def _box(sides: tuple[float, float, float], at: tuple[float, float, float]) -> dict[str, Any]:
    """A box on the middle of its lower face; lengths in mm."""
    corner = (at[0] - sides[0] / 2, at[1] - sides[1] / 2, at[2])
    return {
        "kind": "box",
        "size": [x * mm for x in sides],
        "corner": [x * mm for x in corner],
    }


def _at(angle: float) -> tuple[float, float, float]:
    return 8.0 * np.cos(np.radians(angle)), 8.0 * np.sin(np.radians(angle)), 4.0


#: Outer shape, rooms, height, pressure in kPa, and voxel with two in each wall; lengths in mm.
BODIES: Final[dict[str, tuple[dict[str, Any], list[dict[str, Any]], float, float, float]]] = {
    "tube": (_round(14, 40, (0, 0, 0)), [_round(10, 32, (0, 0, 4))], 40, 8, 2),
    "bender": (_box((20, 20, 60), (0, 0, 0)), [_box((8, 12, 52), (2, 0, 4))], 60, 6, 2),
    "segment": (
        _round(14, 40, (0, 0, 0)),
        [_round(4, 32, _at(angle)) for angle in (0, 120, 240)],
        40,
        12,
        1,
    ),
}


def design(name: str, fill: str, size: float, turn: float) -> vs.Design:
    """A body at a place; the voxel size in mm, the turn in degrees."""
    outer, rooms, height, pressure, _ = BODIES[name]
    shapes = {"outer": outer, **{f"room{index}": room for index, room in enumerate(rooms)}}
    shapes["whole"] = {"kind": "difference", "of": list(shapes)}
    shapes["body"] = {"kind": "rotate", "of": "whole", "axis": "z", "angle": f"{turn} deg"}
    first = np.array([8.0, 0.0]) if name == "segment" else np.zeros(2)
    cos, sin = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    inside = np.array([cos * first[0] - sin * first[1], sin * first[0] + cos * first[1], 20.0])
    return vs.Design.model_validate(
        {
            "schema": "voxsoft/1",
            "name": name,
            "voxel_size": size * mm,
            "fill": fill,
            "shapes": shapes,
            "parts": [{"shape": "body", "material": RUBBER}],
            "chambers": {"driven": {"point": [float(x) * mm for x in inside]}},
            "clamps": [{"region": {"z": ["-inf", 0]}}],
            "loads": [{"kind": "pressure", "cavity": "driven", "value": f"{pressure} kPa"}],
            "probes": {"tip": {"point": [0, 0, height * mm]}},
            "solver": {"error": "off"},
        }
    )


def numbers(made: vs.Design, turn: float) -> np.ndarray:
    """Growth of the chambers in ml, and motion of the tip in mm along the body's own x and z."""
    result = vs.simulate(made)
    if result.status != "ok":
        raise VoxSoftError(made.name, result.message, "")
    x, y, z = np.asarray(result.probes["tip"]) / mm
    along = np.cos(np.radians(turn)) * x + np.sin(np.radians(turn)) * y
    return np.array([float(result.metric("cavity_volume_change")) * 1e6, along, z])


def places(few: bool) -> list[tuple[float, float]]:
    """Sizes as parts of the first one, and turns in degrees."""
    kept = [(part, 0.0) for part in (SIZES[::4] if few else SIZES)]
    return [*kept, *((1.0, turn) for turn in (TURNS[3:5] if few else TURNS))]


def main() -> None:
    """Print the table."""
    report = Report(
        "Spread of answers over the place of a body on the grid",
        one="walls of one voxel",
        few="three sizes and two turns",
    )
    one, few = bool(report.options["one"]), bool(report.options["few"])
    for name, (*_, size) in BODIES.items():
        size = 2 * size if one else size
        for fill in ("binary", "fraction"):
            found, failed = [], []
            for part, turn in places(few):
                try:
                    made = design(name, fill, size * part, turn)
                    found.append(numbers(made, turn))
                except VoxSoftError as error:
                    failed.append(str(error))
            moved = np.array(found)
            title = f"{name}, {fill}, {size:g} mm"
            for column, (number, unit) in enumerate((("growth", "ml"), ("x", "mm"), ("z", "mm"))):
                if number == "x" and name == "tube":
                    continue
                mean = float(moved[:, column].mean())
                off = float(np.abs(moved[:, column] / mean - 1.0).max())
                report.add(f"{title}, mean {number}", mean, unit)
                report.add(f"{title}, largest difference of {number}", 100.0 * off, "%")
            report.add(f"{title}, places not solved", float(len(failed)), "")
            for why in failed:
                print(f"{title}: {why}", file=sys.stderr)
    report.show()


if __name__ == "__main__":
    main()
