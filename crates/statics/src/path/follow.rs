//! Solution of a problem: the choice of the control that follows its load path.

use std::sync::Arc;

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Memory, Observer, Problem, Solution, Solver, State, Status, Term};

use crate::linear::error::FactorError;
use crate::linear::options::{LinearOptions, LinearSolver};
use crate::path::creep::Span;
use crate::path::equilibrium::Equilibrium;
use crate::path::load_path::Path;
use crate::path::parametrization::Parametrization;
use crate::path::pseudo_transient::PseudoTransient;
use crate::path::settings::{Answer, Control, Settings};
use crate::path::{arc_length, volume};

/// Starting guess of an equilibrium.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Start {
    /// Positions in m.
    pub positions: Vec<Vec3>,
    /// Pressures in the hyperelastic voxels in Pa, positive in tension, in the order of [`voxsoft_solid::Hex8s`];
    /// `None` for those of the positions.
    pub pressures: Option<Vec<f64>>,
}

/// Finds the equilibrium under the final values of all loads and motions, from a start or from rest.
pub fn solve(
    problem: &Problem,
    start: Option<&Start>,
    settings: &Settings,
    observer: &mut Observer<'_>,
) -> Answer {
    let loose = match settings.control {
        Control::Load | Control::Time { .. } | Control::Creep { .. } | Control::Volume { .. } => {
            PseudoTransient::find(problem)
        }
        // Loose components come to rest under a fixed load, and past a limit no equilibrium is stable under one.
        Control::ArcLength { .. } => None,
    };
    let Some(loose) = loose else {
        return follow(problem, start, settings, observer, None);
    };
    let dampers = Arc::clone(&loose.dampers) as Arc<dyn Term>;
    let damped = problem.clone().with_term(dampers);
    let damped = damped.expect("dampers have the vertices of the body");
    follow(&damped, start, settings, observer, Some(&loose))
}

/// Follows the path of a problem, in which dampers hold loose components.
fn follow(
    problem: &Problem,
    start: Option<&Start>,
    settings: &Settings,
    observer: &mut Observer<'_>,
    loose: Option<&PseudoTransient>,
) -> Answer {
    let mut problem = problem.clone();
    let rest = problem.body().rest().to_vec();
    let positions = start.map_or(&rest, |start| &start.positions).clone();
    let solver = match settings.control {
        Control::Load | Control::Time { .. } | Control::Creep { .. } => settings.linear,
        // Divergence of contact is detected by the signs of pivots.
        Control::Volume { .. } if problem.contact().is_none() => settings.linear,
        Control::ArcLength { .. } | Control::Volume { .. } => LinearSolver::Direct,
    };
    let options = LinearOptions {
        solver,
        memory: settings.memory,
    };
    let along = Parametrization::of(settings.control);
    let goes_on = matches!(along, Parametrization::Time { .. });
    if !goes_on {
        if let Some(contact) = problem.contact_mut() {
            contact.reset(&positions);
        }
        problem.start_loads();
        problem.start_fluid(&rest, None);
        if matches!(settings.control, Control::Creep { .. }) {
            problem.start_creep();
        }
    }
    let memory = problem.memory();
    let equilibrium = match Equilibrium::new(problem, options) {
        Ok(equilibrium) => Equilibrium {
            precision: (settings.tolerance / Settings::default().tolerance).min(1.0),
            ..equilibrium
        },
        Err(error) => return refused(positions, memory, error),
    };
    let mut path = Path {
        equilibrium: Equilibrium {
            has_loose: loose.is_some(),
            opening: start.and_then(|start| start.pressures.clone()),
            ..equilibrium
        },
        positions,
        point: along.at(0.0),
        points: Vec::new(),
        snaps: Vec::new(),
        observer,
        looking: false,
    };
    let ending = match settings.control {
        Control::Load | Control::Time { .. } => {
            let warm = start.is_some() && !goes_on;
            path.follow_load(settings, along, warm, loose)
        }
        Control::Creep { from, to, longest } => {
            let start = from.map_or_else(|| path.load_suddenly(settings, loose), Ok);
            start.map_or_else(
                |lost| lost,
                |from| path.creep(settings, Span { from, to, longest }, loose),
            )
        }
        Control::ArcLength { steps } => arc_length::follow_arc(&mut path, settings, steps),
        Control::Volume { ratio, steps } => {
            let growth = (ratio, steps);
            volume::follow_volume(&mut path, settings, growth, start.is_some(), loose)
        }
    };
    loose.inspect(|loose| loose.remove(&path.positions));
    path.answer(ending, settings)
}

fn refused(positions: Vec<Vec3>, memory: Memory, error: FactorError) -> Answer {
    Answer {
        memory,
        positions,
        status: match error {
            FactorError::Memory(bytes) => Status::OutOfMemory(bytes),
            FactorError::Cancelled => Status::Cancelled,
            FactorError::NotPositive | FactorError::Singular | FactorError::Stalled => {
                Status::Mechanism
            }
        },
        factor: 0.0,
        dead_factor: 0.0,
        time: f64::INFINITY,
        reached: 0.0,
        residual: f64::INFINITY,
        iterations: 0,
        back_offs: 0,
        path: Vec::new(),
        snaps: Vec::new(),
        limit: None,
        stable: false,
    }
}

impl Solver for Settings {
    fn name(&self) -> &'static str {
        "statics"
    }

    fn solve(
        &self,
        problem: &Problem,
        start: Option<&[Vec3]>,
        observer: &mut Observer<'_>,
    ) -> Solution {
        let start = start.map(|positions| Start {
            positions: positions.to_vec(),
            pressures: None,
        });
        let answer = solve(problem, start.as_ref(), self, observer);
        Solution {
            state: State {
                positions: answer.positions,
                ..State::at_rest(problem.body())
            },
            memory: answer.memory,
            status: answer.status,
            residual: answer.residual,
            steps: u64::from(answer.iterations),
            back_offs: answer.back_offs,
            breakdown: None,
        }
    }
}
