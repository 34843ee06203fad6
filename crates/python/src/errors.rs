//! Exceptions of `voxsoft.errors`, raised from Rust with place, problem and hint.
use pyo3::prelude::*;
use voxsoft_solid::ProblemError;

/// Makes an exception of the package's hierarchy from its class, place, message and hint.
///
/// If the package cannot be imported, returns the import error.
pub fn exception(py: Python<'_>, class: &str, place: &str, what: &str, hint: &str) -> PyErr {
    let made = py
        .import("voxsoft.errors")
        .and_then(|module| module.getattr(class))
        .and_then(|class| class.call1((place, what, hint)));
    made.map_or_else(|error| error, PyErr::from_value)
}

/// Maps each error of a problem to its exception: all are invalid input, and `ValueError`s too.
pub fn to_python(error: ProblemError) -> PyErr {
    let (class, place) = match error {
        ProblemError::RestVolume { .. }
        | ProblemError::NotCubes { .. }
        | ProblemError::NotVoxels { .. } => ("MeshError", "mesh"),
        ProblemError::NotOneCube { .. } | ProblemError::OnTied { .. } => ("DesignError", "refine"),
        ProblemError::FlatMembrane { .. } => ("DesignError", "layers"),
        ProblemError::OnAxis { .. } => ("DesignError", "parts"),
        // The message names the place.
        ProblemError::Length { .. }
        | ProblemError::Index { .. }
        | ProblemError::NotPositive { .. }
        | ProblemError::NotUnit { .. }
        | ProblemError::NotFinite { .. }
        | ProblemError::History { .. } => ("DesignError", ""),
    };
    Python::attach(|py| exception(py, class, place, &error.to_string(), ""))
}
