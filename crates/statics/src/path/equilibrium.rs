//! Newton's method at one point of the load path. The file is long because its two variants share the first iteration,
//! the test for a standstill, and the change from iterative to direct solutions.

use std::ops::ControlFlow;
use std::sync::Arc;

use voxsoft_solid::balance::NEGLIGIBLE_STRAIN;
use voxsoft_solid::element::assumed_strain::AssumedStrains;
use voxsoft_solid::matrix::axial;
use voxsoft_solid::vector::{Vec3, add, norm, scale, sub};
use voxsoft_solid::{Body, Fluid, Hex8, Observer, Problem, Progress, elastic};

use crate::inertia::Inertia;
use crate::linear::error::FactorError;
use crate::linear::options::LinearOptions;
use crate::linear::options::LinearSolver;
use crate::linear::system::{Factor, System};
use crate::path::load_parameter::LoadParameter;
use crate::path::settings::Settings;

/// Reasons why Newton's method stopped without an equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Failure {
    /// It diverged, or converged too slowly.
    Lost,
    /// The tangent stays singular.
    Singular,
    /// The tangent takes more memory than available, in bytes.
    Memory(u64),
    /// The observer asked to stop.
    Cancelled,
    /// The conjugate gradients of a linear system stalled.
    Stalled,
    /// The linear prediction turns a voxel by this angle (rad), more than allowed.
    Turned(f64),
}

impl From<FactorError> for Failure {
    fn from(error: FactorError) -> Self {
        match error {
            FactorError::Memory(bytes) => Self::Memory(bytes),
            FactorError::NotPositive | FactorError::Singular => Self::Singular,
            FactorError::Stalled => Self::Stalled,
            FactorError::Cancelled => Self::Cancelled,
        }
    }
}

/// Variant of Newton's method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Strategy {
    /// Mixed, with strains as unknowns ([`voxsoft_solid::element::assumed_strain`]).
    Newton,
    /// Mixed, then, if that diverges, with a line search.
    NewtonThenLineSearch,
    /// Line search first: from an equilibrium with contact multipliers that were corrected since. It is near, but
    /// friction may begin to slip there, and iterations without a line search overshoot.
    LineSearch,
}

/// Result of a converged Newton iteration.
pub(crate) struct Found {
    pub iterations: u32,
    pub residual: f64,
}

/// Result of iterations that predict the multipliers of contact.
pub(crate) enum Predicted {
    Found(Found),
    /// They do not converge.
    Lost,
    /// There is no contact whose multipliers can be predicted.
    Impossible,
}

/// Net forces at some positions.
pub(crate) struct Forces {
    /// Residual on free coordinates.
    pub free: Vec<f64>,
    /// Norm of the residual.
    pub residual: f64,
    /// Norm of the forces to which the residual is relative.
    pub scale: f64,
}

impl Forces {
    pub fn relative(&self) -> f64 {
        self.residual / self.scale
    }
}

/// Problem with its tangent, and the active set of vertices on the floor.
pub(crate) struct Equilibrium {
    /// Copy of the problem, with its own memory of the current state.
    pub problem: Problem,
    pub system: System,
    /// Solver and memory limit of linear systems.
    pub options: LinearOptions,
    /// Coordinates held by clamps or carried by the floor.
    pub held: Vec<[bool; 3]>,
    pub iterations: u32,
    pub back_offs: u32,
    /// Largest rotation of a voxel (rad) from rest in the linear prediction, as long as only that is known of the body.
    pub largest_turn: Option<f64>,
    /// Initial pressures in the hyperelastic voxels in Pa, used by the first iteration in place of those of its
    /// positions.
    pub opening: Option<Vec<f64>>,
    /// Inertia of a body in motion, whose forces enter the scale of the residual.
    pub inertia: Option<Arc<Inertia>>,
    /// Forces in N that are negligible.
    pub negligible: f64,
    /// Requested precision of contact, relative to its default tolerances.
    pub precision: f64,
    /// Farthest motion of a vertex by a clamp, m.
    pub largest_motion: f64,
    /// Last solution for the displacements by the unknown load factor, a guess for the next one.
    pub by_load: Option<Vec<f64>>,
    /// True if rigid objects move freely: the distance of their motion then gives no measure of rounding in their stiff
    /// springs.
    pub has_loose: bool,
    /// True if surfaces press on each other at the positions of an iteration, for iterative solutions.
    pub presses: bool,
    /// True while iterations predict the multipliers of contact ([`Equilibrium::newton_predicted`]).
    pub predicts: bool,
}

