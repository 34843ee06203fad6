//! What a state of contact comes to, pair by pair.

use std::collections::BTreeMap;

use voxsoft_solid::vector::{Vec3, add, axpy, dot, norm, scale};

use super::Touch;
use super::gap::normal;

/// The part of its bound from which friction counts as slipping: bounds of light pressures are right to a few percent.
const NEARLY: f64 = 0.95;

/// The contact of two surfaces, or of one with itself.
#[derive(Debug, Clone, PartialEq)]
pub struct PairReport {
    /// The two surfaces.
    pub of: [u32; 2],
    /// The force on the first in N; zero for a surface with itself.
    pub force: Vec3,
    /// The sum of the sizes of all pressures and frictions, N: also what cancels.
    pub pressed: f64,
    /// The area in contact in the unloaded body, m².
    pub area: f64,
    /// The smallest gap in m.
    pub gap: f64,
    /// The part of the pressure under which the surfaces slip.
    pub slipping: f64,
}

impl Touch {
    /// What touches at `positions`, with the multipliers of the last correction; ascending.
    pub fn pairs(&self, positions: &[Vec3]) -> Vec<PairReport> {
        let state = self.read();
        let mut found: BTreeMap<[u32; 2], (PairReport, f64, [f64; 2])> = BTreeMap::new();
        self.each_contact(&state, positions, |meeting, pressure, point, points| {
            let sample = &self.samples[meeting.sample as usize];
            let other = self.surface_of[meeting.triangle as usize];
            let of = [sample.surface.min(other), sample.surface.max(other)];
            let memory = &state.now[meeting.sample as usize];
            let friction = self.friction(&state, meeting.sample, point, points);
            let mut force = scale(pressure, meeting.normal);
            let (mut pressed, mut slipping) = (pressure, pressure);
            if let Some(friction) = friction {
                force = add(force, friction.force);
                pressed = norm(force);
                let sticks = !friction.slips && norm(friction.force) < NEARLY * memory.bound;
                if sticks {
                    slipping = 0.0;
                }
            }
            let entry = found.entry(of).or_insert_with(|| {
                let report = PairReport {
                    of,
                    force: [0.0; 3],
                    pressed: 0.0,
                    area: 0.0,
                    gap: f64::INFINITY,
                    slipping: 0.0,
                };
                (report, 0.0, [0.0; 2])
            });
            let (report, total, areas) = entry;
            if of[0] != of[1] {
                let sign = if sample.surface == of[0] { 1.0 } else { -1.0 };
                axpy(&mut report.force, sign, force);
            }
            report.pressed += pressed;
            let facing = |t: &&u32| {
                let own = normal(self.corners(**t, points));
                dot(own, meeting.normal) < -0.5
            };
            let part = sample.triangles.iter().filter(facing).count();
            let side = usize::from(sample.surface != of[0] || of[0] == of[1]);
            areas[side] += sample.area * part as f64 / sample.triangles.len() as f64;
            report.gap = report.gap.min(meeting.gap);
            report.slipping += slipping;
            *total += pressure;
        });
        let each = found.into_values().map(|(mut report, total, areas)| {
            report.slipping /= total;
            // Both sides see the contact, the coarser one less sharply; a surface with itself counts twice.
            report.area = match report.of {
                [a, b] if a == b => areas[1] / 2.0,
                _ => areas[0].max(areas[1]),
            };
            report
        });
        each.collect()
    }
}
