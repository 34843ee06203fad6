use serde::Deserialize;
use voxsoft_solid::vector::Vec3;

/// Default stiffness of the spring of a grab, in N/m.
pub const STIFFNESS: f64 = 50.0;

/// Commands of a player, with the names of the page's protocol. SI units.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "t", rename_all = "lowercase")]
pub enum Command {
    /// Let time run.
    Play,
    /// Stop time.
    Pause,
    /// Take `n` frames and stop.
    Step {
        /// Number of frames, one or more.
        #[serde(default = "one")]
        n: u32,
    },
    /// Go back to the unloaded shape at time zero, with the loads of the design and no grabs.
    Reset,
    /// Set the pace: simulated seconds for each second of the clock.
    Pace {
        /// Above 0, up to 1; `None` chooses it from the duration of the motion.
        #[serde(default)]
        factor: Option<f64>,
    },
    /// Change a control at once; needs exactly one of value and factor.
    Load {
        /// Index of the control.
        index: usize,
        /// New value in SI units.
        #[serde(default)]
        value: Option<f64>,
        /// New value over that of the design.
        #[serde(default)]
        factor: Option<f64>,
    },
    /// Grab a point of the surface and pull it toward a target by a spring; the same id moves the target.
    Grab {
        /// Number of the grab, chosen by the caller.
        id: u32,
        /// Point of the surface; ignored for an object.
        vertex: usize,
        /// Rigid object to hold by its center instead, in the orientation that it had when grabbed.
        #[serde(default)]
        object: Option<usize>,
        /// Target position in m.
        target: Vec3,
        /// Spring stiffness in N/m.
        #[serde(default = "stiffness")]
        stiffness: f64,
    },
    /// Release a grab.
    Release {
        /// Number of the grab, chosen by the caller.
        id: u32,
    },
    /// Show a recorded frame, by its number or by its time in s; time stops.
    Seek {
        /// Number of the frame; takes the nearest that is still recorded.
        #[serde(default)]
        frame: u64,
        /// Time of the frame in s, which takes precedence over the number.
        #[serde(default)]
        time: Option<f64>,
    },
    /// Show the present again.
    Live,
    /// Report all fields at a point of the surface.
    Pick {
        /// Point of the surface.
        vertex: usize,
    },
    /// Plot the displacement of a point of the surface from now on.
    Probe {
        /// Point of the surface.
        vertex: usize,
    },
}

fn one() -> u32 {
    1
}

fn stiffness() -> f64 {
    STIFFNESS
}
