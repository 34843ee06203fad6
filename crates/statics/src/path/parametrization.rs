//! Parametrization of a path with prescribed loads.

use crate::path::load_parameter::LoadParameter;
use crate::path::settings::Control;

/// Quantity that grows from the start of a path to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Parametrization {
    /// All loads and motions, up to those at an instant.
    All {
        /// Instant in s; infinite for the values after all histories.
        time: f64,
    },
    /// All loads and motions at once, up to those at an instant in s, where a creep begins.
    Sudden { time: f64 },
    /// All loads except pressures, which volume control adds afterward.
    Dead,
    /// The time of all histories.
    Time { from: f64, to: f64 },
}

impl Parametrization {
    /// Path of a control; volume control and arc length solve for the load.
    pub fn of(control: Control) -> Self {
        match control {
            Control::Time {
                from: Some(from),
                to,
                ..
            } => Self::Time { from, to },
            Control::Time { from: None, to, .. } => Self::All { time: to },
            Control::Creep {
                from: Some(from),
                to,
                ..
            } => Self::Time { from, to },
            Control::Creep { from: None, .. } => Self::Sudden { time: 0.0 },
            Control::Load | Control::ArcLength { .. } | Control::Volume { .. } => Self::All {
                time: f64::INFINITY,
            },
        }
    }

    /// Point at a fraction of the path.
    pub fn at(self, part: f64) -> LoadParameter {
        match self {
            Self::All { time } | Self::Sudden { time } => LoadParameter {
                time,
                ..LoadParameter::all(part)
            },
            Self::Dead => LoadParameter::of(part, 0.0),
            Self::Time { from, to } => LoadParameter::at(from + part * (to - from)),
        }
    }

    /// Tests whether its points share a factor on all loads, so that a limit of the load can be searched.
    pub fn has_factor(self) -> bool {
        match self {
            Self::All { time } => time.is_infinite(),
            Self::Sudden { .. } => true,
            Self::Dead | Self::Time { .. } => false,
        }
    }
}
