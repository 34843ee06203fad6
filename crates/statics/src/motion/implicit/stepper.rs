//! Stepper interface of implicit runs.

use voxsoft_solid::breakdown::Breakdown;
use voxsoft_solid::loads::grabs::still_state;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Ask, Grab, LiveStatus, Look, Method, Problem, ProblemError, State, Stepper};

use super::pressures::Pressures;
use super::{Failure, Implicit};

/// Shortest and longest step allowed, in s.
pub(crate) const STEPS: [f64; 2] = [1e-6, 0.1];

impl Stepper for Implicit {
    fn method(&self) -> Method {
        Method::Implicit
    }

    fn problem(&self) -> &Problem {
        &self.problem
    }

    fn state(&self) -> &State {
        &self.state
    }

    fn step(&self) -> f64 {
        self.step
    }

    fn prefer_step(&mut self, seconds: f64) {
        let step = seconds.clamp(STEPS[0], STEPS[1]);
        if step != self.settings.step {
            self.settings.step = step;
            self.step = step;
        }
    }

    fn advance_while(&mut self, steps: u32, go_on: &mut dyn FnMut(Ask) -> bool) -> Look {
        for _ in 0..steps {
            if self.status != LiveStatus::Moving {
                break;
            }
            match self.take_step(go_on) {
                Ok(()) => self.judge(),
                Err(Failure::Cancelled) => break,
                Err(Failure::Lost) => {
                    self.status = LiveStatus::Diverged;
                    let state = &self.state;
                    let place = || Breakdown::farthest(&self.problem, &state.positions, state.time);
                    self.breakdown = Some(self.breakdown.unwrap_or_else(place));
                }
            }
            if !go_on(Ask::After) {
                break;
            }
        }
        Look {
            status: self.status,
            time: self.state.time,
            substep: self.step,
            substeps: self.steps,
            back_offs: self.back_offs,
            residual: self.residual,
            elastic: self.value.energy,
            kinetic: self.state.kinetic_energy(self.problem.body().masses()),
            breakdown: self.breakdown,
            settled: self.settled,
        }
    }

    fn set_load(&mut self, load: usize, factor: Option<f64>) -> Result<(), ProblemError> {
        self.grabs.set_load(&mut self.problem, load, factor)?;
        self.wake();
        Ok(())
    }

    fn grab(
        &mut self,
        number: u32,
        vertex: u32,
        target: Vec3,
        stiffness: f64,
    ) -> Result<(), ProblemError> {
        let positions = &self.state.positions;
        self.grabs
            .grab(positions, number, vertex, target, stiffness)?;
        self.wake();
        Ok(())
    }

    fn release(&mut self, number: u32) -> bool {
        let released = self.grabs.release(number);
        if released {
            self.wake();
        }
        released
    }

    fn grabs(&self) -> &[(u32, Grab)] {
        self.grabs.all()
    }

    fn reset(&mut self) {
        self.grabs.release_all();
        self.step = self.settings.step;
        (self.steps, self.back_offs, self.good) = (0, 0, 0);
        self.start_from(State::at_rest(self.problem.body()));
        // Zero pressures, without the rounding of a volume.
        self.pressures = Pressures::new(self.problem.body());
    }

    fn seek(&mut self, positions: Vec<Vec3>, time: f64) -> Result<(), ProblemError> {
        let state = still_state(&self.problem, positions, time)?;
        self.grabs.release_all();
        self.start_from(state);
        Ok(())
    }
}
