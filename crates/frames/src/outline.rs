use voxsoft_solid::ProblemError;
use voxsoft_solid::vector::{Vec3, add, norm, scale, sub};

use crate::pack::{FrameHead, Shape, TopologyFlag, pack_frame, pack_topology};

/// Scale of drawn tetrahedra, which leaves gaps to see between them.
const SHRINK: f64 = 0.85;

/// Least extent of an edge along an axis, in voxels, that counts as a direction of it.
const ALONG: f64 = 1e-3;

/// Largest length of an edge of a voxel over the longest side of its triangle, the face diagonal (0.71 of it for a
/// square).
const SHORTER: f64 = 0.8;

/// Displayed part of any mesh.
#[derive(Debug, Clone)]
pub struct Outline {
    /// Displayed vertices of the mesh: those of the drawn surface or tetrahedra in ascending order, then those of
    /// voxels within.
    vertices: Vec<u32>,
    /// Corners of shrunk tetrahedra, as indices into `vertices`; each corner is a point.
    tets: Option<Vec<[u32; 4]>>,
    triangles: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    tags: Vec<u8>,
    /// Voxels by their corners `x, y, z` in bits 2, 1, 0, for sections; empty unless made by [`Outline::solid`].
    voxels: Vec<[u32; 8]>,
    voxel_size: f64,
}

impl Outline {
    /// Surface given by triangles of a mesh, each with a tag for the client. A voxel size (m) above zero leaves face
    /// diagonals out of the edges.
    pub fn surface(
        rest: &[Vec3],
        triangles: &[[u32; 3]],
        tags: &[u8],
        voxel_size: f64,
    ) -> Result<Self, ProblemError> {
        let vertices = used(rest, triangles.as_flattened(), tags, triangles.len())?;
        let place = places(rest, &vertices);
        let triangles: Vec<[u32; 3]> = triangles
            .iter()
            .map(|t| t.map(|v| place[v as usize]))
            .collect();
        let at = |place: u32| rest[vertices[place as usize] as usize];
        let is_along_axis = |[a, b]: [u32; 2]| {
            let (a, b) = (at(a), at(b));
            let moves = |axis: &usize| (a[*axis] - b[*axis]).abs() > ALONG * voxel_size;
            (0..3).filter(moves).count() == 1
        };
        let drawn = |&[a, b, c]: &[u32; 3]| {
            let sides = [[a, b], [b, c], [c, a]];
            let lengths = sides.map(|[a, b]| norm(sub(at(a), at(b))));
            let longest = lengths.into_iter().fold(0.0, f64::max);
            // In a rotated voxel only lengths identify the diagonal: it is the longest side of half a square.
            let is_edge = |(side, length): ([u32; 2], f64)| {
                voxel_size <= 0.0 || is_along_axis(side) || length < SHORTER * longest
            };
            let each = sides.into_iter().zip(lengths).filter(move |s| is_edge(*s));
            each.map(|(side, _)| side).collect::<Vec<_>>()
        };
        let mut edges: Vec<[u32; 2]> = triangles
            .iter()
            .flat_map(drawn)
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        edges.sort_unstable();
        edges.dedup();
        Ok(Self {
            vertices,
            tets: None,
            triangles,
            edges,
            tags: tags.to_vec(),
            voxels: Vec::new(),
            voxel_size,
        })
    }

    /// Surface with the voxels behind it, given by their corners, for sections through the inside.
    pub fn solid(
        rest: &[Vec3],
        triangles: &[[u32; 3]],
        tags: &[u8],
        voxels: &[[u32; 8]],
        voxel_size: f64,
    ) -> Result<Self, ProblemError> {
        let mut outline = Self::surface(rest, triangles, tags, voxel_size)?;
        let corners = used(rest, voxels.as_flattened(), &[], 0)?;
        let on_surface = |v: &u32| outline.vertices.binary_search(v).is_ok();
        let within: Vec<u32> = corners.into_iter().filter(|v| !on_surface(v)).collect();
        outline.vertices.extend(within);
        let place = places(rest, &outline.vertices);
        outline.voxels = voxels
            .iter()
            .map(|c| c.map(|v| place[v as usize]))
            .collect();
        Ok(outline)
    }

