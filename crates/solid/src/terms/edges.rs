use crate::assembly::Visitor;
use crate::element::hex8::Tangent;
use crate::term::{AssumedStrain, Term};
use crate::vector::{Vec3, axpy, dot, norm, scale, sub};

/// An edge constraint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// The two vertices.
    pub vertices: [u32; 2],
    /// Rest length in m.
    pub length: f64,
    /// Stiffness in N/m: the inverse of the compliance.
    pub stiffness: f64,
}

impl Edge {
    /// `C = |x_a − x_b| − ℓ` (m) and its gradient with respect to `x_a`; the gradient with respect to `x_b` is its
    /// negative. Two coincident vertices have no direction and the gradient zero.
    #[inline(always)]
    pub fn evaluate(&self, positions: &[Vec3]) -> (f64, Vec3) {
        let [a, b] = self.vertices.map(|v| positions[v as usize]);
        let along = sub(a, b);
        let length = norm(along);
        let inverse = if length > 0.0 { 1.0 / length } else { 0.0 };
        (length - self.length, scale(inverse, along))
    }

    /// The Hessian of `k C²/2`: `k (n nᵀ + (C/L)(1 − n nᵀ))` between a vertex and itself. A given `change` replaces
    /// `C`.
    fn hessian(&self, positions: &[Vec3], change: Option<f64>) -> [[f64; 6]; 6] {
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

/// All edge constraints of a body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Edges(pub Vec<Edge>);

impl Term for Edges {
    fn name(&self) -> &'static str {
        "edges"
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        self.0.iter().for_each(|edge| visit(&edge.vertices));
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        let twice = |edge: &Edge| edge.stiffness * edge.evaluate(positions).0.powi(2);
        self.0.iter().map(twice).sum::<f64>() / 2.0
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        for edge in &self.0 {
            let (stretch, gradient) = edge.evaluate(positions);
            let tension = edge.stiffness * stretch;
            let [a, b] = edge.vertices;
            axpy(&mut forces[a as usize], -tension, gradient);
            axpy(&mut forces[b as usize], tension, gradient);
        }
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        self.visit_tangent(positions, Tangent::Exact, visit);
    }

    fn visit_tangent(&self, positions: &[Vec3], tangent: Tangent, visit: Visitor<'_>) {
        let change = (tangent == Tangent::Stressless).then_some(0.0);
        for edge in &self.0 {
            let matrix = edge.hessian(positions, change);
            visit(&edge.vertices, matrix.as_flattened());
        }
    }

    /// The geometric part is bounded by `k` across the edge, which the same row already holds along it.
    fn add_row_sums(&self, _positions: &[Vec3], sums: &mut [f64]) {
        for edge in &self.0 {
            for vertex in edge.vertices {
                sums[vertex as usize] += 2.0 * edge.stiffness;
            }
        }
    }

    fn add_product(&self, positions: &[Vec3], direction: &[Vec3], product: &mut [Vec3]) {
        for edge in &self.0 {
            let (_, gradient) = edge.evaluate(positions);
            let [a, b] = edge.vertices.map(|v| v as usize);
            let force = edge.stiffness * dot(gradient, sub(direction[a], direction[b]));
            axpy(&mut product[a], force, gradient);
            axpy(&mut product[b], -force, gradient);
        }
    }

    fn predict(&self, positions: &[Vec3], moves: &[Vec3]) -> Option<AssumedStrain> {
        let changes = self.0.iter().map(|edge| {
            let (change, gradient) = edge.evaluate(positions);
            let [a, b] = edge.vertices.map(|v| moves[v as usize]);
            change + dot(gradient, sub(a, b))
        });
        Some(AssumedStrain::Numbers(changes.collect()))
    }

    /// Forces need no prediction: a constraint is linear in its strain, so that they are those at `positions`.
    fn visit_predicted_stiffness(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        visit: Visitor<'_>,
    ) {
        for (edge, change) in self.0.iter().zip(strain.numbers()) {
            let matrix = edge.hessian(positions, Some(*change));
            visit(&edge.vertices, matrix.as_flattened());
        }
    }
}
