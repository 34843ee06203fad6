//! Search for the end of a step by Newton's method, with contact settled.

use std::ops::ControlFlow;
use std::sync::Arc;

use voxsoft_solid::element::hex8::Within;
use voxsoft_solid::vector::{Vec3, add, dot, scale, sub};
use voxsoft_solid::{
    History, Input, Observer, Problem, ProblemError, Progress, RecordedContact, State, Term,
    elastic,
};

use super::variations::{Side, Slopes, Variations, Vary};
use crate::inertia::Inertia;
use crate::linear::error::FactorError;
use crate::linear::options::LinearOptions;
use crate::motion::integrator::{Asker, InnerSearch, Stop};
use crate::motion::run::{Now, Run, Step};
use crate::motion::scheme::Stage;
use crate::path::contact_loop::AtLoad;
use crate::path::equilibrium::Equilibrium;
use crate::path::load_parameter::LoadParameter;
use crate::path::settings::Settings;
use crate::sensitivity::adjoint::AdjointError;

/// Relative residual of the equilibrium of a step.
const STEP_TOLERANCE: f64 = 1e-7;
/// Negligible force, as the relative change of the momentum by it in a step.
const NEGLIGIBLE_CHANGE: f64 = 1e-3;

/// Newton's method on the exact tangent, contact corrected until it has settled.
pub struct Newton {
    /// Equilibrium of the problem with the forces of inertia.
    equilibrium: Equilibrium,
    inertia: Arc<Inertia>,
    /// Solver and memory limit of linear systems.
    options: LinearOptions,
    /// Forces and energies at the beginning of the step of which the state is the first stage.
    pub(super) begun: Now,
    /// Variations of the motion by parameters, if it has any.
    variations: Option<Box<dyn Vary>>,
}

impl Newton {
    /// Starts from the state of a run.
    pub(super) fn new(run: &mut Run) -> Result<Self, FactorError> {
        let options = LinearOptions {
            solver: run.settings.linear,
            memory: run.settings.memory,
        };
        let inertia = Arc::new(Inertia::new(run.problem.body().masses()));
        begin_fluid(run);
        Ok(Self {
            equilibrium: moving(&run.problem, &inertia, options)?,
            inertia,
            options,
            begun: Now::default(),
            variations: None,
        })
    }

    /// Adds a parameter of variations ([`super::Motion::vary`]).
    pub(super) fn add_variation<C: RecordedContact>(&mut self, run: &Run, offset: f64) -> usize {
        let variations = self
            .variations
            .get_or_insert_with(|| Box::new(Variations::<C>::new()));
        variations.add(run, offset)
    }

    pub(super) fn forget_variations(&mut self) {
        self.variations = None;
    }

    pub(super) fn command_variation(
        &mut self,
        parameter: usize,
        side: Side,
        inputs: &[(Input, History)],
    ) -> Result<(), ProblemError> {
        let none = ProblemError::Index {
            what: "parameter",
            index: parameter,
            count: 0,
        };
        let variations = self.variations.as_mut().ok_or(none)?;
        variations.command(parameter, side, inputs)
    }

    pub(super) fn slopes(&self, parameter: usize) -> Result<Slopes, AdjointError> {
        let variations = self.variations.as_ref();
        variations.map_or(Err(AdjointError::Unsettled), |all| all.slopes(parameter))
    }

    /// Finds the positions at the end of a step, with the contact of the run.
    fn find(
        &mut self,
        run: &mut Run,
        step: &Step,
        observer: &mut Observer<'_>,
    ) -> Result<Vec<Vec3>, Stop> {
        let coast = |(x, v): (&Vec3, &Vec3)| add(*x, scale(1.0 / step.braked, *v));
        let start = &step.start;
        let free = start.positions.iter().zip(&start.velocities).map(coast);
        self.inertia.set(step.inertia(), free.collect());
        self.inertia.pull(&step.grabs);
        self.equilibrium.negligible = NEGLIGIBLE_CHANGE * momentum(run) / step.length;
        self.equilibrium.problem.begin(step.time);
        self.begin_viscosity(run, step.length);
        for problem in [&mut run.problem, &mut self.equilibrium.problem] {
            if let Some(fluid) = problem.fluid_mut() {
                fluid.begin(step.time, start.rate, start.weights);
            }
        }
        let point = LoadParameter::at(step.time);
        let mut positions = self.best_prediction(run, step, point)?;
        let settings = Settings {
            tolerance: STEP_TOLERANCE,
            ..Settings::default()
        };
        let mut search = AtLoad {
            point,
            safe: true,
            can_be_cut: false,
        };
        self.equilibrium
            .settle(&mut positions, &mut search, &settings, observer)?;
        run.problem.body().ties().follow(&mut positions);
        Ok(positions)
    }

