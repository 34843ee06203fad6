//! Designs of the paper's study that enclose a chamber, by the textbook loop on one core: the reference of
//! `benchmarks/study.py`.
//!
//! `cargo run --release -p voxsoft-xpbd --example textbook_study` prints a line for each aim and design: aim, radius,
//! height and wall in voxels, substeps, rise in m, residual. Then it answers each line of its input with the seconds
//! that all designs take for each aim, of wall-clock and of processor time. With the argument `scan` it prints the cost
//! of other rates of damping: of 40 to 1,280 1/s, 480 projects the fewest constraints, 35 million with 0.1 ms, and the
//! best rate for each design on its own 29 million.
//!
//! # Criterion of rest
//!
//! With one sweep and multipliers from zero the loop rests in a state of smaller apparent stiffness, by a part that
//! grows like the square of the substep (`textbook_step`): where walls are one voxel thick, rises are 0.04 to 0.08 %
//! too large with substeps of 25 µs, 0.6 to 1.3 % with 0.1 ms, 8 to 22 % with 0.4 ms, and the forces never balance to
//! the 1e-5 of the load that is required of the solver of this crate. So there are two aims: the rise within 0.1 % of
//! the equilibrium, and, with a longer substep, within 0.1 % of the final rise of that substep. A run ends as soon as
//! its rise stays there for 0.1 s. The number of substeps is found beforehand, so that the timed run includes neither
//! checks of forces nor those 0.1 s.

mod textbook;

use std::error::Error;
use std::io::{BufRead, Write, stdin, stdout};
use std::ops::ControlFlow;
use std::time::Instant;

use textbook::Textbook;
use voxsoft_solid::balance::balance;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Body, Clamp, LatticeMaterial, Load, Mesh, Pressure, Problem, State};
use voxsoft_voxel::{Grid, tet_mesh};
use voxsoft_xpbd::{Relaxation, Status, relax};

/// Edge of a voxel, in m.
const SIDE: f64 = 5e-3;
/// Pressure in Pa.
const PRESSURE: f64 = 4e3;
/// Edge and bulk modulus in Pa and density in kg/m³ of the card `ecoflex-00-30-lattice`.
const MATERIAL: [f64; 3] = [23.6e3, 2e3, 1070.0];
/// Largest error of a rise.
const WITHIN: f64 = 1e-3;
/// Tolerance of the reference equilibrium, relative to the load.
const TIGHT: f64 = 1e-8;
/// Time for which a rise must stay within the error, and the longest run, in s.
const HOLD: f64 = 0.1;
const LONGEST: f64 = 0.5;

/// End criterion of a run, with its substep (s) and rate of damping (1/s), the fastest of the `scan` for all designs.
struct Aim {
    name: &'static str,
    is_own: bool,
    substep: f64,
    rate: f64,
}

const AIMS: [Aim; 2] = [
    Aim {
        name: "equilibrium",
        is_own: false,
        substep: 2.5e-5,
        rate: 480.0,
    },
    Aim {
        name: "own",
        is_own: true,
        substep: 1e-4,
        rate: 480.0,
    },
];
const SCANNED_RATES: [f64; 7] = [40.0, 160.0, 320.0, 480.0, 640.0, 960.0, 1280.0];

type Result<T> = std::result::Result<T, Box<dyn Error>>;

struct Design {
    /// Radius, height and wall in voxels; caps are one voxel thick.
    size: [usize; 3],
    problem: Problem,
    pressed: Vec<[u32; 3]>,
    top: Vec<usize>,
    /// Rise at equilibrium, in m.
    rise: f64,
}

impl Design {
    /// Makes a design: meshed, loaded and solved for its equilibrium.
    fn new(size: [usize; 3]) -> Result<Self> {
        let [radius, height, wall] = size;
        let mut grid = Grid::empty([2 * radius, 2 * radius, height], [0.0; 3], SIDE, u64::MAX)?;
        let off = |n: usize| n as f64 + 0.5 - radius as f64;
        for (i, j) in (0..4 * radius * radius).map(|n| (n / (2 * radius), n % (2 * radius))) {
            let distance = off(i).hypot(off(j));
            for k in 0..height {
                let is_hollow = distance < (radius - wall) as f64 && k > 0 && k + 1 < height;
                if distance < radius as f64 && !is_hollow {
                    grid.set([i, j, k], 1);
                }
            }
        }
        let tets = tet_mesh(&grid, u64::MAX)?;
        let chamber = tets.cavities.first().ok_or("no chamber")?.triangles.iter();
        let pressed: Vec<_> = chamber.map(|t| t.map(|v| v as u32)).collect();
        let mesh = Mesh {
            tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
            tet_part: vec![0; tets.tets.len()],
            tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
            vertices: tets.vertices,
            ..Mesh::default()
        };
        let at = |z: f64| -> Vec<usize> {
            let is_there = |&v: &usize| (mesh.vertices[v][2] - z).abs() < 1e-9;
            (0..mesh.vertices.len()).filter(is_there).collect()
        };
        let top = at(height as f64 * SIDE);
        let held = at(0.0).into_iter().map(|v| v as u32).collect();
        let [edge, bulk, density] = MATERIAL;
        let body = Body::new(&mesh, &[LatticeMaterial::from_moduli(edge, bulk, density)?])?;
        let load = Load::constant(Pressure {
            triangles: pressed.clone(),
            voids: Vec::new(),
            pressure: PRESSURE,
            closed: false,
        });
        let problem = Problem::new(body, vec![Clamp::fixed(held)], vec![load], None)?;
        let mut design = Self {
            size,
            problem,
            pressed,
            top,
            rise: 0.0,
        };
        let settings = Relaxation {
            tolerance: TIGHT,
            ..Relaxation::default()
        };
        let start = State::at_rest(design.problem.body());
        let answer = relax(&design.problem, start, &settings, &mut |_| {
            ControlFlow::Continue(())
        });
        if answer.status != Status::AtRest {
            return Err(format!("{size:?}: no equilibrium: {:?}", answer.status).into());
        }
        design.rise = design.rise_at(&answer.state.positions);
        Ok(design)
    }

