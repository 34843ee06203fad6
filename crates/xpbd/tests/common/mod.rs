//! Small problems shared by the tests.
#![allow(dead_code, reason = "each test file uses some of them")]

use std::ops::ControlFlow;

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Body, Clamp, Floor, LatticeMaterial, Load, Mesh, Problem, State};
use voxsoft_voxel::{Grid, tet_mesh};
use voxsoft_xpbd::{Answer, Dynamics, Relaxation};

pub const DENSITY: f64 = 1070.0;
pub const GRAVITY: Vec3 = [0.0, 0.0, -9.81];

/// Mesh of a block of `cells` voxels of the edge `h`, from the origin.
pub fn block(cells: [usize; 3], h: f64) -> Mesh {
    let mut grid = Grid::empty(cells, [0.0; 3], h, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], cells.map(|n| n as f64 * h), 1);
    let mesh = tet_mesh(&grid, u64::MAX).unwrap();
    let count = mesh.tets.len();
    Mesh {
        vertices: mesh.vertices,
        tets: mesh.tets.iter().map(|tet| tet.map(|v| v as u32)).collect(),
        tet_part: vec![0; count],
        tet_block: (0..count as u32).map(|tet| tet / 5).collect(),
        ..Mesh::default()
    }
}

pub fn where_<F: Fn(&Vec3) -> bool>(mesh: &Mesh, inside: F) -> Vec<u32> {
    (0..mesh.vertices.len() as u32)
        .filter(|&v| inside(&mesh.vertices[v as usize]))
        .collect()
}

/// The paper's beam: 90 × 10 × 10 mm in voxels of 5 mm, held at x = 0, under its weight.
pub fn beam(edge: f64, bulk: f64) -> Problem {
    let mesh = block([18, 2, 2], 5e-3);
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    problem(
        &mesh,
        edge,
        bulk,
        vec![clamp],
        vec![Load::gravity(GRAVITY)],
        None,
    )
}

pub fn problem(
    mesh: &Mesh,
    edge: f64,
    bulk: f64,
    clamps: Vec<Clamp>,
    loads: Vec<Load>,
    floor: Option<Floor>,
) -> Problem {
    let material = LatticeMaterial::from_moduli(edge, bulk, DENSITY).unwrap();
    Problem::new(Body::new(mesh, &[material]).unwrap(), clamps, loads, floor).unwrap()
}

pub fn simulate(problem: &Problem, settings: &Dynamics) -> Answer {
    let start = State::at_rest(problem.body());
    voxsoft_xpbd::simulate(problem, start, settings, &mut |_| ControlFlow::Continue(()))
}

pub fn relax(problem: &Problem, settings: &Relaxation) -> Answer {
    let start = State::at_rest(problem.body());
    voxsoft_xpbd::relax(problem, start, settings, &mut |_| ControlFlow::Continue(()))
}

/// Mean displacement of the vertices with the largest x at rest.
pub fn tip(problem: &Problem, answer: &Answer) -> Vec3 {
    let rest = problem.body().rest();
    let end = rest.iter().map(|p| p[0]).fold(f64::NEG_INFINITY, f64::max) - 1e-9;
    let tips: Vec<usize> = (0..rest.len()).filter(|&v| rest[v][0] > end).collect();
    std::array::from_fn(|axis| {
        let moved = |&v: &usize| answer.state.positions[v][axis] - rest[v][axis];
        tips.iter().map(moved).sum::<f64>() / tips.len() as f64
    })
}
