//! Pruned, compiled classification against a float64 evaluation of every cell.
use std::sync::atomic::AtomicBool;

use proptest::prelude::*;
use voxsoft_shape::periodic::{Struts, Surface};
use voxsoft_shape::{
    Expr, INSIDE, OUTSIDE, SampleError, SampleGrid, Shape, TIED, operators, primitives, sample,
};

/// Bound on |s| for ties, m.
const TIE: f64 = 1e-12;

/// Classifies every cell on its own, in float64.
fn brute_force(shape: &Shape, grid: &SampleGrid) -> Vec<u8> {
    let [nx, ny, nz] = grid.shape;
    let mut points = Vec::new();
    for i in 0..nx {
        for j in 0..ny {
            for k in 0..nz {
                points.push([grid.center(0, i), grid.center(1, j), grid.center(2, k)]);
            }
        }
    }
    shape
        .evaluate(&points)
        .unwrap()
        .iter()
        .map(|&s| match s {
            s if s < -TIE => INSIDE,
            s if s > TIE => OUTSIDE,
            _ => TIED,
        })
        .collect()
}

fn classify(shape: &Shape, grid: &SampleGrid) -> Vec<u8> {
    sample(shape, grid, TIE, u64::MAX, &AtomicBool::new(false)).unwrap()
}

/// A grid of about `cells`³ that covers ±0.05 m, deliberately not a whole number of blocks.
fn grid(cells: usize) -> SampleGrid {
    let voxel_size = 0.1 / cells as f64;
    SampleGrid {
        origin: [-0.05; 3],
        voxel_size,
        shape: [cells, cells + 3, cells - 5],
    }
}

fn assert_exact(name: &str, shape: &Shape, sizes: [usize; 2]) {
    for cells in sizes {
        let grid = grid(cells);
        let (fast, slow) = (classify(shape, &grid), brute_force(shape, &grid));
        let wrong = fast.iter().zip(&slow).filter(|(a, b)| a != b).count();
        assert_eq!(wrong, 0, "{name}: {wrong} of {} cells differ", slow.len());
    }
}

fn atoms() -> Vec<(&'static str, Shape)> {
    let up = [0.0, 0.0, 1.0];
    let oblique = [1.0, 2.0, -0.5];
    let star = [[0.03, 0.0], [0.0, 0.01], [-0.03, 0.0], [0.0, 0.04]];
    let constant = Expr::constant;
    vec![
        (
            "box",
            primitives::cuboid([0.0; 3], [0.06, 0.05, 0.04]).unwrap(),
        ),
        (
            "rounded box",
            primitives::rounded_box([0.01; 3], [0.06, 0.05, 0.04], 0.01).unwrap(),
        ),
        ("sphere", primitives::sphere([0.0; 3], 0.04).unwrap()),
        (
            "ellipsoid",
            primitives::ellipsoid([0.0; 3], [0.04, 0.02, 0.01]).unwrap(),
        ),
        (
            "cylinder",
            primitives::cylinder([0.0; 3], oblique, 0.02, 0.03).unwrap(),
        ),
        (
            "tube",
            primitives::tube([0.0; 3], up, 0.02, 0.005, 0.03).unwrap(),
        ),
        (
            "cone",
            primitives::cone([0.0; 3], up, 0.02, 0.0, 0.03).unwrap(),
        ),
        (
            "capsule",
            primitives::capsule([0.0; 3], [0.03, 0.01, 0.0], 0.01).unwrap(),
        ),
        (
            "torus",
            primitives::torus([0.0; 3], oblique, 0.03, 0.01).unwrap(),
        ),
        (
            "half-space",
            primitives::half_space([0.0; 3], oblique).unwrap(),
        ),
        (
            "prism",
            primitives::prism([0.0; 3], up, &star, 0.03).unwrap(),
        ),
        (
            "revolve",
            primitives::revolve(
                [0.0; 3],
                oblique,
                &[[0.01, 0.0], [0.03, 0.01], [0.02, 0.02]],
            )
            .unwrap(),
        ),
        (
            "gyroid",
            Surface::Gyroid
                .sheet(&constant(0.02), &constant(0.003), 0.0)
                .unwrap(),
        ),
        (
            "schwarz-p",
            Surface::SchwarzP.solid(&constant(0.03), 0.5).unwrap(),
        ),
        (
            "schwarz-d",
            Surface::SchwarzD
                .sheet(&constant(0.03), &constant(0.002), 0.1)
                .unwrap(),
        ),
        (
            "neovius",
            Surface::Neovius
                .sheet(&constant(0.04), &constant(0.002), 0.0)
                .unwrap(),
        ),
        ("iwp", Surface::Iwp.solid(&constant(0.025), 0.0).unwrap()),
        (
            "cubic",
            Struts::Cubic
                .lattice(&constant(0.01), &constant(0.002))
                .unwrap(),
        ),
        (
            "bcc",
            Struts::Bcc
                .lattice(&constant(0.02), &constant(0.003))
                .unwrap(),
        ),
        (
            "fcc",
            Struts::Fcc
                .lattice(&constant(0.02), &constant(0.003))
                .unwrap(),
        ),
        (
            "octet",
            Struts::Octet
                .lattice(&constant(0.03), &constant(0.003))
                .unwrap(),
        ),
    ]
}