    fn rise_at(&self, positions: &[Vec3]) -> f64 {
        let rest = self.problem.body().rest();
        let moved = |&v: &usize| positions[v][2] - rest[v][2];
        self.top.iter().map(moved).sum::<f64>() / self.top.len() as f64
    }

    fn is_near(&self, run: &Textbook, rise: f64) -> bool {
        (self.rise_at(&run.state.positions) / rise - 1.0).abs() < WITHIN
    }

    /// Target rise of a run in m.
    fn aim(&self, aim: &Aim) -> f64 {
        if !aim.is_own {
            return self.rise;
        }
        let mut run = self.start();
        (0..(LONGEST / aim.substep) as usize).for_each(|_| run.substep(aim.substep, aim.rate));
        self.rise_at(&run.state.positions)
    }

    fn start(&self) -> Textbook {
        let mut run = Textbook::new(&self.problem, [0.0; 3]);
        run.sort();
        run.pressed.clone_from(&self.pressed);
        run.pressure = PRESSURE;
        run
    }

    /// Substeps until the rise is within the error and stays, or `None` if it never does.
    fn substeps(&self, aim: &Aim, rise: f64) -> Option<usize> {
        let h = aim.substep;
        let mut run = self.start();
        let mut since = None;
        for step in 1..=(LONGEST / h) as usize {
            run.substep(h, aim.rate);
            if !self.is_near(&run, rise) {
                since = None;
            } else if (step - *since.get_or_insert(step)) as f64 * h >= HOLD {
                return since;
            }
        }
        None
    }

    /// Number of projections: substeps times constraints.
    fn work(&self, substeps: usize) -> usize {
        let body = self.problem.body();
        substeps * (body.edges().len() + body.tets().len())
    }
}

fn designs() -> Result<Vec<Design>> {
    let mut found = Vec::new();
    for wall in 1..=3 {
        for radius in wall + 1..=5 {
            for height in 3..=7 {
                found.push(Design::new([radius, height, wall])?);
            }
        }
    }
    Ok(found)
}

/// Prints the projections of each rate of damping until all rises are reached, and those with the best rate for each
/// design. The time of a rise hardly depends on the substep.
fn scan(designs: &[Design], aim: &Aim) {
    let mut best = vec![usize::MAX; designs.len()];
    let rises: Vec<f64> = designs.iter().map(|design| design.aim(aim)).collect();
    for rate in SCANNED_RATES {
        let (mut sum, mut missed) = (0, 0);
        for ((design, rise), best) in designs.iter().zip(&rises).zip(&mut best) {
            if let Some(substeps) = design.substeps(&Aim { rate, ..*aim }, *rise) {
                let work = design.work(substeps);
                *best = work.min(*best);
                sum += work;
            } else {
                missed += 1;
            }
        }
        let millions = sum as f64 * 1e-6;
        println!("{rate} 1/s: {millions:.1} million constraints, {missed} designs do not end");
    }
    let each: usize = best.iter().filter(|work| **work < usize::MAX).sum();
    let millions = each as f64 * 1e-6;
    println!("the best rate for each design: {millions:.1} million constraints");
}

fn main() -> Result<()> {
    let designs = designs()?;
    if std::env::args().any(|argument| argument == "scan") {
        scan(&designs, &AIMS[1]);
        return Ok(());
    }
    let mut counts = [const { Vec::new() }; AIMS.len()];
    for (aim, counts) in AIMS.iter().zip(&mut counts) {
        for design in &designs {
            let [radius, height, wall] = design.size;
            let count = design
                .substeps(aim, design.aim(aim))
                .ok_or_else(|| format!("{:?}: the loop does not end", design.size))?;
            let positions = run(design, aim, count).state.positions;
            let residual = balance(&design.problem, &positions, f64::INFINITY).relative_residual();
            let rise = design.rise_at(&positions);
            let name = aim.name;
            println!("{name} {radius} {height} {wall} {count} {rise} {residual:e}");
            counts.push(count);
        }
    }
    stdout().flush()?;
    for line in stdin().lock().lines() {
        line?;
        for (aim, counts) in AIMS.iter().zip(&counts) {
            let (clock, busy) = (Instant::now(), processor_seconds());
            for (design, count) in designs.iter().zip(counts) {
                run(design, aim, *count);
            }
            let wall = clock.elapsed().as_secs_f64();
            let busy = processor_seconds().zip(busy).map_or(wall, |(b, a)| b - a);
            print!("{wall} {busy} ");
        }
        println!();
        stdout().flush()?;
    }
    Ok(())
}

/// Processor time of this thread in s, if the system reports it (Linux).
fn processor_seconds() -> Option<f64> {
    let counts = std::fs::read_to_string("/proc/self/schedstat").ok()?;
    let nanoseconds: f64 = counts.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

fn run(design: &Design, aim: &Aim, substeps: usize) -> Textbook {
    let mut run = design.start();
    (0..substeps).for_each(|_| run.substep(aim.substep, aim.rate));
    run
}
