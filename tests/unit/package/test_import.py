"""`import voxsoft` is light."""

import subprocess
import sys
from importlib.metadata import version

import pytest

#: Modules that take long to load, and are loaded by the names that need them.
HEAVY = {"numpy", "scipy", "pydantic", "optuna", "matplotlib", "pandas", "voxsoft._core"}


def loaded_by(line):
    code = f"import sys; {line}; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(run.stdout.split())


def test_import_loads_nothing_heavy():
    # A list and not a time: it says the same on a busy machine. Without these modules
    # `import voxsoft` takes some hundredths of a second; 0.3 s are allowed.
    assert not HEAVY & loaded_by("import voxsoft")


@pytest.mark.parametrize("name", ["Design", "__version__"])
def test_a_name_loads_its_module(name):
    modules = loaded_by(f"import voxsoft; voxsoft.{name}")
    assert ("pydantic" in modules) == (name == "Design")


def test_a_run_loads_no_library_that_only_plots_studies_and_fits_need():
    # Half of the time that a short command takes is imports; SciPy was a fifth of it.
    modules = loaded_by(
        "import voxsoft as vs\n"
        "from voxsoft.cli import app\n"
        "from voxsoft.design import families\n"
        "vs.simulate(families.beam()).metrics"
    )
    assert not {"scipy", "matplotlib", "optuna", "pandas"} & modules


def test_the_package_is_a_program():
    command = [sys.executable, "-m", "voxsoft", "--version"]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    assert run.stdout == f"voxsoft {version('voxsoft')}\n"
