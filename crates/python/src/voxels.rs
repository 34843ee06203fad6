//! `_core.Grid`: an immutable grid of cells; every change returns a new one.
use std::sync::Arc;

use numpy::{IntoPyArray, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray3};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use voxsoft_voxel::{self as voxel, CombineError, Component, Contact, GridError};

use crate::errors::exception;
use crate::gate;

/// Runs of cells as rows (i, j, first, last), and the number of cells.
type PyComponent<'py> = (Bound<'py, PyArray2<u32>>, u64);

/// Component, width and cells of the openings.
type PyLeak<'py> = (PyComponent<'py>, usize, Vec<(u32, u32, u32)>);

/// Thickness in cells, and a cell.
type PyWall = (u16, (u32, u32, u32));

/// Thickness at each cell, histogram, thinnest place.
type PyWallThickness<'py> = (Bound<'py, PyArray3<u16>>, Vec<u64>, Option<PyWall>);

#[pyclass(frozen, name = "Grid", module = "voxsoft._core")]
pub struct PyGrid(pub Arc<voxel::Grid>);

impl PyGrid {
    fn new(grid: voxel::Grid) -> Self {
        Self(Arc::new(grid))
    }

    /// Makes a changed copy, with the GIL released.
    fn changed(
        &self,
        py: Python<'_>,
        change: impl FnOnce(&mut voxel::Grid) + Send,
    ) -> PyResult<Self> {
        gate::run(py, |_| {
            let mut grid = (*self.0).clone();
            change(&mut grid);
            Self::new(grid)
        })
    }

    /// Runs an analysis of the cells, with the GIL released.
    fn found<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&voxel::Grid) -> T + Send + 'static,
    ) -> PyResult<T> {
        let grid = Arc::clone(&self.0);
        gate::run_owned(py, move |_| work(&grid))
    }

    fn combined(
        &self,
        py: Python<'_>,
        combine: impl FnOnce(&voxel::Grid) -> Result<voxel::Grid, CombineError> + Send,
    ) -> PyResult<Self> {
        let combined = gate::run(py, |_| combine(&self.0))?;
        combined
            .map(Self::new)
            .map_err(|error| combine_error(py, &error))
    }
}

#[pymethods]
impl PyGrid {
    #[staticmethod]
    fn empty(
        py: Python<'_>,
        shape: [usize; 3],
        origin: [f64; 3],
        voxel_size: f64,
        memory_limit: u64,
    ) -> PyResult<Self> {
        voxel::Grid::empty(shape, origin, voxel_size, memory_limit)
            .map(Self::new)
            .map_err(|error| grid_error(py, &error))
    }

    #[staticmethod]
    fn from_array(
        py: Python<'_>,
        array: PyReadonlyArray3<'_, u8>,
        origin: [f64; 3],
        voxel_size: f64,
    ) -> PyResult<Self> {
        let view = array.as_array();
        let shape = [view.shape()[0], view.shape()[1], view.shape()[2]];
        // `iter` runs in C order whatever the strides of the array.
        let cells = match view.as_slice() {
            Some(cells) => cells.to_vec(),
            None => view.iter().copied().collect(),
        };
        voxel::Grid::from_cells(shape, origin, voxel_size, cells)
            .map(Self::new)
            .map_err(|error| grid_error(py, &error))
    }

    fn array<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<u8>>> {
        self.0
            .cells()
            .to_vec()
            .into_pyarray(py)
            .reshape(self.0.shape())
    }

    #[getter]
    fn shape(&self) -> (usize, usize, usize) {
        self.0.shape().into()
    }

    #[getter]
    fn origin(&self) -> (f64, f64, f64) {
        self.0.origin().into()
    }

    #[getter]
    fn lattice_offset(&self) -> (i32, i32, i32) {
        self.0.lattice_offset().into()
    }

    #[getter]
    fn voxel_size(&self) -> f64 {
        self.0.voxel_size()
    }

    fn count(&self) -> usize {
        self.0.count()
    }

    fn part_counts(&self) -> Vec<u64> {
        self.0.part_counts().to_vec()
    }

    fn center_of_mass(&self) -> Option<(f64, f64, f64)> {
        self.0.center_of_mass().map(Into::into)
    }

    fn content(&self) -> Option<[[usize; 3]; 2]> {
        self.0.content()
    }

    fn with_cell(&self, py: Python<'_>, cell: [usize; 3], part: u8) -> PyResult<Self> {
        if cell
            .iter()
            .zip(self.0.shape())
            .any(|(&index, n)| index >= n)
        {
            return Err(PyIndexError::new_err("cell outside the grid"));
        }
        self.changed(py, |grid| grid.set(cell, part))
    }

    fn fill_box(
        &self,
        py: Python<'_>,
        lower: [f64; 3],
        upper: [f64; 3],
        part: u8,
    ) -> PyResult<Self> {
        self.changed(py, |grid| grid.fill_box(lower, upper, part))
    }

    fn fill_sphere(
        &self,
        py: Python<'_>,
        center: [f64; 3],
        radius: f64,
        part: u8,
    ) -> PyResult<Self> {
        self.changed(py, |grid| grid.fill_sphere(center, radius, part))
    }

    #[expect(clippy::too_many_arguments, reason = "the tube's dimensions")]
    fn fill_tube(
        &self,
        py: Python<'_>,
        base: [f64; 3],
        axis: [f64; 3],
        outer_radius: f64,
        inner_radius: f64,
        height: f64,
        part: u8,
    ) -> PyResult<Self> {
        self.changed(py, |grid| {
            grid.fill_tube(base, axis, outer_radius, inner_radius, height, part);
        })
    }

