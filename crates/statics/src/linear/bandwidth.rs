//! Speeds of the kernels of iterative solutions beside the memory's: run by `benchmarks/kernels.py`, which prints them.

use std::hint::black_box;
use std::time::Instant;

use voxsoft_solid::conformance::numbers::random;

use super::multigrid::{BLOCK, BlockMatrix, for_each_chunk, for_each_large};
use super::trials;

/// Runs of each kernel, of which the quickest counts: other programs on the machine slow down the rest.
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

/// Prints one figure, in columns: its name, seconds, and bytes per s.
fn tell(name: &str, bytes: usize, seconds: f64) {
    println!("{name}\t{seconds:e}\t{:e}", bytes as f64 / seconds);
}

/// Bytes of a product with the whole matrix: both halves of each number, and the columns.
fn product_bytes(matrix: &BlockMatrix) -> usize {
    (2 * size_of::<[f32; BLOCK]>() + size_of::<u32>()) * matrix.blocks()
}

/// Bytes of a forward and a backward sweep and the residual between them: each off-diagonal block is read twice.
fn sweep_bytes(matrix: &BlockMatrix) -> usize {
    2 * (size_of::<[f32; BLOCK]>() + size_of::<u32>()) * (matrix.blocks() - matrix.rows())
}

#[test]
#[ignore = "a benchmark"]
fn speeds_of_kernels() {
    let across = std::env::var("VOXSOFT_ACROSS").map_or(46, |text| text.parse().unwrap());
    let problem = trials::cube(across);
    let mut system = trials::assembled(&problem, trials::multigrid());
    let rest = problem.body().rest();
    let mut unused = vec![0.0; system.size()];
    let seconds = quickest(|| {
        system.assemble(&problem, rest, &|_| 1.0, None, None, &mut unused);
    });
    let bytes = product_bytes(system.parts().0);
    tell("assembly", bytes, seconds);
    let seconds = quickest(|| {
        system.factor(true).unwrap();
    });
    tell("coarser matrices", bytes, seconds);
    let (matrix, backend) = system.parts();
    let (operator, mut preconditioner) = (backend.operator(matrix), backend.preconditioner(matrix));
    let x = random(matrix.rows(), 3);
    let mut y = x.clone();
    tell("product", bytes, quickest(|| operator.apply(&x, &mut y)));
    let bytes = sweep_bytes(matrix);
    let single = vec![[1.0f32; 4]; matrix.rows()];
    let mut sums = single.clone();
    let seconds = quickest(|| {
        for half in [matrix.before(&single), matrix.after(&single, 0)] {
            for_each_chunk(&mut sums, |first, sums| half.set(first, sums));
        }
    });
    tell("halves of all rows", bytes / 2, seconds);
    tell(
        "V-cycle",
        bytes,
        quickest(|| preconditioner.apply(&x, &mut y)),
    );
    let bytes = 3 * 8 * TRIAD;
    tell("triad", bytes, bytes as f64 / triad());
}
