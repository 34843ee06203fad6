//! Laws of solvers and steppers for statics and implicit steps; deliberate faults are detected.

mod common;

use std::any::Any;

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

use common::{block, cantilever, rubber, vertices_where};
use voxsoft_solid::conformance::{Law, check_solver, check_stepper};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Ask, Attachment, History, LatticeMaterial, PointForces, Spring, Springs};
use voxsoft_solid::{
    Body, Clamp, Damping, Floor, Grab, Input, Load, Look, Memory, Method, Motion, Observer,
    Problem, ProblemError, Solution, Solver, State, Status, Stepper,
};
use voxsoft_statics::{Control, Implicit, ImplicitSettings, LinearSolver, Settings, Transient};

fn lattice() -> LatticeMaterial {
    LatticeMaterial::from_moduli(60e3, 400e3, 1070.0).unwrap()
}

/// Block that is turned at one end, lies on a floor and is pulled.
fn turned() -> Problem {
    let side = 5e-3;
    let mesh = block([8, 3, 2], side);
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let end = vertices_where(&mesh, |x| x[0] < 1e-9);
    let motion = Motion {
        displacement: [0.0, 0.0, 1e-3],
        axis: [1.0, 0.0, 0.0],
        angle: 0.2,
        center: [0.0, 0.0075, 0.005],
        history: History::constant(),
        courses: None,
    };
    let clamp = Clamp {
        vertices: end,
        axes: [true; 3],
        motion: Some(motion),
    };
    let far = vertices_where(&mesh, |x| x[0] > 8.0 * side - 1e-9);
    let pull = Load::constant(PointForces {
        forces: vec![[1e-3, 0.0, 0.0]; far.len()],
        vertices: far,
    });
    let loads = vec![Load::gravity([0.0, 0.0, -9.81]), pull];
    Problem::new(body, vec![clamp], loads, Some(Floor { z: -2e-4 })).unwrap()
}

/// Block without loads except a spring between its end and a place beside it.
fn sprung() -> Problem {
    let mut mesh = block([8, 3, 2], 5e-3);
    let vertices = vertices_where(&mesh, |x| x[0] > 40e-3 - 1e-9);
    let spring = Spring {
        weights: vec![1.0 / vertices.len() as f64; vertices.len()],
        vertices,
        anchor: [60e-3, 30e-3, 5e-3],
        length: 20e-3,
        stiffness: 2.0,
    };
    mesh.attachments = vec![Attachment::Springs(Springs(vec![spring]))];
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let clamp = Clamp::fixed(vertices_where(&mesh, |x| x[0] < 1e-9));
    Problem::new(body, vec![clamp], vec![], None).unwrap()
}

#[test]
fn statics_keeps_the_laws_of_a_solver() {
    for problem in [
        sprung(),
        cantilever([10, 2, 2], 5e-3, rubber()),
        cantilever([10, 2, 2], 5e-3, lattice()),
        turned(),
    ] {
        let settings = Settings::default();
        check_solver(&settings, &problem, settings.tolerance).unwrap();
    }
    let problem = cantilever([10, 3, 3], 5e-3, rubber());
    for (control, linear) in [
        (Control::ArcLength { steps: 50 }, LinearSolver::Auto),
        (Control::Load, LinearSolver::Iterative),
    ] {
        let settings = Settings {
            control,
            linear,
            ..Settings::default()
        };
        check_solver(&settings, &problem, settings.tolerance).unwrap();
    }
}

#[test]
fn motion_to_rest_keeps_the_laws_of_a_solver() {
    for problem in [
        cantilever([8, 2, 2], 5e-3, rubber()),
        cantilever([8, 2, 2], 5e-3, lattice()),
    ] {
        let settings = Transient {
            damping: Damping::Critical,
            ..Transient::default()
        };
        check_solver(&settings, &problem, settings.tolerance).unwrap();
    }
}

#[test]
fn implicit_steps_keep_the_laws_of_a_stepper() {
    for problem in [
        cantilever([8, 2, 2], 5e-3, rubber()),
        cantilever([8, 2, 2], 5e-3, lattice()),
    ] {
        let settings = ImplicitSettings::default();
        let make = || -> Box<dyn Stepper> { Box::new(Implicit::new(problem.clone(), settings)) };
        check_stepper(&make, settings.tolerance).unwrap();
    }
}

#[test]
fn converged_steps_keep_the_laws_of_a_stepper() {
    for problem in [
        cantilever([8, 2, 2], 5e-3, rubber()),
        cantilever([8, 2, 2], 5e-3, lattice()),
    ] {
        let settings = Transient {
            damping: Damping::Critical,
            ..Transient::default()
        };
        let make = || -> Box<dyn Stepper> {
            Box::new(
                voxsoft_statics::Motion::new(problem.clone(), settings).expect("a small tangent"),
            )
        };
        check_stepper(&make, settings.tolerance).unwrap();
    }
}

/// Statics with a deliberate fault.
struct Faulty(Law, AtomicU32);

