//! Selective mass scaling of membranes, so that they do not limit the substep.
//!
//! A layer of fabric is so much stiffer than the rubber beneath it that its own waves would need substeps of
//! microseconds, though they are of no interest. Its forces stay as they are, explicit at the beginning of the substep,
//! but the vertices of membranes respond to all forces with the masses
//!
//! ```text
//! M̃ = M + h⁴/27 L M⁻¹ L
//! ```
//!
//! instead of `M`, where `L` bounds the stiffness of all membranes along any axis
//! ([`voxsoft_solid::Membrane::bounding_stiffness`]): selective mass scaling (Olovsson, Simonsson and Unosson 2005,
//! doi 10.1002/nme.1293).
//!
//! **Stability.** An explicit substep needs `h² K ≤ 4 M̃`. The default substep is one over the highest frequency of the
//! rest of the body, `h² K ≤ M` there, which leaves `3 M + 4/27 h⁴ L M⁻¹ L` for the membranes; and
//! `3 + 4/27 x² ≥ 4/3 x` for any `x`. So a membrane does not limit the substep, up to strains that make it by a third
//! stiffer than it is at rest.
//!
//! **Accuracy.** An equilibrium has no acceleration, so it is the same for any `M̃`. `L` gives zero for a translation,
//! so momentum is kept; it is the same along all axes, so angular momentum is. A wave with the frequency `ω` in a
//! membrane alone has its inertia multiplied by `1 + (hω)⁴/27`: resolved motions, `hω < 1`, hardly change. With `L`
//! alone in place of its square the factor would be `1 + (hω)²/3`, and rigid rotation would be hard. The default limit
//! of `hω` is [`super::MEMBRANE_FREQUENCY`].

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Body, Problem};

use crate::envelope::{Envelope, along};

/// Factor `(1 + 1/3)²/48` of `h⁴ L M⁻¹ L`, see the module.
const SHARE: f64 = 1.0 / 27.0;

/// Sparse rows of a matrix: columns with values in N/m.
type Rows = Vec<Vec<(usize, f64)>>;

/// Scaled inertia of the vertices of all membranes of a body.
pub(super) struct MembraneInertia {
    /// Vertices of membranes, in the order of the matrices.
    vertices: Vec<usize>,
    /// `L`.
    stiffness: Rows,
    /// `M̃`, factored: for each axis, or once if clamps hold all axes of each vertex or none.
    masses: Vec<Envelope>,
    /// Substep (s) and inverse masses (1/kg, zero on held axes) for which `masses` are made.
    substep: f64,
    inverse_masses: Vec<Vec3>,
    /// Values before a change, followed by work arrays.
    before: Vec<Vec3>,
    momenta: Vec<Vec3>,
    changes: Vec<Vec3>,
}

impl MembraneInertia {
    /// Makes the inertia; `None` for a body without membranes.
    pub fn of(problem: &Problem) -> Option<Self> {
        let body = problem.body();
        if body.membranes().is_empty() {
            return None;
        }
        let corners = body.membranes().iter().flat_map(|m| m.vertices());
        let mut vertices: Vec<usize> = corners.map(|v| v as usize).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let order = along(&pattern_of_square(&bounding_stiffness(body, &vertices)));
        let vertices: Vec<usize> = order.into_iter().map(|place| vertices[place]).collect();
        let stiffness = bounding_stiffness(body, &vertices);
        let masses = Envelope::zeros(&pattern_of_square(&stiffness));
        let held = vertices.iter().map(|&v| problem.held()[v]);
        let alike = held.into_iter().all(|[x, y, z]| x == y && y == z);
        let zeros = vec![[0.0; 3]; vertices.len()];
        Some(Self {
            vertices,
            stiffness,
            masses: vec![masses; if alike { 1 } else { 3 }],
            substep: 0.0,
            inverse_masses: zeros.clone(),
            before: zeros.clone(),
            momenta: zeros.clone(),
            changes: zeros,
        })
    }

    /// Vertices of membranes.
    pub fn vertices(&self) -> &[usize] {
        &self.vertices
    }

