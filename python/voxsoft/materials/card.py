"""Material cards: a named material and the source of its numbers."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable
from typing import Annotated, Any, ClassVar, Final, Literal

from pydantic import Field, ValidationError

from voxsoft.errors import MaterialError, VoxSoftError
from voxsoft.materials.model import AnyMaterial, Material
from voxsoft.records import FrozenDict, Name, Record, Table, closest, plain_error
from voxsoft.units import FILE_CONTEXT, UnitOf

SCHEMA: Final = "voxsoft-material/1"


class Card(Record):
    """A named material with its provenance.

    Parameters
    ----------
    name
        Name in designs.
    title
        Name for people.
    material
        The model and its constants.
    source
        Source of the numbers: data and method, in plain words.
    caution
        Limits of the numbers, and the quality of the source.
    license
        Terms under which the numbers may be passed on, where they are not VoxSoft's own.
    shore
        Shore hardness as the maker states it: ``"00-30"`` on the scale 00, ``"10A"`` on the scale
        A. Empty where the card states none.
    elongation_at_break
        Strain at break (change of length over length), if it was measured.
    same_as, choice
        For a plain name, such as ``ecoflex-00-30``: the card that it stands for, and the reason.
    calibration
        Data noted by a calibration: voxel size, solver settings, errors, seed, versions.

    Examples
    --------
    >>> card = load_card("ecoflex-00-30")
    >>> card.material.model, card.same_as
    ('yeoh', 'ecoflex-00-30-epfl-yeoh')
    >>> load_card("ecoflex-00-30-lattice").material.model
    'lattice'
    """

    error_type: ClassVar[type[VoxSoftError]] = MaterialError

    schema_: Literal["voxsoft-material/1"] = Field(SCHEMA, alias="schema")
    name: Name
    title: str = ""
    material: AnyMaterial
    source: str = ""
    caution: str = ""
    license: str = ""
    same_as: str = ""
    choice: str = ""
    shore: str = Field("", pattern=r"^(00-\d{1,3}|\d{1,3}[AD])?$")
    elongation_at_break: Annotated[float, UnitOf("number", positive=True)] | None = None
    calibration: Table[str, Any] = Field(default_factory=FrozenDict)

    def __hash__(self) -> int:
        return hash((self.name, self.material))  # the record of a calibration may hold lists

    @classmethod
    def from_document(cls, document: Mapping[str, Any]) -> Card:
        """Read a card from parsed TOML, where numbers carry their units as text."""
        document = {_RENAMED.get(key, key): value for key, value in document.items()}
        try:
            return cls.model_validate(document, context=dict(FILE_CONTEXT))
        except ValidationError as error:
            raise plain_error(error, cls, document) from None


# Renamed keys of a card's file; the older name is still accepted.
_RENAMED: Final = {"licence": "license"}  # older spelling
# Suffixes of the cards that came from tests; a plain name has no such suffix.
_ENDINGS: Final = ("-tensile", "-bending")
_PLAIN_NAMES: Final = "plain-names.toml"


@cache
def _shipped() -> Mapping[str, Card]:
    folder = resources.files("voxsoft.materials") / "cards"
    texts = (file.read_text(encoding="utf-8") for file in _card_files(folder))
    cards = {card.name: card for card in map(Card.from_document, map(tomllib.loads, texts))}
    choices = tomllib.loads((folder / _PLAIN_NAMES).read_text(encoding="utf-8"))
    plain = {
        name: _renamed(cards[choice["card"]], name, choice["why"])
        for name, choice in choices.items()
    }
    for name, card in cards.items():
        short = next((name.removesuffix(end) for end in _ENDINGS if name.endswith(end)), name)
        if short != name and short not in plain:
            plain[short] = _renamed(card, short, "The only card of it.")
    return dict(sorted((cards | plain).items()))


def _renamed(card: Card, name: str, why: str) -> Card:
    return card.model_copy(update={"name": name, "same_as": card.name, "choice": why})


def _card_files(folder: Traversable) -> Iterator[Traversable]:
    """Find the cards in a folder and in its subfolders, each of which has a license of its own."""
    for entry in folder.iterdir():
        if entry.is_dir():
            yield from _card_files(entry)
        elif entry.name.endswith(".toml") and entry.name != _PLAIN_NAMES:
            yield entry


def card_names() -> tuple[str, ...]:
    """Return the names of all shipped cards.

    Examples
    --------
    >>> [name for name in card_names() if name.startswith("ecoflex-00-20")]
    ['ecoflex-00-20', 'ecoflex-00-20-bending', 'ecoflex-00-20-lattice']
    """
    return tuple(_shipped())


def is_card_path(name: str | os.PathLike[str]) -> bool:
    """Return True if a material is given by the path of a card's file: its suffix is ``.toml``.

    Examples
    --------
    >>> is_card_path("runs/mine/mine.toml"), is_card_path("ecoflex-00-30")
    (True, False)
    """
    return os.fspath(name).lower().endswith(".toml")


def load_card(name: str | os.PathLike[str]) -> Card:
    """Return a card: a shipped one by its name, any other by the path of its file.

    Parameters
    ----------
    name
        Name in :func:`card_names`, or a path that ends with ``.toml``, such as that of the card of
        a calibration.

    Raises
    ------
    MaterialError
        No such card, and the message suggests the closest; or the file holds no valid card.
    FileError
        The file cannot be read.

    Examples
    --------
    >>> load_card("ecoflex-0030")
    Traceback (most recent call last):
    ...
    voxsoft.errors.MaterialError: material: "ecoflex-0030" is not a card. Try: did you mean \
"ecoflex-00-30"?
    """
    if is_card_path(name):
        # `files` lies above `materials` in the layers; this convenience reaches up when called.
        from voxsoft.files.cards import load_card_file

        return load_card_file(name)
    cards = _shipped()
    name = os.fspath(name)
    if name not in cards:
        hint = closest(name, cards)
        if os.sep in name:
            hint = "the path of a card ends with .toml"
        raise MaterialError("material", f'"{name}" is not a card', hint)
    return cards[name]


def material_of(material: str | os.PathLike[str] | Material) -> Material:
    """Return the model of a card, by name or path; a model is returned as it is."""
    if isinstance(material, (str, os.PathLike)):
        return load_card(material).material
    return material
