//! Matrix-free product with the stiffness of a lattice.

use voxsoft_solid::element::hex8::Tangent;
use voxsoft_solid::lattice::strips::{Columns, Strips};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Problem, Term};

use super::operator::LinearOperator;

/// Material part of the stiffness of a lattice at some positions, multiplied constraint by constraint: without the
/// geometric part, so that it is the whole tangent where nothing is stressed. Its rows are the vertices.
pub struct LatticeProduct<'a> {
    held: &'a [[bool; 3]],
    strips: Strips,
    positions: Columns,
    diagonal: Vec<Vec3>,
}

impl<'a> LatticeProduct<'a> {
    /// Product at `positions` in m; `None` for a body that has other terms than the edges and volumes of equal voxels.
    pub fn of(problem: &'a Problem, positions: &[Vec3]) -> Option<Self> {
        let (body, held) = (problem.body(), problem.held());
        let strips = Strips::of(body)?;
        let mut columns = Columns::zeros(strips.slots());
        strips.load(positions, &mut columns);
        let mut diagonal = vec![[0.0; 3]; positions.len()];
        let mut add = |vertices: &[u32], matrix: &[f64]| {
            let width = 3 * vertices.len();
            for (place, &vertex) in vertices.iter().enumerate() {
                for axis in 0..3 {
                    if !held[vertex as usize][axis] {
                        diagonal[vertex as usize][axis] += matrix[(3 * place + axis) * (width + 1)];
                    }
                }
            }
        };
        for term in body.terms() {
            Term::visit_tangent(term, positions, Tangent::Stressless, &mut add);
        }
        Some(Self {
            held,
            strips,
            positions: columns,
            diagonal,
        })
    }

    /// Sets held coordinates to zero.
    fn hold(&self, vectors: &mut [Vec3]) {
        for (vector, held) in vectors.iter_mut().zip(self.held) {
            for axis in 0..3 {
                if held[axis] {
                    vector[axis] = 0.0;
                }
            }
        }
    }
}

impl LinearOperator for LatticeProduct<'_> {
    fn name(&self) -> &'static str {
        "the product of a lattice"
    }

    fn rows(&self) -> usize {
        self.held.len()
    }

    fn apply(&self, x: &[Vec3], y: &mut [Vec3]) {
        y.copy_from_slice(x);
        self.hold(y);
        let mut from = Columns::zeros(self.strips.slots());
        let mut to = Columns::zeros(self.strips.slots());
        self.strips.load(y, &mut from);
        self.strips
            .add_stiffness_product(&self.positions, &from, &mut to);
        self.strips.store(&to, y);
        self.hold(y);
    }

    fn diagonal(&self) -> Vec<Vec3> {
        self.diagonal.clone()
    }
}
