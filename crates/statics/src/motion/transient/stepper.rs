//! Stepper interface of motions.

use std::ops::ControlFlow;

use voxsoft_solid::breakdown::Breakdown;
use voxsoft_solid::loads::grabs::still_state;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Ask, Grab, LiveStatus, Look, Method, Problem, ProblemError, Progress, State, Stepper,
};

use super::motion::{Motion, Stop};
use crate::motion::implicit::STEPS;
use crate::motion::implicit::scheme::Stage;
use crate::path::equilibrium::Failure;

impl Motion {
    /// Takes a whole step, the first one of a motion in its two stages.
    fn take_whole_step(&mut self, go_on: &mut dyn FnMut(Ask) -> bool) -> Result<(), Stop> {
        let mut observer = |_: &Progress<'_>| {
            if go_on(Ask::Within) {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        loop {
            self.take_step(-1, &mut observer)?;
            if self.stage != Stage::Second {
                return Ok(());
            }
            // Both stages count as one step.
            self.steps -= 1;
        }
    }

    /// Updates the residual, and the status of a body at rest.
    fn judge(&mut self) {
        self.residual = self.residual();
        if self.is_at_rest(self.residual) {
            self.status = LiveStatus::AtRest;
        }
    }
}

impl Stepper for Motion {
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
            match self.take_whole_step(go_on) {
                Ok(()) => self.judge(),
                Err(Stop::Failed(Failure::Cancelled)) => break,
                Err(stop) => {
                    let State {
                        positions, time, ..
                    } = &self.state;
                    let place = match stop {
                        Stop::Gone(place) => place,
                        Stop::Failed(_) => Breakdown::farthest(&self.problem, positions, *time),
                    };
                    self.status = LiveStatus::Diverged;
                    self.breakdown = Some(place);
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
            elastic: self.now.elastic,
            kinetic: self.now.kinetic,
            breakdown: self.breakdown,
            settled: true,
        }
    }

    fn set_load(&mut self, load: usize, factor: Option<f64>) -> Result<(), ProblemError> {
        for problem in [&mut self.problem, &mut self.equilibrium.problem] {
            self.grabs.set_load(problem, load, factor)?;
        }
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
        if self.problem.body().ties().has(vertex) {
            let what = "grab";
            return Err(ProblemError::OnTied { what, vertex });
        }
        let positions = &self.state.positions;
        self.grabs
            .grab(positions, number, vertex, target, stiffness)?;
        self.wake();
        Ok(())
    }

    fn release(&mut self, number: u32) -> bool {
        let released = self.grabs.release(number);
        if released {
            self.inertia.pull(&[]);
            self.wake();
        }
        released
    }

    fn grabs(&self) -> &[(u32, Grab)] {
        self.grabs.all()
    }

    fn reset(&mut self) {
        self.grabs.release_all();
        (self.steps, self.back_offs) = (0, 0);
        self.start_from(State::at_rest(self.problem.body()));
    }

    fn seek(&mut self, positions: Vec<Vec3>, time: f64) -> Result<(), ProblemError> {
        let state = still_state(&self.problem, positions, time)?;
        self.grabs.release_all();
        self.start_from(state);
        Ok(())
    }
}
