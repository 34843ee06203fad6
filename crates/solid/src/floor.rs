//! The floor as a unilateral constraint: vertices that it stops, carries and releases.

/// A horizontal plane without friction that no vertex may pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// Its height in m.
    pub z: f64,
}

impl Floor {
    /// Tests whether a vertex at this height (m) touches the floor or is below.
    pub fn touches(self, height: f64) -> bool {
        height <= self.z
    }

    /// Tests whether the floor carries a vertex at this height (m) on which a force (N) acts along z.
    pub fn carries(self, height: f64, force: f64) -> bool {
        force < 0.0 && self.touches(height)
    }

    /// Clips the height (m) of a vertex to that of the floor.
    pub fn stop(self, height: f64) -> f64 {
        if height < self.z { self.z } else { height }
    }

    /// Updates the active set: tests whether a vertex is carried from now on. A carried one is released if the net
    /// force (N) pulls it up, any other is caught below the floor, by more than the `slack` (m).
    pub fn keeps(self, carried: bool, height: f64, net_force: f64, slack: f64) -> bool {
        if carried {
            net_force <= 0.0
        } else {
            height < self.z - slack
        }
    }
}
