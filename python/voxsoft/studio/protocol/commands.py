"""Commands: requests of the page to the server. All quantities are SI.

Long because each command is a class with its documentation, and the union of all stands at the end.
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, field

from voxsoft._core import STIFFNESS
from voxsoft.studio.protocol.message import Entry, Json, Message, Triple

Count = Annotated[int, Meta(ge=0)]
OneOrMore = Annotated[int, Meta(ge=1)]
Positive = Annotated[float, Meta(gt=0)]
ShortText = Annotated[str, Meta(max_length=300)]
#: Solvers of the state at rest.
RestMethod = Literal["auto", "statics", "xpbd"]
#: Keys and indices from the top of a design document: ["parts", 0, "material"].
Path = Annotated[list[str | int], Meta(min_length=1, max_length=50)]

#: Sections whose entries have names that the rest of the text speaks of.
Named = Literal[
    "bodies",
    "objects",
    "parameters",
    "shapes",
    "materials",
    "histories",
    "chambers",
    "probes",
    "objectives",
    "constraints",
]


class Command(Message):
    """Base of all commands; `seq` grows with each, and frames and errors echo it."""

    seq: int


class Hello(Command):
    """First message of a tab: the protocol that it speaks."""

    protocol: int
    version: str = ""


class Sync(Command):
    """Ask for `synced` once all commands before it are done: requests beside the socket wait."""


class MeshImport(Entry):
    """Reading of a mesh: the unit of its numbers, a factor on them, and its axis that points up.

    The unit of an array is the width of its voxels, such as "0.5 mm".
    """

    unit: ShortText
    scale: Positive = 1.0
    up: Literal["x", "-x", "y", "-y", "z", "-z"] = "z"


class Open(Command):
    """Open a document: a template, a robot, a file or run folder, an upload, or a study's trial.

    A trial is named "ID/INDEX"; a run by its id in the list of runs; a start by its three answers,
    "pressure-finger-bend"; a document that was left without being saved by its id. `mesh` tells how
    an uploaded mesh is read.
    """

    what: Literal["template", "robot", "start", "file", "run", "upload", "trial", "unsaved"]
    name: ShortText
    mesh: MeshImport | None = None


class Text(Command):
    """Replace the text of the document; `rev` is the revision that was edited."""

    rev: int
    text: Annotated[str, Meta(max_length=10_000_000)]


class Edit(Command):
    """Set one value of the document, keeping its comments; `null` removes the key.

    Edits of one place in one `stroke` of the hand, such as the drag of a slider, are undone
    together.
    """

    rev: int
    path: Path
    value: Json = None
    stroke: Count = 0


class OneEdit(Entry):
    """A value of the document at a path; `null` removes the key."""

    path: Path
    value: Json = None


class Edits(Command):
    """Set several values one after the other, as one step that is undone together."""

    rev: int
    changes: Annotated[list[OneEdit], Meta(min_length=1, max_length=100)]


class Swap(Command):
    """Exchange two entries of a list of the document, with their comments."""

    path: Path
    first: int
    second: int


class Beside(Entry, tag_field="kind", tag="beside"):
    """A copy that is moved by a vector, m."""

    by: Triple


class InMirror(Entry, tag_field="kind", tag="mirror"):
    """The mirror image in the plane across an axis, `at` m along it."""

    axis: Literal["x", "y", "z"]
    at: float = 0.0


class Around(Entry, tag_field="kind", tag="around"):
    """Copies at equal angles around an axis through a center, m: `count` with the original."""

    count: Annotated[int, Meta(ge=2, le=100)]
    axis: Triple = (0.0, 0.0, 1.0)
    center: Triple = (0.0, 0.0, 0.0)


class Copy(Command):
    """Copy a body or a rigid object of the design, by its name.

    The body of a design that has no others becomes the first of a new design of several.
    """

    name: ShortText
    way: Beside | InMirror | Around


class Move(Command):
    """Move a body or a rigid object of the design by a vector, m."""

    name: ShortText
    by: Triple


class Remove(Command):
    """Take a body or a rigid object out of the design, with the pairs of contact that name it."""

    name: ShortText


class Rename(Command):
    """Give a named thing of the design another name, everywhere the text speaks of it."""

    section: Named
    name: ShortText
    to: ShortText


class AddBody(Command):
    """Add a body: a design file of the folder, a template, or a file that was uploaded.

    It stands `beyond` so many m along x; `mesh` is as of `Open`. The body of a design that has no
    others becomes the first of a new design of several.
    """

    what: Literal["file", "template", "upload"]
    name: ShortText
    beyond: float = 0.0
    mesh: MeshImport | None = None


class AddFeature(Command):
    """Add a ready feature to the design: its parameters and shapes, by its name.

    Its foot stands at a place in m; null for the origin. A design without parts gets a part, a
    clamp and a load with it.
    """

    name: ShortText
    at: Triple | None = None


class Designs(Command):
    """Ask for the design files beside the document."""


class Materials(Command):
    """Ask for the materials that a part can have."""


class Take(Command):
    """Write the parameters of a study's trial, "ID/INDEX", into the document, as one step."""

    trial: ShortText


