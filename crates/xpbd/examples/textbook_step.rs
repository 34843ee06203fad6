//! Error of the textbook step in the state at rest: the plain loop of Algorithm 3, whose multipliers start from zero,
//! on the paper's beam, against the solver of this crate.
//!
//! `cargo run --release -p voxsoft-xpbd --example textbook_step`

#[expect(dead_code, reason = "this example takes the order of the body")]
mod textbook;

use std::ops::ControlFlow;
use std::time::Instant;

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Body, Clamp, LatticeMaterial, Load, Mesh, Problem, State};
use voxsoft_voxel::{Grid, tet_mesh};
use voxsoft_xpbd::{Relaxation, relax};

use textbook::Textbook;

const DAMPING_RATE: f64 = 20.0;
const END_TIME: f64 = 1.5;

fn beam() -> Result<Problem, Box<dyn std::error::Error>> {
    let mut grid = Grid::empty([18, 2, 2], [0.0; 3], 5e-3, u64::MAX)?;
    grid.fill_box([0.0; 3], [0.09, 0.01, 0.01], 1);
    let tets = tet_mesh(&grid, u64::MAX)?;
    let count = tets.tets.len();
    let mesh = Mesh {
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        tet_part: vec![0; count],
        tet_block: (0..count as u32).map(|t| t / 5).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    };
    let held = (0..mesh.vertices.len() as u32).filter(|&v| mesh.vertices[v as usize][0] < 1e-9);
    let clamp = Clamp::fixed(held.collect());
    let material = LatticeMaterial::from_moduli(27e3, 100e3, 1070.0)?;
    let body = Body::new(&mesh, &[material])?;
    let gravity = Load::gravity([0.0, 0.0, -9.81]);
    Ok(Problem::new(body, vec![clamp], vec![gravity], None)?)
}

fn tip(body: &Body, state: &State) -> Vec3 {
    let tips: Vec<usize> = (0..body.rest().len())
        .filter(|&v| body.rest()[v][0] > 0.0899)
        .collect();
    std::array::from_fn(|axis| {
        let moved = |&v: &usize| state.positions[v][axis] - body.rest()[v][axis];
        1e3 * tips.iter().map(moved).sum::<f64>() / tips.len() as f64
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let problem = beam()?;
    let body = problem.body();
    let rest = State::at_rest(body);
    let settings = Relaxation {
        tolerance: 1e-7,
        ..Relaxation::default()
    };
    let answer = relax(&problem, rest.clone(), &settings, &mut |_| {
        ControlFlow::Continue(())
    });
    let [x, y, z] = tip(body, &answer.state);
    println!("energies at rest            tip {x:8.3} {y:8.3} {z:8.3} mm");
    for h in [1e-4, 2e-4, 4e-4, 8e-4] {
        let order = (0..body.edges().len() + body.tets().len()).collect();
        let mut run = Textbook::in_order(&problem, [0.0, 0.0, -9.81], order);
        run.sort();
        let substeps = (END_TIME / h) as usize;
        let clock = Instant::now();
        for _ in 0..substeps {
            run.substep(h, DAMPING_RATE);
        }
        let constraints = body.edges().len() + body.tets().len();
        let cost = clock.elapsed().as_secs_f64() * 1e9 / (substeps * constraints) as f64;
        let [x, y, z] = tip(body, &run.state);
        let step = h * 1e3;
        println!(
            "textbook, substep {step:.1} ms    tip {x:8.3} {y:8.3} {z:8.3} mm, {cost:.1} ns a constraint"
        );
    }
    Ok(())
}
