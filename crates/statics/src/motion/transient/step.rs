//! One step: its end, with contact settled.

use voxsoft_solid::Observer;
use voxsoft_solid::State;
use voxsoft_solid::breakdown::Breakdown;
use voxsoft_solid::element::hex8::Within;
use voxsoft_solid::vector::{Vec3, add, axpy, dot, scale, sub};

use super::energy::Now;
use super::motion::{Motion, Stop};
use crate::motion::implicit::ANCHOR_SPEED;
use crate::motion::implicit::scheme::Start;
use crate::path::contact_loop::AtLoad;
use crate::path::load_parameter::LoadParameter;
use crate::path::settings::Settings;

/// Relative residual of the equilibrium of a step.
const STEP_TOLERANCE: f64 = 1e-7;
/// Negligible force, as the relative change of the momentum by it in a step.
const NEGLIGIBLE_CHANGE: f64 = 1e-3;

impl Motion {
    /// Finds the state at the end of a step.
    pub(super) fn find(
        &mut self,
        step: f64,
        before: Option<&State>,
        observer: &mut Observer<'_>,
    ) -> Result<(State, Now), Stop> {
        let start = Start::new(&self.state, before, step, self.stage);
        // Contact has one memory, which the problem with inertia borrows while it finds the end.
        self.problem.exchange_contact(&mut self.equilibrium.problem);
        let positions = self.find_positions(step, before, &start, observer);
        self.problem.exchange_contact(&mut self.equilibrium.problem);
        self.state_at(positions?, step, &start)
    }

    /// Finds the positions at the end of a step.
    fn find_positions(
        &mut self,
        step: f64,
        before: Option<&State>,
        start: &Start,
        observer: &mut Observer<'_>,
    ) -> Result<Vec<Vec3>, Stop> {
        let braked = start.rate + self.damping_rate;
        let coast = |(x, v): (&Vec3, &Vec3)| add(*x, scale(1.0 / braked, *v));
        let free = start.positions.iter().zip(&start.velocities).map(coast);
        self.inertia.set(start.rate * braked, free.collect());
        if !self.grabs.all().is_empty() {
            let mut grabs = self.grabs.clone();
            let travel = ANCHOR_SPEED * step * self.shortest_edge;
            self.inertia.pull(&grabs.follow(travel));
        }
        self.equilibrium.negligible = NEGLIGIBLE_CHANGE * self.momentum() / step;
        let time = self.state.time + step;
        self.begin(time);
        self.begin_viscosity(step);
        for problem in [&mut self.problem, &mut self.equilibrium.problem] {
            if let Some(fluid) = problem.fluid_mut() {
                fluid.begin(time, start.rate, start.weights);
            }
        }
        let point = LoadParameter::at(time);
        let mut positions = self.best_prediction(step, before, point)?;
        self.settle(&mut positions, point, observer)?;
        self.problem.body().ties().follow(&mut positions);
        Ok(positions)
    }

    /// Sets the viscous stress of hyperelastic voxels over a step from the state.
    fn begin_viscosity(&mut self, step: f64) {
        let Some(viscosity) = &mut self.viscosity else {
            return;
        };
        let body = self.problem.body();
        let materials = body.hex8s().iter().map(|hex8| body.material_of(hex8));
        let mut within: Vec<Within> = materials.map(Within::elastic).collect();
        viscosity.start(body, &self.state.positions, step, &mut within);
        self.equilibrium.problem.set_within(Some(within.clone()));
        self.problem.set_within(Some(within));
    }

    /// State at the end of a step, with its forces and energies.
    fn state_at(
        &self,
        positions: Vec<Vec3>,
        step: f64,
        start: &Start,
    ) -> Result<(State, Now), Stop> {
        let time = self.state.time + step;
        let pairs = positions.iter().zip(&start.positions);
        let velocities = pairs.map(|(x, from)| scale(start.rate, sub(*x, *from)));
        let next = State {
            velocities: velocities.collect(),
            positions,
            time,
        };
        let place = Breakdown::find(&self.problem, &next.positions, self.travel_limit, time);
        if let Some(place) = place {
            return Err(Stop::Gone(place));
        }
        let mut found = self.look_at(&next);
        let inertia = |(v, old): (&Vec3, &Vec3)| {
            add(
                scale(start.rate, sub(*v, *old)),
                scale(self.damping_rate, *v),
            )
        };
        let accelerations = next.velocities.iter().zip(&start.velocities).map(inertia);
        found.take_reactions(&self.problem, accelerations);
        Ok((next, found))
    }

    /// Norm of the momenta of all vertices, kg m/s.
    fn momentum(&self) -> f64 {
        let masses = self.problem.body().masses();
        let pairs = self.state.velocities.iter().zip(masses);
        pairs.map(|(v, m)| m * m * dot(*v, *v)).sum::<f64>().sqrt()
    }

    /// Starting guess of a step: extrapolation with the acceleration, with the velocity alone, or standing still,
    /// whichever has the lowest potential. Bodies that meet an obstacle, or feel a load that has jumped, do not
    /// continue their motion, and from deep inside an obstacle the way out takes more than twice the iterations.
    ///
    /// Each guess is evaluated with its own facing of contact, and the search updates it: the facing of the last guess
    /// is not that of the best one.
    fn best_prediction(
        &mut self,
        step: f64,
        before: Option<&State>,
        point: LoadParameter,
    ) -> Result<Vec<Vec3>, Stop> {
        let stayed = self.state.positions.clone();
        let mut predictions = vec![self.predicted(step, None), stayed];
        if before.is_some() {
            predictions.push(self.predicted(step, before));
        }
        let mut best = (f64::INFINITY, self.state.positions.clone());
        for mut prediction in predictions {
            self.problem
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

    /// Extrapolates the motion: with its acceleration since the state `before`, if that is given.
    fn predicted(&self, step: f64, before: Option<&State>) -> Vec<Vec3> {
        let mut positions = self.state.positions.clone();
        for (x, v) in positions.iter_mut().zip(&self.state.velocities) {
            axpy(x, step, *v);
        }
        if let Some(before) = before {
            let ratio = 0.5 * step * step / (self.state.time - before.time);
            let velocities = self.state.velocities.iter().zip(&before.velocities);
            for (x, (v, old)) in positions.iter_mut().zip(velocities) {
                axpy(x, ratio, sub(*v, *old));
            }
        }
        positions
    }

    /// Finds the equilibrium of a step, with contact settled.
    fn settle(
        &mut self,
        positions: &mut Vec<Vec3>,
        point: LoadParameter,
        observer: &mut Observer<'_>,
    ) -> Result<(), Stop> {
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
            .settle(positions, &mut search, &settings, observer)?;
        Ok(())
    }
}