impl Solver for Faulty {
    fn name(&self) -> &'static str {
        "faulty statics"
    }

    fn solve(
        &self,
        problem: &Problem,
        start: Option<&[Vec3]>,
        observer: &mut Observer<'_>,
    ) -> Solution {
        let deaf = self.0 == Law::Cancellation;
        let mut solution = Settings::default().solve(problem, start, &mut |progress| {
            let answer = observer(progress);
            if deaf {
                ControlFlow::Continue(())
            } else {
                answer
            }
        });
        let calls = self.1.fetch_add(1, Ordering::Relaxed);
        let vertex = solution.state.positions.len() - 1;
        match self.0 {
            Law::Equilibrium => solution.state.positions[vertex][0] += 1e-5,
            Law::Supports => {
                for x in &mut solution.state.positions {
                    x[0] += 1e-6;
                }
            }
            Law::Threads => solution.state.positions[vertex][1] += 1e-16 * f64::from(calls),
            _ => {}
        }
        solution
    }
}

#[test]
fn suite_catches_faults_of_a_solver() {
    let problem = cantilever([6, 1, 1], 5e-3, rubber());
    for law in [
        Law::Equilibrium,
        Law::Supports,
        Law::Threads,
        Law::Cancellation,
    ] {
        let solver = Faulty(law, AtomicU32::new(0));
        let found = check_solver(&solver, &problem, Settings::default().tolerance);
        assert_eq!(found.map_err(|broken| broken.law), Err(law));
    }
    let status = Settings {
        max_iterations: 1,
        least_step: 1.0,
        ..Settings::default()
    };
    let found = check_solver(&status, &cantilever([20, 1, 1], 5e-3, rubber()), 1e-8);
    let broken = found.expect_err("one iteration is not enough");
    assert_eq!(broken.law, Law::Equilibrium);
    assert!(broken.how.contains(Status::NotConverged.name()), "{broken}");
}

/// Implicit steps with a deliberate fault.
struct FaultyStepper(Implicit, Law, f64);

impl Stepper for FaultyStepper {
    fn as_any(&mut self) -> &mut dyn Any {
        self
    }

    fn method(&self) -> Method {
        self.0.method()
    }

    fn problem(&self) -> &Problem {
        self.0.problem()
    }

    fn state(&self) -> &State {
        self.0.state()
    }

    fn step(&self) -> f64 {
        self.0.step()
    }

    fn prefer_step(&mut self, seconds: f64) {
        self.0.prefer_step(seconds);
    }

    fn advance_while(&mut self, steps: u32, go_on: &mut dyn FnMut(Ask) -> bool) -> Look {
        if self.1 == Law::Threads {
            let threads = rayon::current_num_threads() as f64;
            self.0.prefer_step(self.2 * (1.0 + 1e-9 * threads));
        }
        let deaf = self.1 == Law::Cancellation;
        self.0.advance_while(steps, &mut |ask| go_on(ask) || deaf)
    }

    fn advance_to(&mut self, time: f64, go_on: &mut dyn FnMut(Ask) -> bool) -> Look {
        self.0.advance_to(time, go_on)
    }

    fn set_load(&mut self, load: usize, factor: Option<f64>) -> Result<(), ProblemError> {
        let factor = factor.map(|f| if self.1 == Law::Changes { f + 0.1 } else { f });
        self.0.set_load(load, factor)
    }

    fn command(&mut self, inputs: &[(Input, History)]) -> Result<(), ProblemError> {
        self.0.command(inputs)
    }

    fn grab(&mut self, n: u32, vertex: u32, to: Vec3, stiffness: f64) -> Result<(), ProblemError> {
        self.0.grab(n, vertex, to, stiffness)
    }

    fn release(&mut self, number: u32) -> bool {
        self.0.release(number)
    }

    fn grabs(&self) -> &[(u32, Grab)] {
        self.0.grabs()
    }

    fn reset(&mut self) {
        self.0.reset();
        if self.1 == Law::Repetition {
            self.0.prefer_step(self.2 * 1.001);
        }
    }

    fn seek(&mut self, positions: Vec<Vec3>, time: f64) -> Result<(), ProblemError> {
        self.0.seek(positions, time)
    }

    fn resume(&mut self, state: State, memory: &Memory) -> Result<(), ProblemError> {
        self.0.resume(state, memory)
    }
}

#[test]
fn suite_catches_faults_of_a_stepper() {
    let problem = cantilever([6, 1, 1], 5e-3, rubber());
    let settings = ImplicitSettings::default();
    let check = |law, tolerance| {
        let make = || -> Box<dyn Stepper> {
            let steps = Implicit::new(problem.clone(), settings);
            Box::new(FaultyStepper(steps, law, settings.step))
        };
        check_stepper(&make, tolerance).map_err(|broken| broken.law)
    };
    // No fault: this law does not apply to steppers.
    assert_eq!(check(Law::Gradient, settings.tolerance), Ok(()));
    for law in [
        Law::Repetition,
        Law::Threads,
        Law::Changes,
        Law::Cancellation,
    ] {
        assert_eq!(check(law, settings.tolerance), Err(law));
    }
    let strict = 1e-3 * settings.tolerance;
    assert_eq!(check(Law::Gradient, strict), Err(Law::Equilibrium));
}