    /// Tetrahedra of a mesh, each shrunk toward its center and with a tag for the client.
    pub fn tets(
        rest: &[Vec3],
        tets: &[[u32; 4]],
        tags: &[u8],
        voxel_size: f64,
    ) -> Result<Self, ProblemError> {
        let vertices = used(rest, tets.as_flattened(), tags, tets.len())?;
        let place = places(rest, &vertices);
        let faces = |index: u32| {
            [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].map(|t: [u32; 3]| t.map(|c| 4 * index + c))
        };
        Ok(Self {
            triangles: (0..tets.len() as u32).flat_map(faces).collect(),
            edges: Vec::new(),
            tags: tags.iter().flat_map(|tag| [*tag; 4]).collect(),
            voxels: Vec::new(),
            voxel_size,
            tets: Some(tets.iter().map(|t| t.map(|v| place[v as usize])).collect()),
            vertices,
        })
    }

    /// Displayed vertices of the mesh: those of a surface in ascending order, then those within.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.tets
            .as_ref()
            .map_or(self.vertices.len(), |tets| 4 * tets.len())
    }

    /// Triangles of points.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Edges of voxels, as pairs of points.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// Packs the topology message.
    pub fn topology(&self, rest: &[Vec3], number: u32) -> Vec<u8> {
        let flag = match self.tets {
            Some(_) => TopologyFlag::ShrunkTets,
            None => TopologyFlag::Surface,
        };
        let shape = Shape {
            triangles: &self.triangles,
            edges: &self.edges,
            voxels: &self.voxels,
            tags: &self.tags,
        };
        pack_topology(flag, number, self.voxel_size, &self.place(rest), shape)
    }

    /// Packs the message of a frame: positions (m) of all vertices of the mesh, and a value for each of
    /// [`Outline::vertices`]. `field` is the number of a [`Field`](voxsoft_solid::fields::Field), or one that its
    /// sender defines.
    pub fn frame(
        &self,
        head: FrameHead,
        time: f64,
        positions: &[Vec3],
        field: u16,
        values: &[f64],
    ) -> Vec<u8> {
        let points = self.place(positions);
        match &self.tets {
            Some(tets) => {
                let corners = tets.as_flattened().iter();
                let values: Vec<f64> = corners.map(|&place| values[place as usize]).collect();
                pack_frame(head, field, time, &points, &values)
            }
            None => pack_frame(head, field, time, &points, values),
        }
    }

    fn place(&self, positions: &[Vec3]) -> Vec<Vec3> {
        let of = |place: u32| positions[self.vertices[place as usize] as usize];
        let Some(tets) = &self.tets else {
            return (0..self.vertices.len() as u32).map(of).collect();
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

/// Vertices that are used, in ascending order; checks indices and the number of tags.
fn used(
    rest: &[Vec3],
    corners: &[u32],
    tags: &[u8],
    count: usize,
) -> Result<Vec<u32>, ProblemError> {
    let mut shown = vec![false; rest.len()];
    for &vertex in corners {
        *shown.get_mut(vertex as usize).ok_or(ProblemError::Index {
            what: "vertex of what is shown",
            index: vertex as usize,
            count: rest.len(),
        })? = true;
    }
    if tags.len() != count {
        return Err(ProblemError::Length {
            what: "tags of what is shown",
            got: tags.len(),
            expected: count,
        });
    }
    Ok((0..rest.len() as u32)
        .filter(|&v| shown[v as usize])
        .collect())
}

/// Index of each vertex of a mesh among the used ones.
fn places(rest: &[Vec3], used: &[u32]) -> Vec<u32> {
    let mut places = vec![0; rest.len()];
    for (place, &vertex) in used.iter().enumerate() {
        places[vertex as usize] = place as u32;
    }
    places
}
