use serde::{Deserialize, Serialize};

use crate::assembly::{Visitor, add_product, add_row_sums};
use crate::element::membrane::Membrane;
use crate::term::{AssumedStrain, Term};
use crate::vector::Vec3;

/// All membranes of a body.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Membranes(pub Vec<Membrane>);

impl Membranes {
    /// Sets the stiffness of the material around each vertex, in N/m.
    pub(crate) fn set_behind(&mut self, behind: &[f64]) {
        for membrane in &mut self.0 {
            let around = membrane.vertices().map(|v| behind[v as usize]);
            membrane.set_behind(around.into_iter().fold(f64::INFINITY, f64::min));
        }
    }

    /// Visits the stiffness of every membrane, taut and hardly strained.
    fn visit_taut_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        for membrane in &self.0 {
            let matrix = membrane.taut_stiffness(positions);
            visit(&membrane.vertices(), matrix.as_flattened());
        }
    }
}

impl Term for Membranes {
    fn name(&self) -> &'static str {
        "membranes"
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        self.0.iter().for_each(|m| visit(&m.vertices()));
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        self.0.iter().map(|m| m.energy(positions)).sum()
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        for membrane in &self.0 {
            membrane.add_forces(positions, forces);
        }
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        for membrane in &self.0 {
            let matrix = membrane.stiffness(positions, None);
            visit(&membrane.vertices(), matrix.as_flattened());
        }
    }

    /// A membrane may be wrinkled now and taut a step later, so the bound is for taut ones.
    fn add_row_sums(&self, positions: &[Vec3], sums: &mut [f64]) {
        self.visit_taut_stiffness(positions, &mut |vertices, matrix| {
            add_row_sums(vertices, matrix, sums);
        });
    }

    /// Adds the product with the stiffness of taut membranes.
    fn add_product(&self, positions: &[Vec3], direction: &[Vec3], product: &mut [Vec3]) {
        self.visit_taut_stiffness(positions, &mut |vertices, matrix| {
            add_product(vertices, matrix, direction, product);
        });
    }

    fn predict(&self, positions: &[Vec3], moves: &[Vec3]) -> Option<AssumedStrain> {
        let strain = |membrane: &Membrane| membrane.predict_strain(positions, moves);
        Some(AssumedStrain::Planes(self.0.iter().map(strain).collect()))
    }

    fn add_predicted_forces(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        forces: &mut [Vec3],
    ) {
        for (membrane, strain) in self.0.iter().zip(strain.planes()) {
            membrane.add_predicted_forces(*strain, positions, forces);
        }
    }

    fn visit_predicted_stiffness(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        visit: Visitor<'_>,
    ) {
        for (membrane, strain) in self.0.iter().zip(strain.planes()) {
            let matrix = membrane.stiffness(positions, Some(*strain));
            visit(&membrane.vertices(), matrix.as_flattened());
        }
    }
}
