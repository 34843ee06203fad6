//! Contact of a body with itself and with rigid objects, as Python describes it and is told of it.
use std::sync::Arc;

use pyo3::prelude::*;
use voxsoft_contact::touch::rigid::{frame, on_frame, pose};
use voxsoft_contact::touch::{Description, Surface, Touch};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Body, Clamp, Mesh, Motion, Problem, ProblemError};

/// A rigid object: its surface, and how it is moved.
#[derive(Debug, Clone)]
pub(crate) struct ObjectPart {
    pub points: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    pub motion: Option<Motion>,
}

/// Everything that contact is made of.
#[derive(Debug, Clone, Default)]
pub(crate) struct TouchParts {
    /// The body's boundary; used where it is not made of voxels.
    pub surface: Vec<[u32; 3]>,
    pub voxel: f64,
    pub refine: u32,
    pub objects: Vec<ObjectPart>,
    pub friction: Vec<Vec<f64>>,
}

impl TouchParts {
    /// Adds four vertices for each object to a mesh, and the clamps that hold them.
    pub(crate) fn add_frames(&self, mesh: &mut Mesh, clamps: &mut Vec<Clamp>) {
        for object in &self.objects {
            let first = mesh.vertices.len() as u32;
            mesh.vertices.extend(frame(&object.points));
            clamps.push(Clamp {
                vertices: (first..first + 4).collect(),
                axes: [true; 3],
                motion: object.motion.clone(),
            });
        }
    }

    /// The contact of a body whose objects have their vertices from `first` on.
    pub(crate) fn contact(&self, body: &Body, first: usize) -> Result<Touch, ProblemError> {
        let skin = if body.voxels().is_empty() {
            Surface::of_triangles(&self.surface)
        } else {
            Surface::of_voxels(body.voxels(), self.refine)
        };
        let mut surfaces = vec![skin];
        for (number, object) in self.objects.iter().enumerate() {
            let at = first + 4 * number;
            let frame = frame_at(body.rest(), at);
            let carried = |point: &Vec3| on_frame(*point, &frame, at as u32);
            surfaces.push(Surface {
                points: object.points.iter().map(carried).collect(),
                triangles: object.triangles.clone(),
            });
        }
        let description = Description {
            surfaces,
            friction: self.friction.clone(),
            voxel: self.voxel,
            young: mean_modulus(body),
        };
        Touch::new(description, body.rest())
    }
}

/// The energy at a strain of one over the volume, twice: a mean of Young's moduli, Pa.
fn mean_modulus(body: &Body) -> f64 {
    let bricks: f64 = body.bricks().iter().map(|brick| brick.volume()).sum();
    let tets: f64 = body.tets().iter().map(|tet| tet.volume).sum();
    2.0 * body.unit_strain_energy() / (bricks + tets)
}

fn frame_at(positions: &[Vec3], first: usize) -> [Vec3; 4] {
    std::array::from_fn(|i| positions[first + i])
}

/// What contact comes to where two surfaces touch.
#[pyclass(frozen, get_all, name = "Contact", module = "voxsoft._core")]
pub struct PyContact {
    /// The body is 0, objects count from 1.
    pub a: u32,
    pub b: u32,
    /// On the first, N.
    pub force: Vec3,
    /// The sum of the sizes of all forces, N.
    pub pressed: f64,
    /// In the unloaded body, m².
    pub area: f64,
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

/// Contact of a problem of Python, and where its objects begin among the vertices.
pub(crate) struct Touching {
    pub parts: TouchParts,
    pub touch: Arc<Touch>,
    pub first: usize,
}

impl Touching {
    pub(crate) fn contacts(
        &self,
        py: Python<'_>,
        positions: &[Vec3],
    ) -> PyResult<Vec<Py<PyContact>>> {
        let pairs = self.touch.pairs(positions).into_iter();
        let each = pairs.map(|pair| {
            let contact = PyContact {
                a: pair.of[0],
                b: pair.of[1],
                force: pair.force,
                pressed: pair.pressed,
                area: pair.area,
                gap: pair.gap,
                slipping: pair.slipping,
            };
            Py::new(py, contact)
        });
        each.collect()
    }

    pub(crate) fn poses(
        &self,
        py: Python<'_>,
        positions: &[Vec3],
    ) -> PyResult<Vec<Py<PyObjectPose>>> {
        let numbers = 0..self.parts.objects.len();
        let each = numbers.map(|number| {
            let (position, rotation) = pose(&frame_at(positions, self.first + 4 * number));
            Py::new(py, PyObjectPose { position, rotation })
        });
        each.collect()
    }

    /// The positions of the body, with the objects where their motions end.
    pub(crate) fn completed(&self, problem: &Problem, mut body: Vec<Vec3>) -> Vec<Vec3> {
        let rest = problem.body().rest();
        let count = body.len();
        let mut all = rest.to_vec();
        problem.place_clamps(f64::INFINITY, 1.0, &mut all);
        body.extend_from_slice(&all[count..]);
        body
    }
}
