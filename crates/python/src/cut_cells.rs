//! Cells that a surface cuts: filled fractions of their small cubes, integrals, and closed voids.
use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
    PyReadonlyArray3,
};
use pyo3::prelude::*;
use voxsoft_shape::cut::{self, ALL, CellState, Filled, Neighbors};
use voxsoft_shape::{FieldError, Shape};

use crate::gate;
use crate::shapes::{PyShape, sample_error};

type Rows<'py> = Bound<'py, PyArray2<f64>>;

/// Filled fraction of each small cube, normals there, and the share of each shape in each cell.
type PyFilled<'py> = (Rows<'py>, Bound<'py, PyArray3<f64>>, Rows<'py>);

/// Numbers of masks, and small cubes of each.
type PyVoid<'py> = (Bound<'py, PyArray1<u32>>, Bound<'py, PyArray1<u32>>);

fn owned(shapes: &[PyRef<'_, PyShape>]) -> Vec<Shape> {
    shapes.iter().map(|shape| shape.0.clone()).collect()
}

fn points(rows: &PyReadonlyArray2<'_, f64>) -> Vec<[f64; 3]> {
    let rows = rows.as_array();
    rows.rows()
        .into_iter()
        .map(|p| [p[0], p[1], p[2]])
        .collect()
}

fn field_error(py: Python<'_>, error: FieldError) -> PyErr {
    sample_error(py, &error.into())
}

fn matrix<'py, const N: usize>(py: Python<'py>, rows: Vec<[f64; N]>) -> PyResult<Rows<'py>> {
    let count = rows.len();
    rows.into_flattened().into_pyarray(py).reshape([count, N])
}

#[pyfunction]
pub fn fill_cells<'py>(
    py: Python<'py>,
    shapes: Vec<PyRef<'py, PyShape>>,
    corners: PyReadonlyArray2<'py, f64>,
    size: f64,
) -> PyResult<PyFilled<'py>> {
    let (shapes, corners) = (owned(&shapes), points(&corners));
    let count = (corners.len(), shapes.len());
    let found = gate::run_owned(py, move |_| cut::fill(&shapes, &corners, size))?;
    let found = found.map_err(|error| field_error(py, error))?;
    let normals = found.normals.into_flattened().into_flattened();
    Ok((
        matrix(py, found.filled)?,
        normals.into_pyarray(py).reshape([count.0, ALL, 3])?,
        found.shares.into_pyarray(py).reshape([count.0, count.1])?,
    ))
}

/// Integrals over the material of cells, (k, 10), and over its surface, (k, 25); `known` are their small cubes, where
/// they have been filled before.
#[pyfunction]
#[pyo3(signature = (shapes, corners, size, beyond, behind, gives, known = None))]
#[expect(
    clippy::too_many_arguments,
    reason = "the arguments of Python's function"
)]
pub fn cut_measures<'py>(
    py: Python<'py>,
    shapes: Vec<PyRef<'py, PyShape>>,
    corners: PyReadonlyArray2<'py, f64>,
    size: f64,
    beyond: PyReadonlyArray3<'py, i32>,
    behind: PyReadonlyArray3<'py, i32>,
    gives: PyReadonlyArray1<'py, bool>,
    known: Option<(PyReadonlyArray2<'py, f64>, PyReadonlyArray3<'py, f64>)>,
) -> PyResult<(Rows<'py>, Rows<'py>)> {
    let (shapes, corners) = (owned(&shapes), points(&corners));
    let (beyond, behind) = (sides(&beyond), sides(&behind));
    let gives = gives.as_array().to_vec();
    let known = known.map(|(filled, normals)| cubes(&filled, &normals));
    let work = move |_: &_| {
        let cubes = match known {
            Some(cubes) => cubes,
            None => cut::fill(&shapes, &corners, size)?,
        };
        let neighbors = Neighbors {
            beyond: &beyond,
            behind: &behind,
            gives: &gives,
        };
        Ok(cut::measures(cubes, neighbors))
    };
    let found = gate::run_owned(py, work)?.map_err(|error| field_error(py, error))?;
    Ok((matrix(py, found.material)?, matrix(py, found.surface)?))
}

