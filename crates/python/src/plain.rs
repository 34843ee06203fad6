//! Plain data of Python, as dictionaries and sequences by the names of fields, for types of the core.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::de::DeserializeOwned;

/// Reads `data` as a `T`; an error begins with `name`.
pub fn plain<T: DeserializeOwned>(name: &str, data: &Bound<'_, PyAny>) -> PyResult<T> {
    pythonize::depythonize(data).map_err(|error| PyValueError::new_err(format!("{name}: {error}")))
}
