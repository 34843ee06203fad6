//! Stepper interface of implicit motions.

use std::any::Any;

use voxsoft_solid::breakdown::{Breakdown, Undefined};
use voxsoft_solid::loads::grabs::{checked_state, still_state};
use voxsoft_solid::vector::{Vec3, add, scale, sub};
use voxsoft_solid::{
    Ask, Grab, History, Input, LiveStatus, Look, Memory, Method, Problem, ProblemError, State,
    Stepper,
};

use super::integrator::{InnerSearch, Integrator, SAME_TIME, Stop};
use super::run::Run;
use super::scheme::Stage;

/// Shortest and longest step allowed, in s.
pub(super) const STEPS: [f64; 2] = [1e-6, 0.1];
/// Times after the last state at which a run that broke down looks for a load without a value, in lengths of a step that
/// would come next. The one that failed last was twice as long, and its search goes a little farther.
const AHEAD: [f64; 5] = [0.0, 1.0, 2.0, 4.0, 8.0];

impl<S: InnerSearch> Stepper for Integrator<S> {
    fn as_any(&mut self) -> &mut dyn Any {
        self
    }

    fn method(&self) -> Method {
        Method::Implicit
    }

    fn problem(&self) -> &Problem {
        &self.run.problem
    }

    fn state(&self) -> &State {
        &self.run.state
    }

    fn step(&self) -> f64 {
        self.run.step
    }

    fn prefer_step(&mut self, seconds: f64) {
        let step = seconds.clamp(STEPS[0], STEPS[1]);
        if step != self.run.settings.step {
            self.run.settings.step = step;
            self.run.step = step;
        }
    }

    fn advance_while(&mut self, steps: u32, go_on: &mut dyn FnMut(Ask) -> bool) -> Look {
        for _ in 0..steps {
            if !self.go_on(f64::INFINITY, go_on) {
                break;
            }
        }
        self.look()
    }

    fn advance_to(&mut self, time: f64, go_on: &mut dyn FnMut(Ask) -> bool) -> Look {
        while self.run.state.time < time * (1.0 - SAME_TIME) && self.go_on(time, go_on) {}
        self.look()
    }

    fn set_load(&mut self, load: usize, factor: Option<f64>) -> Result<(), ProblemError> {
        let run = &mut self.run;
        run.grabs.set_load(&mut run.problem, load, factor)?;
        if let Some(copy) = self.search.copy() {
            run.grabs.set_load(copy, load, factor)?;
        }
        self.wake();
        Ok(())
    }

    fn command(&mut self, inputs: &[(Input, History)]) -> Result<(), ProblemError> {
        for (input, course) in inputs {
            self.run.problem.command(*input, course.clone())?;
            if let Some(copy) = self.search.copy() {
                copy.command(*input, course.clone())?;
            }
        }
        self.run.reach.renew(&self.run.problem);
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
        let run = &mut self.run;
        if run.problem.body().ties().has(vertex) {
            let what = "grab";
            return Err(ProblemError::OnTied { what, vertex });
        }
        let positions = &run.state.positions;
        run.grabs
            .grab(positions, number, vertex, target, stiffness)?;
        self.wake();
        Ok(())
    }

    fn release(&mut self, number: u32) -> bool {
        let released = self.run.grabs.release(number);
        if released {
            self.wake();
        }
        released
    }

    fn grabs(&self) -> &[(u32, Grab)] {
        self.run.grabs.all()
    }

    fn reset(&mut self) {
        self.run.grabs.release_all();
        (self.run.steps, self.run.back_offs) = (0, 0);
        self.start_from(State::at_rest(self.run.problem.body()), true);
    }

    fn seek(&mut self, positions: Vec<Vec3>, time: f64) -> Result<(), ProblemError> {
        let state = still_state(&self.run.problem, positions, time)?;
        self.run.grabs.release_all();
        self.start_from(state, false);
        Ok(())
    }

    fn memory(&self) -> Memory {
        let run = &self.run;
        Memory {
            past: (run.stage == Stage::Later).then(|| run.past()),
            ..run.problem.memory()
        }
    }

    fn resume(&mut self, state: State, memory: &Memory) -> Result<(), ProblemError> {
        let run = &mut self.run;
        let state = checked_state(&run.problem, state)?;
        run.grabs.release_all();
        run.start_from(state);
        self.search.start(run, false);
        run.problem.remember(memory);
        if let Some(past) = &memory.past {
            run.take_past(past);
        }
        self.search.resume(run);
        self.search.wake(run);
        if let Some(past) = &memory.past {
            // Forces with inertia, and with contact before it was accepted.
            run.take_forces(past);
        }
        Ok(())
    }
}

impl<S: InnerSearch> Integrator<S> {
    /// Takes a step that does not pass the time `limit` (s); returns whether to take another one.
    fn go_on(&mut self, limit: f64, go_on: &mut dyn FnMut(Ask) -> bool) -> bool {
        if self.run.status != LiveStatus::Moving {
            return false;
        }
        match self.take_whole_step(limit, &mut |_| go_on(Ask::Within)) {
            Ok(()) => self.judge(),
            Err(Stop::Cancelled) => return false,
            Err(Stop::Memory(bytes)) => self.run.status = LiveStatus::OutOfMemory(bytes),
            Err(stop) => {
                self.run.status = LiveStatus::Diverged;
                self.run.breakdown = Some(self.run.place_of(&stop));
            }
        }
        go_on(Ask::After)
    }

    /// Summary of the run.
    fn look(&self) -> Look {
        let run = &self.run;
        Look {
            status: run.status,
            time: run.state.time,
            substep: run.step,
            substeps: run.steps,
            back_offs: run.back_offs,
            residual: run.residual,
            elastic: run.now.elastic,
            kinetic: run.now.kinetic,
            breakdown: run.breakdown,
            settled: self.search.settled(),
        }
    }
}

impl Run {
    /// Place of the failure that ends a run.
    pub fn place_of(&self, stop: &Stop) -> Breakdown {
        let place = match stop {
            Stop::Gone(place) => *place,
            _ => Breakdown::farthest(&self.problem, &self.state.positions, self.state.time),
        };
        Breakdown {
            undefined: self.undefined_ahead(),
            ..place
        }
    }

    /// Finds a load without a value on the way that the steps which failed last would have gone.
    fn undefined_ahead(&self) -> Option<Undefined> {
        let before = self.before.as_ref();
        let gains: Vec<Vec3> = match before {
            Some(before) if before.time < self.state.time => {
                let last = self.state.time - before.time;
                let pairs = self.state.velocities.iter().zip(&before.velocities);
                pairs
                    .map(|(v, old)| scale(1.0 / last, sub(*v, *old)))
                    .collect()
            }
            _ => vec![[0.0; 3]; self.state.velocities.len()],
        };
        AHEAD.iter().find_map(|&steps| {
            let ahead = steps * self.step;
            let time = self.state.time + ahead;
            let positions = self.extrapolated(ahead, before);
            let pairs = self.state.velocities.iter().zip(&gains);
            let velocities: Vec<Vec3> = pairs.map(|(v, a)| add(*v, scale(ahead, *a))).collect();
            let mut loads = self.problem.loads().iter().enumerate();
            loads.find_map(|(load, each)| {
                let (vertex, axis) = each.kind.undefined(&positions, &velocities, time)?;
                Some(Undefined {
                    load,
                    axis,
                    place: positions[vertex],
                    time,
                })
            })
        })
    }
}
