//! Python binding: conversions, error mapping and the gate that frees the GIL. No numerics.
use pyo3::prelude::*;

mod gate;

/// The private Rust module `voxsoft._core`; the public package wraps it.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    Ok(())
}
