//! Meshes as tuples of arrays: made from a grid or from tetrahedra, and their quality.
use std::sync::Arc;

use numpy::{
    Element, IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
};
use pyo3::prelude::*;
use voxsoft_voxel::{self as voxel, FromTetsError, StitchError, TetMesh};

use crate::errors::exception;
use crate::gate;
use crate::voxels::PyGrid;

/// Triangles, volume and area of a cavity.
type PyCavity<'py> = (Bound<'py, PyArray2<i32>>, f64, f64);

/// Vertices, tets, edges, triangles, part of each tet, cavities.
type PyTetMesh<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<i32>>,
    Bound<'py, PyArray2<i32>>,
    Bound<'py, PyArray2<i32>>,
    Bound<'py, PyArray1<u8>>,
    Vec<PyCavity<'py>>,
);

/// Volume, smallest tet, largest tet, area, Euler number, conforming, open edges, non-manifold edges.
type PyQuality<'py> = (
    f64,
    f64,
    f64,
    f64,
    i64,
    bool,
    usize,
    Bound<'py, PyArray2<i32>>,
);

#[pyfunction]
pub fn mesh_voxels<'py>(
    py: Python<'py>,
    grid: &PyGrid,
    memory_limit: u64,
) -> PyResult<PyTetMesh<'py>> {
    let grid = Arc::clone(&grid.0);
    let work = move |cancel: &_| voxel::tet_mesh_until(&grid, memory_limit, cancel);
    match gate::run_owned(py, work)? {
        Ok(mesh) => mesh_to_python(py, mesh),
        Err(error) => Err(stitch_error(py, &error)),
    }
}

#[pyfunction]
pub fn mesh_tets<'py>(
    py: Python<'py>,
    vertices: PyReadonlyArray2<'py, f64>,
    tets: PyReadonlyArray2<'py, i32>,
    tet_part: PyReadonlyArray1<'py, u8>,
) -> PyResult<PyTetMesh<'py>> {
    let (vertices, tets) = (rows_from(&vertices), rows_from(&tets));
    let tet_part = tet_part.as_array().to_vec();
    let work = move |_: &_| voxel::mesh_from_tets(vertices, tets, tet_part);
    match gate::run_owned(py, work)? {
        Ok(mesh) => mesh_to_python(py, mesh),
        Err(error) => Err(from_tets_error(py, &error)),
    }
}

/// Face-connected component of each tetrahedron, numbered from 0 in the order of their first tetrahedra.
#[pyfunction]
pub fn mesh_pieces<'py>(
    py: Python<'py>,
    tets: PyReadonlyArray2<'py, i32>,
) -> Bound<'py, PyArray1<u32>> {
    let tets = rows_from(&tets);
    py.detach(|| voxel::pieces(&tets)).into_pyarray(py)
}

#[pyfunction]
pub fn mesh_quality<'py>(
    py: Python<'py>,
    vertices: PyReadonlyArray2<'py, f64>,
    tets: PyReadonlyArray2<'py, i32>,
    edges: PyReadonlyArray2<'py, i32>,
    triangles: PyReadonlyArray2<'py, i32>,
) -> PyResult<PyQuality<'py>> {
    let mesh = TetMesh {
        vertices: rows_from(&vertices),
        keys: Vec::new(),
        tets: rows_from(&tets),
        edges: rows_from(&edges),
        triangles: rows_from(&triangles),
        tet_part: Vec::new(),
        voxel_cells: Vec::new(),
        voxel_size: None,
        cavities: Vec::new(),
    };
    let quality = gate::run_owned(py, move |_| voxel::quality(&mesh))?;
    Ok((
        quality.volume,
        quality.smallest_tet,
        quality.largest_tet,
        quality.area,
        quality.euler_number,
        quality.conforming,
        quality.open_edges,
        rows_to(py, quality.nonmanifold_edges)?,
    ))
}

fn mesh_to_python(py: Python<'_>, mesh: TetMesh) -> PyResult<PyTetMesh<'_>> {
    let cavity = |c: voxel::CavitySurface| Ok((rows_to(py, c.triangles)?, c.volume, c.area));
    Ok((
        rows_to(py, mesh.vertices)?,
        rows_to(py, mesh.tets)?,
        rows_to(py, mesh.edges)?,
        rows_to(py, mesh.triangles)?,
        mesh.tet_part.into_pyarray(py),
        mesh.cavities
            .into_iter()
            .map(cavity)
            .collect::<PyResult<_>>()?,
    ))
}

/// Converts a list to a matrix, without a copy.
fn rows_to<const N: usize, T: Element>(
    py: Python<'_>,
    rows: Vec<[T; N]>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = rows.len();
    rows.into_flattened().into_pyarray(py).reshape([count, N])
}

/// The rows of a matrix; the Python side has checked that it has N columns.
fn rows_from<const N: usize, T: Element + Copy>(array: &PyReadonlyArray2<'_, T>) -> Vec<[T; N]> {
    array
        .as_array()
        .rows()
        .into_iter()
        .map(|row| std::array::from_fn(|c| row[c]))
        .collect()
}

fn stitch_error(py: Python<'_>, error: &StitchError) -> PyErr {
    let hint = match error {
        StitchError::Empty => "fill some cells, or voxelize with smaller voxels",
        StitchError::TooLarge { .. } | StitchError::TooMany { .. } => "use larger voxels",
        StitchError::Canceled => "",
    };
    exception(py, "MeshError", "mesh", &error.to_string(), hint)
}

fn from_tets_error(py: Python<'_>, error: &FromTetsError) -> PyErr {
    let (place, hint) = match error {
        FromTetsError::Empty => (
            "tets".into(),
            "give at least one row of four vertex indices",
        ),
        FromTetsError::TooMany(_) => ("tets".into(), "use a coarser mesh"),
        FromTetsError::PartCount { .. } => ("tet_part".into(), "give one part id per tetrahedron"),
        FromTetsError::Index { tet, .. } => (
            format!("tets[{tet}]"),
            "count vertices from 0, and check that none is missing",
        ),
        FromTetsError::Position { vertex, .. } => (
            format!("vertices[{vertex}]"),
            "remove or correct the vertex",
        ),
        FromTetsError::Flat { tet, .. } => (
            format!("tets[{tet}]"),
            "remove the tetrahedron, or merge its nearly equal vertices",
        ),
        FromTetsError::Overlap { tets, .. } => (
            format!("tets[{}]", tets[1]),
            "remove tetrahedra that are listed twice or overlap",
        ),
    };
    exception(py, "MeshError", &place, &error.to_string(), hint)
}
