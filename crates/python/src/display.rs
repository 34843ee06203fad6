//! `_core.Outline` and `_core.Display`: the displayed part of a mesh, packed into messages.
use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use voxsoft_frames::{Display, Field, FrameHead, Outline};
use voxsoft_solid::State;
use voxsoft_solid::vector::Vec3;

use crate::arrays::{from_rows, of_vertices, rows};
use crate::errors::to_python;
use crate::handle::Handle;
use crate::simulate::PyProblem;

pub(crate) fn field(id: u16) -> PyResult<Field> {
    let last = Field::ALL.len() - 1;
    let message = || PyValueError::new_err(format!("no field {id}: there are 0 to {last}"));
    Field::from_id(id).ok_or_else(message)
}

/// A surface or tetrahedra of a mesh, which needs no problem.
#[pyclass(frozen, name = "Outline", module = "voxsoft._core")]
pub struct PyOutline {
    rest: Vec<Vec3>,
    outline: Outline,
}

#[pymethods]
impl PyOutline {
    #[staticmethod]
    fn surface(
        vertices: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, u32>,
        tags: PyReadonlyArray1<'_, u8>,
        voxel_size: f64,
    ) -> PyResult<Self> {
        let rest: Vec<Vec3> = rows("vertices", &vertices)?;
        let triangles: Vec<[u32; 3]> = rows("triangles", &triangles)?;
        let tags = tags.as_array().to_vec();
        let outline = Outline::surface(&rest, &triangles, &tags, voxel_size);
        let outline = outline.map_err(to_python)?;
        Ok(Self { rest, outline })
    }

    /// A surface with the voxels behind it, as corners (k, 8).
    #[staticmethod]
    fn solid(
        vertices: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, u32>,
        tags: PyReadonlyArray1<'_, u8>,
        voxels: PyReadonlyArray2<'_, u32>,
        voxel_size: f64,
    ) -> PyResult<Self> {
        let rest: Vec<Vec3> = rows("vertices", &vertices)?;
        let triangles: Vec<[u32; 3]> = rows("triangles", &triangles)?;
        let voxels: Vec<[u32; 8]> = rows("voxels", &voxels)?;
        let tags = tags.as_array().to_vec();
        let outline = Outline::solid(&rest, &triangles, &tags, &voxels, voxel_size);
        let outline = outline.map_err(to_python)?;
        Ok(Self { rest, outline })
    }

    #[staticmethod]
    fn tets(
        vertices: PyReadonlyArray2<'_, f64>,
        tets: PyReadonlyArray2<'_, u32>,
        tags: PyReadonlyArray1<'_, u8>,
        voxel_size: f64,
    ) -> PyResult<Self> {
        let rest: Vec<Vec3> = rows("vertices", &vertices)?;
        let tets: Vec<[u32; 4]> = rows("tets", &tets)?;
        let tags = tags.as_array().to_vec();
        let outline = Outline::tets(&rest, &tets, &tags, voxel_size);
        let outline = outline.map_err(to_python)?;
        Ok(Self { rest, outline })
    }

    /// Displayed vertices of the mesh: those of a surface in ascending order, then those within.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, self.outline.vertices())
    }

    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<u32>> {
        from_rows(py, self.outline.triangles())
    }

    #[getter]
    fn edges<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<u32>> {
        from_rows(py, self.outline.edges())
    }

    fn pack_topology<'py>(&self, py: Python<'py>, topology: u32) -> Bound<'py, PyBytes> {
        let bytes = py.detach(|| self.outline.topology(&self.rest, topology));
        PyBytes::new(py, &bytes)
    }

    /// Packs a frame of positions (m) of all vertices, with field values of the displayed ones (zero by default).
    /// `field` may also be a number that the core does not know.
    #[pyo3(signature = (positions, *, topology, field, values=None, frame=0, seq=0, flags=0, time=0.0))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments of one Python call"
    )]
    fn pack_frame<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
        topology: u32,
        field: u16,
        values: Option<PyReadonlyArray1<'_, f64>>,
        frame: u32,
        seq: u32,
        flags: u8,
        time: f64,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let positions = of_vertices("positions", &positions, self.rest.len())?;
        let shown = self.outline.vertices().len();
        let values = values.map_or_else(|| vec![0.0; shown], |v| v.as_array().to_vec());
        if values.len() != shown {
            let got = values.len();
            let message = format!("values: {got}, expected {shown}");
            return Err(PyValueError::new_err(message));
        }
        let head = FrameHead {
            topology,
            frame,
            seq,
            flags,
        };
        let pack = || self.outline.frame(head, time, &positions, field, &values);
        Ok(PyBytes::new(py, &py.detach(pack)))
    }
}

