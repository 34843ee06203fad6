use std::collections::HashSet;

use voxsoft_solid::fields::{Field, Fields};
use voxsoft_solid::vector::{Vec3, add, norm, scale, sub};
use voxsoft_solid::{Body, ProblemError, State};

use crate::pack::{FrameHead, pack_frame, pack_topology};

/// Tetrahedra are drawn this much smaller, so that one sees between them.
const SHRINK: f64 = 0.85;

/// An edge of a surface triangle longer than this times the voxel size is a face diagonal.
const DIAGONAL: f64 = 1.2;

/// What of a body is shown.
#[derive(Debug, Clone)]
pub struct Display {
    /// The vertices of the body that are needed, in ascending order, with the elements around them.
    fields: Fields,
    /// For shrunk tetrahedra, the places of their corners; each corner is a point.
    tets: Option<Vec<[u32; 4]>>,
    triangles: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    tags: Vec<u8>,
    voxel_size: f64,
}

impl Display {
    /// The surface given by triangles of body vertices, each with a tag for the client. With a voxel size
    /// (m) above zero, edges that are face diagonals are left out.
    pub fn surface(
        body: &Body,
        triangles: &[[u32; 3]],
        tags: &[u8],
        voxel_size: f64,
    ) -> Result<Self, ProblemError> {
        let (vertices, places) = used(body, triangles.as_flattened(), tags, triangles.len())?;
        let triangles: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(&places)).collect();
        let rest = |place: u32| body.rest()[vertices[place as usize] as usize];
        let mut seen = HashSet::new();
        let mut edges = Vec::new();
        for &[a, b, c] in &triangles {
            for [a, b] in [[a, b], [b, c], [c, a]] {
                let edge = [a.min(b), a.max(b)];
                let length = norm(sub(rest(a), rest(b)));
                if (voxel_size <= 0.0 || length < DIAGONAL * voxel_size) && seen.insert(edge) {
                    edges.push(edge);
                }
            }
        }
        Ok(Self {
            triangles,
            edges,
            tags: tags.to_vec(),
            voxel_size,
            fields: Fields::new(body, vertices),
            tets: None,
        })
    }

    /// Tetrahedra of body vertices, each shrunk toward its center and with a tag for the client.
    pub fn tets(
        body: &Body,
        tets: &[[u32; 4]],
        tags: &[u8],
        voxel_size: f64,
    ) -> Result<Self, ProblemError> {
        let (vertices, places) = used(body, tets.as_flattened(), tags, tets.len())?;
        let (mut triangles, mut edges, mut all_tags) = (Vec::new(), Vec::new(), Vec::new());
        for (index, tag) in tags.iter().enumerate() {
            let corner = |c: u32| 4 * index as u32 + c;
            triangles.extend([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].map(|t| t.map(corner)));
            edges.extend([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]].map(|e| e.map(corner)));
            all_tags.extend([*tag; 4]);
        }
        Ok(Self {
            triangles,
            edges,
            tags: all_tags,
            voxel_size,
            tets: Some(tets.iter().map(|t| t.map(&places)).collect()),
            fields: Fields::new(body, vertices),
        })
    }

    /// The body vertices that are shown, in ascending order: those of the points of a surface.
    pub fn vertices(&self) -> &[u32] {
        self.fields.vertices()
    }

    /// The number of points.
    pub fn points(&self) -> usize {
        self.tets
            .as_ref()
            .map_or(self.vertices().len(), |tets| 4 * tets.len())
    }

    /// The message that says what is shown.
    pub fn topology(&self, body: &Body, number: u32) -> Vec<u8> {
        let flag = if self.tets.is_some() { 2 } else { 1 };
        let points = self.place(body.rest());
        let shape = (&*self.triangles, &*self.edges, &*self.tags);
        pack_topology(flag, number, self.voxel_size, &points, shape)
    }

    /// The message of one picture.
    ///
    /// # Panics
    ///
    /// If the state is one of another body.
    pub fn frame(&self, body: &Body, state: &State, field: Field, head: FrameHead) -> Vec<u8> {
        let values = self.fields.evaluate(body, state, field);
        let values = match &self.tets {
            Some(tets) => tets
                .as_flattened()
                .iter()
                .map(|&place| values[place as usize])
                .collect(),
            None => values,
        };
        let points = self.place(&state.positions);
        pack_frame(head, field, state.time, &points, &values)
    }

    fn place(&self, positions: &[Vec3]) -> Vec<Vec3> {
        let of = |place: u32| positions[self.vertices()[place as usize] as usize];
        let Some(tets) = &self.tets else {
            return (0..self.vertices().len() as u32).map(of).collect();
        };
        let mut points = Vec::with_capacity(4 * tets.len());
        for tet in tets {
            let corners = tet.map(of);
            let center = scale(0.25, corners.into_iter().fold([0.0; 3], add));
            points.extend(corners.map(|x| add(center, scale(SHRINK, sub(x, center)))));
        }
        points
    }
}

/// The vertices used, and where each stands among them.
fn used(
    body: &Body,
    corners: &[u32],
    tags: &[u8],
    count: usize,
) -> Result<(Vec<u32>, impl Fn(u32) -> u32 + use<>), ProblemError> {
    let vertices = body.rest().len();
    if let Some(&index) = corners.iter().find(|&&v| v as usize >= vertices) {
        return Err(ProblemError::Index {
            what: "vertex of what is shown",
            index: index as usize,
            count: vertices,
        });
    }
    if tags.len() != count {
        return Err(ProblemError::Length {
            what: "tags of what is shown",
            got: tags.len(),
            expected: count,
        });
    }
    let mut shown = vec![false; vertices];
    for &vertex in corners {
        shown[vertex as usize] = true;
    }
    let used: Vec<u32> = (0..vertices as u32)
        .filter(|&v| shown[v as usize])
        .collect();
    let mut place_of = vec![0; vertices];
    for (place, &vertex) in used.iter().enumerate() {
        place_of[vertex as usize] = place as u32;
    }
    Ok((used, move |vertex| place_of[vertex as usize]))
}
