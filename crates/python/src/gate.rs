//! The ways from Python into long Rust work: they free the GIL and obey Ctrl-C.
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::Duration;

use pyo3::prelude::*;

/// How often the waiting thread asks Python whether Ctrl-C was pressed.
const SIGNAL_PERIOD: Duration = Duration::from_millis(50);

/// Runs `work` on another thread with the GIL released, and waits for its end even after Ctrl-C.
///
/// For work that borrows and looks at `cancel` often: it is set when a signal handler raises
/// (`KeyboardInterrupt`), and the exception is passed on once `work` has returned.
pub fn run<T, F>(py: Python<'_>, work: F) -> PyResult<T>
where
    T: Send,
    F: FnOnce(&AtomicBool) -> T + Send,
{
    let cancel = AtomicBool::new(false);
    py.detach(|| {
        std::thread::scope(|scope| {
            let (sender, receiver) = sync_channel(1);
            let flag = &cancel;
            scope.spawn(move || {
                let _ = sender.send(work(flag));
            });
            wait(&receiver, &cancel)
        })
    })
}

/// As [`run`] for work that owns what it needs, which Ctrl-C leaves behind.
///
/// A factorization or a sort cannot be stopped half-way. The exception does not wait for it: the thread
/// ends by itself when it next looks at `cancel`, or has finished, and its answer is dropped.
pub fn run_owned<T, F>(py: Python<'_>, work: F) -> PyResult<T>
where
    T: Send + 'static,
    F: FnOnce(&AtomicBool) -> T + Send + 'static,
{
    let cancel = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&cancel);
    py.detach(|| {
        let (sender, receiver) = sync_channel(1);
        std::thread::spawn(move || {
            let _ = sender.send(work(&flag));
        });
        wait(&receiver, &cancel)
    })
}

/// Waits for an answer. Python handles signals on its main thread only, so the calling thread asks
/// every [`SIGNAL_PERIOD`].
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