/// The smooth surface of shapes as the page reads it: points (m), triangles, and the part of each.
#[pyfunction]
pub fn pack_smooth<'py>(
    py: Python<'py>,
    topology: u32,
    points: PyReadonlyArray2<'_, f64>,
    triangles: PyReadonlyArray2<'_, u32>,
    parts: PyReadonlyArray1<'_, u8>,
) -> PyResult<Bound<'py, PyBytes>> {
    let points: Vec<Vec3> = rows("points", &points)?;
    let triangles: Vec<[u32; 3]> = rows("triangles", &triangles)?;
    let parts = parts.as_array().to_vec();
    let bytes = voxsoft_frames::pack_smooth(topology, &points, &triangles, &parts);
    Ok(PyBytes::new(py, &bytes))
}

/// A surface or tetrahedra of a body, for packing into frames.
#[pyclass(frozen, name = "Display", module = "voxsoft._core")]
pub struct PyDisplay {
    pub(crate) problem: Arc<Handle>,
    pub(crate) display: Display,
}

#[pymethods]
impl PyDisplay {
    /// Triangles of vertices, each with a tag for the client; a voxel size (m) above zero leaves face
    /// diagonals out of the edges.
    #[staticmethod]
    pub(crate) fn surface(
        problem: PyRef<'_, PyProblem>,
        triangles: PyReadonlyArray2<'_, u32>,
        tags: PyReadonlyArray1<'_, u8>,
        voxel_size: f64,
    ) -> PyResult<Self> {
        let triangles: Vec<[u32; 3]> = rows("triangles", &triangles)?;
        let tags = tags.as_array().to_vec();
        let problem = Arc::clone(&problem.problem);
        let display = Display::surface(problem.now().body(), &triangles, &tags, voxel_size);
        let display = display.map_err(to_python)?;
        Ok(Self { problem, display })
    }

    /// A surface with the voxels behind it, as corners (k, 8).
    #[staticmethod]
    fn solid(
        problem: PyRef<'_, PyProblem>,
        triangles: PyReadonlyArray2<'_, u32>,
        tags: PyReadonlyArray1<'_, u8>,
        voxels: PyReadonlyArray2<'_, u32>,
        voxel_size: f64,
    ) -> PyResult<Self> {
        let triangles: Vec<[u32; 3]> = rows("triangles", &triangles)?;
        let voxels: Vec<[u32; 8]> = rows("voxels", &voxels)?;
        let tags = tags.as_array().to_vec();
        let problem = Arc::clone(&problem.problem);
        let display = Display::solid(problem.now().body(), &triangles, &tags, &voxels, voxel_size);
        let display = display.map_err(to_python)?;
        Ok(Self { problem, display })
    }

    /// Tetrahedra of vertices, drawn a little smaller than they are.
    #[staticmethod]
    fn tets(
        problem: PyRef<'_, PyProblem>,
        tets: PyReadonlyArray2<'_, u32>,
        tags: PyReadonlyArray1<'_, u8>,
        voxel_size: f64,
    ) -> PyResult<Self> {
        let tets: Vec<[u32; 4]> = rows("tets", &tets)?;
        let tags = tags.as_array().to_vec();
        let problem = Arc::clone(&problem.problem);
        let display = Display::tets(problem.now().body(), &tets, &tags, voxel_size);
        let display = display.map_err(to_python)?;
        Ok(Self { problem, display })
    }

    /// Displayed vertices of the body: those of a surface in ascending order, then those within.
    #[getter]
    pub(crate) fn vertices<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, self.display.vertices())
    }

    #[getter]
    fn points(&self) -> usize {
        self.display.points()
    }

    pub(crate) fn pack_topology<'py>(&self, py: Python<'py>, topology: u32) -> Bound<'py, PyBytes> {
        let problem = self.problem.now();
        let bytes = py.detach(|| self.display.topology(problem.body(), topology));
        PyBytes::new(py, &bytes)
    }

    /// Packs a frame of given positions (m).
    #[pyo3(signature = (positions, *, topology, frame, field, seq=0, flags=0, time=0.0, velocities=None))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments of one Python call"
    )]
    fn pack_frame<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
        topology: u32,
        frame: u32,
        field: u16,
        seq: u32,
        flags: u8,
        time: f64,
        velocities: Option<PyReadonlyArray2<'_, f64>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let problem = self.problem.now();
        let body = problem.body();
        let count = body.rest().len();
        let mut state = State::at_rest(body);
        state.positions = of_vertices("positions", &positions, count)?;
        if let Some(velocities) = velocities {
            state.velocities = of_vertices("velocities", &velocities, count)?;
        }
        state.time = time;
        let head = FrameHead {
            topology,
            frame,
            seq,
            flags,
        };
        let field = self::field(field)?;
        let bytes = py.detach(|| self.display.frame(body, &state, field, head));
        Ok(PyBytes::new(py, &bytes))
    }

    /// Values of a field at the displayed vertices, for given positions (m) of all vertices and zero velocities.
    fn values<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
        field: u16,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let problem = self.problem.now();
        let body = problem.body();
        let mut state = State::at_rest(body);
        state.positions = of_vertices("positions", &positions, body.rest().len())?;
        let field = self::field(field)?;
        let values = py.detach(|| self.display.values(body, &state, field));
        Ok(PyArray1::from_vec(py, values))
    }
}
