use serde::{Deserialize, Serialize};

use crate::ProblemError;
use crate::loads::external_force::{ExternalForce, Vertices, check_finite};
use crate::vector::{Vec3, axpy, dot, sub};

/// An acceleration of all mass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Gravity {
    /// The acceleration in m/s².
    pub acceleration: Vec3,
}

impl ExternalForce for Gravity {
    fn check(&self, _vertices: usize) -> Result<(), ProblemError> {
        check_finite(&self.acceleration)
    }

    fn add_forces(&self, on: Vertices<'_>, factor: f64, forces: &mut [Vec3]) {
        for (force, mass) in forces.iter_mut().zip(on.masses) {
            axpy(force, factor * mass, self.acceleration);
        }
    }

    fn work(&self, on: Vertices<'_>) -> f64 {
        let moved = on.positions.iter().zip(on.rest).map(|(x, r)| sub(*x, *r));
        moved
            .zip(on.masses)
            .map(|(moved, mass)| mass * dot(self.acceleration, moved))
            .sum()
    }

    fn is_weight(&self) -> bool {
        true
    }

    fn renumbered(&self, _number: &dyn Fn(u32) -> u32) -> Box<dyn ExternalForce> {
        Box::new(*self)
    }
}
