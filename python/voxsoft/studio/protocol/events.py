"""Events: messages of the server to the page. All quantities are SI.

Long because all events stand in one list, as the page reads them.
"""

from __future__ import annotations

from typing import Literal

from msgspec import field

from voxsoft.studio.protocol.message import Entry, Json, Message, Triple

Severity = Literal["error", "warning", "note"]
#: Source of a material: a card of VoxSoft, the design, or a card's file.
Origin = Literal["card", "design", "file"]
#: Live motion of a body of one material: in quick explicit substeps, in implicit steps, not at all.
LiveMotion = Literal["explicit", "implicit", "none"]
#: Form of a history: points, a sine, an expression of time, a table in a file, none.
HistoryWay = Literal["points", "sine", "expression", "table", "none"]
#: Use of a table of numbers: a test of a material, points on a body, a number over another one.
TableUse = Literal["coupon", "stations", "curve"]
JobKind = Literal["run", "study", "calibrate"]
JobState = Literal[
    "running", "pausing", "paused", "stopping", "stopped", "done", "failed", "interrupted"
]
SimulationState = Literal[
    "empty", "meshing", "playing", "paused", "at-rest", "diverged", "solving", "past"
]


class Event(Message):
    """Base of all events."""


class Template(Entry):
    """A design to start from."""

    name: str
    title: str
    text: str


class MaterialCard(Entry):
    """A material card that designs can name; `young` is that of a large block, Pa."""

    name: str
    title: str
    source: str
    model: str
    young: float | None = None


class MaterialFacts(Entry):
    """Data of a material, SI; null and "" where nobody stated it.

    `same_as` and `choice` are of a plain name: the card that it stands for, and why. `tested_from`
    and `tested_to` are the stretches between which specimens were tested. `stress_at_double` is the
    nominal stress at 100 % strain. `stretches` and `stresses` are the curve of the model itself in
    uniaxial tension; empty where it has none. `table` is the material as a design writes it.
    """

    name: str
    title: str
    origin: Origin
    same_as: str
    choice: str
    model: str
    live: LiveMotion
    shore: str
    young: float | None
    density: float | None
    tested_from: float | None
    tested_to: float | None
    elongation_at_break: float | None
    stress_at_double: float | None
    source: str
    caution: str
    license: str
    stretches: list[float]
    stresses: list[float | None]
    table: dict[str, Json]


class Sampler(Entry):
    """A way to choose trials."""

    name: str
    title: str
    single_objective: bool


class Field(Entry):
    """A quantity that colors the body; `signed` ones have zero in the middle of their range.

    Fields of `contact` are known where a solution with contact ends.
    """

    id: int
    name: str
    title: str
    unit: str
    signed: bool
    contact: bool = False


class Metric(Entry):
    """A metric for an objective or constraint."""

    name: str
    kind: str
    needs_probe: bool
    needs_base: bool
    needs_cavity: bool
    takes_percentile: bool
    needs_object: bool


class FitRange(Entry):
    """A constant of a material that is fitted unless others are named, and its range, SI."""

    name: str
    kind: str
    low: float
    high: float


class Hello(Event):
    """First event: abilities of this server. `design_schema` is the JSON Schema of a design.

    `fit_ranges` holds for each model of a material the constants that a calibration fits.
    """

    version: str
    protocol: int
    design_schema: dict[str, Json]
    templates: list[Template]
    materials: list[MaterialCard]
    samplers: list[Sampler]
    calibration_methods: list[str]
    fit_ranges: dict[str, list[FitRange]]
    methods: list[str]
    metrics: list[Metric]
    fields: list[Field]
    runs_folder: str
    cores: int


class Robot(Entry):
    """A finished robot to open, and the addresses of its pictures; `moving` may be empty."""

    name: str
    title: str
    sentence: str
    picture: str
    moving: str = ""


