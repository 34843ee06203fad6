//! Anchors of friction: where a sample begins to stick.

use voxsoft_solid::vector::{Vec3, add, axpy, dot, scale, sub};

use super::state::{ContactState, Facing};
use super::{ContactPair, SurfaceContact};
use crate::gap::{self, normal};

/// Smallest cosine between the normals of a triangle and of the plane of friction for which the place across is used.
const LEAST_LEAN: f64 = 0.5;

impl SurfaceContact {
    /// Foot of a sample on the triangle that it faces.
    pub(super) fn foot(&self, meeting: &ContactPair, points: &[Vec3]) -> (u32, [f64; 3]) {
        let weights = match meeting.facing {
            Facing::Across(..) => meeting.weights,
            _ => {
                let point = self.place(meeting.sample, meeting.along, points);
                gap::affine(point, self.corners(meeting.triangle, points))
            }
        };
        (meeting.triangle, weights)
    }

    /// Place on the triangle that a sample faces from which it has not slipped in the `plane` of friction of this normal,
    /// so that an anchor there leaves friction as it is: the sides of a gap lean from each other.
    pub(super) fn foot_across(
        &self,
        meeting: &ContactPair,
        plane: Vec3,
        points: &[Vec3],
    ) -> (u32, [f64; 3]) {
        let corners = self.corners(meeting.triangle, points);
        let outward = normal(corners);
        let lean = dot(plane, outward);
        if matches!(meeting.facing, Facing::Across(..)) || lean <= LEAST_LEAN {
            return self.foot(meeting, points);
        }
        let mut point = self.place(meeting.sample, meeting.along, points);
        let height = dot(sub(point, corners[0]), outward);
        axpy(&mut point, -height / lean, plane);
        (meeting.triangle, gap::affine(point, corners))
    }

    /// First anchor of a sample that has come into contact since the last accepted state: the place where it met the
    /// surface, back along its way by the ratio of the gaps. An edge sticks where it first presses at an equilibrium.
    /// Returns the place on the triangle, the place on the edge, and the part of the step that remained.
    pub(super) fn first_anchor(
        &self,
        state: &ContactState,
        meeting: &ContactPair,
        points: &[Vec3],
    ) -> ((u32, [f64; 3]), f64, f64) {
        if matches!(meeting.facing, Facing::Across(..)) {
            return (self.foot(meeting, points), meeting.along, 0.0);
        }
        let point = points[meeting.sample as usize];
        let corners = self.corners(meeting.triangle, points);
        let before = self.corners(meeting.triangle, &state.accepted_points);
        let start = state.accepted_points[meeting.sample as usize];
        let first = gap::affine(start, before);
        let mut foot = [0.0; 3];
        let mut foot_now = [0.0; 3];
        for c in 0..3 {
            axpy(&mut foot, first[c], before[c]);
            axpy(&mut foot_now, first[c], corners[c]);
        }
        let clearance = self.mobility(meeting) * self.clearance(meeting.sample);
        let gap_before = dot(sub(start, foot), normal(before)) - clearance;
        let gap_now = meeting.gap - clearance;
        let given = state.given_since.get(meeting.sample as usize);
        let since = if let Some(given) = given {
            *given
        } else if gap_before > 0.0 && gap_before > gap_now {
            1.0 - gap_before / (gap_before - gap_now.min(0.0))
        } else {
            1.0
        };
        // A contact that only just begins has `since` near 0: it has not slipped yet.
        let slip = sub(point, foot_now);
        let anchor = add(point, scale(-since, slip));
        ((meeting.triangle, gap::affine(anchor, corners)), 0.0, since)
    }
}
