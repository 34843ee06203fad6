use crate::assembly::Visitor;
use crate::element::hex8::Tangent;
use crate::matrix::cross_matrix;
use crate::term::{AssumedStrain, Term};
use crate::vector::{Vec3, axpy, cross, dot, norm, scale, sub};

/// A volume constraint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tet {
    /// The four vertices.
    pub vertices: [u32; 4],
    /// Rest volume in m³.
    pub volume: f64,
    /// Stiffness in Pa/m³ on `V − V₀`: the inverse of the compliance.
    pub stiffness: f64,
}

impl Tet {
    /// A tetrahedron used for its volume alone.
    pub(crate) fn volume_of(vertices: [u32; 4]) -> Self {
        Self {
            vertices,
            volume: 0.0,
            stiffness: 0.0,
        }
    }

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

    /// The Hessian of `k C²/2`: `k (∇C ∇Cᵀ + C ∇²V)`. A given `change` replaces `C`.
    fn hessian(&self, positions: &[Vec3], change: Option<f64>) -> [[f64; 12]; 12] {
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
    // For each pair of corners the edge between the other two, directed so that the sign is right.
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

/// All volume constraints of a body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tets(pub Vec<Tet>);

impl Term for Tets {
    fn name(&self) -> &'static str {
        "tetrahedra"
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        self.0.iter().for_each(|tet| visit(&tet.vertices));
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        let twice = |tet: &Tet| tet.stiffness * tet.evaluate(positions).0.powi(2);
        self.0.iter().map(twice).sum::<f64>() / 2.0
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        for tet in &self.0 {
            let (change, gradients) = tet.evaluate(positions);
            let pressure = tet.stiffness * change;
            for (vertex, gradient) in tet.vertices.into_iter().zip(gradients) {
                axpy(&mut forces[vertex as usize], -pressure, gradient);
            }
        }
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        self.visit_tangent(positions, Tangent::Exact, visit);
    }

    fn visit_tangent(&self, positions: &[Vec3], tangent: Tangent, visit: Visitor<'_>) {
        let change = (tangent == Tangent::Stressless).then_some(0.0);
        for tet in &self.0 {
            let matrix = tet.hessian(positions, change);
            visit(&tet.vertices, matrix.as_flattened());
        }
    }

    /// A constraint adds `k ∇_iC ∇_jCᵀ`, bounded by `k |∇_iC| |∇_jC|`.
    fn add_row_sums(&self, positions: &[Vec3], sums: &mut [f64]) {
        for tet in &self.0 {
            let lengths = tet.evaluate(positions).1.map(norm);
            let total: f64 = lengths.iter().sum();
            for (vertex, length) in tet.vertices.into_iter().zip(lengths) {
                sums[vertex as usize] += tet.stiffness * length * total;
            }
        }
    }

    fn add_product(&self, positions: &[Vec3], direction: &[Vec3], product: &mut [Vec3]) {
        for tet in &self.0 {
            let (_, gradients) = tet.evaluate(positions);
            let vertices = tet.vertices.map(|v| v as usize);
            let change: f64 = (0..4)
                .map(|i| dot(gradients[i], direction[vertices[i]]))
                .sum();
            for (vertex, gradient) in vertices.into_iter().zip(gradients) {
                axpy(&mut product[vertex], tet.stiffness * change, gradient);
            }
        }
    }

    fn predict(&self, positions: &[Vec3], moves: &[Vec3]) -> Option<AssumedStrain> {
        let changes = self.0.iter().map(|tet| {
            let (change, gradients) = tet.evaluate(positions);
            let along = tet.vertices.into_iter().zip(gradients);
            change + along.map(|(v, g)| dot(g, moves[v as usize])).sum::<f64>()
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
        for (tet, change) in self.0.iter().zip(strain.numbers()) {
            let matrix = tet.hessian(positions, Some(*change));
            visit(&tet.vertices, matrix.as_flattened());
        }
    }
}