/// Most mixed iterations: most steps take less than ten.
pub(crate) const MIXED_ITERATIONS: u32 = 25;
/// Mixed iterations without halving the residual, after which they count as diverged, unless it was just halved: nearly
/// incompressible bodies have intermediate residuals of thousands of times the load.
pub(crate) const PATIENCE: u32 = 8;
/// Iterations with contact without halving the residual, once it was below [`NEARBY`], after which a line search
/// continues from there: near the solution, samples that open and close in turn make full steps cycle.
const TO_AND_FRO: u32 = 3;
const NEARBY: f64 = 0.01;
/// Largest move of a vertex in an iteration, in sizes of the body; beyond it the iteration counts as diverged.
const FARTHEST: f64 = 20.0;
/// Largest move with contact. Candidates on a longer way would be listed without any use.
const FARTHEST_WITH_CONTACT: f64 = 0.5;
/// Largest relative shift of the diagonal: beyond it a step is a step of steepest descent.
const LARGEST_SHIFT: f64 = 10.0;
/// Armijo's condition: the fraction of the predicted decrease that a step must achieve.
const SUFFICIENT: f64 = 1e-4;
/// Relative tolerance of iterative solutions of a step, in the energy norm. Slender bodies, whose first steps go far,
/// take twice the steps with 1e-3, and none fewer with 1e-5.
const LINEAR_TOLERANCE: f64 = 1e-4;
/// Tolerance with contact, whose penalties take most of that energy.
const LINEAR_TOLERANCE_WITH_CONTACT: f64 = 1e-6;
/// Fraction of the final residual that the last linear solution may leave: energies and residuals decrease alike, but
/// not together. A step is the last if solutions to such a tolerance ([`AT_ONCE`]) are nearly as cheap as all others.
const LAST_PART: f64 = 0.1;
const AT_ONCE: f64 = 1e-6;
const LOOSEST: f64 = 0.1;
/// Most halvings of a step.
const HALVINGS: u32 = 12;
/// Relative rounding of potentials, which are sums of many terms.
const ROUNDING: f64 = 1e-12;
/// Newton step, relative to the body or to its motion so far, that counts as rounding: Newton's method squares its
/// error, so that the residual cannot decrease any more.
const STANDSTILL: f64 = 1e-13;
const STANDSTILL_OF_MOTION: f64 = 1e-9;
/// Largest relative residual at a standstill: rounding of stiff parts, over a small load.
const STANDSTILL_RESIDUAL: f64 = 1e-4;
/// Most iterations in a row with a tangent that is kept, in a motion. Each takes about a tenth of the time of one with
/// its own tangent and direct factor.
const KEPT: i32 = 3;
/// Expected reduction of the residual by an iteration with the tangent of the last one, over the reduction by that one:
/// Newton's method squares the error `e`, so that it leaves `C e`, and the tangent at its start is off by `2 C e`.
const KEPT_OVER_OWN: f64 = 2.0;

