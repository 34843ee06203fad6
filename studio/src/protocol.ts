// Written by `python -m voxsoft.studio.typescript`; change python/voxsoft/studio instead.
// Long because all messages of the studio stand in one file.

/** Page and server must speak the same. */
export const PROTOCOL = 1;

/** Frames that the server sends before it waits for an `ack`. */
export const CREDITS = 2;

/** Largest file that the server takes, bytes. */
export const LARGEST_UPLOAD = 67108864;

/** First four bytes of a binary message. */
export const MAGIC = 826693718;

/** Length of the head of a binary message, bytes. */
export const HEADER = 64;

/** Topology of the objects around a body at rest. */
export const STILL_OBJECTS = 2;

/** Bit of a triangle's tag that says that it faces a cavity. */
export const CAVITY = 128;

/** Endings of mesh files that are read. */
export const MESHES = [".vtu", ".vti", ".vtp", ".vts", ".vtr", ".vtk", ".nrrd", ".nhdr", ".nii", ".nii.gz", ".tif", ".tiff", ".msh", ".inp", ".mesh", ".stl", ".obj", ".3mf", ".ply", ".off", ".glb", ".npy", ".vxa", ".vxc", ".vxd", ".mat"] as const;

/** Formats of files that the server writes, by ending. */
export const WRITTEN = {
  ".vtu": {"title": "Mesh", "purpose": "To look at displacement, stretch and stress in ParaView or PyVista.", "asksUnit": false, "asksShape": false},
  ".msh": {"title": "Mesh", "purpose": "To go on in Gmsh or a code that reads its meshes.", "asksUnit": false, "asksShape": false},
  ".inp": {"title": "Mesh", "purpose": "To solve the same body in Abaqus or CalculiX and check this result.", "asksUnit": false, "asksShape": false},
  ".stl": {"title": "Surface", "purpose": "To print the body or cut its mold; other programs read it as triangles.", "asksUnit": true, "asksShape": true},
  ".obj": {"title": "Surface", "purpose": "To open the surface in Blender and other modelers.", "asksUnit": true, "asksShape": true},
  ".3mf": {"title": "Surface", "purpose": "To print the parts in their materials: one object, its parts by name, in mm.", "asksUnit": false, "asksShape": true},
  ".glb": {"title": "Surface", "purpose": "To show the body on web pages and in viewers, its parts by name.", "asksUnit": false, "asksShape": true},
  ".npy": {"title": "Voxels", "purpose": "To work on the voxels in Python: an array of part numbers.", "asksUnit": false, "asksShape": false},
  ".xml": {"title": "Scene", "purpose": "To simulate the robot in MuJoCo: flexes, contact, tendons, loads as actuators.", "asksUnit": false, "asksShape": false},
  ".usda": {"title": "Scene", "purpose": "To show the robot and its motion in Blender, Houdini or Omniverse.", "asksUnit": false, "asksShape": false},
  ".pvd": {"title": "Series", "purpose": "To play a path in ParaView: the body at each value, with its objects.", "asksUnit": false, "asksShape": false},
  ".csv": {"title": "Table", "purpose": "To plot probes, residual and energies in a spreadsheet or Python.", "asksUnit": false, "asksShape": false},
  ".toml": {"title": "Design", "purpose": "To keep, cite or send the design: this page of text rebuilds everything.", "asksUnit": false, "asksShape": false},
} as const;

/** Endings of files of CAD programs. */
export const CAD_SUFFIXES = [".step", ".stp", ".p21", ".iges", ".igs", ".brep", ".brp", ".fcstd", ".sldprt", ".sldasm", ".ipt", ".f3d", ".x_t", ".x_b", ".sat", ".3dm"] as const;

/** Why they are not read. */
export const CAD_WHAT = "is a CAD model, whose faces are formulas: only triangles are read";

/** Remedy for them. */
export const CAD_HINT = "export the part as STL or OBJ in the CAD program, or open it in FreeCAD, choose the body and take File, Export";

/** Speeds of time: simulated seconds for each of the clock. */
export const PACES = [1.0, 0.5, 0.2, 0.1, 0.02, 0.005] as const;

/** Why the server closes a websocket; from 4000 on the codes are the studio's own. */
export const CloseCode = {
  "TRY_AGAIN": 1013,
  "OTHER_PROTOCOL": 4000,
  "NO_HELLO": 4001,
  "WRONG_MESSAGES": 4002,
} as const;

/** Kind of a binary message. */
export const MessageKind = {
  "TOPOLOGY": 1,
  "FRAME": 2,
  "SMOOTH": 3,
} as const;

/** Flags of a frame beside its numbers. */
export const FrameFlag = {
  "PAUSED": 1,
  "DIVERGED": 2,
  "AT_REST": 4,
} as const;

/** Kind of a topology. */
export const TopologyFlag = {
  "SURFACE": 1,
  "SHRUNK_TETS": 2,
} as const;

/** Kinds: SI unit, unit of bare numbers, exponents. */
export const KINDS = {
  "length": {"si": "m", "written": "mm", "called": "a length", "dimension": [1, 0, 0, 0, 0, 0]},
  "curvature": {"si": "1/m", "written": "1/m", "called": "a curvature", "dimension": [-1, 0, 0, 0, 0, 0]},
  "area": {"si": "m^2", "written": "mm^2", "called": "an area", "dimension": [2, 0, 0, 0, 0, 0]},
  "volume": {"si": "m^3", "written": "mL", "called": "a volume", "dimension": [3, 0, 0, 0, 0, 0]},
  "pressure": {"si": "Pa", "written": "kPa", "called": "a pressure", "dimension": [-1, 1, -2, 0, 0, 0]},
  "modulus": {"si": "Pa", "written": "kPa", "called": "a pressure", "dimension": [-1, 1, -2, 0, 0, 0]},
  "density": {"si": "kg/m^3", "written": "kg/m^3", "called": "a density", "dimension": [-3, 1, 0, 0, 0, 0]},
  "mass": {"si": "kg", "written": "g", "called": "a mass", "dimension": [0, 1, 0, 0, 0, 0]},
  "force": {"si": "N", "written": "N", "called": "a force", "dimension": [1, 1, -2, 0, 0, 0]},
  "acceleration": {"si": "m/s^2", "written": "m/s^2", "called": "an acceleration", "dimension": [1, 0, -2, 0, 0, 0]},
  "time": {"si": "s", "written": "s", "called": "a time", "dimension": [0, 0, 1, 0, 0, 0]},
  "rate": {"si": "1/s", "written": "1/s", "called": "a rate", "dimension": [0, 0, -1, 0, 0, 0]},
  "speed": {"si": "m/s", "written": "m/s", "called": "a speed", "dimension": [1, 0, -1, 0, 0, 0]},
  "angle": {"si": "rad", "written": "deg", "called": "an angle", "dimension": [0, 0, 0, 1, 0, 0]},
  "stiffness": {"si": "N/m", "written": "N/m", "called": "a stiffness", "dimension": [0, 1, -2, 0, 0, 0]},
  "compliance": {"si": "m/N", "written": "m/N", "called": "a compliance", "dimension": [0, -1, 2, 0, 0, 0]},
  "volume compliance": {"si": "m^3/Pa", "written": "m^3/Pa", "called": "a volume compliance", "dimension": [4, -1, 2, 0, 0, 0]},
  "volume flow": {"si": "m^3/s", "written": "mL/s", "called": "a volume flow", "dimension": [3, 0, -1, 0, 0, 0]},
  "mass flow": {"si": "kg/s", "written": "g/s", "called": "a mass flow", "dimension": [0, 1, -1, 0, 0, 0]},
  "conductance": {"si": "m^3/s/Pa", "written": "L/s/bar", "called": "a conductance", "dimension": [4, -1, 1, 0, 0, 0]},
  "viscosity": {"si": "Pa*s", "written": "Pa*s", "called": "a viscosity", "dimension": [-1, 1, -1, 0, 0, 0]},
  "energy": {"si": "J", "written": "J", "called": "an energy", "dimension": [2, 1, -2, 0, 0, 0]},
  "power": {"si": "W", "written": "W", "called": "a power", "dimension": [2, 1, -3, 0, 0, 0]},
  "angular speed": {"si": "rad/s", "written": "rad/s", "called": "an angular speed", "dimension": [0, 0, -1, 1, 0, 0]},
  "torque": {"si": "N*m", "written": "N*m", "called": "an energy", "dimension": [2, 1, -2, 0, 0, 0]},
  "magnetic field": {"si": "T", "written": "mT", "called": "a magnetic field", "dimension": [0, 1, -2, 0, -1, 0]},
  "voltage": {"si": "V", "written": "kV", "called": "a voltage", "dimension": [2, 1, -3, 0, -1, 0]},
  "electric field": {"si": "V/m", "written": "MV/m", "called": "an electric field", "dimension": [1, 1, -3, 0, -1, 0]},
  "temperature": {"si": "K", "written": "K", "called": "a temperature", "dimension": [0, 0, 0, 0, 0, 1]},
  "thermal expansion": {"si": "1/K", "written": "1/K", "called": "a thermal expansion", "dimension": [0, 0, 0, 0, 0, -1]},
  "number": {"si": "1", "written": "", "called": "a plain number", "dimension": [0, 0, 0, 0, 0, 0]},
} as const;

