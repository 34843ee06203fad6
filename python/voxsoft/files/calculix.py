"""CalculiX as a subprocess: a temporary folder, a time limit, and its answer read back."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.calculix_contact import wall_names
from voxsoft.comparison.calculix_deck import Element, calculix_deck
from voxsoft.comparison.calculix_names import HELD, VERTICES, DeckNames
from voxsoft.comparison.calculix_output import Printed, read_printed, read_totals
from voxsoft.comparison.calculix_units import DeckUnits
from voxsoft.comparison.outside import OutsideAnswer, support_forces
from voxsoft.errors import MissingPackageError, OutsideCodeError

#: Name of the program, as Debian and Ubuntu install it.
PROGRAM: Final = "ccx"
_JOB = "voxsoft"
_LAST_LINES = 8

Floats = NDArray[np.float64]
#: Total forces by name of the set and time.
Totals = dict[tuple[str, float], Floats]


def calculix_path() -> Path:
    """Find the program on the search path.

    Raises
    ------
    MissingPackageError
        The program was not found.
    """
    found = shutil.which(PROGRAM)
    if found is None:
        raise MissingPackageError(
            "CalculiX",
            f'there is no program "{PROGRAM}" on the search path',
            "apt install calculix-ccx (Debian, Ubuntu), or compare with scikit-fem: "
            "pip install scikit-fem",
        )
    return Path(found)


def run_calculix(
    model: BrickModel,
    *,
    element: Element = "C3D20R",
    time_limit: float = 600.0,
    threads: int = 1,
) -> OutsideAnswer:
    """Solve a problem with CalculiX.

    Parameters
    ----------
    model
        The problem, on bricks with as many nodes as the element has.
    element
        Name of the element; default C3D20R: 20 nodes, reduced integration.
    time_limit
        Seconds after which the program is stopped.
    threads
        Number of cores it may use.

    Returns
    -------
    OutsideAnswer
        The answer, at the last converged increment where the whole load was not reached.

    Raises
    ------
    MissingPackageError
        CalculiX is not installed.
    OutsideCodeError
        It crashed, wrote no output, or took longer than the limit.
    SimulationError
        A material that it does not have.
    """
    program = calculix_path()
    deck = calculix_deck(model, element)
    with tempfile.TemporaryDirectory(prefix="voxsoft-calculix-") as name:
        folder = Path(name)
        (folder / f"{_JOB}.inp").write_text(deck, encoding="ascii")
        started = time.perf_counter()
        code, log = _run(program, folder, time_limit, threads)
        seconds = time.perf_counter() - started
        text = _printed(folder)
    printed = read_printed(text)
    moved = [each for each in printed if each.name == VERTICES]
    complete = [each for each in moved if len(each.nodes) == len(model.vertex_nodes)]
    if code is None:
        reached = f"{complete[-1].time:.0%}" if complete else "nothing"
        raise OutsideCodeError(
            "CalculiX",
            f"did not end within {time_limit:g} s; it had reached {reached} of the load",
            "allow more time (--time-limit), split voxels less, or load less",
        )
    gave_up = "increment size smaller than minimum" in log or "too many cutbacks" in log
    if not complete or (code != 0 and not gave_up):
        raise OutsideCodeError(
            "CalculiX",
            f"ended with code {code}; its last lines: {_last_lines(log)}",
            "run the exported mesh by hand, or compare with scikit-fem",
        )
    totals = read_totals(text) if model.contact is not None else {}
    return _answer(model, element, printed, totals, complete[-1], log, seconds)


def _answer(
    model: BrickModel,
    element: Element,
    printed: list[Printed],
    totals: Totals,
    last: Printed,
    log: str,
    seconds: float,
) -> OutsideAnswer:
    units = DeckUnits.of(model)
    row = np.full(len(model.nodes), -1)
    row[last.nodes] = np.arange(len(last.nodes))
    pulls = [each for each in printed if each.name == HELD and each.time == last.time]
    held = pulls[-1].nodes if pulls else np.zeros(0, np.int64)
    inner = pulls[-1].values * units.force if pulls else np.zeros((0, 3))
    whole = last.time > 1.0 - 1e-9
    version = re.search(r"[Vv]ersion (\d+\.\d+)", log)
    return OutsideAnswer(
        code="CalculiX",
        version=version[1] if version else "",
        element=element,
        status="ok" if whole else "not-converged",
        message=(
            "reached the whole load"
            if whole
            else f"found no equilibrium past {last.time:.1%} of the load; that state is kept"
        ),
        load_factor=1.0 if whole else last.time,
        displacements=last.values[row[model.vertex_nodes]] * units.length,
        held=held,
        reactions=support_forces(model, held, inner, last.time),
        unknowns=int((~model.fixed).sum()),
        seconds=seconds,
        contacts=_contacts(model, totals, last.time, units),
        pressed=_pressed(model, totals, last.time, units),
    )


def _contacts(model: BrickModel, totals: Totals, at: float, units: DeckUnits) -> dict[str, Floats]:
    """Return the force of each object on the body in N: the force that holds the object."""
    tools = model.contact.tools if model.contact is not None else ()
    names = DeckNames.numbered(model).tools
    return {
        tool.name: totals[name, at] * units.force for tool, name in zip(tools, names, strict=True)
    }


def _pressed(model: BrickModel, totals: Totals, at: float, units: DeckUnits) -> float | None:
    """Sum the magnitudes of the forces between walls of the body in N.

    A curved wall has forces in several directions; the magnitude of their sum counts here.
    """
    if model.contact is None or not model.contact.walls:
        return None
    sizes = [
        float(np.linalg.norm(totals[wall_names(index)[0], at]))
        for index in range(len(model.contact.walls))
    ]
    return sum(sizes) * units.force


def _run(program: Path, folder: Path, time_limit: float, threads: int) -> tuple[int | None, str]:
    """Run the program; return its exit code (None past the limit) and its output."""
    numbers = dict.fromkeys(("OMP_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER"), str(threads))
    output = folder / "log.txt"
    with output.open("wb") as log:
        # A session of its own, so that its child processes are stopped with it.
        process = subprocess.Popen(
            [program, "-i", _JOB],
            cwd=folder,
            env={**os.environ, **numbers},
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        try:
            code: int | None = process.wait(timeout=time_limit)
        except subprocess.TimeoutExpired:
            code = None
        finally:
            if process.poll() is None:
                _stop(process)
    return code, output.read_text(encoding="utf-8", errors="replace")


def _stop(process: subprocess.Popen[bytes]) -> None:
    with suppress(ProcessLookupError, PermissionError):
        if hasattr(os, "killpg"):
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
    process.wait()


def _printed(folder: Path) -> str:
    path = folder / f"{_JOB}.dat"
    return path.read_text(errors="replace") if path.exists() else ""


def _last_lines(log: str) -> str:
    lines = [line.strip() for line in log.splitlines() if line.strip()]
    return " | ".join(lines[-_LAST_LINES:]) or "none"