class Way(Entry):
    """A robot, with values of its own, for the three answers to New."""

    name: str
    drive: str
    form: str
    task: str
    robot: str
    sentence: str


class RecentFile(Entry):
    """A design that was opened or saved; `when` is ISO 8601, `picture` where it is drawn.

    One that was left without being saved has an id in `unsaved`, and neither path nor folder.
    """

    path: str
    name: str
    folder: str
    when: str
    picture: str = ""
    unsaved: str = ""


class Start(Event):
    """Content of the start screen; `fresh` while nothing was opened or changed yet."""

    fresh: bool
    robots: list[Robot]
    ways: list[Way]
    recent: list[RecentFile]


class Parameter(Entry):
    """A parameter of the document; numbers are SI, `text` is the value as it is written.

    `display_unit` and `factor`: value / factor is the number to show with that unit. `former` is
    the value when the document was opened or saved last.
    """

    name: str
    value: float
    kind: str
    text: str
    min: float | None = None
    max: float | None = None
    step: float | None = None
    display_unit: str = ""
    factor: float = 1.0
    formula: bool = False
    former: float | None = None
    description: str = ""


class Diagnostic(Entry):
    """Something wrong with the text. Lines and columns count from 1; columns may be unknown (0)."""

    line: int
    column: int
    end_column: int
    severity: Severity
    where: str
    what: str
    hint: str = ""


class HistoryUse(Entry):
    """An entry that uses a history, and the value of a factor of 1, such as "30 kPa"."""

    title: str
    amount: str


class HistoryLine(Entry):
    """A history over time, or a place that has none.

    `path` is where it is written. Points can be moved; `words` is the text of the other ways.
    `times` in s and `factors` are one cycle of `repeat`; factors stay between `low` and `high`.
    `lives` names the file of a body that it is written in, where it is changed; "" in the document.
    """

    path: list[str | int]
    title: str
    used_by: list[HistoryUse]
    way: HistoryWay
    words: str = ""
    times: list[float] = field(default_factory=list)
    factors: list[float] = field(default_factory=list)
    repeat: int = 1
    low: float | None = None
    high: float | None = None
    lives: str = ""


class Document(Event):
    """The document as it stands; `design` is that of the last text that was good (or null).

    `id` tells it from other documents that were open, `hash` its present design from earlier ones.
    `dirty`: it differs from the text opened or saved last. `folder` is where it would be saved.
    `empty`: nothing is described yet, so that it is no design, and has no fault either.
    `before` and `after` name documents with unsaved changes that were open before and after it;
    undo and redo come there only where they are asked to go beyond its own changes. `histories` are
    those of the last text that was good.
    """

    rev: int
    id: str
    hash: str
    text: str
    name: str
    path: str | None
    folder: str
    dirty: bool
    valid: bool
    empty: bool
    parameters: list[Parameter]
    design: dict[str, Json] | None
    source: dict[str, Json] | None
    diagnostics: list[Diagnostic]
    can_undo: bool
    can_redo: bool
    before: str = ""
    after: str = ""
    histories: list[HistoryLine] = field(default_factory=list)


class Edge(Event):
    """Undo or redo has come to the end of the changes of a document; `beyond` is the next one."""

    way: Literal["undo", "redo"]
    name: str
    beyond: str


class DesignFile(Entry):
    """A design file beside the document: its name there, and that of the design.

    `parameters` holds the values that a body may set, as they are written.
    """

    file: str
    title: str
    parameters: dict[str, str] = field(default_factory=dict)


class DesignFiles(Event):
    """The design files in the folder of the document, without its own."""

    folder: str
    files: list[DesignFile]


class Materials(Event):
    """All materials that a part can have: those of the design at `rev`, then the cards.

    `mixed` describes effects of parts of spring lattices and of rubber together; "" elsewhere.
    """

    rev: int
    materials: list[MaterialFacts]
    mixed: str


