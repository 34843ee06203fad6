//! Contact of bodies with themselves and with rigid objects: its description from Python and its results.
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use pyo3::prelude::*;
use voxsoft_contact::skin::Skin;
use voxsoft_contact::surface::{Carried, Surface};
use voxsoft_contact::surface_contact::bonds::Bond;
use voxsoft_contact::surface_contact::law::Laws;
use voxsoft_contact::surface_contact::rigid::Frame;
use voxsoft_contact::surface_contact::tie::{Side, Solid};
use voxsoft_contact::surface_contact::{Description, Flip, SurfaceContact};
use voxsoft_player::Placed;
use voxsoft_scene::Touching as Played;
use voxsoft_solid::matrix::Mat3;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Body, Clamp, Contact, Hex8, Images, Mesh, MirroredContact, Motion, Problem, ProblemError,
    Rigid, Springs,
};

use crate::contact_answer::{PyContact, PyObjectPose, to_python};

/// Motion of a rigid object.
#[derive(Debug, Clone)]
pub(crate) enum Way {
    /// Fixed, or with a prescribed motion.
    Held(Option<Motion>),
    /// Free motion.
    Free(Freedom),
    /// Mirror image of a free object: its number, and the factors on its vectors.
    Image(usize, Vec3),
}

/// Mass and constraints of a free object.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Freedom {
    /// Mass in kg.
    pub mass: f64,
    /// Share of the mass that is solved for: less than 1 where planes of symmetry cut the object.
    pub share: f64,
    /// Axes across these planes, along which it is held.
    pub held: [bool; 3],
}

/// A whole body with planes of symmetry, of which a part is solved for.
#[derive(Debug, Clone)]
pub(crate) struct Whole {
    /// Images of the vertices of the part.
    pub images: Images,
    /// Corners of its voxels, by its own vertices.
    pub voxels: Vec<[u32; 8]>,
    /// The images of all its vertices in each plane.
    pub flips: Vec<Flip>,
}

/// A rigid object: its surface, the frame of vertices that carries it, and its motion.
#[derive(Debug, Clone)]
pub(crate) struct ObjectPart {
    pub points: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    pub frame: Frame,
    pub way: Way,
}

impl ObjectPart {
    /// Factors on vectors from the vertices that are solved for.
    fn signs(&self) -> Vec3 {
        match self.way {
            Way::Image(_, signs) => signs,
            Way::Held(_) | Way::Free(_) => [1.0; 3],
        }
    }

    fn freedom(&self) -> Option<Freedom> {
        match self.way {
            Way::Free(freedom) => Some(freedom),
            Way::Held(_) | Way::Image(..) => None,
        }
    }
}

/// A body in contact.
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
    /// Contact surface, and for each of its points the vertices that stand for it in fields.
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

/// Description of all contact of a problem.
#[derive(Debug, Clone, Default)]
pub(crate) struct ContactParts {
    pub bodies: Vec<BodyPart>,
    pub objects: Vec<ObjectPart>,
    pub friction: Vec<Vec<f64>>,
    pub bonds: Vec<BondPart>,
    /// Contact laws of pairs of surfaces that differ from hard contact.
    pub laws: Laws,
    /// The whole body, if a symmetric part of it is solved for.
    pub whole: Option<Whole>,
}

/// Two surfaces that are bonded where they are near each other at rest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BondPart {
    pub of: [u32; 2],
    /// Largest distance of bonded points at rest, m.
    pub reach: f64,
    /// Strength in traction, Pa; infinite for a bond that never fails.
    pub strength: f64,
}

