//! A beam that carries rigid objects, for trials.

use std::sync::Arc;

use voxsoft_solid::assembly::Visitor;
use voxsoft_solid::vector::{Vec3, add, dot, scale, sub};
use voxsoft_solid::{Body, Clamp, Load, Material, Mesh, Problem, Spring, Springs, Term};
use voxsoft_voxel::{Grid, tet_mesh};

use super::trials::rubber;

/// Springs that reach from surface to surface only.
#[derive(Debug)]
struct Near(Springs);

impl Term for Near {
    fn name(&self) -> &'static str {
        "springs of a surface"
    }

    fn is_local(&self) -> bool {
        true
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        self.0.visit_pattern(visit);
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        self.0.energy(positions)
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        self.0.add_forces(positions, forces);
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        self.0.visit_stiffness(positions, visit);
    }
}

/// Springs without length of a stiffness (N/m) between vertices of a body and points of an object in the same places,
/// whose vertices are those from `first` on, in the corners of a regular tetrahedron.
fn glued(mesh: &Mesh, below: &[u32], first: u32, stiffness: f64) -> Springs {
    let corners: [Vec3; 4] = std::array::from_fn(|k| mesh.vertices[first as usize + k]);
    let middle = scale(0.25, corners.into_iter().fold([0.0; 3], add));
    let spring = |vertex: &u32| {
        let from = sub(mesh.vertices[*vertex as usize], middle);
        let weight = |corner: Vec3| {
            let arm = sub(corner, middle);
            -0.25 - 0.75 * dot(arm, from) / dot(arm, arm)
        };
        Spring {
            vertices: [&[*vertex][..], &[first, first + 1, first + 2, first + 3]].concat(),
            weights: [&[1.0][..], &corners.map(weight)].concat(),
            anchor: [0.0; 3],
            length: 0.0,
            stiffness,
        }
    };
    Springs(below.iter().map(spring).collect())
}

/// The beam with two rigid objects glued to its top and to each other by springs of a stiffness that is some hundred
/// times that of a voxel; springs ten thousand times as stiff as the body keep their shape.
pub(crate) fn laden(young: f64) -> Problem {
    let (cells, side) = ([12, 6, 6], 0.005);
    let mut grid = Grid::empty(cells, [0.0; 3], side, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], cells.map(|n| n as f64 * side), 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let mut mesh = Mesh {
        tet_part: vec![0; tets.tets.len()],
        tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        vertices: tets.vertices,
        block_fraction: vec![1.0; tets.tets.len() / 5],
        ..Mesh::default()
    };
    let near = |x: Vec3, low: f64, high: f64| x[2] > 0.0299 && x[0] > low && x[0] < high;
    let vertices = |mesh: &Mesh, low: f64, high: f64| -> Vec<u32> {
        let all = 0..mesh.vertices.len() as u32;
        all.filter(|&v| near(mesh.vertices[v as usize], low, high))
            .collect()
    };
    let places = [vertices(&mesh, 0.009, 0.031), vertices(&mesh, 0.039, 0.061)];
    let foot: Vec<u32> = (0..mesh.vertices.len() as u32)
        .filter(|&v| mesh.vertices[v as usize][0] < 1e-9)
        .collect();
    let (mut springs, mut glue) = (Vec::new(), Vec::new());
    let arm = 0.01;
    let mut firsts = Vec::new();
    for (number, below) in places.iter().enumerate() {
        let first = mesh.vertices.len() as u32;
        let middle = [0.02 + 0.03 * number as f64, 0.015, 0.045];
        let signs = [
            [1.0, 1.0, 1.0],
            [1.0, -1.0, -1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, -1.0, 1.0],
        ];
        mesh.vertices
            .extend(signs.map(|sign: Vec3| add(middle, scale(arm, sign))));
        for a in 0..4 {
            for b in a + 1..4 {
                springs.push(Spring {
                    vertices: vec![first + a, first + b],
                    weights: vec![1.0, -1.0],
                    anchor: [0.0; 3],
                    length: 8f64.sqrt() * arm,
                    stiffness: 1e4 * young * 0.02f64.powi(2) / side,
                });
            }
        }
        glue.extend(glued(&mesh, below, first, 100.0 * young * side).0);
        firsts.push(first);
    }
    // The objects touch each other in a point between them.
    let [one, other] = [firsts[0], firsts[1]];
    glue.push(Spring {
        vertices: (one..one + 4).chain(other..other + 4).collect(),
        weights: vec![0.25, 0.25, 0.25, 0.25, -0.25, -0.25, -0.25, -0.25],
        anchor: [0.0; 3],
        length: 0.03,
        stiffness: 100.0 * young * side,
    });
    let body = Body::new(&mesh, &[Material::from(rubber())]).unwrap();
    let gravity = Load::gravity([0.0, 0.0, -9.81]);
    Problem::new(body, vec![Clamp::fixed(foot)], vec![gravity], None)
        .unwrap()
        .with_term(Arc::new(Springs(springs)))
        .unwrap()
        .with_term(Arc::new(Near(Springs(glue))))
        .unwrap()
}