class BodyPose(Entry):
    """Frame of a body: its origin in m, and its rotation, nine numbers by rows."""

    position: Triple
    rotation: list[float]


class Ghost(Entry):
    """A shape by itself, in its own frame; `poses` are those of the bodies that are made of it.

    `vertices` are x, y, z as float32 in m and `triangles` three indices as uint32, in base64; `low`
    and `high` are their bounds. Samples are `step` m apart: walls that are thinner may be missing.
    It goes on beyond the picture along the axes of `clipped`. `trouble` is why there is no surface,
    or an empty text.
    """

    name: str
    vertices: str
    triangles: str
    low: Triple
    high: Triple
    step: float
    clipped: str
    trouble: str
    poses: list[BodyPose]


class Ghosts(Event):
    """The shapes that a tab asked for, as the last good design has them at a revision."""

    rev: int
    shapes: list[Ghost]


class Cavity(Entry):
    """An enclosed space: its name or an empty text, volume in m³, area in m²."""

    name: str
    volume: float
    area: float
    center: Triple


class Leak(Entry):
    """A chamber that is open: its volume in m³, the place of the opening."""

    volume: float
    point: Triple


class Finding(Entry):
    """A finding of a check; `at` is a point of the unloaded body in m where it is seen."""

    severity: Severity
    where: str
    what: str
    hint: str = ""
    at: Triple | None = None


class BodyClamp(Entry):
    """A clamp: how many vertices it holds, their center, and some of them."""

    name: str
    vertices: int
    center: Triple
    points: list[Triple]


class BodyPlane(Entry):
    """A plane of symmetry: the axis across it, 0 to 2, and where it is along that in m."""

    axis: int
    at: float


class BodyLoad(Entry):
    """A load with the range of its slider; value / factor is the number to show with `unit`.

    `kind` is that of the load in a design, `quantity` that of its size.
    """

    index: int
    kind: str
    label: str
    value: float
    quantity: str
    unit: str
    factor: float
    min: float
    max: float
    at: Triple
    direction: Triple


class BodyLayer(Entry):
    """A layer: its stiffness in N/m, its center, and triangles of drawn vertices, three each."""

    name: str
    stiffness: float
    center: Triple
    triangles: list[int]


class BodyPlace(Entry):
    """A place: its center in the unloaded body, and the drawn vertices that carry it, if any."""

    center: Triple
    vertices: list[int]


class BodyAttachment(Entry):
    """An attachment of the body: the places that it joins, in turn.

    `load` is the index of the load that pulls it; null where nothing does.
    """

    name: str
    summary: str
    places: list[BodyPlace]
    load: int | None = None


class BodyProbe(Entry):
    """A named place of measurement, with the surface vertices of it."""

    name: str
    center: Triple
    vertices: list[int]


class BodyObject(Entry):
    """A rigid object where it is at first: `middle` is that of its box, which poses move and turn.

    `vertices` are x, y, z as float32 in m and `triangles` three indices as uint32, in base64.
    """

    name: str
    motion: Literal["fixed", "moved", "free"]
    middle: Triple
    vertices: str
    triangles: str


class BodyBond(Entry):
    """Two things that are bonded, and points of the unloaded first one where they are, m.

    `strength` is the traction at which it lets go, Pa; null for one that does not.
    """

    of: tuple[str, str]
    strength: float | None
    points: list[Triple]


class BodyPart(Entry):
    """A part; `color` is a CSS color, and `body` the body that it is of where there are several."""

    name: str
    material: str
    color: str
    body: str = ""


class BodyOfSeveral(Entry):
    """One of several bodies, unloaded: its bounds in m, and its first and last drawn vertex."""

    name: str
    bounds: tuple[Triple, Triple]
    vertices: tuple[int, int]


