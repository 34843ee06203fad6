//! A problem with the memory that its last solution has left.
use std::sync::{Arc, PoisonError, RwLock};

use voxsoft_solid::{Memory, Problem};

/// The problem of a `_core.Problem`, as all that belongs to it sees it: displays, fields, what is asked after a solution.
///
/// Each solution works on a value of its own and leaves its memory here, which replaces the value whole.
pub(crate) struct Handle(RwLock<Arc<Problem>>);

impl Handle {
    pub fn new(problem: Problem) -> Self {
        Self(RwLock::new(Arc::new(problem)))
    }

    /// The problem with its memory now.
    pub fn now(&self) -> Arc<Problem> {
        // A value is replaced whole, so that a thread that died leaves none half written.
        Arc::clone(&self.0.read().unwrap_or_else(PoisonError::into_inner))
    }

    /// Takes the memory of a solution.
    pub fn remember(&self, memory: &Memory) {
        self.change(|problem| problem.remember(memory));
    }

    /// Lets the problem go on from other memory.
    pub fn change(&self, act: impl FnOnce(&mut Problem)) {
        let mut kept = self.0.write().unwrap_or_else(PoisonError::into_inner);
        act(Arc::make_mut(&mut kept));
    }
}
