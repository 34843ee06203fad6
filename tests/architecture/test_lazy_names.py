"""Names that a package loads when first used, and its list of names."""

import importlib
import subprocess
import sys
from pathlib import Path

import pytest

NAMES = ("comparison", "control", "environments", "files", "jobs", "plot", "simulation", "study")
PACKAGES = ["voxsoft", *(f"voxsoft.{each}" for each in NAMES)]


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
    modules = set(package._MODULES) if name == "voxsoft" else set()
    assert shown == set(package.__all__) | modules
    assert list(package.__all__) == sorted(package.__all__)


def test_the_package_itself_has_at_most_eighty_names():
    """Names for everyday use; the rest is in its modules."""
    voxsoft = importlib.import_module("voxsoft")
    assert len(voxsoft.__all__) <= 80
    assert len(set(voxsoft.__all__)) == len(voxsoft.__all__)


def test_no_tools_of_the_modules_show_as_names():
    code = "import voxsoft as vs; vs.simulate, vs.shapes, vs.Study; print(*dir(vs))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    shown = set(done.stdout.split())
    tools = {"Any", "Final", "TYPE_CHECKING", "annotations", "import_module", "lazy_names"}
    assert not shown & tools
    assert {"simulate", "shapes", "Study"} <= shown


def test_each_module_of_the_package_is_an_attribute_without_an_import():
    voxsoft = importlib.import_module("voxsoft")
    for name in voxsoft._MODULES:
        code = f"import voxsoft as vs; print(vs.{name}.__name__)"
        if name in ("shapes", "metrics"):  # in a process of their own, where nothing is loaded yet
            command = [sys.executable, "-c", code]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
            assert done.stdout == f"voxsoft.{name}\n"
        assert getattr(voxsoft, name) is importlib.import_module(f"voxsoft.{name}")


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("exp", "voxsoft.shapes.exp"),
        ("random_shape", "voxsoft.shapes.random_shape"),
        ("SchwarzP", "voxsoft.shapes.SchwarzP"),
        ("CompliantLattice", "voxsoft.materials.CompliantLattice"),
        ("Card", "voxsoft.materials.Card"),
        ("Observation", "voxsoft.simulation.Observation"),
        ("Calibration", "voxsoft.calibration.Calibration"),
        ("Comparison", "voxsoft.comparison.Comparison"),
        ("StudyResult", "voxsoft.study.StudyResult"),
        ("kPa", "voxsoft.units.kPa"),
    ],
)
def test_a_name_that_is_elsewhere_points_there(name, place):
    voxsoft = importlib.import_module("voxsoft")
    with pytest.raises(AttributeError, match=f"has no attribute '{name}': it is .*{place}"):
        getattr(voxsoft, name)
    module, _, own = place.rpartition(".")
    assert getattr(importlib.import_module(module), own) is not None


def test_a_misspelled_name_gets_a_suggestion():
    code = "import voxsoft as vs; vs.Desing"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    last = done.stderr.strip().splitlines()[-1]
    assert last.endswith("has no attribute 'Desing'. Did you mean: 'Design'?")


def test_everything_can_be_imported_by_a_star():
    names = {}
    exec("from voxsoft import *", names)
    assert names.keys() >= {"Design", "simulate", "Sphere", "Box"}
    assert not names.keys() & {"Any", "Final", "KINDS", "Scope", "annotations", "import_module"}
