//! Energy, forces and stiffness of a body: constraints, hyperelastic voxels, membranes.

use crate::batches::in_order;
use crate::body::{Body, Edge, Tet};
use crate::brick::{Tangent, Within};
use crate::matrix::cross_matrix;
use crate::vector::{Vec3, axpy, cross, dot, norm, scale, sub};

/// Voxels whose forces, or stiffness matrices of 4.6 kB, are kept until they are added.
pub(crate) const FORCE_BATCH: usize = 8192;
pub(crate) const STIFFNESS_BATCH: usize = 256;

impl Edge {
    /// `C = |x_a − x_b| − ℓ` (m) and its gradient with respect to `x_a`; the gradient with respect
    /// to `x_b` is its negative. Two vertices on one spot have no direction and the gradient zero.
    #[inline(always)]
    pub fn evaluate(&self, positions: &[Vec3]) -> (f64, Vec3) {
        let [a, b] = self.vertices.map(|v| positions[v as usize]);
        let along = sub(a, b);
        let length = norm(along);
        let inverse = if length > 0.0 { 1.0 / length } else { 0.0 };
        (length - self.length, scale(inverse, along))
    }

    /// The Hessian of `k C²/2`: `k (n nᵀ + (C/L)(1 − n nᵀ))` between a vertex and itself. A `change` of
    /// the caller's takes the place of `C`.
    pub(crate) fn hessian(&self, positions: &[Vec3], change: Option<f64>) -> [[f64; 6]; 6] {
        let (stretch, n) = self.evaluate(positions);
        let length = stretch + self.length;
        let stretch = change.unwrap_or(stretch);
        let across = if length > 0.0 { stretch / length } else { 0.0 };
        let mut matrix = [[0.0; 6]; 6];
        for i in 0..3 {
            for j in 0..3 {
                let unit = if i == j { across } else { 0.0 };
                let k = self.stiffness * ((1.0 - across) * n[i] * n[j] + unit);
                for (a, b, sign) in [(0, 0, 1.0), (0, 3, -1.0), (3, 0, -1.0), (3, 3, 1.0)] {
                    matrix[a + i][b + j] = sign * k;
                }
            }
        }
        matrix
    }
}

impl Tet {
    /// `C = V − V₀` (m³) and its gradients with respect to the four vertices.
    ///
    /// The signed volume is a polynomial: a tetrahedron pressed flat or inside out is pushed back
    /// to its right orientation, no case needs a guard.
    #[inline(always)]
    pub fn evaluate(&self, positions: &[Vec3]) -> (f64, [Vec3; 4]) {
        let [a, b, c, d] = self.vertices.map(|v| positions[v as usize]);
        let (u, v, w) = (sub(b, a), sub(c, a), sub(d, a));
        let gb = scale(1.0 / 6.0, cross(v, w));
        let gc = scale(1.0 / 6.0, cross(w, u));
        let gd = scale(1.0 / 6.0, cross(u, v));
        let ga = [
            -(gb[0] + gc[0] + gd[0]),
            -(gb[1] + gc[1] + gd[1]),
            -(gb[2] + gc[2] + gd[2]),
        ];
        (dot(u, gb) - self.volume, [ga, gb, gc, gd])
    }

    /// The Hessian of `k C²/2`: `k (∇C ∇Cᵀ + C ∇²V)`. A `change` of the caller's takes the place of `C`.
    pub(crate) fn hessian(&self, positions: &[Vec3], change: Option<f64>) -> [[f64; 12]; 12] {
        let (own, gradients) = self.evaluate(positions);
        let change = change.unwrap_or(own);
        let mut matrix = volume_hessian(self.vertices.map(|v| positions[v as usize]));
        for (row, entries) in matrix.iter_mut().enumerate() {
            for (column, entry) in entries.iter_mut().enumerate() {
                let outer = gradients[row / 3][row % 3] * gradients[column / 3][column % 3];
                *entry = self.stiffness * (outer + change * *entry);
            }
        }
        matrix
    }
}