/// Applies the operator numbered `which` to `atom`, with parameters from `t` in [0, 1].
fn operate(which: usize, atom: &Shape, other: &Shape, t: f64) -> Shape {
    let both = [atom.clone(), other.clone()];
    let (up, origin) = ([0.0, 0.0, 1.0], [0.0; 3]);
    match which {
        0 => operators::union(&both),
        1 => operators::intersection(&both),
        2 => operators::difference(&both),
        3 => operators::smooth_union(&both, 0.001 + 0.02 * t),
        4 => operators::smooth_intersection(&both, 0.001 + 0.02 * t),
        5 => operators::smooth_difference(&both, 0.001 + 0.02 * t),
        6 => operators::offset(atom, 0.01 * (t - 0.5)),
        7 => operators::shell(atom, 0.001 + 0.005 * t),
        8 => operators::translate(atom, [0.01 * t, -0.02 * t, 0.03]),
        9 => operators::rotate(atom, [1.0, t, 0.3], 6.0 * t, [0.0, 0.01, 0.0]),
        10 => operators::scale(atom, [0.5 + t, 1.0, 1.5 - t], [0.01; 3]),
        11 => operators::mirror(atom, [0.01, 0.0, 0.0], [1.0, t, 0.0]),
        12 => operators::array(atom, [2, 1, 3], [0.02, 0.0, 0.02 + 0.02 * t]),
        13 => operators::polar_array(atom, 5, up, 3.0 * t, [0.03, 0.0, 0.0]),
        14 => operators::twist(atom, 100.0 * (t - 0.5), up, origin),
        15 => operators::bend(atom, 40.0 * (t - 0.5) + 1e-3, up, [1.0, 0.0, 0.0], origin),
        16 => operators::taper(atom, 0.3 + t, 0.03, up, origin),
        _ => Ok(operators::blend(
            atom,
            other,
            &(Expr::axes()[0].clone() * 10.0 + t),
        )),
    }
    .unwrap()
}

#[test]
fn every_primitive_matches_float64() {
    for (name, shape) in atoms() {
        // The larger grid has more than one tile of 64 cells.
        assert_exact(name, &shape, [20, 75]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn random_compositions_match_float64(
        picks in prop::array::uniform3(0..21_usize), which in prop::array::uniform2(0..18_usize),
        t in prop::array::uniform2(0.0..1.0f64),
    ) {
        let atoms = atoms();
        let inner = operate(which[0], &atoms[picks[0]].1, &atoms[picks[1]].1, t[0]);
        let shape = operate(which[1], &inner, &atoms[picks[2]].1, t[1]);
        let name = format!("operators {which:?} on {picks:?} with {t:?}");
        assert_exact(&name, &shape, [20, 40]);
    }
}

#[test]
fn center_on_surface_is_not_inside() {
    // Centers lie at x = ±0.5, ±1.5 ...: a shell of thickness 1 around the plane x = 0 touches two layers.
    let plane = primitives::half_space([0.0; 3], [1.0, 0.0, 0.0]).unwrap();
    // Grids of few cells, which are evaluated one by one, and of many.
    for cells in [4, 64] {
        let grid = SampleGrid {
            origin: [-0.5 * cells as f64; 3],
            voxel_size: 1.0,
            shape: [cells; 3],
        };
        let count = |thickness: f64| {
            let shell = operators::shell(&plane, thickness).unwrap();
            let cells = classify(&shell, &grid);
            cells.iter().filter(|&&cell| cell == 1).count()
        };
        assert_eq!(count(1.0), 0);
        assert_eq!(count(1.0 + 1e-6), 2 * cells * cells);
    }
}

#[cfg(feature = "threads")]
#[test]
fn result_is_independent_of_thread_count() {
    let gyroid = Surface::Gyroid
        .sheet(&0.02.into(), &0.003.into(), 0.0)
        .unwrap();
    let grid = grid(130);
    let with_threads = |count| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(count)
            .build()
            .unwrap();
        pool.install(|| classify(&gyroid, &grid))
    };
    assert_eq!(with_threads(1), with_threads(4));
}

#[test]
fn too_large_grid_is_refused_before_allocation() {
    let ball = primitives::sphere([0.0; 3], 1.0).unwrap();
    let grid = SampleGrid {
        origin: [0.0; 3],
        voxel_size: 1e-6,
        shape: [2_000_000; 3],
    };
    let refused = sample(&ball, &grid, TIE, 1 << 30, &AtomicBool::new(false));
    assert!(
        matches!(refused, Err(SampleError::TooLarge { bytes, .. }) if bytes == 16 * 10_u128.pow(18))
    );
}

#[test]
fn nan_is_reported_with_its_position() {
    let [x, ..] = Expr::axes();
    let shape = Shape::unknown(x.sqrt() - 0.01);
    // Grids of few cells, which are evaluated one by one, and of many.
    for (cells, undefined) in [(20, 10 * 23 * 15), (80, 40 * 83 * 75)] {
        let refused = sample(&shape, &grid(cells), TIE, u64::MAX, &AtomicBool::new(false));
        let Err(SampleError::NotANumber { count, at }) = refused else {
            panic!("{refused:?}")
        };
        assert_eq!(count, undefined);
        let first = -0.05 + 0.05 / cells as f64;
        assert!((at[0] - first).abs() < 1e-12, "{at:?}");
    }
}

#[test]
fn cancel_stops() {
    let ball = primitives::sphere([0.0; 3], 0.04).unwrap();
    let stopped = sample(&ball, &grid(75), TIE, u64::MAX, &AtomicBool::new(true));
    assert_eq!(stopped, Err(SampleError::Canceled));
}
