use serde::Serialize;
use voxsoft_solid::vector::Vec3;

/// Events of a player, with the names of the page's protocol. SI units; non-finite numbers are absent.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "t", rename_all = "lowercase")]
pub enum Event {
    /// State of the simulation.
    Stat(Stat),
    /// Rows of the plots.
    Plot(Plot),
    /// All fields at a point.
    Picked(Picked),
    /// Contacts and poses of rigid objects in a frame.
    Moment(MomentOf),
}

/// Contacts and poses at an instant, for one body.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MomentOf {
    /// The number of the body.
    pub topology: u32,
    /// Contacts and poses.
    pub moment: Moment,
}

/// Contacts and poses that belong to a frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Moment {
    /// Number of the frame.
    pub frame: u64,
    /// Time in s.
    pub time: f64,
    /// Pose of each object.
    pub poses: Vec<Pose>,
    /// Contact of each pair of surfaces.
    pub contacts: Vec<SurfaceContact>,
    /// True if fields of contact are known.
    pub fields: bool,
    /// Penetration depth of surfaces in m, if it exceeds the tolerance of contact.
    pub depth: Option<f64>,
}

/// Pose of a rigid object.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Pose {
    /// Present position of the center of its first bounding box, in m.
    pub position: Vec3,
    /// Rotation from its first pose, nine numbers by rows.
    pub rotation: Vec<f64>,
}

/// Contact of two surfaces.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SurfaceContact {
    /// Names of the two surfaces.
    pub of: [String; 2],
    /// Force on the first surface, in N.
    pub force: Vec3,
    /// Sum of the magnitudes of all pressures and frictions, in N.
    pub pressed: f64,
    /// Contact area in m².
    pub area: f64,
    /// Smallest gap in m.
    pub gap: f64,
    /// Fraction of the pressure under which the surfaces slip.
    pub slipping: f64,
}

/// Mode of a player: time runs, or the reason why not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// Time stands still.
    Paused,
    /// Time runs.
    Playing,
    /// The body is at rest until something is changed.
    AtRest,
    /// The simulation diverged.
    Diverged,
    /// A recorded frame is shown.
    Past,
}

impl Mode {
    /// Name in the protocol.
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

/// Present numbers of a player.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stat {
    /// The number of the body.
    pub topology: u32,
    /// Mode of the player.
    pub state: Mode,
    /// Sentence on the mode; may be empty.
    pub sentence: String,
    /// Time of the displayed frame in s.
    pub time: f64,
    /// Clock time of a step in ms.
    pub step_ms: f64,
    /// Steps taken since the start.
    pub substeps: u64,
    /// Simulated over clock time.
    pub real_time_factor: f64,
    /// Pace in force: upper limit of the real-time factor.
    pub pace: f64,
    /// Pace chosen by the user.
    pub pace_chosen: Option<f64>,
    /// Number of choices so far, which identifies the present one.
    pub pace_choices: u32,
    /// Relative residual force, dimensionless.
    pub residual: Option<f64>,
    /// Elastic energy in J.
    pub elastic: Option<f64>,
    /// Kinetic energy in J.
    pub kinetic: Option<f64>,
    /// Number of the displayed frame.
    pub frame: u64,
    /// Number of the oldest recorded frame.
    pub first_frame: u64,
    /// Number of the newest recorded frame.
    pub last_frame: u64,
    /// Number of recorded frames.
    pub frames_stored: usize,
    /// Memory of the recorded frames in bytes.
    pub bytes_stored: usize,
    /// The value of each control.
    pub loads: Vec<f64>,
    /// Active grabs.
    pub grabs: Vec<GrabState>,
}

/// A grab: a spring that pulls a point or an object.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GrabState {
    /// Number of the grab, chosen by the caller.
    pub id: u32,
    /// Point of the surface.
    pub vertex: usize,
    /// Rigid object that is held by its center instead.
    pub object: Option<usize>,
    /// Target position in m.
    pub target: Vec3,
    /// Spring stiffness in N/m.
    pub stiffness: f64,
    /// Force on the body, in N.
    pub force: Vec3,
    /// Elongation of the spring: distance from the point to the anchor, in m.
    pub stretch: f64,
}

/// Rows to add to the plots.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plot {
    /// The number of the body.
    pub topology: u32,
    /// Names of the columns.
    pub names: Vec<String>,
    /// Units of the columns.
    pub units: Vec<String>,
    /// Rows in order of time.
    pub rows: Vec<Vec<Option<f64>>>,
    /// True if the rows replace all earlier ones.
    pub clear: bool,
}

/// All values at a point of the surface.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Picked {
    /// Point of the surface.
    pub vertex: usize,
    /// Rest position in m.
    pub rest: Vec3,
    /// Displayed position in m.
    pub position: Vec3,
    /// Value of each field.
    pub values: Vec<Value>,
}

/// The value of a field at a point.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Value {
    /// Number of the field.
    pub field: u16,
    /// Name of the field.
    pub name: &'static str,
    /// Value, if finite.
    pub value: Option<f64>,
    /// Unit of the value.
    pub unit: &'static str,
}

/// The displayed frame, present or recorded.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shown {
    /// The number of the frame.
    pub frame: u64,
    /// Time of the frame in s.
    pub time: f64,
    /// The value of each control then.
    pub loads: Vec<f64>,
    /// Grabs then.
    pub grabs: Vec<GrabState>,
}

/// Refusal of a command, with the fields of the package's errors: place, message and hint.
#[derive(Debug, Clone, PartialEq, Serialize, thiserror::Error)]
#[error("{place}: {what}")]
pub struct Refusal {
    /// Command or quantity that is refused.
    #[serde(rename = "where")]
    pub place: &'static str,
    /// Reason of the refusal.
    pub what: String,
    /// Suggestion; may be empty.
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
