"""Files, commands and links named in the documents exist."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = "crates|python|tests|docs|examples|benchmarks|evidence|research"
PATH = re.compile(rf"`((?:{FOLDERS})/[\w./-]+)`")


def named_paths():
    for document in [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")]:
        for match in PATH.finditer(document.read_text(encoding="utf-8")):
            yield pytest.param(match[1], id=f"{document.name}:{match[1]}")


@pytest.mark.parametrize("path", list(named_paths()))
def test_a_path_named_in_a_document_exists(path):
    assert (ROOT / path).exists()


def test_no_document_holds_two_sides_of_a_merge():
    sides = re.compile(r"^(?:<{7} |={7}$|>{7} )", re.MULTILINE)
    documents = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "tests").glob("*.md")]
    found = [path.name for path in documents if sides.search(path.read_text(encoding="utf-8"))]
    assert not found
    assert sides.search("a\n<<<<<<< HEAD\nb")


#: Files that may name an absolute path: an invented one of a user.
INVENTED = {"docs/how-to/dask.md"}


def test_no_file_names_a_folder_of_a_machine():
    folder = "/(work|root|home|Users)/[A-Za-z]"
    listed = subprocess.run(
        ["git", "grep", "-lIE", folder, "--", ":!*.lock"], cwd=ROOT, capture_output=True, text=True
    )
    if listed.returncode > 1:
        pytest.skip("no git repository here")
    found = set(listed.stdout.splitlines()) - {Path(__file__).relative_to(ROOT).as_posix()}
    assert found == INVENTED


def test_there_are_paths_to_check():
    assert len(list(named_paths())) > 20


def test_every_crate_and_layer_stands_in_the_map():
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    members = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"][
        "members"
    ]
    modules = {
        f"python/voxsoft/{path.name}"
        for path in (ROOT / "python/voxsoft").iterdir()
        if not path.name.startswith("_")
        and (path.suffix == ".py" or (path / "__init__.py").exists())
    }
    missing = [name for name in {*members, *modules} if f"`{name}`" not in text]
    assert missing == []


def test_the_makefile_has_the_targets_that_the_readme_names():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = set(re.findall(r"^(\w[\w-]*):", makefile, flags=re.MULTILINE))
    assert set(re.findall(r"(?<!voxsoft )make (\w[\w-]*)", readme)) <= targets


def test_first_screen_of_the_readme_holds_the_two_commands():
    first_screen = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()[:40]
    assert any("make demo" in line for line in first_screen)
    assert any("make test" in line for line in first_screen)


def test_layers_of_the_package_hold():
    command = [Path(sys.executable).with_name("lint-imports"), "--no-cache"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_long_files_say_why():
    long = []
    for pattern in ("crates/**/*.rs", "python/**/*.py"):
        for path in ROOT.glob(pattern):
            lines = path.read_text(encoding="utf-8").splitlines()
            if len(lines) > 500 and "long because" not in "\n".join(lines[:20]).lower():
                long.append(f"{path.relative_to(ROOT)}: {len(lines)} lines")
    assert long == []
