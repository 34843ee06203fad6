//! Bodies with contact.

use voxsoft_contact::surface::{Carried, Surface};
use voxsoft_contact::surface_contact::rigid::Frame;
use voxsoft_contact::surface_contact::{Description, PairReport, SurfaceContact};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Body, Clamp, History, Load, Mesh, Motion, Problem};
use voxsoft_statics::Answer;

use super::rubber;

/// Young's modulus of [`rubber`], Pa.
pub const YOUNG: f64 = 60e3;
/// Coefficient of friction of surfaces that pass through each other.
pub const NONE: f64 = f64::NAN;

/// Appends a mesh of the same material; returns the number of its first vertex.
pub fn join(mesh: &mut Mesh, other: Mesh, shift: Vec3) -> u32 {
    let first = mesh.vertices.len() as u32;
    let blocks = mesh.tet_block.iter().max().map_or(0, |block| block + 1);
    let moved = other
        .vertices
        .iter()
        .map(|x| [0, 1, 2].map(|i| x[i] + shift[i]));
    mesh.vertices.extend(moved);
    mesh.tets
        .extend(other.tets.iter().map(|t| t.map(|v| v + first)));
    mesh.tet_part.extend(other.tet_part);
    mesh.tet_block
        .extend(other.tet_block.iter().map(|b| b + blocks));
    first
}

pub fn moved(vertices: Vec<u32>, axes: [bool; 3], displacement: Vec3) -> Clamp {
    Clamp {
        vertices,
        axes,
        motion: Some(Motion {
            displacement,
            axis: [0.0, 0.0, 1.0],
            angle: 0.0,
            center: [0.0; 3],
            history: History::constant(),
            courses: None,
        }),
    }
}

/// Corners of a box.
pub fn corners_of(low: Vec3, high: Vec3) -> Vec<Vec3> {
    (0..8)
        .map(|c| [c >> 2 & 1, c >> 1 & 1, c & 1])
        .map(|bits| std::array::from_fn(|i| if bits[i] == 1 { high[i] } else { low[i] }))
        .collect()
}

/// Adds a rigid box to a mesh; returns its surface.
pub fn add_box(mesh: &mut Mesh, low: Vec3, high: Vec3) -> Surface {
    let corners = corners_of(low, high);
    add_rigid(mesh, &corners, &Frame::around(&corners))
}

/// Adds a rigid box that a frame carries, given by its corners; returns its surface.
pub fn add_rigid(mesh: &mut Mesh, corners: &[Vec3], frame: &Frame) -> Surface {
    let first = mesh.vertices.len() as u32;
    mesh.vertices.extend(frame.vertices());
    let shape = Surface::of_voxels(&[[0, 1, 2, 3, 4, 5, 6, 7]], 1);
    let on = |point: &Carried| frame.carry(corners[point.vertices[0] as usize], first);
    Surface {
        points: shape.points.iter().map(on).collect(),
        triangles: shape.triangles,
    }
}

/// Problem with contact.
pub fn touching(
    mesh: &Mesh,
    clamps: Vec<Clamp>,
    loads: Vec<Load>,
    surfaces: Vec<Surface>,
    friction: Vec<Vec<f64>>,
    voxel: f64,
) -> Problem {
    let body = Body::new(mesh, &[rubber()]).unwrap();
    let young = YOUNG;
    let description = Description {
        bonds: Vec::new(),
        surfaces,
        friction,
        voxel,
        young,
    };
    let touch = SurfaceContact::new(description, &mesh.vertices).unwrap();
    let problem = Problem::new(body, clamps, loads, None).unwrap();
    problem.with_contact(Box::new(touch)).unwrap()
}

/// Contact of a problem.
pub fn touch_of(problem: &Problem) -> &SurfaceContact {
    let contact = problem.contact().unwrap();
    contact.found_by().downcast_ref().unwrap()
}

/// Reports of all pairs in contact at a solution.
pub fn pairs_at(problem: &Problem, answer: &Answer) -> Vec<PairReport> {
    let mut there = problem.clone();
    there.remember(&answer.memory);
    touch_of(&there).pairs(&answer.positions)
}
