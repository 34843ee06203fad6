//! Speeds of the kernels of iterative solutions beside the memory's: run by `benchmarks/kernels.py`, which prints them.

use std::hint::black_box;
use std::time::Instant;

use super::multigrid::for_each_large;
use super::trials;

/// Runs of each kernel, of which the quickest counts: what the processor can do, whoever else is using it.
const RUNS: usize = 15;
/// Numbers of each array of the triad: 160 MB, more than any cache holds.
const TRIAD: usize = 20_000_000;

/// Least time of a task in s.
fn quickest(mut task: impl FnMut()) -> f64 {
    let time = |_| {
        let start = Instant::now();
        task();
        start.elapsed().as_secs_f64()
    };
    (0..RUNS).map(time).fold(f64::INFINITY, f64::min)
}

/// STREAM triad `a = b + s c`, in bytes per s (McCalpin 1995).
fn triad() -> f64 {
    let (b, c) = (vec![1.0; TRIAD], vec![2.0; TRIAD]);
    let mut a = vec![0.0; TRIAD];
    let length = TRIAD / 64;
    let seconds = quickest(|| {
        let mut parts: Vec<&mut [f64]> = a.chunks_mut(length).collect();
        for_each_large(&mut parts, |part, a| {
            let range = part * length..part * length + a.len();
            for ((a, b), c) in a.iter_mut().zip(&b[range.clone()]).zip(&c[range]) {
                *a = b + 3.0 * c;
            }
        });
        black_box(&mut a);
    });
    (3 * 8 * TRIAD) as f64 / seconds
}

/// Prints one figure: its name, seconds, and bytes per s.
fn tell(name: &str, bytes: usize, seconds: f64) {
    println!("{name}\t{seconds:e}\t{:e}", bytes as f64 / seconds);
}

#[test]
#[ignore = "a benchmark"]
fn speeds_of_kernels() {
    let across: usize = std::env::var("VOXSOFT_ACROSS").map_or(46, |text| text.parse().unwrap());
    let problem = trials::cube(across);
    let start = Instant::now();
    let mut system = trials::assembled(&problem, trials::multigrid());
    println!("new+first assembly {}", start.elapsed().as_secs_f64());
    let rest = problem.body().rest().to_vec();
    let mut unused = vec![0.0; system.size()];
    let t = quickest(|| {
        system.assemble(&problem, &rest, &|_| 1.0, None, None, &mut unused);
    });
    tell("assemble", 0, t);
    let t = quickest(|| {
        system.factor(true).unwrap();
    });
    tell("project", 0, t);
    let (matrix, backend) = system.parts();
    let blocks = matrix.blocks();
    tell("triad", 1, 1.0 / triad());
    let operator = backend.operator(matrix);
    let x = voxsoft_solid::conformance::numbers::random(matrix.rows(), 3);
    let mut y = x.clone();
    tell(
        "product",
        76 * blocks,
        quickest(|| operator.apply(&x, &mut y)),
    );
    let mut preconditioner = backend.preconditioner(matrix);
    tell(
        "cycle",
        80 * blocks,
        quickest(|| preconditioner.apply(&x, &mut y)),
    );
    let mut side: Vec<f64> = (problem.body().rest().len() * 3..)
        .step_by(1)
        .take(system.size())
        .map(|_| 0.0)
        .collect();
    for (vertex, held) in problem.held().iter().enumerate() {
        if !held[2] {
            side[3 * vertex + 2] = -1.0;
        }
    }
    drop((operator, preconditioner));
    let factor = system.factor(true).unwrap();
    let t = quickest(|| {
        let mut s = side.clone();
        system.solve(&factor, &mut s, 1e-8, &mut || false).unwrap();
    });
    tell("solve", 0, t);
}