class Ghosts(Command):
    """Ask for the surfaces of some shapes of the document, by their names."""

    names: Annotated[list[ShortText], Meta(max_length=20)]


class Undo(Command):
    """Take back the last change of the document.

    If it has none, `beyond` leads back to the document before it; else `edge` names that.
    """

    beyond: bool = False


class Redo(Command):
    """Make the change again that was taken back last.

    If there is none, `beyond` leads on to the document after this one; else `edge` names that.
    """

    beyond: bool = False


class Save(Command):
    """Write the document to its file, or to another: a name in its folder, or a whole path.

    A file of another document is replaced only with `overwrite`.
    """

    path: ShortText | None = None
    overwrite: bool = False


class Versions(Command):
    """Ask for the versions of the document."""


class VersionShow(Command):
    """Ask how a version of the document differs from it."""

    id: ShortText


class VersionRestore(Command):
    """Make the text of a version that of the document, as one step; the present one is kept."""

    id: ShortText


class Play(Command):
    """Let time run."""


class Pause(Command):
    """Stop time."""


class Step(Command):
    """Take `n` frames of time and stop."""

    n: Annotated[int, Meta(ge=1, le=10_000)] = 1


class Reset(Command):
    """Go back to the unloaded shape at time zero."""


class Rest(Command):
    """Solve for the state at rest with the chosen solver."""


class Estimate(Command):
    """Look for the error bars of the equilibrium that is shown on voxels half as large."""


class Fineness(Command):
    """Ask for the cost of the shown equilibrium on voxels half as large."""


class Solver(Command):
    """Choose the solver of `rest`."""

    method: RestMethod


class Load(Command):
    """Change a load while time runs: its value in the unit of `BodyLoad`, or as a factor."""

    index: Count
    value: float | None = None
    factor: float | None = None


class Grab(Command):
    """Pull a vertex of the surface toward a point by a spring; the same id moves the point.

    A free object, by its place among those of the body, is held by its middle instead of a vertex.
    """

    id: Count
    vertex: Count
    target: Triple
    stiffness: Positive = STIFFNESS
    object: Count | None = None


class Release(Command):
    """Take the spring away."""

    id: Count


class Pace(Command):
    """Let time run so many times as fast as the clock; null leaves it to the motion."""

    factor: Annotated[float, Meta(gt=0, le=1)] | None = None


class Seek(Command):
    """Show a stored frame, by its number or by its time in s; time stops."""

    frame: Count = 0
    time: float | None = None


class Vibrate(Command):
    """Draw the equilibrium in one of its natural vibrations, counted from 0; null stops it."""

    mode: Count | None = None


class Live(Command):
    """Go back from a stored frame to the present."""


class View(Command):
    """View of this tab: the field, the surface or the tetrahedra, and whether it is visible.

    Solid is the surface with the voxels behind it, which a section shows.
    """

    field: Annotated[int, Meta(ge=0, le=11)] = 0
    mode: Literal["surface", "solid", "tets"] = "surface"
    visible: bool = True


class Pick(Command):
    """Ask for all values at a vertex of the surface."""

    vertex: Count


class Probe(Command):
    """Plot the displacement of a vertex of the surface over time."""

    vertex: Count


class Ack(Command):
    """Say that a frame was shown; allows one more."""

    frame: int


class RunSpec(Entry, tag_field="kind", tag="run"):
    """Bring the design to rest, or to its end time, and keep the result as a run folder.

    `solver` replaces settings of the design's solver. `over` follows a path of equilibria instead:
    a key of the design with a range, such as "loads[0].value=0..30 kPa/16".
    """

    name: ShortText | None = None
    solver: dict[str, Json] = field(default_factory=dict)
    over: ShortText | None = None


