//! The quick search within the loop of steps.

use voxsoft_solid::vector::{Vec3, add};
use voxsoft_solid::{Load, Problem, State, Velocities, elastic};

use super::QuasiNewton;
use super::contact::touches;
use super::objective::{Goal, factor_within};
use super::pressures::Pressures;
use crate::motion::integrator::{Asker, InnerSearch, Stop};
use crate::motion::run::{Now, Run, Step};

/// Forces (N) of the loads that are held constant for a step: those at its beginning, at the time of its end.
fn lagged_loads(run: &mut Run, step: &Step) -> Vec<Vec3> {
    let positions = &run.state.positions;
    let within = factor_within(&run.problem, step.time);
    let factor_of = |load: &Load| {
        if within(load) == 0.0 {
            load.history.at(step.time)
        } else {
            0.0
        }
    };
    let mut forces = vec![[0.0; 3]; positions.len()];
    if !run.problem.feels_motion() {
        run.problem
            .add_scaled_loads(positions, &factor_of, &mut forces);
        return forces;
    }
    let mut begun = run.problem.clone();
    let velocities = &run.state.velocities;
    begun.begin_motion(
        || Velocities::of(positions, velocities, step.start.rate),
        positions,
    );
    begun.add_scaled_loads(positions, &factor_of, &mut forces);
    forces
}

impl InnerSearch for QuasiNewton {
    const FORGETS: bool = true;

    fn start(&mut self, run: &mut Run, at_rest: bool) {
        let body = run.problem.body();
        self.pressures = if at_rest {
            // Zero, without the rounding of a volume.
            Pressures::new(body)
        } else {
            Pressures::at(body, &run.state.positions)
        };
        self.met = false;
        self.carried.fill(false);
        self.memory.clear();
        // The tangent is that of the state from which the next step starts, independent of earlier ones.
        if let Some(lagged) = &mut self.lagged {
            lagged.forget();
        }
        self.excess = 0.0;
    }

    fn resume(&mut self, run: &mut Run) {
        // Contact that is remembered may have other pairs.
        self.lagged = None;
        self.met = touches(&run.problem, &run.state.positions);
    }

    /// A step that begins in contact does not.
    fn may_look_back(&self) -> bool {
        !self.met
    }

    fn solve(
        &mut self,
        run: &mut Run,
        step: &Step,
        asker: &mut Asker<'_>,
    ) -> Result<Vec<Vec3>, Stop> {
        let start = &step.start;
        let free: Vec<Vec3> = start
            .positions
            .iter()
            .zip(&start.velocities)
            .map(|(x, v)| std::array::from_fn(|i| x[i] + v[i] / step.braked))
            .collect();
        let dead = (!run.problem.is_conservative()).then(|| lagged_loads(run, step));
        let mut within = self.pressures.start(run.problem.body());
        run.problem
            .begin_viscosity(&run.state.positions, step.length, &mut within);
        let inertia = step.inertia();
        let goal = Goal {
            time: step.time,
            inertia,
            free: &free,
            grabs: &step.grabs,
            dead: dead.as_deref(),
            within: &within,
        };
        let (mut positions, value) = self.minimize(run, goal, asker)?;
        self.keep_momentum(run, inertia, &mut positions, &value);
        self.found = value;
        Ok(positions)
    }

    fn look(&mut self, run: &Run, _step: &Step, next: &State) -> Now {
        let found = &mut self.found;
        Now {
            internal: std::mem::take(&mut found.elastic),
            external: std::mem::take(&mut found.external),
            elastic: found.energy,
            kinetic: next.kinetic_energy(run.problem.body().masses()),
            ..Now::default()
        }
    }

    /// A formula that looks two steps back makes bodies that meet rebound too fast.
    fn takes_again(&mut self, _run: &Run, outcome: &Result<(State, Now), Stop>) -> bool {
        let again = self.met && !matches!(outcome, Err(Stop::Cancelled));
        // The tangent has the contact stiffness of the final state, and would resist bodies that have yet to come there.
        if let (true, Some(lagged)) = (again, &mut self.lagged) {
            lagged.forget();
        }
        again
    }

    fn accept_contact(&mut self, problem: &mut Problem, next: &State) -> bool {
        let contact = problem.contact_mut();
        contact.is_none_or(|contact| contact.commit_partial(&next.positions))
    }

    fn accept(&mut self, _run: &mut Run, _next: &State) {
        self.pressures.take(&self.found.pressures);
    }

    /// Pressures and viscous stress may not have converged: only the elastic forces decide.
    fn residual_at_rest(&self, run: &Run, _residual: f64) -> f64 {
        let positions = &run.state.positions;
        let mut net = vec![[0.0; 3]; positions.len()];
        elastic::add_forces(run.problem.body(), positions, &mut net);
        for (force, load) in net.iter_mut().zip(&run.now.external) {
            *force = add(*force, *load);
        }
        run.residual_of(net)
    }

    fn settled(&self) -> bool {
        self.settled
    }
}
