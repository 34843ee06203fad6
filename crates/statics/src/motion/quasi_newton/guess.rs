//! Starting guess of a step.

use voxsoft_solid::vector::Vec3;

use super::QuasiNewton;
use super::contact::{restore, touches};
use super::objective::{Goal, Objective, Value};
use crate::motion::run::Run;

/// Ratio of the kinetic energy to the elastic one above which a step checks the prediction of its motion.
const VIOLENT: f64 = 1e-3;

impl QuasiNewton {
    /// Starting guess of the step with its value, and the potential of standing still as a bound, if that is known.
    pub(super) fn first_guess(&mut self, run: &mut Run, goal: Goal<'_>) -> (Vec<Vec3>, Value, f64) {
        let (positions, value) = self.judged(run, self.predicted(run, goal.time), goal);
        if !is_violent(run) && !touches(&run.problem, &positions) {
            let bound = value.potential;
            return (positions, value, bound);
        }
        // The prediction may be wrong: a load has jumped, or a contact has closed.
        let (stayed, other) = self.judged(run, self.stayed(run, goal.time), goal);
        let bound = other.potential;
        if !(value.potential <= bound) {
            return (stayed, other, bound);
        }
        let (positions, value) = self.judged(run, positions, goal);
        (positions, value, bound)
    }

    /// Restarts from standing still if that has a lower potential, after contact has changed its facing or penalty;
    /// returns the potential of standing still.
    ///
    /// The previous result may be deep in a surface that is faced now, and a search from there converts the energy of a
    /// fictitious compression into motion.
    pub(super) fn stay_where_better(
        &self,
        run: &Run,
        goal: Goal<'_>,
        positions: &mut Vec<Vec3>,
        value: &mut Value,
    ) -> f64 {
        let stayed = self.stayed(run, goal.time);
        let mut other = Value::default();
        let problem = &run.problem;
        Objective { problem, goal }.evaluate(&stayed, &mut other);
        let bound = other.potential;
        if !(value.potential <= bound) {
            (*positions, *value) = (stayed, other);
        }
        bound
    }

    /// Guess with its value, with the facing of samples updated there.
    fn judged(
        &mut self,
        run: &mut Run,
        positions: Vec<Vec3>,
        goal: Goal<'_>,
    ) -> (Vec<Vec3>, Value) {
        self.face(run, &positions, true);
        let mut value = Value::default();
        let problem = &run.problem;
        Objective { problem, goal }.evaluate(&positions, &mut value);
        (positions, value)
    }

    /// Prediction of the motion with its velocity and acceleration, and clamps at their targets.
    fn predicted(&self, run: &Run, time: f64) -> Vec<Vec3> {
        let step = time - run.state.time;
        let mut positions = run.extrapolated(step, run.before.as_ref());
        self.place(&run.problem, time, &mut positions);
        restore(&run.problem, &mut positions);
        positions
    }

    /// Prediction of standing still, except for clamps.
    fn stayed(&self, run: &Run, time: f64) -> Vec<Vec3> {
        let mut positions = run.state.positions.clone();
        self.place(&run.problem, time, &mut positions);
        positions
    }
}

/// Tests whether the body moves so fast, or has changed so much, that its motion cannot be predicted.
fn is_violent(run: &Run) -> bool {
    !(run.now.kinetic <= VIOLENT * run.now.elastic)
}
