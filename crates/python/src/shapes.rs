//! `_core.Shape`: implicit shapes built from plain numbers, and their sampling.
use numpy::{IntoPyArray, PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use voxsoft_shape::periodic::{Struts, Surface};
use voxsoft_shape::{
    Bounds, BuildError, Expr, SampleError, SampleGrid, Shape, operators, primitives,
};

use crate::errors::exception;
use crate::gate;

mod field;

type Point = [f64; 3];

/// A point that becomes a tuple, not a list, in Python.
type Corner = (f64, f64, f64);

/// An immutable implicit shape, or a scalar field used to grade another one.
#[pyclass(frozen, name = "Shape", module = "voxsoft._core")]
pub struct PyShape(pub(crate) Shape);

/// A number, or a scalar field.
#[derive(FromPyObject)]
enum Graded<'py> {
    Number(f64),
    Field(PyRef<'py, PyShape>),
}

impl Graded<'_> {
    fn expr(&self) -> Expr {
        match self {
            Self::Number(value) => Expr::constant(*value),
            Self::Field(shape) => shape.0.expr.clone(),
        }
    }
}

fn built(py: Python<'_>, shape: Result<Shape, BuildError>) -> PyResult<PyShape> {
    shape.map(PyShape).map_err(|error| build_error(py, &error))
}

fn build_error(py: Python<'_>, error: &BuildError) -> PyErr {
    let (place, what) = match error {
        BuildError::NotPositive { name, value } => {
            (*name, format!("is {value}; it must be positive and finite"))
        }
        BuildError::NotFinite { name, value } => (*name, format!("is {value}; it must be finite")),
        BuildError::NoDirection { name } => {
            (*name, "has no length; one number must not be zero".into())
        }
        BuildError::OutOfRange {
            name,
            value,
            allowed,
        } => (*name, format!("is {value}; {allowed}")),
        BuildError::Polygon(_) => ("points", error.to_string()),
        BuildError::NoOperands => ("of", error.to_string()),
    };
    exception(py, "ShapeError", place, &what, "")
}

pub(crate) fn sample_error(py: Python<'_>, error: &SampleError) -> PyErr {
    let (place, hint) = match error {
        SampleError::TooLarge { .. } => ("voxel_size", "use larger voxels or smaller bounds"),
        SampleError::BadLattice { name, .. } => (*name, ""),
        SampleError::NotANumber { .. } => (
            "",
            "check for roots and logarithms of negative numbers and for 0/0, or limit with max",
        ),
        SampleError::Field(_) | SampleError::Canceled => ("", ""),
    };
    exception(py, "ShapeError", place, &error.to_string(), hint)
}

fn surface(name: &str) -> Option<Surface> {
    Some(match name {
        "gyroid" => Surface::Gyroid,
        "schwarz-p" => Surface::SchwarzP,
        "schwarz-d" => Surface::SchwarzD,
        "neovius" => Surface::Neovius,
        "iwp" => Surface::Iwp,
        _ => return None,
    })
}

fn struts(name: &str) -> Option<Struts> {
    Some(match name {
        "cubic" => Struts::Cubic,
        "bcc" => Struts::Bcc,
        "fcc" => Struts::Fcc,
        "octet" => Struts::Octet,
        _ => return None,
    })
}

fn unknown_kind(py: Python<'_>, name: &str) -> PyErr {
    exception(
        py,
        "ShapeError",
        "kind",
        &format!("\"{name}\" is not known"),
        "",
    )
}

#[pymethods]
impl PyShape {
    #[staticmethod]
    fn cuboid(py: Python<'_>, center: Point, size: Point) -> PyResult<Self> {
        built(py, primitives::cuboid(center, size))
    }

    #[staticmethod]
    fn rounded_box(py: Python<'_>, center: Point, size: Point, radius: f64) -> PyResult<Self> {
        built(py, primitives::rounded_box(center, size, radius))
    }

    #[staticmethod]
    fn sphere(py: Python<'_>, center: Point, radius: f64) -> PyResult<Self> {
        built(py, primitives::sphere(center, radius))
    }

    #[staticmethod]
    fn ellipsoid(py: Python<'_>, center: Point, radii: Point) -> PyResult<Self> {
        built(py, primitives::ellipsoid(center, radii))
    }

    #[staticmethod]
    fn cylinder(
        py: Python<'_>,
        base: Point,
        axis: Point,
        radius: f64,
        height: f64,
    ) -> PyResult<Self> {
        built(py, primitives::cylinder(base, axis, radius, height))
    }