    /// Stores `factor` times the values of all vertices, before they are changed.
    pub fn note(&mut self, factor: f64, values: &[Vec3]) {
        for (before, &vertex) in self.before.iter_mut().zip(&self.vertices) {
            *before = values[vertex].map(|value| factor * value);
        }
    }

    /// Replaces the changes of the values since [`Self::note`], by impulses on the plain masses in a substep of `h`,
    /// with those of the same impulses on `M̃`.
    pub fn spread(&mut self, h: f64, inverse_masses: &[Vec3], values: &mut [Vec3]) {
        self.weigh(h, inverse_masses);
        for (place, &vertex) in self.vertices.iter().enumerate() {
            for axis in 0..3 {
                let inverse = self.inverse_masses[place][axis];
                let change = values[vertex][axis] - self.before[place][axis];
                self.momenta[place][axis] = if inverse > 0.0 { change / inverse } else { 0.0 };
            }
        }
        for (axis, masses) in self.masses.iter().enumerate() {
            self.changes.copy_from_slice(&self.momenta);
            masses.solve(&mut self.changes);
            let axes = if self.masses.len() == 1 {
                0..3
            } else {
                axis..axis + 1
            };
            for (place, &vertex) in self.vertices.iter().enumerate() {
                for axis in axes.clone() {
                    if self.inverse_masses[place][axis] > 0.0 {
                        values[vertex][axis] = self.before[place][axis] + self.changes[place][axis];
                    }
                }
            }
        }
    }

    /// Updates `M̃` after a change of the substep or of the inverse masses.
    fn weigh(&mut self, h: f64, inverse_masses: &[Vec3]) {
        let mut places = self.inverse_masses.iter().zip(&self.vertices);
        if h == self.substep && places.all(|(known, &vertex)| *known == inverse_masses[vertex]) {
            return;
        }
        self.substep = h;
        for (known, &vertex) in self.inverse_masses.iter_mut().zip(&self.vertices) {
            *known = inverse_masses[vertex];
        }
        for (axis, masses) in self.masses.iter_mut().enumerate() {
            masses.clear();
            let inverse = |place: usize| self.inverse_masses[place][axis];
            let free = |link: &&(usize, f64)| inverse(link.0) > 0.0;
            for (row, links) in self.stiffness.iter().enumerate() {
                if inverse(row) == 0.0 {
                    masses.add(row, row, 1.0);
                    continue;
                }
                masses.add(row, row, 1.0 / inverse(row));
                for (middle, first) in links.iter().filter(free) {
                    let factor = SHARE * h.powi(4) * inverse(*middle) * first;
                    let seconds = self.stiffness[*middle].iter().filter(free);
                    for (column, second) in seconds.filter(|(column, _)| *column <= row) {
                        masses.add(row, *column, factor * second);
                    }
                }
            }
            masses.factor();
        }
    }
}

/// Assembles `L` for vertices in the order given.
fn bounding_stiffness(body: &Body, vertices: &[usize]) -> Rows {
    let mut place_of = vec![usize::MAX; body.rest().len()];
    for (place, &vertex) in vertices.iter().enumerate() {
        place_of[vertex] = place;
    }
    let mut rows: Rows = vec![Vec::new(); vertices.len()];
    for membrane in body.membranes() {
        let places = membrane.vertices().map(|v| place_of[v as usize]);
        for (row, values) in places.into_iter().zip(membrane.bounding_stiffness()) {
            for (column, value) in places.into_iter().zip(values) {
                match rows[row].iter_mut().find(|(place, _)| *place == column) {
                    Some((_, sum)) => *sum += value,
                    None => rows[row].push((column, value)),
                }
            }
        }
    }
    rows
}

/// Sparsity pattern of the square of a matrix: the nonzero columns of each row.
fn pattern_of_square(rows: &Rows) -> Vec<Vec<usize>> {
    let pattern = |row: &Vec<(usize, f64)>| {
        let columns = row
            .iter()
            .flat_map(|(middle, _)| rows[*middle].iter().map(|(column, _)| *column));
        let mut columns: Vec<usize> = columns.collect();
        columns.sort_unstable();
        columns.dedup();
        columns
    };
    rows.iter().map(pattern).collect()
}
