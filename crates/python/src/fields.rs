//! `_core.Fields`: stress and strain of a problem's body at any positions.
use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use voxsoft_solid::fields::{Field, Fields, Measure};
use voxsoft_solid::{Body, State};

use crate::arrays::from_rows;
use crate::gate;
use crate::simulate::PyProblem;

/// Elements of a problem's body: voxels, or tetrahedra where it is not made of voxels.
#[pyclass(frozen, name = "Fields", module = "voxsoft._core")]
pub struct PyFields {
    problem: Py<PyProblem>,
    fields: Fields,
    blocks: Vec<u32>,
}

/// Components of a symmetric matrix in the order of ParaView: xx, yy, zz, xy, yz, xz.
const COMPONENTS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]];

fn components(measure: &Measure) -> [f64; 6] {
    COMPONENTS.map(|[i, j]| measure.stress[i][j])
}

#[pymethods]
impl PyFields {
    #[new]
    fn new(py: Python<'_>, problem: Py<PyProblem>) -> PyResult<Self> {
        let now = problem.get().now();
        let (mesh, body) = (&problem.get().mesh, now.body());
        let (fields, blocks) = gate::run(py, |_| {
            let fields = Fields::of_all(body);
            let blocks = fields.blocks(body, mesh);
            (fields, blocks)
        })?;
        Ok(Self {
            fields,
            blocks,
            problem,
        })
    }

    /// Block of the mesh of each element.
    #[getter]
    fn blocks<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, &self.blocks)
    }

    /// Rest volume of the material of each element in m³.
    #[getter]
    fn volumes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.fields.volumes())
    }

    /// Stress and strain of each element, in the order of `blocks`.
    fn measure<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let positions = self.positions(&positions)?;
        let body = &*self.body();
        let measures = gate::run(py, |_| self.fields.measure(body, &positions))?;
        let column = |value: fn(&Measure) -> f64| -> Bound<'py, PyArray1<f64>> {
            PyArray1::from_vec(py, measures.iter().map(value).collect())
        };
        let stretches: Vec<[f64; 3]> = measures.iter().map(|m| m.stretches).collect();
        let stress: Vec<[f64; 6]> = measures.iter().map(components).collect();
        let found = PyDict::new(py);
        found.set_item("stress", from_rows(py, &stress))?;
        found.set_item("von_mises", column(|m| m.von_mises))?;
        found.set_item("stretches", from_rows(py, &stretches))?;
        found.set_item("energy_density", column(|m| m.energy_density))?;
        found.set_item("volume_ratio", column(|m| m.volume_ratio))?;
        Ok(found)
    }

    /// Number of inverted elements: those with a volume ratio of zero or less.
    fn inverted(&self, py: Python<'_>, positions: PyReadonlyArray2<'_, f64>) -> PyResult<usize> {
        let positions = self.positions(&positions)?;
        let body = &*self.body();
        gate::run(py, |_| self.fields.inverted(body, &positions))
    }

    /// Stress and strain averaged on the vertices of the body, as the studio colors by them; vertices that carry
    /// objects are left out.
    fn at_vertices<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let body = &*self.body();
        let own = self.problem.get().own();
        let mut state = State::at_rest(body);
        state.positions = self.positions(&positions)?;
        let (stress, scalars) = gate::run(py, |_| {
            let measures = self.fields.measure(body, &state.positions);
            let smooth = |k: usize| {
                let values: Vec<f64> = measures.iter().map(|m| components(m)[k]).collect();
                self.fields.smooth(&values)
            };
            let columns: [Vec<f64>; 6] = std::array::from_fn(smooth);
            let stress: Vec<[f64; 6]> = (0..own)
                .map(|vertex| std::array::from_fn(|k| columns[k][vertex]))
                .collect();
            let mut scalars = [Field::VonMises, Field::Stretch, Field::EnergyDensity]
                .map(|field| self.fields.evaluate(body, &state, field));
            scalars.iter_mut().for_each(|values| values.truncate(own));
            (stress, scalars)
        })?;
        let found = PyDict::new(py);
        found.set_item("stress", from_rows(py, &stress))?;
        for (name, values) in ["von_mises", "max_stretch", "energy_density"]
            .into_iter()
            .zip(scalars)
        {
            found.set_item(name, PyArray1::from_vec(py, values))?;
        }
        Ok(found)
    }

    /// The derivative of the largest principal stretch of an element by the positions of the vertices of the
    /// body, in 1/m.
    fn stretch_slope<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
        element: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let positions = self.positions(&positions)?;
        let count = self.blocks.len();
        if element >= count {
            let message = format!("element {element} is past the last of {count}");
            return Err(PyIndexError::new_err(message));
        }
        let slope = self.fields.stretch_slope(&self.body(), &positions, element);
        Ok(from_rows(py, &slope[..self.problem.get().own()]))
    }
}

impl PyFields {
    fn body(&self) -> Arc<Body> {
        self.problem.get().now().shared_body()
    }

    fn positions(&self, array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; 3]>> {
        self.problem.get().positions(array)
    }
}