impl ContactParts {
    /// Adds to a mesh four vertices for each object that is no mirror image, with their clamps or masses.
    pub(crate) fn add_frames(&self, mesh: &mut Mesh, clamps: &mut Vec<Clamp>) {
        for object in &self.objects {
            let first = mesh.vertices.len() as u32;
            let vertices = first..first + 4;
            match &object.way {
                Way::Held(motion) => clamps.push(Clamp {
                    vertices: vertices.collect(),
                    axes: [true; 3],
                    motion: motion.clone(),
                }),
                Way::Free(Freedom { mass, share, held }) => {
                    let each = vertices.clone().map(|v| (v, share * mass / 4.0));
                    mesh.point_masses.extend(each);
                    if held.contains(&true) {
                        clamps.push(Clamp {
                            vertices: vertices.collect(),
                            axes: *held,
                            motion: None,
                        });
                    }
                }
                Way::Image(..) => continue,
            }
            mesh.vertices.extend(object.frame.vertices());
        }
    }

    /// Index of the first of four vertices of an object among those that are solved for, where objects begin at
    /// `first`. A mirror image has the vertices of its original.
    fn solved_at(&self, number: usize, first: usize) -> usize {
        let number = match self.objects[number].way {
            Way::Image(of, _) => of,
            Way::Held(_) | Way::Free(_) => number,
        };
        let before = self.objects[..number].iter();
        first + 4 * before.filter(|o| !matches!(o.way, Way::Image(..))).count()
    }

    /// Images of the solved vertices that make up the whole, objects included.
    fn images(&self, first: usize) -> Option<Images> {
        let mut images = self.whole.as_ref()?.images.clone();
        for (number, object) in self.objects.iter().enumerate() {
            let at = self.solved_at(number, first) as u32;
            images.of.extend(at..at + 4);
            images.signs.extend([object.signs(); 4]);
        }
        Some(images)
    }

    /// Springs that keep the vertices of free objects rigid, where objects begin at the vertex `first`.
    pub(crate) fn frame_springs(&self, body: &Body, first: usize) -> Option<Springs> {
        let young = mean_modulus(body);
        let free = self
            .objects
            .iter()
            .enumerate()
            .filter_map(|(number, object)| Some((number, object, object.freedom()?.share)));
        let springs = free.flat_map(|(number, object, share)| {
            let stiffness = object.frame.stiffness(&object.points, young, self.voxel());
            let at = self.solved_at(number, first) as u32;
            object.frame.springs(at, share * stiffness)
        });
        let springs: Vec<_> = springs.collect();
        (!springs.is_empty()).then_some(Springs(springs))
    }

    /// Size of the smallest voxels in m: valid for all bodies, as it bounds depths and distances in contact.
    fn voxel(&self) -> f64 {
        let sizes = self.bodies.iter().map(|body| body.voxel);
        sizes.fold(f64::INFINITY, f64::min)
    }

    /// Number of clamps that hold objects.
    pub(crate) fn held(&self) -> usize {
        let is_held = |object: &&ObjectPart| match object.way {
            Way::Held(_) => true,
            Way::Free(freedom) => freedom.held.contains(&true),
            Way::Image(..) => false,
        };
        self.objects.iter().filter(is_held).count()
    }

