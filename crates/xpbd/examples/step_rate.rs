//! Nanoseconds for a voxel and substep: the solvers of this crate against the textbook loop.
//!
//! `cargo run --release -p voxsoft-xpbd --example step_rate` prints one line for each figure:
//! `body; program; threads; ns; ratio to the textbook`. `benchmarks/step_rate.py` reads them.
//!
//! Every answer is checked before it counts: the sweep against the textbook loop in the same order,
//! relaxation and dynamics by the residual that the plain loops find in their states at rest.

mod textbook;

use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

use textbook::Textbook;
use voxsoft_solid::balance::balance;
use voxsoft_solid::lattice::strips::{Columns, Strips, Sweep};
use voxsoft_solid::vector::{Vec3, norm, sub};
use voxsoft_solid::{Body, Clamp, LatticeMaterial, Load, Mesh, Problem, State};
use voxsoft_voxel::{Grid, tet_mesh};
use voxsoft_xpbd::{Damping, Dynamics, Relaxation, Status, relax, simulate};

const GRAVITY: Vec3 = [0.0, 0.0, -9.81];
const SIDE: f64 = 5e-3;
/// Substep that is stable for the materials below, in s.
const SUBSTEP: f64 = 1e-4;
/// Number of alternating rounds of the programs; medians are printed.
const ROUNDS: usize = 15;
/// Voxels and substeps in a round of one program.
const WORK: f64 = 2e5;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Problem of the voxels in `inside`, clamped at the lowest x, or at the lowest z for the cylinder.
fn body(
    cells: [usize; 3],
    axis: usize,
    inside: impl Fn([usize; 3]) -> bool,
) -> Result<(Problem, usize)> {
    let mut grid = Grid::empty(cells, [0.0; 3], SIDE, u64::MAX)?;
    for index in 0..cells.iter().product() {
        let cell = [
            index / (cells[1] * cells[2]),
            index / cells[2] % cells[1],
            index % cells[2],
        ];
        if inside(cell) {
            grid.set(cell, 1);
        }
    }
    let tets = tet_mesh(&grid, u64::MAX)?;
    let voxels = tets.voxel_cells.len();
    let mesh = Mesh {
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        tet_part: tets.tet_part.iter().map(|part| part - 1).collect(),
        tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    };
    let held = (0..mesh.vertices.len() as u32).filter(|&v| mesh.vertices[v as usize][axis] < 1e-9);
    let clamp = Clamp::fixed(held.collect());
    let material = LatticeMaterial::from_moduli(60e3, 250e3, 1070.0)?;
    let body = Body::new(&mesh, &[material])?;
    let problem = Problem::new(body, vec![clamp], vec![Load::gravity(GRAVITY)], None)?;
    Ok((problem, voxels))
}

/// Cylinder of the paper with a radius of five voxels, seven high, with walls of one.
fn in_cylinder([i, j, k]: [usize; 3]) -> bool {
    let square: f64 = [i, j].iter().map(|&n| (n as f64 - 4.5).powi(2)).sum();
    square < 25.0 && !(square < 16.0 && (1..6).contains(&k))
}

/// Arrays of a sweep.
struct Sweeping<'a> {
    strips: &'a Strips,
    rest: Columns,
    positions: Columns,
    inverse_masses: Columns,
    multipliers: Vec<f64>,
}

impl<'a> Sweeping<'a> {
    fn new(problem: &Problem, strips: &'a Strips) -> Self {
        let mut rest = Columns::zeros(strips.slots());
        let mut inverse_masses = rest.clone();
        strips.load(problem.body().rest(), &mut rest);
        let weight =
            |(mass, held): (&f64, &[bool; 3])| held.map(|h| if h { 0.0 } else { 1.0 / mass });
        let masses = problem.body().masses().iter().zip(problem.held());
        strips.load(&masses.map(weight).collect::<Vec<_>>(), &mut inverse_masses);
        Self {
            strips,
            positions: rest.clone(),
            rest,
            inverse_masses,
            multipliers: vec![0.0; strips.places()],
        }
    }

    /// Takes a sweep from the present positions, with all multipliers zero.
    fn sweep(&mut self) {
        self.strips.sweep(Sweep {
            positions: &mut self.positions,
            start: &self.rest,
            inverse_masses: &self.inverse_masses,
            isotropic: true,
            multipliers: &mut self.multipliers,
            keep: false,
            substep: SUBSTEP,
            retardation: 0.0,
        });
    }
}

