//! The smooth surface of a body of voxels, carried by its voxels.
//!
//! The outer faces of the voxels are divided into four squares each, as [`Surface::of_voxels`] divides them, and their
//! points are moved onto the surface of the shape that the voxels were filled from. This is dual contouring on the
//! grid of the centers of voxels: the center of a face moves along the line between the centers of two voxels to
//! where the surface passes ([`crossing`]), the middle of an edge within the square of the four centers around it,
//! and a corner within the cube of eight, to the place that fits the planes at these crossings best ([`feature`]).
//! Each triangle has one point of each kind, so it stays in the cube of its corner, and triangles of two cubes do not
//! pass through each other (Ju and Udeshi 2006, "Intersection-free contouring on an octree grid"). The surface stays
//! as closed as the faces of the voxels are, and walls keep both sides.
//!
//! Faces are those of the cells with their center inside where a surface cuts voxels ([`cells`]).
//!
//! A point moves with the corners of one voxel as if the displacement between them, which is trilinear, went on up to
//! half a voxel beyond its faces.

mod carrier;
mod cells;
mod crossing;
mod feature;
mod folds;
#[cfg(test)]
mod tests;

use std::array;

use voxsoft_solid::vector::{Vec3, add, norm, scale, sub};

use crate::gap::{doubled, unit};
use crate::surface::{Carried, Surface};
use crate::surface::{Face, outer_faces};
pub(crate) use carrier::Carriers;
use cells::Cells;
use crossing::{Crossing, Field};
use folds::Folds;

/// Parts into which the edge of a face is divided.
const PARTS: u32 = 2;
/// Triangles per face.
const TRIANGLES: usize = 2 * (PARTS * PARTS) as usize;
/// Largest move, in voxels, of one step that brings a fitted point onto a curved surface.
const OFF: f64 = 0.25;
/// Newton steps onto the surface. Each squares the remaining distance, at first a fiftieth of a voxel on a ball of
/// eight voxels radius.
const APPROACHES: usize = 3;

/// Smooth surface of a body of voxels.
#[derive(Debug, Clone, PartialEq)]
pub struct Skin {
    /// Points, carried by vertices of voxels, also inner ones, with weights of both signs; and triangles.
    pub surface: Surface,
    /// Vertices at the surface that stand for each point, with positive weights.
    pub shares: Vec<Carried>,
    /// Positions of the points, m.
    pub points: Vec<Vec3>,
}

impl Skin {
    /// Builds the skin of voxels with the corners `voxels`, among `vertices` (m), that were filled from a shape, whose
    /// function is negative inside. Corner `c` of a voxel is at `(c >> 2 & 1, c >> 1 & 1, c & 1)`; voxels are equal
    /// cubes along the axes.
    ///
    /// # Errors
    ///
    /// Errors of the function.
    pub fn of<E>(
        voxels: &[[u32; 8]],
        vertices: &[Vec3],
        mut function: impl FnMut(&[Vec3]) -> Result<Vec<f64>, E>,
    ) -> Result<Self, E> {
        let Some(first) = voxels.first() else {
            return Ok(Self {
                surface: Surface::default(),
                shares: Vec::new(),
                points: Vec::new(),
            });
        };
        let voxel = norm(sub(
            vertices[first[4] as usize],
            vertices[first[0] as usize],
        ));
        let mut field = Field {
            values: &mut function,
            voxel,
        };
        let cells = Cells::of(voxels, vertices, &mut field)?;
        let faces = outer_faces(&cells.corners);
        let flat = Surface::of_faces(&faces, PARTS);
        let middles = middles(&faces, &cells.vertices);
        let found = field.crossings(&middles)?;
        let mut moved = Moved::new(&flat, &cells.vertices, &found);
        // A face without a crossing stays in place.
        let either = |(found, middle): (Option<Crossing>, Crossing)| found.unwrap_or(middle);
        let crossings: Vec<Crossing> = found.into_iter().zip(middles).map(either).collect();
        let mut targets = moved.targets(&crossings, voxel);
        moved.approach(&mut targets, &mut field)?;
        let folds = Folds {
            triangles: &flat.triangles,
            crossings: &crossings,
            voxel,
        };
        let points = folds.unfolded([&targets, &moved.means, &moved.starts]);
        let carriers = Carriers::new(voxels, vertices).with(cells.near.clone());
        let carried = flat.points.iter().zip(&points);
        let carried = carried
            .map(|(share, point)| carriers.carry(share, *point))
            .collect();
        Ok(Self {
            surface: Surface {
                points: carried,
                triangles: flat.triangles,
            },
            shares: flat.points.iter().map(|p| cells.share(p)).collect(),
            points,
        })
    }
}