class Body(Event):
    """A new body: its topology follows as a binary message with the same id.

    `mass` is null where the body cannot be solved. `smooth` says that the smooth surface of the
    shapes follows as well (kind 3), `cut` that this surface cuts voxels. `not_live` is why time
    does not run, or an empty text; `touches` tells whether anything of the design may touch.
    `bodies` is empty where there is one. `floor` is the height of the floor in m; null where there
    is none. `refused` has a sentence for each use that refuses the design
    (`voxsoft.simulation.compatibility`).
    """

    topology: int
    rev: int
    voxels: int
    vertices: int
    tets: int
    surface_vertices: int
    triangles: int
    voxel_size: float
    cavities: list[Cavity]
    leaks: list[Leak]
    mass: float | None
    volume: float
    bounds: tuple[Triple, Triple]
    findings: list[Finding]
    clamps: list[BodyClamp]
    loads: list[BodyLoad]
    probes: list[BodyProbe]
    parts: list[BodyPart]
    layers: list[BodyLayer]
    attachments: list[BodyAttachment]
    objects: list[BodyObject]
    not_live: str
    touches: bool
    seconds: float
    memory: float
    smooth: bool = False
    cut: bool = False
    bodies: list[BodyOfSeveral] = field(default_factory=list)
    planes: list[BodyPlane] = field(default_factory=list)
    floor: float | None = None
    bonds: list[BodyBond] = field(default_factory=list)
    refused: dict[str, str] = field(default_factory=dict)


class GrabState(Entry):
    """A spring that pulls: force in N on the body, distance to its target in m.

    If it holds an object, that is its place among those of the body, and `vertex` means nothing.
    """

    id: int
    vertex: int
    target: Triple
    stiffness: float
    force: Triple
    stretch: float
    object: int | None = None


class Bare(Event):
    """There is no body to be shown: the document has none, or it is not there yet."""


class Stat(Event):
    """State of the simulation. Times in s, `step_ms` in ms for one substep, energies in J.

    `real_time_factor` is simulated over wall-clock time, and `pace` its upper limit;
    `pace_chosen` is the user's choice, or null, and `pace_choices` the number of choices
    for this body. Stored frames run from `first_frame` to `last_frame`. `untimed`: the shown state
    was found without time, and `time` is that of the motion played before.
    """

    topology: int
    state: SimulationState
    sentence: str
    time: float = 0.0
    untimed: bool = False
    step_ms: float = 0.0
    substeps: int = 0
    real_time_factor: float = 0.0
    pace: float = 1.0
    pace_chosen: float | None = None
    pace_choices: int = 0
    residual: float | None = None
    elastic: float | None = None
    kinetic: float | None = None
    frame: int = 0
    first_frame: int = 0
    last_frame: int = 0
    frames_stored: int = 0
    bytes_stored: int = 0
    solver: str = "auto"
    progress: float | None = None
    loads: list[float] = field(default_factory=list)
    grabs: list[GrabState] = field(default_factory=list)


class MovedProbe(Entry):
    """A probe and how far it moved, m; `estimate` is that with its error bars in words.

    `share` is the error as a part of the displacement; null where it is not known.
    """

    name: str
    displacement: Triple
    estimate: str = ""
    share: float | None = None


class MetricValue(Entry):
    """A metric of the body as it stands, SI; `kind` tells its unit, `estimate` its error bar.

    `share` is the error as a part of the value; null where it is not known.
    """

    name: str
    value: float | None
    kind: str
    estimate: str = ""
    share: float | None = None


class Chamber(Entry):
    """A chamber: volumes unloaded and now in m³, pressure in Pa, the volume with its error bar.

    `share` is the error as a part of how far the volume grew; null where it is not known.
    """

    name: str
    rest_volume: float
    volume: float
    pressure: float
    estimate: str = ""
    share: float | None = None


class Summarized(Entry):
    """Something by its name, and its state in words; `estimate` has its error bars in words."""

    name: str
    words: str
    estimate: str = ""


