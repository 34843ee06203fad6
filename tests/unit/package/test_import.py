"""`import voxsoft` is light."""

import subprocess
import sys
from importlib.metadata import version

import pytest

import voxsoft as vs
from voxsoft.units import mm

#: Modules that take long to load, and are loaded by the names that need them.
HEAVY = {"numpy", "scipy", "pydantic", "optuna", "matplotlib", "pandas", "voxsoft._core"}

#: Modules of which a run and a check need nothing.
PLOTS_AND_FITS = {"scipy", "matplotlib", "PIL", "optuna", "pandas"}


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


@pytest.mark.parametrize(
    ("command", "unneeded"),
    [
        ("check", {*PLOTS_AND_FITS, "meshio", "voxsoft.simulation.runs.run"}),
        ("check", {"voxsoft.simulation.derivatives", "voxsoft.simulation.runs.simulator"}),
        ("run", {*PLOTS_AND_FITS, "urllib.request", "voxsoft.simulation.runs.simulator"}),
    ],
)
def test_a_command_loads_no_library_that_it_does_not_need(command, unneeded, tmp_path):
    # A round body, of cut voxels; a run draws its thumbnail and writes a file of VTK.
    file = tmp_path / "rod.toml"
    vs.Design(
        name="rod",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=vs.Cylinder(radius=8 * mm, height=40 * mm), material="ecoflex-00-30")],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Gravity()],
    ).save(file)
    out = ["--out", str(tmp_path / "run")] if command == "run" else []
    arguments = [command, str(file), *out]
    line = f"from voxsoft.cli.app import app; app({arguments}, standalone_mode=False)"
    assert unneeded & loaded_by(line) == set()


def test_the_package_is_a_program():
    command = [sys.executable, "-m", "voxsoft", "--version"]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    assert run.stdout == f"voxsoft {version('voxsoft')}\n"
