"""Bodies at rest for pictures beside the view: of runs, of designs of studies, of calibrations.

They are read from disk, or are solved here, and the body that the view shows is not
touched.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import msgspec
import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.document.documents import with_absolute_paths
from voxsoft.errors import FileError, MeshError, SimulationError, VoxSoftError
from voxsoft.files.designs import read_document, read_text
from voxsoft.files.specimen import read_specimen
from voxsoft.jobs import load
from voxsoft.simulation import Setup, simulate
from voxsoft.simulation.features import has_feature
from voxsoft.simulation.results.fields import remember
from voxsoft.simulation.setup.contact import Pose
from voxsoft.simulation.setup.places import on_the_surface
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.fields import DISPLACEMENT, FIELDS
from voxsoft.studio.bodies.objects import surroundings_of
from voxsoft.studio.bodies.reopening import Known, known_equilibrium, run_positions, stored_in
from voxsoft.studio.bodies.surface import Surface
from voxsoft.studio.protocol.wire import STILL_BODY, STILL_OBJECTS, FrameFlag
from voxsoft.studio.running.runs import RunList, kind_of, read_summary
from voxsoft.studio.running.studying import design_text_of, stored_study, stored_trial
from voxsoft.study.trial import Trial

#: Bodies that were solved for a picture and are kept, so that another look costs nothing.
MOST_KEPT: Final = 4
#: Fields that tell something of a body at rest.
_FIELDS: Final = tuple(each for each in FIELDS if each.name != "speed")
_FLAGS: Final = {
    "ok": FrameFlag.PAUSED | FrameFlag.AT_REST,
    "diverged": FrameFlag.PAUSED | FrameFlag.DIVERGED,
}


class StillCancelledError(Exception):
    """Nobody waits for the picture any more."""


@dataclass(frozen=True, eq=False)
class Still:
    """A body in one state.

    Attributes
    ----------
    setup
        The body.
    positions
        Positions of its vertices [m], (n, 3).
    status
        Status of the solution: ``ok``, ``not-at-rest`` or ``diverged``.
    fields
        Fields that are known of that state.
    poses
        Poses of rigid objects by name; others stand in their first poses.
    """

    setup: Setup = field(repr=False)
    positions: NDArray[np.float64] = field(repr=False)
    status: str = "ok"
    fields: tuple[str, ...] = tuple(each.name for each in _FIELDS)
    poses: Mapping[str, Pose] = field(default_factory=dict, repr=False)

    def packed(self) -> bytes:
        """Write it as the page reads it: the surface, a frame for each field, shape, objects."""
        mesh, flags = self.setup.mesh, _FLAGS.get(self.status, FrameFlag.PAUSED)
        surface = Surface.of(mesh)
        messages = [surface.outline.pack_topology(STILL_BODY)]
        try:
            triangles, size = mesh.triangles.astype(np.uint32), mesh.voxel_size or 0.0
            problem = self.setup.problem_alone
            display = _core.Display.surface(problem, triangles, surface.tags, size)
        except VoxSoftError:  # no problem to solve, such as a card that is gone: only the shape
            moved = np.linalg.norm(self.positions - mesh.vertices, axis=1)
            shape = surface.outline.pack_frame(
                self.positions,
                topology=STILL_BODY,
                field=DISPLACEMENT,
                values=moved[surface.vertices],
                flags=flags,
            )
            return b"".join([*messages, shape, *self._smooth(surface), *self._objects()])
        messages += [
            display.pack_frame(
                self.positions, topology=STILL_BODY, frame=0, field=each.id, flags=flags
            )
            for each in _FIELDS
            if each.name in self.fields
        ]
        return b"".join([*messages, *self._smooth(surface), *self._objects()])

    def _smooth(self, surface: Surface) -> Iterator[bytes]:
        """The surface of cut voxels on that of the shapes that cut them, unloaded."""
        mesh, triangles = self.setup.mesh, surface.outline.triangles
        if mesh.fractions is not None:
            points = on_the_surface(self.setup.design, mesh)[surface.vertices]
            owners = np.zeros(len(triangles), dtype=np.uint8)
            yield _core.pack_smooth(STILL_BODY, points, triangles, owners)

    def _objects(self) -> Iterator[bytes]:
        """The surface of all rigid objects where they are, if there are any."""
        found = surroundings_of(self.setup.design, self.poses).objects
        if found is not None:
            tags = np.zeros(len(found.triangles), dtype=np.uint8)
            outline = _core.Outline.surface(found.vertices, found.triangles, tags, 0.0)
            yield outline.pack_topology(STILL_OBJECTS)


class Stills:
    """Finds or solves bodies by the names that the list of runs gives them.

    Parameters
    ----------
    runs
        The list.
    """

    def __init__(self, runs: RunList) -> None:
        self._runs = runs
        self._solved: OrderedDict[str, Still] = OrderedDict()
        self._lock = threading.Lock()

    def packed(self, name: str, cancelled: threading.Event) -> bytes:
        """Write a body as the page reads it.

        Parameters
        ----------
        name
            A run; a study, for its best design; "STUDY/NUMBER" for another; or a calibration, for
            its best candidate.
        cancelled
            Set where nobody waits for it any more.

        Raises
        ------
        VoxSoftError
            There is no such body, or it cannot be solved.
        StillCancelledError
            `cancelled` was set meanwhile.
        """
        try:
            if cancelled.is_set():
                raise StillCancelledError
            return self._still(name, cancelled).packed()
        except (VoxSoftError, StillCancelledError):
            raise
        except MemoryError:
            what = "needs more memory than there is"
            raise MeshError("voxel_size", what, "make the voxels larger") from None
        except BaseException as error:  # a panic of the core too: the page must hear of it
            raise SimulationError(name, f"{type(error).__name__}: {error}") from None

    def _still(self, name: str, cancelled: threading.Event) -> Still:
        run, _, number = name.rpartition("/")
        folder = self._runs.folder_of(run or name)
        if run:
            return self._trial(folder, stored_trial(folder, number), cancelled)
        match kind_of(folder):
            case "run":
                return _of_run(folder)
            case "study":
                best = stored_study(folder).best
                if best is None:
                    raise FileError(name, "holds no good design yet")
                return self._trial(folder, best, cancelled)
            case "calibrate":
                setup = Setup.of(design_in(folder))
                positions = read_specimen(folder, len(setup.mesh.vertices))
                # The stress would be that of the material of the design, not of the candidate.
                return Still(setup, positions, fields=(FIELDS[DISPLACEMENT].name,))
        raise FileError(name, "holds neither a run nor a study")

    def _trial(self, folder: Path, trial: Trial, cancelled: threading.Event) -> Still:
        design = design_in(folder).with_parameters(**trial.parameters)
        key = design.hash
        with self._lock:
            if (known := self._solved.get(key)) is not None:
                self._solved.move_to_end(key)
                return known
        still = _at_rest(design, stored_in(folder), cancelled)
        with self._lock:
            self._solved[key] = still
            while len(self._solved) > MOST_KEPT:
                self._solved.popitem(last=False)
        return still


def design_in(folder: Path) -> Design:
    """Read the design that a folder is about.

    Raises
    ------
    VoxSoftError
        There is none, or it cannot be read.
    """
    file = folder / "design.toml"
    try:
        job = load(folder, check=False)
    except VoxSoftError:  # a folder that tells no job
        text = read_text(file) if file.is_file() else design_text_of(folder)
        return Design.from_document(with_absolute_paths(read_document(text, folder.name), folder))
    return job.spec.design.read()


def _of_run(folder: Path) -> Still:
    """Read the state that a run left."""
    mesh, positions = run_positions(folder)
    design = design_in(folder)
    try:
        summary = read_summary(folder)
    except OSError:
        summary = {}
    status, poses = str(summary.get("status", "ok")), _poses_in(summary)
    setup = Setup(design, mesh)
    if has_feature(design, "softening"):
        # The mesh file does not hold the memory of the voxels, and so not their stress.
        shown = (FIELDS[DISPLACEMENT].name,)
        return Still(setup, positions, status, shown, poses)
    return Still(setup, positions, status, poses=poses)


def _poses_in(summary: Mapping[str, Any]) -> dict[str, Pose]:
    """Poses in which a run left the rigid objects, by name; empty where they cannot be read."""
    try:
        return msgspec.convert(summary.get("objects", {}), dict[str, Pose])
    except msgspec.ValidationError:
        return {}


def _at_rest(design: Design, stored: Sequence[Known], cancelled: threading.Event) -> Still:
    """Mesh a design, and take its stored equilibrium, or solve it as its study did."""
    body = StudioBody.of(design, rev=0, topology=STILL_BODY)
    if body.refusal is not None:
        raise body.refusal

    def look(*_: object) -> None:
        if cancelled.is_set():
            raise StillCancelledError

    look()
    result = known_equilibrium(body, stored) or simulate(body.setup, progress=look)
    if not np.isfinite(result.positions).all():
        raise SimulationError(design.name, result.message, "look at a design with a smaller load")
    remember(body.setup.problem_alone, result.peaks)
    return Still(body.setup, result.positions, result.status, poses=result.objects)
