//! Newton's method with the load factor as an unknown, shared by arc length and volume control.
//!
//! Equilibrium `r(x, s) = 0` comes with one more equation `c(x, s) = 0`, the constraint. A step of the bordered system
//! takes two solutions with the same tangent, `K a = r` and `K b = ∂r/∂s`: `δx = a + b δs`, and the constraint gives
//! `δs` (Riks 1979, doi 10.1016/0020-7683(79)90081-7). The tangent may be indefinite; it is singular only at single
//! points of the path. Clamps that move with the load are part of `∂r/∂s`.
//!
//! Mixed iterations, with strains as unknowns ([`voxsoft_solid::element::assumed_strain`]), come first; they are quick
//! but may cycle, for example where layers change between taut and wrinkled. From their best state a line search
//! continues: if the equilibria are minima of an energy among all states that satisfy the constraint, on the augmented
//! Lagrangian `Π − s c + ρ/2 c²` (Nocedal and Wright 2006, chapter 17, doi 10.1007/978-0-387-40065-5); otherwise, which
//! only contact needs, on the residual. The file is long because both methods share the evaluation of a state and the
//! steps.

use voxsoft_solid::element::assumed_strain::AssumedStrains;
use voxsoft_solid::vector::{Vec3, add, norm, scale};
use voxsoft_solid::{Observer, Problem};

use crate::linear::system::Factor;
use crate::linear::vectors::product;
use crate::path::contact_loop::{Round, Search};
use crate::path::equilibrium::{Equilibrium, Failure, Forces, Found};
use crate::path::load_parameter::LoadParameter;
use crate::path::settings::Settings;

/// Relative tolerance of the constraint.
const KEPT: f64 = 1e-9;
/// Most mixed iterations: most steps take less than ten.
const MIXED_ITERATIONS: u32 = 30;
/// Mixed iterations without halving the residual, after which they count as diverged.
const PATIENCE: u32 = 6;
/// Most iterations with a line search.
const SEARCHED_ITERATIONS: u32 = 60;
/// Smallest and largest relative shift of the diagonal.
const LEAST_SHIFT: f64 = 1e-6;
const LARGEST_SHIFT: f64 = 10.0;
/// Armijo's condition: the fraction of the predicted decrease that a step must achieve.
const SUFFICIENT: f64 = 1e-4;
/// Most halvings of a step.
const HALVINGS: u32 = 14;
/// Relative rounding of energies, which are sums of many terms.
const ROUNDING: f64 = 1e-12;
/// Largest move of a vertex in an iteration, in sizes of the body: beyond it the iteration counts as diverged. It is
/// smaller with contact, because candidates on such a way would be listed without any use.
const FARTHEST: f64 = 1.0;
const FARTHEST_WITH_CONTACT: f64 = 0.5;
/// Tolerance of iterative solutions for the displacements by the load factor: they are multiplied by its change, which
/// decreases with the residual.
pub(crate) const DIRECTION_TOLERANCE: f64 = 1e-4;
/// Change of the factor for the central difference of the velocity of clamps: rotations are accurate to its square.
const DIFFERENCE: f64 = 1e-4;

/// Load factor that is the unknown.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Unknown {
    All,
    Pressure,
}

impl Unknown {
    pub fn with(self, point: LoadParameter, factor: f64) -> LoadParameter {
        match self {
            Self::All => LoadParameter {
                time: point.time,
                ..LoadParameter::all(factor)
            },
            Self::Pressure => LoadParameter {
                pressure: factor,
                ..point
            },
        }
    }

    /// Factors that the unknown changes, at a time of all histories.
    fn direction(self, time: f64) -> LoadParameter {
        let factors = match self {
            Self::All => LoadParameter::all(1.0),
            Self::Pressure => LoadParameter::of(0.0, 1.0),
        };
        LoadParameter { time, ..factors }
    }
}

/// Additional equation along a path.
pub(crate) trait Constraint: Clone {
    /// Load factor that is the unknown.
    fn unknown(&self) -> Unknown;

    /// Constraint violation at a state.
    fn missing(&self, problem: &Problem, positions: &[Vec3], factor: f64) -> Missing;

