//! Bodies for the tests: boxes of voxels along the axes from the origin.
#![allow(dead_code, reason = "each test file uses some of it")]

pub mod touching;

use std::ops::ControlFlow;

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Body, Clamp, HyperelasticMaterial, Load, Material, Mesh, Problem};
use voxsoft_statics::{Answer, Settings, solve};
use voxsoft_voxel::{Grid, tet_mesh};

/// Mesh of all filled cells of a grid, part `p` as material `p − 1`.
pub fn mesh_of(grid: &Grid) -> Mesh {
    let tets = tet_mesh(grid, u64::MAX).unwrap();
    Mesh {
        tet_part: tets.tet_part.iter().map(|part| part - 1).collect(),
        tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    }
}

pub fn block(cells: [usize; 3], side: f64) -> Mesh {
    let mut grid = Grid::empty(cells, [0.0; 3], side, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], cells.map(|n| n as f64 * side), 1);
    mesh_of(&grid)
}

pub fn vertices_where(mesh: &Mesh, choose: impl Fn(Vec3) -> bool) -> Vec<u32> {
    let all = mesh.vertices.iter().enumerate();
    all.filter(|(_, x)| choose(**x))
        .map(|(v, _)| v as u32)
        .collect()
}

pub fn rubber() -> HyperelasticMaterial {
    HyperelasticMaterial::neo_hookean(60e3, 0.49, 1070.0).unwrap()
}

/// Beam along x whose first two layers of voxels are held, under its own weight.
pub fn cantilever(cells: [usize; 3], side: f64, material: impl Into<Material>) -> Problem {
    let mesh = block(cells, side);
    let body = Body::new(&mesh, &[material.into()]).unwrap();
    let wall = vertices_where(&mesh, |x| x[0] < 2.0 * side + 1e-9);
    let gravity = Load::gravity([0.0, 0.0, -9.81]);
    Problem::new(body, vec![Clamp::fixed(wall)], vec![gravity], None).unwrap()
}

pub fn settled(problem: &Problem, settings: &Settings) -> Answer {
    solve(problem, None, settings, &mut |now| {
        if std::env::var_os("VERBOSE").is_some() {
            println!(
                "{} {:.4} {:.2e} {}",
                now.steps, now.time, now.residual, now.record
            );
        }
        ControlFlow::Continue(())
    })
}
