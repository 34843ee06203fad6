//! Entry points from Python into long Rust work: they release the GIL and handle Ctrl-C.
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::Duration;

use pyo3::prelude::*;

/// Period at which the waiting thread checks Python's signals for Ctrl-C.
const SIGNAL_PERIOD: Duration = Duration::from_millis(50);

/// Runs `work` on a thread of the pool that its parallel loops use, with the GIL released, and waits for its
/// end even after Ctrl-C.
///
/// A parallel loop started within the pool need not hand over to another thread; from outside each would cost two
/// context switches, as long as meshing a small body takes. For work that borrows and checks `cancel` often: it is set
/// when a signal handler raises (`KeyboardInterrupt`), and the exception is passed on once `work` has returned.
pub fn run<T, F>(py: Python<'_>, work: F) -> PyResult<T>
where
    T: Send,
    F: FnOnce(&AtomicBool) -> T + Send,
{
    let cancel = AtomicBool::new(false);
    if within_pool() {
        return Ok(py.detach(|| work(&cancel)));
    }
    py.detach(|| {
        rayon::in_place_scope(|scope| {
            let (sender, receiver) = sync_channel(1);
            let flag = &cancel;
            scope.spawn(move |_| {
                let _ = sender.send(work(flag));
            });
            wait(&receiver, &cancel)
        })
    })
}

/// Runs `work` like [`run`], but for work that owns its data and is abandoned on Ctrl-C.
///
/// A factorization or a sort cannot be stopped half-way. The exception does not wait for it: the thread ends by itself
/// when it next checks `cancel`, or has finished, and its answer is dropped.
pub fn run_owned<T, F>(py: Python<'_>, work: F) -> PyResult<T>
where
    T: Send + 'static,
    F: FnOnce(&AtomicBool) -> T + Send + 'static,
{
    let cancel = Arc::new(AtomicBool::new(false));
    if within_pool() {
        return Ok(py.detach(|| work(&cancel)));
    }
    let flag = Arc::clone(&cancel);
    py.detach(|| {
        let (sender, receiver) = sync_channel(1);
        rayon::spawn(move || {
            // A panic here would end the process; without an answer the waiting thread reports it.
            if let Ok(answer) = catch_unwind(AssertUnwindSafe(|| work(&flag))) {
                let _ = sender.send(answer);
            }
        });
        wait(&receiver, &cancel)
    })
}

/// True on a thread of the pool: work there has called Python (a shape's function, say), which calls the core in turn.
/// Waiting for the pool could then deadlock.
fn within_pool() -> bool {
    rayon::current_thread_index().is_some()
}

/// Waits for an answer. Python handles signals on its main thread only, so the calling thread checks them every
/// [`SIGNAL_PERIOD`].
fn wait<T>(receiver: &Receiver<T>, cancel: &AtomicBool) -> PyResult<T> {
    loop {
        match receiver.recv_timeout(SIGNAL_PERIOD) {
            Ok(value) => return Ok(value),
            Err(RecvTimeoutError::Timeout) => {
                if let Err(raised) = Python::attach(|py| py.check_signals()) {
                    cancel.store(true, Ordering::Relaxed);
                    return Err(raised);
                }
            }
            Err(RecvTimeoutError::Disconnected) => {
                return Err(pyo3::exceptions::PyRuntimeError::new_err(
                    "the Rust core panicked; please report this with the input that caused it",
                ));
            }
        }
    }
}
