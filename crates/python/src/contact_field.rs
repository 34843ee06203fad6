//! Contact field over the vertices of the body, for Python.
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use voxsoft_contact::surface_contact::SurfaceContact;
use voxsoft_solid::vector::Vec3;

use crate::arrays::from_rows;
use crate::surface_contact::Touching;

/// Contact pressure, friction and gap at the vertices of the body.
#[pyclass(frozen, get_all, name = "ContactField", module = "voxsoft._core")]
pub struct PyContactField {
    /// Contact pressure, Pa.
    pub pressure: Py<PyArray1<f64>>,
    /// Friction on the body, Pa.
    pub friction: Py<PyArray2<f64>>,
    /// Gap, m; infinite where nothing is near.
    pub gap: Py<PyArray1<f64>>,
    /// Area of the surface that each vertex stands for, m².
    pub area: Py<PyArray1<f64>>,
}

impl Touching {
    pub(crate) fn field(
        &self,
        py: Python<'_>,
        touch: &SurfaceContact,
        positions: &[Vec3],
    ) -> PyResult<Py<PyContactField>> {
        let found = touch.field(&self.seen(positions), self.own(), self.flips());
        let field = PyContactField {
            pressure: PyArray1::from_vec(py, found.pressure).unbind(),
            friction: from_rows(py, &found.friction).unbind(),
            gap: PyArray1::from_vec(py, found.gap).unbind(),
            area: PyArray1::from_vec(py, found.area).unbind(),
        };
        Py::new(py, field)
    }
}