    #[staticmethod]
    fn tube(
        py: Python<'_>,
        base: Point,
        axis: Point,
        radius: f64,
        wall: f64,
        height: f64,
    ) -> PyResult<Self> {
        built(py, primitives::tube(base, axis, radius, wall, height))
    }

    #[staticmethod]
    fn cone(
        py: Python<'_>,
        base: Point,
        axis: Point,
        radius: f64,
        top_radius: f64,
        height: f64,
    ) -> PyResult<Self> {
        built(py, primitives::cone(base, axis, radius, top_radius, height))
    }

    #[staticmethod]
    fn capsule(py: Python<'_>, start: Point, end: Point, radius: f64) -> PyResult<Self> {
        built(py, primitives::capsule(start, end, radius))
    }

    #[staticmethod]
    fn torus(
        py: Python<'_>,
        center: Point,
        axis: Point,
        radius: f64,
        tube_radius: f64,
    ) -> PyResult<Self> {
        built(py, primitives::torus(center, axis, radius, tube_radius))
    }

    #[staticmethod]
    fn half_space(py: Python<'_>, point: Point, normal: Point) -> PyResult<Self> {
        built(py, primitives::half_space(point, normal))
    }

    #[staticmethod]
    fn prism(
        py: Python<'_>,
        base: Point,
        axis: Point,
        points: Vec<[f64; 2]>,
        height: f64,
    ) -> PyResult<Self> {
        built(py, primitives::prism(base, axis, &points, height))
    }

    #[staticmethod]
    fn revolve(py: Python<'_>, base: Point, axis: Point, points: Vec<[f64; 2]>) -> PyResult<Self> {
        built(py, primitives::revolve(base, axis, &points))
    }

    #[staticmethod]
    fn surface_sheet(
        py: Python<'_>,
        kind: &str,
        period: Graded<'_>,
        thickness: Graded<'_>,
        level: f64,
    ) -> PyResult<Self> {
        let surface = surface(kind).ok_or_else(|| unknown_kind(py, kind))?;
        built(py, surface.sheet(&period.expr(), &thickness.expr(), level))
    }

    #[staticmethod]
    fn surface_solid(py: Python<'_>, kind: &str, period: Graded<'_>, level: f64) -> PyResult<Self> {
        let surface = surface(kind).ok_or_else(|| unknown_kind(py, kind))?;
        built(py, surface.solid(&period.expr(), level))
    }

    #[staticmethod]
    fn struts(
        py: Python<'_>,
        kind: &str,
        period: Graded<'_>,
        thickness: Graded<'_>,
    ) -> PyResult<Self> {
        let struts = struts(kind).ok_or_else(|| unknown_kind(py, kind))?;
        built(py, struts.lattice(&period.expr(), &thickness.expr()))
    }

    #[staticmethod]
    fn expression(py: Python<'_>, text: &str) -> PyResult<Self> {
        match voxsoft_shape::parse(text) {
            Ok(expr) => Ok(Self(Shape::unknown(expr))),
            Err(error) => {
                let hint = "write a function of x, y, z in m, such as \"x^2 + y^2 - 0.02^2\"";
                Err(exception(
                    py,
                    "ShapeError",
                    "text",
                    &error.to_string(),
                    hint,
                ))
            }
        }
    }

    /// Shape of a field sampled by a Python function: points (n, 3) -> values (n,).
    #[staticmethod]
    fn sampled(
        py: Python<'_>,
        function: Py<PyAny>,
        low: Point,
        high: Point,
        is_distance: bool,
    ) -> PyResult<Self> {
        let expr = field::expression(function, is_distance);
        let bounds = Bounds::new(low, high);
        if is_distance {
            return Ok(Self(Shape::distance(expr, bounds)));
        }
        built(py, operators::clip(&Shape::unknown(expr), &bounds))
    }

    #[staticmethod]
    fn union(py: Python<'_>, of: Vec<PyRef<'_, Self>>, smooth: f64) -> PyResult<Self> {
        combined(py, &of, smooth, operators::union, operators::smooth_union)
    }

    #[staticmethod]
    fn intersection(py: Python<'_>, of: Vec<PyRef<'_, Self>>, smooth: f64) -> PyResult<Self> {
        combined(
            py,
            &of,
            smooth,
            operators::intersection,
            operators::smooth_intersection,
        )
    }

    #[staticmethod]
    fn difference(py: Python<'_>, of: Vec<PyRef<'_, Self>>, smooth: f64) -> PyResult<Self> {
        combined(
            py,
            &of,
            smooth,
            operators::difference,
            operators::smooth_difference,
        )
    }

