//! `_core.Skin`: the smooth surface of a body, for contact.
use std::sync::Arc;

use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voxsoft_contact::skin::Skin;
use voxsoft_shape::{FieldError, Shape};
use voxsoft_solid::vector::Vec3;

use crate::arrays::{from_rows, rows};
use crate::gate;
use crate::shapes::{PyShape, sample_error};

/// Smooth surface of a body of voxels, interpolated from their vertices.
#[pyclass(frozen, name = "Skin", module = "voxsoft._core")]
pub struct PySkin(pub(crate) Arc<Skin>);

#[pymethods]
impl PySkin {
    /// Makes the surface of voxels with these corners among vertices (m), filled from the union of the shapes.
    #[new]
    fn new(
        py: Python<'_>,
        shapes: Vec<PyRef<'_, PyShape>>,
        vertices: PyReadonlyArray2<'_, f64>,
        voxels: PyReadonlyArray2<'_, u32>,
    ) -> PyResult<Self> {
        let shapes: Vec<Shape> = shapes.iter().map(|shape| shape.0.clone()).collect();
        let vertices: Vec<Vec3> = rows("vertices", &vertices)?;
        let voxels: Vec<[u32; 8]> = rows("voxels", &voxels)?;
        let skin = gate::run(py, |_| {
            Skin::of(&voxels, &vertices, |places| union(&shapes, places))
        })?;
        let skin = skin.map_err(|error| sample_error(py, &error.into()))?;
        Ok(Self(Arc::new(skin)))
    }

    /// Rest positions of its points, m.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        from_rows(py, &self.0.points)
    }

    /// Positions (m) of its points for `positions` (m) of the vertices that carry them.
    fn at<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let positions: Vec<Vec3> = rows("positions", &positions)?;
        let carriers = self.0.surface.points.iter().flat_map(|p| &p.vertices);
        let count = carriers.max().map_or(0, |last| *last as usize + 1);
        if positions.len() < count {
            let message = format!("positions: {} rows, expected {count}", positions.len());
            return Err(PyValueError::new_err(message));
        }
        let points: Vec<Vec3> = (self.0.surface.points.iter())
            .map(|point| point.at(&positions))
            .collect();
        Ok(from_rows(py, &points))
    }

    /// Triangles of points, oriented outward.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<u32>> {
        from_rows(py, &self.0.surface.triangles)
    }
}

/// Minimum of the functions of several shapes; infinite where all are NaN.
fn union(shapes: &[Shape], places: &[Vec3]) -> Result<Vec<f64>, FieldError> {
    let mut least = vec![f64::INFINITY; places.len()];
    for shape in shapes {
        for (least, value) in least.iter_mut().zip(shape.evaluate(places)?) {
            *least = least.min(value);
        }
    }
    Ok(least)
}