    fn fill_random(&self, py: Python<'_>, density: f64, seed: u64, part: u8) -> PyResult<Self> {
        self.changed(py, |grid| grid.fill_random(density, seed, part))
    }

    fn union(&self, py: Python<'_>, other: &Self, memory_limit: u64) -> PyResult<Self> {
        self.combined(py, |grid| grid.union(&other.0, memory_limit))
    }

    fn intersection(&self, py: Python<'_>, other: &Self) -> PyResult<Self> {
        self.combined(py, |grid| grid.intersection(&other.0))
    }

    fn difference(&self, py: Python<'_>, other: &Self) -> PyResult<Self> {
        self.combined(py, |grid| grid.difference(&other.0))
    }

    fn flipped(&self, py: Python<'_>, axis: usize) -> PyResult<Self> {
        self.combined(py, |grid| Ok(grid.flipped(axis)))
    }

    fn shifted(&self, py: Python<'_>, steps: [i32; 3]) -> PyResult<Self> {
        self.combined(py, |grid| grid.shifted(steps))
    }

    fn padded(
        &self,
        py: Python<'_>,
        before: [usize; 3],
        after: [usize; 3],
        memory_limit: u64,
    ) -> PyResult<Self> {
        self.combined(py, |grid| grid.padded(before, after, memory_limit))
    }

    fn cropped(&self, py: Python<'_>) -> PyResult<Self> {
        self.combined(py, |grid| grid.cropped())
    }

    /// Connected components. `contact` is the number of axes in which two neighbors may differ: 1 face, 2 edge, 3
    /// corner.
    fn components<'py>(&self, py: Python<'py>, contact: u8) -> PyResult<Vec<PyComponent<'py>>> {
        let contact = match contact {
            1 => Contact::Face,
            2 => Contact::Edge,
            _ => Contact::Corner,
        };
        let pieces = self.found(py, move |grid| voxel::components(grid, contact))?;
        pieces.iter().map(|piece| region(py, piece)).collect()
    }

    fn cavities<'py>(&self, py: Python<'py>) -> PyResult<Vec<(PyComponent<'py>, f64, f64)>> {
        let cavities = self.found(py, voxel::cavities)?;
        cavities
            .iter()
            .map(|c| Ok((region(py, &c.region)?, c.volume, c.area)))
            .collect()
    }

    /// Hinges, one row of two cells (i, j, k, i, j, k) each.
    fn hinges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let hinges = self.found(py, voxel::hinges)?;
        let count = hinges.len();
        let cells: Vec<u32> = hinges
            .iter()
            .flat_map(|hinge| hinge.cells)
            .flatten()
            .collect();
        cells.into_pyarray(py).reshape([count, 6])
    }

    fn leaks<'py>(&self, py: Python<'py>, max_width: usize) -> PyResult<Vec<PyLeak<'py>>> {
        let leaks = self.found(py, move |grid| voxel::leaks(grid, max_width))?;
        let cells = |openings: &[[u32; 3]]| openings.iter().map(|&cell| cell.into()).collect();
        leaks
            .iter()
            .map(|l| Ok((region(py, &l.region)?, l.width, cells(&l.openings))))
            .collect()
    }

    fn wall_thickness<'py>(&self, py: Python<'py>) -> PyResult<PyWallThickness<'py>> {
        let walls = self.found(py, voxel::wall_thickness)?;
        let cells = walls.cells.into_pyarray(py).reshape(self.0.shape())?;
        Ok((cells, walls.histogram, walls.thinnest.map(wall)))
    }

    fn cavity_walls(&self, py: Python<'_>) -> PyResult<Vec<PyWall>> {
        let walls = self.found(py, voxel::cavity_walls)?;
        Ok(walls.into_iter().map(wall).collect())
    }
}

fn wall(wall: voxel::Wall) -> PyWall {
    (wall.thickness, wall.cell.into())
}

fn region<'py>(py: Python<'py>, region: &Component) -> PyResult<PyComponent<'py>> {
    let rows: Vec<[u32; 4]> = region
        .runs()
        .iter()
        .map(|run| [run.i, run.j, run.first, run.last].map(u32::from))
        .collect();
    let count = rows.len();
    let array = rows.into_flattened().into_pyarray(py).reshape([count, 4])?;
    Ok((array, region.cell_count()))
}

fn grid_error(py: Python<'_>, error: &GridError) -> PyErr {
    let (place, hint) = match error {
        GridError::Shape { .. } => ("shape", "check the size against the voxel size"),
        GridError::VoxelSize(_) => ("voxel_size", "give a positive length, such as 5*mm"),
        GridError::Origin(_) => ("origin", "bring the grid closer to the origin"),
        GridError::CellCount { .. } => ("array", "give one number per cell"),
        GridError::TooLarge { .. } => ("shape", "use larger voxels"),
    };
    exception(py, "VoxelError", place, &error.to_string(), hint)
}

fn combine_error(py: Python<'_>, error: &CombineError) -> PyErr {
    let (place, hint) = match error {
        CombineError::VoxelSize(..) => ("voxel_size", "voxelize both with the same voxel size"),
        CombineError::Lattice(_) => ("origin", "move one grid by the fraction of a voxel"),
        CombineError::Shape(_) => ("shape", "use larger voxels or less padding"),
        CombineError::TooLarge { .. } => ("shape", "crop both grids first, or use larger voxels"),
        CombineError::TooFar => ("shift", "move the grid by fewer voxels"),
        CombineError::Empty => ("crop", "fill some cells first"),
    };
    exception(py, "VoxelError", place, &error.to_string(), hint)
}
