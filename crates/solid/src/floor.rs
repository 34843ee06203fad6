//! The rules of the floor: whom it stops, whom it carries, whom it lets go.

/// A horizontal plane without friction that no vertex may pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// Its height in m.
    pub z: f64,
}

impl Floor {
    /// Whether a vertex at this height (m) touches it or is below.
    pub fn touches(self, height: f64) -> bool {
        height <= self.z
    }

    /// Whether it carries a vertex at this height (m) that is pushed with a force (N) along z.
    pub fn carries(self, height: f64, force: f64) -> bool {
        force < 0.0 && self.touches(height)
    }

    /// Where it stops a vertex that would go to this height, in m.
    pub fn stop(self, height: f64) -> f64 {
        if height < self.z { self.z } else { height }
    }

    /// Whether a vertex is carried from now on: one that was is let go if the net force (N) pulls it up, any
    /// other is caught below the floor, by more than the `slack` (m).
    pub fn keeps(self, carried: bool, height: f64, net_force: f64, slack: f64) -> bool {
        if carried {
            net_force <= 0.0
        } else {
            height < self.z - slack
        }
    }
}