    /// Derivatives with respect to free coordinates and to the factor.
    fn gradient(&self, equilibrium: &Equilibrium, positions: &[Vec3]) -> (Vec<f64>, f64);

    /// Tests whether equilibria are stationary points of an energy on the constraint, with the factor as Lagrange
    /// multiplier.
    fn has_potential(&self, problem: &Problem) -> bool;

    /// Longest move of a coordinate (m) that a correction may take.
    fn longest_correction(&self) -> f64 {
        f64::INFINITY
    }
}

/// Constraint violation, in its own unit and relative to the prescribed value.
#[derive(Clone, Copy)]
pub(crate) struct Missing {
    pub size: f64,
    pub relative: f64,
}

/// Search for the equilibrium that satisfies a constraint.
#[derive(Clone)]
pub(crate) struct Bordered<C> {
    pub constraint: C,
    pub point: LoadParameter,
}

impl<C: Constraint> Search for Bordered<C> {
    fn point(&self) -> LoadParameter {
        self.point
    }

    fn find(
        &mut self,
        equilibrium: &mut Equilibrium,
        positions: &mut Vec<Vec3>,
        settings: &Settings,
        round: Round,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure> {
        let start = Iterate {
            positions: positions.clone(),
            factor: self.point.pressure,
            iterations: 0,
        };
        let touches = equilibrium.problem.contact().is_some();
        let searches = touches || self.constraint.has_potential(&equilibrium.problem);
        let mut newton = Newton {
            equilibrium,
            constraint: &self.constraint,
            point: self.point,
            settings,
            observer,
        };
        let mut now = start.clone();
        let mut seen = newton.find(&mut now, touches && !round.first, searches);
        if let Err(Failure::Stalled) = seen {
            newton.equilibrium.go_on_directly()?;
            now = start;
            seen = newton.find(&mut now, touches && !round.first, searches);
        }
        let seen = seen?;
        if !equilibrium.is_sound(&now.positions) {
            return Err(Failure::Lost);
        }
        self.point = seen.point;
        *positions = now.positions;
        Ok(Found {
            iterations: now.iterations,
            residual: seen.forces.relative(),
        })
    }
}

/// Derivative of the forces with respect to an unknown factor, on free coordinates, with clamps in place.
pub(crate) fn load_direction(
    equilibrium: &Equilibrium,
    positions: &[Vec3],
    point: LoadParameter,
    unknown: Unknown,
) -> Vec<f64> {
    let mut forces = vec![[0.0; 3]; positions.len()];
    let one = unknown.direction(point.time);
    let (factor_of, slope_of) = (point.factor_of(), one.factor_of());
    equilibrium
        .problem
        .add_load_slopes(positions, &factor_of, &slope_of, &mut forces);
    equilibrium.system.gather(&forces)
}

/// Velocity of clamps with respect to an unknown factor, for all vertices; `None` without moving clamps.
fn clamp_velocity(problem: &Problem, point: LoadParameter, unknown: Unknown) -> Option<Vec<Vec3>> {
    let moves = problem.clamps().iter().any(|clamp| clamp.motion.is_some());
    if unknown == Unknown::Pressure || !moves {
        return None;
    }
    let placed = |ramp: f64| {
        let mut positions = vec![[0.0; 3]; problem.body().rest().len()];
        problem.place_clamps(point.time, ramp, &mut positions);
        positions
    };
    let after = placed(point.dead + DIFFERENCE);
    let before = placed(point.dead - DIFFERENCE);
    let speed = |(a, b): (&Vec3, &Vec3)| [0, 1, 2].map(|i| (a[i] - b[i]) / (2.0 * DIFFERENCE));
    Some(after.iter().zip(&before).map(speed).collect())
}

/// Right-hand sides of both solutions on free coordinates.
pub(crate) struct Sides {
    residual: Vec<f64>,
    /// Load vector `∂r/∂s`, including moving clamps.
    direction: Vec<f64>,
    velocity: Option<Vec<Vec3>>,
}

/// State at which the tangent is assembled.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    pub positions: &'a [Vec3],
    pub point: LoadParameter,
    pub unknown: Unknown,
    pub strains: Option<&'a AssumedStrains>,
    /// Prescribed displacement increments of held coordinates.
    pub jump: Option<&'a [Vec3]>,
}

