//! NumPy arrays as rows of numbers, and back.
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voxsoft_solid::vector::Vec3;

/// Rows of a NumPy array with N columns; a `ValueError` says so of any other.
pub(crate) fn rows<const N: usize, T: numpy::Element + Copy>(
    what: &str,
    array: &PyReadonlyArray2<'_, T>,
) -> PyResult<Vec<[T; N]>> {
    let view = array.as_array();
    if view.ncols() != N {
        let message = format!("{what} must have {N} columns, got {}", view.ncols());
        return Err(PyValueError::new_err(message));
    }
    let row = |row: numpy::ndarray::ArrayView1<'_, T>| std::array::from_fn(|i| row[i]);
    Ok(view.rows().into_iter().map(row).collect())
}

/// One row for each vertex of a mesh.
pub(crate) fn of_vertices(
    what: &str,
    array: &PyReadonlyArray2<'_, f64>,
    expected: usize,
) -> PyResult<Vec<Vec3>> {
    let read: Vec<Vec3> = rows(what, array)?;
    let got = read.len();
    let message = || PyValueError::new_err(format!("{what}: {got} rows, expected {expected}"));
    (got == expected).then_some(read).ok_or_else(message)
}

/// Rows as a NumPy array, (n, N).
pub(crate) fn from_rows<'py, const N: usize, T: numpy::Element + Copy>(
    py: Python<'py>,
    rows: &[[T; N]],
) -> Bound<'py, PyArray2<T>> {
    PyArray1::from_slice(py, rows.as_flattened())
        .reshape([rows.len(), N])
        .expect("a flattened array of rows has rows times N entries")
}
