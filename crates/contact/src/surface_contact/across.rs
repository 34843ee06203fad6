//! Forces across surfaces in contact, by their law.

use voxsoft_solid::Contact;
use voxsoft_solid::vector::{Vec3, dot};

use super::law::{Across, Law, Laws, Normal};
use super::state::{ContactState, SampleMemory};
use super::{ContactPair, ROUNDING, SurfaceContact};
use crate::gap::{area, normal};

/// Smallest cosine between the normal of a triangle and the direction against which its contact presses: 60 degrees.
const TOWARD: f64 = 0.5;

impl SurfaceContact {
    /// Sets the contact laws of pairs of surfaces, at `rest` (m) in the unloaded design; those without one have hard
    /// contact.
    #[must_use]
    pub fn with_laws(mut self, laws: Laws, rest: &[Vec3]) -> Self {
        if !laws.is_empty() {
            self.laws = laws;
            Contact::reset(&mut self, rest);
        }
        self
    }

    /// Contact law of a sample and a triangle.
    pub(super) fn law(&self, sample: u32, triangle: u32) -> &dyn Law {
        let of = self.samples[sample as usize].surface;
        self.laws.of(of, self.surface_of[triangle as usize])
    }

    /// Forces on a sample along the contact normal; `None` where there is none.
    ///
    /// The points are asked for by laws with a range only.
    ///
    /// If a body touches in the unloaded design, the clearance goes to zero beside vertices that never move: their gaps
    /// cannot change, and a multiplier that should open them would grow without bound.
    pub(super) fn normal(
        &self,
        memory: &SampleMemory,
        meeting: &ContactPair,
        points: &[Vec3],
    ) -> Option<Normal> {
        let law = self.law(meeting.sample, meeting.triangle);
        let gap = self.gap_to_clearance(meeting)?;
        let reaches = gap < law.range() && law.range() > 0.0;
        law.normal(Across {
            multiplier: memory.normal,
            penalty: self.penalty(meeting.sample),
            gap,
            pressed: memory.regime.map(|regime| regime.pressed),
            area: if reaches {
                self.area_across(meeting, points)
            } else {
                0.0
            },
        })
    }

    /// Gap less the clearance, m; `None` if no vertex of the pair moves.
    pub(super) fn gap_to_clearance(&self, meeting: &ContactPair) -> Option<f64> {
        let mobility = self.mobility(meeting);
        (mobility > ROUNDING).then(|| meeting.gap - mobility * self.clearance(meeting.sample))
    }

    /// Calls `take` with every contact pair that has forces along its normal, and with these.
    pub(super) fn each_contact(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        mut take: impl FnMut(&ContactPair, Normal, &[Vec3]),
    ) {
        self.each_meeting(state, positions, |meeting, points| {
            let memory = &state.now[meeting.sample as usize];
            if let Some(normal) = self.normal(memory, meeting, points) {
                take(meeting, normal, points);
            }
        });
    }

    /// Calls `take` with every sample that faces a triangle, and with the points.
    pub(super) fn each_meeting(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        mut take: impl FnMut(&ContactPair, &[Vec3]),
    ) {
        let points = self.points_at(positions);
        for (index, facing) in state.facing.iter().enumerate() {
            if let Some(meeting) = facing.and_then(|f| self.meeting(index as u32, f, &points)) {
                take(&meeting, &points);
            }
        }
    }

    /// Area in the unloaded body (m²) over which a sample integrates a traction: of its triangles that face the
    /// contact. Of two surfaces the one with the finer points integrates; a surface with itself counts twice.
    fn area_across(&self, meeting: &ContactPair, points: &[Vec3]) -> f64 {
        let sample = &self.samples[meeting.sample as usize];
        let (own, other) = (
            sample.surface as usize,
            self.surface_of[meeting.triangle as usize] as usize,
        );
        let size = |surface: usize| (self.least_area[surface], surface);
        if sample.is_edge() || size(other) < size(own) {
            return 0.0;
        }
        let faces = |t: &&u32| dot(normal(self.corners(**t, points)), meeting.normal) < -TOWARD;
        let thirds = sample.triangles.iter().filter(faces);
        let part: f64 = thirds
            .map(|t| area(self.corners(*t, &self.rest_points)) / 3.0)
            .sum();
        let sides = if own == other { 2.0 } else { 1.0 };
        self.weight(meeting.sample) * part / sides
    }
}