/** Kinds of shapes that a design file can hold. */
export const SHAPE_KINDS = ["box", "rounded-box", "sphere", "ellipsoid", "cylinder", "tube", "cone", "capsule", "torus", "half-space", "prism", "revolve", "gyroid", "schwarz-p", "schwarz-d", "neovius", "iwp", "cubic", "bcc", "fcc", "octet", "expression", "mesh", "union", "intersection", "difference", "offset", "shell", "blend", "grade", "translate", "rotate", "scale", "mirror", "twist", "bend", "taper", "array", "polar-array"] as const;

/** Ready features by name, and how each is built. */
export const FEATURES = {
  "bellows": "Folds between two lids, which air unfolds.",
  "fold": "A sleeve with one fold, open at both ends.",
  "finger": "A bar with a round tip and a room above its thick foot: it bends.",
  "chamber-row": "A row of chambers with a duct on a foot: it bends as they swell.",
} as const;

/** Units of daily use: SI units in one, and exponents. */
export const COMMON_UNITS = {
  "um": [1e-06, [1, 0, 0, 0, 0, 0]],
  "mm": [0.001, [1, 0, 0, 0, 0, 0]],
  "cm": [0.01, [1, 0, 0, 0, 0, 0]],
  "m": [1.0, [1, 0, 0, 0, 0, 0]],
  "inch": [0.0254, [1, 0, 0, 0, 0, 0]],
  "mg": [1e-06, [0, 1, 0, 0, 0, 0]],
  "g": [0.001, [0, 1, 0, 0, 0, 0]],
  "kg": [1.0, [0, 1, 0, 0, 0, 0]],
  "ms": [0.001, [0, 0, 1, 0, 0, 0]],
  "s": [1.0, [0, 0, 1, 0, 0, 0]],
  "mN": [0.001, [1, 1, -2, 0, 0, 0]],
  "N": [1.0, [1, 1, -2, 0, 0, 0]],
  "kN": [1000.0, [1, 1, -2, 0, 0, 0]],
  "Pa": [1.0, [-1, 1, -2, 0, 0, 0]],
  "kPa": [1000.0, [-1, 1, -2, 0, 0, 0]],
  "MPa": [1000000.0, [-1, 1, -2, 0, 0, 0]],
  "GPa": [1000000000.0, [-1, 1, -2, 0, 0, 0]],
  "bar": [100000.0, [-1, 1, -2, 0, 0, 0]],
  "psi": [6894.757293168361, [-1, 1, -2, 0, 0, 0]],
  "mJ": [0.001, [2, 1, -2, 0, 0, 0]],
  "J": [1.0, [2, 1, -2, 0, 0, 0]],
  "mW": [0.001, [2, 1, -3, 0, 0, 0]],
  "W": [1.0, [2, 1, -3, 0, 0, 0]],
  "mL": [1e-06, [3, 0, 0, 0, 0, 0]],
  "L": [0.001, [3, 0, 0, 0, 0, 0]],
  "deg": [0.017453292519943295, [0, 0, 0, 1, 0, 0]],
  "rad": [1.0, [0, 0, 0, 1, 0, 0]],
  "Hz": [1.0, [0, 0, -1, 0, 0, 0]],
  "mT": [0.001, [0, 1, -2, 0, -1, 0]],
  "T": [1.0, [0, 1, -2, 0, -1, 0]],
  "V": [1.0, [2, 1, -3, 0, -1, 0]],
  "kV": [1000.0, [2, 1, -3, 0, -1, 0]],
  "MV": [1000000.0, [2, 1, -3, 0, -1, 0]],
  "K": [1.0, [0, 0, 0, 0, 0, 1]],
} as const;

export type Triple = [number, number, number];

/** First message of a tab: the protocol that it speaks. */
export interface HelloCommand {
  t: "hello";
  seq: number;
  protocol: number;
  version?: string;
}

/**
 * Reading of a mesh: the unit of its numbers, a factor on them, and its axis that points up.
 *
 * The unit of an array is the width of its voxels, such as "0.5 mm".
 */
export interface MeshImport {
  unit: string;
  scale?: number;
  up?: "-x" | "-y" | "-z" | "x" | "y" | "z";
}

/**
 * Open a document: a template, a robot, a file or run folder, an upload, or a study's trial.
 *
 * A trial is named "ID/INDEX"; a run by its id in the list of runs; a start by its three answers,
 * "pressure-finger-bend"; a document that was left without being saved by its id. `mesh` tells how
 * an uploaded mesh is read.
 */
export interface OpenCommand {
  t: "open";
  seq: number;
  what: "file" | "robot" | "run" | "start" | "template" | "trial" | "unsaved" | "upload";
  name: string;
  mesh?: MeshImport | null;
}

/** Replace the text of the document; `rev` is the revision that was edited. */
export interface TextCommand {
  t: "text";
  seq: number;
  rev: number;
  text: string;
}

/**
 * Set one value of the document, keeping its comments; `null` removes the key.
 *
 * Edits of one place in one `stroke` of the hand, such as the drag of a slider, are undone
 * together.
 */
export interface EditCommand {
  t: "edit";
  seq: number;
  rev: number;
  path: (string | number)[];
  value?: unknown;
  stroke?: number;
}

/** A value of the document at a path; `null` removes the key. */
export interface OneEdit {
  path: (string | number)[];
  value?: unknown;
}

/** Set several values one after the other, as one step that is undone together. */
export interface EditsCommand {
  t: "edits";
  seq: number;
  rev: number;
  changes: OneEdit[];
}

/** A copy that is moved by a vector, m. */
export interface Beside {
  kind: "beside";
  by: Triple;
}

