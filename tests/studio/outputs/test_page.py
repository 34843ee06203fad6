"""The built page that ships: one archive, made from these sources, small, quiet on the network."""

import gzip
import os
import re
import shutil
import subprocess
import sys
import zipfile
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest
from starlette.testclient import TestClient

from voxsoft.studio.outputs.page import page_file
from voxsoft.studio.server.app import make_app

ROOT = Path(__file__).parents[3]
SOURCES = ROOT / "studio"


def tool(path):
    """The script that builds and packs the page, for the tree that it stands in."""
    spec = spec_from_file_location("archive", path)
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


PAGE = {
    name.removeprefix("page/"): content
    for name, content in tool(SOURCES / "archive.py").archived().items()
    if name.startswith("page/")
}


def test_the_archive_was_built_from_these_sources():
    archive = tool(SOURCES / "archive.py")
    hint = "the page is older than its sources: run `make studio` and commit the archive"
    assert archive.is_fresh(archive.archived()), hint


def test_the_page_is_under_a_megabyte_compressed():
    # The single file holds the WebAssembly core, and is fetched only where there is no server.
    sizes = {
        name: len(gzip.compress(content, 6))
        for name, content in PAGE.items()
        if name != "viewer.html"
    }
    assert len(sizes) > 50
    assert sum(sizes.values()) < 1_000_000, sizes


# Namespaces and links in messages of libraries are names, not addresses that are fetched.
FETCHED = re.compile(
    r"""(?:src|href)=["']https?://|url\(["']?https?://|import\(["']https?://|fetch\(["'`]https?://"""
    r"""|@import\s+["']https?://|new (?:WebSocket|EventSource|Worker)\(["'`](?:https?|wss?)://"""
)


@pytest.mark.parametrize("name", sorted(PAGE))
def test_no_file_fetches_from_outside(name):
    if Path(name).suffix in {".js", ".css", ".html", ".svg"}:
        assert FETCHED.findall(PAGE[name].decode()) == []


def test_the_lock_file_names_no_host():
    assert '"resolved"' not in (SOURCES / "package-lock.json").read_text()


def test_files_of_the_page_are_served_from_the_archive():
    app = make_app(_NoSession(), token="secret", port=80)
    with TestClient(app, base_url="http://127.0.0.1") as browser:
        index = browser.get("/?token=secret")
        assert index.content == page_file("index.html")
        script = browser.get("/assets/index.js")
        assert script.content == page_file("assets/index.js")
        assert script.headers["content-type"].startswith("text/javascript")
        known = {"if-none-match": script.headers["etag"]}
        assert browser.get("/assets/index.js", headers=known).status_code == 304
        for other in ["/assets/none.js", "/SOURCE", "/assets/%2e%2e/%2e%2e/SOURCE", "/a%00b"]:
            assert browser.get(other).status_code == 404, other


def test_without_a_page_the_server_says_how_to_build_one(monkeypatch, tmp_path):
    monkeypatch.setattr("voxsoft.studio.outputs.page.ARCHIVE", tmp_path / "page.zip")
    app = make_app(_NoSession(), token="secret", port=80)
    with TestClient(app, base_url="http://127.0.0.1") as browser:
        assert "make studio" in browser.get("/?token=secret").text
        (tmp_path / "page.zip").write_bytes(b"cut off")
        assert "make studio" in browser.get("/?token=secret").text


class _NoSession:
    def start(self):
        pass

    def end(self):
        pass


@pytest.fixture
def tree(tmp_path):
    """A source tree whose page is one script, with its archive, and an npm that copies it."""
    studio = tmp_path / "studio"
    (studio / "src").mkdir(parents=True)
    (tmp_path / "python/voxsoft/studio").mkdir(parents=True)
    shutil.copy(SOURCES / "archive.py", studio)
    for name in tool(studio / "archive.py").FILES:
        (studio / name).write_text("{}")
    (studio / "src/main.ts").write_text("one")
    (studio / "public").mkdir()
    (studio / "public/core.wasm").write_bytes(b"core")
    commands = tmp_path / "bin"
    commands.mkdir()
    for name, text in {
        "node": "echo v20.19.1",
        "npm": "[ $1 = ci ] && exit; mkdir -p ../target/page; cp src/main.ts ../target/page/a.js",
    }.items():
        (commands / name).write_text(f"#!/bin/sh\n{text}\n")
        (commands / name).chmod(0o755)
    made = archive(tmp_path, "build")
    assert made.returncode == 0, made.stderr
    return tmp_path