    /// Sets the viscous stress of hyperelastic voxels over a step from the state.
    fn begin_viscosity(&mut self, run: &mut Run, step: f64) {
        if !run.problem.is_viscous() {
            return;
        }
        let body = run.problem.body();
        let materials = body.hex8s().iter().map(|hex8| body.material_of(hex8));
        let mut within: Vec<Within> = materials.map(Within::elastic).collect();
        run.problem
            .begin_viscosity(&run.state.positions, step, &mut within);
        self.equilibrium.problem.set_within(Some(within.clone()));
        run.problem.set_within(Some(within));
    }

    /// Starting guess of a step: extrapolation with the acceleration, with the velocity alone, or standing still,
    /// whichever has the lowest potential. Bodies that meet an obstacle, or feel a load that has jumped, do not
    /// continue their motion, and from deep inside an obstacle the way out takes more than twice the iterations.
    ///
    /// Each guess is evaluated with its own facing of contact, and the search updates it: the facing of the last guess
    /// is not that of the best one.
    fn best_prediction(
        &mut self,
        run: &Run,
        step: &Step,
        point: LoadParameter,
    ) -> Result<Vec<Vec3>, Stop> {
        let stayed = run.state.positions.clone();
        let mut predictions = vec![run.extrapolated(step.length, None), stayed];
        let before = run.before.as_ref().filter(|_| step.second_order);
        if before.is_some() {
            predictions.push(run.extrapolated(step.length, before));
        }
        let mut best = (f64::INFINITY, run.state.positions.clone());
        for mut prediction in predictions {
            run.problem
                .place_clamps(point.time, point.dead, &mut prediction);
            self.relist();
            self.equilibrium.follow_contact(&prediction)?;
            let (potential, _) = self.equilibrium.potential(&prediction, point);
            if potential < best.0 {
                best = (potential, prediction);
            }
        }
        self.relist();
        Ok(best.1)
    }

    fn relist(&mut self) {
        if let Some(contact) = self.equilibrium.problem.contact_mut() {
            contact.relist();
        }
    }
}

impl InnerSearch for Newton {
    const FORGETS: bool = false;

    fn copy(&mut self) -> Option<&mut Problem> {
        Some(&mut self.equilibrium.problem)
    }

    fn start(&mut self, run: &mut Run, _at_rest: bool) {
        self.variations = None;
        if run.problem.is_viscous() {
            run.problem.set_within(None);
        }
        begin_fluid(run);
        self.resume(run);
    }

    fn resume(&mut self, run: &mut Run) {
        // A tangent of the size of the last one fits in memory too.
        if let Ok(equilibrium) = moving(&run.problem, &self.inertia, self.options) {
            self.equilibrium = equilibrium;
        }
    }

    /// A load acts with its new value for all of the next step, whose work counts in the balance of energy.
    /// Supports still carry the inertia of the moving body.
    fn wake(&self, run: &mut Run) {
        let found = run.look_at(&run.state);
        let then = std::mem::replace(&mut run.now, found);
        if then.reactions.len() == run.now.external.len() {
            let loads = run.now.external.iter().zip(&then.external);
            let each = then.reactions.iter().zip(loads);
            run.now.reactions = each
                .map(|(r, (new, old))| sub(*r, sub(*new, *old)))
                .collect();
        }
    }

