//! Starting guess of a step.

use voxsoft_solid::vector::{Vec3, axpy, sub};

use super::Implicit;
use super::contact::restore;
use super::objective::{Goal, Objective, Value};

/// Ratio of the kinetic energy to the elastic one above which a step checks the prediction of its motion.
const VIOLENT: f64 = 1e-3;

impl Implicit {
    /// Starting guess of the step with its value, and the potential of standing still as a bound, if that is known.
    pub(super) fn first_guess(&mut self, goal: Goal<'_>) -> (Vec<Vec3>, Value, f64) {
        let (positions, value) = self.judged(self.predicted(goal.time), goal);
        if !self.is_violent() && !self.touches(&positions) {
            let bound = value.potential;
            return (positions, value, bound);
        }
        // The prediction may be wrong: a load has jumped, or a contact has closed.
        let (stayed, other) = self.judged(self.stayed(goal.time), goal);
        let bound = other.potential;
        if !(value.potential <= bound) {
            return (stayed, other, bound);
        }
        let (positions, value) = self.judged(positions, goal);
        (positions, value, bound)
    }

    /// Restarts from standing still if that has a lower potential, after contact has changed its facing or penalty;
    /// returns the potential of standing still.
    ///
    /// The previous result may be deep in a surface that is faced now, and a search from there converts the energy of a
    /// fictitious compression into motion.
    pub(super) fn stay_where_better(
        &mut self,
        goal: Goal<'_>,
        positions: &mut Vec<Vec3>,
        value: &mut Value,
    ) -> f64 {
        let stayed = self.stayed(goal.time);
        let mut other = Value::default();
        let problem = &self.problem;
        Objective { problem, goal }.evaluate(&stayed, &mut other);
        let bound = other.potential;
        if !(value.potential <= bound) {
            (*positions, *value) = (stayed, other);
        }
        bound
    }

    /// Guess with its value, with the facing of samples updated there.
    fn judged(&mut self, positions: Vec<Vec3>, goal: Goal<'_>) -> (Vec<Vec3>, Value) {
        self.face(&positions, true);
        let mut value = Value::default();
        let problem = &self.problem;
        Objective { problem, goal }.evaluate(&positions, &mut value);
        (positions, value)
    }

    /// Tests whether the body moves so fast, or has changed so much, that its motion cannot be predicted.
    fn is_violent(&self) -> bool {
        let kinetic = self.state.kinetic_energy(self.problem.body().masses());
        !(kinetic <= VIOLENT * self.value.energy)
    }

    /// Prediction of the motion with its velocity and acceleration, and clamps at their targets.
    fn predicted(&self, time: f64) -> Vec<Vec3> {
        let step = time - self.state.time;
        let mut positions = self.state.positions.clone();
        if let Some(before) = &self.before {
            let ratio = 0.5 * step * step / (self.state.time - before.time);
            let velocities = self.state.velocities.iter().zip(&before.velocities);
            for (x, (v, old)) in positions.iter_mut().zip(velocities) {
                axpy(x, step, *v);
                axpy(x, ratio, sub(*v, *old));
            }
        } else {
            for (x, v) in positions.iter_mut().zip(&self.state.velocities) {
                axpy(x, step, *v);
            }
        }
        self.place(time, &mut positions);
        restore(&self.problem, &mut positions);
        positions
    }

    /// Prediction of standing still, except for clamps.
    fn stayed(&self, time: f64) -> Vec<Vec3> {
        let mut positions = self.state.positions.clone();
        self.place(time, &mut positions);
        positions
    }
}
