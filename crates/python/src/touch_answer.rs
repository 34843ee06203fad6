//! What contact came to, as Python is told of it.

use pyo3::prelude::*;
use voxsoft_contact::touch::PairReport;
use voxsoft_solid::vector::Vec3;

/// What contact comes to where two surfaces touch.
#[pyclass(frozen, get_all, name = "Contact", module = "voxsoft._core")]
pub struct PyContact {
    /// Bodies come first, then objects.
    pub a: u32,
    pub b: u32,
    /// On the first, N.
    pub force: Vec3,
    /// The sum of the sizes of all forces, N.
    pub pressed: f64,
    /// The sum of all pressures, N.
    pub pressure: f64,
    /// The part of the force that is friction, N.
    pub friction: Vec3,
    /// The most that friction can be, N.
    pub bound: f64,
    /// In the unloaded body, m².
    pub area: f64,
    /// The part of it that is bonded, m².
    pub bonded: f64,
    /// The smallest, m.
    pub gap: f64,
    /// The part of the pressure under which the surfaces slip.
    pub slipping: f64,
}

/// Where an object is.
#[pyclass(frozen, get_all, name = "ObjectPose", module = "voxsoft._core")]
pub struct PyObjectPose {
    /// The middle of its box, m.
    pub position: Vec3,
    /// From its first pose, row by row.
    pub rotation: [Vec3; 3],
}

/// Contact and objects over time, one entry for each record.
#[pyclass(frozen, get_all, name = "TouchHistory", module = "voxsoft._core")]
pub struct PyTouchHistory {
    pub contacts: Vec<Vec<Py<PyContact>>>,
    pub objects: Vec<Vec<Py<PyObjectPose>>>,
    pub elastic: Vec<f64>,
    pub kinetic: Vec<f64>,
    pub loads: Vec<f64>,
    pub momentum: Vec<[f64; 3]>,
}

pub(crate) fn to_python(py: Python<'_>, pairs: Vec<PairReport>) -> PyResult<Vec<Py<PyContact>>> {
    let each = pairs.into_iter().map(|pair| {
        let contact = PyContact {
            a: pair.of[0],
            b: pair.of[1],
            force: pair.force,
            pressed: pair.pressed,
            pressure: pair.pressure,
            friction: pair.friction,
            bound: pair.bound,
            area: pair.area,
            bonded: pair.bonded,
            gap: pair.gap,
            slipping: pair.slipping,
        };
        Py::new(py, contact)
    });
    each.collect()
}
