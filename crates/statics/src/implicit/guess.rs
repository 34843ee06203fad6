//! Where the search for the end of a step begins.

use voxsoft_solid::vector::{Vec3, axpy, sub};

use super::Implicit;
use super::contact::restore;
use super::objective::{Goal, Objective, Value};

/// The kinetic energy over the elastic one above which a step looks whether the motion goes on as it did.
const VIOLENT: f64 = 1e-3;

impl Implicit {
    /// Where the search begins, evaluated, and the potential of standing still where that is known.
    pub(super) fn first_guess(&mut self, goal: Goal<'_>) -> (Vec<Vec3>, Value, f64) {
        let (positions, value) = self.judged(self.predicted(goal.time), goal);
        if !self.is_violent() && !self.touches(&positions) {
            let bound = value.potential;
            return (positions, value, bound);
        }
        // The motion may not go on as it did: a load has jumped, or something is met.
        let (stayed, other) = self.judged(self.stayed(goal.time), goal);
        let bound = other.potential;
        if !(value.potential <= bound) {
            return (stayed, other, bound);
        }
        let (positions, value) = self.judged(positions, goal);
        (positions, value, bound)
    }

    /// Begins anew from standing still where that has less potential, after contact has changed what faces what or how
    /// much it resists; the potential of standing still.
    ///
    /// What was found before may lie deep in what is faced now, and a search from there spends the energy of a spring that
    /// nothing has compressed on throwing the body away.
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

    /// A guess, what it faces being looked for there.
    fn judged(&mut self, positions: Vec<Vec3>, goal: Goal<'_>) -> (Vec<Vec3>, Value) {
        self.face(&positions, true);
        let mut value = Value::default();
        let problem = &self.problem;
        Objective { problem, goal }.evaluate(&positions, &mut value);
        (positions, value)
    }

    /// Whether the body moves so fast, or has changed so much, that its motion cannot be foreseen.
    fn is_violent(&self) -> bool {
        let kinetic = self.state.kinetic_energy(self.problem.body().masses());
        !(kinetic <= VIOLENT * self.value.energy)
    }

    /// Where the search begins: the motion goes on as it did, clamps are where they belong.
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

    /// Where it begins instead: where the body is, but for its clamps.
    fn stayed(&self, time: f64) -> Vec<Vec3> {
        let mut positions = self.state.positions.clone();
        self.place(time, &mut positions);
        positions
    }
}