class Grip(Entry):
    """Grip on a free object at the end of a run, also in a sentence.

    `held` only by moving or soft things; `slips` where more slips than sticks; `touched` while it
    still stands on something fixed; `lost` where nothing presses it. `rise` is the way up
    in m, `pressed` the force that presses it in N, `weight` its weight in N, null without gravity,
    and `margin` the largest possible friction over the present one, null without any.
    """

    name: str
    verdict: Literal["held", "slips", "touched", "lost"]
    sentence: str
    rise: float
    pressed: float
    weight: float | None
    margin: float | None


class Equilibrium(Event):
    """The numbers of the state that `frame` shows, and its doubtful points.

    `residual` is a share of the load in words, `largest_strain` that of the largest stretch.
    `error_bars` says where error bars come from, or why there are none; told a second time once
    they are known. `looking` while they are being looked for, and `askable` where none were found
    and smaller voxels could still give them. `missing` names the parts of a stored state that are
    not there, in a sentence; empty where all is.
    """

    topology: int
    frame: int
    status: str
    sentence: str
    residual: str
    seconds: float
    probes: list[MovedProbe]
    metrics: list[MetricValue]
    chambers: list[Chamber]
    largest_strain: float
    warnings: list[Finding]
    tendons: list[Summarized]
    reactions: list[Summarized]
    supplies: list[Summarized]
    grips: list[Grip]
    error_bars: str = ""
    looking: bool = False
    askable: bool = False
    missing: str = ""


class TextChange(Entry):
    """A value of the document at a path, as an edit of it."""

    path: list[str | int]
    value: Json


class Fineness(Event):
    """Cost of the shown equilibrium on voxels half as large, and the way to have them.

    Sizes in m, memory in bytes, `seconds` of the solution, null where no solver found the state.
    `halving` makes the voxels half as large; where it is empty `not_halved` says why. Parts of
    `refinable` can be refined alone; where there is none `not_refined` says why. `refinements` is
    how many there are. `refining` halves the voxels that hold most of the error; it is empty where
    voxels cannot have two sizes, or have them.
    """

    topology: int
    voxel_size: float
    voxels: int
    memory: float
    seconds: float | None
    half_voxels: int
    half_memory: float
    half_seconds: float | None
    free_memory: float
    halving: list[TextChange]
    not_halved: str
    refinable: list[str]
    not_refined: str
    refinements: int
    refining: list[TextChange]


class Vibration(Event):
    """The slowest natural vibrations of the state that `frame` shows, in Hz.

    `mode` is the one that is drawn, from 0, `amplitude` how far it is drawn in m, and `period` how
    long a drawn swing takes in s. While they are looked for there are none; `trouble` says why
    there are none, and `hint` is the remedy.
    """

    topology: int
    frame: int
    frequencies: list[float]
    mode: int | None = None
    amplitude: float = 0.0
    period: float = 0.0
    trouble: str = ""
    hint: str = ""


class ChamberCurve(Entry):
    """A volume of gas or liquid over time: gauge pressure in Pa, volume in m³, flow in kg/s."""

    name: str
    pressure: list[float]
    volume: list[float]
    flow: list[float]


class Chambers(Event):
    """State of supplies in the shown motion, at instants in s; empty where nothing happened."""

    topology: int
    times: list[float]
    chambers: list[ChamberCurve]


class ObjectPose(Entry):
    """Pose of an object: the middle of its box in m, and its rotation, nine numbers by rows."""

    position: Triple
    rotation: list[float]


class Touch(Entry):
    """A pair in contact: the force on the first in N, the area in m² and the smallest gap in m.

    `pressed` is the sum of the sizes of all forces, and `slipping` the part of it that slips.
    `friction` is the size of that part of the force and `bound` the most that it can be, in N;
    null where motion is live.
    """

    of: tuple[str, str]
    force: Triple
    pressed: float
    area: float
    gap: float
    slipping: float
    friction: float | None = None
    bound: float | None = None


