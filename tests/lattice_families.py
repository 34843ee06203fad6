"""The ready families with the spring lattice of the paper, whose solvers these tests are about.

The families themselves are rubber. Beam and cylinder are the paper's.
"""

import tomllib

from voxsoft.design import Design
from voxsoft.design.families import FAMILIES, family_text

_RUBBERS = {
    '"ecoflex-00-30"': '"ecoflex-00-30-lattice"',
    '"ecoflex-00-50"': '"ecoflex-00-50-lattice"',
    '{ model = "neo-hookean", young = "500 kPa", poisson = 0.48, density = "1070 kg/m^3" }': (
        '{ model = "lattice", edge = "200 kPa", bulk = "1 MPa" }'
    ),
}

__all__ = ["FAMILIES", "beam", "cylinder", "family", "finger", "pneunet", "sphere"]


def family(name: str, **parameters: float | str) -> Design:
    """Return a design of a family, all of whose parts are lattices."""
    text = family_text(f"paper-{name}" if name in ("beam", "cylinder") else name)
    for rubber, lattice in _RUBBERS.items():
        text = text.replace(rubber, lattice)
    return Design.from_document(tomllib.loads(text), parameters)


def beam(**parameters: float | str) -> Design:
    return family("beam", **parameters)


def cylinder(**parameters: float | str) -> Design:
    return family("cylinder", **parameters)


def finger(**parameters: float | str) -> Design:
    return family("finger", **parameters)


def pneunet(**parameters: float | str) -> Design:
    return family("pneunet", **parameters)


def sphere(**parameters: float | str) -> Design:
    return family("sphere", **parameters)
