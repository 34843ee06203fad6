//! One step: finds its end, and accepts it if it is sound.

use voxsoft_solid::vector::{Vec3, scale, sub};
use voxsoft_solid::{Ask, Breakdown, Damping, Load, State};

use super::objective::{Goal, Value};
use super::scheme::{FIRST_PART, SECOND_OVER_FIRST, Stage, Start};
use super::{ANCHOR_SPEED, Failure, Implicit, MAX_BACK_OFFS, PATIENCE};

impl Implicit {
    /// Takes one step, halved repeatedly if a whole one fails.
    pub(super) fn take_step(&mut self, go_on: &mut dyn FnMut(Ask) -> bool) -> Result<(), Failure> {
        let least = self.settings.step * 0.5f64.powi(MAX_BACK_OFFS as i32);
        loop {
            self.steps += 1;
            match self.try_step(go_on) {
                Ok(()) => {
                    self.good += 1;
                    if self.good >= PATIENCE && self.step < self.settings.step {
                        self.step = (2.0 * self.step).min(self.settings.step);
                        self.good = 0;
                    }
                    return Ok(());
                }
                Err(Failure::Cancelled) => return Err(Failure::Cancelled),
                Err(Failure::Lost) => {
                    self.back_offs += 1;
                    self.good = 0;
                    self.step /= 2.0;
                    self.before = None;
                    self.stage = Stage::Later;
                    if self.step < least {
                        return Err(Failure::Lost);
                    }
                }
            }
        }
    }

    /// Takes a step by the second-order formula, except in contact; the first step in its two stages.
    fn try_step(&mut self, go_on: &mut dyn FnMut(Ask) -> bool) -> Result<(), Failure> {
        if self.stage == Stage::First {
            self.take_stage(FIRST_PART * self.step, go_on)?;
            self.stage = Stage::Second;
        }
        let step = match (self.stage, &self.before) {
            (Stage::Second, Some(before)) => SECOND_OVER_FIRST * (self.state.time - before.time),
            _ => self.step,
        };
        self.take_stage(step, go_on)?;
        self.stage = Stage::Later;
        Ok(())
    }

    fn take_stage(&mut self, step: f64, go_on: &mut dyn FnMut(Ask) -> bool) -> Result<(), Failure> {
        let second_order = self.before.is_some() && !self.met;
        let mut found = self.find(step, second_order, go_on);
        if second_order && self.met && !matches!(found, Err(Failure::Cancelled)) {
            self.rollback();
            // The tangent has the contact stiffness of the final state, and would resist bodies that have yet to come
            // there.
            if let Some(lagged) = &mut self.lagged {
                lagged.forget();
            }
            found = self.find(step, false, go_on);
        }
        let (next, value) = found.inspect_err(|_| self.rollback())?;
        self.accept(next, value)
    }

    /// Finds the end of a step that starts from the state, by the second-order formula or by backward Euler.
    fn find(
        &mut self,
        step: f64,
        second_order: bool,
        go_on: &mut dyn FnMut(Ask) -> bool,
    ) -> Result<(State, Value), Failure> {
        let before = self.before.as_ref().filter(|_| second_order);
        let start = Start::new(&self.state, before, step, self.stage);
        let braked = start.rate + self.damping_rate;
        let inertia = start.rate * braked;
        let free: Vec<Vec3> = start
            .positions
            .iter()
            .zip(&start.velocities)
            .map(|(x, v)| std::array::from_fn(|i| x[i] + v[i] / braked))
            .collect();
        let time = self.state.time + step;
        let mut grabs = self.grabs.clone();
        let grabs = grabs.follow(ANCHOR_SPEED * step * self.shortest_edge);
        let dead = (!self.problem.is_conservative()).then(|| {
            let mut forces = vec![[0.0; 3]; free.len()];
            self.problem
                .add_loads(&self.state.positions, time, &mut forces);
            forces
        });
        self.problem.begin(time);
        let mut within = self.pressures.start(self.problem.body());
        if let Some(viscosity) = &mut self.viscosity {
            let from = &self.state.positions;
            viscosity.start(self.problem.body(), from, step, &mut within);
        }
        let goal = Goal {
            time,
            inertia,
            free: &free,
            grabs: &grabs,
            dead: dead.as_deref(),
            within: &within,
        };
        let (mut positions, value) = self.minimize(goal, go_on)?;
        self.keep_momentum(inertia, &mut positions, &value);
        let velocities = positions.iter().zip(&start.positions);
        let velocities = velocities.map(|(x, from)| scale(start.rate, sub(*x, *from)));
        let next = State {
            velocities: velocities.collect(),
            positions,
            time,
        };
        Ok((next, value))
    }

    /// Accepts the end of a step, if it is sound.
    fn accept(&mut self, next: State, value: Value) -> Result<(), Failure> {
        let step = next.time - self.state.time;
        if let Some(place) =
            Breakdown::find(&self.problem, &next.positions, self.travel_limit, next.time)
        {
            self.breakdown = Some(place);
            self.rollback();
            return Err(Failure::Lost);
        }
        let taken = self
            .problem
            .contact_mut()
            .is_none_or(|contact| contact.commit_partial(&next.positions));
        if !taken {
            self.rollback();
            return Err(Failure::Lost);
        }
        let factor_of = |load: &Load| load.history.at(next.time);
        self.problem.accept_loads(&next.positions, &factor_of);
        self.grabs.follow(ANCHOR_SPEED * step * self.shortest_edge);
        if let Some(viscosity) = &mut self.viscosity {
            viscosity.end(self.problem.body(), &next.positions, step);
        }
        self.pressures.take(&value.pressures);
        if self.settings.damping == Damping::Critical {
            self.damping_rate = 2.0 * self.frequency(&next, &value);
        }
        let left = std::mem::replace(&mut self.state, next);
        // The first stage is of first order, and not used as a previous state by later steps.
        if self.stage != Stage::Second {
            self.before = Some(left);
        }
        self.value = value;
        Ok(())
    }

    /// Resets the memory of contact to the state.
    fn rollback(&mut self) {
        if let Some(contact) = self.problem.contact_mut() {
            contact.rollback();
        }
    }
}
