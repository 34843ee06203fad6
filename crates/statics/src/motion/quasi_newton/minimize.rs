//! Quasi-Newton minimization of the potential of a time step.

use voxsoft_solid::Problem;
use voxsoft_solid::balance::NEGLIGIBLE_STRAIN;
use voxsoft_solid::matrix::determinant;
use voxsoft_solid::vector::{Vec3, add, norm, scale, sub};

use super::contact::{make_rigid, restore};
use super::lagged::Lagged;
use super::line::{Line, Outcome, Then};
use super::objective::{Objective, Value};
use super::pairs::{QuasiNewtonMemory, product};
use crate::motion::integrator::Asker;

/// Factors of [`Tolerance`].
const MOVE_OF_STEP: f64 = 1e-2;
const MOVE_OF_FORCES: f64 = 3e-2;
/// Armijo's condition: the fraction of the predicted decrease that a move must achieve.
const SUFFICIENT: f64 = 1e-4;
/// Largest stretch of a voxel after a move, unless it is stretched farther already: beyond the range of any elastomer.
const LARGEST_STRETCH: f64 = 20.0;
/// Largest change of a voxel's deformation gradient by one move: a rotation by `θ` along straight lines swells by `θ²`.
const LARGEST_CHANGE: f64 = 0.15;
/// Relative rounding of potentials, which are sums of many terms, and rounding relative to the energy of a unit strain:
/// small strains are found as differences.
const ROUNDING: f64 = 1e-12;
const ROUNDING_OF_STRAIN: f64 = 4e-15;
/// Smallest volume ratio of a voxel after a move, unless it is compressed more already.
const LEAST_VOLUME: f64 = 0.05;

/// End of a search for the minimum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// The last move was within the tolerance.
    Found,
    /// Most moves were taken, the last one being small enough in contact.
    Rough,
    /// Most moves were taken.
    Slow,
    /// No move along the direction decreases the potential.
    Stuck,
    /// The caller asked to stop.
    Cancelled,
}

/// Search for the minimum.
pub(super) struct Search<'a> {
    pub objective: Objective<'a>,
    pub lagged: &'a mut Lagged,
    pub memory: &'a mut QuasiNewtonMemory,
    /// Vertices on the floor, whose z coordinates do not move, besides the clamped ones.
    pub carried: &'a [bool],
    /// Tolerance of the last move.
    pub tolerance: Tolerance<'a>,
}

/// Tolerance of the last move of a search: relative to the motion of the step so far, and to the displacement by forces
/// from the force-free positions.
pub(super) struct Tolerance<'a> {
    /// Positions at the start of the step, m.
    pub from: &'a [Vec3],
    /// Force-free positions, m.
    pub free: &'a [Vec3],
    /// Smallest tolerance, m.
    pub least: f64,
    /// Factor on the tolerance after the most moves.
    pub rough: f64,
}

impl Tolerance<'_> {
    fn at(&self, positions: &[Vec3]) -> f64 {
        (MOVE_OF_STEP * farthest(positions, self.from))
            .min(MOVE_OF_FORCES * farthest(positions, self.free))
            .max(self.least)
    }
}

/// Largest distance between two places of a vertex.
fn farthest(a: &[Vec3], b: &[Vec3]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| norm(sub(*a, *b))).fold(0.0, f64::max)
}

