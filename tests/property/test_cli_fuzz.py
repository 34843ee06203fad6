"""Whatever is typed and whatever files hold, the command line ends in words and a known code.

``VOXSOFT_FUZZ=20000 pytest tests/property/test_cli_fuzz.py`` tries longer than a test run should.
"""

import contextlib
import json
import os
import tempfile
from pathlib import Path

from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from voxsoft.cli.app import app

ROOT = Path(__file__).parents[2]
DESIGN = (ROOT / "examples" / "beam.toml").read_bytes()
DATA = (ROOT / "examples" / "data" / "paper_beams" / "ecoflex-00-30.csv").read_bytes()
CODES = {0, 2, 3, 4, 5}

THOROUGH = settings(
    max_examples=int(os.environ.get("VOXSOFT_FUZZ", "4")),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
)

# Searches are cut short (`few`): a sweep of the whole beam has 15,600 designs.
VERBS = ["new", "check", "mesh", "run", "export", "calibrate", "optimize", "sweep", "fly", ""]
WORDS = st.one_of(
    st.sampled_from(
        [
            "design.toml",
            "data.csv",
            "data.toml",
            "missing.toml",
            "out.vtu",
            "out.stl",
            "out.npy",
            "out.csv",
            "-",
            "--",
            ".",
            "--json",
            "--help",
            "--deformed",
            "--free-scale",
            "--unit",
            "--voxel-size",
            "--sampler",
            "--seed",
            "--template",
            "--solver",
            "mm",
            "2 mm",
            "random",
            "-5",
            "0",
            "nan",
            "inf",
            "xpbd",
            "beam",
        ]
    ),
    st.text(max_size=8).filter(lambda text: "\0" not in text and not text.startswith("--")),
)
SETS = st.sampled_from(
    [
        "length=20 mm",
        "width=5 mm",
        "height=-1 mm",
        "voxel_size=2.5 mm",
        "voxel_size=0 mm",
        "voxel_size=1 nm",
        "solver.max_time=1 ms",
        "solver.tolerance=2",
        "clamps=[]",
        "loads=[]",
        "loads.0.value=1e300 m/s^2",
        "loads.0.direction=[0, 0, 0]",
        "parts.0.material=lead",
        "probes={}",
        "objectives={}",
        "parameters={}",
        "a.b.c=1",
        "=",
        "[red]=1",
    ]
)


def few(verb):
    """Options that keep a search short."""
    return {
        "optimize": ["--budget", "1", "--workers", "1"],
        "sweep": ["--set", "parameters={}", "--workers", "1"],
        "calibrate": ["--generations", "1", "--population", "4"],
    }.get(verb, [])


def ends_in_words(arguments, files):
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        for name, content in files.items():
            Path(name).write_bytes(content)
        outcome = CliRunner().invoke(app, arguments)
        assert outcome.exit_code in CODES, (arguments, outcome.exception)
        assert outcome.exception is None or isinstance(outcome.exception, SystemExit)
        assert "Traceback" not in outcome.stderr
        if "--json" in arguments and outcome.exit_code != 2 and outcome.stdout.startswith("{"):
            assert isinstance(json.loads(outcome.stdout), dict)
        assert outcome.exit_code == 0 or outcome.output.strip(), "a failure is explained"


@THOROUGH
@given(st.sampled_from(VERBS), st.lists(WORDS, max_size=4), st.lists(SETS, max_size=2))
@example("run", ["design.toml", "--json"], ["[red]=1"])
@example("new", ["\x1b[31m"], [])
@example("new", ["[/red]"], [])
def test_arguments(verb, words, sets):
    assigned = [part for value in sets for part in ("--set", value)]
    files = {"design.toml": DESIGN, "data.csv": DATA}
    ends_in_words([verb, *words, *assigned, *few(verb)], files)


def damaged(original):
    """A file with a piece cut out, replaced or doubled, or any bytes at all."""

    def damage(start, length, put):
        start %= len(original) + 1
        return original[:start] + put + original[start + length :]

    pieces = st.sampled_from(
        [b"", b"\n", b'"', b"[[", b"= nan", b"1e999 mm", b"\xff", b"5", b"-", b","]
    )
    cut = st.builds(damage, st.integers(0, 10_000), st.integers(0, 60), pieces)
    return st.one_of(cut, st.binary(max_size=40))


@THOROUGH
@given(st.sampled_from(["check", "mesh", "run", "optimize"]), damaged(DESIGN))
def test_design_files(verb, content):
    # The short beam keeps whatever is still a design cheap to solve.
    small = ["--set", "length=20 mm"]
    ends_in_words([verb, "design.toml", "--json", *small, *few(verb)], {"design.toml": content})


@THOROUGH
@given(damaged(DATA))
def test_measurements(content):
    arguments = ["calibrate", "design.toml", "data.csv", "--json", *few("calibrate")]
    ends_in_words(
        [*arguments, "--set", "voxel_size=10 mm"], {"design.toml": DESIGN, "data.csv": content}
    )


@THOROUGH
@given(st.sampled_from(["stl", "obj", "ply", "vtk", "vtu", "png"]), st.binary(max_size=200))
def test_mesh_files(suffix, content):
    name = f"part.{suffix}"
    ends_in_words(["check", name, "--unit", "mm", "--json"], {name: content})