/** The mirror image in the plane across an axis, `at` m along it. */
export interface InMirror {
  kind: "mirror";
  axis: "x" | "y" | "z";
  at?: number;
}

/** Copies at equal angles around an axis through a center, m: `count` with the original. */
export interface Around {
  kind: "around";
  count: number;
  axis?: Triple;
  center?: Triple;
}

/**
 * Copy a body or a rigid object of the design, by its name.
 *
 * The body of a design that has no others becomes the first of a new design of several.
 */
export interface CopyCommand {
  t: "copy";
  seq: number;
  name: string;
  way: Beside | InMirror | Around;
}

/** Move a body or a rigid object of the design by a vector, m. */
export interface MoveCommand {
  t: "move";
  seq: number;
  name: string;
  by: Triple;
}

/** Take a body or a rigid object out of the design, with the pairs of contact that name it. */
export interface RemoveCommand {
  t: "remove";
  seq: number;
  name: string;
}

/** Give a named thing of the design another name, everywhere the text speaks of it. */
export interface RenameCommand {
  t: "rename";
  seq: number;
  section: "bodies" | "chambers" | "constraints" | "histories" | "materials" | "objectives" | "objects" | "parameters" | "probes" | "shapes";
  name: string;
  to: string;
}

/** Exchange two entries of a list of the document, with their comments. */
export interface SwapCommand {
  t: "swap";
  seq: number;
  path: (string | number)[];
  first: number;
  second: number;
}

/** Ask for `synced` once all commands before it are done: requests beside the socket wait. */
export interface SyncCommand {
  t: "sync";
  seq: number;
}

/**
 * Add a body: a design file of the folder, a template, or a file that was uploaded.
 *
 * It stands `beyond` so many m along x; `mesh` is as of `Open`. The body of a design that has no
 * others becomes the first of a new design of several.
 */
export interface AddBodyCommand {
  t: "add_body";
  seq: number;
  what: "file" | "template" | "upload";
  name: string;
  beyond?: number;
  mesh?: MeshImport | null;
}

/**
 * Add a ready feature to the design: its parameters and shapes, by its name.
 *
 * Its foot stands at a place in m; null for the origin. A design without parts gets a part, a
 * clamp and a load with it.
 */
export interface AddFeatureCommand {
  t: "add_feature";
  seq: number;
  name: string;
  at?: Triple | null;
}

/** Ask for the design files beside the document. */
export interface DesignsCommand {
  t: "designs";
  seq: number;
}

/** Ask for the materials that a part can have. */
export interface MaterialsCommand {
  t: "materials";
  seq: number;
}

/** Write the parameters of a study's trial, "ID/INDEX", into the document, as one step. */
export interface TakeCommand {
  t: "take";
  seq: number;
  trial: string;
}

/** Ask for the surfaces of some shapes of the document, by their names. */
export interface GhostsCommand {
  t: "ghosts";
  seq: number;
  names: string[];
}

/**
 * Take back the last change of the document.
 *
 * If it has none, `beyond` leads back to the document before it; else `edge` names that.
 */
export interface UndoCommand {
  t: "undo";
  seq: number;
  beyond?: boolean;
}

/**
 * Make the change again that was taken back last.
 *
 * If there is none, `beyond` leads on to the document after this one; else `edge` names that.
 */
export interface RedoCommand {
  t: "redo";
  seq: number;
  beyond?: boolean;
}

/**
 * Write the document to its file, or to another: a name in its folder, or a whole path.
 *
 * A file of another document is replaced only with `overwrite`.
 */
export interface SaveCommand {
  t: "save";
  seq: number;
  path?: string | null;
  overwrite?: boolean;
}

/** Ask for the versions of the document. */
export interface VersionsCommand {
  t: "versions";
  seq: number;
}

/** Ask how a version of the document differs from it. */
export interface VersionShowCommand {
  t: "version_show";
  seq: number;
  id: string;
}

/** Make the text of a version that of the document, as one step; the present one is kept. */
export interface VersionRestoreCommand {
  t: "version_restore";
  seq: number;
  id: string;
}

/** Let time run. */
export interface PlayCommand {
  t: "play";
  seq: number;
}

/** Stop time. */
export interface PauseCommand {
  t: "pause";
  seq: number;
}

/** Take `n` frames of time and stop. */
export interface StepCommand {
  t: "step";
  seq: number;
  n?: number;
}

/** Go back to the unloaded shape at time zero. */
export interface ResetCommand {
  t: "reset";
  seq: number;
}

/** Solve for the state at rest with the chosen solver. */
export interface RestCommand {
  t: "rest";
  seq: number;
}

/** Look for the error bars of the equilibrium that is shown on voxels half as large. */
export interface EstimateCommand {
  t: "estimate";
  seq: number;
}

/** Ask for the cost of the shown equilibrium on voxels half as large. */
export interface FinenessCommand {
  t: "fineness";
  seq: number;
}

/** Choose the solver of `rest`. */
export interface SolverCommand {
  t: "solver";
  seq: number;
  method: "auto" | "statics" | "xpbd";
}

/** Change a load while time runs: its value in the unit of `BodyLoad`, or as a factor. */
export interface LoadCommand {
  t: "load";
  seq: number;
  index: number;
  value?: number | null;
  factor?: number | null;
}

/**
 * Pull a vertex of the surface toward a point by a spring; the same id moves the point.
 *
 * A free object, by its place among those of the body, is held by its middle instead of a vertex.
 */
export interface GrabCommand {
  t: "grab";
  seq: number;
  id: number;
  vertex: number;
  target: Triple;
  stiffness?: number;
  object?: number | null;
}

/** Take the spring away. */
export interface ReleaseCommand {
  t: "release";
  seq: number;
  id: number;
}

/** Let time run so many times as fast as the clock; null leaves it to the motion. */
export interface PaceCommand {
  t: "pace";
  seq: number;
  factor?: number | null;
}

/** Show a stored frame, by its number or by its time in s; time stops. */
export interface SeekCommand {
  t: "seek";
  seq: number;
  frame?: number;
  time?: number | null;
}

/** Go back from a stored frame to the present. */
export interface LiveCommand {
  t: "live";
  seq: number;
}

/** Draw the equilibrium in one of its natural vibrations, counted from 0; null stops it. */
export interface VibrateCommand {
  t: "vibrate";
  seq: number;
  mode?: number | null;
}

/**
 * View of this tab: the field, the surface or the tetrahedra, and whether it is visible.
 *
 * Solid is the surface with the voxels behind it, which a section shows.
 */
export interface ViewCommand {
  t: "view";
  seq: number;
  field?: number;
  mode?: "solid" | "surface" | "tets";
  visible?: boolean;
}

/** Ask for all values at a vertex of the surface. */
export interface PickCommand {
  t: "pick";
  seq: number;
  vertex: number;
}

/** Plot the displacement of a vertex of the surface over time. */
export interface ProbeCommand {
  t: "probe";
  seq: number;
  vertex: number;
}

/** Say that a frame was shown; allows one more. */
export interface AckCommand {
  t: "ack";
  seq: number;
  frame: number;
}

/** Keep the state on the screen as a run folder, with its live loads and pulls. */
export interface KeepCommand {
  t: "keep";
  seq: number;
  name?: string | null;
}

/**
 * Bring the design to rest, or to its end time, and keep the result as a run folder.
 *
 * `solver` replaces settings of the design's solver. `over` follows a path of equilibria instead:
 * a key of the design with a range, such as "loads[0].value=0..30 kPa/16".
 */
