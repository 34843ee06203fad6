use serde::{Deserialize, Serialize};

use super::pressure::closed_stiffness;
use crate::ProblemError;
use crate::assembly::{Visitor, check_indices};
use crate::loads::external_force::{ExternalForce, Vertices, check_finite};
use crate::terms::{Tet, volume_hessian};
use crate::vector::{Vec3, axpy, cross, dot, scale, sub};

/// The weight of a liquid in a cavity: a pressure on its walls that grows linearly with depth. With its mean over a
/// tetrahedron, and tetrahedra from the origin of that pressure over all triangles, the work of a unit of it is
///
/// ```text
/// W = ∫ γ·(x − o) dV = Σ D S,   D = −a·(b × c)/6,   S = γ·(a + b + c)/4,
/// ```
///
/// where corners count from `o`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hydrostatic {
    /// The walls, whose normals point out of the solid.
    pub triangles: Vec<[u32; 3]>,
    /// Tetrahedra of cut voxels with the part of each that belongs to the cavity.
    pub voids: Vec<([u32; 4], f64)>,
    /// `γ`, the gradient of the pressure, Pa/m: density times acceleration.
    pub slope: Vec3,
    /// `o`, a point of zero pressure, m.
    pub origin: Vec3,
}

impl Hydrostatic {
    /// Corners of an element relative to the origin, and the mean pressure over its tetrahedron (of a triangle, that
    /// with the origin).
    fn seen<const N: usize>(&self, corners: [u32; N], positions: &[Vec3]) -> ([Vec3; N], f64) {
        let from = corners.map(|v| sub(positions[v as usize], self.origin));
        let mean = from.iter().map(|x| dot(self.slope, *x)).sum::<f64>() / 4.0;
        (from, mean)
    }

    /// Completes the stiffness at a constant mean pressure, `−S ∂²D`, by the terms from the change of `S`.
    fn finished(&self, mut matrix: Vec<f64>, gradients: &[Vec3], part: f64) -> Vec<f64> {
        let size = 3 * gradients.len();
        let by_mean = |entry: usize| self.slope[entry % 3] / 4.0;
        let by_volume = |entry: usize| gradients[entry / 3][entry % 3];
        for row in 0..size {
            for column in 0..size {
                let both = by_volume(row) * by_mean(column) + by_mean(row) * by_volume(column);
                matrix[row * size + column] -= part * both;
            }
        }
        matrix
    }
}

fn volume_and_gradients([a, b, c]: [Vec3; 3]) -> (f64, [Vec3; 3]) {
    let gradients = [cross(b, c), cross(c, a), cross(a, b)].map(|g| scale(-1.0 / 6.0, g));
    (dot(a, gradients[0]), gradients)
}

impl ExternalForce for Hydrostatic {
    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        check_finite(&self.slope)?;
        check_finite(&self.origin)?;
        for (corners, part) in &self.voids {
            check_finite(&[*part])?;
            check_indices("vertex of a cut voxel", corners, vertices)?;
        }
        let corners = self.triangles.as_flattened();
        check_indices("vertex of a wall", corners, vertices)
    }

    fn add_forces(&self, on: Vertices<'_>, factor: f64, forces: &mut [Vec3]) {
        let quarter = scale(0.25, self.slope);
        for &triangle in &self.triangles {
            let (corners, mean) = self.seen(triangle, on.positions);
            let (volume, gradients) = volume_and_gradients(corners);
            for (vertex, gradient) in triangle.into_iter().zip(gradients) {
                let force = &mut forces[vertex as usize];
                axpy(force, factor * mean, gradient);
                axpy(force, factor * volume, quarter);
            }
        }
        for &(corners, part) in &self.voids {
            let (_, mean) = self.seen(corners, on.positions);
            let (volume, gradients) = Tet::volume_of(corners).evaluate(on.positions);
            for (vertex, gradient) in corners.into_iter().zip(gradients) {
                let force = &mut forces[vertex as usize];
                axpy(force, factor * part * mean, gradient);
                axpy(force, factor * part * volume, quarter);
            }
        }
    }

    fn work(&self, on: Vertices<'_>) -> f64 {
        let of_triangle = |triangle: &[u32; 3]| {
            let (corners, mean) = self.seen(*triangle, on.positions);
            volume_and_gradients(corners).0 * mean
        };
        let of_void = |(corners, part): &([u32; 4], f64)| {
            let (_, mean) = self.seen(*corners, on.positions);
            part * mean * Tet::volume_of(*corners).evaluate(on.positions).0
        };
        let within: f64 = self.triangles.iter().map(of_triangle).sum();
        within + self.voids.iter().map(of_void).sum::<f64>()
    }

    fn follows(&self) -> bool {
        true
    }

    /// The forces have a potential in any case; on an open surface they include those on the cone over its rim.
    fn is_conservative(&self) -> bool {
        true
    }

    fn visit_stiffness(&self, on: Vertices<'_>, factor: f64, visit: Visitor<'_>) {
        let positions = on.positions;
        for &triangle in &self.triangles {
            let (corners, mean) = self.seen(triangle, positions);
            let (_, gradients) = volume_and_gradients(corners);
            let matrix = closed_stiffness(factor * mean, corners);
            let matrix = matrix.as_flattened().to_vec();
            visit(&triangle, &self.finished(matrix, &gradients, factor));
        }
        for &(corners, part) in &self.voids {
            let (_, mean) = self.seen(corners, positions);
            let gradients = Tet::volume_of(corners).evaluate(positions).1;
            let matrix = volume_hessian(corners.map(|v| positions[v as usize]));
            let weight = -part * factor * mean;
            let matrix = matrix.as_flattened().iter().map(|k| weight * k).collect();
            visit(&corners, &self.finished(matrix, &gradients, part * factor));
        }
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        self.triangles.iter().for_each(|t| visit(t));
        self.voids.iter().for_each(|(t, _)| visit(t));
    }

    fn renumbered(&self, number: &dyn Fn(u32) -> u32) -> Box<dyn ExternalForce> {
        Box::new(Self {
            triangles: self.triangles.iter().map(|t| t.map(number)).collect(),
            voids: (self.voids.iter())
                .map(|(t, part)| (t.map(number), *part))
                .collect(),
            slope: self.slope,
            origin: self.origin,
        })
    }
}
