use serde::{Deserialize, Serialize};

use crate::vector::{Vec3, axpy};

/// A point of a surface: the weighted mean of vertices of the problem.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Carried {
    /// Vertices that carry the point, each once.
    pub vertices: Vec<u32>,
    /// Weights of the vertices; they sum to 1.
    pub weights: Vec<f64>,
}

impl Carried {
    /// Point at a vertex of the problem itself.
    pub fn vertex(vertex: u32) -> Self {
        Self {
            vertices: vec![vertex],
            weights: vec![1.0],
        }
    }

    /// Position of the point.
    pub fn at(&self, positions: &[Vec3]) -> Vec3 {
        let mut point = [0.0; 3];
        for (vertex, weight) in self.vertices.iter().zip(&self.weights) {
            axpy(&mut point, *weight, positions[*vertex as usize]);
        }
        point
    }

    /// Distributes a force on the point to the vertices that carry it.
    pub fn add_force(&self, factor: f64, force: Vec3, forces: &mut [Vec3]) {
        for (vertex, weight) in self.vertices.iter().zip(&self.weights) {
            axpy(&mut forces[*vertex as usize], factor * weight, force);
        }
    }
}
