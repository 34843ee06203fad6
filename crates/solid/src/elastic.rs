//! Energy and forces of the constraints.

use crate::body::{Body, Edge, Tet};
use crate::vector::{Vec3, axpy, cross, dot, norm, scale, sub};

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
    (edges + tets) / 2.0
}

/// Adds the elastic forces in N, minus the gradient of [`energy`].
pub fn add_forces(body: &Body, positions: &[Vec3], forces: &mut [Vec3]) {
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

/// For every vertex, a bound in N/m on the row sum of the stiffness matrix at `positions`.
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
}

/// Adds the product of the material part of the stiffness matrix at `positions` with `direction`.
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
}
