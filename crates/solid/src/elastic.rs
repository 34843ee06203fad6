//! Energy, forces and stiffness of a body: the sums over its terms.

use crate::assembly::{ElementsVisitor, Visitor};
use crate::body::Body;
use crate::element::hex8::{Tangent, Within};
use crate::term::Term;
use crate::vector::Vec3;

/// The elastic energy in J.
pub fn energy(body: &Body, positions: &[Vec3]) -> f64 {
    body.terms().map(|term| term.energy(positions)).sum()
}

/// The elastic energy in J without the viscous potential of a time step.
pub fn stored_energy(body: &Body, positions: &[Vec3]) -> f64 {
    if body.hex8_term().is_elastic() {
        return energy(body, positions);
    }
    let others = body.terms_but_hex8s();
    let others: f64 = others.map(|term| term.energy(positions)).sum();
    body.hex8_term().elastic_energy(positions) + others
}

/// Adds the elastic forces in N, minus the gradient of [`stored_energy`]: without viscous stress.
pub fn add_stored_forces(body: &Body, positions: &[Vec3], forces: &mut [Vec3]) {
    body.terms_but_hex8s()
        .for_each(|term| term.add_forces(positions, forces));
    body.hex8_term().add_elastic_forces(positions, forces);
}

/// Adds the elastic forces in N, minus the gradient of [`energy`].
pub fn add_forces(body: &Body, positions: &[Vec3], forces: &mut [Vec3]) {
    body.terms()
        .for_each(|term| term.add_forces(positions, forces));
}

/// The response to `positions` within a time step: the elastic energy and the potential of the forces in J; adds the
/// forces in N and sets the `pressures` of hyperelastic voxels in Pa.
pub fn respond(
    body: &Body,
    positions: &[Vec3],
    within: &[Within],
    forces: &mut [Vec3],
    pressures: &mut [f64],
) -> (f64, f64) {
    let mut other = 0.0;
    for term in body.terms_but_hex8s() {
        other += term.energy(positions);
        term.add_forces(positions, forces);
    }
    let hex8s = body.hex8_term();
    let (elastic, potential) = hex8s.respond(positions, within, forces, pressures);
    (other + elastic, other + potential)
}

/// Visits the element matrices of the tangent stiffness (N/m), the Hessian of [`energy`], one at a time.
pub fn visit_stiffness(body: &Body, positions: &[Vec3], visit: Visitor<'_>) {
    body.terms()
        .for_each(|term| term.visit_stiffness(positions, visit));
}

/// Visits the element matrices of the tangent stiffness in batches of a size that the term chooses.
pub fn visit_elements(body: &Body, positions: &[Vec3], visit: ElementsVisitor<'_>) {
    body.terms()
        .for_each(|term| term.visit_elements(positions, visit));
}

/// Visits the element matrices of the tangent stiffness within a time step, with or without its geometric part.
pub fn visit_tangent(
    body: &Body,
    positions: &[Vec3],
    within: &[Within],
    tangent: Tangent,
    visit: Visitor<'_>,
) {
    for term in body.terms_but_hex8s() {
        term.visit_tangent(positions, tangent, visit);
    }
    let hex8s = body.hex8_term();
    hex8s.visit_tangent_within(positions, within, tangent, visit);
}

/// Computes, for every vertex, a bound in N/m on the row sum of the stiffness matrix at `positions`, membranes taut.
pub fn row_sums(body: &Body, positions: &[Vec3], sums: &mut [f64]) {
    sums.fill(0.0);
    body.terms()
        .for_each(|term| term.add_row_sums(positions, sums));
}

/// Adds the product of the stiffness matrix at `positions` with `direction`, without the geometric part of edges and
/// tetrahedra, and without membranes, for which see [`add_taut_product`].
pub fn add_stiffness_product(
    body: &Body,
    positions: &[Vec3],
    direction: &[Vec3],
    product: &mut [Vec3],
) {
    body.terms_but_membranes()
        .for_each(|term| term.add_product(positions, direction, product));
}

/// Adds the product of the stiffness of all membranes, as if taut at `positions`, with `direction`.
pub fn add_taut_product(body: &Body, positions: &[Vec3], direction: &[Vec3], product: &mut [Vec3]) {
    body.membrane_term()
        .add_product(positions, direction, product);
}
