//! Contact of a scene: surfaces, friction, rigid objects.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use voxsoft_contact::surface::{Carried, Surface};
use voxsoft_contact::surface_contact::Description;
use voxsoft_contact::surface_contact::live::LiveSurfaceContact;
use voxsoft_player::{Placed, Touching as Played};
use voxsoft_solid::{Problem, ProblemError, Rigid, Springs};

/// Contact of a problem for play, with names for reports.
#[derive(Debug, Clone, PartialEq)]
pub struct Touching {
    /// Surfaces and their friction.
    pub description: Description,
    /// Rigid objects that move freely.
    pub rigid: Vec<Rigid>,
    /// Springs that keep them rigid.
    pub springs: Springs,
    /// Names of the surfaces.
    pub names: Vec<String>,
    /// Objects that are drawn.
    pub objects: Vec<Placed>,
}

impl Touching {
    /// Adds this contact to a problem; returns it with the names and objects for a player.
    pub(crate) fn add_to(&self, problem: Problem) -> Result<(Problem, Played), ProblemError> {
        let description = self.description.clone();
        let contact = LiveSurfaceContact::new(description, problem.body().rest())?;
        let problem = problem
            .with_term(Arc::new(self.springs.clone()))?
            .with_rigid(self.rigid.clone())?
            .with_contact(Box::new(contact))?;
        let played = Played {
            names: self.names.clone(),
            objects: self.objects.clone(),
        };
        Ok((problem, played))
    }
}

/// Vertices and weights of each point, and triangles of points.
type SurfaceForm = (Vec<(Vec<u32>, Vec<f64>)>, Vec<[u32; 3]>);

/// Serialized layout of contact.
#[derive(Serialize, Deserialize)]
pub(crate) struct Form {
    /// Vertices and weights of the points of each surface, and its triangles.
    surfaces: Vec<SurfaceForm>,
    friction: Vec<Vec<f64>>,
    voxel: f64,
    young: f64,
    rigid: Vec<[u32; 4]>,
    springs: Springs,
    names: Vec<String>,
    objects: Vec<Placed>,
}

/// True if the triangles index only `points` points and use each of them.
fn all_are_used(points: usize, triangles: &[[u32; 3]]) -> bool {
    let mut used = vec![false; points];
    for point in triangles.as_flattened() {
        match used.get_mut(*point as usize) {
            Some(used) => *used = true,
            None => return false,
        }
    }
    !used.contains(&false)
}

impl From<&Touching> for Form {
    fn from(touching: &Touching) -> Self {
        let point = |point: &Carried| (point.vertices.clone(), point.weights.clone());
        let surface = |surface: &Surface| {
            let points = surface.points.iter().map(point).collect();
            (points, surface.triangles.clone())
        };
        // Bonds are dropped: designs with bonds are not played.
        let Description {
            surfaces,
            friction,
            voxel,
            young,
            bonds: _,
        } = &touching.description;
        Self {
            surfaces: surfaces.iter().map(surface).collect(),
            friction: friction.clone(),
            voxel: *voxel,
            young: *young,
            rigid: touching.rigid.iter().map(|body| body.0).collect(),
            springs: touching.springs.clone(),
            names: touching.names.clone(),
            objects: touching.objects.clone(),
        }
    }
}

impl Form {
    /// Makes the contact, if all vertices of points and objects are below `count`.
    pub(crate) fn of_vertices(self, count: usize) -> Option<Touching> {
        let known = |vertex: &u32| (*vertex as usize) < count;
        let sound = |(vertices, weights): &(Vec<u32>, Vec<f64>)| {
            vertices.iter().all(known) && vertices.len() == weights.len()
        };
        let good = self.surfaces.iter().all(|(points, triangles)| {
            points.iter().all(sound) && all_are_used(points.len(), triangles)
        }) && self
            .objects
            .iter()
            .all(|object| object.vertices.iter().all(known));
        let surface = |(points, triangles): SurfaceForm| {
            let point = |(vertices, weights)| Carried { vertices, weights };
            let points = points.into_iter().map(point).collect();
            Surface { points, triangles }
        };
        good.then(|| Touching {
            description: Description {
                bonds: Vec::new(),
                surfaces: self.surfaces.into_iter().map(surface).collect(),
                friction: self.friction,
                voxel: self.voxel,
                young: self.young,
            },
            rigid: self.rigid.into_iter().map(Rigid).collect(),
            springs: self.springs,
            names: self.names,
            objects: self.objects,
        })
    }
}