/// The Hessian of the volume of a tetrahedron.
///
/// The gradient by `b` is `(c − a) × (d − a)/6`, linear in the others: blocks are `±[difference]×/6`.
pub(crate) fn volume_hessian(corners: [Vec3; 4]) -> [[f64; 12]; 12] {
    let mut matrix = [[0.0; 12]; 12];
    // For each pair of corners the edge between the other two, turned so that the sign is right.
    for (p, q, from, to) in [
        (0, 1, 3, 2),
        (0, 2, 1, 3),
        (0, 3, 2, 1),
        (1, 2, 3, 0),
        (1, 3, 0, 2),
        (2, 3, 1, 0),
    ] {
        let block = cross_matrix(scale(1.0 / 6.0, sub(corners[to], corners[from])));
        for i in 0..3 {
            for j in 0..3 {
                matrix[3 * p + i][3 * q + j] = block[i][j];
                matrix[3 * q + j][3 * p + i] = block[i][j];
            }
        }
    }
    matrix
}

/// The elastic energy in J.
pub fn energy(body: &Body, positions: &[Vec3]) -> f64 {
    let edges: f64 = body
        .edges()
        .iter()
        .map(|edge| edge.stiffness * edge.evaluate(positions).0.powi(2))
        .sum();
    let tets: f64 = body
        .tets()
        .iter()
        .map(|tet| tet.stiffness * tet.evaluate(positions).0.powi(2))
        .sum();
    let bricks: f64 = body
        .bricks()
        .iter()
        .map(|brick| brick.energy(body.material_of(brick), positions))
        .sum();
    let membranes: f64 = body.membranes().iter().map(|m| m.energy(positions)).sum();
    (edges + tets) / 2.0 + bricks + membranes
}

/// The response to `positions` within a step: the elastic energy and the potential of the forces in J; adds the
/// forces in N and sets the `pressures` of hyperelastic voxels in Pa.
pub fn respond(
    body: &Body,
    positions: &[Vec3],
    within: &[Within],
    forces: &mut [Vec3],
    pressures: &mut [f64],
) -> (f64, f64) {
    let other = add_other_forces(body, positions, forces);
    let (mut elastic, mut potential) = (other, other);
    let bricks = body.bricks();
    in_order(
        bricks.len(),
        FORCE_BATCH,
        |i| bricks[i].respond(body.material_of(&bricks[i]), positions, &within[i]),
        |i, response| {
            elastic += response.elastic;
            potential += response.potential;
            pressures[i] = response.pressure;
            bricks[i].add_to(&response.forces, forces);
        },
    );
    (elastic, potential)
}

/// Energy and forces of everything but hyperelastic voxels.
fn add_other_forces(body: &Body, positions: &[Vec3], forces: &mut [Vec3]) -> f64 {
    add_constraint_forces(body, positions, forces);
    let edges = body.edges().iter();
    let edges = edges.map(|edge| edge.stiffness * edge.evaluate(positions).0.powi(2));
    let tets = body.tets().iter();
    let tets = tets.map(|tet| tet.stiffness * tet.evaluate(positions).0.powi(2));
    let mut energy = (edges.sum::<f64>() + tets.sum::<f64>()) / 2.0;
    for membrane in body.membranes() {
        energy += membrane.energy(positions);
        membrane.add_forces(positions, forces);
    }
    energy
}

/// Adds the elastic forces in N, minus the gradient of [`energy`].
pub fn add_forces(body: &Body, positions: &[Vec3], forces: &mut [Vec3]) {
    add_constraint_forces(body, positions, forces);
    add_element_forces(body, positions, forces);
}

/// Adds the forces of the edge and volume constraints alone.
pub fn add_constraint_forces(body: &Body, positions: &[Vec3], forces: &mut [Vec3]) {
    for edge in body.edges() {
        let (stretch, gradient) = edge.evaluate(positions);
        let tension = edge.stiffness * stretch;
        let [a, b] = edge.vertices;
        axpy(&mut forces[a as usize], -tension, gradient);
        axpy(&mut forces[b as usize], tension, gradient);
    }
    for tet in body.tets() {
        let (change, gradients) = tet.evaluate(positions);
        let pressure = tet.stiffness * change;
        for (vertex, gradient) in tet.vertices.into_iter().zip(gradients) {
            axpy(&mut forces[vertex as usize], -pressure, gradient);
        }
    }
}

