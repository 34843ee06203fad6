//! What a tendon remembers of the state that was accepted last.

use std::sync::{Arc, Mutex, PoisonError};

/// Tensions (N) and lengths (m) of all segments; of copies of one problem the same. Empty before anything was accepted.
#[derive(Debug, Clone, Default)]
pub(super) struct Memory(Arc<Mutex<(Vec<f64>, Vec<f64>)>>);

impl Memory {
    fn look<T>(&self, act: impl FnOnce(&mut (Vec<f64>, Vec<f64>)) -> T) -> T {
        // Values are replaced whole, so that a thread that died leaves none half written.
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Those that were there; where nothing was accepted yet, none and the lengths at rest.
    pub fn tensions_and_lengths(&self, rest: &[f64]) -> (Vec<f64>, Vec<f64>) {
        self.look(|(tensions, lengths)| {
            if lengths.is_empty() {
                (vec![0.0; rest.len()], rest.to_vec())
            } else {
                (tensions.clone(), lengths.clone())
            }
        })
    }

    pub fn keep(&self, tensions: Vec<f64>, lengths: Vec<f64>) {
        self.look(|kept| *kept = (tensions, lengths));
    }

    pub fn forget(&self) {
        self.keep(Vec::new(), Vec::new());
    }

    /// The tension at the pulled end.
    pub fn first(&self) -> Option<f64> {
        self.look(|(tensions, _)| tensions.first().copied())
    }

    /// The ratio of each tension to the first, one where nothing was pulled; and the first.
    pub fn ratios_and_first(&self, segments: usize) -> (Vec<f64>, f64) {
        self.look(|(tensions, _)| match tensions.first() {
            Some(first) if *first > 0.0 => (tensions.iter().map(|t| t / first).collect(), *first),
            _ => (vec![1.0; segments], 0.0),
        })
    }
}

/// What is remembered does not tell one tendon from another.
impl PartialEq for Memory {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
