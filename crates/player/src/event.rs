use serde::Serialize;
use voxsoft_solid::vector::Vec3;

/// What a player tells, under the names that the page's protocol has. SI units; numbers that are not finite
/// are absent.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "t", rename_all = "lowercase")]
pub enum Event {
    /// Where the simulation stands.
    Stat(Stat),
    /// Rows of the plots.
    Plot(Plot),
    /// All fields at a point.
    Picked(Picked),
    /// What touches what in a frame, and where objects are.
    Moment(MomentOf),
}

/// A moment of a body.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MomentOf {
    /// The number of the body.
    pub topology: u32,
    /// What is told.
    pub moment: Moment,
}

/// A frame beside its picture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Moment {
    /// Its number.
    pub frame: u64,
    /// In s.
    pub time: f64,
    /// Of each object.
    pub poses: Vec<Pose>,
    /// Pair by pair.
    pub contacts: Vec<Touch>,
    /// Whether fields of contact are known.
    pub fields: bool,
    /// How deep surfaces are in each other in m, where that is more than contact lets them in a step.
    pub depth: Option<f64>,
}

/// Where an object is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Pose {
    /// The middle of its first box, in m.
    pub position: Vec3,
    /// From its first pose, nine numbers by rows.
    pub rotation: Vec<f64>,
}

/// What touches what.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Touch {
    /// The two, by name.
    pub of: [String; 2],
    /// On the first, in N.
    pub force: Vec3,
    /// The sum of the sizes of all forces, in N.
    pub pressed: f64,
    /// In m².
    pub area: f64,
    /// The smallest, in m.
    pub gap: f64,
    /// The part of the pressure under which they slip.
    pub slipping: f64,
}

/// Whether time runs, and why not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// It stands still.
    Paused,
    /// It runs.
    Playing,
    /// Nothing moves until something is changed.
    AtRest,
    /// The body could not be followed.
    Diverged,
    /// A recorded frame is looked at.
    Past,
}

impl Mode {
    /// Its name in the protocol.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paused => "paused",
            Self::Playing => "playing",
            Self::AtRest => "at-rest",
            Self::Diverged => "diverged",
            Self::Past => "past",
        }
    }
}

/// All numbers of the moment.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stat {
    /// The number of the body.
    pub topology: u32,
    /// Whether time runs.
    pub state: Mode,
    /// The same in words; may be empty.
    pub sentence: String,
    /// The time that is looked at in s.
    pub time: f64,
    /// Clock time of a step in ms.
    pub step_ms: f64,
    /// Steps taken since the start.
    pub substeps: u64,
    /// Simulated over clock time.
    pub real_time_factor: f64,
    /// What it shall be at most.
    pub pace: f64,
    /// What was chosen by hand.
    pub pace_chosen: Option<f64>,
    /// How often one was chosen: tells which choice this is.
    pub pace_choices: u32,
    /// The residual force without units.
    pub residual: Option<f64>,
    /// Energy in J.
    pub elastic: Option<f64>,
    /// Energy in J.
    pub kinetic: Option<f64>,
    /// The frame that is looked at.
    pub frame: u64,
    /// The oldest frame recorded.
    pub first_frame: u64,
    /// The newest.
    pub last_frame: u64,
    /// How many.
    pub frames_stored: usize,
    /// What they take.
    pub bytes_stored: usize,
    /// The value of each control.
    pub loads: Vec<f64>,
    /// The springs that pull.
    pub grabs: Vec<GrabState>,
}

/// A spring that pulls.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GrabState {
    /// The caller's number.
    pub id: u32,
    /// The point of the surface.
    pub vertex: usize,
    /// The object that is held by its middle instead.
    pub object: Option<usize>,
    /// Toward where, in m.
    pub target: Vec3,
    /// In N/m.
    pub stiffness: f64,
    /// On the body, in N.
    pub force: Vec3,
    /// How far the point is from where the spring is held, in m.
    pub stretch: f64,
}

/// Rows to add to the plots.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plot {
    /// The number of the body.
    pub topology: u32,
    /// Of the columns.
    pub names: Vec<String>,
    /// Of the columns.
    pub units: Vec<String>,
    /// By time.
    pub rows: Vec<Vec<Option<f64>>>,
    /// Whether they replace all rows before.
    pub clear: bool,
}

/// All values at a point of the surface.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Picked {
    /// Which point.
    pub vertex: usize,
    /// Where it is at rest, in m.
    pub rest: Vec3,
    /// Where it is, in m.
    pub position: Vec3,
    /// One of each field.
    pub values: Vec<Value>,
}

/// The value of a field at a point.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Value {
    /// The field's number.
    pub field: u16,
    /// Its name.
    pub name: &'static str,
    /// The value.
    pub value: Option<f64>,
    /// Its unit.
    pub unit: &'static str,
}

/// What is looked at, now or recorded.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shown {
    /// The number of the frame.
    pub frame: u64,
    /// Its time in s.
    pub time: f64,
    /// The value of each control then.
    pub loads: Vec<f64>,
    /// The springs that pulled then.
    pub grabs: Vec<GrabState>,
}

/// What cannot be done, in the words of the error tree: where, what, and what to try.
#[derive(Debug, Clone, PartialEq, Serialize, thiserror::Error)]
#[error("{place}: {what}")]
pub struct Refusal {
    /// Of what.
    #[serde(rename = "where")]
    pub place: &'static str,
    /// Why.
    pub what: String,
    /// What to try; may be empty.
    pub hint: &'static str,
}

impl Refusal {
    pub(crate) fn new(place: &'static str, what: impl ToString, hint: &'static str) -> Self {
        let what = what.to_string();
        Self { place, what, hint }
    }
}

pub(crate) fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}
