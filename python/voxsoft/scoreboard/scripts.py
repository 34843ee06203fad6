"""Cases of the scoreboard: scripts that predict measured numbers."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from types import ModuleType
from typing import Final

from voxsoft.errors import FileError, VoxSoftError
from voxsoft.records import closest
from voxsoft.scoreboard.board import Scoreboard
from voxsoft.scoreboard.prediction import Prediction

#: Name of the function of a script that makes it a case.
FUNCTION: Final = "predictions"

#: Function called before a script is run, with its name, its number, and the number of all.
Announce = Callable[[str, int, int], None]


def predictions_in(
    folder: Path, names: Sequence[str] = (), announce: Announce | None = None
) -> Scoreboard:
    """Run the cases of a folder: its Python files that define a function ``predictions``.

    Parameters
    ----------
    folder
        Folder of the scripts.
    names
        Names of files without ``.py``; default: all.
    announce
        Called before each script.

    Returns
    -------
    Scoreboard
        Predictions of all cases. A case that fails is among the failed ones, and the others stay.

    Raises
    ------
    FileError
        There is no such folder, no such case, or no case at all.
    """
    if not folder.is_dir():
        hint = "name the folder of the cases, examples/validation of the repository"
        raise FileError(str(folder), "is not a folder", hint)
    scripts = [path for path in sorted(folder.glob("*.py")) if f"def {FUNCTION}(" in _text(path)]
    known = [path.stem for path in scripts]
    for name in names:
        if name not in known:
            raise FileError(name, f"is not a case of {folder}", closest(name, known))
    chosen = [path for path in scripts if not names or path.stem in names]
    if not chosen:
        what = f"has no script with a function {FUNCTION}"
        raise FileError(str(folder), what, "see examples/validation of the repository")
    found: list[Prediction] = []
    failed: dict[str, str] = {}
    for number, path in enumerate(chosen):
        if announce is not None:
            announce(path.stem, number, len(chosen))
        try:
            made: Iterable[Prediction] = getattr(_module(path), FUNCTION)()
            found += list(made)
        except (VoxSoftError, ArithmeticError, ValueError, AssertionError, SystemExit) as error:
            failed[path.stem] = str(error).partition("\n")[0] or type(error).__name__
    return Scoreboard(tuple(found), failed)


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace")


def _module(path: Path) -> ModuleType:
    """Import a script as a module; it may import its neighbors."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None  # it is a Python file
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(path.parent))
    sys.modules[path.stem] = module
    try:
        spec.loader.exec_module(module)
    finally:
        sys.path.pop(0)
    return module