    /// Makes the contact of a problem whose objects have their vertices from `first` on. If a symmetric part is solved
    /// for, it is the contact of the whole, whose objects come after its own vertices.
    fn touch(&self, problem: &Problem, first: usize) -> Result<SurfaceContact, ProblemError> {
        let body = problem.body();
        let images = self.images(first);
        let rest: Cow<'_, [Vec3]> = match &images {
            Some(images) => images.seen(body.rest()).into(),
            None => body.rest().into(),
        };
        let (voxels, first) = match &self.whole {
            Some(whole) => (whole.voxels.as_slice(), whole.images.of.len()),
            None => (body.voxels(), first),
        };
        let (mut surfaces, mut shares) = (Vec::new(), Vec::new());
        for part in &self.bodies {
            let (surface, of_points) = part.surface(voxels);
            surfaces.push(surface);
            shares.extend(of_points);
        }
        for (number, object) in self.objects.iter().enumerate() {
            let at = first + 4 * number;
            let carried = |point: &Vec3| self.carried(number, *point, at as u32);
            surfaces.push(Surface {
                points: object.points.iter().map(carried).collect(),
                triangles: object.triangles.clone(),
            });
        }
        let bonds = self.bonds.iter().map(|bond| {
            let side = |surface: u32| self.side(surface, &surfaces, &shares, voxels, first);
            let [a, b] = bond.of.map(side);
            Bond::new(a, b, bond.reach, bond.strength, &rest)
        });
        let bonds = bonds.collect::<Result<_, _>>()?;
        let description = Description {
            bonds,
            surfaces,
            friction: self.friction.clone(),
            voxel: self.voxel(),
            young: mean_modulus(body),
        };
        let touch = SurfaceContact::new(description, &rest)?.with_laws(self.laws.clone(), &rest);
        let touch = touch.with_bodies(self.bodies.len() as u32, shares);
        let still = still(problem);
        Ok(match &images {
            Some(images) => touch
                .with_still(
                    images.of.iter().map(|of| still[*of as usize]).collect(),
                    &rest,
                )
                .with_planes(across(images), &rest),
            None => touch.with_still(still, &rest),
        })
    }

    /// Makes the contact of a problem, with its description and mirror images.
    pub(crate) fn into_touching(
        self,
        problem: &Problem,
        first: usize,
    ) -> Result<(Touching, Box<dyn Contact>), ProblemError> {
        let touch = self.touch(problem, first)?;
        let images = self.images(first);
        let description = touch.description().clone();
        let contact: Box<dyn Contact> = match &images {
            Some(images) => Box::new(MirroredContact::new(images.clone(), touch)),
            None => Box::new(touch),
        };
        let touching = Touching {
            parts: self,
            description,
            images,
            first,
        };
        Ok((touching, contact))
    }

    /// Carries a point of an object by the four vertices from `at` on. On a mirror image, the frame of the original
    /// carries the mirrored point.
    fn carried(&self, number: usize, point: Vec3, at: u32) -> Carried {
        match self.objects[number].way {
            Way::Image(of, signs) => self.objects[of].frame.carry(mirrored(point, signs), at),
            Way::Held(_) | Way::Free(_) => self.objects[number].frame.carry(point, at),
        }
    }
}

/// Axes on which vertices are held without a prescribed motion.
fn still(problem: &Problem) -> Vec<[bool; 3]> {
    let mut still = vec![[false; 3]; problem.body().rest().len()];
    let (moving, resting): (Vec<_>, Vec<_>) = problem
        .clamps()
        .iter()
        .partition(|clamp| clamp.motion.is_some());
    for clamp in resting {
        for &vertex in &clamp.vertices {
            let held = &mut still[vertex as usize];
            *held = std::array::from_fn(|axis| held[axis] || clamp.axes[axis]);
        }
    }
    for &vertex in moving.iter().flat_map(|clamp| &clamp.vertices) {
        still[vertex as usize] = [false; 3];
    }
    still
}

/// Axes across planes of symmetry: those along which some images change sign.
fn across(images: &Images) -> [bool; 3] {
    [0, 1, 2].map(|axis| images.signs.iter().any(|signs| signs[axis] < 0.0))
}

fn mirrored(vector: Vec3, signs: Vec3) -> Vec3 {
    [0, 1, 2].map(|axis| signs[axis] * vector[axis])
}