/// Adds the forces of hyperelastic voxels and membranes alone, which are not constraints.
pub fn add_element_forces(body: &Body, positions: &[Vec3], forces: &mut [Vec3]) {
    let bricks = body.bricks();
    in_order(
        bricks.len(),
        FORCE_BATCH,
        |i| bricks[i].forces(body.material_of(&bricks[i]), positions),
        |i, corners| bricks[i].add_to(&corners, forces),
    );
    for membrane in body.membranes() {
        membrane.add_forces(positions, forces);
    }
}

/// Hands the stiffness matrix (N/m), the Hessian of [`energy`], to `visit` piece by piece: the
/// vertices of a piece, and its dense row-major matrix with rows and columns `3 place + axis`.
pub fn visit_stiffness(body: &Body, positions: &[Vec3], visit: &mut dyn FnMut(&[u32], &[f64])) {
    visit_constraint_stiffness(body, positions, Tangent::Exact, visit);
    visit_brick_stiffness(body, positions, visit);
    visit_membrane_stiffness(body, positions, visit);
}

/// The same within a step, with the stress that is there or without it.
pub fn visit_tangent(
    body: &Body,
    positions: &[Vec3],
    within: &[Within],
    tangent: Tangent,
    visit: &mut dyn FnMut(&[u32], &[f64]),
) {
    visit_constraint_stiffness(body, positions, tangent, visit);
    let bricks = body.bricks();
    in_order(
        bricks.len(),
        STIFFNESS_BATCH,
        |i| {
            let material = body.material_of(&bricks[i]);
            bricks[i].stiffness_within(material, positions, None, &within[i], tangent)
        },
        |i, matrix| visit(&bricks[i].vertices, matrix.as_flattened()),
    );
    visit_membrane_stiffness(body, positions, visit);
}

fn visit_constraint_stiffness(
    body: &Body,
    positions: &[Vec3],
    tangent: Tangent,
    visit: &mut dyn FnMut(&[u32], &[f64]),
) {
    let change = (tangent == Tangent::Stressless).then_some(0.0);
    for edge in body.edges() {
        let matrix = edge.hessian(positions, change);
        visit(&edge.vertices, matrix.as_flattened());
    }
    for tet in body.tets() {
        visit(&tet.vertices, tet.hessian(positions, change).as_flattened());
    }
}

fn visit_membrane_stiffness(
    body: &Body,
    positions: &[Vec3],
    visit: &mut dyn FnMut(&[u32], &[f64]),
) {
    for membrane in body.membranes() {
        let matrix = membrane.stiffness(positions, None);
        visit(&membrane.vertices(), matrix.as_flattened());
    }
}

fn visit_brick_stiffness(body: &Body, positions: &[Vec3], visit: &mut dyn FnMut(&[u32], &[f64])) {
    let bricks = body.bricks();
    in_order(
        bricks.len(),
        STIFFNESS_BATCH,
        |i| bricks[i].stiffness(body.material_of(&bricks[i]), positions, None),
        |i, matrix| visit(&bricks[i].vertices, matrix.as_flattened()),
    );
}

/// Hands the stiffness of every membrane where it is taut to `visit`, as [`visit_stiffness`] does.
fn visit_taut_stiffness(body: &Body, positions: &[Vec3], visit: &mut dyn FnMut(&[u32], &[f64])) {
    for membrane in body.membranes() {
        let matrix = membrane.taut_stiffness(positions);
        visit(&membrane.vertices(), matrix.as_flattened());
    }
}

/// For every vertex, a bound in N/m on the row sum of the stiffness matrix at `positions`, membranes taut.
///
/// A constraint adds `k ∇_iC ∇_jCᵀ`, bounded by `k |∇_iC| |∇_jC|`; the geometric part of an edge is
/// bounded by `k` across it, which the same row already holds along it.
pub fn row_sums(body: &Body, positions: &[Vec3], sums: &mut [f64]) {
    sums.fill(0.0);
    for edge in body.edges() {
        for vertex in edge.vertices {
            sums[vertex as usize] += 2.0 * edge.stiffness;
        }
    }
    for tet in body.tets() {
        let lengths = tet.evaluate(positions).1.map(norm);
        let total: f64 = lengths.iter().sum();
        for (vertex, length) in tet.vertices.into_iter().zip(lengths) {
            sums[vertex as usize] += tet.stiffness * length * total;
        }
    }
    let mut add = |vertices: &[u32], matrix: &[f64]| {
        let size = 3 * vertices.len();
        for (place, vertex) in vertices.iter().enumerate() {
            let rows = matrix[3 * place * size..].chunks(size).take(3);
            let largest = rows
                .map(|row| row.iter().map(|k| k.abs()).sum())
                .fold(0.0, f64::max);
            sums[*vertex as usize] += largest;
        }
    };
    visit_brick_stiffness(body, positions, &mut add);
    visit_taut_stiffness(body, positions, &mut add);
}

