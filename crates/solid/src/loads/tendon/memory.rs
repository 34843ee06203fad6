//! What a tendon remembers of the state that was accepted last.

use std::sync::{Arc, Mutex, PoisonError};

/// A state.
#[derive(Debug, Clone, Default)]
pub(super) struct Kept {
    /// Of each segment, in N.
    pub tensions: Vec<f64>,
    /// Of each segment, in m.
    pub lengths: Vec<f64>,
    /// `e^{−μθ}` of each bend.
    pub decays: Vec<f64>,
}

/// Of copies of one problem the same; nothing before a state was accepted.
#[derive(Debug, Clone, Default)]
pub(super) struct Memory(Arc<Mutex<Option<Kept>>>);

impl Memory {
    fn look<T>(&self, act: impl FnOnce(&mut Option<Kept>) -> T) -> T {
        // States are replaced whole, so that a thread that died leaves none half written.
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    pub fn keep(&self, state: Kept) {
        self.look(|kept| *kept = Some(state));
    }

    pub fn forget(&self) {
        self.look(|kept| *kept = None);
    }

    pub fn kept(&self) -> Option<Kept> {
        self.look(|kept| kept.clone())
    }
}

/// What is remembered does not tell one tendon from another.
impl PartialEq for Memory {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
