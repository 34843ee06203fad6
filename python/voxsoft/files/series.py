"""Series: the states of a path or a motion, each with all of its fields, for ParaView.

A series is a list of files, ``.pvd``, with a folder ``NAME-states`` beside it: for each state a
VTU of the body as in a run folder, and one of the rigid objects where there are any. Points are
unloaded in both, and the array ``displacement`` moves them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from itertools import pairwise
from pathlib import Path
from typing import Final, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.errors import ErrorDetail, FileError
from voxsoft.files.atomic import replace_whole, write_atomically
from voxsoft.files.meshes import read_mesh_file, write_mesh
from voxsoft.files.motion_frames import FRAMES, MotionFrames, read_frames
from voxsoft.files.path_states import read_states
from voxsoft.files.run_folder import fields_in, make_folder, read_summary
from voxsoft.files.scenes.scene import pose_at, poses_of_run
from voxsoft.mesh import Mesh
from voxsoft.simulation import LoadPath, Result, Setup, named_regions
from voxsoft.simulation.features import has_feature
from voxsoft.simulation.results.fields import fields_of
from voxsoft.simulation.setup.contact import Pose
from voxsoft.simulation.setup.distance import Surface

Floats = NDArray[np.float64]

#: Features of a design by which stress depends on more than positions, with the reason.
_NOT_IN_FRAMES: Final[Mapping[str, str]] = {
    "softening": "depends on the largest stretch before, which a recording does not have",
    "activations": "depends on the activation, which a recording does not have",
}


@dataclass(frozen=True, eq=False)
class SeriesState:
    """A state of a series.

    Attributes
    ----------
    mesh
        Mesh of the unloaded body.
    point_data, cell_data
        Arrays on its vertices, (n, ...), and in its tets, (m, ...), in SI units.
    regions
        Vertices of each named region.
    poses
        Pose of each rigid object by name; one that is left out stands where the design has it.
    """

    mesh: Mesh
    point_data: Mapping[str, NDArray[np.generic]]
    cell_data: Mapping[str, NDArray[np.generic]]
    regions: Mapping[str, NDArray[np.integer]] = field(default_factory=dict)
    poses: Mapping[str, Pose] = field(default_factory=dict)


class SeriesSource(Protocol):
    """Subject of an export whose file is a series."""

    def series(self) -> Series:
        """Return the series."""


@dataclass(frozen=True, eq=False)
class Series:
    """States with their times.

    Attributes
    ----------
    times
        Time of each state, ascending: seconds, or the values of a path.
    state
        Function from the number of a state to the state: only one is in memory at a time.
    objects
        Unloaded surface of each rigid object by name.
    lost
        Contents that a file of the series does not hold.
    """

    times: tuple[float, ...]
    state: Callable[[int], SeriesState] = field(repr=False)
    objects: Mapping[str, Surface] = field(default_factory=dict, repr=False)
    lost: tuple[ErrorDetail, ...] = ()

    @classmethod
    def of(cls, body: Result | LoadPath | Sequence[Result]) -> Self:
        """Make a series.

        Parameters
        ----------
        body
            A path, whose values are the times; several results, at 0, 1, 2; or one result, with
            all of its recording if that has frames, else as a single state.

        Raises
        ------
        FileError
            No result.
        """
        if isinstance(body, Result):
            if len(body.recording.frames):
                return cls._of_frames(MotionFrames.of(body), body.design, body.mesh)
            return cls._of_results([body], (body.time or 1.0,))
        if isinstance(body, LoadPath):
            times, lost = times_of(body.over.key, body.values)
            return cls._of_results(body.results, times, lost)
        results = list(body)
        if not results:
            raise FileError("results", "holds no result", "give one or more")
        return cls._of_results(results, tuple(map(float, range(len(results)))))

    @classmethod
    def of_run(cls, folder: Path, design: Design) -> Self:
        """Make a series of a run folder: all equilibria of a path or frames, else its one result.

        Parameters
        ----------
        folder
            The run folder.
        design
            Its design.

        Raises
        ------
        FileError
            A file of the folder is missing or damaged.
        """
        states = read_states(folder)
        if states is not None:
            mesh = Setup.of(states.design(0), allow_loose=True, refine=design.solver.refine).mesh
            states.check(mesh)
            times, lost = times_of(states.key, states.values)

            def equilibrium(number: int) -> SeriesState:
                then = states.design(number)
                measured = fields_of(
                    then, mesh, states.positions(number), peaks=states.peaks(number)
                )
                return SeriesState(
                    mesh,
                    {**states.point_data(number, mesh), **measured.point_data()},
                    measured.cell_data(mesh),
                    named_regions(then, mesh),
                    states.poses(number),
                )

            return cls(times, equilibrium, _objects_of(states.design(0), mesh), lost)
        summary = read_summary(folder)
        mesh = Setup.of(design, allow_loose=True, refine=design.solver.refine).mesh
        frames = read_frames(folder, str(summary.get("hash")))
        if frames is not None:
            frames.check(mesh, folder / FRAMES)
            return cls._of_frames(frames, design, mesh)
        body = read_mesh_file(folder / "result.vtu")
        poses = poses_of_run(folder)
        found = SeriesState(body.mesh, body.point_data, body.cell_data, body.regions, poses)
        time = float(summary.get("time") or 1.0)
        return cls((time,), lambda _: found, _objects_of(design, mesh))

    @classmethod
    def _of_results(
        cls,
        results: Sequence[Result],
        times: tuple[float, ...],
        lost: tuple[ErrorDetail, ...] = (),
    ) -> Self:
        def state(number: int) -> SeriesState:
            result = results[number]
            points, cells = fields_in(result)
            regions = named_regions(result.design, result.mesh)
            return SeriesState(result.mesh, points, cells, regions, result.objects)

        return cls(times, state, _objects_of(results[0].design, results[0].mesh), lost)

    @classmethod
    def _of_frames(cls, frames: MotionFrames, design: Design, mesh: Mesh) -> Self:
        regions = named_regions(design, mesh)
        lost = tuple(
            ErrorDetail(feature, f"stress and stretch over time are left out: stress {reason}")
            for feature, reason in _NOT_IN_FRAMES.items()
            if has_feature(design, feature)
        )

        def state(number: int) -> SeriesState:
            positions = frames.positions[number]
            points: dict[str, Floats] = {"displacement": positions - mesh.vertices}
            cells: dict[str, Floats] = {}
            if not lost:
                measured = fields_of(design, mesh, positions)
                points |= measured.point_data()
                cells = measured.cell_data(mesh)
            poses = {
                name: pose_at(at[number], turn[number])
                for name, (at, turn) in frames.objects.items()
            }
            return SeriesState(mesh, points, cells, regions, poses)

        times = tuple(map(float, frames.times))
        return cls(times, state, _objects_of(design, mesh), lost)


def times_of(
    key: str, values: Sequence[float]
) -> tuple[tuple[float, ...], tuple[ErrorDetail, ...]]:
    """Return the times of a path: its values where they ascend, else 0, 1, 2, with a sentence.

    Examples
    --------
    >>> times_of("loads[0].value", (0.0, 500.0))
    ((0.0, 500.0), ())
    >>> times, lost = times_of("loads[0].value", (0.0, 500.0, 0.0))
    >>> times, lost[0].what
    ((0.0, 1.0, 2.0), 'does not ascend: times are numbers, of the values 0, 500, 0')
    """
    if all(a < b for a, b in pairwise(values)):
        return tuple(map(float, values)), ()
    shown = ", ".join(f"{value:.6g}" for value in values)
    what = f"does not ascend: times are numbers, of the values {shown}"
    return tuple(map(float, range(len(values)))), (ErrorDetail(key, what),)


def write(target: Path, source: SeriesSource) -> tuple[ErrorDetail, ...]:
    """Write a ``.pvd`` with the files of its states; the list comes last, when all are there.

    Returns
    -------
    tuple of ErrorDetail
        Contents that the files do not hold.

    Raises
    ------
    FileError, OutputError
        A file cannot be written.
    """
    series = source.series()
    folder = make_folder(target.with_name(f"{target.stem}-states"))
    rows = []
    for number, time in enumerate(series.times):
        state = series.state(number)
        files = {"body": folder / f"body-{number:04}.vtu"}
        write_mesh(
            files["body"],
            state.mesh,
            point_data=state.point_data,
            cell_data=state.cell_data,
            regions=state.regions,
        )
        if series.objects:
            files["objects"] = folder / f"objects-{number:04}.vtu"
            _write_objects(files["objects"], series.objects, state.poses)
        rows += [
            f'    <DataSet timestep="{time!r}" part="{part}" name="{name}" '
            f'file="{escape(file.relative_to(target.parent).as_posix())}"/>'
            for part, (name, file) in enumerate(files.items())
        ]
    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">',
        "  <Collection>",
        *rows,
        "  </Collection>",
        "</VTKFile>",
        "",
    ]
    write_atomically(target, "\n".join(lines))
    return series.lost


def _write_objects(path: Path, objects: Mapping[str, Surface], poses: Mapping[str, Pose]) -> None:
    """Write the surfaces of objects, unloaded, with their motion and number from 1."""
    import meshio  # slow to load

    surfaces = list(objects.values())
    firsts = np.cumsum([0, *(len(each.vertices) for each in surfaces)])
    triangles = [s.triangles.astype(np.int64) + f for s, f in zip(surfaces, firsts, strict=False)]
    moved = [_displacement(each, poses.get(name)) for name, each in objects.items()]
    numbers = np.repeat(np.arange(1, len(surfaces) + 1, dtype=np.int32), list(map(len, triangles)))
    mesh = meshio.Mesh(
        np.concatenate([each.vertices for each in surfaces]),
        [("triangle", np.concatenate(triangles))],
        {"displacement": np.concatenate(moved)},
        {"object": [numbers]},
    )
    replace_whole(path, lambda temporary: meshio.vtu.write(str(temporary), mesh))


def _displacement(surface: Surface, pose: Pose | None) -> Floats:
    """Return the motion of each vertex of an object to a pose [m], (n, 3)."""
    if pose is None:
        return np.zeros_like(surface.vertices)
    turned = (surface.vertices - surface.middle) @ np.asarray(pose.rotation).T
    moved: Floats = turned + np.asarray(pose.position) - surface.vertices
    return moved


def _objects_of(design: Design, mesh: Mesh) -> dict[str, Surface]:
    """Return the unloaded surface of each object by name; none for a design without objects."""
    touching = Setup(design.assembled, mesh).touching if design.assembled.objects else None
    if touching is None:
        return {}
    names = [each.name for each in design.assembled.objects]
    return dict(zip(names, touching.surfaces, strict=True))