class Moment(Entry):
    """A frame of a solution: its time in s, the pose of each object of the body, its contacts.

    `fields` tells whether the fields of contact are known of it. `depth` is how deep surfaces are
    in each other in m, where that is more than live contact should let them.
    """

    frame: int
    time: float
    poses: list[ObjectPose]
    contacts: list[Touch]
    fields: bool = False
    depth: float | None = None


class MomentNews(Event, tag="moment"):
    """Contacts in the newest frame of a body that moves; adds to those known before."""

    topology: int
    moment: Moment


class Moments(Event):
    """Data of stored frames beside their pictures; replaces those known before."""

    topology: int
    moments: list[Moment]


class OverlapPlace(Entry):
    """A place where a body is in itself: its depth in m, and a point of it unloaded and now, m."""

    depth: float
    rest: Triple
    now: Triple


class Overlap(Event):
    """Places where the shown body is in itself, the deepest one first; none where it is not."""

    topology: int
    depth: float
    sentence: str
    places: list[OverlapPlace]


class Plot(Event):
    """Rows to append to the plots: time, residual, elastic and kinetic energy, then each probe.

    `names` and `units` name all columns. Values that are not finite come as null.
    """

    topology: int
    names: list[str]
    units: list[str]
    rows: list[list[float | None]]
    clear: bool = False


class Value(Entry):
    """A field's value at a vertex."""

    field: int
    name: str
    value: float | None
    unit: str


class Picked(Event):
    """All values at a vertex of the surface; positions in m."""

    vertex: int
    rest: Triple
    position: Triple
    values: list[Value]


class Job(Event):
    """State of a job: `done` of `total` designs, generations or other units, named in `of`.

    `left` is the time that these will still take in s, `best` a short text.
    """

    id: str
    kind: JobKind
    name: str
    state: JobState
    done: int
    total: int
    elapsed: float
    left: float | None
    best: str
    folder: str
    message: str
    of: str = ""
    stage: str = ""
    parameters: list[str] = field(default_factory=list)
    objectives: list[str] = field(default_factory=list)
    directions: list[str] = field(default_factory=list)


class Subject(Event):
    """The design that a job is of: its name, its hash, and the document that it was started from.

    `document` is empty for a job of an earlier studio.
    """

    job: str
    document: str
    design: str
    hash: str


class Trial(Event):
    """A trial of a study; `objectives` is null where it has no result."""

    job: str
    index: int
    parameters: dict[str, Json]
    objectives: dict[str, float] | None
    metrics: dict[str, float | None]
    status: str
    seconds: float
    feasible: bool = True
    front: bool = False
    message: str = ""


class Bound(Entry):
    """A constraint of a study: the metric that it keeps within bounds, SI; null where open."""

    name: str
    metric: str
    min: float | None
    max: float | None


class TriedRange(Entry):
    """A range of a parameter that a study has varied, SI; `step` is null for any value."""

    low: float
    high: float
    step: float | None
    log: bool


class Trials(Event):
    """All trials of a study so far, replacing those sent before; kinds by name tell the units.

    `space` holds the ranges of the parameters that it varied, without lists of choices.
    """

    job: str
    parameters: list[str]
    objectives: list[str]
    directions: list[str]
    kinds: dict[str, str]
    trials: list[Trial]
    constraints: list[Bound] = field(default_factory=list)
    space: dict[str, TriedRange] = field(default_factory=dict)


class Generation(Event):
    """A generation of a calibration: fitness, and error in m."""

    job: str
    index: int
    best: float
    mean: float
    error: float | None
    parameters: dict[str, float]
    spread: dict[str, tuple[float, float]] = field(default_factory=dict)


class PathColumn(Entry):
    """A number along a path, in SI units; its kind tells the unit."""

    name: str
    kind: str
    values: list[float | None]


