"""Files of the shown body: the design, the body as it stands, or a run folder."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import files
from voxsoft.design import Design
from voxsoft.errors import DesignError, ErrorDetail, FileError, SimulationError, VoxSoftError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.exports import write_computed, write_source
from voxsoft.files.run_folder import make_folder
from voxsoft.files.scenes.scene import Scene, SceneState
from voxsoft.files.series import Series
from voxsoft.files.shapes import shape_of
from voxsoft.formats.registry import WRITTEN, Format
from voxsoft.simulation import Result, named_regions
from voxsoft.simulation.results.result import Status
from voxsoft.simulation.runs.state import result_at
from voxsoft.simulation.setup.places import on_the_surface
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.objects import poses_in, surroundings_of
from voxsoft.studio.outputs.archive import archive
from voxsoft.studio.outputs.html import export_page, page_of_body
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.events import GrabState

#: Formats in which the shown body can be written.
FORMATS: Final = (*(suffix[1:] for suffix in WRITTEN), "molds", "run", "png", "html")
#: Dots per inch of a picture of normal size.
_DPI: Final = 200


@dataclass(frozen=True, eq=False)
class Shown:
    """View of a tab at the moment of an export.

    Attributes
    ----------
    name
        Name of the files.
    text
        The text of the design.
    body
        The body.
    positions
        Positions of its vertices [m].
    result
        The state at rest that a solver found, if the body is in it.
    columns, units, rows
        The content of the plots.
    factors
        Factor on each load of the design.
    pulls
        The springs that pull by hand.
    status, sentence, time
        State of the simulation, and its time [s].
    moment
        Poses of objects, and contacts, as far as they are known.
    equilibrium
        Numbers of the equilibrium that is shown, with error bars where these are known.
    """

    name: str
    text: str
    body: StudioBody = field(repr=False)
    positions: NDArray[np.float64] = field(repr=False)
    result: Result | None = field(repr=False)
    columns: Sequence[str]
    units: Sequence[str]
    rows: Sequence[Sequence[float | None]] = field(repr=False)
    factors: Sequence[float] = ()
    pulls: Sequence[GrabState] = ()
    status: Status = "not-at-rest"
    sentence: str = ""
    time: float = 0.0
    moment: events.Moment | None = None
    equilibrium: events.Equilibrium | None = None

    @property
    def design(self) -> Design:
        """Design of the body."""
        return self.body.setup.design

    def table(self) -> str:
        """Return the plots as the text of a CSV file."""
        return _table(self)

    def scene(self) -> Scene:
        """Return the design under the live loads, unloaded at time 0 and as it stands after 1 s."""
        setup = self.body.under(self.factors)
        poses = poses_in(self.moment, self.design)
        now = SceneState(1.0, self.positions, poses)
        return Scene(setup, (SceneState(0.0, setup.mesh.vertices), now))

    def series(self) -> Series:
        """Return the body as it stands, with its fields, as one state."""
        return Series.of(self.measured())

    def measured(self) -> Result:
        """The state as a result: the solver's where one found it, else measured as it stands.

        Raises
        ------
        VoxSoftError
            The body cannot be solved, or the state is not finite.
        """
        if self.result is not None:
            return self.result
        setup = self.body.under(self.factors)
        return result_at(
            setup, self.positions, status=self.status, message=self.sentence, time=self.time
        )


@dataclass(frozen=True)
class Written:
    """A written file, and entries of the design that it does not hold."""

    file: Path
    lost: tuple[ErrorDetail, ...] = ()


def export_shown(shown: Shown, format: str, options: dict[str, Any], folder: Path) -> Written:
    """Write the shown state to files.

    Parameters
    ----------
    shown
        The shown state.
    format
        One of :data:`FORMATS`.
    options
        ``deformed``: whether a mesh or surface has the shape under load; ``unit`` of the numbers
        in STL and OBJ files, ``"mm"`` by default; ``voxels``: whether a surface is that of the
        voxels; ``resolved``: whether a design file holds
        values in place of formulas; ``scale`` of a picture; of a computation ``mesh_alone``, and
        its ``unit``, ``element`` and ``split``. Where the design has no computation, such as the
        lattice, the file holds the mesh alone, and the loss is listed.
    folder
        Folder of the files.

    Returns
    -------
    Written
        The file.

    Raises
    ------
    FileError
        An unknown format, or one that needs a result where there is none.
    DesignError
        Molds are asked for that cannot be used.
    """
    target = folder / f"{shown.name}.{format}"
    lost: tuple[ErrorDetail, ...] = ()
    form = WRITTEN.get(f".{format}")
    if form is not None and form.kind == "design" and not options.get("resolved", False):
        write_atomically(target, shown.text)
    elif form is not None and form.computation is not None and not _is_mesh_alone(options):
        whole = shown.body.under(shown.factors).design
        try:
            lost = write_computed(target, whole, **_of_computation(options))
        except (DesignError, SimulationError) as error:
            _write_mesh(shown, target, form, options)
            lost = (_mesh_alone(error),)
    elif form is not None and form.has_shape:
        _write_mesh(shown, target, form, options)
    elif form is not None and form.kind == "series":
        lost = write_source(_within(target), shown)
        target = archive(_within(target).parent, target.with_suffix(".zip"))
    elif form is not None:
        lost = write_source(target, shown)
    elif format == "run":
        target = target.with_suffix(".zip")
        _write_run(shown, target)
    elif format == "molds":
        target = _write_molds(shown.design, folder / f"{shown.name}-molds")
    elif format == "png":
        _draw(shown, target, options.get("scale", 1))
    elif format == "html":
        page = page_of_body(
            shown.body,
            factors=shown.factors,
            positions=shown.positions,
            moment=shown.moment,
            at_rest=shown.status == "ok",
            equilibrium=shown.equilibrium,
            text=shown.text,
        )
        page.save(target)
    else:
        raise FileError("format", f'"{format}" is not known', f"use {', '.join(FORMATS)}")
    return Written(target, lost)


def export_run(source: Path, format: str, options: dict[str, Any], folder: Path) -> Written:
    """Write a run folder in a format: the folder itself as an archive, or its contents.

    Raises
    ------
    FileError
        See :func:`voxsoft.files.export`.
    """
    target = folder / f"{source.name}.{format}"
    if format == "run":
        return Written(archive(source, target.with_suffix(".zip")))
    if format == "molds":
        design = files.load(source / "design.toml")
        return Written(_write_molds(design, folder / f"{source.name}-molds"))
    if format == "html":
        export_page(source, target)
        return Written(target)
    form = WRITTEN.get(f".{format}")
    given: dict[str, Any] = {}
    if form is not None and form.unit is None:
        given["unit"] = str(options.get("unit", "mm"))
    if form is not None and form.computation is not None and not _is_mesh_alone(options):
        given = _of_computation(options)
    given |= {key: bool(options.get(key, False)) for key in ("deformed", "voxels", "mesh_alone")}
    several = form is not None and form.kind == "series"
    written = _within(target) if several else target
    try:
        lost = files.export(source, written, **given)
    except (DesignError, SimulationError) as error:
        if form is None or form.computation is None or given["mesh_alone"]:
            raise
        given = {key: given[key] for key in ("deformed", "voxels")}
        files.export(source, written, mesh_alone=True, **given)
        lost = (_mesh_alone(error),)
    if several:
        target = archive(written.parent, target.with_suffix(".zip"))
    return Written(target, lost)


def _is_mesh_alone(options: dict[str, Any]) -> bool:
    """Return True where a file is asked for that holds the shape and no computation."""
    return bool(options.get("mesh_alone", False) or options.get("deformed", False))


def _mesh_alone(error: VoxSoftError) -> ErrorDetail:
    """Return the reason why a file holds the mesh, and not the computation that was asked for."""
    what = f"is left out, the file holds the mesh alone: {error.where} {error.what}"
    return ErrorDetail("computation", what, error.hint)


def _of_computation(options: dict[str, Any]) -> dict[str, Any]:
    """Return the options of a computation, of the types that it takes.

    Raises
    ------
    FileError
        One of another type.
    """
    kinds = {"unit": str, "element": str, "split": int}
    found = {key: options[key] for key in kinds if options.get(key) is not None}
    for key, value in found.items():
        if type(value) is not kinds[key]:
            raise FileError(key, f"{value!r} is no {kinds[key].__name__}")
    return found


def _write_mesh(shown: Shown, target: Path, form: Format, options: dict[str, Any]) -> None:
    mesh, is_deformed = shown.body.mesh, bool(options.get("deformed", False))
    if form.kind == "surface":
        positions = shown.positions if is_deformed else None
        is_stairs = bool(options.get("voxels", False))
        surfaces = shape_of(shown.design, mesh, positions, voxels=is_stairs)
        unit = options.get("unit") if form.unit is None else None
        files.write_surfaces(target, surfaces, unit)
        return
    data: dict[str, NDArray[np.float64]] = {}
    if "values" in form.holds:
        data["displacement"] = shown.positions - mesh.vertices
        if shown.result is not None:
            data["reaction"] = shown.result.reactions
    regions = named_regions(shown.design, mesh) if "regions" in form.holds else {}
    vertices = shown.positions if is_deformed else mesh.vertices
    files.write_mesh(target, replace(mesh, vertices=vertices), point_data=data, regions=regions)


def _table(shown: Shown) -> str:
    if not shown.rows:
        raise FileError("csv", "nothing was recorded yet", "press play, then export again")
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    pairs = zip(shown.columns, shown.units, strict=True)
    writer.writerow([f"{name.replace(' ', '_')}_{unit}" if unit else name for name, unit in pairs])
    for row in shown.rows:
        writer.writerow(["" if value is None else f"{value:.9g}" for value in row])
    return out.getvalue()


def _write_run(shown: Shown, target: Path) -> None:
    folder = target.with_suffix("")
    files.write_run(shown.measured(), folder)
    archive(folder, target)


def _write_molds(design: Design, folder: Path) -> Path:
    """Write parts to print and the sheet of steps as an archive.

    Raises
    ------
    DesignError
        A proof of a mold fails, or the body cannot be sampled.
    """
    from voxsoft.fabrication import make
    from voxsoft.files.fabrication import write_fabrication

    write_fabrication(make(design), folder)
    return archive(folder, folder.with_suffix(".zip"))


def _within(target: Path) -> Path:
    """Return the path of a file with others beside it, in a folder of their own."""
    return make_folder(target.with_name(f"{target.stem}-series")) / target.name


def _draw(shown: Shown, target: Path, scale: object) -> None:
    from voxsoft.files.figures import save_figure
    from voxsoft.plot import plot_body
    from voxsoft.plot.objects import Surroundings

    if not isinstance(scale, (int, float)) or not 0 < scale <= 8:
        raise FileError("scale", f"{scale!r} is no scale", "use a number up to 8")
    if shown.result is not None:
        figure = plot_body(shown.result)
    else:
        mesh = shown.body.mesh
        moved = np.linalg.norm(shown.positions - mesh.vertices, axis=1)
        design = shown.body.setup.design
        # The poses of objects may be unknown for a moment in the past.
        known = shown.moment is not None or shown.time == 0.0
        around = surroundings_of(design, poses_in(shown.moment, design))
        figure = plot_body(
            replace(mesh, vertices=on_the_surface(design, mesh) + shown.positions - mesh.vertices),
            1e3 * moved,
            label="displacement (mm)",
            objects=around if known else Surroundings(floor=around.floor),
        )
    figure.set_dpi(_DPI * float(scale))
    save_figure(figure, target)
