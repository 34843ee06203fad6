use serde::{Deserialize, Serialize};

use crate::assembly::{Visitor, check_indices};
use crate::loads::external_force::{ExternalForce, Vertices, check_finite};
use crate::matrix::{cross_matrix, plus};
use crate::terms::{Tet, volume_hessian};
use crate::vector::{Vec3, axpy, cross, scale, sub};
use crate::{ProblemError, balance::cavity_volume};

/// A pressure on triangles whose normals point out of the solid; it follows the surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pressure {
    /// The loaded triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Tetrahedra of cut voxels with the part of each that belongs to the cavity: the pressure
    /// works on the volume that the triangles enclose plus these parts.
    pub voids: Vec<([u32; 4], f64)>,
    /// The pressure in Pa; positive pushes against the solid.
    pub pressure: f64,
    /// Set if the triangles are known to enclose a volume, if need be with planes of symmetry through the origin: a rim
    /// stays in these, so that the cone from the origin over it has no volume and pushes along their normals alone,
    /// where the rim is held. Scenes omit it; then it is found from the triangles.
    #[serde(skip)]
    pub closed: bool,
}

impl ExternalForce for Pressure {
    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        check_finite(&[self.pressure])?;
        for (corners, part) in &self.voids {
            check_finite(&[*part])?;
            check_indices("vertex of a cut voxel", corners, vertices)?;
        }
        let corners = self.triangles.as_flattened();
        check_indices("vertex of a pressure triangle", corners, vertices)
    }

    /// Each triangle contributes a third of `−p A n` to each corner (`A n` the current area vector), which on a closed
    /// surface is `p` times the gradient of the enclosed volume and sums to zero.
    fn add_forces(&self, on: Vertices<'_>, factor: f64, forces: &mut [Vec3]) {
        let pressure = factor * self.pressure;
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|v| on.positions[v as usize]);
            let force = scale(-pressure / 6.0, cross(sub(b, a), sub(c, a)));
            for &vertex in triangle {
                axpy(&mut forces[vertex as usize], 1.0, force);
            }
        }
        for &(corners, part) in &self.voids {
            let gradients = Tet::volume_of(corners).evaluate(on.positions).1;
            for (vertex, gradient) in corners.into_iter().zip(gradients) {
                axpy(&mut forces[vertex as usize], part * pressure, gradient);
            }
        }
    }

    fn work(&self, on: Vertices<'_>) -> f64 {
        self.pressure * enclosed_volume(&self.triangles, &self.voids, on.positions)
    }

    fn follows(&self) -> bool {
        true
    }

    fn is_conservative(&self) -> bool {
        self.is_closed()
    }

    fn is_pressure(&self) -> bool {
        true
    }

    /// On a closed surface the forces are `p ∂V/∂x`, and a triangle's part of `V` is `−a·(b × c)/6`; an
    /// open one loads each corner with a third of `−p A n`, whose derivative is not symmetric.
    fn visit_stiffness(&self, on: Vertices<'_>, factor: f64, visit: Visitor<'_>) {
        let positions = on.positions;
        let pressure = factor * self.pressure;
        let closed = self.is_closed();
        for triangle in &self.triangles {
            let corners = triangle.map(|v| positions[v as usize]);
            let matrix = if closed {
                closed_stiffness(pressure, corners)
            } else {
                open_stiffness(pressure, corners)
            };
            visit(triangle, matrix.as_flattened());
        }
        for (corners, part) in &self.voids {
            let mut matrix = volume_hessian(corners.map(|v| positions[v as usize]));
            for entry in matrix.as_flattened_mut() {
                *entry *= -part * pressure;
            }
            visit(corners, matrix.as_flattened());
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
            pressure: self.pressure,
            closed: self.closed,
        })
    }
}

impl Pressure {
    fn is_closed(&self) -> bool {
        self.closed || is_closed(&self.triangles)
    }
}

/// The volume in m³ enclosed by triangles whose normals point out of the solid, plus parts of tetrahedra.
pub fn enclosed_volume(
    triangles: &[[u32; 3]],
    voids: &[([u32; 4], f64)],
    positions: &[Vec3],
) -> f64 {
    let within: f64 = voids
        .iter()
        .map(|&(corners, part)| part * Tet::volume_of(corners).evaluate(positions).0)
        .sum();
    within + cavity_volume(triangles, positions)
}

/// Tests whether triangles enclose a volume: every edge is met once from each side.
fn is_closed(triangles: &[[u32; 3]]) -> bool {
    let mut edges: Vec<(u32, u32, i8)> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(from, to)| {
            if from < to {
                (from, to, 1)
            } else {
                (to, from, -1)
            }
        })
        .collect();
    edges.sort_unstable();
    edges
        .chunk_by(|x, y| (x.0, x.1) == (y.0, y.1))
        .all(|same| same.iter().map(|&(.., side)| i32::from(side)).sum::<i32>() == 0)
}

pub(super) fn closed_stiffness(pressure: f64, corners: [Vec3; 3]) -> [[f64; 9]; 9] {
    let mut matrix = [[0.0; 9]; 9];
    for (row, column, other) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        let block = cross_matrix(scale(-pressure / 6.0, corners[other]));
        for i in 0..3 {
            for j in 0..3 {
                matrix[3 * row + i][3 * column + j] = block[i][j];
                matrix[3 * column + j][3 * row + i] = block[i][j];
            }
        }
    }
    matrix
}

fn open_stiffness(pressure: f64, [a, b, c]: [Vec3; 3]) -> [[f64; 9]; 9] {
    let u = cross_matrix(scale(pressure / 6.0, sub(b, a)));
    let v = cross_matrix(scale(pressure / 6.0, sub(c, a)));
    let blocks = [plus(&v, -1.0, &u), v.map(|row| row.map(|x| -x)), u];
    let mut matrix = [[0.0; 9]; 9];
    for (row, entries) in matrix.iter_mut().enumerate() {
        for (column, entry) in entries.iter_mut().enumerate() {
            *entry = blocks[column / 3][row % 3][column % 3];
        }
    }
    matrix
}
