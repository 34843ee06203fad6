//! What changes along a path whose loads are given.

use crate::point::Point;
use crate::settings::Control;

/// What grows, or goes on, from the start of a path to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Along {
    /// All loads and motions, to those at an instant.
    All {
        /// In s; without end for those after all histories.
        time: f64,
    },
    /// All but pressures, which volume control goes on with.
    Dead,
    /// The time of all histories.
    Time { from: f64, to: f64 },
}

impl Along {
    /// What a control changes by itself; volume and arc length look for the load.
    pub fn of(control: Control) -> Self {
        match control {
            Control::Time {
                from: Some(from),
                to,
                ..
            } => Self::Time { from, to },
            Control::Time { from: None, to, .. } => Self::All { time: to },
            Control::Load | Control::ArcLength { .. } | Control::Volume { .. } => Self::All {
                time: f64::INFINITY,
            },
        }
    }

    /// The point at a part of the way.
    pub fn at(self, part: f64) -> Point {
        match self {
            Self::All { time } => Point {
                time,
                ..Point::all(part)
            },
            Self::Dead => Point::of(part, 0.0),
            Self::Time { from, to } => Point::at(from + part * (to - from)),
        }
    }

    /// Whether its points have a factor on all loads, so that it may have a limit to look for.
    pub fn has_factor(self) -> bool {
        matches!(self, Self::All { time } if time.is_infinite())
    }
}