export interface RunSpec {
  kind: "run";
  name?: string | null;
  solver?: Record<string, unknown>;
  over?: string | null;
}

/** A range of a parameter: every `step` of it, or any value. */
export interface SpaceRange {
  low: number;
  high: number;
  step?: number | null;
  log?: boolean;
}

/**
 * Solve many designs. Entries left out are those of the design.
 *
 * `space` holds, by parameter, a range or a list of choices. `objectives` and `constraints` are
 * written as in a design file.
 */
export interface StudySpec {
  kind: "study";
  name?: string | null;
  sampler?: string;
  budget?: number;
  batch?: number | null;
  seed?: number;
  workers?: number | null;
  space?: Record<string, SpaceRange | unknown[]> | null;
  objectives?: Record<string, Record<string, unknown>> | null;
  constraints?: Record<string, Record<string, unknown>> | null;
}

/** Content of a column of a table: a quantity ("s", "dz", "x", ...; "" for nothing), a unit. */
export interface ColumnMap {
  column: string;
  quantity: string;
  unit?: string;
}

/**
 * A measured table: the name of a measurement that was sent, and how to read it.
 *
 * `select` names the material to take, where a table holds several.
 */
export interface MeasuredData {
  name: string;
  columns?: ColumnMap[] | null;
  select?: string | null;
}

/** Fit the design's material to measurements. `bounds` holds (low, high) by constant. */
export interface CalibrateSpec {
  kind: "calibrate";
  data: MeasuredData[];
  name?: string | null;
  method?: string;
  generations?: number;
  population?: number;
  bounds?: Record<string, [number, number]> | null;
  free_scale?: boolean;
  refine?: boolean;
  identify?: boolean;
  seed?: number;
  workers?: number | null;
}

/** Start a job on the document as it stands. */
export interface JobStartCommand {
  t: "job_start";
  seq: number;
  spec: RunSpec | StudySpec | CalibrateSpec;
}

/** Hold a job: work that has begun is finished, and nothing more begins. */
export interface JobPauseCommand {
  t: "job_pause";
  seq: number;
  id: string;
}

/** Go on with a job that was paused or stopped, or with a study of the list of runs. */
export interface JobResumeCommand {
  t: "job_resume";
  seq: number;
  id: string;
}

/** Stop a job; finished work is kept. */
export interface JobStopCommand {
  t: "job_stop";
  seq: number;
  id: string;
}

/** Send the events in the folder of a study or calibration, as they were sent when it ran. */
export interface JobShowCommand {
  t: "job_show";
  seq: number;
  id: string;
}

/** Ask how a job can be done again without the studio. */
export interface RecipeCommand {
  t: "recipe";
  seq: number;
  id: string;
}

/** Ask for the list of runs. */
export interface RunsCommand {
  t: "runs";
  seq: number;
}

/** Give a run folder another name. */
export interface RunRenameCommand {
  t: "run_rename";
  seq: number;
  id: string;
  name: string;
}

/** Move a run folder to the trash. */
export interface RunDeleteCommand {
  t: "run_delete";
  seq: number;
  id: string;
}

/** Take a run folder out of the trash. */
export interface RunRestoreCommand {
  t: "run_restore";
  seq: number;
  id: string;
}

/** Set two runs, or trials written "ID/INDEX", side by side. */
export interface CompareCommand {
  t: "compare";
  seq: number;
  a: string;
  b: string;
}

/** Read a measured table and guess the contents of its columns. */
export interface MeasurementCommand {
  t: "measurement";
  seq: number;
  name: string;
  text: string;
  columns?: ColumnMap[] | null;
  select?: string | null;
}

/** Keep the material of a calibration as a card beside the document. */
export interface CardSaveCommand {
  t: "card_save";
  seq: number;
  job: string;
  name: string;
}

/** A design to start from. */
export interface Template {
  name: string;
  title: string;
  text: string;
}

/** A material card that designs can name; `young` is that of a large block, Pa. */
export interface MaterialCard {
  name: string;
  title: string;
  source: string;
  model: string;
  young: number | null;
}

/** A way to choose trials. */
export interface Sampler {
  name: string;
  title: string;
  single_objective: boolean;
}

/** A constant of a material that is fitted unless others are named, and its range, SI. */
export interface FitRange {
  name: string;
  kind: string;
  low: number;
  high: number;
}

/** A metric for an objective or constraint. */
export interface Metric {
  name: string;
  kind: string;
  needs_probe: boolean;
  needs_base: boolean;
  needs_cavity: boolean;
  takes_percentile: boolean;
  needs_object: boolean;
}

/**
 * A quantity that colors the body; `signed` ones have zero in the middle of their range.
 *
 * Fields of `contact` are known where a solution with contact ends.
 */
export interface Field {
  id: number;
  name: string;
  title: string;
  unit: string;
  signed: boolean;
  contact: boolean;
}

/**
 * First event: abilities of this server. `design_schema` is the JSON Schema of a design.
 *
 * `fit_ranges` holds for each model of a material the constants that a calibration fits.
 */
export interface HelloEvent {
  t: "hello";
  version: string;
  protocol: number;
  design_schema: Record<string, unknown>;
  templates: Template[];
  materials: MaterialCard[];
  samplers: Sampler[];
  calibration_methods: string[];
  fit_ranges: Record<string, FitRange[]>;
  methods: string[];
  metrics: Metric[];
  fields: Field[];
  runs_folder: string;
  cores: number;
}

/** A finished robot to open, and the addresses of its pictures; `moving` may be empty. */
export interface Robot {
  name: string;
  title: string;
  sentence: string;
  picture: string;
  moving: string;
}

/** A robot, with values of its own, for the three answers to New. */
export interface Way {
  name: string;
  drive: string;
  form: string;
  task: string;
  robot: string;
  sentence: string;
}

/**
 * A design that was opened or saved; `when` is ISO 8601, `picture` where it is drawn.
 *
 * One that was left without being saved has an id in `unsaved`, and neither path nor folder.
 */
export interface RecentFile {
  path: string;
  name: string;
  folder: string;
  when: string;
  picture: string;
  unsaved: string;
}

/** Content of the start screen; `fresh` while nothing was opened or changed yet. */
export interface StartEvent {
  t: "start";
  fresh: boolean;
  robots: Robot[];
  ways: Way[];
  recent: RecentFile[];
}

/**
 * A parameter of the document; numbers are SI, `text` is the value as it is written.
 *
 * `display_unit` and `factor`: value / factor is the number to show with that unit. `former` is
 * the value when the document was opened or saved last.
 */
export interface Parameter {
  name: string;
  value: number;
  kind: string;
  text: string;
  min: number | null;
  max: number | null;
  step: number | null;
  display_unit: string;
  factor: number;
  formula: boolean;
  former: number | null;
  description: string;
}

/** Something wrong with the text. Lines and columns count from 1; columns may be unknown (0). */
export interface Diagnostic {
  line: number;
  column: number;
  end_column: number;
  severity: "error" | "note" | "warning";
  where: string;
  what: string;
  hint: string;
}

/** An entry that uses a history, and the value of a factor of 1, such as "30 kPa". */
export interface HistoryUse {
  title: string;
  amount: string;
}

/**
 * A history over time, or a place that has none.
 *
 * `path` is where it is written. Points can be moved; `words` is the text of the other ways.
 * `times` in s and `factors` are one cycle of `repeat`; factors stay between `low` and `high`.
 * `lives` names the file of a body that it is written in, where it is changed; "" in the document.
 */
