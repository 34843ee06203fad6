//! Python binding: conversions, error mapping and release of the GIL. No numerics.
use pyo3::prelude::*;

mod answer;
mod arrays;
mod blocks;
mod contact;
mod contact_answer;
mod contact_field;
mod display;
mod ensemble;
mod equilibrium;
mod errors;
mod fields;
mod gate;
mod handle;
mod live;
mod materials;
mod mesh;
mod modes;
mod plain;
mod player;
mod problem_parts;
mod sensitivity;
mod shapes;
mod simulate;
mod skin;
mod surface_contact;
mod tendon;
mod transient;
mod voxels;
mod watch;

/// The private Rust module `voxsoft._core`; the public package wraps it.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<answer::PyAnswer>()?;
    module.add_class::<answer::PyPath>()?;
    module.add_class::<answer::PySettlement>()?;
    module.add_class::<answer::PyStatus>()?;
    module.add_class::<handle::PyMemory>()?;
    module.add_class::<answer::PyAdvance>()?;
    module.add_class::<answer::PyLiveStatus>()?;
    module.add_class::<materials::PyMaterial>()?;
    module.add_class::<materials::PyFiber>()?;
    module.add_class::<materials::PyWinding>()?;
    module.add_class::<tendon::PyTendon>()?;
    module.add_class::<contact_answer::PyContact>()?;
    module.add_class::<contact_field::PyContactField>()?;
    module.add_class::<skin::PySkin>()?;
    module.add_class::<contact_answer::PyObjectPose>()?;
    module.add_class::<contact_answer::PyTouchHistory>()?;
    module.add_class::<simulate::PyProblem>()?;
    module.add_class::<problem_parts::PyProblemParts>()?;
    module.add_class::<ensemble::PyEnsemble>()?;
    module.add_class::<fields::PyFields>()?;
    module.add_class::<display::PyOutline>()?;
    module.add_class::<display::PyDisplay>()?;
    module.add_function(wrap_pyfunction!(display::pack_smooth, module)?)?;
    module.add_class::<live::PyLive>()?;
    module.add_class::<player::PyScene>()?;
    module.add_class::<player::PyPlayer>()?;
    player::add_constants(module)?;
    module.add_function(wrap_pyfunction!(equilibrium::equilibrium, module)?)?;
    module.add_function(wrap_pyfunction!(equilibrium::adjoint, module)?)?;
    module.add_function(wrap_pyfunction!(blocks::block_slopes, module)?)?;
    module.add_function(wrap_pyfunction!(blocks::block_masses, module)?)?;
    module.add_function(wrap_pyfunction!(blocks::block_energies, module)?)?;
    module.add_function(wrap_pyfunction!(blocks::with_fractions, module)?)?;
    module.add_function(wrap_pyfunction!(modes::modes, module)?)?;
    module.add_function(wrap_pyfunction!(sensitivity::sensitivities, module)?)?;
    module.add_function(wrap_pyfunction!(sensitivity::recording, module)?)?;
    module.add_function(wrap_pyfunction!(sensitivity::recorded_contact, module)?)?;
    module.add_function(wrap_pyfunction!(sensitivity::same_surfaces, module)?)?;
    module.add_function(wrap_pyfunction!(sensitivity::contacts_at, module)?)?;
    module.add_function(wrap_pyfunction!(transient::transient, module)?)?;
    module.add_class::<shapes::PyShape>()?;
    module.add_class::<voxels::PyGrid>()?;
    module.add_function(wrap_pyfunction!(voxels::closed_voids, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::mesh_voxels, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::mesh_tets, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::mesh_pieces, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::mesh_quality, module)?)?;
    module.add_function(wrap_pyfunction!(contact::penetration, module)?)?;
    Ok(())
}
