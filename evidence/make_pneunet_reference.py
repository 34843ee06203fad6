"""CalculiX on a PneuNet whose walls meet: its tip at each increment of the pressure.

``python evidence/make_pneunet_reference.py FOLDER [SPLIT] [--without] [--rows] [DESIGN]
[KEY=VALUE ...]`` solves one half of DESIGN (`examples/pneunet_contact.toml` without it) up to its
`pressure` in FOLDER, and adds the rows to FOLDER/pneunet.csv: displacement and angle of the tip and
force between the walls at each increment. SPLIT (default 1) is how many quadratic bricks (C3D20R)
an edge of a voxel has, `--without` leaves contact out, and `--rows` takes what CalculiX has written
so far and solves nothing; KEY=VALUE changes the design as `--set` does. `pressure="80 kPa"` is the
tutorial's; one solution of three chambers takes hours then.

Made with it: `examples/data/pneunet/calculix.csv`, by `examples/toolkit_pneunet.toml`.

The paper is a layer of quadratic bricks as thick as it is, bonded to the rubber below. Its
stiffness in bending, E t³/12, is below 1 % of that of the rubber around it.
"""

from __future__ import annotations

import csv
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import voxsoft as vs
from voxsoft.comparison.brick_contact import BrickContact
from voxsoft.comparison.bricks import BrickModel, FacePressure
from voxsoft.comparison.calculix_contact import wall_names
from voxsoft.comparison.calculix_deck import VERTICES, calculix_deck
from voxsoft.comparison.calculix_lines import member_lines
from voxsoft.comparison.calculix_output import read_printed, read_totals
from voxsoft.comparison.calculix_units import DeckUnits
from voxsoft.design import Layer
from voxsoft.geometry import mean_rotation_vector
from voxsoft.simulation import Setup

EXAMPLE = Path(__file__).parents[1] / "examples" / "pneunet_contact.toml"
#: The largest increment, Pa: paper turns far in a step of 3 kPa and is stretched by it, so that
#: Newton's method does not come back.
LARGEST = 1e3
FIELDS = ["contact", "split", "pressure_kPa", "tip_ux_mm", "tip_uz_mm", "angle_deg", "force_N"]
#: Of a mirror image in the plane y = 0.
IMAGE = np.array([1.0, -1.0, 1.0])

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


def half(model: BrickModel) -> BrickModel:
    """The half of a problem at y > 0, with a plane of symmetry at y = 0."""
    kept = model.nodes[model.bricks].mean(axis=1)[:, 1] > 0.0
    brick = np.cumsum(kept) - 1
    used = np.unique(model.bricks[kept])
    node = np.full(len(model.nodes), -1)
    node[used] = np.arange(len(used))

    def faces(rows: Ints) -> Ints:
        own = rows[kept[rows[:, 0]]]
        return np.column_stack((brick[own[:, 0]], own[:, 1]))

    fixed = model.fixed[used].copy()
    fixed[np.abs(model.nodes[used, 1]) < 1e-9, 1] = True
    vertices = node[model.vertex_nodes]
    contact = model.contact and BrickContact(
        outer=faces(model.contact.outer),
        walls=tuple((faces(a), faces(b)) for a, b in model.contact.walls if len(faces(a))),
        friction=model.contact.friction,
        tools=(),
    )
    return replace(
        model,
        nodes=model.nodes[used],
        bricks=node[model.bricks[kept]],
        parts=model.parts[kept],
        fixed=fixed,
        values=model.values[used],
        forces=model.forces[used],
        pressures=tuple(FacePressure(faces(p.faces), p.value) for p in model.pressures),
        vertex_nodes=vertices[vertices >= 0],
        clamp_nodes=(),
        contact=contact,
    )


def paper_lines(model: BrickModel, paper: Layer, height: float) -> list[str]:
    """Bricks on the faces that look down in a plane: their lower nodes are those of the faces."""
    units = DeckUnits.of(model)
    low = np.abs(model.nodes[model.bricks[:, :4], 2] - height).max(axis=1) < 1e-9
    corners, edges = model.bricks[low, :4], model.bricks[low, 8:12]
    count = len(model.nodes)
    top = {node: count + k for k, node in enumerate(np.unique([corners, edges]).tolist())}
    middle = {node: count + len(top) + k for k, node in enumerate(np.unique(corners).tolist())}
    lines = ["*NODE, NSET=PAPER"]
    for above, share in ((top, 1.0), (middle, 0.5)):
        for node, number in above.items():
            x, y, z = (model.nodes[node] + (0, 0, share * paper.thickness)) / units.length
            lines.append(f"{number + 1}, {x:.12g}, {y:.12g}, {z:.12g}")
    lines.append("*ELEMENT, TYPE=C3D20, ELSET=PAPER")
    first = len(model.bricks)
    for index, (four, sides) in enumerate(zip(corners.tolist(), edges.tolist(), strict=True)):
        rows = [*four, *(top[n] for n in four), *sides, *(top[n] for n in sides)]
        row = [first + index, *rows, *(middle[n] for n in four)]
        words = [str(number + 1) for number in row]
        lines += [",".join(words[:15]) + ",", ",".join(words[15:])]
    lines += [
        "*MATERIAL, NAME=PAPER",
        f"*ELASTIC\n{paper.young / units.stress:.12g}, {paper.poisson:.12g}",
        "*SOLID SECTION, ELSET=PAPER, MATERIAL=PAPER",
    ]
    # What is held of a face is held of all of its paper.
    for above in (top, middle):
        for axis in range(3):
            held = np.array([new for node, new in above.items() if model.fixed[node, axis]])
            name = f"PAPER{'TOP' if above is top else 'MIDDLE'}{axis}"
            lines += member_lines("NSET", name, held)
            lines += ["*BOUNDARY", f"{name}, {axis + 1}, {axis + 1}"]
    return lines


