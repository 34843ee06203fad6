//! Times the classification of 256³ cells: `cargo run --release -p voxsoft-shape --example gyroid_speed`.
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use voxsoft_shape::periodic::Surface;
use voxsoft_shape::{SampleGrid, Shape, operators, primitives, sample};

fn main() {
    let gyroid = Surface::Gyroid
        .sheet(&0.02.into(), &0.003.into(), 0.0)
        .expect("valid numbers");
    let ball = primitives::sphere([0.0; 3], 0.04).expect("valid numbers");
    let cube = primitives::cuboid([0.0; 3], [0.08; 3]).expect("valid numbers");
    let pot = operators::difference(&[cube, ball]).expect("valid numbers");
    let spheres = operators::array(
        &primitives::sphere([-0.045; 3], 0.004).unwrap(),
        [10; 3],
        [0.01; 3],
    )
    .unwrap();
    report("gyroid", &gyroid);
    report("box minus ball", &pot);
    report("1000 balls", &spheres);
}

fn report(name: &str, shape: &Shape) {
    let grid = SampleGrid {
        origin: [-0.05; 3],
        voxel_size: 0.1 / 256.0,
        shape: [256; 3],
    };
    let start = Instant::now();
    let cells =
        sample(shape, &grid, 1e-12, u64::MAX, &AtomicBool::new(false)).expect("a valid grid");
    let seconds = start.elapsed().as_secs_f64();
    let inside: usize = cells.iter().map(|&cell| usize::from(cell)).sum();
    let rate = cells.len() as f64 / seconds / 1e6;
    println!(
        "{name}: {inside} of {} cells inside, {seconds:.3} s, {rate:.0} million cells/s",
        cells.len()
    );
}
