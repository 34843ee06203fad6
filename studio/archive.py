"""Keep the one archive of the built page as new as its sources.

    python studio/archive.py check   # build it if it is older than its sources (`make install`)
    python studio/archive.py build   # build it in any case (`make studio`)

The archive is python/voxsoft/studio/page.zip. It holds the page, the core that the page was built
with (studio/public), and a hash of both in SOURCE. Entries are sorted, dated alike and compressed;
an archive whose sources are as they were is not written again.
"""

from __future__ import annotations

import argparse
import hashlib
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Mapping
from pathlib import Path

STUDIO = Path(__file__).resolve().parent
ARCHIVE = STUDIO.parent / "python/voxsoft/studio/page.zip"
# Where Vite writes the page (vite.config.ts).
BUILT = STUDIO.parent / "target/page"
OLDEST_NODE = (20, 19)  # as in package.json

# What decides the page, beside src and the core.
FILES = [
    ".npmrc",
    "index.html",
    "package-lock.json",
    "package.json",
    "tsconfig.json",
    "viewer.html",
    "vite.config.ts",
    "vite.viewer.config.ts",
]


class CannotBuildError(Exception):
    """The page cannot be built here, and why."""


def files_below(folder: Path) -> dict[str, bytes]:
    """The files of a folder by their paths in it."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def core_here() -> dict[str, bytes]:
    """The core that the next page is built with."""
    return {f"public/{name}": data for name, data in files_below(STUDIO / "public").items()}


def archived() -> dict[str, bytes]:
    """The files of the archive; none if there is no archive, or a damaged one."""
    try:
        with zipfile.ZipFile(ARCHIVE) as archive:
            return {name: archive.read(name) for name in archive.namelist()}
    except (OSError, zipfile.BadZipFile):
        return {}


def hash_of_sources(core: Mapping[str, bytes]) -> str:
    """One hash of everything that a page with this core is built from."""
    contents = {name: (STUDIO / name).read_bytes() for name in FILES} | dict(core)
    contents |= {f"src/{name}": data for name, data in files_below(STUDIO / "src").items()}
    total = hashlib.sha256()
    for name in sorted(contents):
        total.update(f"{name} {hashlib.sha256(contents[name]).hexdigest()}\n".encode())
    return total.hexdigest()


def is_fresh(archive: Mapping[str, bytes]) -> bool:
    """Whether an archive was built from the sources that are here, and from the core in it."""
    core = {name: data for name, data in archive.items() if name.startswith("public/")}
    return archive.get("SOURCE", b"").decode().strip() == hash_of_sources(core)


def unpack_core(archive: Mapping[str, bytes]) -> None:
    """Put the core of an archive where builds and tests look for it."""
    for name, data in archive.items():
        path = STUDIO / name
        if name.startswith("public/") and not (path.is_file() and path.read_bytes() == data):
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(data)


def pack(contents: Mapping[str, bytes]) -> None:
    """Write an archive, all at once."""
    partial = ARCHIVE.with_suffix(".partial")
    with zipfile.ZipFile(partial, "w") as archive:
        for name in sorted(contents):
            entry = zipfile.ZipInfo(name)  # dated 1980
            entry.create_system, entry.external_attr = 3, 0o644 << 16
            archive.writestr(entry, contents[name], zipfile.ZIP_DEFLATED, compresslevel=9)
    partial.replace(ARCHIVE)


def build() -> None:
    """Build the page with Node and write the archive.

    Raises
    ------
    CannotBuildError
        Node is missing or old, npm cannot fetch what it needs, or the sources are wrong.
    """
    npm = npm_of_a_new_node()
    installed = STUDIO / "node_modules/.package-lock.json"
    lock = STUDIO / "package-lock.json"
    if not installed.is_file() or installed.stat().st_mtime < lock.stat().st_mtime:
        run(npm, "ci", "--silent")
    shutil.rmtree(BUILT, ignore_errors=True)
    run(npm, "run", "build", "--silent")
    core = core_here()
    source = f"{hash_of_sources(core)}\n".encode()
    page = {f"page/{name}": data for name, data in files_below(BUILT).items()}
    pack({**page, **core, "SOURCE": source})
    print(f"{ARCHIVE.relative_to(STUDIO.parent)} is built from studio: commit it with the change.")


def npm_of_a_new_node() -> str:
    """The path of npm, if the Node beside it is new enough."""
    needed = f"it needs npm and Node {'.'.join(map(str, OLDEST_NODE))} or newer"
    node, npm = shutil.which("node"), shutil.which("npm")
    if node is None or npm is None:
        raise CannotBuildError(f"{needed}, and there is none")
    answer = subprocess.run([node, "--version"], capture_output=True, text=True, check=False)
    if tuple(int(number) for number in re.findall(r"\d+", answer.stdout)[:2]) < OLDEST_NODE:
        raise CannotBuildError(f"{needed}, and Node is {answer.stdout.strip()}")
    return npm


def run(*command: str) -> None:
    """Run a command in the page's folder."""
    done = subprocess.run(command, cwd=STUDIO, capture_output=True, text=True, check=False)
    if done.returncode:
        last = "\n".join((done.stdout + done.stderr).strip().splitlines()[-12:])
        raise CannotBuildError(f"`npm {' '.join(command[1:])}` failed:\n{last}")


def main() -> int:
    """Do what the command line asks for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("what", choices=["check", "build"])
    is_asked = parser.parse_args().what == "build"
    archive = archived()
    if not is_asked and is_fresh(archive):
        unpack_core(archive)
        return 0
    if not core_here():
        unpack_core(archive)
    try:
        build()
    except CannotBuildError as reason:
        print(f"The studio's page was not built: {reason}", file=sys.stderr)
        if not is_asked:
            state = "is older than its sources" if archive else "is missing"
            print(f"{ARCHIVE.name} {state}; nothing else depends on it.", file=sys.stderr)
        return int(is_asked)
    return 0


if __name__ == "__main__":
    sys.exit(main())
