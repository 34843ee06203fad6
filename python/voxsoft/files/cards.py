"""Material cards as files."""

from __future__ import annotations

import re
from pathlib import Path

from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import FilePath, read_document, read_text
from voxsoft.files.toml_text import write_toml
from voxsoft.materials import Card
from voxsoft.units import EXACT


def card_text(card: Card) -> str:
    """Write a material card as TOML text.

    Examples
    --------
    >>> from voxsoft.materials import load_card
    >>> card_text(load_card("ecoflex-00-30")).splitlines()[1]
    'name = "ecoflex-00-30"'
    """
    dumped = card.model_dump(mode="json", by_alias=True, exclude_none=True, context=EXACT)
    return write_toml({key: value for key, value in dumped.items() if value not in ("", {})})


def card_name(text: str) -> str:
    """Make a name that is valid in a design: lower case, letters, digits and hyphens.

    Examples
    --------
    >>> card_name("Ecoflex 00-30, 2nd"), card_name("硅胶")
    ('ecoflex-00-30-2nd', 'material')
    """
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-") or "material"


def save_card(card: Card, path: FilePath) -> None:
    """Write a material card to a TOML file, atomically.

    Parameters
    ----------
    card
        The card, such as :meth:`voxsoft.calibration.Calibration.card` makes.
    path
        Path of the file; it is replaced if it exists.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    write_atomically(path, card_text(card))


def load_card_file(path: FilePath) -> Card:
    """Read a material card from a TOML file.

    Raises
    ------
    FileError
        The file cannot be read, or is not TOML.
    MaterialError
        It is not a material card; every problem is listed.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> from voxsoft.materials import load_card
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "soft.toml"
    >>> save_card(load_card("ecoflex-00-30"), file)
    >>> load_card_file(file) == load_card("ecoflex-00-30")
    True
    """
    return Card.from_document(read_document(read_text(path), Path(path).name))
