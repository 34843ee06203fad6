//! Self-intersection of a body.
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voxsoft_contact::{Body, Covered, Overlap, penetration as find};

use crate::gate;

/// An overlap: depth, present point, both points of the unloaded body, both tets, inverted or not.
type PyOverlap = (f64, [f64; 3], [[f64; 3]; 2], [i32; 2], bool);

/// Pairs of triangles, overlaps, and covered vertices, each with the tet that it is in and its overlap.
type PyPenetration<'py> = (
    Bound<'py, PyArray2<u32>>,
    Vec<PyOverlap>,
    Bound<'py, PyArray2<i32>>,
);

#[pyfunction]
pub fn penetration<'py>(
    py: Python<'py>,
    rest: PyReadonlyArray2<'py, f64>,
    positions: PyReadonlyArray2<'py, f64>,
    tets: PyReadonlyArray2<'py, i32>,
    triangles: PyReadonlyArray2<'py, i32>,
    membranes: PyReadonlyArray2<'py, i32>,
) -> PyResult<PyPenetration<'py>> {
    let body = Body {
        rest: rows(&rest)?,
        positions: rows(&positions)?,
        tets: rows(&tets)?,
        triangles: rows(&triangles)?,
        membranes: rows(&membranes)?,
    };
    let found = gate::run(py, |_| find(&body))?;
    let rows = |c: &Covered| [c.vertex, c.tet, c.overlap as i32];
    let covered: Vec<[i32; 3]> = found.covered.iter().map(rows).collect();
    let count = covered.len();
    let plain = |o: &Overlap| (o.depth, o.now, o.rest, o.tets, o.inverted);
    let pairs = found.pairs.len();
    Ok((
        found
            .pairs
            .into_flattened()
            .into_pyarray(py)
            .reshape([pairs, 2])?,
        found.overlaps.iter().map(plain).collect(),
        covered
            .into_flattened()
            .into_pyarray(py)
            .reshape([count, 3])?,
    ))
}

/// The rows of a matrix in place, not copied.
fn rows<'a, const N: usize, T: numpy::Element>(
    array: &'a PyReadonlyArray2<'_, T>,
) -> PyResult<&'a [[T; N]]> {
    let wrong = || PyValueError::new_err(format!("expected rows of {N}, one after the other"));
    if array.shape()[1] != N {
        return Err(wrong());
    }
    let flat = array.as_slice().map_err(|_| wrong())?;
    Ok(flat.as_chunks().0)
}
