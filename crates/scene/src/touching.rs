//! What touches in a scene: surfaces, friction, rigid objects.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use voxsoft_contact::touch::live::LiveTouch;
use voxsoft_contact::touch::{Carried, Description, Surface};
use voxsoft_player::{Placed, Touching as Played};
use voxsoft_solid::{Problem, ProblemError, Rigid, Springs};

/// Contact of a problem, and what it takes to play and to tell of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Touching {
    /// The surfaces and their friction.
    pub description: Description,
    /// What is rigid and moves freely.
    pub rigid: Vec<Rigid>,
    /// The springs that keep it rigid.
    pub springs: Springs,
    /// What each surface is called.
    pub names: Vec<String>,
    /// The objects that are drawn.
    pub objects: Vec<Placed>,
}

impl Touching {
    /// The problem with this contact, and what a player is told of it.
    pub(crate) fn add_to(&self, problem: Problem) -> Result<(Problem, Played), ProblemError> {
        let description = self.description.clone();
        let contact = LiveTouch::new(description, problem.body().rest())?;
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

/// The same as it is laid out in bytes.
#[derive(Serialize, Deserialize)]
pub(crate) struct Form {
    /// Of each surface the vertices and weights of its points, and its triangles.
    surfaces: Vec<SurfaceForm>,
    friction: Vec<Vec<f64>>,
    voxel: f64,
    young: f64,
    rigid: Vec<[u32; 4]>,
    springs: Springs,
    names: Vec<String>,
    objects: Vec<Placed>,
}

/// Whether triangles are of so many points, each of which is on one.
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
        // Designs with bonds are not played.
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
    /// What it describes, if all vertices of points and objects are among so many.
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
