//! Contact of a body with itself and with rigid objects, as Python describes it and is told of it.
use std::ops::Range;
use std::sync::Arc;

use pyo3::prelude::*;
use voxsoft_contact::skin::Skin;
use voxsoft_contact::touch::bonds::{Bond, Side, Solid};
use voxsoft_contact::touch::rigid::Frame;
use voxsoft_contact::touch::{Carried, Description, PairReport, Surface, Touch};
use voxsoft_player::Placed;
use voxsoft_scene::Touching as Played;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Body, Brick, Clamp, Mesh, Motion, Problem, ProblemError, Rigid, Springs};

/// What moves a rigid object.
#[derive(Debug, Clone)]
pub(crate) enum Way {
    /// It is held, or moved.
    Held(Option<Motion>),
    /// It moves freely, with a mass in kg.
    Free(f64),
}

/// A rigid object: its surface, what carries it, and how it is moved.
#[derive(Debug, Clone)]
pub(crate) struct ObjectPart {
    pub points: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    pub frame: Frame,
    pub way: Way,
}

impl ObjectPart {
    fn is_free(&self) -> bool {
        matches!(self.way, Way::Free(_))
    }
}

/// A body that touches.
#[derive(Debug, Clone)]
pub(crate) struct BodyPart {
    /// Its boundary; used where it is not made of voxels.
    pub surface: Vec<[u32; 3]>,
    pub voxel: f64,
    pub refine: u32,
    /// The smooth surface of a body of voxels, where it has one; its vertices count from the first of the body.
    pub skin: Option<Arc<Skin>>,
    /// Its vertices among all.
    pub vertices: Range<u32>,
}

impl BodyPart {
    /// Its surface, and what stands for each point of it.
    fn surface(&self, all: &[[u32; 8]]) -> (Surface, Vec<Carried>) {
        let moved = |point: &Carried| Carried {
            vertices: point
                .vertices
                .iter()
                .map(|v| v + self.vertices.start)
                .collect(),
            weights: point.weights.clone(),
        };
        if let Some(skin) = &self.skin {
            let surface = Surface {
                points: skin.surface.points.iter().map(moved).collect(),
                triangles: skin.surface.triangles.clone(),
            };
            return (surface, skin.shares.iter().map(moved).collect());
        }
        let own = all.iter().filter(|v| self.vertices.contains(&v[0]));
        let voxels: Vec<[u32; 8]> = own.copied().collect();
        let surface = if voxels.is_empty() {
            Surface::of_triangles(&self.surface)
        } else {
            Surface::of_voxels(&voxels, self.refine)
        };
        let shares = surface.points.clone();
        (surface, shares)
    }
}

/// Everything that contact is made of.
#[derive(Debug, Clone, Default)]
pub(crate) struct TouchParts {
    pub bodies: Vec<BodyPart>,
    pub objects: Vec<ObjectPart>,
    pub friction: Vec<Vec<f64>>,
    pub bonds: Vec<BondPart>,
}

/// Two surfaces that are bonded where they are near each other at rest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BondPart {
    pub of: [u32; 2],
    /// m
    pub reach: f64,
    /// Pa; infinite for a bond that does not let go.
    pub strength: f64,
}

impl TouchParts {
    /// Adds four vertices for each object to a mesh, and the clamps that hold them, or their mass.
    pub(crate) fn add_frames(&self, mesh: &mut Mesh, clamps: &mut Vec<Clamp>) {
        for object in &self.objects {
            let first = mesh.vertices.len() as u32;
            mesh.vertices.extend(object.frame.vertices());
            match &object.way {
                Way::Held(motion) => clamps.push(Clamp {
                    vertices: (first..first + 4).collect(),
                    axes: [true; 3],
                    motion: motion.clone(),
                }),
                Way::Free(mass) => {
                    let each = (first..first + 4).map(|vertex| (vertex, mass / 4.0));
                    mesh.point_masses.extend(each);
                }
            }
        }
    }

    /// What keeps the vertices of free objects apart, those of the first object from `first` on.
    pub(crate) fn frame_springs(&self, body: &Body, first: usize) -> Option<Springs> {
        let young = mean_modulus(body);
        let free = self
            .objects
            .iter()
            .enumerate()
            .filter(|(_, object)| object.is_free());
        let springs = free.flat_map(|(number, object)| {
            let stiffness = object.frame.stiffness(&object.points, young, self.voxel());
            object.frame.springs((first + 4 * number) as u32, stiffness)
        });
        let springs: Vec<_> = springs.collect();
        (!springs.is_empty()).then_some(Springs(springs))
    }

    /// The size of the smallest voxels in m: right for all, as it is a bound of what may be deep, or be near.
    fn voxel(&self) -> f64 {
        let sizes = self.bodies.iter().map(|body| body.voxel);
        sizes.fold(f64::INFINITY, f64::min)
    }

