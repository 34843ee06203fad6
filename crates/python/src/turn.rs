//! Whose turn a problem is: it remembers contact, tendons, fluids, growth and softening of one solution at a time.
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use pyo3::prelude::*;

use crate::errors::exception;

/// Whether a problem is being solved.
#[derive(Default)]
pub struct Turns(Arc<AtomicBool>);

/// The problem is this solution's until the last clone of it is dropped: by the thread of the pool that solves, which goes on
/// for a while after Ctrl-C, or by who reads the answer.
#[derive(Clone)]
pub struct Turn(#[expect(dead_code, reason = "dropped is what it is for")] Arc<Release>);

struct Release(Arc<AtomicBool>);

impl Drop for Release {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Release);
    }
}

impl Turns {
    /// Takes the turn; a `SimulationError` where another solution has it.
    pub fn take(&self, py: Python<'_>) -> PyResult<Turn> {
        if self.0.swap(true, Ordering::Acquire) {
            return Err(exception(
                py,
                "SimulationError",
                "setup",
                "is being solved already, and what it remembers of contact, tendons and supplies is that of one solution",
                "wait for the end of the other solution, or give each thread a Setup of its own",
            ));
        }
        Ok(Turn(Arc::new(Release(Arc::clone(&self.0)))))
    }
}
