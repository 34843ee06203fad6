"""Memory is a value: problems and contact change only through ``&mut``."""

import re
from pathlib import Path

import pytest

CRATES = Path(__file__).parents[2] / "crates"
#: Types that let shared data change.
INTERIOR = re.compile(
    r"\b(?:Mutex|RwLock|RefCell|OnceCell|OnceLock|LazyCell|LazyLock|UnsafeCell|Atomic\w+|Cell<)"
)
#: Files that may hold some, and why.
CACHES = {
    "solid/src/element/clamp_modes.rs": "tables of the element at a clamp, each made once",
}


def test_problems_hold_no_interior_mutability():
    found = {
        path.relative_to(CRATES).as_posix()
        for crate in ("solid", "contact")
        for path in (CRATES / crate / "src").rglob("*.rs")
        if INTERIOR.search(path.read_text(encoding="utf-8"))
    }
    assert found <= CACHES.keys(), "keep what is remembered in Memory, and change it through &mut"
    assert found == CACHES.keys(), "a cache is none any more"


@pytest.mark.parametrize(
    "line",
    [
        "state: Arc<Mutex<State>>,",
        "peak: AtomicU64,",
        "use std::cell::RefCell;",
        "kept: Cell<f64>,",
    ],
)
def test_ways_around_are_known(line):
    assert INTERIOR.search(line)
