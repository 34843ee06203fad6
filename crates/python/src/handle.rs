//! A problem whose voxels may be softened from outside.
use std::sync::{Arc, PoisonError, RwLock};

use voxsoft_solid::Problem;

/// The problem of a `_core.Problem`, as its displays and fields see it.
///
/// Each solution works on a value of its own; peaks of softening, which a stored result brings along, replace the value whole.
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

    /// Lets the problem go on from other memory.
    pub fn change(&self, act: impl FnOnce(&mut Problem)) {
        let mut kept = self.0.write().unwrap_or_else(PoisonError::into_inner);
        act(Arc::make_mut(&mut kept));
    }
}