/// Adds the product of the material part of the stiffness matrix at `positions` with `direction`. Membranes have
/// theirs, [`add_taut_product`].
pub fn add_stiffness_product(
    body: &Body,
    positions: &[Vec3],
    direction: &[Vec3],
    product: &mut [Vec3],
) {
    for edge in body.edges() {
        let (_, gradient) = edge.evaluate(positions);
        let [a, b] = edge.vertices.map(|v| v as usize);
        let force = edge.stiffness * dot(gradient, sub(direction[a], direction[b]));
        axpy(&mut product[a], force, gradient);
        axpy(&mut product[b], -force, gradient);
    }
    for tet in body.tets() {
        let (_, gradients) = tet.evaluate(positions);
        let vertices = tet.vertices.map(|v| v as usize);
        let change: f64 = (0..4)
            .map(|i| dot(gradients[i], direction[vertices[i]]))
            .sum();
        for i in 0..4 {
            axpy(
                &mut product[vertices[i]],
                tet.stiffness * change,
                gradients[i],
            );
        }
    }
    visit_brick_stiffness(body, positions, &mut |vertices, matrix| {
        add_product(vertices, matrix, direction, product);
    });
}

/// Adds the product of the stiffness of all membranes, were they taut at `positions`, with `direction`.
pub fn add_taut_product(body: &Body, positions: &[Vec3], direction: &[Vec3], product: &mut [Vec3]) {
    visit_taut_stiffness(body, positions, &mut |vertices, matrix| {
        add_product(vertices, matrix, direction, product);
    });
}

fn add_product(vertices: &[u32], matrix: &[f64], direction: &[Vec3], product: &mut [Vec3]) {
    for (row, entries) in matrix.chunks(3 * vertices.len()).enumerate() {
        let mut sum = 0.0;
        for (column, k) in entries.iter().enumerate() {
            sum += k * direction[vertices[column / 3] as usize][column % 3];
        }
        product[vertices[row / 3] as usize][row % 3] += sum;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constraint_stiffness_is_the_derivative_of_the_forces() {
        let positions = vec![
            [0.1, 0.0, 0.2],
            [1.2, 0.1, 0.0],
            [0.0, 0.8, 0.1],
            [0.2, 0.1, 1.1],
        ];
        let edge = Edge {
            vertices: [0, 2],
            length: 1.3,
            stiffness: 2.0,
        };
        let tet = Tet {
            vertices: [0, 1, 2, 3],
            volume: 0.1,
            stiffness: 3.0,
        };
        let step = 1e-6;
        for column in 0..12 {
            let moved = |t: f64| {
                let mut moved = positions.clone();
                moved[column / 3][column % 3] += t;
                moved
            };
            let tet_force = |t: f64, row: usize| {
                let (change, gradients) = tet.evaluate(&moved(t));
                tet.stiffness * change * gradients[row / 3][row % 3]
            };
            let edge_force = |t: f64, axis: usize| {
                let (change, gradient) = edge.evaluate(&moved(t));
                edge.stiffness * change * gradient[axis]
            };
            for row in 0..12 {
                let slope = (tet_force(step, row) - tet_force(-step, row)) / (2.0 * step);
                assert!((slope - tet.hessian(&positions, None)[row][column]).abs() < 1e-8);
            }
            let place = [0, 6]
                .iter()
                .position(|&first| (first..first + 3).contains(&column));
            let Some(place) = place else { continue };
            for axis in 0..3 {
                let slope = (edge_force(step, axis) - edge_force(-step, axis)) / (2.0 * step);
                let got = edge.hessian(&positions, None)[axis][3 * place + column % 3];
                assert!((slope - got).abs() < 1e-8);
            }
        }
    }
}
