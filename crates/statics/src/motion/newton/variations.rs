//! First-order changes of a motion by parameters of its commands.
//!
//! The end of a step is an equilibrium `r(x, s, p) = 0` with the forces of inertia. The memory `s` holds all that a step
//! depends on: the last two states, multipliers and anchors of contact, masses in chambers, friction of tendons, viscous
//! stress. With the tangent `K = −∂r/∂x` at the end,
//!
//! ```text
//! K dx/dp = ∂r/∂p + ∂r/∂s ds/dp .
//! ```
//!
//! Each tangent is factorized once for all parameters. All other derivatives are central differences: two neighbors of
//! each parameter, at values a little above and below, hold states and memories of their own, and take the steps of the
//! motion to the first order. Multipliers of contact are corrected until the derivatives settle.

use std::marker::PhantomData;

use voxsoft_solid::element::hex8::Within;
use voxsoft_solid::vector::{Vec3, add, axpy, scale, sub};
use voxsoft_solid::{
    History, Input, Load, Moment, Problem, ProblemError, RecordedContact, State, Velocities,
};

use crate::linear::system::System;
use crate::motion::integrator::Stop;
use crate::motion::run::{Run, Step};
use crate::motion::scheme::{Stage, Start};
use crate::path::equilibrium::Equilibrium;
use crate::path::load_parameter::LoadParameter;
use crate::sensitivity::adjoint::AdjointError;
use crate::sensitivity::parameters::{contact_of, net_forces};

/// Relative tolerance of iterative solutions for derivatives, in the energy norm.
const TOLERANCE: f64 = 1e-8;
/// Corrections of derivatives at the end of a step with contact: until their relative change is below [`SETTLED`], but
/// at most [`ROUNDS`]; above [`LARGEST_CHANGE`] they count as diverged.
const SETTLED: f64 = 1e-4;
const ROUNDS: u32 = 30;
const LARGEST_CHANGE: f64 = 1e-2;

/// First-order change of positions (m) and velocities (m/s) per unit of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Slopes {
    /// Derivatives of positions, m.
    pub positions: Vec<Vec3>,
    /// Derivatives of velocities, m/s.
    pub velocities: Vec<Vec3>,
}

/// Side of a neighbor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// A value a little below.
    Below,
    /// A value a little above.
    Above,
}

/// Variations of a motion, whatever its contact.
pub(super) trait Vary: Send {
    /// Adds a parameter whose neighbors are at `offset` from its value, from the present state on; returns its number.
    fn add(&mut self, run: &Run, offset: f64) -> usize;

    /// Replaces courses of inputs of a neighbor of a parameter.
    fn command(
        &mut self,
        parameter: usize,
        side: Side,
        inputs: &[(Input, History)],
    ) -> Result<(), ProblemError>;

    /// Takes a step that the motion has found and not yet accepted, with the problem whose equilibrium it is.
    fn follow(
        &mut self,
        equilibrium: &mut Equilibrium,
        run: &Run,
        step: &Step,
        next: &State,
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<(), Stop>;

    /// Slopes by a parameter.
    ///
    /// # Errors
    ///
    /// A step whose tangent is singular, or whose contact does not settle to the first order.
    fn slopes(&self, parameter: usize) -> Result<Slopes, AdjointError>;
}

/// Variations of a motion with contact of a kind, if it has any.
pub(super) struct Variations<C> {
    parameters: Vec<Parameter>,
    failed: Option<AdjointError>,
    contact: PhantomData<fn() -> C>,
}

struct Parameter {
    offset: f64,
    /// Largest slope of any position so far, m: beside it a change of slopes that have died away is rounding.
    largest: f64,
    /// Below and above.
    neighbors: [Neighbor; 2],
}

/// A motion beside another one.
struct Neighbor {
    problem: Problem,
    state: State,
    before: Option<State>,
}

/// Signs of the offsets of neighbors.
const SIGNS: [f64; 2] = [-1.0, 1.0];

impl<C> Variations<C> {
    pub fn new() -> Self {
        Self {
            parameters: Vec::new(),
            failed: None,
            contact: PhantomData,
        }
    }
}

impl<C: RecordedContact> Vary for Variations<C> {
    fn add(&mut self, run: &Run, offset: f64) -> usize {
        let neighbor = || Neighbor {
            problem: run.problem.clone(),
            state: run.state.clone(),
            before: run.before.clone(),
        };
        self.parameters.push(Parameter {
            offset,
            largest: 0.0,
            neighbors: [neighbor(), neighbor()],
        });
        self.parameters.len() - 1
    }

    fn command(
        &mut self,
        parameter: usize,
        side: Side,
        inputs: &[(Input, History)],
    ) -> Result<(), ProblemError> {
        let count = self.parameters.len();
        let missing = ProblemError::Index {
            what: "parameter",
            index: parameter,
            count,
        };
        let parameter = self.parameters.get_mut(parameter).ok_or(missing)?;
        let neighbor = &mut parameter.neighbors[side as usize];
        for (input, course) in inputs {
            neighbor.problem.command(*input, course.clone())?;
        }
        Ok(())
    }

