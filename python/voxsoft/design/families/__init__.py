"""Design families: ready designs with parameters, to start from.

Each is a commented TOML file beside this module, so that a family is also the text that
``voxsoft new`` writes. All are of silicone rubber, and fine enough to be solved without a warning.
"""

from __future__ import annotations

import tomllib
from importlib import resources
from typing import Final

from voxsoft.design.model import Design
from voxsoft.errors import DesignError
from voxsoft.records import closest

#: Names of the families.
FAMILIES: Final = ("beam", "cylinder", "finger", "pneunet", "sphere")

#: The bodies of the paper, as its spring lattice on voxels of 5 mm: no templates, but a reference.
PAPER: Final = ("paper-beam", "paper-cylinder")


def family_text(name: str) -> str:
    """Return a family as the text of a design file, with comments.

    Parameters
    ----------
    name
        One of :data:`FAMILIES` or :data:`PAPER`.

    Raises
    ------
    DesignError
        There is no such family.

    Examples
    --------
    >>> print(family_text("beam")[:49])
    # A cantilever beam under its own weight: the spe
    """
    if name not in FAMILIES + PAPER:
        raise DesignError("family", f'there is no family "{name}"', closest(name, FAMILIES))
    file = resources.files("voxsoft.design.families").joinpath(f"{name}.toml")
    return file.read_text(encoding="utf-8")


def family(name: str, **parameters: float | str) -> Design:
    """Return a design of a family.

    Parameters
    ----------
    name
        One of :data:`FAMILIES`.
    **parameters
        Values of its parameters: text with a unit, or numbers in SI units.

    Raises
    ------
    DesignError
        No such family or parameter, or a value out of range.

    Examples
    --------
    >>> family("cylinder", height="20 mm").shapes["outer"].height
    0.02
    """
    return Design.from_document(tomllib.loads(family_text(name)), parameters)


def beam(**parameters: float | str) -> Design:
    """Return a cantilever under its own weight, with nine probes along its centerline.

    Parameters
    ----------
    **parameters
        ``length`` (default 100 mm), ``width`` (10 mm), ``height`` (10 mm), ``clamped`` (10 mm).

    Examples
    --------
    >>> beam(length="50 mm").probes["station-9"].point
    (0.05, 0.005, 0.005)
    """
    return family("beam", **parameters)


def cylinder(**parameters: float | str) -> Design:
    """Return a cylindrical actuator: a closed chamber under 6 kPa on a plate.

    Parameters
    ----------
    **parameters
        ``radius`` (default 30 mm), ``height`` (50 mm), ``wall`` (10 mm), ``cap`` (10 mm).

    Examples
    --------
    >>> cylinder(radius="20 mm", wall="20 mm").empty_shapes
    ('cavity',)
    """
    return family("cylinder", **parameters)


def sphere(**parameters: float | str) -> Design:
    """Return a ball with a spherical chamber, clamped at its foot.

    Parameters
    ----------
    **parameters
        ``radius`` (default 25 mm), ``wall`` (10 mm).

    Examples
    --------
    >>> round(sphere(wall="5 mm").shapes["cavity"].radius, 12)
    0.02
    """
    return family("sphere", **parameters)


def pneunet(**parameters: float | str) -> Design:
    """Return a PneuNet: a row of connected chambers on a stiffer layer, which bends.

    Parameters
    ----------
    **parameters
        ``chambers`` (default 5), ``pitch`` (12.5 mm), ``width`` (20 mm), ``height`` (25 mm),
        ``wall`` (2.5 mm), ``gap`` (2.5 mm), ``channel`` (5 mm), ``layer`` (2.5 mm).

    Examples
    --------
    >>> pneunet(chambers=3).parameters["length"].value
    0.035
    """
    return family("pneunet", **parameters)


def finger(**parameters: float | str) -> Design:
    """Return a finger with a skin around a gyroid, pushed at its tip.

    Parameters
    ----------
    **parameters
        ``length`` (default 80 mm), ``width`` (28 mm), ``skin`` (4 mm), ``period`` (40 mm),
        ``thickness`` (5 mm).

    Examples
    --------
    >>> finger(period="20 mm").shapes["lattice"].period
    0.02
    """
    return family("finger", **parameters)


def paper_beam(**parameters: float | str) -> Design:
    """Return the paper's cantilever, of its lattice: the beam of the paper's calibration.

    Parameters
    ----------
    **parameters
        Parameters of :func:`beam`.

    Examples
    --------
    >>> paper_beam().material_of(paper_beam().parts[0]).model
    'lattice'
    """
    return family("paper-beam", **parameters)


def paper_cylinder(**parameters: float | str) -> Design:
    """Return the paper's cylindrical actuator, of its lattice: its study varies it 105 times.

    Parameters
    ----------
    **parameters
        ``radius`` (default 25 mm), ``height`` (35 mm), ``wall`` (5 mm), ``cap`` (5 mm).

    Examples
    --------
    >>> paper_cylinder(radius="10 mm", wall="10 mm").empty_shapes
    ('cavity',)
    """
    return family("paper-cylinder", **parameters)