impl Equilibrium {
    pub fn new(problem: Problem, options: LinearOptions) -> Result<Self, FactorError> {
        let mut held = problem.held().to_vec();
        if let Some(floor) = problem.floor() {
            for (held, point) in held.iter_mut().zip(problem.body().rest()) {
                held[2] |= floor.touches(point[2]);
            }
        }
        Ok(Self {
            system: System::new(&problem, &held, options)?,
            options,
            largest_motion: largest_motion(&problem),
            problem,
            held,
            iterations: 0,
            back_offs: 0,
            largest_turn: None,
            opening: None,
            inertia: None,
            negligible: 0.0,
            precision: 1.0,
            by_load: None,
            has_loose: false,
            presses: false,
            predicts: false,
        })
    }

    /// Updates the contact pattern of the tangent for the pairs at `positions`; returns true if it has changed.
    pub fn follow_contact(&mut self, positions: &[Vec3]) -> Result<bool, FactorError> {
        let contact = self.problem.contact_mut();
        let changed = contact.is_some_and(|contact| contact.follow(positions));
        if changed {
            self.system = System::new(&self.problem, &self.held, self.options)?;
        }
        // Only iterative solutions ask, and only their bodies are so large that it costs little beside them.
        let contact = self
            .problem
            .contact()
            .filter(|_| self.system.is_iterative());
        self.presses = contact.is_some_and(|contact| contact.is_touching(positions));
        Ok(changed)
    }

    /// Net forces at `positions`, with their norm and scale.
    pub fn forces(&self, positions: &[Vec3], point: LoadParameter) -> Forces {
        let mut external = vec![[0.0; 3]; positions.len()];
        self.problem
            .add_scaled_loads(positions, &point.factor_of(), &mut external);
        let square = |forces: &[Vec3]| forces.as_flattened().iter().map(|f| f * f).sum::<f64>();
        let applied = square(&external);
        let mut net = external;
        elastic::add_forces(self.problem.body(), positions, &mut net);
        let free = self.system.gather(&net);
        let residual: f64 = free.iter().map(|f| f * f).sum();
        let supported = square(&net) - residual;
        let negligible = NEGLIGIBLE_STRAIN * self.problem.body().unit_strain_force();
        let scale = if applied > 0.0 { applied } else { supported };
        let inertial = self.inertia.as_ref();
        let inertial = inertial.map_or(0.0, |term| term.size(positions));
        Forces {
            free,
            residual: residual.sqrt(),
            scale: scale
                .sqrt()
                .max(inertial)
                .max(negligible)
                .max(self.negligible),
        }
    }

    /// Net forces on free coordinates with the elastic forces that `strains` predict.
    pub fn predicted_forces(
        &self,
        strains: &AssumedStrains,
        positions: &[Vec3],
        point: LoadParameter,
    ) -> Vec<f64> {
        let mut net = vec![[0.0; 3]; positions.len()];
        self.problem
            .add_scaled_loads(positions, &point.factor_of(), &mut net);
        strains.add_forces(self.problem.body(), positions, &mut net);
        self.system.gather(&net)
    }

    pub fn potential(&self, positions: &[Vec3], point: LoadParameter) -> (f64, f64) {
        let elastic = elastic::energy(self.problem.body(), positions);
        let loads = self.problem.load_potential(positions, &point.factor_of());
        (elastic + loads, elastic.abs() + loads.abs())
    }

    /// Prescribed displacement increments that remain on held coordinates.
    fn jump(&self, positions: &[Vec3], point: LoadParameter) -> Option<Vec<Vec3>> {
        let mut target = positions.to_vec();
        self.problem
            .place_clamps(point.time, point.dead, &mut target);
        if let Some(floor) = self.problem.floor() {
            for vertex in 0..target.len() {
                if self.held[vertex][2] && !self.problem.held()[vertex][2] {
                    target[vertex][2] = floor.z;
                }
            }
        }
        let jump: Vec<Vec3> = target
            .iter()
            .zip(positions)
            .map(|(t, x)| sub(*t, *x))
            .collect();
        jump.iter().flatten().any(|x| *x != 0.0).then_some(jump)
    }