export interface HistoryLine {
  path: (string | number)[];
  title: string;
  used_by: HistoryUse[];
  way: "expression" | "none" | "points" | "sine" | "table";
  words: string;
  times: number[];
  factors: number[];
  repeat: number;
  low: number | null;
  high: number | null;
  lives: string;
}

/**
 * The document as it stands; `design` is that of the last text that was good (or null).
 *
 * `id` tells it from other documents that were open, `hash` its present design from earlier ones.
 * `dirty`: it differs from the text opened or saved last. `folder` is where it would be saved.
 * `empty`: nothing is described yet, so that it is no design, and has no fault either.
 * `before` and `after` name documents with unsaved changes that were open before and after it;
 * undo and redo come there only where they are asked to go beyond its own changes. `histories` are
 * those of the last text that was good.
 */
export interface DocumentEvent {
  t: "document";
  rev: number;
  id: string;
  hash: string;
  text: string;
  name: string;
  path: string | null;
  folder: string;
  dirty: boolean;
  valid: boolean;
  empty: boolean;
  parameters: Parameter[];
  design: Record<string, unknown> | null;
  source: Record<string, unknown> | null;
  diagnostics: Diagnostic[];
  can_undo: boolean;
  can_redo: boolean;
  before: string;
  after: string;
  histories: HistoryLine[];
}

/** Undo or redo has come to the end of the changes of a document; `beyond` is the next one. */
export interface EdgeEvent {
  t: "edge";
  way: "redo" | "undo";
  name: string;
  beyond: string;
}

/**
 * A design file beside the document: its name there, and that of the design.
 *
 * `parameters` holds the values that a body may set, as they are written.
 */
export interface DesignFile {
  file: string;
  title: string;
  parameters: Record<string, string>;
}

/** The design files in the folder of the document, without its own. */
export interface DesignFilesEvent {
  t: "design_files";
  folder: string;
  files: DesignFile[];
}

/**
 * Data of a material, SI; null and "" where nobody stated it.
 *
 * `same_as` and `choice` are of a plain name: the card that it stands for, and why. `tested_from`
 * and `tested_to` are the stretches between which specimens were tested. `stress_at_double` is the
 * nominal stress at 100 % strain. `stretches` and `stresses` are the curve of the model itself in
 * uniaxial tension; empty where it has none. `table` is the material as a design writes it.
 */
export interface MaterialFacts {
  name: string;
  title: string;
  origin: "card" | "design" | "file";
  same_as: string;
  choice: string;
  model: string;
  live: "explicit" | "implicit" | "none";
  shore: string;
  young: number | null;
  density: number | null;
  tested_from: number | null;
  tested_to: number | null;
  elongation_at_break: number | null;
  stress_at_double: number | null;
  source: string;
  caution: string;
  license: string;
  stretches: number[];
  stresses: (number | null)[];
  table: Record<string, unknown>;
}

/**
 * All materials that a part can have: those of the design at `rev`, then the cards.
 *
 * `mixed` describes effects of parts of spring lattices and of rubber together; "" elsewhere.
 */
export interface MaterialsEvent {
  t: "materials";
  rev: number;
  materials: MaterialFacts[];
  mixed: string;
}

/** Frame of a body: its origin in m, and its rotation, nine numbers by rows. */
export interface BodyPose {
  position: Triple;
  rotation: number[];
}

/**
 * A shape by itself, in its own frame; `poses` are those of the bodies that are made of it.
 *
 * `vertices` are x, y, z as float32 in m and `triangles` three indices as uint32, in base64; `low`
 * and `high` are their bounds. Samples are `step` m apart: walls that are thinner may be missing.
 * It goes on beyond the picture along the axes of `clipped`. `trouble` is why there is no surface,
 * or an empty text.
 */
export interface Ghost {
  name: string;
  vertices: string;
  triangles: string;
  low: Triple;
  high: Triple;
  step: number;
  clipped: string;
  trouble: string;
  poses: BodyPose[];
}

/** The shapes that a tab asked for, as the last good design has them at a revision. */
export interface GhostsEvent {
  t: "ghosts";
  rev: number;
  shapes: Ghost[];
}

/** An enclosed space: its name or an empty text, volume in m³, area in m². */
export interface Cavity {
  name: string;
  volume: number;
  area: number;
  center: Triple;
}

/** A chamber that is open: its volume in m³, the place of the opening. */
export interface Leak {
  volume: number;
  point: Triple;
}

/** A finding of a check; `at` is a point of the unloaded body in m where it is seen. */
export interface Finding {
  severity: "error" | "note" | "warning";
  where: string;
  what: string;
  hint: string;
  at: Triple | null;
}

/** A clamp: how many vertices it holds, their center, and some of them. */
export interface BodyClamp {
  name: string;
  vertices: number;
  center: Triple;
  points: Triple[];
}

/**
 * A load with the range of its slider; value / factor is the number to show with `unit`.
 *
 * `kind` is that of the load in a design, `quantity` that of its size.
 */
export interface BodyLoad {
  index: number;
  kind: string;
  label: string;
  value: number;
  quantity: string;
  unit: string;
  factor: number;
  min: number;
  max: number;
  at: Triple;
  direction: Triple;
}

/** A named place of measurement, with the surface vertices of it. */
export interface BodyProbe {
  name: string;
  center: Triple;
  vertices: number[];
}

/** A part; `color` is a CSS color, and `body` the body that it is of where there are several. */
export interface BodyPart {
  name: string;
  material: string;
  color: string;
  body: string;
}

/** A layer: its stiffness in N/m, its center, and triangles of drawn vertices, three each. */
export interface BodyLayer {
  name: string;
  stiffness: number;
  center: Triple;
  triangles: number[];
}

/** A place: its center in the unloaded body, and the drawn vertices that carry it, if any. */
export interface BodyPlace {
  center: Triple;
  vertices: number[];
}

/**
 * An attachment of the body: the places that it joins, in turn.
 *
 * `load` is the index of the load that pulls it; null where nothing does.
 */
export interface BodyAttachment {
  name: string;
  summary: string;
  places: BodyPlace[];
  load: number | null;
}

/**
 * A rigid object where it is at first: `middle` is that of its box, which poses move and turn.
 *
 * `vertices` are x, y, z as float32 in m and `triangles` three indices as uint32, in base64.
 */
export interface BodyObject {
  name: string;
  motion: "fixed" | "free" | "moved";
  middle: Triple;
  vertices: string;
  triangles: string;
}

/** One of several bodies, unloaded: its bounds in m, and its first and last drawn vertex. */
export interface BodyOfSeveral {
  name: string;
  bounds: [Triple, Triple];
  vertices: [number, number];
}

/** A plane of symmetry: the axis across it, 0 to 2, and where it is along that in m. */
export interface BodyPlane {
  axis: number;
  at: number;
}

/**
 * Two things that are bonded, and points of the unloaded first one where they are, m.
 *
 * `strength` is the traction at which it lets go, Pa; null for one that does not.
 */
export interface BodyBond {
  of: [string, string];
  strength: number | null;
  points: Triple[];
}

/**
 * A new body: its topology follows as a binary message with the same id.
 *
 * `mass` is null where the body cannot be solved. `smooth` says that the smooth surface of the
 * shapes follows as well (kind 3), `cut` that this surface cuts voxels. `not_live` is why time
 * does not run, or an empty text; `touches` tells whether anything of the design may touch.
 * `bodies` is empty where there is one. `floor` is the height of the floor in m; null where there
 * is none. `refused` has a sentence for each use that refuses the design
 * (`voxsoft.simulation.compatibility`).
 */
