"""Frames of a motion in its run folder, ``frames.npz``: times, positions, and poses of objects."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Self
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.files.atomic import replace_whole
from voxsoft.mesh import Mesh
from voxsoft.simulation import Result

Floats = NDArray[np.float64]

#: Name of the file in a run folder.
FRAMES: Final = "frames.npz"
_AGAIN: Final = "run the design again with --frames"


@dataclass(frozen=True, eq=False)
class MotionFrames:
    """Body and objects at instants of a motion.

    Attributes
    ----------
    times
        Instants [s], (f,).
    positions
        Positions of all vertices [m], (f, n, 3).
    objects
        Positions [m], (f, 3), and rotations from the first pose, (f, 3, 3), of each object by
        name.
    """

    times: Floats = field(repr=False)
    positions: Floats = field(repr=False)
    objects: Mapping[str, tuple[Floats, Floats]] = field(repr=False)

    @classmethod
    def of(cls, result: Result) -> Self:
        """Return the frames of a result; none where it recorded none."""
        recording = result.recording
        return cls(recording.times, recording.frames, recording.objects)

    def check(self, mesh: Mesh, file: Path) -> None:
        """Refuse a mesh that is not that of the frames.

        Raises
        ------
        FileError
            It has another number of vertices.
        """
        if self.positions.shape[1:] != mesh.vertices.shape:
            what = "holds frames on another mesh than that of the design beside it"
            raise FileError(str(file), what, _AGAIN)


def write_frames(result: Result, folder: Path) -> None:
    """Write the frames of a result.

    Raises
    ------
    OutputError
        The file cannot be written.
    """
    frames = MotionFrames.of(result)
    arrays: dict[str, Any] = {"times": frames.times, "positions": frames.positions}
    for name, (at, turned) in frames.objects.items():
        arrays |= {f"at.{name}": at, f"turned.{name}": turned}
    arrays["hash"] = np.array(result.design.hash)
    replace_whole(folder / FRAMES, lambda beside: np.savez_compressed(beside, **arrays))


def read_frames(folder: Path, design_hash: str) -> MotionFrames | None:
    """Read the frames of a run folder; None where its run kept none.

    Parameters
    ----------
    folder
        The run folder.
    design_hash
        Hash of the design in its summary.

    Raises
    ------
    FileError
        The file is damaged, or holds the frames of another design.
    """
    file = folder / FRAMES
    if not file.is_file():
        return None
    try:
        with np.load(file, allow_pickle=False) as content:
            found = {name: content[name] for name in content}
        objects = {
            name.removeprefix("at."): (at, found[f"turned.{name.removeprefix('at.')}"])
            for name, at in found.items()
            if name.startswith("at.")
        }
        frames = MotionFrames(found["times"], found["positions"], objects)
        is_ours = str(found["hash"]) == design_hash
        if frames.positions.ndim != 3 or len(frames.times) != len(frames.positions):
            raise ValueError(f"{len(frames.times)} times and {frames.positions.shape} positions")
    except (OSError, ValueError, KeyError, EOFError, BadZipFile) as error:
        raise FileError(str(file), f"is damaged: {error!r}", _AGAIN) from None
    if not is_ours:
        raise FileError(str(file), "holds the frames of another design", _AGAIN)
    return frames