class SpaceRange(Entry):
    """A range of a parameter: every `step` of it, or any value."""

    low: float
    high: float
    step: float | None = None
    log: bool = False


class StudySpec(Entry, tag_field="kind", tag="study"):
    """Solve many designs. Entries left out are those of the design.

    `space` holds, by parameter, a range or a list of choices. `objectives` and `constraints` are
    written as in a design file.
    """

    name: ShortText | None = None
    sampler: ShortText = "grid"
    budget: OneOrMore = 100
    batch: OneOrMore | None = None
    seed: int = 0
    workers: OneOrMore | None = None
    space: dict[str, SpaceRange | list[Json]] | None = None
    objectives: dict[str, dict[str, Json]] | None = None
    constraints: dict[str, dict[str, Json]] | None = None


class ColumnMap(Entry):
    """Content of a column of a table: a quantity ("s", "dz", "x", ...; "" for nothing), a unit."""

    column: str
    quantity: str
    unit: str = ""


class MeasuredData(Entry):
    """A measured table: the name of a measurement that was sent, and how to read it.

    `select` names the material to take, where a table holds several.
    """

    name: ShortText
    columns: list[ColumnMap] | None = None
    select: ShortText | None = None


class CalibrateSpec(Entry, tag_field="kind", tag="calibrate"):
    """Fit the design's material to measurements. `bounds` holds (low, high) by constant."""

    data: Annotated[list[MeasuredData], Meta(min_length=1, max_length=50)]
    name: ShortText | None = None
    method: ShortText = "genetic"
    generations: OneOrMore = 50
    population: Annotated[int, Meta(ge=4)] = 30
    bounds: dict[str, tuple[float, float]] | None = None
    free_scale: bool = False
    refine: bool = True
    identify: bool = True
    seed: int = 0
    workers: OneOrMore | None = None


class Keep(Command):
    """Keep the state on the screen as a run folder, with its live loads and pulls."""

    name: ShortText | None = None


class JobStart(Command):
    """Start a job on the document as it stands."""

    spec: RunSpec | StudySpec | CalibrateSpec


class JobPause(Command):
    """Hold a job: work that has begun is finished, and nothing more begins."""

    id: ShortText


class JobResume(Command):
    """Go on with a job that was paused or stopped, or with a study of the list of runs."""

    id: ShortText


class JobStop(Command):
    """Stop a job; finished work is kept."""

    id: ShortText


class JobShow(Command):
    """Send the events in the folder of a study or calibration, as they were sent when it ran."""

    id: ShortText


class Recipe(Command):
    """Ask how a job can be done again without the studio."""

    id: ShortText


class Runs(Command):
    """Ask for the list of runs."""


class RunRename(Command):
    """Give a run folder another name."""

    id: ShortText
    name: ShortText


class RunDelete(Command):
    """Move a run folder to the trash."""

    id: ShortText


class RunRestore(Command):
    """Take a run folder out of the trash."""

    id: ShortText


class Compare(Command):
    """Set two runs, or trials written "ID/INDEX", side by side."""

    a: ShortText
    b: ShortText


class Measurement(Command):
    """Read a measured table and guess the contents of its columns."""

    name: ShortText
    text: Annotated[str, Meta(max_length=10_000_000)]
    columns: list[ColumnMap] | None = None
    select: ShortText | None = None


class CardSave(Command):
    """Keep the material of a calibration as a card beside the document."""

    job: ShortText
    name: ShortText


AnyCommand = (
    Hello
    | Open
    | Text
    | Edit
    | Edits
    | Copy
    | Move
    | Remove
    | Rename
    | Swap
    | Sync
    | AddBody
    | AddFeature
    | Designs
    | Materials
    | Take
    | Ghosts
    | Undo
    | Redo
    | Save
    | Versions
    | VersionShow
    | VersionRestore
    | Play
    | Pause
    | Step
    | Reset
    | Rest
    | Estimate
    | Fineness
    | Solver
    | Load
    | Grab
    | Release
    | Pace
    | Seek
    | Live
    | Vibrate
    | View
    | Pick
    | Probe
    | Ack
    | Keep
    | JobStart
    | JobPause
    | JobResume
    | JobStop
    | JobShow
    | Recipe
    | Runs
    | RunRename
    | RunDelete
    | RunRestore
    | Compare
    | Measurement
    | CardSave
)