/// Centers of faces, and their normals.
fn middles(faces: &[Face], vertices: &[Vec3]) -> Vec<Crossing> {
    let middle = |face: &Face| {
        let [a, b, c, d] = face.corners.map(|v| vertices[v as usize]);
        Crossing {
            point: scale(0.25, add(add(a, b), add(c, d))),
            normal: unit(doubled([a, b, c])),
        }
    };
    faces.iter().map(middle).collect()
}

/// Points of the divided faces on their way to the surface.
struct Moved {
    starts: Vec<Vec3>,
    /// Faces around each point.
    around: Vec<Vec<u32>>,
    /// Axes along which each point may move.
    free: Vec<[bool; 3]>,
    /// True if all faces around the point have a crossing.
    known: Vec<bool>,
    /// Mean of the crossings around each point.
    means: Vec<Vec3>,
}

impl Moved {
    fn new(flat: &Surface, vertices: &[Vec3], found: &[Option<Crossing>]) -> Self {
        let starts: Vec<Vec3> = flat.points.iter().map(|point| point.at(vertices)).collect();
        let mut around = vec![Vec::new(); starts.len()];
        for (face, triangles) in flat.triangles.chunks_exact(TRIANGLES).enumerate() {
            for point in triangles.as_flattened() {
                let faces: &mut Vec<u32> = &mut around[*point as usize];
                if faces.last() != Some(&(face as u32)) {
                    faces.push(face as u32);
                }
            }
        }
        // The midpoint of an edge moves across it; the center of a face stays at its crossing.
        let free = |point: &Carried| {
            let at = |v: &u32| vertices[*v as usize];
            let first = at(&point.vertices[0]);
            let is_of_face = point.vertices.len() == 4;
            array::from_fn(|i| !is_of_face && point.vertices.iter().all(|v| at(v)[i] == first[i]))
        };
        let all_found = |faces: &Vec<u32>| faces.iter().all(|face| found[*face as usize].is_some());
        Self {
            free: flat.points.iter().map(free).collect(),
            known: around.iter().map(all_found).collect(),
            starts,
            around,
            means: Vec::new(),
        }
    }

    /// Target positions of the points.
    fn targets(&mut self, crossings: &[Crossing], voxel: f64) -> Vec<Vec3> {
        let mut targets = Vec::with_capacity(self.starts.len());
        for (point, faces) in self.around.iter().enumerate() {
            let near: Vec<Crossing> = faces.iter().map(|f| crossings[*f as usize]).collect();
            self.means.push(feature::mean(&near));
            targets.push(feature::feature(&near, self.free[point]));
        }
        self.keep_in_cells(&mut targets, voxel);
        targets
    }

    /// Brings fitted points onto the surface.
    fn approach<E>(&self, targets: &mut [Vec3], field: &mut Field<'_, E>) -> Result<(), E> {
        let ways = self.free.iter().zip(&self.known);
        let ways: Vec<[bool; 3]> = ways
            .map(|(free, known)| free.map(|free| free && *known))
            .collect();
        for _ in 0..APPROACHES {
            field.approach(targets, &ways, OFF * field.voxel)?;
            self.keep_in_cells(targets, field.voxel);
        }
        Ok(())
    }

    fn keep_in_cells(&self, targets: &mut [Vec3], voxel: f64) {
        let half = voxel / 2.0;
        for (target, start) in targets.iter_mut().zip(&self.starts) {
            *target = array::from_fn(|i| target[i].clamp(start[i] - half, start[i] + half));
        }
    }
}
