use serde::{Deserialize, Serialize};

use crate::ProblemError;
use crate::assembly::check_indices;
use crate::loads::external_force::{ExternalForce, Vertices, check_finite};
use crate::vector::{Vec3, axpy, dot, sub};

/// Forces on vertices, fixed in direction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointForces {
    /// The loaded vertices.
    pub vertices: Vec<u32>,
    /// The force on each in N.
    pub forces: Vec<Vec3>,
}

impl ExternalForce for PointForces {
    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        check_finite(self.forces.as_flattened())?;
        if self.vertices.len() != self.forces.len() {
            return Err(ProblemError::Length {
                what: "forces on vertices",
                got: self.forces.len(),
                expected: self.vertices.len(),
            });
        }
        check_indices("vertex of a force", &self.vertices, vertices)
    }

    fn add_forces(&self, _on: Vertices<'_>, factor: f64, forces: &mut [Vec3]) {
        for (&vertex, value) in self.vertices.iter().zip(&self.forces) {
            axpy(&mut forces[vertex as usize], factor, *value);
        }
    }

    fn work(&self, on: Vertices<'_>) -> f64 {
        let moved = |vertex: usize| sub(on.positions[vertex], on.rest[vertex]);
        self.vertices
            .iter()
            .zip(&self.forces)
            .map(|(&vertex, force)| dot(*force, moved(vertex as usize)))
            .sum()
    }

    fn renumbered(&self, number: &dyn Fn(u32) -> u32) -> Box<dyn ExternalForce> {
        Box::new(Self {
            vertices: self.vertices.iter().map(|&v| number(v)).collect(),
            forces: self.forces.clone(),
        })
    }
}
