"""Price of contact: bodies that touch beside bodies that do not.

``python benchmarks/contact_price.py [--json] [--rounds N] [--fine] [--before TREE]``. Each scene is
solved beside one without what it prices, in turn: a block of rubber that a plate presses by 1 of
12 mm, without and with friction, beside a block whose top moves alike; bellows with contact that
do not touch beside bellows without; a plate of finer voxels than the block beside one of equal
voxels; two pads that close on a free bar and hold it against its weight, over time, beside pads
whose inner faces stand still. A free cube on a pad has its time alone. With ``--fine`` the block
has 10,648 voxels too, the pads 9,826 and 101,306, and ``examples/gripper.toml`` is run.

Times are medians of the processor time of `simulate`, without imports; the ratio is the median of
those of each round's pair. Each round is a process of its own. With ``--before``, the folder of
another checkout with its core, rounds of both alternate, and the figures of that one come beside.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from measure import Report

import voxsoft as vs
from voxsoft.design import Contact, History, Object, Solver
from voxsoft.files.designs import load
from voxsoft.units import kPa, mm

ROOT = Path(__file__).parents[1]
RUBBER = vs.NeoHookean(young=100 * kPa, poisson=0.45, density=1070)
SIDE = 12 * mm
FOOT = vs.Clamp(region=vs.Region(z=(0, 0)))
DOWN = vs.Motion(displacement=(0, 0, -1 * mm))
#: Voxels along the block of each size.
SMALL, LARGE = 12, 22

Scene = Callable[[], vs.Design]


def held(count: int) -> vs.Design:
    """A block whose top moves down by 1 mm."""
    part = vs.Part(shape=vs.Box(size=(SIDE, SIDE, SIDE)), material=RUBBER)
    top = vs.Clamp(region=vs.Region(z=(SIDE, SIDE)), motion=DOWN)
    return vs.Design(name="block", voxel_size=SIDE / count, parts=[part], clamps=[FOOT, top])


def pressed(count: int, friction: float, plate_voxel: float | None = None) -> vs.Design:
    """The block under a plate that moves down by 1 mm."""
    shape = vs.Box(size=(20 * mm, 20 * mm, 4 * mm), center=(6 * mm, 6 * mm, 14 * mm))
    plate = Object(name="plate", shape=shape, motion=DOWN, voxel_size=plate_voxel)
    return held(count).replace(clamps=[FOOT], objects=[plate], contact=Contact(friction=friction))


def bellows(*, contact: bool) -> vs.Design:
    """A PneuNet under so little pressure that its chambers stay apart."""
    design = load(ROOT / "examples/pneunet.toml")
    loads = [each.model_copy(update={"value": 1 * kPa}) for each in design.loads[:1]]
    return design.replace(loads=loads, contact=Contact() if contact else None)


def cube() -> vs.Design:
    """A free cube of 8 g on a pad."""
    shape = vs.Box(size=(12 * mm, 12 * mm, 12 * mm), center=(12 * mm, 12 * mm, 14 * mm))
    pad = vs.Part(shape=vs.Box(size=(24 * mm, 24 * mm, 8 * mm)), material=RUBBER)
    return vs.Design(
        name="pad",
        voxel_size=2 * mm,
        parts=[pad],
        clamps=[FOOT],
        objects=[Object(name="cube", shape=shape, motion="free", mass=0.008)],
        loads=[vs.Gravity()],
        contact=Contact(friction=0.5),
    )


def pads(count: int, *, grasp: bool) -> vs.Design:
    """Two pads that close by 1 mm each, on a free bar of 20 g or with their inner faces held."""
    close = History(time=[0.0, 0.05], factor=[0.0, 1.0])
    sides = (-1, 1)
    shapes = [vs.Box(size=(SIDE, SIDE, SIDE), center=(side * SIDE, 0, 0)) for side in sides]
    outer = [
        vs.Clamp(
            region=vs.Region(x=(1.5 * side * SIDE, 1.5 * side * SIDE)),
            motion=vs.Motion(displacement=(-side * mm, 0, 0), history=close),
        )
        for side in sides
    ]
    inner = [vs.Clamp(region=vs.Region(x=(side * SIDE / 2, side * SIDE / 2))) for side in sides]
    alone = vs.Design(
        name="pads",
        voxel_size=SIDE / count,
        parts=[vs.Part(shape=shapes[0] | shapes[1], material=RUBBER)],
        clamps=outer + inner,
        contact=Contact(friction=0.8),  # which takes the same implicit steps
        loads=[vs.Gravity(history=History(time=[0.05, 0.1], factor=[0.0, 1.0]))],
        solver=Solver(method="dynamics", time_step=0.01, end_time=0.15),
    )
    if not grasp:
        return alone
    shape = vs.Box(size=(SIDE, 16 * mm, 16 * mm), center=(0, 0, 0))
    bar = Object(name="bar", shape=shape, motion="free", mass="20 g", voxel_size=2 * mm)
    return alone.replace(clamps=outer, objects=[bar])


#: Scenes by name, each with that beside which it is priced, if any.
SCENES: dict[str, tuple[Scene, Scene | None]] = {
    "block of 1,728, smooth plate": (lambda: pressed(SMALL, 0.0), lambda: held(SMALL)),
    "block of 1,728, friction 0.5": (lambda: pressed(SMALL, 0.5), lambda: held(SMALL)),
    "bellows that do not touch": (
        lambda: bellows(contact=True),
        lambda: bellows(contact=False),
    ),
    "plate of voxels of a third": (
        lambda: pressed(SMALL, 0.0, SIDE / SMALL / 3),
        lambda: pressed(SMALL, 0.0),
    ),
    "free cube on a pad": (cube, None),
    "grasp by 432 voxels": (lambda: pads(6, grasp=True), lambda: pads(6, grasp=False)),
    "grasp by 9,826 voxels": (lambda: pads(17, grasp=True), lambda: pads(17, grasp=False)),
    "grasp by 101,306 voxels": (lambda: pads(37, grasp=True), lambda: pads(37, grasp=False)),
    "block of 10,648, smooth plate": (lambda: pressed(LARGE, 0.0), lambda: held(LARGE)),
    "block of 10,648, friction 0.5": (lambda: pressed(LARGE, 0.5), lambda: held(LARGE)),
    "gripper": (lambda: load(ROOT / "examples/gripper.toml"), None),
}
#: Number of scenes that take seconds.
QUICK = 6


def timed(scene: Scene | None) -> tuple[float, int, float]:
    """Seconds of the processor, Newton iterations or steps, and the first contact's force in N."""
    if scene is None:
        return 0.0, 0, 0.0
    design = scene()
    start = time.process_time()
    result = vs.simulate(design)
    seconds = time.process_time() - start
    force = result.contacts[0].pressure if result.contacts else 0.0
    return seconds, result.steps, force


