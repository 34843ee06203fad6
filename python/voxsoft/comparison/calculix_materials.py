"""Materials in CalculiX's input files, which Abaqus reads alike."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

from voxsoft.comparison.outside import no_such_material, rubber
from voxsoft.materials import Material

Constants = list[float]


def _neo_hookean(values: Constants, d1: float, stress: float) -> tuple[str, Constants]:
    return "NEO HOOKE", [values[0] / stress, d1]


def _mooney_rivlin(values: Constants, d1: float, stress: float) -> tuple[str, Constants]:
    return "MOONEY-RIVLIN", [values[0] / stress, values[1] / stress, d1]


def _volumetric(d1: float, terms: int) -> Constants:
    """Return D1 and higher terms that are negligible.

    A zero would do in the manual's formula. The program's answer then depends on the units, by 0.4
    % of the displacement of a drawn bar of Yeoh's rubber; these values have no such effect.
    """
    return [d1, *[1e8 * d1] * (terms - 1)]


def _yeoh(values: Constants, d1: float, stress: float) -> tuple[str, Constants]:
    return "YEOH", [*(value / stress for value in (*values, 0.0, 0.0)[:3]), *_volumetric(d1, 3)]


def _ogden(values: Constants, d1: float, stress: float) -> tuple[str, Constants]:
    terms = len(values) // 2
    pairs = [value / (stress if index % 2 == 0 else 1.0) for index, value in enumerate(values)]
    return f"OGDEN, N={terms}", [*pairs, *_volumetric(d1, terms)]


_KEYWORDS: Final[dict[str, Callable[[Constants, float, float], tuple[str, Constants]]]] = {
    "neo-hookean": _neo_hookean,
    "mooney-rivlin": _mooney_rivlin,
    "yeoh": _yeoh,
    "ogden": _ogden,
}


def material_lines(material: Material, where: str, stress: float) -> Iterator[str]:
    """Write the energy of a hyperelastic material.

    Parameters
    ----------
    material
        Any material.
    where
        Its place in the design, for messages.
    stress
        Unit of stress of the file in Pa.

    Raises
    ------
    SimulationError
        A material that CalculiX does not have.

    Examples
    --------
    >>> from voxsoft.materials import NeoHookean
    >>> list(material_lines(NeoHookean(young=60e3, poisson=0.45), "parts[0].material", 1e6))
    ['*HYPERELASTIC, NEO HOOKE', '0.0103448275862, 10']
    """
    model, values, bulk = rubber(material, "CalculiX", where)
    if model not in _KEYWORDS:
        raise no_such_material("CalculiX", model, where)
    # U = (J - 1)²/D1 in CalculiX and K/2 (J - 1)² here.
    keyword, constants = _KEYWORDS[model](list(values), 2.0 * stress / bulk, stress)
    yield f"*HYPERELASTIC, {keyword}"
    for start in range(0, len(constants), 8):
        yield ", ".join(f"{value:.12g}" for value in constants[start : start + 8])