fn cubes(filled: &PyReadonlyArray2<'_, f64>, normals: &PyReadonlyArray3<'_, f64>) -> Filled {
    let (filled, normals) = (filled.as_array(), normals.as_array());
    let parts = |cell: ArrayView1<'_, f64>| std::array::from_fn(|cube| cell[cube]);
    let normal = |cell: ArrayView2<'_, f64>| {
        std::array::from_fn(|cube| [0, 1, 2].map(|axis| cell[[cube, axis]]))
    };
    Filled {
        filled: filled.outer_iter().map(parts).collect(),
        normals: normals.outer_iter().map(normal).collect(),
        shares: vec![],
    }
}

fn sides(numbers: &PyReadonlyArray3<'_, i32>) -> Vec<[[i32; 2]; 3]> {
    let numbers = numbers.as_array();
    let cells = numbers.outer_iter();
    cells
        .map(|cell| [0, 1, 2].map(|axis| [cell[[axis, 0]], cell[[axis, 1]]]))
        .collect()
}

/// Integrals over the filled parts of small cubes, (k, 10).
#[pyfunction]
pub fn material_integrals<'py>(
    py: Python<'py>,
    filled: PyReadonlyArray2<'py, f64>,
    normals: PyReadonlyArray3<'py, f64>,
) -> PyResult<Rows<'py>> {
    let (filled, normals) = (filled.as_array(), normals.as_array());
    let found = filled.outer_iter().zip(normals.outer_iter());
    let found = found.map(|(parts, normals)| {
        let parts = std::array::from_fn(|cube| parts[cube]);
        let unit = |cube| cut::unit([0, 1, 2].map(|axis| normals[[cube, axis]]));
        cut::integrals(&parts, &std::array::from_fn(unit))
    });
    matrix(py, found.collect())
}

/// Closed voids of cells: for each the numbers of the masks that it touches and how many small cubes of them. A state is
/// the number of a mask, −1 for a full cell, −2 for an open one.
#[pyfunction]
pub fn closed_voids<'py>(
    py: Python<'py>,
    states: PyReadonlyArray3<'py, i32>,
    masks: PyReadonlyArray1<'py, u64>,
) -> PyResult<Vec<PyVoid<'py>>> {
    let states = states.as_array();
    let shape = [states.shape()[0], states.shape()[1], states.shape()[2]];
    let cells: Vec<CellState> = states
        .iter()
        .map(|&state| match state {
            -1 => CellState::Full,
            -2 => CellState::Open,
            mask => CellState::Cut(mask as u32),
        })
        .collect();
    let masks = masks.as_array().to_vec();
    let found = gate::run_owned(py, move |_| cut::closed_voids(shape, &cells, &masks))?;
    Ok(found
        .into_iter()
        .map(|void| {
            let (cells, counts): (Vec<u32>, Vec<u32>) = void.into_iter().unzip();
            (cells.into_pyarray(py), counts.into_pyarray(py))
        })
        .collect())
}

/// The region of each small cube, (k, 64), from those of the cells in the window around its cell, (k, 125).
#[pyfunction]
pub fn nearest_regions<'py>(
    py: Python<'py>,
    windows: PyReadonlyArray2<'py, i16>,
) -> PyResult<Bound<'py, PyArray2<i16>>> {
    let windows = windows.as_array();
    let rows = windows.outer_iter();
    let found: Vec<[i16; ALL]> = rows
        .map(|row| cut::nearest_region(&std::array::from_fn(|cell| row[cell])))
        .collect();
    let count = found.len();
    found
        .into_flattened()
        .into_pyarray(py)
        .reshape([count, ALL])
}