class Path(Event):
    """The equilibria of a job along a path so far; `asked` is how many there are to be.

    `message` is empty until it ends.
    """

    job: str
    over: str
    kind: str
    values: list[float]
    asked: int
    columns: list[PathColumn]
    status: str
    message: str = ""


class OverlayExperiment(Entry):
    """Measured and simulated stations of one experiment in m; errors in m."""

    name: str
    measured: list[Triple]
    simulated: list[Triple]
    error: list[float]
    percent: list[float]


class Overlay(Event):
    """The best candidate of a calibration over the measurements."""

    job: str
    experiments: list[OverlayExperiment]


class FittedParameter(Entry):
    """A constant that was fitted; `sentence` gives the information of the data about it."""

    name: str
    value: float
    kind: str
    text: str
    low: float
    high: float
    identifiable: bool | None
    sentence: str


class StationError(Entry):
    """The error at one station, in m and in percent of the sag."""

    experiment: str
    station: str
    measured: list[float]
    simulated: list[float]
    error: float
    percent: float


class Calibrated(Event):
    """The result of a calibration; errors in m. `card` is the text of the material card.

    `miss` says where and by how much the model misses more than marks are misread, or is empty.
    """

    job: str
    parameters: list[FittedParameter]
    table: list[StationError]
    quantities: list[str]
    identifiable: dict[str, bool]
    fitness: float
    mean_error: float
    max_error: float
    material: dict[str, Json]
    card: str
    miss: str = ""
    warnings: list[str] = field(default_factory=list)


class Recipe(Event):
    """Ways to repeat a job: a script, and a command where the options allow it (else "").

    `version` is that of the VoxSoft which did it; "" while it has not ended.
    """

    job: str
    python: str
    command: str
    seed: int | None
    version: str


class RunRow(Entry):
    """A folder of the list of runs; `when` is ISO 8601, `thumbnail` an address.

    `again` tells whether the studio knows how it can be done again.
    """

    id: str
    kind: Literal["run", "study", "calibrate", "unknown"]
    name: str
    status: str
    best: str
    when: str
    seconds: float | None
    folder: str
    thumbnail: str | None
    message: str = ""
    trials: int | None = None
    again: bool = False


class Runs(Event):
    """The list of runs, newest first; `trash` holds those that can be restored."""

    rows: list[RunRow]
    trash: list[RunRow]
    folder: str


class Side(Entry):
    """One side of a comparison."""

    id: str
    name: str
    status: str
    parameters: dict[str, Json]
    metrics: dict[str, float | None]
    text: str


class Difference(Entry):
    """A value of the design in which two sides differ."""

    where: str
    a: Json
    b: Json


class Compared(Event):
    """Two runs or trials side by side."""

    a: Side
    b: Side
    differences: list[Difference]


class MeasuredColumn(Entry):
    """A column of a measured table as it is understood."""

    column: str
    quantity: str
    unit: str
    sample: list[str]


class Measured(Event):
    """A measured table as it is understood; `problems` tell why it cannot be used as it is."""

    name: str
    columns: list[MeasuredColumn]
    quantities: list[str]
    stations: int
    materials: list[str]
    arcs: list[float]
    points: list[Triple]
    problems: list[Finding]


class MeshFacts(Event):
    """A mesh that was uploaded: its box from `low` to `high` in its own numbers, and its unit.

    The unit is a guess unless it is `stated`; of an array of `voxels` it is the width of one. The
    longest side has `cells` voxels.
    """

    name: str
    low: Triple
    high: Triple
    unit: str
    stated: bool
    voxels: bool
    parts: list[str]
    cells: int


class TableUses(Event):
    """Uses of a table of numbers that was dropped on the page, the likeliest first.

    `coupon` is a test of a material, `stations` are points measured on a body, `curve` is a number
    over another one.
    """

    name: str
    uses: list[TableUse]


class CouponCurve(Entry):
    """A test of a material: the engineering strain and stress that were fitted, Pa."""

    name: str
    mode: str
    strain: list[float]
    stress: list[float]