/// Assembles the tangent at a place, for which the contact pattern is up to date.
pub(crate) fn assemble(equilibrium: &mut Equilibrium, place: Place<'_>, residual: &[f64]) -> Sides {
    let Place {
        positions,
        point,
        unknown,
        strains,
        jump,
    } = place;
    equilibrium.iterations += 1;
    let mut direction = load_direction(equilibrium, positions, point, unknown);
    let mut residual = residual.to_vec();
    let velocity = clamp_velocity(&equilibrium.problem, point, unknown);
    let (system, problem) = (&mut equilibrium.system, &equilibrium.problem);
    let factor_of = point.factor_of();
    let mut put = |jump: Option<&[Vec3]>, side: &mut [f64]| {
        system.assemble(problem, positions, &factor_of, strains, jump, side);
    };
    if velocity.is_some() {
        put(velocity.as_deref(), &mut direction);
    }
    if velocity.is_none() || jump.is_some() {
        put(jump, &mut residual);
    }
    Sides {
        residual,
        direction,
        velocity,
    }
}

impl Sides {
    /// Solves for `a` and `b` with a factorized tangent; iterative solutions use the given tolerances.
    pub fn solve(
        &self,
        equilibrium: &Equilibrium,
        factor: &Factor,
        tolerances: [f64; 2],
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<(Vec<f64>, Vec<f64>), Failure> {
        let (mut a, mut b) = (self.residual.clone(), self.direction.clone());
        let system = &equilibrium.system;
        system.solve(factor, &mut a, false, tolerances[0], stop)?;
        let guess = equilibrium.by_load.as_deref();
        let guess = guess.filter(|guess| guess.len() == b.len());
        system.solve_from(factor, &mut b, guess, tolerances[1], stop)?;
        if a.iter().chain(&b).all(|x| x.is_finite()) {
            Ok((a, b))
        } else {
            Err(Failure::Singular)
        }
    }
}

/// State of Newton's method between two equilibria.
#[derive(Clone)]
struct Iterate {
    positions: Vec<Vec3>,
    factor: f64,
    iterations: u32,
}

impl Iterate {
    fn shift(&mut self, moves: &[Vec3], part: f64) {
        for (x, m) in self.positions.iter_mut().zip(moves) {
            *x = add(*x, scale(part, *m));
        }
    }
}

/// Evaluated state on the way to an equilibrium.
struct Seen {
    point: LoadParameter,
    forces: Forces,
    missing: Missing,
    /// Prescribed displacement increments that remain on held coordinates.
    jump: Option<Vec<Vec3>>,
}

impl Seen {
    /// Sum of the relative violations of both equations.
    fn both(&self) -> f64 {
        self.forces.relative() + self.missing.relative
    }

    fn is_solved(&self, settings: &Settings) -> bool {
        self.jump.is_none()
            && self.forces.relative() <= settings.tolerance
            && self.missing.relative <= KEPT
    }
}

/// Solution of the bordered system.
struct Step {
    free: Vec<f64>,
    change: f64,
    /// Curvature `δ·K δ` (J).
    curvature: f64,
    /// Derivative of the constraint with respect to the factor along the path of equilibria.
    compliance: f64,
}

/// Penalty and shift kept from one line-search iteration to the next.
#[derive(Default)]
struct IterateMemory {
    penalty: f64,
    shift: f64,
}

/// Newton's method on both equations.
struct Newton<'n, 'o, C> {
    equilibrium: &'n mut Equilibrium,
    constraint: &'n C,
    /// Point of the path, in which the unknown factor is replaced.
    point: LoadParameter,
    settings: &'n Settings,
    observer: &'n mut Observer<'o>,
}

impl<C: Constraint> Newton<'_, '_, C> {
    /// Finds the equilibrium: from a `near` one with a line search first, otherwise with one last if the problem
    /// `searches`.
    fn find(&mut self, now: &mut Iterate, near: bool, searches: bool) -> Result<Seen, Failure> {
        if near {
            // Friction may begin to slip there, and iterations without a line search overshoot.
            let start = now.clone();
            return match self.searched(now) {
                Err(Failure::Lost | Failure::Singular) => {
                    *now = start;
                    self.mixed(now)
                }
                other => other,
            };
        }
        match self.mixed(now) {
            Err(Failure::Lost) if now.iterations > 0 && searches => self.searched(now),
            other => other,
        }
    }

