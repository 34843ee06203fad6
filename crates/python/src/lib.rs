//! Python binding: conversions, error mapping and the gate that frees the GIL. No numerics.
use pyo3::prelude::*;

mod gate;
mod simulate;

/// The private Rust module `voxsoft._core`; the public package wraps it.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<simulate::PyProblem>()?;
    module.add_class::<simulate::PyProblemParts>()?;
    module.add_function(wrap_pyfunction!(simulate::lattice_constants, module)?)?;
    Ok(())
}
