use serde::{Deserialize, Serialize};

use crate::Body;
use crate::vector::Vec3;

/// Positions and velocities of the vertices.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Positions in m.
    pub positions: Vec<Vec3>,
    /// Velocities in m/s.
    pub velocities: Vec<Vec3>,
    /// Time in s.
    pub time: f64,
}

impl State {
    /// The body at rest at time zero.
    pub fn at_rest(body: &Body) -> Self {
        Self {
            positions: body.rest().to_vec(),
            velocities: vec![[0.0; 3]; body.rest().len()],
            time: 0.0,
        }
    }

    /// The kinetic energy in J for the given masses (kg).
    pub fn kinetic_energy(&self, masses: &[f64]) -> f64 {
        let twice: f64 = self
            .velocities
            .iter()
            .zip(masses)
            .map(|(v, m)| m * crate::vector::dot(*v, *v))
            .sum();
        twice / 2.0
    }
}