class CouponModel(Entry):
    """A model fitted to tests of a material.

    `error` is that of the stress, Pa, and `young` the initial modulus between `low` and `high`
    (95 %). `stresses` are those of the model at the strains of each test. `table` is the material
    as a design writes it, empty where `refused` says why it cannot be used.
    """

    name: str
    size: int
    error: float
    largest: float
    young: float
    low: float
    high: float
    stresses: list[list[float]]
    table: dict[str, Json]
    refused: str
    warnings: list[str]


class CouponFit(Event):
    """Models fitted to tests of a material, best prediction first; `recommended` is one of them.

    `name` is a name for the material, `rejected` says which models could not be fitted, and why.
    """

    name: str
    curves: list[CouponCurve]
    models: list[CouponModel]
    recommended: str
    rejected: list[str]


class Exported(Event):
    """A file that is ready to be fetched at `url`."""

    format: str
    url: str
    name: str


class Casting(Entry):
    """A solid to be cast: volumes in m³, masses in kg with the waste in A and B, times in s."""

    name: str
    material: str
    volume: float
    mass: float
    a: float
    b: float
    deviation: float
    trapped_air: float
    pot_life: float | None
    cure: float | None


class MoldProblem(Entry):
    """A proof of molds that fails."""

    where: str
    what: str
    hint: str


class Molds(Event):
    """Molds of the document `rev`; without problems with their sheet, and the archive at `url`."""

    rev: int
    way: str
    why: str
    castings: list[Casting]
    files: list[str]
    notes: list[str]
    problems: list[MoldProblem]
    sheet: str
    url: str
    name: str


class Saved(Event):
    """A file that was written."""

    what: Literal["document", "card", "run", "design"]
    path: str


class FileExists(Event):
    """A file that saving would replace: the page asks, and saves again with `overwrite`."""

    path: str


class Taken(Event):
    """Parameters of a trial that were written into the document; `changed` unless it had them."""

    trial: str
    changed: bool


class VersionRow(Entry):
    """A version of the document; `when` is ISO 8601, `picture` where its body is drawn."""

    id: str
    when: str
    reason: str
    picture: str


class Versions(Event):
    """Versions of the document that is open, the newest first; `most` of them are kept."""

    name: str
    most: int
    versions: list[VersionRow]


class DifferentLine(Entry):
    """A line of a comparison of two texts, with its numbers, counted from 1, in both.

    Lines that both have stand around each change; `gap` is where others are left out, after the
    line `before`.
    """

    mark: Literal["same", "gone", "new", "gap"]
    text: str
    before: int | None = None
    after: int | None = None


class VersionDifference(Event):
    """Changes from a version to the present document; null where they are too long to list."""

    id: str
    lines: list[DifferentLine] | None


class Error(Event):
    """A failure, and a remedy. `seq` is the command's, or 0."""

    seq: int
    where: str
    what: str
    hint: str = ""


class Synced(Event):
    """All commands up to `seq` are done."""

    seq: int


class Log(Event):
    """A line for the log."""

    level: Literal["info", "warning", "error"]
    text: str


AnyEvent = (
    Hello
    | Start
    | Document
    | Edge
    | DesignFiles
    | Materials
    | Ghosts
    | Body
    | Bare
    | Stat
    | Equilibrium
    | Fineness
    | Vibration
    | Chambers
    | Overlap
    | Moments
    | MomentNews
    | Plot
    | Picked
    | Job
    | Subject
    | Trial
    | Trials
    | Generation
    | Overlay
    | Path
    | Calibrated
    | Recipe
    | Runs
    | Compared
    | Measured
    | MeshFacts
    | TableUses
    | CouponFit
    | Exported
    | Molds
    | Saved
    | FileExists
    | Taken
    | Versions
    | VersionDifference
    | Error
    | Synced
    | Log
)
