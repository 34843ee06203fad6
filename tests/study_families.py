"""Families and evaluations that cost nothing, for tests of studies; workers import them."""

import os
import signal
import time

from waiting import until

from voxsoft.design import Clamp, Design, Parameter, Part, Probe, Region
from voxsoft.errors import DesignError
from voxsoft.shapes import Box
from voxsoft.study import Outcome, evaluate_design

FALL = {"fall": {"maximize": "displacement", "probe": "tip", "axis": "z"}}
SPACE = {"x": (0.0, 1.0, 0.1), "y": (1, 10)}


def block(x=0.5, y=5):
    """A box whose size encodes its parameters."""
    if y == 13:
        raise DesignError("y", "13 brings bad luck")
    return Design(
        name="block",
        voxel_size=0.1,
        parameters={"x": Parameter(value=x), "y": Parameter(value=y)},
        shapes={"body": Box(size=(1.0 + x, float(y), 1.0))},
        parts=[Part(shape="body", material="ecoflex-00-30")],
        clamps=[Clamp(region=Region(z=(0.0, 0.0)))],
        probes={"tip": Probe(z=(1.0, 1.0))},
    )


def parameters(design):
    size = design.shapes["body"].size
    return size[0] - 1.0, size[1]


def bowl(design):
    """Best (0) at x = 0.3, y = 7."""
    x, y = parameters(design)
    return Outcome("ok", "", {name: score(x, y) for name in design.objectives} | {"mass": y})


def score(x, y):
    return -((x - 0.3) ** 2) - ((y - 7) / 10) ** 2


def two_sided(design):
    x, y = parameters(design)
    return Outcome("ok", "", {"near": (x - 0.2) ** 2, "far": -((x - 0.8) ** 2) - (y - 5) ** 2})


def moody(design):
    """Ends in another way for each y."""
    _, y = parameters(design)
    match int(y):
        case 1:
            return Outcome("no-cavity", "nothing enclosed")
        case 2:
            return Outcome("not-at-rest", "still moving", {"mass": 2.0})
        case 3:
            raise ZeroDivisionError("a bug in the solver")
        case 4:
            return Outcome("ok", "", {"fall": float("nan")})
        case _:
            return bowl(design)


def deadly(mark, design):
    """Kills its worker, always for y = 3, and once for y = 5."""
    _, y = parameters(design)
    if y == 3 or (y == 5 and not mark.exists()):
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return bowl(design)


def slow(design):
    time.sleep(0.05)
    return bowl(design)


def counted(mark, design):
    """Leaves a line for each evaluation."""
    x, y = parameters(design)
    with mark.open("a") as file:
        file.write(f"{x:.3g} {y:g}\n")
    time.sleep(0.02)
    return bowl(design)


def patient(mark, design):
    """Leaves a line when it begins, and ends once somebody has made the file beside."""
    with mark.open("a") as file:
        file.write("begun\n")
    until(mark.with_suffix(".go").exists, "leave to go on")
    return bowl(design)


def deadly_once(mark, wall, design):
    """Simulates, and kills its worker before the first design of one wall."""
    if not mark.exists() and design.parameters["wall"].value == wall:
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return evaluate_design(design)
