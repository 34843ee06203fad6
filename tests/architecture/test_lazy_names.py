"""Names that a package loads when first used, and what it shows of itself."""

import importlib
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGES = ["voxsoft", "voxsoft.files", "voxsoft.study"]


@pytest.mark.parametrize("name", PACKAGES)
def test_no_lazy_name_is_that_of_a_module(name):
    """Importing a module sets it on its package, where it would hide the function for good."""
    package = importlib.import_module(name)
    modules = {path.stem for path in Path(package.__file__).parent.iterdir()}
    assert package.__all__
    assert not set(package.__all__) & modules


@pytest.mark.parametrize("name", PACKAGES)
def test_a_package_shows_its_public_names_and_nothing_else(name):
    package = importlib.import_module(name)
    for each in package.__all__:
        assert getattr(package, each) is not None
    shown = {each for each in dir(package) if not each.startswith("__")}
    assert shown == set(package.__all__)
    assert list(package.__all__) == sorted(package.__all__)


def test_shapes_are_all_there():
    """The package's own list is written out, so that it can be read without loading the shapes."""
    voxsoft, shapes = map(importlib.import_module, ("voxsoft", "voxsoft.shapes"))
    assert set(shapes.__all__) - set(voxsoft.__all__) == {"KINDS", "Scope"}


def test_a_misspelled_name_gets_a_suggestion():
    code = "import voxsoft as vs; vs.Desing"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    last = done.stderr.strip().splitlines()[-1]
    assert last.endswith("has no attribute 'Desing'. Did you mean: 'Design'?")


def test_everything_can_be_imported_by_a_star():
    names = {}
    exec("from voxsoft import *", names)
    assert names.keys() >= {"Design", "simulate", "Sphere", "sqrt"}
    assert not names.keys() & {"Any", "Final", "KINDS", "Scope", "annotations", "import_module"}