    /// Finds the equilibrium at `point` from `positions`, which it changes.
    pub fn newton(
        &mut self,
        positions: &mut Vec<Vec3>,
        point: LoadParameter,
        settings: &Settings,
        strategy: Strategy,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure> {
        let start = positions.clone();
        let mut outcome = self.newton_by(strategy, positions, point, settings, observer);
        if let Err(Failure::Stalled) = outcome {
            self.go_on_directly()?;
            positions.clone_from(&start);
            outcome = self.newton_by(strategy, positions, point, settings, observer);
        }
        if outcome.is_err() {
            *positions = start;
        }
        outcome
    }

    /// Finds the equilibrium at `point` from `positions`, which it changes, with multipliers of contact that each
    /// iteration predicts; all is as before where it finds none.
    pub fn newton_predicted(
        &mut self,
        positions: &mut Vec<Vec3>,
        point: LoadParameter,
        settings: &Settings,
        observer: &mut Observer<'_>,
    ) -> Result<Predicted, Failure> {
        let contact = self.problem.contact_mut();
        if !contact.is_some_and(|contact| contact.begin_prediction()) {
            return Ok(Predicted::Impossible);
        }
        let opening = self.opening.clone();
        self.predicts = true;
        let outcome = self.newton(positions, point, settings, Strategy::Newton, observer);
        self.predicts = false;
        if let Some(contact) = self.problem.contact_mut() {
            contact.end_prediction(outcome.is_ok());
        }
        if !matches!(outcome, Err(Failure::Lost | Failure::Singular)) {
            return outcome.map(Predicted::Found);
        }
        self.opening = opening;
        Ok(Predicted::Lost)
    }

    /// Switches to the direct solver, if that fits in memory.
    pub fn go_on_directly(&mut self) -> Result<(), FactorError> {
        self.options.solver = LinearSolver::Direct;
        self.system = System::new(&self.problem, &self.held, self.options)?;
        Ok(())
    }

    fn newton_by(
        &mut self,
        strategy: Strategy,
        positions: &mut Vec<Vec3>,
        point: LoadParameter,
        settings: &Settings,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure> {
        let start = positions.clone();
        let outcome = match strategy {
            Strategy::Newton | Strategy::NewtonThenLineSearch => {
                self.newton_mixed(positions, point, settings, observer)
            }
            Strategy::LineSearch => self.newton_searched(positions, point, settings, observer),
        };
        if !matches!(outcome, Err(Failure::Lost | Failure::Singular))
            || strategy == Strategy::Newton
        {
            return outcome;
        }
        *positions = start;
        if strategy == Strategy::LineSearch {
            self.newton_mixed(positions, point, settings, observer)
        } else {
            self.newton_searched(positions, point, settings, observer)
        }
    }

    /// Sets the pressures of a fluid as unknowns for the rest of an iteration: they determine its forces and stiffness,
    /// while a state is judged by its own.
    fn carry(&mut self, pressures: Option<Vec<f64>>) {
        if let Some(fluid) = self.problem.fluid_mut() {
            fluid.carry(pressures);
        }
    }

    fn newton_mixed(
        &mut self,
        positions: &mut Vec<Vec3>,
        point: LoadParameter,
        settings: &Settings,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure> {
        let found = self.iterate_mixed(positions, point, settings, observer);
        self.carry(None);
        found
    }

    fn iterate_mixed(
        &mut self,
        positions: &mut Vec<Vec3>,
        point: LoadParameter,
        settings: &Settings,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure> {
        let opening = self.opening.take();
        let mut strains =
            opening.map(|p| AssumedStrains::with_pressures(self.problem.body(), positions, &p));
        let stiff = self.problem.fluid().filter(|fluid| fluid.is_stiff());
        let mut carried = stiff.map(Fluid::last_pressures);
        let is_stiff = carried.is_some();
        let mut lowest = f64::INFINITY;
        let mut since_lowest = 0;
        let mut previous = f64::INFINITY;
        let mut last: Option<(Factor, f64)> = None;
        let farthest = match self.problem.contact() {
            Some(_) => FARTHEST_WITH_CONTACT,
            None => FARTHEST,
        };
        for iteration in 0..=MIXED_ITERATIONS {
            if self.follow_contact(positions)? {
                last = None;
            }
            let (mut forces, jump) = self.look(positions, point, observer)?;
            let relative = forces.relative();
            if jump.is_none() && relative <= settings.tolerance {
                return Ok(Found {
                    iterations: iteration,
                    residual: relative,
                });
            }
            if is_stiff {
                self.carry(carried.take());
            }
            if let Some(strains) = &strains {
                forces.free = self.predicted_forces(strains, positions, point);
            } else if is_stiff {
                forces.free = self.forces(positions, point).free;
            }
            // While clamps have yet to move, the residual is that of the last equilibrium.
            if jump.is_none() {
                since_lowest += 1;
                if relative < 0.5 * lowest {
                    (lowest, since_lowest) = (relative, 0);
                }
            }
            // Predicted multipliers may raise the residual on their way.
            let fixed = self.problem.contact().is_some() && !self.predicts;
            if since_lowest > TO_AND_FRO && lowest < NEARBY && fixed {
                let found = self.newton_searched(positions, point, settings, observer)?;
                return Ok(Found {
                    iterations: iteration + found.iterations,
                    ..found
                });
            }
            if since_lowest > PATIENCE && relative > 0.5 * previous {
                return Err(Failure::Lost);
            }
            let reduction = relative / previous;
            previous = relative;
            self.iterations += 1;
            let may_keep = self.inertia.is_some() && jump.is_none() && !is_stiff;
            let kept = last.take().filter(|(_, over)| {
                may_keep && relative * (over * reduction).powi(KEPT) <= settings.tolerance
            });
            let (factor, over) = if let Some((factor, _)) = kept {
                // Strains that the last step predicted belong to its own tangent.
                if strains.take().is_some() {
                    forces.free = self.forces(positions, point).free;
                }
                (factor, 1.0)
            } else {
                self.system.assemble(
                    &self.problem,
                    positions,
                    &point.factor_of(),
                    strains.as_ref(),
                    jump.as_deref(),
                    &mut forces.free,
                );
                (self.carried()?, KEPT_OVER_OWN)
            };
            let side = &mut forces.free;
            let tolerance = self.linear_tolerance(relative, settings);
            let mut stop = || self.tell(positions, point, relative, observer).is_err();
            self.system
                .solve(&factor, side, false, tolerance, &mut stop)?;
            if !self.system.is_iterative() {
                last = Some((factor, over));
            }
            let mut moves = self.system.spread(&forces.free);
            if let Some(jump) = &jump {
                moves = moves.iter().zip(jump).map(|(a, b)| add(*a, *b)).collect();
            }
            let largest = moves.iter().map(|m| norm(*m)).fold(0.0, f64::max);
            if !(largest < farthest * self.problem.body().size() + self.largest_motion) {
                return Err(Failure::Lost);
            }
            if self.stands_still(positions, largest, relative) {
                return Ok(self.take_last(positions, &moves, point, iteration, relative));
            }
            if let Some(limit) = self.largest_turn.take() {
                let turn = largest_turn(self.problem.body(), positions, &moves);
                if turn > limit {
                    return Err(Failure::Turned(turn));
                }
            }
            let body = self.problem.body();
            strains = Some(match strains.take() {
                Some(strains) => strains.update(body, positions, &moves),
                None => AssumedStrains::predict(body, positions, &moves),
            });
            let stiff = self.problem.fluid().filter(|_| is_stiff);
            carried = stiff.map(|fluid| {
                fluid.carried_on(positions, fluid.instant(&point.factor_of()), &moves)
            });
            self.carry(None);
            if self.predicts
                && let Some(contact) = self.problem.contact_mut()
            {
                contact.take_prediction(positions, &moves);
            }
            for (x, m) in positions.iter_mut().zip(&moves) {
                *x = add(*x, *m);
            }
        }
        Err(Failure::Lost)
    }

    /// Evaluates the forces at the start of an iteration and the remaining displacement increments of clamps, and
    /// notifies the observer.
    pub fn look(
        &self,
        positions: &[Vec3],
        point: LoadParameter,
        observer: &mut Observer<'_>,
    ) -> Result<(Forces, Option<Vec<Vec3>>), Failure> {
        let forces = self.forces(positions, point);
        let relative = forces.relative();
        if !relative.is_finite() {
            return Err(Failure::Lost);
        }
        self.tell(positions, point, relative, observer)?;
        Ok((forces, self.jump(positions, point)))
    }

    /// Takes the step at a standstill too, if it still reduces the residual: stiff parts balance by moves far below the
    /// resolution of the motion of a slender body.
    fn take_last(
        &self,
        positions: &mut [Vec3],
        moves: &[Vec3],
        point: LoadParameter,
        iterations: u32,
        relative: f64,
    ) -> Found {
        let moved: Vec<Vec3> = positions
            .iter()
            .zip(moves)
            .map(|(x, m)| add(*x, *m))
            .collect();
        let residual = self.forces(&moved, point).relative();
        if residual < relative {
            positions.copy_from_slice(&moved);
            Found {
                iterations: iterations + 1,
                residual,
            }
        } else {
            Found {
                iterations,
                residual: relative,
            }
        }
    }

    /// Tests whether a step of the size `largest` (m) is nothing but rounding.
    pub fn stands_still(&self, positions: &[Vec3], largest: f64, relative: f64) -> bool {
        let body = self.problem.body();
        let moved = if self.has_loose {
            0.0
        } else {
            let pairs = positions.iter().zip(body.rest());
            let moved = pairs.map(|(x, rest)| norm(sub(*x, *rest)));
            moved.fold(0.0, f64::max)
        };
        is_standstill(relative, largest, body.size(), moved)
    }

    pub fn tell(
        &self,
        positions: &[Vec3],
        point: LoadParameter,
        residual: f64,
        observer: &mut Observer<'_>,
    ) -> Result<(), Failure> {
        let progress = Progress {
            problem: &self.problem,
            steps: u64::from(self.iterations),
            time: point.progress(),
            residual,
            positions,
            velocities: &[],
            record: false,
        };
        match observer(&progress) {
            ControlFlow::Break(()) => Err(Failure::Cancelled),
            ControlFlow::Continue(()) => Ok(()),
        }
    }

    fn newton_searched(
        &mut self,
        positions: &mut Vec<Vec3>,
        point: LoadParameter,
        settings: &Settings,
        observer: &mut Observer<'_>,
    ) -> Result<Found, Failure> {
        let size = self.problem.body().size();
        let limit = FARTHEST * size;
        let mut shift = 0.0f64;
        for iteration in 0..=settings.max_iterations {
            self.follow_contact(positions)?;
            let (mut forces, jump) = self.look(positions, point, observer)?;
            let relative = forces.relative();
            if jump.is_none() && relative <= settings.tolerance {
                return Ok(Found {
                    iterations: iteration,
                    residual: relative,
                });
            }
            if iteration == settings.max_iterations {
                return Err(Failure::Lost);
            }
            self.iterations += 1;
            self.system.assemble(
                &self.problem,
                positions,
                &point.factor_of(),
                None,
                jump.as_deref(),
                &mut forces.free,
            );
            let mut step = forces.free.clone();
            let factor = self.descending(&mut shift)?;
            let mut stop = || self.tell(positions, point, relative, observer).is_err();
            let tolerance = self.linear_tolerance(relative, settings);
            self.system
                .solve(&factor, &mut step, false, tolerance, &mut stop)?;
            if !step.iter().all(|x| x.is_finite()) {
                return Err(Failure::Singular);
            }
            let mut moves = self.system.spread(&step);
            if let Some(jump) = &jump {
                moves = moves.iter().zip(jump).map(|(a, b)| add(*a, *b)).collect();
            }
            let largest = moves.iter().map(|m| norm(*m)).fold(0.0, f64::max);
            if self.stands_still(positions, largest, relative) {
                return Ok(self.take_last(positions, &moves, point, iteration, relative));
            }
            let gain: f64 = step.iter().zip(&forces.free).map(|(s, f)| s * f).sum();
            self.advance(positions, &moves, point, gain, &forces, jump.is_some())?;
            let gone = positions
                .iter()
                .zip(self.problem.body().rest())
                .any(|(x, rest)| !(norm(sub(*x, *rest)) < limit + self.largest_motion));
            if gone {
                return Err(Failure::Lost);
            }
        }
        Err(Failure::Lost)
    }

    /// Tolerance of an iterative solution, at a residual `relative` to the loads: not below that of the final residual,
    /// which is used at once when it is near.
    pub fn linear_tolerance(&self, relative: f64, settings: &Settings) -> f64 {
        let enough = LAST_PART * settings.tolerance / relative;
        match self.problem.contact() {
            Some(_) if self.presses => LINEAR_TOLERANCE_WITH_CONTACT,
            _ if enough >= AT_ONCE => enough.min(LOOSEST),
            _ => LINEAR_TOLERANCE,
        }
    }

    /// Factorizes the tangent for a mixed iteration. Far from equilibrium the tangent may be indefinite, and mixed
    /// iterations are no descent method anyway; but with contact they diverge from there.
    fn carried(&mut self) -> Result<Factor, Failure> {
        if self.problem.contact().is_none() || !self.problem.is_conservative() {
            return Ok(self.system.factor(0.0)?);
        }
        match self.system.factor_positive(0.0) {
            Err(FactorError::NotPositive) => Err(Failure::Lost),
            outcome => Ok(outcome?),
        }
    }

    /// Factorizes a tangent whose step is a descent direction: if loads have a potential, the diagonal is shifted until
    /// the tangent is positive definite.
    fn descending(&mut self, shift: &mut f64) -> Result<Factor, Failure> {
        if !self.problem.is_conservative() {
            return Ok(self.system.factor(0.0)?);
        }
        let mut trial = if *shift > 1e-6 { *shift / 10.0 } else { 0.0 };
        loop {
            match self.system.factor_positive(trial) {
                Ok(factor) => {
                    *shift = trial;
                    return Ok(factor);
                }
                Err(FactorError::NotPositive) if trial < LARGEST_SHIFT => {
                    trial = (10.0 * trial).max(1e-6);
                }
                Err(error) => return Err(error.into()),
            }
        }
    }

    /// Line search along `moves`, halving the step until the potential decreases (or, without a potential, the
    /// residual). Steps that move clamps may raise it and need only be sound.
    fn advance(
        &self,
        positions: &mut Vec<Vec3>,
        moves: &[Vec3],
        point: LoadParameter,
        gain: f64,
        forces: &Forces,
        clamps_move: bool,
    ) -> Result<(), Failure> {
        let conservative = self.problem.is_conservative();
        let (start, size) = self.potential(positions, point);
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            let trial: Vec<Vec3> = positions
                .iter()
                .zip(moves)
                .map(|(x, m)| add(*x, scale(part, *m)))
                .collect();
            let good = if clamps_move {
                self.is_sound(&trial)
            } else if conservative {
                let (end, end_size) = self.potential(&trial, point);
                let rounding = ROUNDING * size.max(end_size);
                end <= start - SUFFICIENT * part * gain + rounding
            } else {
                self.forces(&trial, point).residual <= forces.residual * (1.0 - SUFFICIENT * part)
                    && self.is_sound(&trial)
            };
            if good {
                *positions = trial;
                return Ok(());
            }
            part /= 2.0;
        }
        Err(Failure::Lost)
    }

    /// Tests that no voxel is inverted or nearly so.
    pub fn is_sound(&self, positions: &[Vec3]) -> bool {
        let body = self.problem.body();
        let ratio = |hex8: &Hex8| {
            let deformation = hex8.deformation(body.material_of(hex8), positions);
            voxsoft_solid::matrix::determinant(&deformation)
        };
        body.hex8s().iter().all(|hex8| ratio(hex8) > 0.1)
            && positions.iter().flatten().all(|x| x.is_finite())
    }

    /// Tests whether the equilibrium at `positions` is stable.
    pub fn is_stable(&mut self, positions: &[Vec3], point: LoadParameter) -> bool {
        if self.follow_contact(positions).is_err() {
            return false;
        }
        let mut unused = vec![0.0; self.system.size()];
        self.system.assemble(
            &self.problem,
            positions,
            &point.factor_of(),
            None,
            None,
            &mut unused,
        );
        !self.problem.is_conservative() || self.system.is_positive_definite()
    }

    /// Updates the active set of the floor: catches vertices below it and releases those that it pulls; returns true if
    /// any changed.
    pub fn update_floor(
        &mut self,
        positions: &[Vec3],
        point: LoadParameter,
    ) -> Result<bool, FactorError> {
        let Some(floor) = self.problem.floor() else {
            return Ok(false);
        };
        let mut net = vec![[0.0; 3]; positions.len()];
        self.problem
            .add_scaled_loads(positions, &point.factor_of(), &mut net);
        elastic::add_forces(self.problem.body(), positions, &mut net);
        let slack = 1e-9 * self.problem.body().size();
        let mut changed = false;
        for vertex in 0..positions.len() {
            if self.problem.held()[vertex][2] {
                continue;
            }
            let carried = self.held[vertex][2];
            let keep = floor.keeps(carried, positions[vertex][2], net[vertex][2], slack);
            changed |= keep != carried;
            self.held[vertex][2] = keep;
        }
        if changed {
            self.system = System::new(&self.problem, &self.held, self.options)?;
        }
        Ok(changed)
    }

    /// Goes back to the coordinates that were held before a state which is not accepted: vertices that the floor carried
    /// in it would be pulled down to the floor by the next search.
    pub fn hold(&mut self, held: Vec<[bool; 3]>) -> Result<(), FactorError> {
        if held != self.held {
            self.held = held;
            self.system = System::new(&self.problem, &self.held, self.options)?;
        }
        Ok(())
    }
}

/// Tests whether a step of the size `largest` of a body of some size that has moved by `moved` (all m), with the
/// `relative` residual before it, is nothing but rounding.
pub(crate) fn is_standstill(relative: f64, largest: f64, size: f64, moved: f64) -> bool {
    let rounding = f64::max(STANDSTILL * size, STANDSTILL_OF_MOTION * moved);
    relative <= STANDSTILL_RESIDUAL && largest < rounding
}

/// Largest angle (rad) by which displacements from rest turn a voxel, to first order.
fn largest_turn(body: &Body, positions: &[Vec3], moves: &[Vec3]) -> f64 {
    let moved: Vec<Vec3> = positions
        .iter()
        .zip(moves)
        .map(|(x, m)| add(*x, *m))
        .collect();
    let turn = |hex8: &Hex8| norm(axial(&hex8.deformation(body.material_of(hex8), &moved))) / 2.0;
    body.hex8s().iter().map(turn).fold(0.0, f64::max)
}

/// Farthest motion of a vertex by a clamp, m.
fn largest_motion(problem: &Problem) -> f64 {
    let rest = problem.body().rest();
    let far = |vertex: u32, clamp: &voxsoft_solid::Clamp| {
        let at = rest[vertex as usize];
        norm(sub(clamp.target(at, f64::INFINITY, 1.0), at))
    };
    problem
        .clamps()
        .iter()
        .flat_map(|clamp| clamp.vertices.iter().map(move |&v| far(v, clamp)))
        .fold(0.0, f64::max)
}
