//! Tendons: their description from Python and their results.

use pyo3::prelude::*;
use serde::Deserialize;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Drive, History, Load, LoadKind, Place, Problem, Tendon};

use crate::surface_contact::ContactParts;

/// A point on the path of a tendon.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
enum PlacePart {
    /// On a body, or fixed in space.
    Place(Place),
    /// On an object, at this point (m) in the first pose of the object.
    OnObject { object: usize, point: Vec3 },
}

/// Description of a tendon before its objects have vertices.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct TendonPart {
    places: Vec<PlacePart>,
    lengths: Vec<f64>,
    drive: Drive,
    friction: f64,
}

impl TendonPart {
    /// Makes the load, with the vertices of objects from `first` on.
    pub(crate) fn load(
        self,
        history: History,
        touch: Option<&ContactParts>,
        first: usize,
    ) -> Option<Load> {
        let place = |part| match part {
            PlacePart::Place(place) => Some(place),
            PlacePart::OnObject { object, point } => {
                let at = u32::try_from(first + 4 * object).ok()?;
                let carried = touch?.objects.get(object)?.frame.carry(point, at);
                Some(Place {
                    vertices: carried.vertices,
                    weights: carried.weights,
                    offset: [0.0; 3],
                })
            }
        };
        let places = self.places.into_iter().map(place).collect::<Option<_>>()?;
        let tendon = Tendon::new(places, self.lengths, self.drive, self.friction);
        let kind = LoadKind::Tendon(tendon);
        Some(Load { kind, history })
    }
}

/// A tendon at the end of a run.
#[pyclass(frozen, get_all, name = "Tendon", module = "voxsoft._core")]
pub struct PyTendon {
    /// Tension of each segment from the pulled end on, N.
    pub tensions: Vec<f64>,
    /// Length of its path, m.
    pub length: f64,
    /// Excess of its own length over the path, m.
    pub slack: f64,
    /// Its points, m.
    pub points: Vec<Vec3>,
}

/// The tendons of a problem, in the order of its loads.
pub(crate) fn tendons(
    py: Python<'_>,
    problem: &Problem,
    positions: &[Vec3],
    factor_of: &dyn Fn(&Load) -> f64,
) -> PyResult<Vec<Py<PyTendon>>> {
    let each = problem.loads().iter().filter_map(|load| match &load.kind {
        LoadKind::Tendon(tendon) => Some((tendon, factor_of(load))),
        _ => None,
    });
    each.map(|(tendon, factor)| {
        let state = tendon.state(positions, factor);
        Py::new(
            py,
            PyTendon {
                tensions: state.tensions,
                length: state.length,
                slack: state.slack,
                points: tendon.points(positions),
            },
        )
    })
    .collect()
}