export interface BodyEvent {
  t: "body";
  topology: number;
  rev: number;
  voxels: number;
  vertices: number;
  tets: number;
  surface_vertices: number;
  triangles: number;
  voxel_size: number;
  cavities: Cavity[];
  leaks: Leak[];
  mass: number | null;
  volume: number;
  bounds: [Triple, Triple];
  findings: Finding[];
  clamps: BodyClamp[];
  loads: BodyLoad[];
  probes: BodyProbe[];
  parts: BodyPart[];
  layers: BodyLayer[];
  attachments: BodyAttachment[];
  objects: BodyObject[];
  not_live: string;
  touches: boolean;
  seconds: number;
  memory: number;
  smooth: boolean;
  cut: boolean;
  bodies: BodyOfSeveral[];
  planes: BodyPlane[];
  floor: number | null;
  bonds: BodyBond[];
  refused: Record<string, string>;
}

/** There is no body to be shown: the document has none, or it is not there yet. */
export interface BareEvent {
  t: "bare";
}

/**
 * A spring that pulls: force in N on the body, distance to its target in m.
 *
 * If it holds an object, that is its place among those of the body, and `vertex` means nothing.
 */
export interface GrabState {
  id: number;
  vertex: number;
  target: Triple;
  stiffness: number;
  force: Triple;
  stretch: number;
  object: number | null;
}

/**
 * State of the simulation. Times in s, `step_ms` in ms for one substep, energies in J.
 *
 * `real_time_factor` is simulated over wall-clock time, and `pace` its upper limit;
 * `pace_chosen` is the user's choice, or null, and `pace_choices` the number of choices
 * for this body. Stored frames run from `first_frame` to `last_frame`. `untimed`: the shown state
 * was found without time, and `time` is that of the motion played before.
 */
export interface StatEvent {
  t: "stat";
  topology: number;
  state: "at-rest" | "diverged" | "empty" | "meshing" | "past" | "paused" | "playing" | "solving";
  sentence: string;
  time: number;
  untimed: boolean;
  step_ms: number;
  substeps: number;
  real_time_factor: number;
  pace: number;
  pace_chosen: number | null;
  pace_choices: number;
  residual: number | null;
  elastic: number | null;
  kinetic: number | null;
  frame: number;
  first_frame: number;
  last_frame: number;
  frames_stored: number;
  bytes_stored: number;
  solver: string;
  progress: number | null;
  loads: number[];
  grabs: GrabState[];
}

/**
 * A probe and how far it moved, m; `estimate` is that with its error bars in words.
 *
 * `share` is the error as a part of the displacement; null where it is not known.
 */
export interface MovedProbe {
  name: string;
  displacement: Triple;
  estimate: string;
  share: number | null;
}

/**
 * A metric of the body as it stands, SI; `kind` tells its unit, `estimate` its error bar.
 *
 * `share` is the error as a part of the value; null where it is not known.
 */
export interface MetricValue {
  name: string;
  value: number | null;
  kind: string;
  estimate: string;
  share: number | null;
}

/**
 * A chamber: volumes unloaded and now in m³, pressure in Pa, the volume with its error bar.
 *
 * `share` is the error as a part of how far the volume grew; null where it is not known.
 */
export interface Chamber {
  name: string;
  rest_volume: number;
  volume: number;
  pressure: number;
  estimate: string;
  share: number | null;
}

/** Something by its name, and its state in words; `estimate` has its error bars in words. */
export interface Summarized {
  name: string;
  words: string;
  estimate: string;
}

/**
 * Grip on a free object at the end of a run, also in a sentence.
 *
 * `held` only by moving or soft things; `slips` where more slips than sticks; `touched` while it
 * still stands on something fixed; `lost` where nothing presses it. `rise` is the way up
 * in m, `pressed` the force that presses it in N, `weight` its weight in N, null without gravity,
 * and `margin` the largest possible friction over the present one, null without any.
 */
export interface Grip {
  name: string;
  verdict: "held" | "lost" | "slips" | "touched";
  sentence: string;
  rise: number;
  pressed: number;
  weight: number | null;
  margin: number | null;
}

/**
 * The numbers of the state that `frame` shows, and its doubtful points.
 *
 * `residual` is a share of the load in words, `largest_strain` that of the largest stretch.
 * `error_bars` says where error bars come from, or why there are none; told a second time once
 * they are known. `looking` while they are being looked for, and `askable` where none were found
 * and smaller voxels could still give them. `missing` names the parts of a stored state that are
 * not there, in a sentence; empty where all is.
 */
export interface EquilibriumEvent {
  t: "equilibrium";
  topology: number;
  frame: number;
  status: string;
  sentence: string;
  residual: string;
  seconds: number;
  probes: MovedProbe[];
  metrics: MetricValue[];
  chambers: Chamber[];
  largest_strain: number;
  warnings: Finding[];
  tendons: Summarized[];
  reactions: Summarized[];
  supplies: Summarized[];
  grips: Grip[];
  error_bars: string;
  looking: boolean;
  askable: boolean;
  missing: string;
}

/** A value of the document at a path, as an edit of it. */
export interface TextChange {
  path: (string | number)[];
  value: unknown;
}

/**
 * Cost of the shown equilibrium on voxels half as large, and the way to have them.
 *
 * Sizes in m, memory in bytes, `seconds` of the solution, null where no solver found the state.
 * `halving` makes the voxels half as large; where it is empty `not_halved` says why. Parts of
 * `refinable` can be refined alone; where there is none `not_refined` says why. `refinements` is
 * how many there are. `refining` halves the voxels that hold most of the error; it is empty where
 * voxels cannot have two sizes, or have them.
 */
export interface FinenessEvent {
  t: "fineness";
  topology: number;
  voxel_size: number;
  voxels: number;
  memory: number;
  seconds: number | null;
  half_voxels: number;
  half_memory: number;
  half_seconds: number | null;
  free_memory: number;
  halving: TextChange[];
  not_halved: string;
  refinable: string[];
  not_refined: string;
  refinements: number;
  refining: TextChange[];
}

/**
 * The slowest natural vibrations of the state that `frame` shows, in Hz.
 *
 * `mode` is the one that is drawn, from 0, `amplitude` how far it is drawn in m, and `period` how
 * long a drawn swing takes in s. While they are looked for there are none; `trouble` says why
 * there are none, and `hint` is the remedy.
 */
export interface VibrationEvent {
  t: "vibration";
  topology: number;
  frame: number;
  frequencies: number[];
  mode: number | null;
  amplitude: number;
  period: number;
  trouble: string;
  hint: string;
}

/** A volume of gas or liquid over time: gauge pressure in Pa, volume in m³, flow in kg/s. */
export interface ChamberCurve {
  name: string;
  pressure: number[];
  volume: number[];
  flow: number[];
}

/** State of supplies in the shown motion, at instants in s; empty where nothing happened. */
export interface ChambersEvent {
  t: "chambers";
  topology: number;
  times: number[];
  chambers: ChamberCurve[];
}

/** A place where a body is in itself: its depth in m, and a point of it unloaded and now, m. */
export interface OverlapPlace {
  depth: number;
  rest: Triple;
  now: Triple;
}

/** Places where the shown body is in itself, the deepest one first; none where it is not. */
export interface OverlapEvent {
  t: "overlap";
  topology: number;
  depth: number;
  sentence: string;
  places: OverlapPlace[];
}