fn go_on(_: &voxsoft_solid::Progress<'_>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn check(problem: &Problem, strips: &Strips) -> Result<()> {
    let mut oracle = Textbook::in_order(problem, GRAVITY, strips.order().collect());
    oracle.substep(SUBSTEP, 0.0);
    let mut fast = Sweeping::new(problem, strips);
    let fall = |(v, p): (usize, &Vec3)| -> Vec3 {
        let held = problem.held()[v][0];
        let drop = if held { 0.0 } else { SUBSTEP * SUBSTEP };
        std::array::from_fn(|axis| p[axis] + drop * GRAVITY[axis])
    };
    let fallen: Vec<Vec3> = problem.body().rest().iter().enumerate().map(fall).collect();
    fast.strips.load(&fallen, &mut fast.positions);
    fast.sweep();
    let mut rows = fallen.clone();
    strips.store(&fast.positions, &mut rows);
    // A fall of 1e-7 m in coordinates of 0.3 m, which are rounded to 5e-17 m.
    for (row, expected) in rows.iter().zip(&oracle.state.positions) {
        if norm(sub(*row, *expected)) > 1e-15 {
            return Err("the sweep is not the textbook's".into());
        }
    }
    if problem.body().rest().len() < 2000 {
        let start = State::at_rest(problem.body());
        let settings = Relaxation::default();
        let rests = [
            relax(problem, start.clone(), &settings, &mut go_on),
            simulate(problem, start, &Dynamics::default(), &mut go_on),
        ];
        for answer in rests {
            let residual = balance(problem, &answer.state.positions, f64::INFINITY);
            if answer.status != Status::AtRest || residual.relative_residual() > 1.01e-4 {
                return Err(format!("no rest: {:?}", answer.status).into());
            }
        }
    }
    Ok(())
}

/// Seconds that `steps` more steps of relaxation take: the difference of two runs of different length, which excludes
/// the setup before the first step.
fn relaxation(problem: &Problem, steps: u64) -> f64 {
    let run = |max_steps| {
        let settings = Relaxation {
            tolerance: 0.0,
            max_steps,
            ..Relaxation::default()
        };
        let clock = Instant::now();
        relax(
            problem,
            State::at_rest(problem.body()),
            &settings,
            &mut go_on,
        );
        clock.elapsed().as_secs_f64()
    };
    let short = run(25);
    run(25 + steps) - short
}

/// Seconds that `substeps` more substeps of dynamics take.
fn dynamics(problem: &Problem, substeps: u64) -> f64 {
    let run = |steps: f64| {
        let settings = Dynamics {
            time_step: 100.0 * SUBSTEP,
            substeps: Some(100),
            damping: Damping::Rate(20.0),
            end_time: Some(steps * 100.0 * SUBSTEP),
            ..Dynamics::default()
        };
        let clock = Instant::now();
        simulate(
            problem,
            State::at_rest(problem.body()),
            &settings,
            &mut go_on,
        );
        clock.elapsed().as_secs_f64()
    };
    let short = run(1.0);
    run(1.0 + (substeps / 100) as f64) - short
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn measure(name: &str, problem: &Problem, voxels: usize, threads: usize) -> Result<()> {
    let strips = Strips::of(problem.body()).ok_or("voxels lie on a lattice")?;
    check(problem, &strips)?;
    let steps = ((WORK / voxels as f64 / 100.0).ceil() as u64).max(1) * 100;
    let steps = if voxels > 100_000 { 100 } else { steps };
    let few = if voxels > 100_000 { 2 } else { steps };
    let rounds = if voxels > 100_000 { 3 } else { ROUNDS };
    let mut reference = Textbook::new(problem, GRAVITY);
    reference.sort();
    let all = (0..problem.body().edges().len() + problem.body().tets().len()).collect();
    let mut colored = Textbook::in_order(problem, GRAVITY, all);
    colored.sort();
    let mut sweeping = Sweeping::new(problem, &strips);
    let mut forces = Columns::zeros(strips.slots());
    let repeat = |task: &mut dyn FnMut()| {
        let clock = Instant::now();
        (0..few).for_each(|_| task());
        clock.elapsed().as_secs_f64() / few as f64
    };
    let names = [
        "textbook loop, order of the mesh",
        "textbook loop, colored order",
        "one sweep on strips",
        "elastic forces on strips",
        "substep of dynamics",
        "step of relaxation",
    ];
    let mut seconds = vec![Vec::new(); names.len()];
    for _ in 0..rounds {
        seconds[0].push(repeat(&mut || reference.substep(SUBSTEP, 20.0)));
        seconds[1].push(repeat(&mut || colored.substep(SUBSTEP, 20.0)));
        seconds[2].push(repeat(&mut || sweeping.sweep()));
        seconds[3].push(repeat(&mut || {
            strips.add_forces(&sweeping.rest, &mut forces)
        }));
        seconds[4].push(dynamics(problem, steps) / steps as f64);
        seconds[5].push(relaxation(problem, steps) / steps as f64);
    }
    let medians: Vec<f64> = seconds.into_iter().map(median).collect();
    for (what, seconds) in names.iter().zip(&medians) {
        let each = seconds * 1e9 / voxels as f64;
        println!(
            "{name}; {what}; {threads}; {each:.2}; {:.3}",
            medians[0] / seconds
        );
    }
    Ok(())
}

fn main() -> Result<()> {
    let everywhere = |_: [usize; 3]| true;
    let bodies = [
        ("beam", body([20, 2, 2], 0, everywhere)?),
        ("cylinder (5,7,1)", body([10, 10, 7], 2, in_cylinder)?),
        ("block 20^3", body([20; 3], 2, everywhere)?),
        ("block 64^3", body([64; 3], 2, everywhere)?),
    ];
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()?;
        for (name, (problem, voxels)) in &bodies {
            pool.install(|| measure(name, problem, *voxels, threads).map_err(|e| e.to_string()))?;
        }
    }
    Ok(())
}