impl ContactParts {
    /// One side of a bond: a surface with the solid behind it; `shares` are those of the points of all bodies. Bodies
    /// come before the objects, so that the first side of a bond with an object is the soft one.
    fn side<'a>(
        &'a self,
        number: u32,
        surfaces: &'a [Surface],
        shares: &'a [Carried],
        voxels: &'a [[u32; 8]],
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
                (Solid::Voxels(voxels), &shares[start..end])
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

/// Mean of Young's moduli, Pa: twice the energy at unit strain over the volume.
fn mean_modulus(body: &Body) -> f64 {
    let volume = |hex8: &Hex8| hex8.volume(body.material_of(hex8));
    let hex8s: f64 = body.hex8s().iter().map(volume).sum();
    let tets: f64 = body.tets().iter().map(|tet| tet.volume).sum();
    2.0 * body.unit_strain_energy() / (hex8s + tets)
}

fn frame_at(positions: &[Vec3], first: usize) -> [Vec3; 4] {
    std::array::from_fn(|i| positions[first + i])
}

/// Contact of a problem, with its history variables; that of the whole if a symmetric part is solved for.
pub(crate) fn contact_of(problem: &Problem) -> Option<&SurfaceContact> {
    problem.contact()?.found_by().downcast_ref()
}

/// Contact of a Python problem, and the index of the first vertex of its objects.
pub(crate) struct Touching {
    pub parts: ContactParts,
    /// Surfaces and their friction: those of the whole, also if a symmetric part is solved for.
    description: Description,
    /// Images of the solved vertices that make up the whole.
    images: Option<Images>,
    pub first: usize,
}

impl Touching {
    /// Positions of the whole, with the vertices of objects last.
    pub(crate) fn seen<'a>(&self, positions: &'a [Vec3]) -> Cow<'a, [Vec3]> {
        match &self.images {
            Some(images) => images.seen(positions).into(),
            None => positions.into(),
        }
    }

    /// Number of vertices of the whole that belong to bodies.
    pub(crate) fn own(&self) -> usize {
        let whole = self.parts.whole.as_ref();
        whole.map_or(self.first, |whole| whole.images.of.len())
    }

    /// Images of the vertices of bodies in each plane of symmetry.
    pub(crate) fn flips(&self) -> &[Flip] {
        let whole = self.parts.whole.as_ref();
        whole.map_or(&[], |whole| &whole.flips)
    }

    /// Contacts at given positions of the solved vertices.
    pub(crate) fn contacts(
        &self,
        py: Python<'_>,
        problem: &Problem,
        positions: &[Vec3],
    ) -> PyResult<Vec<Py<PyContact>>> {
        let pairs = contact_of(problem).map(|touch| touch.pairs(&self.seen(positions)));
        to_python(py, pairs.unwrap_or_default())
    }

    /// Poses of the objects, from the vertices of all of them.
    pub(crate) fn poses(&self, py: Python<'_>, frames: &[Vec3]) -> PyResult<Vec<Py<PyObjectPose>>> {
        let each = (0..self.parts.objects.len()).map(|number| {
            let (position, rotation) = self.pose(number, frames);
            Py::new(py, PyObjectPose { position, rotation })
        });
        each.collect()
    }

    fn pose(&self, number: usize, frames: &[Vec3]) -> (Vec3, Mat3) {
        let object = &self.parts.objects[number];
        let Way::Image(of, signs) = object.way else {
            return object.frame.pose(&frame_at(frames, 4 * number));
        };
        let (position, rotation) = self.pose(of, frames);
        let turned = |i: usize| std::array::from_fn(|j| signs[i] * rotation[i][j] * signs[j]);
        (mirrored(position, signs), std::array::from_fn(turned))
    }

    /// Contact for live motion, with the name of each surface and the center (m) of each drawn object.
    pub(crate) fn to_play(&self, body: &Body, names: Vec<String>, middles: &[Vec3]) -> Played {
        let corners = |number: usize| {
            let first = (self.first + 4 * number) as u32;
            std::array::from_fn(|i| first + i as u32)
        };
        let free = self.parts.objects.iter().enumerate();
        let free = free.filter(|(_, object)| object.freedom().is_some());
        let place = |(number, middle): (usize, &Vec3)| Placed {
            vertices: corners(number),
            middle: *middle,
        };
        let springs = self.parts.frame_springs(body, self.first);
        Played {
            description: self.description.clone(),
            rigid: free.map(|(number, _)| Rigid(corners(number))).collect(),
            springs: springs.unwrap_or_default(),
            names,
            objects: middles.iter().enumerate().map(place).collect(),
        }
    }

    /// Completes positions of the body with those of the objects at the end of their motions.
    pub(crate) fn completed(&self, problem: &Problem, mut body: Vec<Vec3>) -> Vec<Vec3> {
        let rest = problem.body().rest();
        let count = body.len();
        let mut all = rest.to_vec();
        problem.place_clamps(f64::INFINITY, 1.0, &mut all);
        body.extend_from_slice(&all[count..]);
        body
    }
}