/** Pose of an object: the middle of its box in m, and its rotation, nine numbers by rows. */
export interface ObjectPose {
  position: Triple;
  rotation: number[];
}

/**
 * A pair in contact: the force on the first in N, the area in m² and the smallest gap in m.
 *
 * `pressed` is the sum of the sizes of all forces, and `slipping` the part of it that slips.
 * `friction` is the size of that part of the force and `bound` the most that it can be, in N;
 * null where motion is live.
 */
export interface Touch {
  of: [string, string];
  force: Triple;
  pressed: number;
  area: number;
  gap: number;
  slipping: number;
  friction: number | null;
  bound: number | null;
}

/**
 * A frame of a solution: its time in s, the pose of each object of the body, its contacts.
 *
 * `fields` tells whether the fields of contact are known of it. `depth` is how deep surfaces are
 * in each other in m, where that is more than live contact should let them.
 */
export interface Moment {
  frame: number;
  time: number;
  poses: ObjectPose[];
  contacts: Touch[];
  fields: boolean;
  depth: number | null;
}

/** Data of stored frames beside their pictures; replaces those known before. */
export interface MomentsEvent {
  t: "moments";
  topology: number;
  moments: Moment[];
}

/** Contacts in the newest frame of a body that moves; adds to those known before. */
export interface MomentNewsEvent {
  t: "moment";
  topology: number;
  moment: Moment;
}

/**
 * Rows to append to the plots: time, residual, elastic and kinetic energy, then each probe.
 *
 * `names` and `units` name all columns. Values that are not finite come as null.
 */
export interface PlotEvent {
  t: "plot";
  topology: number;
  names: string[];
  units: string[];
  rows: ((number | null)[])[];
  clear: boolean;
}

/** A field's value at a vertex. */
export interface Value {
  field: number;
  name: string;
  value: number | null;
  unit: string;
}

/** All values at a vertex of the surface; positions in m. */
export interface PickedEvent {
  t: "picked";
  vertex: number;
  rest: Triple;
  position: Triple;
  values: Value[];
}

/**
 * State of a job: `done` of `total` designs, generations or other units, named in `of`.
 *
 * `left` is the time that these will still take in s, `best` a short text.
 */
export interface JobEvent {
  t: "job";
  id: string;
  kind: "calibrate" | "run" | "study";
  name: string;
  state: "done" | "failed" | "interrupted" | "paused" | "pausing" | "running" | "stopped" | "stopping";
  done: number;
  total: number;
  elapsed: number;
  left: number | null;
  best: string;
  folder: string;
  message: string;
  of: string;
  stage: string;
  parameters: string[];
  objectives: string[];
  directions: string[];
}

/**
 * The design that a job is of: its name, its hash, and the document that it was started from.
 *
 * `document` is empty for a job of an earlier studio.
 */
export interface SubjectEvent {
  t: "subject";
  job: string;
  document: string;
  design: string;
  hash: string;
}

/** A trial of a study; `objectives` is null where it has no result. */
export interface TrialEvent {
  t: "trial";
  job: string;
  index: number;
  parameters: Record<string, unknown>;
  objectives: Record<string, number> | null;
  metrics: Record<string, number | null>;
  status: string;
  seconds: number;
  feasible: boolean;
  front: boolean;
  message: string;
}

/** A constraint of a study: the metric that it keeps within bounds, SI; null where open. */
export interface Bound {
  name: string;
  metric: string;
  min: number | null;
  max: number | null;
}

/** A range of a parameter that a study has varied, SI; `step` is null for any value. */
export interface TriedRange {
  low: number;
  high: number;
  step: number | null;
  log: boolean;
}

/**
 * All trials of a study so far, replacing those sent before; kinds by name tell the units.
 *
 * `space` holds the ranges of the parameters that it varied, without lists of choices.
 */
export interface TrialsEvent {
  t: "trials";
  job: string;
  parameters: string[];
  objectives: string[];
  directions: string[];
  kinds: Record<string, string>;
  trials: TrialEvent[];
  constraints: Bound[];
  space: Record<string, TriedRange>;
}

/** A generation of a calibration: fitness, and error in m. */
export interface GenerationEvent {
  t: "generation";
  job: string;
  index: number;
  best: number;
  mean: number;
  error: number | null;
  parameters: Record<string, number>;
  spread: Record<string, [number, number]>;
}

/** Measured and simulated stations of one experiment in m; errors in m. */
export interface OverlayExperiment {
  name: string;
  measured: Triple[];
  simulated: Triple[];
  error: number[];
  percent: number[];
}

/** The best candidate of a calibration over the measurements. */
export interface OverlayEvent {
  t: "overlay";
  job: string;
  experiments: OverlayExperiment[];
}

/** A number along a path, in SI units; its kind tells the unit. */
export interface PathColumn {
  name: string;
  kind: string;
  values: (number | null)[];
}

/**
 * The equilibria of a job along a path so far; `asked` is how many there are to be.
 *
 * `message` is empty until it ends.
 */
export interface PathEvent {
  t: "path";
  job: string;
  over: string;
  kind: string;
  values: number[];
  asked: number;
  columns: PathColumn[];
  status: string;
  message: string;
}

/** A constant that was fitted; `sentence` gives the information of the data about it. */
export interface FittedParameter {
  name: string;
  value: number;
  kind: string;
  text: string;
  low: number;
  high: number;
  identifiable: boolean | null;
  sentence: string;
}

/** The error at one station, in m and in percent of the sag. */
export interface StationError {
  experiment: string;
  station: string;
  measured: number[];
  simulated: number[];
  error: number;
  percent: number;
}

/**
 * The result of a calibration; errors in m. `card` is the text of the material card.
 *
 * `miss` says where and by how much the model misses more than marks are misread, or is empty.
 */
export interface CalibratedEvent {
  t: "calibrated";
  job: string;
  parameters: FittedParameter[];
  table: StationError[];
  quantities: string[];
  identifiable: Record<string, boolean>;
  fitness: number;
  mean_error: number;
  max_error: number;
  material: Record<string, unknown>;
  card: string;
  miss: string;
  warnings: string[];
}

/**
 * Ways to repeat a job: a script, and a command where the options allow it (else "").
 *
 * `version` is that of the VoxSoft which did it; "" while it has not ended.
 */
export interface RecipeEvent {
  t: "recipe";
  job: string;
  python: string;
  command: string;
  seed: number | null;
  version: string;
}

/**
 * A folder of the list of runs; `when` is ISO 8601, `thumbnail` an address.
 *
 * `again` tells whether the studio knows how it can be done again.
 */
export interface RunRow {
  id: string;
  kind: "calibrate" | "run" | "study" | "unknown";
  name: string;
  status: string;
  best: string;
  when: string;
  seconds: number | null;
  folder: string;
  thumbnail: string | null;
  message: string;
  trials: number | null;
  again: boolean;
}

/** The list of runs, newest first; `trash` holds those that can be restored. */
export interface RunsEvent {
  t: "runs";
  rows: RunRow[];
  trash: RunRow[];
  folder: string;
}

/** One side of a comparison. */
export interface Side {
  id: string;
  name: string;
  status: string;
  parameters: Record<string, unknown>;
  metrics: Record<string, number | null>;
  text: string;
}

/** A value of the design in which two sides differ. */
export interface Difference {
  where: string;
  a: unknown;
  b: unknown;
}

/** Two runs or trials side by side. */
export interface ComparedEvent {
  t: "compared";
  a: Side;
  b: Side;
  differences: Difference[];
}