    fn follow(
        &mut self,
        equilibrium: &mut Equilibrium,
        run: &Run,
        step: &Step,
        next: &State,
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<(), Stop> {
        if self.failed.is_some() || self.parameters.is_empty() {
            return Ok(());
        }
        match self.take(equilibrium, run, step, next, stop) {
            Err(AdjointError::Cancelled) => return Err(Stop::Cancelled),
            outcome => self.failed = outcome.err(),
        }
        Ok(())
    }

    fn slopes(&self, parameter: usize) -> Result<Slopes, AdjointError> {
        if let Some(error) = self.failed {
            return Err(error);
        }
        let found = self.parameters.get(parameter);
        let Parameter {
            offset, neighbors, ..
        } = found.ok_or(AdjointError::Unsettled)?;
        let [below, above] = neighbors.each_ref().map(|neighbor| &neighbor.state);
        let slope = |above: &[Vec3], below: &[Vec3]| {
            let pairs = above.iter().zip(below);
            pairs
                .map(|(a, b)| scale(0.5 / offset, sub(*a, *b)))
                .collect()
        };
        Ok(Slopes {
            positions: slope(&above.positions, &below.positions),
            velocities: slope(&above.velocities, &below.velocities),
        })
    }
}

impl<C: RecordedContact> Variations<C> {
    fn take(
        &mut self,
        equilibrium: &mut Equilibrium,
        run: &Run,
        step: &Step,
        next: &State,
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<(), AdjointError> {
        let moment = settled_moment::<C>(&equilibrium.problem, next)?;
        let contact = equilibrium.problem.contact();
        let touches = contact.is_some_and(|contact| contact.is_touching(&next.positions));
        let kept = contact.map(|contact| contact.memory());
        let end = LoadParameter::at(step.time);
        let assembled = assemble::<C>(equilibrium, moment.as_ref(), next, end);
        // The motion goes on from its own contact, also without a tangent.
        if let (Some(kept), Some(contact)) = (&kept, equilibrium.problem.contact_mut()) {
            contact.remember(kept);
        }
        assembled?;
        let system = &mut equilibrium.system;
        let factor = system.factor(0.0)?;
        for parameter in &mut self.parameters {
            let offset = parameter.offset;
            let starts = parameter
                .neighbors
                .each_mut()
                .map(|neighbor| neighbor.begin(run, step));
            if let Some(moment) = &moment {
                let guesses = parameter.guesses(step.length, &next.positions);
                C::begin_step(&mut parameter.contacts()?, &guesses, moment);
            }
            let mut before: Vec<Vec3> = Vec::new();
            let mut round = 0;
            let places = loop {
                let mut side = vec![0.0; system.size()];
                let mut places = Vec::with_capacity(2);
                for ((neighbor, start), sign) in parameter.neighbors.iter().zip(&starts).zip(SIGNS)
                {
                    let mut positions = next.positions.clone();
                    neighbor
                        .problem
                        .place_clamps(end.time, end.dead, &mut positions);
                    neighbor.problem.body().ties().follow(&mut positions);
                    let net = neighbor.net_forces(&positions, start, step, end);
                    for (side, force) in side.iter_mut().zip(system.gather(&net)) {
                        *side += sign * force / (2.0 * offset);
                    }
                    places.push(positions);
                }
                system.solve(&factor, &mut side, false, TOLERANCE, stop)?;
                if !side.iter().all(|x| x.is_finite()) {
                    return Err(AdjointError::Singular);
                }
                let slopes = system.spread(&side);
                for (positions, sign) in places.iter_mut().zip(SIGNS) {
                    for (x, slope) in positions.iter_mut().zip(&slopes) {
                        axpy(x, sign * offset, *slope);
                    }
                }
                let Some(moment) = moment.as_ref().filter(|_| touches) else {
                    break places;
                };
                let change = parameter.change(&before, &slopes);
                if round == ROUNDS && change > LARGEST_CHANGE {
                    return Err(AdjointError::Unsettled);
                }
                if round == ROUNDS || change <= SETTLED {
                    break places;
                }
                let again = Moment {
                    settled: false,
                    ..moment.clone()
                };
                C::follow_on(&mut parameter.contacts()?, &places, &again, Some(&again));
                before = slopes;
                round += 1;
            };
            if let Some(moment) = &moment {
                C::follow_on(&mut parameter.contacts()?, &places, moment, None);
            }
            let ends = parameter.neighbors.iter_mut().zip(starts).zip(places);
            for ((neighbor, start), positions) in ends {
                neighbor.accept(run.stage, step, &start, positions);
            }
        }
        Ok(())
    }
}

impl Parameter {
    fn contacts<C: RecordedContact>(&mut self) -> Result<Vec<&mut C>, AdjointError> {
        let each = self.neighbors.iter_mut();
        each.map(|neighbor| contact_of(&mut neighbor.problem))
            .collect()
    }

