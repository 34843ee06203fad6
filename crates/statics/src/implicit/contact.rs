//! Contact and free rigid bodies within a step.
//!
//! Contact is a term of the body that is minimized with the rest, its multipliers as they are; they are corrected once,
//! at the end of the step. What samples face is fixed during a search and looked for anew after it: where that has
//! changed anything the search goes on.
//!
//! Where something touches, at the start of a step or at its end, the step is taken by the backward Euler formula: one
//! that looks two steps back lets what meets rebound too fast (see [`crate::transient`]).
//!
//! A rigid body moves as four vertices whose forces and moves are made rigid, and which are put back where they have
//! their distances after every move: no move has to go along the narrow valley of its stiff springs.

use voxsoft_solid::Problem;
use voxsoft_solid::vector::Vec3;

use super::objective::{Goal, Objective, Value};
use super::{Implicit, MOST_MOVES, MOST_MOVES_IN_CONTACT, MOVE_IN_CONTACT, MOVE_OF_EDGE, ROUGH};

/// Searches of one step for which samples may look anew at what they face.
pub(super) const FACING_ROUNDS: u32 = 2;
/// The same after which contact may resist more, where something is too deep.
pub(super) const DEEP_ROUNDS: u32 = 4;

impl Implicit {
    /// Lets all samples look for what they face at `positions`.
    pub(super) fn face(&mut self, positions: &[Vec3], anew: bool) {
        if let Some(contact) = self.problem.contact_mut() {
            if anew {
                contact.look_anew();
            }
            self.pattern_changed |= contact.follow(positions);
        }
    }

    /// Evaluates anew what is faced at `positions`; whether that changes anything.
    pub(super) fn faces_other(
        &mut self,
        goal: Goal<'_>,
        positions: &[Vec3],
        value: &mut Value,
    ) -> bool {
        if self.problem.contact().is_none() {
            return false;
        }
        let before = value.potential;
        self.face(positions, false);
        let problem = &self.problem;
        Objective { problem, goal }.evaluate(positions, value);
        value.potential != before
    }

    /// Lets contact resist more where something is too deep at `positions`; whether anything is.
    pub(super) fn stiffens(
        &mut self,
        goal: Goal<'_>,
        positions: &[Vec3],
        value: &mut Value,
    ) -> bool {
        let contact = self.problem.contact_mut();
        if !contact.is_some_and(|contact| contact.stiffen(positions)) {
            return false;
        }
        let problem = &self.problem;
        Objective { problem, goal }.evaluate(positions, value);
        true
    }

    /// A last move of a search that is small in any case (m), how many moves it may take, and how many times as large
    /// the last one may be then.
    pub(super) fn patience(&self) -> (f64, u32, f64) {
        let (part, most, rough) = match self.problem.contact() {
            Some(_) => (MOVE_IN_CONTACT, MOST_MOVES_IN_CONTACT, ROUGH),
            None => (MOVE_OF_EDGE, MOST_MOVES, 0.0),
        };
        (part * self.shortest_edge, most, rough)
    }

    /// Whether anything is pressed at `positions`.
    pub(super) fn touches(&self, positions: &[Vec3]) -> bool {
        let contact = self.problem.contact();
        contact.is_some_and(|contact| contact.is_touching(positions))
    }
}

/// Leaves of vectors on the vertices of rigid bodies what is rigid.
pub(super) fn make_rigid(problem: &Problem, positions: &[Vec3], vectors: &mut [Vec3]) {
    for body in problem.rigid() {
        body.project(positions, vectors);
    }
}

/// Gives the vertices of rigid bodies back their distances.
pub(super) fn restore(problem: &Problem, positions: &mut [Vec3]) {
    for body in problem.rigid() {
        body.restore(problem.body().rest(), positions);
    }
}
