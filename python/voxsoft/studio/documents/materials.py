"""Materials on the page: the cards, and those of the design that is open."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any, Final

import numpy as np

from voxsoft.design import Design
from voxsoft.errors import VoxSoftError
from voxsoft.materials import (
    Card,
    CompliantLattice,
    Hyperelastic,
    Lattice,
    Material,
    Rigid,
    card_names,
    is_card_path,
    load_card,
    uniaxial_stress,
)
from voxsoft.studio.documents.document import DesignDocument
from voxsoft.studio.protocol import events
from voxsoft.units import EXACT

#: A length that moduli of lattices are given for [m]; they hardly depend on it.
_USUAL_VOXEL: Final = 2e-3
#: A curve has so many points, and goes at least to this stretch, or beyond the tested range so far.
_POINTS: Final = 61
_LEAST: Final = 2.0
_BEYOND: Final = 1.25
#: The stretch whose stress makers state as the modulus at 100 % strain.
_DOUBLE: Final = 2.0


def young_of(material: Material) -> float | None:
    """Young's modulus at small strain in Pa, or None of a rigid material."""
    return None if isinstance(material, Rigid) else float(material.young(_USUAL_VOXEL))


def written(material: Material) -> dict[str, Any]:
    """A material as a design file writes it."""
    return material.model_dump(mode="json", by_alias=True, exclude_none=True, context=EXACT)


def materials_of(document: DesignDocument) -> events.Materials:
    """All cards, the design's own materials, and a note on mixing its kinds."""
    design = document.design
    own = [] if design is None else _own(design)
    mixed = "" if design is None else mixture_of(design)
    return events.Materials(rev=document.rev, materials=[*own, *_shipped()], mixed=mixed)


def mixture_of(design: Design) -> str:
    """Describe the effects of mixing spring lattices and rubber in a design; "" for other designs.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> mixture_of(families.beam())
    ''
    """
    kinds = [design.material_of(part) for part in design.assembled.parts]
    lattice = any(isinstance(each, Lattice | CompliantLattice) for each in kinds)
    rubber = any(isinstance(each, Hyperelastic) for each in kinds)
    if not (lattice and rubber):
        return ""
    return (
        "This design mixes a spring lattice with rubber. It is solved, but live motion takes the "
        "implicit steps of rubber, error bars come only where the solver's error asks for them, "
        "and local refinement is refused."
    )


@cache
def _shipped() -> Sequence[events.MaterialFacts]:
    """The cards; one that a plain name stands for goes by that name."""
    cards = [load_card(name) for name in card_names()]
    stood_for = {card.same_as for card in cards}
    return [_facts(card, "card") for card in cards if card.name not in stood_for]


def _own(design: Design) -> list[events.MaterialFacts]:
    """The materials of a design, and the cards of its folder that its parts name."""
    cards = [Card(name=name, material=material) for name, material in design.materials.items()]
    found = [_facts(card, "design") for card in cards]
    named = [part.material for part in design.parts if isinstance(part.material, str)]
    for path in dict.fromkeys(filter(is_card_path, named)):
        try:
            found.append(_facts(load_card(path).replace(name=path), "file"))
        except VoxSoftError:  # the document names it where it is wrong
            continue
    return found


def _facts(card: Card, origin: events.Origin) -> events.MaterialFacts:
    material = card.material
    tested = getattr(material, "tested_stretch", None)
    stretches, stresses = _curve(material, card.elongation_at_break)
    return events.MaterialFacts(
        name=card.name,
        title=card.title,
        origin=origin,
        same_as=card.same_as,
        choice=card.choice,
        model=material.model,
        live=_live(material),
        shore=card.shore,
        young=young_of(material),
        density=None if isinstance(material, Rigid) else material.density,
        tested_from=None if tested is None else tested.smallest or 1.0,
        tested_to=None if tested is None else tested.largest,
        elongation_at_break=card.elongation_at_break,
        stress_at_double=_stress_at_double(material),
        source=card.source,
        caution=card.caution,
        license=card.license,
        stretches=stretches,
        stresses=stresses,
        table=written(material),
    )


def _live(material: Material) -> events.LiveMotion:
    if isinstance(material, Rigid):
        return "none"
    return "implicit" if isinstance(material, Hyperelastic) else "explicit"


def _curve(
    material: Material, elongation_at_break: float | None
) -> tuple[list[float], list[float | None]]:
    """Stretches and nominal stresses in Pa of a pull along one axis, as far as there are any."""
    if not isinstance(material, Hyperelastic | Lattice):
        return [], []  # rigid, or compliances of one voxel size
    tested = material.tested_stretch
    end = _LEAST if tested is None else max(_LEAST, 1.0 + _BEYOND * (tested.largest - 1.0))
    if elongation_at_break is not None:
        end = min(end, 1.0 + elongation_at_break)
    stretches = np.linspace(1.0, end, _POINTS)
    stresses = uniaxial_stress(material, stretches)
    return stretches.tolist(), [float(s) if np.isfinite(s) else None for s in stresses]


def _stress_at_double(material: Material) -> float | None:
    if not isinstance(material, Hyperelastic | Lattice):
        return None
    stress = float(uniaxial_stress(material, _DOUBLE))
    return stress if np.isfinite(stress) else None
