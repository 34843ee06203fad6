//! Quasi-Newton steps down the potential of a time step.

use voxsoft_solid::balance::NEGLIGIBLE_STRAIN;
use voxsoft_solid::matrix::determinant;
use voxsoft_solid::vector::{Vec3, add, norm, scale, sub};
use voxsoft_solid::{Ask, Problem};

use super::contact::{make_rigid, restore};
use super::lagged::Lagged;
use super::line::{Line, Outcome, Then};
use super::objective::{Objective, Value};
use super::quasi_newton::{Memory, product};

/// The parts of [`Tolerance`].
const MOVE_OF_STEP: f64 = 1e-2;
const MOVE_OF_FORCES: f64 = 3e-2;
/// Armijo's condition: the part of the predicted gain that a move must bring.
const SUFFICIENT: f64 = 1e-4;
/// The largest stretch of a voxel after a move, unless it is stretched farther already: no elastomer follows.
const LARGEST_STRETCH: f64 = 20.0;
/// How far one move may turn or strain a voxel: what turns by `θ` in a straight line swells by `θ²`.
const LARGEST_CHANGE: f64 = 0.15;
/// Potentials are sums of many terms and known to about this part of their size, and of the energy of a strain of one:
/// small strains are found as differences.
const ROUNDING: f64 = 1e-12;
const ROUNDING_OF_STRAIN: f64 = 4e-15;
/// The least volume ratio of a voxel after a move, unless it is pressed flatter already.
const LEAST_VOLUME: f64 = 0.05;

/// How a search for the minimum ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// The last move was as small as asked.
    Found,
    /// As many moves as allowed, the last one being small enough where surfaces touch.
    Rough,
    /// As many moves as allowed.
    Slow,
    /// No move along the direction helps.
    Stuck,
    /// The caller asked to stop.
    Cancelled,
}

/// A search for the minimum.
pub(super) struct Search<'a> {
    pub objective: Objective<'a>,
    pub lagged: &'a mut Lagged,
    pub memory: &'a mut Memory,
    /// Coordinates that do not move besides the clamped ones: vertices on the floor.
    pub carried: &'a [bool],
    /// After which move it ends.
    pub tolerance: Tolerance<'a>,
}

/// How small the last move of a search must be: as a part of how far the step has come, and of how far forces have
/// driven it from where the body would be without them.
pub(super) struct Tolerance<'a> {
    /// The positions that the step starts from, m.
    pub from: &'a [Vec3],
    /// Where the body would be without forces, m.
    pub free: &'a [Vec3],
    /// What is small in any case, m.
    pub least: f64,
    /// How many times as large a last move may be that ends a search which has taken as many as allowed.
    pub rough: f64,
}

impl Tolerance<'_> {
    fn at(&self, positions: &[Vec3]) -> f64 {
        (MOVE_OF_STEP * farthest(positions, self.from))
            .min(MOVE_OF_FORCES * farthest(positions, self.free))
            .max(self.least)
    }
}

/// The largest distance between two places of a vertex.
fn farthest(a: &[Vec3], b: &[Vec3]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| norm(sub(*a, *b))).fold(0.0, f64::max)
}

impl Search<'_> {
    /// Goes down from `positions`, at most as many moves; `value` is that at `positions`, before and after.
    pub fn run(
        &mut self,
        positions: &mut Vec<Vec3>,
        value: &mut Value,
        most: u32,
        go_on: &mut dyn FnMut(Ask) -> bool,
    ) -> (End, u32) {
        let problem = self.objective.problem;
        let mut trial = Vec::with_capacity(positions.len());
        let mut next = Value::default();
        let mut force = self.free_force(positions, value);
        let mut extremes = Extremes::of(problem, positions);
        let mut last = f64::INFINITY;
        for taken in 0..most {
            if !go_on(Ask::Within) {
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
                // A force of zero, or rounding.
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
            // A move that had to be shortened does not show how near the minimum is.
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

    /// What potentials are known to, in J.
    fn rounding(&self, a: &Value, b: &Value) -> f64 {
        let unit = self.objective.problem.body().unit_strain_energy();
        ROUNDING * a.size.max(b.size) + ROUNDING_OF_STRAIN * unit
    }

    /// Whether the material still resists: constants that were fitted to some range may promise energy beyond it.
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

/// The largest norm of the change of a voxel's deformation gradient: how far it is turned or strained.
fn largest_change(problem: &Problem, moves: &[Vec3]) -> f64 {
    let size = |brick: &voxsoft_solid::Brick| {
        let change = brick.deformation(problem.body().material_of(brick), moves);
        change
            .as_flattened()
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt()
    };
    let bricks = problem.body().bricks().iter();
    bricks.map(size).fold(0.0, f64::max)
}

/// The least ratio of volumes and the largest stretch among voxels.
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
        problem.body().bricks().iter().fold(start, |so_far, brick| {
            let material = problem.body().material_of(brick);
            let deformation = brick.deformation(material, positions);
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
