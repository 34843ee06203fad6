"""Ready features in the text of a design file."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Final

from voxsoft.design import Design
from voxsoft.design.features import feature_changes
from voxsoft.errors import DesignError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import FilePath
from voxsoft.files.run_folder import make_folder
from voxsoft.files.toml_edits import with_value

#: A design file that holds nothing yet.
_NOTHING: Final = """\
schema = "voxsoft/1"
name = "robot"
voxel_size = "2 mm"
"""


def write_feature(feature: str, path: FilePath, *, name: str) -> None:
    """Write a design file that begins with a ready feature.

    Parameters
    ----------
    feature
        One of those of :data:`voxsoft.design.features.FEATURES`.
    path
        Path of the file; its folder is made if it does not exist.
    name
        Name of the new design.

    Raises
    ------
    DesignError
        There is no such feature, or no design can have the name.
    FileError
        The file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "arm.toml")
    ...     write_feature("bellows", file, name="arm")
    ...     "bellows_walls" in file.read_text()
    True
    """
    text = with_feature(with_value(_NOTHING, ["name"], name), feature)
    Design.from_document(tomllib.loads(text))
    make_folder(Path(path).parent)
    write_atomically(path, text)


def with_feature(text: str, name: str, at: tuple[float, float, float] | None = None) -> str:
    r"""Return the text of a design file with a new feature; its comments stay.

    Parameters
    ----------
    text
        Text of the design file.
    name, at
        Parameters of :func:`voxsoft.design.features.feature_changes`.

    Raises
    ------
    DesignError
        There is no such feature, or the text is not TOML.

    Examples
    --------
    >>> text = with_feature('schema = "voxsoft/1"\nname = "arm"\n', "finger")
    >>> "finger_stem" in text
    True
    """
    try:
        source = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise DesignError("text", f"is not TOML: {error}", "check it with voxsoft check") from None
    _, changes = feature_changes(source, name, at)
    for path, value in changes:
        text = with_value(text, path, value)
    return text