def problem_of(design: vs.Design, split: int) -> tuple[BrickModel, str]:
    """The half of the design on bricks, and its input file."""
    (paper,) = design.layers
    assert paper.region.z is not None
    model = half(BrickModel.of(Setup.of(design.replace(layers=())), split=split))
    head, _, tail = calculix_deck(model).partition("*STEP")
    first, _, rest = tail.partition("*STATIC\n")
    lines = "\n".join(paper_lines(model, paper, paper.region.z[0]))
    most = LARGEST / model.pressures[0].value
    steps = f"{most:.6g}, 1.0, 1e-6, {most:.6g}"
    return model, f"{head}{lines}\n*STEP{first}*STATIC\n{steps}\n{rest.partition(chr(10))[2]}"


def rows_of(model: BrickModel, text: str, layer: float) -> Iterator[list[float]]:
    """Pressure in kPa, tip in mm and degrees about y, force between the walls in N, of a `.dat`."""
    places = model.nodes[model.vertex_nodes]
    end = (places[:, 0] > places[:, 0].max() - 1e-9) & (places[:, 2] < layer + 1e-9)
    # Of the whole body what is off the plane of symmetry is there twice.
    weights = np.where(np.abs(places[end, 1]) < 1e-9, 1.0, 2.0)
    units, totals = DeckUnits.of(model), read_totals(text)
    for each in read_printed(text):
        if each.name != VERTICES or len(each.nodes) != len(places):
            continue
        row = np.full(len(model.nodes), -1)
        row[each.nodes] = np.arange(len(each.nodes))
        moved = each.values[row[model.vertex_nodes[end]]] * units.length
        tip = 1e3 * np.average(moved, axis=0, weights=weights)
        walls = range(len(model.contact.walls) if model.contact else 0)
        if any((wall_names(k)[0], each.time) not in totals for k in walls):
            continue  # the file breaks off in this increment
        sizes = [np.linalg.norm(totals[wall_names(k)[0], each.time]) for k in walls]
        force = 2 * units.force * float(np.sum(sizes))
        pressure = model.pressures[0].value * each.time / 1e3
        yield [pressure, float(tip[0]), float(tip[2]), angle_of(places[end], moved), force]


def angle_of(rest: Floats, moved: Floats) -> float:
    """How far the tip has turned about y in degrees, as the metric `rotation` has it."""
    off = np.abs(rest[:, 1]) > 1e-9
    whole = np.concatenate((rest, rest[off] * IMAGE))
    after = whole + np.concatenate((moved, moved[off] * IMAGE))
    turn = mean_rotation_vector(whole, after, np.arange(len(whole), dtype=np.uint32))
    return float(np.degrees(turn[1]))


def main() -> None:
    """Solve, and add the rows."""
    changes = [word for word in sys.argv[1:] if "=" in word]
    words = [word for word in sys.argv[1:] if not word.startswith("--") and "=" not in word]
    files = [word for word in words if word.endswith(".toml")]
    place, *rest = [word for word in words if word not in files]
    folder, split = Path(place), int(rest[0]) if rest else 1
    design = vs.load(files[0] if files else EXAMPLE, assignments=changes)
    touching = "--without" not in sys.argv
    model, deck = problem_of(design if touching else design.replace(contact=None), split)
    job = f"pneunet-{split}-{'contact' if touching else 'without'}"
    if "--rows" not in sys.argv:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{job}.inp").write_text(deck, encoding="ascii")
        print(f"{len(model.bricks)} bricks, {len(model.nodes)} nodes", flush=True)
        with (folder / f"{job}.log").open("w") as log:
            subprocess.run(["ccx", "-i", job], cwd=folder, stdout=log, check=False)
    layer = design.probes["tip"].z
    assert layer is not None
    path = folder / "pneunet.csv"
    with path.open("a", newline="", encoding="utf-8") as lines:
        table = csv.writer(lines, lineterminator="\n")
        if not path.stat().st_size:
            table.writerow(FIELDS)
        for values in rows_of(model, (folder / f"{job}.dat").read_text(), layer[1]):
            table.writerow([int(touching), split, *(f"{value:.6g}" for value in values)])


if __name__ == "__main__":
    main()
