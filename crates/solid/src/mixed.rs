//! Strains that Newton's method carries along by itself.
//!
//! A long Newton step of a slender body turns its elements far, which the linear step mistakes for
//! stretch. The stress at the end of the step is then spurious, its geometric stiffness ruins the
//! next tangent, and dozens of iterations go into undoing it. Treating the strain `ê` as an unknown of
//! its own (as mixed elements do) avoids this: stress and moduli are those of `ê`, which the *linear*
//! step predicts, `ê = e(x) + B δ`, and which is moderate. Newton's method on both unknowns is
//!
//! `(Bᵀ C B + G(σ)) δ = f − Bᵀ (σ + C (e(x) − ê))`, `σ = Φ'(ê)`, `C = Φ''(ê)`.
//!
//! The equilibrium is the same; the way there is several times shorter (Magisano, Leonetti and Garcea
//! 2017, doi 10.1016/j.cma.2016.09.044).

use crate::batches::in_order;
use crate::brick::BrickStrain;
use crate::elastic::{FORCE_BATCH, STIFFNESS_BATCH};
use crate::membrane::Plane;
use crate::vector::{Vec3, dot, sub};
use crate::{Body, elastic};

/// The strain of every piece of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Strains {
    edges: Vec<f64>,
    tets: Vec<f64>,
    bricks: Vec<BrickStrain>,
    membranes: Vec<Plane>,
}

impl Strains {
    /// The strains that a step `moves` from `positions` leads to, to first order.
    pub fn predict(body: &Body, positions: &[Vec3], moves: &[Vec3]) -> Self {
        let edges = body.edges().iter().map(|edge| {
            let (change, gradient) = edge.evaluate(positions);
            let [a, b] = edge.vertices.map(|v| moves[v as usize]);
            change + dot(gradient, sub(a, b))
        });
        let tets = body.tets().iter().map(|tet| {
            let (change, gradients) = tet.evaluate(positions);
            let along = tet.vertices.into_iter().zip(gradients);
            change + along.map(|(v, g)| dot(g, moves[v as usize])).sum::<f64>()
        });
        let bricks = body
            .bricks()
            .iter()
            .map(|brick| brick.predict_strain(positions, moves));
        let membranes = body
            .membranes()
            .iter()
            .map(|membrane| membrane.predict_strain(positions, moves));
        Self {
            edges: edges.collect(),
            tets: tets.collect(),
            bricks: bricks.collect(),
            membranes: membranes.collect(),
        }
    }

    /// Adds the forces at `positions` of the stress that these strains predict, in N. Constraints are
    /// linear in their strains, so theirs are the true ones.
    pub fn add_forces(&self, body: &Body, positions: &[Vec3], forces: &mut [Vec3]) {
        elastic::add_constraint_forces(body, positions, forces);
        let bricks = body.bricks();
        in_order(
            bricks.len(),
            FORCE_BATCH,
            |i| {
                let material = body.material_of(&bricks[i]);
                bricks[i].predicted_forces(material, &self.bricks[i], positions)
            },
            |i, corners| bricks[i].add_to(&corners, forces),
        );
        for (membrane, strain) in body.membranes().iter().zip(&self.membranes) {
            membrane.add_predicted_forces(*strain, positions, forces);
        }
    }

    /// The tangent at `positions` with the stress of these strains, piece by piece as in
    /// [`crate::elastic::visit_stiffness`].
    pub fn visit_stiffness(
        &self,
        body: &Body,
        positions: &[Vec3],
        visit: &mut dyn FnMut(&[u32], &[f64]),
    ) {
        for (edge, change) in body.edges().iter().zip(&self.edges) {
            let matrix = edge.hessian(positions, Some(*change));
            visit(&edge.vertices, matrix.as_flattened());
        }
        for (tet, change) in body.tets().iter().zip(&self.tets) {
            let matrix = tet.hessian(positions, Some(*change));
            visit(&tet.vertices, matrix.as_flattened());
        }
        let bricks = body.bricks();
        in_order(
            bricks.len(),
            STIFFNESS_BATCH,
            |i| {
                let material = body.material_of(&bricks[i]);
                bricks[i].stiffness(material, positions, Some(&self.bricks[i]))
            },
            |i, matrix| visit(&bricks[i].vertices, matrix.as_flattened()),
        );
        for (membrane, strain) in body.membranes().iter().zip(&self.membranes) {
            let matrix = membrane.stiffness(positions, Some(*strain));
            visit(&membrane.vertices(), matrix.as_flattened());
        }
    }
}