    /// Largest change of slopes, relative to the largest so far; infinite without slopes before.
    fn change(&mut self, before: &[Vec3], now: &[Vec3]) -> f64 {
        let now = now.as_flattened();
        self.largest = now.iter().fold(self.largest, |most, x| most.max(x.abs()));
        if before.is_empty() {
            return f64::INFINITY;
        }
        let pairs = before.as_flattened().iter().zip(now);
        let moved = pairs.fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
        if moved > 0.0 {
            moved / self.largest
        } else {
            0.0
        }
    }

    /// Positions of the neighbors after a step that nothing hinders, around those of its end.
    fn guesses(&self, step: f64, positions: &[Vec3]) -> Vec<Vec<Vec3>> {
        let [below, above] = self.neighbors.each_ref().map(|each| &each.state);
        let beside = |sign: f64| {
            let mut guess = positions.to_vec();
            for (vertex, x) in guess.iter_mut().enumerate() {
                let way = sub(above.positions[vertex], below.positions[vertex]);
                let speed = sub(above.velocities[vertex], below.velocities[vertex]);
                axpy(x, sign / 2.0, add(way, scale(step, speed)));
            }
            guess
        };
        SIGNS.map(beside).into()
    }
}

impl Neighbor {
    /// Begins a step of the motion from its own state.
    fn begin(&mut self, run: &Run, step: &Step) -> Start {
        let before = self.before.as_ref().filter(|_| step.second_order);
        let start = Start::new(&self.state, before, step.length, run.stage);
        self.problem.begin(step.time);
        if self.problem.is_viscous() {
            let body = self.problem.body();
            let materials = body.hex8s().iter().map(|hex8| body.material_of(hex8));
            let mut within: Vec<Within> = materials.map(Within::elastic).collect();
            self.problem
                .begin_viscosity(&self.state.positions, step.length, &mut within);
            self.problem.set_within(Some(within));
        }
        if let Some(fluid) = self.problem.fluid_mut() {
            fluid.begin(step.time, start.rate, start.weights);
        }
        let velocities = || Velocities {
            rate: start.rate,
            from: start.positions.clone(),
        };
        let State {
            positions: from,
            velocities: speeds,
            ..
        } = &self.state;
        let pairs = from.iter().zip(speeds);
        let near: Vec<Vec3> = pairs
            .map(|(x, v)| add(*x, scale(step.length, *v)))
            .collect();
        self.problem.begin_motion(velocities, &near);
        start
    }

    /// Net forces at positions at the end of a step, inertia included.
    fn net_forces(
        &self,
        positions: &[Vec3],
        start: &Start,
        step: &Step,
        end: LoadParameter,
    ) -> Vec<Vec3> {
        let mut net = net_forces(&self.problem, positions, end);
        let inertia = step.inertia();
        for (vertex, mass) in self.problem.body().masses().iter().enumerate() {
            let mut free = start.positions[vertex];
            axpy(&mut free, 1.0 / step.braked, start.velocities[vertex]);
            axpy(
                &mut net[vertex],
                inertia * mass,
                sub(free, positions[vertex]),
            );
        }
        net
    }

    /// Accepts the end of a step.
    fn accept(&mut self, stage: Stage, step: &Step, start: &Start, positions: Vec<Vec3>) {
        let factor_of = |load: &Load| load.history.at(step.time);
        self.problem.accept_loads(&positions, &factor_of);
        self.problem.end_viscosity(&positions, step.length);
        if let Some(fluid) = self.problem.fluid_mut() {
            if stage == Stage::Second {
                fluid.take_stage(&positions);
            } else {
                fluid.take_step(&positions);
            }
        }
        let pairs = positions.iter().zip(&start.positions);
        let velocities = pairs.map(|(x, from)| scale(start.rate, sub(*x, *from)));
        let next = State {
            velocities: velocities.collect(),
            positions,
            time: step.time,
        };
        let left = std::mem::replace(&mut self.state, next);
        if stage != Stage::Second {
            self.before = Some(left);
        }
    }
}

/// The moment of contact at the end of a step, where something touches.
fn settled_moment<C: RecordedContact>(
    problem: &Problem,
    next: &State,
) -> Result<Option<Moment<C::Memory>>, AdjointError> {
    let Some(contact) = problem.contact() else {
        return Ok(None);
    };
    let found = contact.found_by().downcast_ref::<C>();
    let found = found.ok_or(AdjointError::Unsettled)?;
    Ok(Some(found.moment(&next.positions)))
}

/// Assembles the exact tangent at the end of a step, with its contact.
fn assemble<C: RecordedContact>(
    equilibrium: &mut Equilibrium,
    moment: Option<&Moment<C::Memory>>,
    next: &State,
    end: LoadParameter,
) -> Result<(), AdjointError> {
    if let Some(moment) = moment
        && contact_of::<C>(&mut equilibrium.problem)?.recall(moment)
    {
        equilibrium.system =
            System::new(&equilibrium.problem, &equilibrium.held, equilibrium.options)?;
    }
    let system = &mut equilibrium.system;
    let mut unused = vec![0.0; system.size()];
    system.assemble(
        &equilibrium.problem,
        &next.positions,
        &end.factor_of(),
        None,
        None,
        &mut unused,
    );
    Ok(())
}
