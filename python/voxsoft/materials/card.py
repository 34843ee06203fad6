"""Material cards: a named material and where its numbers come from."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, ValidationError

from voxsoft.errors import MaterialError, VoxSoftError
from voxsoft.materials.model import AnyMaterial, Material
from voxsoft.records import Record, closest, plain_error
from voxsoft.units import FILE_CONTEXT, UnitOf


class Card(Record):
    """A named material with its provenance.

    Parameters
    ----------
    name
        What designs call it by.
    title
        What people call it.
    material
        The model and its constants.
    source
        Where the numbers come from: data and method, in plain words.
    caution
        What the numbers are not good for, and what the source is worth.
    licence
        Under which terms the numbers may be passed on, where they are not VoxSoft's own.
    elongation_at_break
        Strain at break (change of length over length), if it was measured.
    calibration
        What a calibration noted: voxel size, solver settings, errors, seed, versions.

    Examples
    --------
    >>> card = load_card("ecoflex-00-30")
    >>> card.material.model
    'lattice'
    """

    error_type: ClassVar[type[VoxSoftError]] = MaterialError

    schema_: Literal["voxsoft-material/1"] = Field("voxsoft-material/1", alias="schema")
    name: str
    title: str = ""
    material: AnyMaterial
    source: str = ""
    caution: str = ""
    licence: str = ""
    elongation_at_break: Annotated[float, UnitOf("number", positive=True)] | None = None
    calibration: dict[str, Any] = Field(default_factory=dict)

    @classmethod
    def from_document(cls, document: Mapping[str, Any]) -> Card:
        """Read a card from parsed TOML, where numbers carry their units as text."""
        try:
            return cls.model_validate(document, context=dict(FILE_CONTEXT))
        except ValidationError as error:
            raise plain_error(error, cls, document) from None


@cache
def _shipped() -> Mapping[str, Card]:
    folder = resources.files("voxsoft.materials") / "cards"
    texts = (file.read_text(encoding="utf-8") for file in _card_files(folder))
    cards = (Card.from_document(tomllib.loads(text)) for text in texts)
    return {card.name: card for card in sorted(cards, key=lambda card: card.name)}


def _card_files(folder: Traversable) -> Iterator[Traversable]:
    """Find the cards in a folder and in those below it, each of which has a licence of its own."""
    for entry in folder.iterdir():
        if entry.is_dir():
            yield from _card_files(entry)
        elif entry.name.endswith(".toml"):
            yield entry


def card_names() -> tuple[str, ...]:
    """Name all shipped cards.

    Examples
    --------
    >>> [name for name in card_names() if name.startswith("ecoflex-00-20")]
    ['ecoflex-00-20', 'ecoflex-00-20-bending']
    """
    return tuple(_shipped())


def load_card(name: str) -> Card:
    """Return a shipped card by name.

    Raises
    ------
    MaterialError
        No such card; the message suggests the closest.

    Examples
    --------
    >>> load_card("ecoflex-0030")
    Traceback (most recent call last):
    ...
    voxsoft.errors.MaterialError: material: "ecoflex-0030" is not a card. Try: did you mean \
"ecoflex-00-30"?
    """
    cards = _shipped()
    if name not in cards:
        raise MaterialError("material", f'"{name}" is not a card', closest(name, cards))
    return cards[name]


def material_of(material: str | Material) -> Material:
    """Return the model behind a card's name; a model is returned as it is."""
    return load_card(material).material if isinstance(material, str) else material
