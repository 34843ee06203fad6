"""From what a user typed to the document that a file holds."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Any

from voxsoft.design.resolution import Document, formulas


def plain_document(
    source: Mapping[str, Any], resolved: Mapping[str, Any], *, from_file: bool
) -> Document:
    """Make the document of a design with its formulas.

    Parameters
    ----------
    source
        What the design was made of: for a Python call, a mix of models, SI floats and dicts.
    resolved
        The same as plain data with values in place of formulas.
    from_file
        Whether the source is a document already.

    Examples
    --------
    >>> plain_document({"size": ["= a", 0.005]}, {"size": ["1 mm", "5 mm"]}, from_file=False)
    {'size': ['= a', '5 mm']}
    """
    if from_file:
        return copy.deepcopy(dict(source))
    document = copy.deepcopy(dict(resolved))
    for path, formula in formulas(source):
        _put(document, path, formula)
    return document


def _put(document: Any, path: tuple[str | int, ...], formula: str) -> None:  # noqa: ANN401
    *way, last = path
    here = document
    for step in way:
        here = here[step]
    here[last] = formula