    fn offset(&self, py: Python<'_>, distance: Graded<'_>) -> PyResult<Self> {
        match &distance {
            Graded::Number(distance) => built(py, operators::offset(&self.0, *distance)),
            Graded::Field(field) => Ok(Self(operators::graded_offset(&self.0, &field.0.expr))),
        }
    }

    fn shell(&self, py: Python<'_>, thickness: Graded<'_>) -> PyResult<Self> {
        match &thickness {
            Graded::Number(thickness) => built(py, operators::shell(&self.0, *thickness)),
            Graded::Field(field) => Ok(Self(operators::graded_shell(&self.0, &field.0.expr))),
        }
    }

    fn translate(&self, py: Python<'_>, by: Point) -> PyResult<Self> {
        built(py, operators::translate(&self.0, by))
    }

    fn rotate(&self, py: Python<'_>, axis: Point, angle: f64, center: Point) -> PyResult<Self> {
        built(py, operators::rotate(&self.0, axis, angle, center))
    }

    fn mirror(&self, py: Python<'_>, point: Point, normal: Point) -> PyResult<Self> {
        built(py, operators::mirror(&self.0, point, normal))
    }

    fn scale(&self, py: Python<'_>, factors: Point, center: Point) -> PyResult<Self> {
        built(py, operators::scale(&self.0, factors, center))
    }

    fn array(&self, py: Python<'_>, count: [usize; 3], spacing: Point) -> PyResult<Self> {
        built(py, operators::array(&self.0, count, spacing))
    }

    fn polar_array(
        &self,
        py: Python<'_>,
        count: usize,
        axis: Point,
        angle: f64,
        center: Point,
    ) -> PyResult<Self> {
        built(
            py,
            operators::polar_array(&self.0, count, axis, angle, center),
        )
    }

    fn twist(&self, py: Python<'_>, rate: f64, axis: Point, center: Point) -> PyResult<Self> {
        built(py, operators::twist(&self.0, rate, axis, center))
    }

    fn bend(
        &self,
        py: Python<'_>,
        curvature: f64,
        axis: Point,
        toward: Point,
        center: Point,
    ) -> PyResult<Self> {
        built(
            py,
            operators::bend(&self.0, curvature, axis, toward, center),
        )
    }

    fn taper(
        &self,
        py: Python<'_>,
        factor: f64,
        height: f64,
        axis: Point,
        center: Point,
    ) -> PyResult<Self> {
        built(py, operators::taper(&self.0, factor, height, axis, center))
    }

    fn blend(&self, other: PyRef<'_, Self>, weight: Graded<'_>) -> Self {
        Self(operators::blend(&self.0, &other.0, &weight.expr()))
    }

    /// Lowest and highest corner; infinite where there is no end, reversed when empty.
    fn bounds(&self, py: Python<'_>) -> PyResult<(Corner, Corner)> {
        if self.0.bounds.is_finite() {
            return Ok((self.0.bounds.low.into(), self.0.bounds.high.into()));
        }
        let found = gate::run(py, |_| self.0.find_bounds())?;
        let found = found.map_err(|error| sample_error(py, &error.into()))?;
        Ok((found.low.into(), found.high.into()))
    }

    /// Values at points (n, 3).
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let points: Vec<Point> = points
            .as_array()
            .rows()
            .into_iter()
            .map(|p| [p[0], p[1], p[2]])
            .collect();
        let values = gate::run(py, |_| self.0.evaluate(&points))?;
        let values = values.map_err(|error| sample_error(py, &error.into()))?;
        Ok(values.into_pyarray(py))
    }

    /// 1 for each cell whose center is inside, else 0; shape (nx, ny, nz).
    fn sample<'py>(
        &self,
        py: Python<'py>,
        origin: Point,
        voxel_size: f64,
        shape: [usize; 3],
        tie: f64,
        memory_limit: u64,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let grid = SampleGrid {
            origin,
            voxel_size,
            shape,
        };
        let cells = gate::run(py, |cancel| {
            voxsoft_shape::sample(&self.0, &grid, tie, memory_limit, cancel)
        })?;
        let cells = cells.map_err(|error| sample_error(py, &error))?;
        cells.into_pyarray(py).reshape(shape)
    }
}

fn combined(
    py: Python<'_>,
    of: &[PyRef<'_, PyShape>],
    smooth: f64,
    sharp: impl Fn(&[Shape]) -> Result<Shape, BuildError>,
    blended: impl Fn(&[Shape], f64) -> Result<Shape, BuildError>,
) -> PyResult<PyShape> {
    let shapes: Vec<Shape> = of.iter().map(|shape| shape.0.clone()).collect();
    built(
        py,
        if smooth == 0.0 {
            sharp(&shapes)
        } else {
            blended(&shapes, smooth)
        },
    )
}
