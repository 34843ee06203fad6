"""Names that a package loads when first used."""

import importlib
from pathlib import Path

import pytest


@pytest.mark.parametrize("name", ["voxsoft", "voxsoft.files", "voxsoft.study"])
def test_no_lazy_name_is_that_of_a_module(name):
    """Importing a module sets it on its package, where it would hide the function for good."""
    package = importlib.import_module(name)
    folder = Path(package.__file__).parent
    lazy = set(getattr(package, "_HOME_OF", None) or package._HOMES)
    modules = {path.stem for path in folder.iterdir()}
    assert lazy
    assert not lazy & modules