impl Search<'_> {
    /// Minimizes from `positions` with `most` moves at most; `value` is that at `positions`, before and after.
    pub fn run(
        &mut self,
        positions: &mut Vec<Vec3>,
        value: &mut Value,
        most: u32,
        asker: &mut Asker<'_>,
    ) -> (End, u32) {
        let problem = self.objective.problem;
        let mut trial = Vec::with_capacity(positions.len());
        let mut next = Value::default();
        let mut force = self.free_force(positions, value);
        let mut extremes = Extremes::of(problem, positions);
        let mut last = f64::INFINITY;
        for taken in 0..most {
            if !asker(None) {
                return (End::Cancelled, taken);
            }
            self.lagged.turn(problem, positions, self.carried);
            let lagged = &*self.lagged;
            let direction = self
                .memory
                .direction(force.clone(), |side| lagged.apply(side));
            let mut moves = lagged.spread(&direction);
            make_rigid(problem, positions, &mut moves);
            let direction = lagged.gather(&moves);
            let gain = product(&direction, &force);
            if !(gain > 0.0) {
                // Zero force, or rounding.
                let end = if gain == 0.0 { End::Found } else { End::Stuck };
                return (end, taken);
            }
            let largest = moves.iter().map(|m| norm(*m)).fold(0.0, f64::max);
            let part = (LARGEST_CHANGE / largest_change(problem, &moves)).min(1.0);
            let mut line = Line::new(part, gain, problem.contact().is_some());
            loop {
                trial.clear();
                let pairs = positions.iter().zip(&moves);
                trial.extend(pairs.map(|(x, m)| add(*x, scale(line.part, *m))));
                restore(problem, &mut trial);
                let new = Extremes::of(problem, &trial);
                let mut outcome = Outcome::Unsound;
                if new.are_sound_after(extremes) {
                    self.objective.evaluate(&trial, &mut next);
                    if self.is_stable(&next) {
                        let asked = value.potential - SUFFICIENT * line.part * gain;
                        let low = next.potential <= asked + self.rounding(value, &next);
                        outcome = if low { Outcome::Lower } else { Outcome::TooFar };
                    }
                }
                let slope = || -product(&direction, &self.free_force(&trial, &next));
                match line.after(outcome, slope) {
                    Then::Take => {
                        extremes = new;
                        break;
                    }
                    Then::TryAgain => {}
                    Then::GiveUp => {
                        let nothing = gain <= self.rounding(value, value);
                        return (if nothing { End::Found } else { End::Stuck }, taken);
                    }
                }
            }
            let part = line.part;
            std::mem::swap(positions, &mut trial);
            std::mem::swap(value, &mut next);
            let after = self.free_force(positions, value);
            let change = force.iter().zip(&after).map(|(a, b)| a - b).collect();
            let step = direction.iter().map(|d| part * d).collect();
            self.memory.note(step, change, part * part * gain);
            force = after;
            // A shortened move does not show the distance from the minimum.
            last = if line.is_whole() {
                part * largest
            } else {
                f64::INFINITY
            };
            if last <= self.tolerance.at(positions) {
                return (End::Found, taken + 1);
            }
        }
        let rough = last <= self.tolerance.rough * self.tolerance.at(positions);
        (if rough { End::Rough } else { End::Slow }, most)
    }

    /// Rounding of potentials, in J.
    fn rounding(&self, a: &Value, b: &Value) -> f64 {
        let unit = self.objective.problem.body().unit_strain_energy();
        ROUNDING * a.size.max(b.size) + ROUNDING_OF_STRAIN * unit
    }

    /// Tests whether the material is stable: constants that were fitted to some range may have negative energy beyond
    /// it.
    fn is_stable(&self, value: &Value) -> bool {
        let unit = self.objective.problem.body().unit_strain_energy();
        value.energy >= -NEGLIGIBLE_STRAIN.powi(2) * unit
    }

    /// Minus the gradient on free coordinates.
    fn free_force(&self, positions: &[Vec3], value: &Value) -> Vec<f64> {
        let problem = self.objective.problem;
        let mut force = if problem.rigid().is_empty() {
            self.lagged.gather(&value.net)
        } else {
            let mut net = value.net.clone();
            make_rigid(problem, positions, &mut net);
            self.lagged.gather(&net)
        };
        for (vertex, _) in self.carried.iter().enumerate().filter(|(_, c)| **c) {
            if let Some(row) = self.lagged.row_of(vertex, 2) {
                force[row] = 0.0;
            }
        }
        force
    }
}

/// Largest norm of the change of a voxel's deformation gradient, by rotation or strain.
fn largest_change(problem: &Problem, moves: &[Vec3]) -> f64 {
    let size = |hex8: &voxsoft_solid::Hex8| {
        let change = hex8.deformation(problem.body().material_of(hex8), moves);
        change
            .as_flattened()
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt()
    };
    let hex8s = problem.body().hex8s().iter();
    hex8s.map(size).fold(0.0, f64::max)
}

/// Smallest volume ratio and largest stretch among voxels.
#[derive(Clone, Copy)]
struct Extremes {
    volume: f64,
    stretch: f64,
}

impl Extremes {
    fn of(problem: &Problem, positions: &[Vec3]) -> Self {
        let start = Self {
            volume: f64::INFINITY,
            stretch: 0.0,
        };
        problem.body().hex8s().iter().fold(start, |so_far, hex8| {
            let material = problem.body().material_of(hex8);
            let deformation = hex8.deformation(material, positions);
            let squares = deformation.as_flattened().iter().map(|x| x * x);
            Self {
                volume: so_far.volume.min(determinant(&deformation)),
                stretch: so_far.stretch.max(squares.sum::<f64>().sqrt()),
            }
        })
    }

    fn are_sound_after(self, before: Self) -> bool {
        self.volume > LEAST_VOLUME.min(before.volume)
            && self.stretch < LARGEST_STRETCH.max(before.stretch)
    }
}
