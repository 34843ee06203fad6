//! Limits on time and memory: the estimate before allocating, and linear stitching.
//!
//! The ignored tests take seconds and a gigabyte; run them alone and in release mode:
//! `cargo test --release -p voxsoft-voxel --test large_grids -- --ignored --nocapture --test-threads 1`.
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::Instant;

use voxsoft_voxel::{
    Contact, Grid, StitchError, cavities, components, hinges, leaks, mesh_bytes, tet_mesh,
    wall_thickness,
};

/// System allocator with a record of the peak memory.
struct Counting;

static NOW: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call goes to the system's allocator with the arguments it came with.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        PEAK.fetch_max(
            NOW.fetch_add(layout.size(), Relaxed) + layout.size(),
            Relaxed,
        );
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const GIB: usize = 1 << 30;

/// A gyroid sheet with a period of 32 cells.
fn gyroid(n: usize) -> Grid {
    let wave: Vec<(f64, f64)> = (0..n)
        .map(|i| (i as f64 * std::f64::consts::TAU / 32.0).sin_cos())
        .collect();
    let mut cells = Vec::with_capacity(n.pow(3));
    for (sx, cx) in &wave {
        for (sy, cy) in &wave {
            cells.extend(
                wave.iter()
                    .map(|(sz, cz)| u8::from((sx * cy + sy * cz + sz * cx).abs() < 0.3)),
            );
        }
    }
    Grid::from_cells([n; 3], [0.0; 3], 1e-3, cells).unwrap()
}

#[test]
fn mesh_over_the_limit_is_refused_before_allocation() {
    let grid = Grid::from_cells([64; 3], [0.0; 3], 1e-3, vec![1; 64 * 64 * 64]).unwrap();
    let refused = tet_mesh(&grid, 10_000_000);
    let Err(StitchError::TooLarge {
        voxels,
        bytes,
        limit,
    }) = refused
    else {
        panic!("expected TooLarge, got {refused:?}")
    };
    assert_eq!((voxels, limit), (64 * 64 * 64, 10_000_000));
    assert!(bytes > limit && bytes < mesh_bytes(voxels));
    let mesh = tet_mesh(&grid, bytes).unwrap();
    let kept = mesh.tets.len() * 17 + mesh.vertices.len() * 36 + mesh.edges.len() * 8;
    assert!((kept as u64) < bytes);
}

#[test]
#[ignore = "slow: 512³ cells"]
fn components_and_cavities_of_512_cubed_stay_under_a_gibibyte() {
    for (name, density) in [("gyroid", None), ("random", Some(0.5))] {
        let mut grid = Grid::empty([512; 3], [0.0; 3], 1e-3, u64::MAX).unwrap();
        match density {
            Some(density) => grid.fill_random(density, 1, 1),
            None => grid = gyroid(512),
        }
        PEAK.store(NOW.load(Relaxed), Relaxed);
        let start = Instant::now();
        let pieces = components(&grid, Contact::Corner).len();
        let components_seconds = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let found = cavities(&grid).len();
        let peak = PEAK.load(Relaxed);
        println!(
            "{name} 512³: {pieces} pieces in {components_seconds:.2} s, {found} cavities in {:.2} s, peak {} MiB",
            start.elapsed().as_secs_f64(),
            peak >> 20
        );
        assert!(pieces > 0 && peak < GIB, "{name}: {peak} bytes");
    }
}

#[test]
#[ignore = "slow: a timing"]
fn stitching_is_linear_in_the_number_of_voxels() {
    let nanoseconds: Vec<f64> = [64, 128, 256]
        .iter()
        .map(|&n| {
            let grid = gyroid(n);
            let voxels = grid.count();
            PEAK.store(NOW.load(Relaxed), Relaxed);
            let mut vertices = 0;
            let timed = || {
                let start = Instant::now();
                vertices = tet_mesh(&grid, u64::MAX).unwrap().vertices.len();
                start.elapsed().as_nanos() as f64 / voxels as f64
            };
            // The fastest of several runs is the least disturbed by other programs.
            let nanoseconds = std::iter::repeat_with(timed).take(5).fold(f64::INFINITY, f64::min);
            println!(
                "gyroid {n}³: {voxels} voxels, {vertices} vertices, {nanoseconds:.0} ns and {} bytes at the peak per voxel",
                PEAK.load(Relaxed) / voxels
            );
            nanoseconds
        })
        .collect();
    // 64 times the voxels may cost no more than twice the time each (caches, first touch).
    assert!(nanoseconds[2] < 2.0 * nanoseconds[0], "{nanoseconds:?}");
}

#[test]
#[ignore = "slow: 512³ cells"]
fn leaks_hinges_and_walls_of_512_cubed_stay_under_a_gibibyte() {
    let grid = gyroid(512);
    PEAK.store(NOW.load(Relaxed), Relaxed);
    let start = Instant::now();
    let found = leaks(&grid, 2).len();
    println!(
        "512³: {found} leaks, {:.2} s, {} MiB",
        start.elapsed().as_secs_f64(),
        PEAK.load(Relaxed) >> 20
    );
    let start = Instant::now();
    let joints = hinges(&grid).len();
    println!(
        "512³: {joints} hinges, {:.2} s",
        start.elapsed().as_secs_f64()
    );
    let start = Instant::now();
    let walls = wall_thickness(&grid);
    println!(
        "512³: thinnest {:?}, {:.2} s",
        walls.thinnest,
        start.elapsed().as_secs_f64()
    );
    assert_eq!(walls.histogram.iter().sum::<u64>() as usize, grid.count());
    let peak = PEAK.load(Relaxed);
    println!("512³: peak {} MiB", peak >> 20);
    assert!(peak < GIB, "{peak} bytes");
}