/** A column of a measured table as it is understood. */
export interface MeasuredColumn {
  column: string;
  quantity: string;
  unit: string;
  sample: string[];
}

/** A measured table as it is understood; `problems` tell why it cannot be used as it is. */
export interface MeasuredEvent {
  t: "measured";
  name: string;
  columns: MeasuredColumn[];
  quantities: string[];
  stations: number;
  materials: string[];
  arcs: number[];
  points: Triple[];
  problems: Finding[];
}

/**
 * A mesh that was uploaded: its box from `low` to `high` in its own numbers, and its unit.
 *
 * The unit is a guess unless it is `stated`; of an array of `voxels` it is the width of one. The
 * longest side has `cells` voxels.
 */
export interface MeshFactsEvent {
  t: "mesh_facts";
  name: string;
  low: Triple;
  high: Triple;
  unit: string;
  stated: boolean;
  voxels: boolean;
  parts: string[];
  cells: number;
}

/**
 * Uses of a table of numbers that was dropped on the page, the likeliest first.
 *
 * `coupon` is a test of a material, `stations` are points measured on a body, `curve` is a number
 * over another one.
 */
export interface TableUsesEvent {
  t: "table_uses";
  name: string;
  uses: ("coupon" | "curve" | "stations")[];
}

/** A test of a material: the engineering strain and stress that were fitted, Pa. */
export interface CouponCurve {
  name: string;
  mode: string;
  strain: number[];
  stress: number[];
}

/**
 * A model fitted to tests of a material.
 *
 * `error` is that of the stress, Pa, and `young` the initial modulus between `low` and `high`
 * (95 %). `stresses` are those of the model at the strains of each test. `table` is the material
 * as a design writes it, empty where `refused` says why it cannot be used.
 */
export interface CouponModel {
  name: string;
  size: number;
  error: number;
  largest: number;
  young: number;
  low: number;
  high: number;
  stresses: number[][];
  table: Record<string, unknown>;
  refused: string;
  warnings: string[];
}

/**
 * Models fitted to tests of a material, best prediction first; `recommended` is one of them.
 *
 * `name` is a name for the material, `rejected` says which models could not be fitted, and why.
 */
export interface CouponFitEvent {
  t: "coupon_fit";
  name: string;
  curves: CouponCurve[];
  models: CouponModel[];
  recommended: string;
  rejected: string[];
}

/** A file that is ready to be fetched at `url`. */
export interface ExportedEvent {
  t: "exported";
  format: string;
  url: string;
  name: string;
}

/** A solid to be cast: volumes in m³, masses in kg with the waste in A and B, times in s. */
export interface Casting {
  name: string;
  material: string;
  volume: number;
  mass: number;
  a: number;
  b: number;
  deviation: number;
  trapped_air: number;
  pot_life: number | null;
  cure: number | null;
}

/** A proof of molds that fails. */
export interface MoldProblem {
  where: string;
  what: string;
  hint: string;
}

/** Molds of the document `rev`; without problems with their sheet, and the archive at `url`. */
export interface MoldsEvent {
  t: "molds";
  rev: number;
  way: string;
  why: string;
  castings: Casting[];
  files: string[];
  notes: string[];
  problems: MoldProblem[];
  sheet: string;
  url: string;
  name: string;
}

/** A file that was written. */
export interface SavedEvent {
  t: "saved";
  what: "card" | "design" | "document" | "run";
  path: string;
}

/** A file that saving would replace: the page asks, and saves again with `overwrite`. */
export interface FileExistsEvent {
  t: "file_exists";
  path: string;
}

/** Parameters of a trial that were written into the document; `changed` unless it had them. */
export interface TakenEvent {
  t: "taken";
  trial: string;
  changed: boolean;
}

/** A version of the document; `when` is ISO 8601, `picture` where its body is drawn. */
export interface VersionRow {
  id: string;
  when: string;
  reason: string;
  picture: string;
}

/** Versions of the document that is open, the newest first; `most` of them are kept. */
export interface VersionsEvent {
  t: "versions";
  name: string;
  most: number;
  versions: VersionRow[];
}

/**
 * A line of a comparison of two texts, with its numbers, counted from 1, in both.
 *
 * Lines that both have stand around each change; `gap` is where others are left out, after the
 * line `before`.
 */
export interface DifferentLine {
  mark: "gap" | "gone" | "new" | "same";
  text: string;
  before: number | null;
  after: number | null;
}

/** Changes from a version to the present document; null where they are too long to list. */
export interface VersionDifferenceEvent {
  t: "version_difference";
  id: string;
  lines: DifferentLine[] | null;
}

/** A failure, and a remedy. `seq` is the command's, or 0. */
export interface ErrorEvent {
  t: "error";
  seq: number;
  where: string;
  what: string;
  hint: string;
}

/** All commands up to `seq` are done. */
export interface SyncedEvent {
  t: "synced";
  seq: number;
}

/** A line for the log. */
export interface LogEvent {
  t: "log";
  level: "error" | "info" | "warning";
  text: string;
}

export type AnyCommand =
  | HelloCommand
  | OpenCommand
  | TextCommand
  | EditCommand
  | EditsCommand
  | CopyCommand
  | MoveCommand
  | RemoveCommand
  | RenameCommand
  | SwapCommand
  | SyncCommand
  | AddBodyCommand
  | AddFeatureCommand
  | DesignsCommand
  | MaterialsCommand
  | TakeCommand
  | GhostsCommand
  | UndoCommand
  | RedoCommand
  | SaveCommand
  | VersionsCommand
  | VersionShowCommand
  | VersionRestoreCommand
  | PlayCommand
  | PauseCommand
  | StepCommand
  | ResetCommand
  | RestCommand
  | EstimateCommand
  | FinenessCommand
  | SolverCommand
  | LoadCommand
  | GrabCommand
  | ReleaseCommand
  | PaceCommand
  | SeekCommand
  | LiveCommand
  | VibrateCommand
  | ViewCommand
  | PickCommand
  | ProbeCommand
  | AckCommand
  | KeepCommand
  | JobStartCommand
  | JobPauseCommand
  | JobResumeCommand
  | JobStopCommand
  | JobShowCommand
  | RecipeCommand
  | RunsCommand
  | RunRenameCommand
  | RunDeleteCommand
  | RunRestoreCommand
  | CompareCommand
  | MeasurementCommand
  | CardSaveCommand;

export type AnyEvent =
  | HelloEvent
  | StartEvent
  | DocumentEvent
  | EdgeEvent
  | DesignFilesEvent
  | MaterialsEvent
  | GhostsEvent
  | BodyEvent
  | BareEvent
  | StatEvent
  | EquilibriumEvent
  | FinenessEvent
  | VibrationEvent
  | ChambersEvent
  | OverlapEvent
  | MomentsEvent
  | MomentNewsEvent
  | PlotEvent
  | PickedEvent
  | JobEvent
  | SubjectEvent
  | TrialEvent
  | TrialsEvent
  | GenerationEvent
  | OverlayEvent
  | PathEvent
  | CalibratedEvent
  | RecipeEvent
  | RunsEvent
  | ComparedEvent
  | MeasuredEvent
  | MeshFactsEvent
  | TableUsesEvent
  | CouponFitEvent
  | ExportedEvent
  | MoldsEvent
  | SavedEvent
  | FileExistsEvent
  | TakenEvent
  | VersionsEvent
  | VersionDifferenceEvent
  | ErrorEvent
  | SyncedEvent
  | LogEvent;
