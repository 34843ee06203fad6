use serde::Deserialize;
use voxsoft_solid::vector::Vec3;

/// Stiffness of a hand's spring unless another is asked for, in N/m.
pub const STIFFNESS: f64 = 50.0;

/// What can be asked of a player, under the names that the page's protocol has. SI units.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "t", rename_all = "lowercase")]
pub enum Command {
    /// Let time run.
    Play,
    /// Stop time.
    Pause,
    /// Take so many frames and stop.
    Step {
        /// One or more.
        #[serde(default = "one")]
        n: u32,
    },
    /// Go back to the unloaded shape at time zero, with the loads of the design and no hands.
    Reset,
    /// Let time run so many times as fast as the clock.
    Pace {
        /// Above 0, up to 1; `None` leaves it to the motion.
        #[serde(default)]
        factor: Option<f64>,
    },
    /// Change a control at once: one of value and factor.
    Load {
        /// Which control.
        index: usize,
        /// Its value.
        #[serde(default)]
        value: Option<f64>,
        /// Its value over that of the design.
        #[serde(default)]
        factor: Option<f64>,
    },
    /// Pull a point of the surface toward a target by a spring; the same id moves the target.
    Grab {
        /// The caller's number.
        id: u32,
        /// Which point of the surface; of no meaning for an object.
        vertex: usize,
        /// Which object is held by its middle instead, as its pose was when it was taken.
        #[serde(default)]
        object: Option<usize>,
        /// Toward where, in m.
        target: Vec3,
        /// In N/m.
        #[serde(default = "stiffness")]
        stiffness: f64,
    },
    /// Take a spring away.
    Release {
        /// The caller's number.
        id: u32,
    },
    /// Look at a recorded frame, by its number or by its time in s; time stops.
    Seek {
        /// The number; the nearest that is still there is taken.
        #[serde(default)]
        frame: u64,
        /// The time, which goes before the number.
        #[serde(default)]
        time: Option<f64>,
    },
    /// Look at the present again.
    Live,
    /// Tell all fields at a point of the surface.
    Pick {
        /// Which.
        vertex: usize,
    },
    /// Plot how far a point of the surface moves from now on.
    Probe {
        /// Which.
        vertex: usize,
    },
}

fn one() -> u32 {
    1
}

fn stiffness() -> f64 {
    STIFFNESS
}
