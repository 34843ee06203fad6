//! Exceptions of `voxsoft.errors`, raised from Rust with place, problem and advice.
use pyo3::prelude::*;
use voxsoft_solid::ProblemError;

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

/// The exception for each way in which a problem is not one: all are bad input, and `ValueError`s too.
pub fn to_python(error: ProblemError) -> PyErr {
    let (class, place) = match error {
        ProblemError::RestVolume { .. }
        | ProblemError::NotCubes { .. }
        | ProblemError::NotVoxels { .. } => ("MeshError", "mesh"),
        ProblemError::NotOneCube { .. } | ProblemError::OnTied { .. } => ("DesignError", "refine"),
        ProblemError::FlatMembrane { .. } => ("DesignError", "layers"),
        ProblemError::OnAxis { .. } => ("DesignError", "parts"),
        // The message says which.
        ProblemError::Length { .. }
        | ProblemError::Index { .. }
        | ProblemError::NotPositive { .. }
        | ProblemError::NotUnit { .. }
        | ProblemError::NotFinite { .. }
        | ProblemError::History { .. } => ("DesignError", ""),
    };
    Python::attach(|py| exception(py, class, place, &error.to_string(), ""))
}
