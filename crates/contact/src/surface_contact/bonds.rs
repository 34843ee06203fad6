//! Bonds: surfaces that are glued to each other (tie constraints), for good or up to a strength.
//!
//! Points `s` all over the triangles of the first surface that lie on the second at rest, with the areas `A_s`, are
//! tied to the coincident places `y_s` of the second body, which move with it. Vertices `v` share each point by
//! `N_v(s)`, and there is one tie for each of them (a mortar form: Bernardi, Maday and Patera 1994; Puso and Laursen
//! 2004, doi 10.1016/j.cma.2003.10.010):
//!
//! ```text
//! c_v = Σ_s A_s N_v(s) (x_s − y_s) / W_v = 0,   W_v = Σ_s A_s N_v(s),
//! ```
//!
//! so that a uniform traction passes between voxels of different sizes, and neither side is stiffened. With a
//! multiplier `f` and a penalty `k` its force is `f − k c`, and `f` is updated after each equilibrium like that of
//! contact. Because `y_s` coincides with the point at rest, gaps and overlaps at rest are kept, and no moment is lost.
//!
//! A bond with a strength breaks where `√(t_n² + t_t²)` exceeds it, with the tension `t_n` along the normal, for which
//! pressure does not count, and the traction `t_t` along the surface; both as means over a tie and its neighbors.
//! Surfaces of a broken tie are in contact.

use std::collections::BTreeMap;

use voxsoft_solid::ProblemError;
use voxsoft_solid::assembly::Visitor;
use voxsoft_solid::vector::{Vec3, axpy, dot, norm, scale, sub};

use super::mortar::MortarIntegral;
use super::state::{ContactState, Hold};
use super::tie::{Side, Tie};
use super::{PENALTY, SurfaceContact};
use crate::gap::normal;

/// Tolerance of the tie constraint, in voxels: a hundredth of the clearance of contact.
const OFF: f64 = 1e-6;
/// Penalty of a tie over that of contact: a tie has no kinks, and a larger penalty reduces the multiplier error more
/// with each correction.
const STIFFER_THAN_CONTACT: f64 = 10.0;

/// Two surfaces that are bonded.
#[derive(Debug, Clone, PartialEq)]
pub struct Bond {
    /// Numbers of the surfaces.
    pub of: [u32; 2],
    /// Strength: the traction at which the bond breaks, Pa; infinite for a permanent one.
    pub strength: f64,
    /// Ties between the surfaces.
    pub(super) ties: Vec<Tie>,
}

impl Bond {
    /// Bonds the parts of two surfaces that are within `reach` (m) of each other at `rest`.
    ///
    /// The first one should have the smaller voxels, and must not be rigid unless both are.
    ///
    /// # Errors
    ///
    /// An error if the surfaces do not meet.
    pub fn new(
        first: Side<'_>,
        second: Side<'_>,
        reach: f64,
        strength: f64,
        rest: &[Vec3],
    ) -> Result<Self, ProblemError> {
        let ties = MortarIntegral::new([first, second], reach, rest).ties(rest);
        if ties.is_empty() {
            let what = "the bonded area in m²";
            return Err(ProblemError::NotPositive { what, value: 0.0 });
        }
        Ok(Self {
            of: [first.number, second.number],
            strength,
            ties,
        })
    }
}

impl Tie {
    /// Constraint violation, m.
    fn off(&self, positions: &[Vec3]) -> Vec3 {
        sub(self.first.at(positions), self.second.at(positions))
    }
}

impl SurfaceContact {
    /// All ties with their bonds, in the order of their holds.
    pub(super) fn ties(&self) -> impl Iterator<Item = (&Bond, &Tie)> {
        let bonds = self.description.bonds.iter();
        bonds.flat_map(|bond| bond.ties.iter().map(move |tie| (bond, tie)))
    }

    /// Calls `take` with every unbroken tie and its force on the first surface, N.
    pub(super) fn each_tie(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        mut take: impl FnMut(&Bond, &Tie, Vec3),
    ) {
        for ((bond, tie), hold) in self.ties().zip(&state.holds) {
            if !hold.broken {
                let force = self.tie_force(tie, hold, positions);
                take(bond, tie, force);
            }
        }
    }

    fn tie_force(&self, tie: &Tie, hold: &Hold, positions: &[Vec3]) -> Vec3 {
        let mut force = hold.force;
        axpy(&mut force, -self.tie_penalty(tie), tie.off(positions));
        force
    }

    /// Penalty, N/m.
    pub(super) fn tie_penalty(&self, tie: &Tie) -> f64 {
        STIFFER_THAN_CONTACT * PENALTY * self.description.young / self.description.voxel * tie.stiff
    }

