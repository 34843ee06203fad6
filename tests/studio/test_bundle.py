"""The built page that ships: made from these sources, small, and quiet on the network."""

import gzip
import hashlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "studio"
BUNDLE = ROOT / "python/voxsoft/studio/static"

# The same list as in studio/bundle-source.ts.
FILES = [
    ".npmrc",
    "bundle-source.ts",
    "index.html",
    "package-lock.json",
    "package.json",
    "tsconfig.json",
    "viewer.html",
    "vite.config.ts",
    "vite.viewer.config.ts",
]


def hash_of_sources():
    paths = list(FILES)
    for folder in ("src", "public"):
        paths += [
            path.relative_to(SOURCES).as_posix()
            for path in (SOURCES / folder).rglob("*")
            if path.is_file()
        ]
    total = hashlib.sha256()
    for path in sorted(paths):
        content = hashlib.sha256((SOURCES / path).read_bytes()).hexdigest()
        total.update(f"{path} {content}\n".encode())
    return total.hexdigest()


def shipped():
    return [path for path in sorted(BUNDLE.rglob("*")) if path.is_file()]


def test_the_bundle_was_built_from_these_sources():
    built = (BUNDLE / "SOURCE").read_text().strip()
    assert built == hash_of_sources(), "the page is older than its sources: run `make studio`"


def test_the_bundle_is_under_a_megabyte_compressed():
    # The WebAssembly core counts for itself: it is fetched only where there is no server.
    sizes = {
        path.name: len(gzip.compress(path.read_bytes(), 6))
        for path in shipped()
        if path.suffix != ".wasm" and path.name != "viewer.html"
    }
    assert sum(sizes.values()) < 1_000_000, sizes


# Namespaces and links in messages of libraries are names, not addresses that are fetched.
FETCHED = re.compile(
    r"""(?:src|href)=["']https?://|url\(["']?https?://|import\(["']https?://|fetch\(["'`]https?://"""
    r"""|@import\s+["']https?://|new (?:WebSocket|EventSource|Worker)\(["'`](?:https?|wss?)://"""
)


@pytest.mark.parametrize("path", shipped(), ids=lambda path: path.name)
def test_no_file_fetches_from_outside(path):
    if path.suffix in {".js", ".css", ".html", ".svg"}:
        assert FETCHED.findall(path.read_text(encoding="utf-8")) == []


def test_the_lock_file_names_no_host():
    assert '"resolved"' not in (SOURCES / "package-lock.json").read_text()
