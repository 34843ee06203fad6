"""`import voxsoft` is light."""

import subprocess
import sys

import pytest

#: What takes long to load, and is loaded by the names that need it.
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
def test_a_name_brings_what_it_needs(name):
    modules = loaded_by(f"import voxsoft; voxsoft.{name}")
    assert ("pydantic" in modules) == (name == "Design")
