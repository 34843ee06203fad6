"""Whole computations for CalculiX and Abaqus, ``.inp``."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import dropwhile, takewhile
from pathlib import Path

from voxsoft.comparison.deck import DEFAULT_ELEMENT, HOLDS, Deck
from voxsoft.design import Design
from voxsoft.errors import ErrorDetail
from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import FilePath


def write(
    path: Path, design: Design, *, unit: str = "m", element: str | None = None, split: int = 1
) -> Deck:
    """Write the computation of a design; parameters and errors as of :func:`write_computation`."""
    deck = Deck.of(design, unit=unit, element=element or DEFAULT_ELEMENT, split=split)
    write_atomically(path, deck.text)
    return deck


def write_computation(
    path: FilePath,
    design: Design,
    *,
    unit: str = "m",
    element: str = DEFAULT_ELEMENT,
    split: int = 1,
) -> tuple[ErrorDetail, ...]:
    """Write the computation of a design for CalculiX or Abaqus.

    The file is complete: ``ccx NAME`` runs it, and prints the displacement of each probe. It is
    that of ``voxsoft compare``, in other units.

    Parameters
    ----------
    path
        The file, ``NAME.inp``.
    design
        The design. With an `end_time` of its solver the file is a motion over time, else the
        equilibrium under the whole load.
    unit
        ``"m"`` for SI (default), ``"mm"`` for N, mm, MPa, t, or ``"um"`` for µN, µm, MPa, kg.
    element
        ``"C3D20R"`` (default), that of a comparison; ``"C3D20"``, ``"C3D8"``, ``"C3D8I"`` or
        ``"C3D8R"``.
    split
        Bricks along each edge of a voxel, 1 to 8.

    Returns
    -------
    tuple of ErrorDetail
        Entries of the design that the file does not hold, or holds in another form.

    Raises
    ------
    SimulationError
        A body or material that these programs do not have: the lattice, Gent, rubber that softens,
        several bodies, tetrahedra of a file; or an unknown unit or element.
    DesignError
        A design that cannot be solved: no clamp, a probe outside the body.
    OutputError
        The file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from voxsoft.design import families
    >>> write_computation(Path(tempfile.mkdtemp(), "beam.inp"), families.beam(), unit="mm")
    ()
    """
    return write(Path(path), design, unit=unit, element=element, split=split).lost


def held_in(path: FilePath) -> list[str]:
    """Return the sentences at the beginning of a computation that tell all that it holds.

    Parameters
    ----------
    path
        A file of :func:`write_computation`; of any other file there are none.

    Examples
    --------
    >>> import tempfile
    >>> from voxsoft.design import families
    >>> path = Path(tempfile.mkdtemp(), "beam.inp")
    >>> _ = write_computation(path, families.beam())
    >>> held_in(path)[2:4]
    ['clamps[0]: xyz held', 'loads[0]: gravity']
    """
    found: list[str] = []
    for line in _account(Path(path)):
        if line.startswith("** - "):
            found.append(line[5:])
        else:
            found[-1] += f" {line[5:]}"
    return found


def _account(path: Path) -> Iterator[str]:
    """Return the comments below the line that begins the account."""
    with path.open(encoding="ascii", errors="replace") as file:
        head = takewhile(lambda line: line.startswith("**"), map(str.rstrip, file))
        below = dropwhile(lambda line: line != HOLDS, head)
        next(below, None)
        yield from takewhile(lambda line: line.startswith(("** - ", "**   ")), below)
