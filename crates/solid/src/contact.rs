//! Contact as seen by solvers.

use std::any::Any;
use std::fmt::Debug;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::Term;
use crate::vector::Vec3;

/// Memory of contact: plain data that only the contact which made it can read.
#[derive(Debug)]
pub struct ContactMemory(Box<dyn Remembered>);

impl ContactMemory {
    /// Wraps the memory of a contact.
    pub fn new(memory: impl Remembered) -> Self {
        Self(Box::new(memory))
    }

    /// Reads the bytes of a memory of this type; `None` if they are damaged.
    pub fn read<M: Remembered + DeserializeOwned>(bytes: &[u8]) -> Option<Self> {
        let memory: M = postcard::from_bytes(bytes).ok()?;
        Some(Self::new(memory))
    }

    /// The memory, if it is of this type.
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

impl Serialize for ContactMemory {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.bytes().serialize(serializer)
    }
}

/// Gives the bytes themselves as a memory, which [`Contact::read_memory`] turns into one of its own type.
impl<'de> Deserialize<'de> for ContactMemory {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(|bytes: Vec<u8>| Self::new(bytes))
    }
}

/// Data that contact may keep as memory: all that can be cloned, compared, sent and stored.
pub trait Remembered: Debug + Send + Sync + Any {
    /// Returns the data in the format of the `postcard` crate.
    fn bytes(&self) -> Vec<u8>;

    /// Clones the data.
    fn boxed(&self) -> Box<dyn Remembered>;

    /// Tests whether another memory is of the same type and equal.
    fn equals(&self, other: &dyn Remembered) -> bool;
}

impl<M: Debug + Clone + PartialEq + Serialize + Send + Sync + 'static> Remembered for M {
    fn bytes(&self) -> Vec<u8> {
        postcard::to_allocvec(self).expect("memory takes all bytes, and all lists have lengths")
    }

    fn boxed(&self) -> Box<dyn Remembered> {
        Box::new(self.clone())
    }

    fn equals(&self, other: &dyn Remembered) -> bool {
        let other: &dyn Any = other;
        other.downcast_ref::<M>() == Some(self)
    }
}

/// Factors on the default tolerances of contact, at most 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Precision {
    /// Factor for gaps and for the creep of surfaces that stick.
    pub gaps: f64,
    /// Factor for friction and its bounds, whose errors add up along a path.
    pub friction: f64,
}

impl Precision {
    /// The default tolerances.
    pub const DEFAULT: Self = Self {
        gaps: 1.0,
        friction: 1.0,
    };
}

/// Contact between surfaces: a term of the body with memory.
///
/// Its energy is that of the Lagrange multipliers and the friction anchors that it holds (augmented Lagrangian). A
/// solver finds an equilibrium under these, lets them be [corrected](Contact::correct) until that changes little, and
/// then [accepts](Contact::accept) the state or [goes back](Contact::rollback) to the last accepted one.
pub trait Contact: Term + Any {
    /// Clones the contact with its memory.
    fn boxed(&self) -> Box<dyn Contact>;

    /// The concrete contact behind wrappers such as mirrored ones, to be downcast by callers that know its type.
    fn found_by(&self) -> &dyn Any;

    /// Mutable access to the concrete contact.
    fn found_by_mut(&mut self) -> &mut dyn Any;

    /// The memory of the contact.
    fn memory(&self) -> ContactMemory;

    /// Restores a memory that this contact made.
    fn remember(&mut self, memory: &ContactMemory);

    /// Reads a memory of its own type from stored bytes; `None` if they are damaged, or of another type.
    fn read_memory(&self, bytes: &[u8]) -> Option<ContactMemory>;

    /// Clears the memory; `positions` (m) become the accepted state.
    fn reset(&mut self, positions: &[Vec3]);

    /// Updates the contact pairs at `positions`. Returns whether the pattern of the stiffness has changed: it couples
    /// vertices that it did not before, or no longer many that it did. To be called before the stiffness is assembled.
    fn follow(&mut self, positions: &[Vec3]) -> bool;

    /// Announces a new solve, or an initial guess for one: the next calls of [`follow`](Contact::follow) search for all
    /// contact pairs anew, not only near the last ones.
    fn relist(&mut self);

    /// Updates the multipliers to the forces at `positions`, an equilibrium. Returns whether they were converged
    /// already, and nothing has changed. Forces of the size `negligible` (N) do not matter.
    fn correct(&mut self, positions: &[Vec3], negligible: f64, precision: Precision) -> bool;

    /// Prepares iterations with predicted multipliers: until the first [prediction](Contact::take_prediction), contact
    /// that sticks does so whatever its bound. Returns `false` if it cannot, as while the load path is recorded.
    fn begin_prediction(&mut self) -> bool {
        false
    }

