"""Designs of the registered environments: a TOML file beside this module for each."""

from __future__ import annotations

from importlib import resources

from voxsoft.design import Design
from voxsoft.files import load


def robot(name: str) -> Design:
    """Return the design of a registered environment.

    Examples
    --------
    >>> robot("crawl").voxel_size
    0.005
    """
    file = resources.files("voxsoft.environments") / "designs" / f"{name}.toml"
    with resources.as_file(file) as path:
        return load(path)