    fn solve(
        &mut self,
        run: &mut Run,
        step: &Step,
        asker: &mut Asker<'_>,
    ) -> Result<Vec<Vec3>, Stop> {
        let mut observer = |progress: &Progress<'_>| {
            if asker(Some(progress)) {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        // Contact has one memory, which the problem with inertia borrows while it finds the end.
        run.problem.exchange_contact(&mut self.equilibrium.problem);
        let positions = self.find(run, step, &mut observer);
        run.problem.exchange_contact(&mut self.equilibrium.problem);
        positions
    }

    fn look(&mut self, run: &Run, step: &Step, next: &State) -> Now {
        let mut found = run.look_at(next);
        let inertia = |(v, old): (&Vec3, &Vec3)| {
            add(
                scale(step.start.rate, sub(*v, *old)),
                scale(run.damping_rate, *v),
            )
        };
        let accelerations = next.velocities.iter().zip(&step.start.velocities);
        found.take_reactions(&run.problem, accelerations.map(inertia));
        found
    }

    fn takes_again(&mut self, run: &Run, outcome: &Result<(State, Now), Stop>) -> bool {
        let gains = |(next, found): &(State, Now)| self.gains_energy(run, next, found);
        outcome.as_ref().is_ok_and(gains)
    }

    fn varies(&self) -> bool {
        self.variations.is_some()
    }

    fn vary(
        &mut self,
        run: &mut Run,
        step: &Step,
        next: &State,
        asker: &mut Asker<'_>,
    ) -> Result<(), Stop> {
        let Some(variations) = &mut self.variations else {
            return Ok(());
        };
        let equilibrium = &mut self.equilibrium;
        run.problem.exchange_contact(&mut equilibrium.problem);
        let outcome = variations.follow(equilibrium, run, step, next, &mut || !asker(None));
        run.problem.exchange_contact(&mut equilibrium.problem);
        outcome
    }

    fn accept_contact(&mut self, problem: &mut Problem, next: &State) -> bool {
        if let Some(contact) = problem.contact_mut() {
            contact.accept(&next.positions);
        }
        true
    }

    fn accept(&mut self, run: &mut Run, next: &State) {
        if let Some(fluid) = run.problem.fluid_mut() {
            if run.stage == Stage::Second {
                fluid.take_stage(&next.positions);
            } else {
                fluid.take_step(&next.positions);
            }
        }
        self.equilibrium.problem.remember_but_contact(&run.problem);
    }

    fn leave(&mut self, run: &Run, then: Now) {
        if run.stage == Stage::First {
            self.begun = then;
        }
    }

    /// The viscous stress has yet to decay.
    fn residual_at_rest(&self, run: &Run, residual: f64) -> f64 {
        if !run.problem.is_viscous() {
            return residual;
        }
        let mut net = run.now.external.clone();
        elastic::add_stored_forces(run.problem.body(), &run.state.positions, &mut net);
        run.residual_of(net)
    }

    fn fluid_is_at_rest(&self, run: &Run) -> bool {
        let fluid = run.problem.fluid();
        fluid.is_none_or(|fluid| fluid.is_at_rest(run.settings.tolerance))
    }
}

/// Starts gas and liquid at the state of a run.
fn begin_fluid(run: &mut Run) {
    let time = run.state.time;
    run.problem.start_fluid(&run.state.positions, Some(time));
}

/// Norm of the momenta of all vertices, kg m/s.
fn momentum(run: &Run) -> f64 {
    let masses = run.problem.body().masses();
    let pairs = run.state.velocities.iter().zip(masses);
    pairs.map(|(v, m)| m * m * dot(*v, *v)).sum::<f64>().sqrt()
}

/// Equilibrium of a problem with the forces of inertia.
fn moving(
    problem: &Problem,
    inertia: &Arc<Inertia>,
    options: LinearOptions,
) -> Result<Equilibrium, FactorError> {
    let moving = problem
        .clone()
        .with_term(Arc::clone(inertia) as Arc<dyn Term>);
    let moving = moving.expect("inertia has the vertices of its body");
    Ok(Equilibrium {
        inertia: Some(Arc::clone(inertia)),
        ..Equilibrium::new(moving, options)?
    })
}
