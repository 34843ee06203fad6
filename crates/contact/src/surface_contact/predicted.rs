//! Contact pressures as independent unknowns of Newton's method.
//!
//! A step that lets two surfaces penetrate ends under spurious pressures, whose geometric stiffness would make the next
//! tangent indefinite. With the pressure `p` of every sample as an unknown of its own, Newton's method on `f(x) + Σ p
//! ∂g = 0` and `p = ⟨λ − k (g − δ)⟩` solves, as for strains ([`voxsoft_solid::element::assumed_strain`]),
//!
//! `(K + Σ k ∂g ∂gᵀ + Σ p̂ ∂²g) δ = f + Σ ⟨λ − k (g − δ)⟩ ∂g`,
//!
//! with the sum on the right over the samples pressed at `x`, and `p̂` the pressure predicted by the last step: the
//! pressure at its start less `k ∂g·δ` where a sample was pressed, none elsewhere (a semi-smooth Newton method;
//! Hintermüller, Ito and Kunisch 2002, doi 10.1137/S1052623401383558). The equilibrium is the same.

use voxsoft_solid::vector::{Vec3, axpy, dot};

use super::SurfaceContact;

impl SurfaceContact {
    /// Force of every sample along its normal in N, linearized, at the end of a step that `moves` (m) from `positions`.
    pub(super) fn predicted_pressures(&self, positions: &[Vec3], moves: &[Vec3]) -> Vec<f64> {
        let mut pressures = vec![0.0; self.samples.len()];
        self.each_contact(&self.state, positions, |meeting, normal, _| {
            let mut relative = [0.0; 3];
            for (factor, point) in self.relative(meeting.spot()) {
                axpy(&mut relative, factor, self.points[point as usize].at(moves));
            }
            let law = self.law(meeting.sample, meeting.triangle);
            let opening = dot(meeting.normal, relative);
            pressures[meeting.sample as usize] =
                law.predicted(normal, self.penalty(meeting.sample), opening);
        });
        pressures
    }
}
