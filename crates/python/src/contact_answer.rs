//! Results of contact for Python.

use pyo3::prelude::*;
use voxsoft_contact::surface_contact::PairReport;
use voxsoft_solid::vector::Vec3;

/// Contact of two surfaces that touch.
#[pyclass(frozen, get_all, name = "Contact", module = "voxsoft._core")]
pub struct PyContact {
    /// Numbers `a` and `b` of the surfaces: bodies come first, then objects.
    pub a: u32,
    pub b: u32,
    /// Force on the first surface, N.
    pub force: Vec3,
    /// Sum of the magnitudes of all pressures and frictions, N.
    pub pressed: f64,
    /// Sum of the magnitudes of all normal forces, N.
    pub pressure: f64,
    /// Friction part of the force, N.
    pub friction: Vec3,
    /// Limit of friction (coefficient times normal force, summed), N.
    pub bound: f64,
    /// Contact area in the unloaded body, m².
    pub area: f64,
    /// Bonded part of the area, m².
    pub bonded: f64,
    /// Smallest gap, m.
    pub gap: f64,
    /// Fraction of the pressure under which the surfaces slip.
    pub slipping: f64,
    /// Mean place of the pressure, m; none where nothing presses.
    pub place: Option<Vec3>,
}

/// Pose of a rigid object.
#[pyclass(frozen, get_all, name = "ObjectPose", module = "voxsoft._core")]
pub struct PyObjectPose {
    /// Center of its box, m.
    pub position: Vec3,
    /// Rotation from its first pose, row by row.
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
            place: pair.place,
        };
        Py::new(py, contact)
    });
    each.collect()
}
