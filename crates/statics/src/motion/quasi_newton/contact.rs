//! Contact and free rigid bodies within a step.
//!
//! Contact is a term of the body that is minimized with the rest, with fixed multipliers; they are corrected once, at
//! the end of the step. The facing of samples is fixed during a search and updated after it: if that has changed
//! anything the search continues.
//!
//! If there is contact at the start of a step or at its end, the step is taken by the backward Euler formula: one that
//! looks two steps back makes bodies in contact rebound too fast (see [`crate::motion::newton`]).
//!
//! A rigid body moves as four vertices whose forces and moves are projected to rigid ones, and which are restored to
//! their distances after every move: no move has to go along the narrow valley of its stiff springs.

use voxsoft_solid::Problem;
use voxsoft_solid::vector::Vec3;

use super::objective::{Goal, Objective, Value};
use super::{MOST_MOVES, MOST_MOVES_IN_CONTACT, MOVE_IN_CONTACT, MOVE_OF_EDGE, QuasiNewton, ROUGH};
use crate::motion::run::Run;

/// Most searches of one step after which samples update their facing.
pub(super) const FACING_ROUNDS: u32 = 2;
/// Most searches after which the contact penalty may grow, if a sample is too deep.
pub(super) const DEEP_ROUNDS: u32 = 4;

impl QuasiNewton {
    /// Updates the facing of all samples at `positions`; a full search if `anew`.
    pub(super) fn face(&mut self, run: &mut Run, positions: &[Vec3], anew: bool) {
        if let Some(contact) = run.problem.contact_mut() {
            if anew {
                contact.relist();
            }
            self.pattern_changed |= contact.follow(positions);
        }
    }

    /// Updates the facing at `positions`, with the value; returns true if the potential changes.
    pub(super) fn faces_other(
        &mut self,
        run: &mut Run,
        goal: Goal<'_>,
        positions: &[Vec3],
        value: &mut Value,
    ) -> bool {
        if run.problem.contact().is_none() {
            return false;
        }
        let before = value.potential;
        self.face(run, positions, false);
        let problem = &run.problem;
        Objective { problem, goal }.evaluate(positions, value);
        value.potential != before
    }
}

/// Raises the contact penalty if a sample is too deep at `positions`; returns true if one is.
pub(super) fn stiffens(
    run: &mut Run,
    goal: Goal<'_>,
    positions: &[Vec3],
    value: &mut Value,
) -> bool {
    let contact = run.problem.contact_mut();
    if !contact.is_some_and(|contact| contact.stiffen(positions)) {
        return false;
    }
    let problem = &run.problem;
    Objective { problem, goal }.evaluate(positions, value);
    true
}

/// Tolerance of the last move of a search (m), most moves, and the factor on the tolerance after them.
pub(super) fn patience(run: &Run) -> (f64, u32, f64) {
    let (part, most, rough) = match run.problem.contact() {
        Some(_) => (MOVE_IN_CONTACT, MOST_MOVES_IN_CONTACT, ROUGH),
        None => (MOVE_OF_EDGE, MOST_MOVES, 0.0),
    };
    (part * run.shortest_edge, most, rough)
}

/// Tests whether any sample is pressed at `positions`.
pub(super) fn touches(problem: &Problem, positions: &[Vec3]) -> bool {
    let contact = problem.contact();
    contact.is_some_and(|contact| contact.is_touching(positions))
}

/// Projects vectors on the vertices of rigid bodies to rigid motions.
pub(super) fn make_rigid(problem: &Problem, positions: &[Vec3], vectors: &mut [Vec3]) {
    for body in problem.rigid() {
        body.project(positions, vectors);
    }
}

/// Restores the distances of the vertices of rigid bodies.
pub(super) fn restore(problem: &Problem, positions: &mut [Vec3]) {
    for body in problem.rigid() {
        body.restore(problem.body().rest(), positions);
    }
}
