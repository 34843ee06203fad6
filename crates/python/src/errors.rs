//! Exceptions of `voxsoft.errors`, raised from Rust with place, problem and advice.
use pyo3::prelude::*;

/// An exception of the package's tree: `class(place, what, hint)`.
///
/// If the package cannot be imported, the import error is what the caller sees.
pub fn exception(py: Python<'_>, class: &str, place: &str, what: &str, hint: &str) -> PyErr {
    let made = py
        .import("voxsoft.errors")
        .and_then(|module| module.getattr(class))
        .and_then(|class| class.call1((place, what, hint)));
    made.map_or_else(|error| error, PyErr::from_value)
}
