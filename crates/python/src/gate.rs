//! The one way from Python into long Rust work: frees the GIL and obeys Ctrl-C.
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::Duration;

use pyo3::prelude::*;

/// How often the waiting thread asks Python whether Ctrl-C was pressed.
const SIGNAL_PERIOD: Duration = Duration::from_millis(50);

/// Runs `work` on another thread with the GIL released.
///
/// Python handles signals on its main thread only, so the calling thread waits and asks every
/// [`SIGNAL_PERIOD`]. When a signal handler raises (`KeyboardInterrupt`), `cancel` is set, `work`
/// is expected to return early, and the exception is passed on.
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
        })
    })
}