def archive(tree, what, path=None):
    """Run the script of a tree, with its own Node unless another path is given."""
    path = f"{tree / 'bin'}{os.pathsep}/usr/bin{os.pathsep}/bin" if path is None else path
    command = [sys.executable, "studio/archive.py", what]
    return subprocess.run(
        command, cwd=tree, capture_output=True, text=True, check=False, env={"PATH": path}
    )


def packed(tree):
    with zipfile.ZipFile(tree / "python/voxsoft/studio/page.zip") as found:
        return {name: found.read(name) for name in found.namelist()}


def bits(tree):
    return (tree / "python/voxsoft/studio/page.zip").read_bytes()


def test_a_fresh_archive_is_left_alone_and_gives_its_core(tree):
    before = bits(tree)
    shutil.rmtree(tree / "studio/public")
    checked = archive(tree, "check", path="")
    assert (checked.returncode, checked.stdout, checked.stderr) == (0, "", "")
    assert bits(tree) == before
    assert (tree / "studio/public/core.wasm").read_bytes() == b"core"


def test_the_same_page_gives_the_same_bits(tree):
    before = bits(tree)
    os.utime(tree / "studio/src/main.ts")
    assert archive(tree, "build").returncode == 0
    assert bits(tree) == before


@pytest.mark.parametrize("changed", ["src/main.ts", "src/new.css", "vite.config.ts"])
def test_a_stale_archive_is_built_where_node_is_there(tree, changed):
    (tree / "studio" / changed).write_text("two")
    checked = archive(tree, "check")
    assert checked.returncode == 0, checked.stderr
    assert "commit it with the change" in checked.stdout
    main = (tree / "studio/src/main.ts").read_bytes()
    assert packed(tree)["page/a.js"] == main
    assert archive(tree, "check").stdout == ""


def test_a_new_core_goes_into_the_archive(tree):
    (tree / "studio/public/core.wasm").write_bytes(b"newer")
    assert archive(tree, "build").returncode == 0
    assert packed(tree)["public/core.wasm"] == b"newer"


def test_an_archive_that_came_with_a_pull_brings_its_core(tree):
    (tree / "studio/public/core.wasm").write_bytes(b"left from before")
    before = bits(tree)
    assert archive(tree, "check").returncode == 0
    assert bits(tree) == before
    assert (tree / "studio/public/core.wasm").read_bytes() == b"core"


def without_node(tree):
    for name in ("node", "npm"):
        (tree / "bin" / name).unlink()


def with_an_old_node(tree):
    (tree / "bin/node").write_text("#!/bin/sh\necho v18.20.0\n")


def without_network(tree):
    (tree / "bin/npm").write_text("#!/bin/sh\necho 'getaddrinfo ENOTFOUND' >&2; exit 1\n")


@pytest.mark.parametrize(
    ("obstacle", "reason"),
    [
        (without_node, "there is none"),
        (with_an_old_node, "Node is v18.20.0"),
        (without_network, "ENOTFOUND"),
    ],
)
def test_a_page_that_cannot_be_built_keeps_the_older_one(tree, obstacle, reason):
    before = bits(tree)
    obstacle(tree)
    (tree / "studio/src/main.ts").write_text("two")
    path = str(tree / "bin") if obstacle is without_node else None
    checked = archive(tree, "check", path=path)
    assert checked.returncode == 0
    assert reason in checked.stderr
    assert "older than its sources" in checked.stderr
    assert bits(tree) == before
    assert archive(tree, "build", path=path).returncode == 1