def one(name: str) -> str:
    """Both runs of a scene, as JSON."""
    scene, beside = SCENES[name]
    vs.simulate(held(2))  # loads what simulations need
    return json.dumps([timed(beside), timed(scene)])


def in_process(number: int, tree: Path) -> list[tuple[float, int, float]]:
    """Runs of a scene in a process with the package of a tree."""
    command = [sys.executable, __file__, "--scene", str(number)]
    environment = {**os.environ, "PYTHONPATH": str(tree / "python")}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)}: {done.stdout}{done.stderr}")
    found: list[tuple[float, int, float]] = json.loads(done.stdout)
    return found


def main() -> None:
    """Time all scenes and print them."""
    report = Report(
        "Price of contact",
        {"rounds": (3, "rounds"), "scene": (None, "number of a scene, run once and told as JSON")},
        {"before": "folder of another checkout, priced in turn"},
        fine="the large block, the large pads and the gripper, too: hours",
    )
    if report.options["scene"] is not None:
        print(one(list(SCENES)[int(report.options["scene"])]))
        return
    trees = {"": ROOT}
    if report.options["before"] is not None:
        trees[", before"] = Path(report.options["before"])
    names = list(SCENES)[: None if report.options["fine"] else QUICK]
    for number, name in enumerate(names):
        found: dict[str, list[list[tuple[float, int, float]]]] = {tree: [] for tree in trees}
        for _ in range(int(report.options["rounds"])):
            for tree, folder in trees.items():
                found[tree].append(in_process(number, folder))
        for tree, rounds in found.items():
            seconds = statistics.median(own[0] for _, own in rounds)
            pairs = [own[0] / beside[0] for beside, own in rounds if beside[0] > 0.0]
            report.add(name + tree, seconds, "s", statistics.median(pairs) if pairs else None)
            _, steps, force = rounds[0][1]
            report.add(f"its iterations or steps{tree}", steps, "")
            report.add(f"its pressure{tree}", force, "N")
    report.show()


if __name__ == "__main__":
    main()
