//! Contact as solvers know it.

use std::any::Any;
use std::fmt::Debug;

use crate::Term;
use crate::vector::Vec3;

/// Memory of contact: plain data that only the contact which made it knows how to read.
#[derive(Debug)]
pub struct ContactMemory(Box<dyn Remembered>);

impl ContactMemory {
    /// Takes the memory of a contact.
    pub fn new(memory: impl Remembered) -> Self {
        Self(Box::new(memory))
    }

    /// The memory, where it is of this type.
    pub fn get<M: Remembered>(&self) -> Option<&M> {
        let memory: &dyn Any = &*self.0;
        memory.downcast_ref()
    }
}

impl Clone for ContactMemory {
    fn clone(&self) -> Self {
        Self(self.0.boxed())
    }
}

impl PartialEq for ContactMemory {
    fn eq(&self, other: &Self) -> bool {
        self.0.equals(&*other.0)
    }
}

/// Data that contact may remember: all that can be cloned, compared and sent.
pub trait Remembered: Debug + Send + Sync + Any {
    /// A copy.
    fn boxed(&self) -> Box<dyn Remembered>;

    /// Whether another memory is of the same kind and equal.
    fn equals(&self, other: &dyn Remembered) -> bool;
}

impl<M: Debug + Clone + PartialEq + Send + Sync + 'static> Remembered for M {
    fn boxed(&self) -> Box<dyn Remembered> {
        Box::new(self.clone())
    }

    fn equals(&self, other: &dyn Remembered) -> bool {
        let other: &dyn Any = other;
        other.downcast_ref::<M>() == Some(self)
    }
}

/// Surfaces that touch: a term of the body that remembers.
///
/// Its energy is that of the multipliers and the anchors that it holds. A solver finds an equilibrium under these,
/// lets them be [corrected](Contact::correct) until that changes little, and then
/// [accepts](Contact::accept) the state or [goes back](Contact::go_back) to the last accepted one.
pub trait Contact: Term + Any {
    /// A copy, with its memory.
    fn boxed(&self) -> Box<dyn Contact>;

    /// The contact that finds what touches, for those who know of which kind it is.
    fn found_by(&self) -> &dyn Any;

    /// The same, to change it.
    fn found_by_mut(&mut self) -> &mut dyn Any;

    /// All that it remembers.
    fn memory(&self) -> ContactMemory;

    /// Goes on from a memory of its own.
    fn remember(&mut self, memory: &ContactMemory);

    /// Forgets everything; `positions` (m) become the accepted state.
    fn start(&mut self, positions: &[Vec3]);

    /// Looks who touches at `positions`; whether the pattern of the stiffness has changed: it joins vertices that it did
    /// not before, or no longer many that it did. To be called before the stiffness is asked for.
    fn follow(&mut self, positions: &[Vec3]) -> bool;

    /// A search starts, or a guess at where: the next calls of [`follow`](Contact::follow) look for all that is faced, not
    /// only where it was left.
    fn look_anew(&mut self);

    /// Brings the multipliers up to the forces at `positions`, an equilibrium; whether they were there already, and nothing
    /// has changed. Forces of the size `negligible` (N) do not matter. `precision` is the part of what contact may be off by
    /// default that is asked for, at most 1.
    fn correct(&mut self, positions: &[Vec3], negligible: f64, precision: f64) -> bool;

    /// Hands over the vertices by which surfaces are bonded: faces between them do not warp freely.
    fn visit_bonded(&self, _visit: &mut dyn FnMut(u32)) {}

    /// A length by which things are near each other, in m: the size of a voxel.
    fn length(&self) -> f64;

    /// Lets bonds go that the forces at `positions`, an equilibrium, pass; whether any did. What others carry changes then.
    fn let_go(&mut self, positions: &[Vec3]) -> bool;

    /// Whether the answer depends on the way to it, as friction and bonds that may break make it.
    fn depends_on_way(&self) -> bool;

    /// Takes `positions` as the state from which the path goes on.
    fn accept(&mut self, positions: &[Vec3]);

    /// Takes `positions` as the end of a step that was not solved to the end: the multipliers are brought up to the
    /// forces there, once. `false`, and nothing is taken, where something is so deep in something else that which side
    /// it came from is no longer known.
    fn take_step(&mut self, positions: &[Vec3]) -> bool {
        self.accept(positions);
        true
    }

    /// Resists more for the rest of the step where something is too deep in something else at `positions`; whether it is.
    fn stiffen(&mut self, _positions: &[Vec3]) -> bool {
        false
    }

    /// Whether anything is pressed at `positions`.
    fn is_touching(&self, positions: &[Vec3]) -> bool {
        self.energy(positions) > 0.0
    }

    /// Forgets what happened since the last accepted state.
    fn go_back(&mut self);

    /// Whether its path is recorded, to be gone over again.
    fn is_recorded(&self) -> bool {
        false
    }

    /// Lets the multipliers of the last accepted state go on as they changed in the step to it: a start for one that is
    /// `ratio` times as long. The answer does not depend on it.
    fn extrapolate(&mut self, ratio: f64);
}

/// An equilibrium on the way of a load path, under what contact held before a correction.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment<M> {
    /// All vertices, m.
    pub positions: Vec<Vec3>,
    /// Whether contact had settled: a step of the path ends here.
    pub settled: bool,
    /// What contact held.
    pub memory: M,
}

/// Contact that can go over its path again, which derivatives along the path need.
///
/// The contact of a problem that differs by a little follows at the same moments: it faces what the recorded one faced, and
/// takes its own multipliers and anchors along.
pub trait RecordedContact: Contact {
    /// What it holds at a moment.
    type Memory: Clone + PartialEq + Send + Sync;

    /// Records from now on, from the next [`start`](Contact::start).
    fn record(&mut self);

    /// Takes what was recorded of the accepted path, and records no more.
    fn take_recorded(&mut self) -> Vec<Moment<Self::Memory>>;

    /// Goes back to a moment of its own; whether there is no room for its stiffness yet.
    fn recall(&mut self, moment: &Moment<Self::Memory>) -> bool;

    /// Faces what another one faced at a moment.
    fn face_as(&mut self, moment: &Moment<Self::Memory>);

    /// Brings the multipliers and anchors of contacts along from a moment to the `next`, with their vertices at `positions`. The
    /// contacts are those of values around the recorded one, whose mean it is.
    fn follow_on(
        group: &mut [&mut Self],
        positions: &[Vec<Vec3>],
        moment: &Moment<Self::Memory>,
        next: Option<&Moment<Self::Memory>>,
    );
}
