"""Small pictures of designs, at rest where their equilibrium is known: drawn once, kept on disk."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from voxsoft.design import Design
from voxsoft.errors import FileError, MeshError, SimulationError, VoxSoftError
from voxsoft.files.figures import save_cutout, scale_of
from voxsoft.files.run_folder import make_folder
from voxsoft.plot.cutout import cutout
from voxsoft.simulation.setup.places import on_the_surface
from voxsoft.studio.bodies.body import PART_COLORS, filled_within_memory
from voxsoft.studio.bodies.objects import surroundings_of
from voxsoft.study.equilibria import Equilibria

#: Name of a folder of pictures, in that of a study and in the studio's own.
FOLDER: Final = "thumbnails"
#: Edition of the pictures; those of another one are drawn anew.
_EDITION: Final = "cut"
#: Number of pictures in the studio's own folder; those of a study are as many as its designs.
MOST: Final = 500


class NoLongerWantedError(Exception):
    """Nobody waits for the picture any more."""


class NoPictureError(FileError):
    """The listed file is no design that can be drawn, which is no fault of the list."""


@dataclass(frozen=True)
class Thumbnail:
    """A picture of a design.

    Attributes
    ----------
    content
        PNG without a background.
    at_rest
        True if it shows the body at rest under its loads; else it shows the unloaded shape.
    per_meter
        Pixels per meter; 0 where that is not known.
    """

    content: bytes
    at_rest: bool
    per_meter: float


class Thumbnails:
    """A folder of pictures, one for each name and state.

    Parameters
    ----------
    folder
        Made when there is something to keep.
    most
        Largest number of pictures; the oldest are dropped. None for any number.
    """

    def __init__(self, folder: Path, most: int | None = None) -> None:
        self._folder, self._most = folder, most

    def of(
        self,
        name: str,
        design: Callable[[], Design],
        known: Sequence[Equilibria],
        cancelled: threading.Event,
    ) -> Thumbnail:
        """Find the picture of a name, or draw it.

        Parameters
        ----------
        name
            Name in the folder.
        design
            Gives the design; called only where the picture at rest is not there yet.
        known
            Stores that may hold its equilibrium.
        cancelled
            Set where nobody waits for it any more.

        Raises
        ------
        VoxSoftError
            The design cannot be read or drawn.
        NoLongerWantedError
            `cancelled` was set before it was begun.
        """
        if cancelled.is_set():
            raise NoLongerWantedError
        try:
            return self._found(name, at_rest=True) or self._of(name, design(), known)
        except VoxSoftError:
            raise
        except MemoryError:
            what = "needs more memory than there is"
            raise MeshError("voxel_size", what, "make the voxels larger") from None
        except BaseException as error:  # a panic of the core too: the page must hear of it
            raise SimulationError(name, f"{type(error).__name__}: {error}") from None

    def _of(self, name: str, design: Design, known: Sequence[Equilibria]) -> Thumbnail:
        holders = [each for each in known if each.holds(design.hash)]
        before = None if holders else self._found(name, at_rest=False)
        if before is not None:
            return before
        mesh = filled_within_memory(design.assembled).mesh()
        equilibria = (each.find(design.hash, mesh) for each in holders)
        found = next((each for each in equilibria if each is not None), None)
        around = surroundings_of(design, {} if found is None else found.objects)
        positions = on_the_surface(design, mesh)
        if found is not None:
            positions = positions + found.positions - mesh.vertices
        picture = cutout(mesh, positions, colors=PART_COLORS, around=around)
        file = self._file(name, at_rest=found is not None)
        make_folder(self._folder)
        save_cutout(picture, file)
        self._make_room()
        return Thumbnail(file.read_bytes(), found is not None, picture.per_meter)

    def _found(self, name: str, *, at_rest: bool) -> Thumbnail | None:
        with suppress(OSError):
            content = self._file(name, at_rest=at_rest).read_bytes()
            return Thumbnail(content, at_rest, scale_of(content) or 0.0)
        return None

    def _file(self, name: str, *, at_rest: bool) -> Path:
        if not name.isalnum():
            raise FileError(name[:80], "is no name of a picture")
        return self._folder / f"{name}-{_EDITION}-{'rest' if at_rest else 'unloaded'}.png"

    def _make_room(self) -> None:
        if self._most is None:
            return
        with suppress(OSError):
            files = sorted(self._folder.glob("*.png"), key=lambda file: file.stat().st_mtime_ns)
            for file in files[: max(0, len(files) - self._most)]:
                file.unlink(missing_ok=True)