    /// Evaluates both equations, updates the contact pattern of the tangent, and notifies the observer.
    fn look(&mut self, positions: &[Vec3], factor: f64) -> Result<Seen, Failure> {
        self.equilibrium.follow_contact(positions)?;
        let point = self.constraint.unknown().with(self.point, factor);
        let (forces, jump) = self.equilibrium.look(positions, point, self.observer)?;
        let problem = &self.equilibrium.problem;
        let missing = self.constraint.missing(problem, positions, factor);
        if !missing.size.is_finite() {
            return Err(Failure::Lost);
        }
        Ok(Seen {
            point,
            forces,
            missing,
            jump,
        })
    }

    fn place<'p>(
        &self,
        now: &'p Iterate,
        seen: &'p Seen,
        strains: Option<&'p AssumedStrains>,
    ) -> Place<'p> {
        Place {
            positions: &now.positions,
            point: seen.point,
            unknown: self.constraint.unknown(),
            strains,
            jump: seen.jump.as_deref(),
        }
    }

    /// Solves the bordered system with a factorized tangent.
    fn step(
        &mut self,
        factor: &Factor,
        sides: &Sides,
        now: &Iterate,
        seen: &Seen,
    ) -> Result<Step, Failure> {
        let relative = seen.forces.relative();
        let tolerances = [
            self.equilibrium.linear_tolerance(relative, self.settings),
            DIRECTION_TOLERANCE,
        ];
        let (equilibrium, observer) = (&*self.equilibrium, &mut *self.observer);
        let mut stop = || {
            equilibrium
                .tell(&now.positions, seen.point, relative, observer)
                .is_err()
        };
        let (a, b) = sides.solve(equilibrium, factor, tolerances, &mut stop)?;
        self.equilibrium.by_load = Some(b.clone());
        let (across, along) = self.constraint.gradient(self.equilibrium, &now.positions);
        let compliance = product(&across, &b) + along;
        let change = (seen.missing.size - product(&across, &a)) / compliance;
        let free: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + change * b).collect();
        if !free.iter().all(|x| x.is_finite()) {
            return Err(Failure::Singular);
        }
        let curvature = product(&free, &sides.residual) + change * product(&free, &sides.direction);
        Ok(Step {
            free,
            change,
            curvature,
            compliance,
        })
    }

    /// Moves of all vertices in a step, held ones included.
    fn moves(&self, step: &Step, sides: &Sides, seen: &Seen) -> Vec<Vec3> {
        let mut moves = self.equilibrium.system.spread(&step.free);
        let mut shift = |by: &[Vec3], part: f64| {
            for (m, by) in moves.iter_mut().zip(by) {
                *m = add(*m, scale(part, *by));
            }
        };
        sides.velocity.iter().for_each(|by| shift(by, step.change));
        seen.jump.iter().for_each(|by| shift(by, 1.0));
        moves
    }

    /// Puts clamps exactly at their targets for the factor.
    fn place_clamps(&self, now: &mut Iterate) {
        if self.constraint.unknown() == Unknown::All {
            let problem = &self.equilibrium.problem;
            let (time, ramp) = (self.point.time, now.factor);
            problem.place_clamps(time, ramp, &mut now.positions);
        }
    }

    /// Factorizes the tangent for a mixed iteration. With contact, more than one negative pivot counts as divergence;
    /// one is expected past a limit.
    fn carried(&mut self) -> Result<Factor, Failure> {
        let factor = self.equilibrium.system.factor(0.0)?;
        let problem = &self.equilibrium.problem;
        let astray = problem.contact().is_some()
            && self.constraint.has_potential(problem)
            && self.equilibrium.system.negative_pivots(&factor) > Some(1);
        if astray {
            Err(Failure::Lost)
        } else {
            Ok(factor)
        }
    }

    fn farthest(&self) -> f64 {
        let size = self.equilibrium.problem.body().size();
        match self.equilibrium.problem.contact() {
            Some(_) => FARTHEST_WITH_CONTACT * size + self.equilibrium.largest_motion,
            None => FARTHEST * size + self.equilibrium.largest_motion,
        }
    }

    /// Mixed iterations, with strains as unknowns. If they diverge, `now` is their best state.
    fn mixed(&mut self, now: &mut Iterate) -> Result<Seen, Failure> {
        let mut at = now.clone();
        let mut strains: Option<AssumedStrains> = None;
        let (mut best, mut lowest, mut since_lowest) = (f64::INFINITY, f64::INFINITY, 0);
        for iteration in 0..=MIXED_ITERATIONS {
            let seen = self.look(&at.positions, at.factor)?;
            // A step begins at an equilibrium, whose residual is no measure.
            let both = seen.both();
            if iteration > 0 && both < best {
                best = both;
                now.clone_from(&at);
                now.iterations = iteration;
            }
            if seen.is_solved(self.settings) {
                now.clone_from(&at);
                now.iterations = iteration;
                return Ok(seen);
            }
            since_lowest += 1;
            if iteration > 0 && both < 0.5 * lowest {
                (lowest, since_lowest) = (both, 0);
            }
            if since_lowest > PATIENCE {
                return Err(Failure::Lost);
            }
            let residual = match &strains {
                Some(strains) => {
                    self.equilibrium
                        .predicted_forces(strains, &at.positions, seen.point)
                }
                None => seen.forces.free.clone(),
            };
            let place = self.place(&at, &seen, strains.as_ref());
            let sides = assemble(self.equilibrium, place, &residual);
            let factor = self.carried()?;
            let step = self.step(&factor, &sides, &at, &seen)?;
            let longest = step.free.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            if iteration > 2 && !(longest < self.constraint.longest_correction()) {
                return Err(Failure::Lost);
            }
            let moves = self.moves(&step, &sides, &seen);
            let largest = moves.iter().map(|m| norm(*m)).fold(0.0, f64::max);
            if !(largest < self.farthest()) {
                return Err(Failure::Lost);
            }
            if self.stands_still(&at, &seen, largest) {
                now.clone_from(&at);
                now.iterations = iteration;
                return Ok(seen);
            }
            let body = self.equilibrium.problem.body();
            strains = Some(match strains.take() {
                Some(strains) => strains.update(body, &at.positions, &moves),
                None => AssumedStrains::predict(body, &at.positions, &moves),
            });
            at.shift(&moves, 1.0);
            at.factor += step.change;
            self.place_clamps(&mut at);
        }
        Err(Failure::Lost)
    }

    /// Tests whether a step of the size `largest` (m) would change nothing but rounding.
    fn stands_still(&self, at: &Iterate, seen: &Seen, largest: f64) -> bool {
        let relative = seen.forces.relative();
        seen.missing.relative <= KEPT
            && self
                .equilibrium
                .stands_still(&at.positions, largest, relative)
    }

    /// Newton's method with a line search.
    fn searched(&mut self, now: &mut Iterate) -> Result<Seen, Failure> {
        let mut memory = IterateMemory::default();
        for _ in 0..SEARCHED_ITERATIONS {
            let seen = self.look(&now.positions, now.factor)?;
            if seen.is_solved(self.settings) {
                return Ok(seen);
            }
            now.iterations += 1;
            let place = self.place(now, &seen, None);
            let sides = assemble(self.equilibrium, place, &seen.forces.free);
            let potential = self.constraint.has_potential(&self.equilibrium.problem);
            let step = if potential {
                self.descending(&sides, now, &seen, &mut memory)?
            } else {
                let factor = self.equilibrium.system.factor(0.0)?;
                self.step(&factor, &sides, now, &seen)?
            };
            let moves = self.moves(&step, &sides, &seen);
            let largest = moves.iter().map(|m| norm(*m)).fold(0.0, f64::max);
            if self.stands_still(now, &seen, largest) {
                return Ok(seen);
            }
            if seen.jump.is_some() {
                // A step that moves held coordinates may raise either measure.
                now.shift(&moves, 1.0);
                now.factor += step.change;
            } else if potential {
                self.along_energy(now, &step, &moves, &seen, memory.penalty)?;
            } else {
                self.along_residual(now, &step, &moves, &seen)?;
            }
        }
        Err(Failure::Lost)
    }

    /// Finds a step along which the augmented Lagrangian decreases, by `δ·K δ + ρ c²`: otherwise the diagonal is
    /// shifted. The penalty ρ only grows: to twice the stiffness of the factor against the constraint, so that it
    /// outweighs that of a balloon past its limit, which is negative.
    fn descending(
        &mut self,
        sides: &Sides,
        now: &Iterate,
        seen: &Seen,
        memory: &mut IterateMemory,
    ) -> Result<Step, Failure> {
        let mut trial = memory.shift / 10.0;
        loop {
            if trial < LEAST_SHIFT {
                trial = 0.0;
            }
            let factor = self.equilibrium.system.factor(trial)?;
            let step = self.step(&factor, sides, now, seen)?;
            memory.penalty = memory.penalty.max(2.0 / step.compliance.abs());
            if gain(&step, seen, memory.penalty) > 0.0 {
                memory.shift = trial;
                return Ok(step);
            }
            trial = (10.0 * trial).max(LEAST_SHIFT);
            if trial > LARGEST_SHIFT {
                return Err(Failure::Lost);
            }
        }
    }

    /// Line search along `moves` on the augmented Lagrangian.
    fn along_energy(
        &self,
        now: &mut Iterate,
        step: &Step,
        moves: &[Vec3],
        seen: &Seen,
        penalty: f64,
    ) -> Result<(), Failure> {
        // Lagrange multiplier of the constraint.
        let factor = now.factor + step.change;
        let point = self.constraint.unknown().with(self.point, factor);
        let merit = |positions: &[Vec3]| {
            let (potential, size) = self.equilibrium.potential(positions, point);
            let problem = &self.equilibrium.problem;
            let missing = self.constraint.missing(problem, positions, factor).size;
            (potential + 0.5 * penalty * missing * missing, size)
        };
        let (start, size) = merit(&now.positions);
        let falls = gain(step, seen, penalty);
        self.halve(now, step, moves, |trial, part| {
            let (end, end_size) = merit(&trial.positions);
            end <= start - SUFFICIENT * part * falls + ROUNDING * size.max(end_size)
        })
    }

    /// Line search along `moves` on the residual and the constraint violation.
    fn along_residual(
        &self,
        now: &mut Iterate,
        step: &Step,
        moves: &[Vec3],
        seen: &Seen,
    ) -> Result<(), Failure> {
        let problem = &self.equilibrium.problem;
        let unit = seen.forces.scale;
        let start = seen.both();
        self.halve(now, step, moves, |trial, part| {
            let point = self.constraint.unknown().with(self.point, trial.factor);
            let residual = self.equilibrium.forces(&trial.positions, point).residual;
            let missing = self
                .constraint
                .missing(problem, &trial.positions, trial.factor);
            residual / unit + missing.relative <= start * (1.0 - SUFFICIENT * part)
        })
    }

    /// Halves the step along `moves` until a state is good and no voxel inverted.
    fn halve(
        &self,
        now: &mut Iterate,
        step: &Step,
        moves: &[Vec3],
        is_good: impl Fn(&Iterate, f64) -> bool,
    ) -> Result<(), Failure> {
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            let mut trial = now.clone();
            trial.shift(moves, part);
            trial.factor += part * step.change;
            self.place_clamps(&mut trial);
            if is_good(&trial, part) && self.equilibrium.is_sound(&trial.positions) {
                *now = trial;
                return Ok(());
            }
            part /= 2.0;
        }
        Err(Failure::Lost)
    }
}

/// Predicted decrease of the augmented Lagrangian along a step (J).
fn gain(step: &Step, seen: &Seen, penalty: f64) -> f64 {
    step.curvature + penalty * seen.missing.size * seen.missing.size
}