    /// Ends iterations with predicted multipliers; all is as before if they did not converge.
    fn end_prediction(&mut self, _converged: bool) {}

    /// Updates the multipliers to those that a linear step of `moves` (m) from `positions` predicts.
    fn take_prediction(&mut self, _positions: &[Vec3], _moves: &[Vec3]) {}

    /// Visits the vertices by which surfaces are bonded: faces between them do not warp freely.
    fn visit_bonded(&self, _visit: &mut dyn FnMut(u32)) {}

    /// The length scale of proximity in m: the size of a voxel.
    fn length(&self) -> f64;

    /// Releases bonds whose strength the forces at `positions`, an equilibrium, exceed. Returns whether any was
    /// released; its load goes to the others then.
    fn release_bonds(&mut self, positions: &[Vec3]) -> bool;

    /// Tests whether the solution depends on the load path, as with friction and with bonds that may break.
    fn depends_on_way(&self) -> bool;

    /// Deviation of friction at `positions`, an equilibrium, from a straight path, along which it would change since the
    /// last accepted state by `ratio` times its change in the step to that state, as a part of all its bounds; `None` if
    /// the way matters for more than friction, as for bonds that may break.
    fn deviation(&self, _positions: &[Vec3], _ratio: f64) -> Option<f64> {
        None
    }

    /// Accepts `positions` as the state from which the load path continues.
    fn accept(&mut self, positions: &[Vec3]);

    /// Accepts `positions` as the end of a step that was not solved to convergence: the multipliers are updated to the
    /// forces there, once. Returns `false`, and accepts nothing, where surfaces overlap so deeply that the side from
    /// which they came is no longer known.
    fn commit_partial(&mut self, positions: &[Vec3]) -> bool {
        self.accept(positions);
        true
    }

    /// Raises the contact penalty for the rest of the step where surfaces overlap too deeply at `positions`; returns
    /// whether any do.
    fn stiffen(&mut self, _positions: &[Vec3]) -> bool {
        false
    }

    /// Tests whether any surfaces press on each other at `positions`.
    fn is_touching(&self, positions: &[Vec3]) -> bool {
        self.energy(positions) > 0.0
    }

    /// Restores the last accepted state.
    fn rollback(&mut self);

    /// Tests whether the load path is being recorded, to be replayed.
    fn is_recorded(&self) -> bool {
        false
    }

    /// Extrapolates the multipliers of the last accepted state by their change in the step to it: a predictor for a
    /// step that is `ratio` times as long. The converged solution does not depend on it.
    fn extrapolate(&mut self, ratio: f64);
}

/// An equilibrium on a load path, under the contact state before a correction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Moment<M> {
    /// Positions of all vertices, m.
    pub positions: Vec<Vec3>,
    /// Set if contact had converged: a step of the path ends here.
    pub settled: bool,
    /// The contact state (memory).
    pub memory: M,
}

/// Contact that can replay its load path, which derivatives along the path need.
///
/// The contact of a slightly different problem is evaluated at the same moments: it uses the contact pairs of the
/// recorded one, and carries its own multipliers and anchors along.
pub trait RecordedContact: Contact {
    /// The contact state at a moment.
    type Memory: Clone + PartialEq + Send + Sync;

    /// The present contact state, settled at `positions` (m).
    fn moment(&self, positions: &[Vec3]) -> Moment<Self::Memory>;

    /// Starts recording at the next [`reset`](Contact::reset).
    fn record(&mut self);

    /// Takes the recorded moments of the accepted path, and stops recording.
    fn take_recorded(&mut self) -> Vec<Moment<Self::Memory>>;

    /// Restores a moment of its own recording. Returns whether the pattern of the stiffness has grown.
    fn recall(&mut self, moment: &Moment<Self::Memory>) -> bool;

    /// Takes over the contact pairs that another contact had at a moment.
    fn face_as(&mut self, moment: &Moment<Self::Memory>);

    /// Begins a step of a motion that ends at a moment: points that have come into contact get anchors from the way to
    /// `positions`, one for each contact of the group, and multipliers have those of the moment as their mean.
    fn begin_step(group: &mut [&mut Self], positions: &[Vec<Vec3>], moment: &Moment<Self::Memory>);

    /// Carries the multipliers and anchors of contacts from a moment to the `next`, with their vertices at `positions`.
    /// The contacts are those of problems with parameters around the recorded one, which is their mean.
    fn follow_on(
        group: &mut [&mut Self],
        positions: &[Vec<Vec3>],
        moment: &Moment<Self::Memory>,
        next: Option<&Moment<Self::Memory>>,
    );
}