    /// How many objects clamps hold.
    pub(crate) fn held(&self) -> usize {
        self.objects
            .iter()
            .filter(|object| !object.is_free())
            .count()
    }

    /// The contact of a body whose objects have their vertices from `first` on.
    pub(crate) fn contact(&self, body: &Body, first: usize) -> Result<Touch, ProblemError> {
        let (mut surfaces, mut shares) = (Vec::new(), Vec::new());
        for part in &self.bodies {
            let (surface, of_points) = part.surface(body.voxels());
            surfaces.push(surface);
            shares.extend(of_points);
        }
        for (number, object) in self.objects.iter().enumerate() {
            let at = first + 4 * number;
            let carried = |point: &Vec3| object.frame.carry(*point, at as u32);
            surfaces.push(Surface {
                points: object.points.iter().map(carried).collect(),
                triangles: object.triangles.clone(),
            });
        }
        let bonds = self.bonds.iter().map(|bond| {
            let side = |surface: u32| self.side(surface, &surfaces, &shares, body, first);
            let [a, b] = bond.of.map(side);
            Bond::new(a, b, bond.reach, bond.strength, body.rest())
        });
        let bonds = bonds.collect::<Result<_, _>>()?;
        let description = Description {
            bonds,
            surfaces,
            friction: self.friction.clone(),
            voxel: self.voxel(),
            young: mean_modulus(body),
        };
        let touch = Touch::new(description, body.rest())?;
        Ok(touch.with_bodies(self.bodies.len() as u32, shares))
    }
}

impl TouchParts {
    /// A surface with what is behind it, `shares` those of the points of all bodies. Bodies come before the objects, so that
    /// of a bond with an object the first side is the soft one.
    fn side<'a>(
        &'a self,
        number: u32,
        surfaces: &'a [Surface],
        shares: &'a [Carried],
        body: &'a Body,
        first: usize,
    ) -> Side<'a> {
        let number = number as usize;
        let (solid, shares) = match number.checked_sub(self.bodies.len()) {
            Some(object) => {
                let at = first + 4 * object;
                (
                    Solid::Rigid(&self.objects[object].frame, at as u32),
                    &[][..],
                )
            }
            None => {
                let points = |surfaces: &[Surface]| surfaces.iter().map(|s| s.points.len()).sum();
                let (start, end): (usize, usize) =
                    (points(&surfaces[..number]), points(&surfaces[..=number]));
                (Solid::Voxels(body.voxels()), &shares[start..end])
            }
        };
        Side {
            number: number as u32,
            surface: &surfaces[number],
            shares,
            solid,
        }
    }
}

/// The energy at a strain of one over the volume, twice: a mean of Young's moduli, Pa.
fn mean_modulus(body: &Body) -> f64 {
    let volume = |brick: &Brick| brick.volume(body.material_of(brick));
    let bricks: f64 = body.bricks().iter().map(volume).sum();
    let tets: f64 = body.tets().iter().map(|tet| tet.volume).sum();
    2.0 * body.unit_strain_energy() / (bricks + tets)
}

fn frame_at(positions: &[Vec3], first: usize) -> [Vec3; 4] {
    std::array::from_fn(|i| positions[first + i])
}

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
        to_python(py, self.touch.pairs(positions))
    }

    /// Where the objects are, the vertices of the first one being those from `first` on.
    pub(crate) fn poses(
        &self,
        py: Python<'_>,
        positions: &[Vec3],
        first: usize,
    ) -> PyResult<Vec<Py<PyObjectPose>>> {
        let objects = self.parts.objects.iter().enumerate();
        let each = objects.map(|(number, object)| {
            let now = frame_at(positions, first + 4 * number);
            let (position, rotation) = object.frame.pose(&now);
            Py::new(py, PyObjectPose { position, rotation })
        });
        each.collect()
    }

    /// The same contact for live motion: what each surface is called, and the middle (m) of each object that is drawn.
    pub(crate) fn to_play(&self, body: &Body, names: Vec<String>, middles: &[Vec3]) -> Played {
        let corners = |number: usize| {
            let first = (self.first + 4 * number) as u32;
            std::array::from_fn(|i| first + i as u32)
        };
        let free = self.parts.objects.iter().enumerate();
        let free = free.filter(|(_, object)| object.is_free());
        let place = |(number, middle): (usize, &Vec3)| Placed {
            vertices: corners(number),
            middle: *middle,
        };
        let springs = self.parts.frame_springs(body, self.first);
        Played {
            description: self.touch.description().clone(),
            rigid: free.map(|(number, _)| Rigid(corners(number))).collect(),
            springs: springs.unwrap_or_default(),
            names,
            objects: middles.iter().enumerate().map(place).collect(),
        }
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