    /// Updated multipliers of the ties at an equilibrium, and their largest constraint violation relative to its
    /// tolerance.
    pub(super) fn corrected_ties(
        &self,
        state: &ContactState,
        positions: &[Vec3],
    ) -> (Vec<Hold>, f64) {
        let mut largest = 0.0f64;
        let pairs = self.ties().zip(&state.holds);
        let corrected = pairs.map(|((_, tie), hold)| {
            if hold.broken {
                return *hold;
            }
            largest = largest.max(norm(tie.off(positions)) / (OFF * self.description.voxel));
            Hold {
                force: self.tie_force(tie, hold, positions),
                ..*hold
            }
        });
        (corrected.collect(), largest)
    }

    /// Breaks ties that are loaded beyond their strength; returns true if any broke.
    pub(super) fn break_ties(&self, state: &mut ContactState, positions: &[Vec3]) -> bool {
        let mut loads = Vec::with_capacity(state.holds.len());
        let mut first = 0;
        for bond in &self.description.bonds {
            let holds = &state.holds[first..first + bond.ties.len()];
            first += bond.ties.len();
            for (tie, hold) in bond.ties.iter().zip(holds) {
                let load = if hold.broken || bond.strength.is_infinite() {
                    0.0
                } else {
                    let traction = self.traction(bond, tie, holds, positions);
                    self.pull(bond, tie, traction, positions) / bond.strength
                };
                loads.push(load);
            }
        }
        let mut any = false;
        for (hold, load) in state.holds.iter_mut().zip(loads) {
            if load > 1.0 {
                (hold.broken, any) = (true, true);
            }
        }
        any
    }

    /// Traction on the first surface, averaged around a tie, Pa: multipliers of single ties, of which some have little
    /// area, oscillate from one to the next.
    fn traction(&self, bond: &Bond, tie: &Tie, holds: &[Hold], positions: &[Vec3]) -> Vec3 {
        let (mut force, mut area) = ([0.0; 3], 0.0);
        for &near in &tie.patch {
            let (tie, hold) = (&bond.ties[near as usize], &holds[near as usize]);
            if !hold.broken {
                axpy(&mut force, 1.0, self.tie_force(tie, hold, positions));
                area += tie.area;
            }
        }
        scale(1.0 / area, force)
    }

    /// Magnitude of a traction on the first surface without its compressive part, Pa.
    fn pull(&self, bond: &Bond, tie: &Tie, traction: Vec3, positions: &[Vec3]) -> f64 {
        let surface = &self.description.surfaces[bond.of[1] as usize];
        let corners = surface.triangles[tie.triangle as usize];
        let outward = normal(corners.map(|p| surface.points[p as usize].at(positions)));
        let pressing = dot(traction, outward).max(0.0);
        norm(sub(traction, scale(pressing, outward)))
    }

    /// Ties of each sample, with the surface at their other end.
    pub(super) fn ties_at(&self, first_sample: &[u32], samples: usize) -> Vec<Vec<(u32, u32)>> {
        let mut at = vec![Vec::new(); samples];
        for (number, (bond, tie)) in self.ties().enumerate() {
            for side in 0..2 {
                let first = first_sample[bond.of[side] as usize];
                for point in &tie.points[side] {
                    at[(first + point) as usize].push((number as u32, bond.of[1 - side]));
                }
            }
        }
        at
    }

    /// Tests whether a sample is still bonded to a surface.
    pub(super) fn is_bonded(&self, state: &ContactState, sample: u32, surface: u32) -> bool {
        let ties = self.ties_at[sample as usize].iter();
        let holds = |(tie, to): &(u32, u32)| *to == surface && !state.holds[*tie as usize].broken;
        ties.into_iter().any(holds)
    }

    /// Stiffness of a tie: its penalty between all vertices that carry it.
    pub(super) fn visit_tie(&self, tie: &Tie, visit: Visitor<'_>) {
        let mut parts: BTreeMap<u32, f64> = BTreeMap::new();
        for (sign, side) in [(1.0, &tie.first), (-1.0, &tie.second)] {
            for (vertex, weight) in side.vertices.iter().zip(&side.weights) {
                *parts.entry(*vertex).or_default() += sign * weight;
            }
        }
        let (vertices, weights): (Vec<u32>, Vec<f64>) = parts.into_iter().unzip();
        let size = 3 * vertices.len();
        let mut matrix = vec![0.0; size * size];
        let k = self.tie_penalty(tie);
        for (a, wa) in weights.iter().enumerate() {
            for (b, wb) in weights.iter().enumerate() {
                for i in 0..3 {
                    matrix[(3 * a + i) * size + 3 * b + i] = k * wa * wb;
                }
            }
        }
        visit(&vertices, &matrix);
    }
}
