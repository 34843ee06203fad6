//! State of contact between evaluations.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use voxsoft_solid::Moment;
use voxsoft_solid::vector::Vec3;

/// Multipliers and friction anchor of one contact sample.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SampleMemory {
    /// Lagrange multiplier of the gap: a force in N that pushes apart.
    pub normal: f64,
    /// Lagrange multiplier of the slip: the friction in N, along the surface.
    pub friction: Vec3,
    /// Normal of the friction plane, of the last correction.
    pub plane: Vec3,
    /// Bound of friction, in N.
    pub bound: f64,
    /// Anchor of friction on the other surface: a triangle, and affine coordinates in it.
    pub anchor: Option<(u32, [f64; 3])>,
    /// Place of an edge that sticks there, as a part of the way between its ends.
    pub along: f64,
    /// Part of its step that remained when it came into contact there.
    pub since: f64,
    /// True while it sticks whatever its bound, for one iteration.
    pub unbounded: bool,
    /// Regime of the sample, prescribed while a motion is differentiated.
    pub regime: Option<Regime>,
}

/// Side of the kinks of contact on which a sample is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Regime {
    /// True if surfaces press on each other there.
    pub pressed: bool,
    /// With friction, true if that is at its bound.
    pub slips: Option<bool>,
}

impl SampleMemory {
    /// Tests whether a sample with a pressure (N) presses on a surface.
    pub fn is_pressed(&self, pressure: f64) -> bool {
        self.regime.map_or(pressure > 0.0, |regime| regime.pressed)
    }

    /// Tests whether friction acts.
    pub fn rubs(&self) -> bool {
        self.regime
            .map_or(self.bound > 0.0, |regime| regime.slips.is_some())
    }

    /// Tests whether friction is prescribed to be at its bound.
    pub fn slips_as_prescribed(&self) -> bool {
        self.regime.is_some_and(|regime| regime.slips == Some(true))
    }

    /// The anchor without any force.
    pub fn anchor_only(&self) -> Self {
        Self {
            anchor: self.anchor,
            along: self.along,
            since: self.since,
            regime: self.regime,
            ..Self::default()
        }
    }
}

/// Face that a sample meets, fixed for some steps of Newton's method, so that the minimized energy has no kinks where a
/// sample slides over an edge.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Facing {
    /// Plane of a triangle.
    Plane(u32),
    /// Point on an edge or corner of a triangle, with its barycentric coordinates, and the normal there.
    Edge(u32, [f64; 3], Vec3),
    /// Edge of a triangle, from the given corner to the next; true if the normal is the cross product of the two edges,
    /// that of the sample first, false if its opposite.
    Across(u32, usize, bool),
}

impl Facing {
    pub fn triangle(self) -> u32 {
        match self {
            Self::Plane(triangle) | Self::Edge(triangle, ..) | Self::Across(triangle, ..) => {
                triangle
            }
        }
    }
}

/// Multiplier and damage of one tie.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Hold {
    /// Multiplier: the force on the first surface, N.
    pub force: Vec3,
    /// True once the tie is broken.
    pub broken: bool,
}

/// Multipliers and facing of all samples at an equilibrium, before its correction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Held {
    pub(super) now: Vec<SampleMemory>,
    pub(super) facing: Vec<Option<Facing>>,
    pub(super) stick: f64,
    pub(super) extrapolated: Option<f64>,
    pub(super) precise: bool,
    /// Regime of each sample; empty where it is not prescribed.
    pub(super) regimes: Vec<Regime>,
}

/// State to which contact returns from iterations with predicted multipliers that did not converge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct BeforePrediction {
    pub(super) now: Vec<SampleMemory>,
    pub(super) facing: Vec<Option<Facing>>,
    pub(super) stick: f64,
    pub(super) looks: u32,
}

/// Recorded part of a path.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Recording {
    pub(super) accepted: Vec<Moment<Held>>,
    /// Moments since the last accepted state.
    pub(super) pending: Vec<Moment<Held>>,
}

/// State of all samples.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct ContactState {
    /// Points of all surfaces at the last accepted state, m.
    pub accepted_points: Vec<Vec3>,
    /// Facing of each sample at the last accepted state.
    pub accepted_facing: Vec<Option<Facing>>,
    /// Multipliers and anchors at the last accepted state.
    pub accepted: Vec<SampleMemory>,
    /// Multipliers and anchors at the accepted state before that.
    pub before: Vec<SampleMemory>,
    /// Friction on each vertex in N at the last accepted state and at the one before.
    pub accepted_friction: [Vec<Vec3>; 2],
    /// Steps by which the multipliers are extrapolated, until a correction.
    pub extrapolated: Option<f64>,
    /// Current multipliers and anchors.
    pub now: Vec<SampleMemory>,
    /// Multipliers of the ties at the last accepted state, and the current ones.
    pub accepted_holds: Vec<Hold>,
    pub holds: Vec<Hold>,
    /// Points when candidates were last listed.
    pub listed_points: Vec<Vec3>,
    /// True if those were the points of the accepted state.
    pub listed_at_rest: bool,
    /// Candidate triangles of each point on the way from the last accepted state.
    pub candidates: Vec<Vec<u32>>,
    /// Points when candidates of edges were last listed; empty if they have to be.
    pub edges_listed_points: Vec<Vec3>,
    /// Candidate triangles of each edge.
    pub edge_candidates: Vec<Vec<u32>>,
    /// Current facing of each sample.
    pub facing: Vec<Option<Facing>>,
    /// Slip penalty, relative to the contact penalty.
    pub stick: f64,
    /// Largest creep of sticking samples at the last correction, relative to its tolerance.
    pub crept: f64,
    /// Largest error of gaps and creep at the last correction, relative to its tolerance.
    pub off: f64,
    /// Corrections since the last accepted state.
    pub corrections: u32,
    /// Remaining searches of all samples before their facing is fixed.
    pub looks: u32,
    /// Sparsity pattern: samples and triangles whose stiffness has entries.
    pub pattern: BTreeSet<(u32, u32)>,
    /// True if the pattern has shrunk since [`follow`](voxsoft_solid::Contact::follow) last reported a change.
    pub pattern_shrank: bool,
    /// State before iterations with predicted multipliers, while these go on.
    pub before_prediction: Option<BeforePrediction>,
    /// Predicted pressures of all samples in N, within these iterations; empty before the first prediction.
    pub predicted: Vec<f64>,
    /// True while a path is retraced, for which the stiffness has to be exact.
    pub retraces: bool,
    /// Values of [`SampleMemory::since`] of all samples, prescribed while a path is retraced: for a sample that was
    /// only just apart it changes steeply, and soon no more.
    pub given_since: Vec<f64>,
    /// Recorded path, if derivatives will need it.
    pub recording: Option<Recording>,
}
