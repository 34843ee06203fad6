//! Contact in equilibrium, compared with closed forms and with equivalent models without contact.

mod common;

use std::ops::ControlFlow;

use common::touching::{NONE, add_box, join, moved, pairs_at, touching};
use common::{block, mesh_of, rubber, vertices_where};
use voxsoft_contact::surface::Surface;
use voxsoft_contact::surface_contact::PairReport;
use voxsoft_solid::balance::balance;
use voxsoft_solid::vector::{Vec3, norm};
use voxsoft_solid::{Body, Clamp, Mesh, Problem, Status};
use voxsoft_statics::{Answer, Settings, solve};
use voxsoft_voxel::Grid;

fn settle(problem: &Problem) -> Answer {
    let settings = Settings {
        tolerance: 1e-8,
        ..Settings::default()
    };
    let answer = solve(problem, None, &settings, &mut |now| {
        if std::env::var_os("VERBOSE").is_some() {
            println!(
                "{} {:.4} {:.2e} {}",
                now.steps, now.time, now.residual, now.record
            );
        }
        ControlFlow::Continue(())
    });
    assert_eq!(answer.status, Status::AtRest, "after {}", answer.iterations);
    answer
}

/// Reaction of supports on some vertices.
fn reaction(problem: &Problem, positions: &[Vec3], on: &[u32]) -> Vec3 {
    let balance = balance(problem, positions, f64::INFINITY);
    let mut sum = [0.0; 3];
    for vertex in on {
        for (sum, force) in sum.iter_mut().zip(balance.reactions[*vertex as usize]) {
            *sum += force;
        }
    }
    sum
}

/// Blocks of voxels of 4 and of 3 mm, held against bulging and compressed by a tenth: the stress is uniform.
#[test]
fn uniform_pressure_between_voxels_of_different_sizes() {
    let mut mesh = block([3, 3, 2], 4e-3);
    let upper = join(&mut mesh, block([4, 4, 2], 3e-3), [0.0, 0.0, 8e-3]);
    let press = -1.4e-3;
    let hold = |mesh: &Mesh| {
        let top = vertices_where(mesh, |x| x[2] > 14e-3 - 1e-9);
        let mut clamps = vec![
            Clamp::fixed(vertices_where(mesh, |x| x[2] < 1e-9)),
            moved(top.clone(), [true; 3], [0.0, 0.0, press]),
        ];
        for axis in 0..2 {
            let at_side = |x: Vec3| x[axis] < 1e-9 || x[axis] > 12e-3 - 1e-9;
            clamps.push(Clamp {
                vertices: vertices_where(mesh, at_side),
                axes: std::array::from_fn(|i| i == axis),
                motion: None,
            });
        }
        (clamps, top)
    };
    let (clamps, top) = hold(&mesh);
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let (low, high): (Vec<_>, Vec<_>) = body.voxels().iter().partition(|v| v[0] < upper);
    let surfaces = vec![Surface::of_voxels(&low, 2), Surface::of_voxels(&high, 2)];
    let friction = vec![vec![NONE, 0.0], vec![0.0, NONE]];
    let problem = touching(&mesh, clamps, vec![], surfaces, friction, 3e-3);
    let answer = settle(&problem);
    for (rest, now) in mesh.vertices.iter().zip(&answer.positions) {
        let off = now[2] - rest[2] - press / 14e-3 * rest[2];
        assert!(off.abs() < 5e-3 * press.abs(), "{rest:?}: {off:e}");
    }
    let [pair] = pairs_at(&problem, &answer).try_into().unwrap();
    assert!((pair.area - 144e-6).abs() < 1e-12, "{pair:?}");
    // One block without contact in between, whose voxels may be of any size for a uniform state.
    let one = block([6, 6, 7], 2e-3);
    let (clamps, one_top) = hold(&one);
    let body = Body::new(&one, &[rubber()]).unwrap();
    let whole = Problem::new(body, clamps, vec![], None).unwrap();
    let expected = reaction(&whole, &settle(&whole).positions, &one_top)[2];
    let mut problem = problem;
    problem.remember(&answer.memory);
    let found = reaction(&problem, &answer.positions, &top)[2];
    assert!((found / expected - 1.0).abs() < 5e-3, "{found} {expected}");
    assert!((pair.force[2] / expected - 1.0).abs() < 5e-3, "{pair:?}");
}

/// Initial gap between the plate and the block, m.
const GAP: f64 = 0.1e-3;

/// Block of 12 mm, some layers of 4 mm high, under a rigid plate that moves by `way`; returns its contact, and the
/// problem with its solution.
fn plate(layers: usize, way: Vec3, friction: f64) -> (PairReport, Problem, Answer) {
    let mut mesh = block([3, 3, layers], 4e-3);
    let low = 4e-3 * layers as f64 + GAP;
    let floor = vertices_where(&mesh, |x| x[2] < 1e-9);
    let count = mesh.vertices.len() as u32;
    let plate = add_box(&mut mesh, [-4e-3, -4e-3, low], [16e-3, 16e-3, low + 4e-3]);
    let clamps = vec![
        Clamp::fixed(floor),
        moved((count..count + 4).collect(), [true; 3], way),
    ];
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let surfaces = vec![Surface::of_voxels(body.voxels(), 2), plate];
    let table = vec![vec![0.0, friction], vec![friction, NONE]];
    let problem = touching(&mesh, clamps, vec![], surfaces, table, 4e-3);
    let answer = settle(&problem);
    let [pair] = pairs_at(&problem, &answer).try_into().unwrap();
    let mut problem = problem;
    problem.remember(&answer.memory);
    (pair, problem, answer)
}

#[test]
fn smooth_plate_equals_a_sliding_clamp() {
    let (pair, problem, answer) = plate(3, [0.0, 0.0, -GAP - 2e-3], 0.0);
    let mesh = block([3, 3, 3], 4e-3);
    let top = vertices_where(&mesh, |x| x[2] > 12e-3 - 1e-9);
    let clamps = vec![
        Clamp::fixed(vertices_where(&mesh, |x| x[2] < 1e-9)),
        moved(top.clone(), [false, false, true], [0.0, 0.0, -2e-3]),
    ];
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let clamped = Problem::new(body, clamps, vec![], None).unwrap();
    let expected = reaction(&clamped, &settle(&clamped).positions, &top)[2];
    // The clearance adds 8e-7 m to the 2 mm, 4e-4 of it, and the block gets stiffer as it is pressed.
    assert!(
        (pair.force[2] / expected - 1.0).abs() < 8e-4,
        "{pair:?} {expected}"
    );
    assert!(pair.gap > 0.0 && pair.gap < 1e-3 * 4e-3, "{pair:?}");
    // The contact force on the plate equals the reaction of its support.
    let count = answer.positions.len() as u32;
    let carried = reaction(
        &problem,
        &answer.positions,
        &[count - 4, count - 3, count - 2, count - 1],
    );
    assert!(
        (carried[2] - pair.force[2]).abs() < 1e-6 * expected.abs(),
        "{carried:?}"
    );
}

#[test]
fn friction_sticks_below_its_bound_and_slips_at_it() {
    let (press, drag) = (-GAP - 0.24e-3, 2e-3);
    let (slipping, ..) = plate(3, [drag, 0.0, press], 0.3);
    let across = slipping.force[0];
    // Friction bounds are accurate to 0.3 % of the largest.
    let ratio = across / slipping.force[2].abs();
    assert!((ratio / 0.3 - 1.0).abs() < 0.01, "{slipping:?}");
    assert!(slipping.slipping > 0.9, "{slipping:?}");
    // Far below the bound the surface follows the plate: with the same force as if it were held there.
    let (sticking, ..) = plate(3, [5e-5, 0.0, press], 5.0);
    assert!(sticking.slipping < 1e-3, "{sticking:?}");
    let (rough, ..) = plate(3, [5e-5, 0.0, press], 50.0);
    assert!(
        (sticking.force[0] / rough.force[0] - 1.0).abs() < 0.02,
        "{sticking:?} {rough:?}"
    );
    assert!(sticking.force[0] > 0.0);
}

/// Friction under a plate that presses straight on changes linearly along the path: steps of a quarter, a quarter and a
/// half say the same as twenty of a twentieth, which took some 150 iterations. Those before the plate touches, which find
/// that without contact, count too.
#[test]
fn friction_that_grows_with_the_load_takes_few_steps() {
    let (pair, _, answer) = plate(3, [0.0, 0.0, -GAP - 1e-3], 0.5);
    assert!(pair.slipping > 0.0 && pair.slipping < 1.0, "{pair:?}");
    assert!(answer.path.len() <= 5, "{:?}", answer.path);
    assert!(answer.iterations <= 75, "{}", answer.iterations);
}

/// Slit of one voxel between two lips that is pressed shut.
#[test]
fn lips_of_a_slit_meet() {
    let side = 2e-3;
    let mut grid = Grid::empty([10, 2, 5], [0.0; 3], side, u64::MAX).unwrap();
    let n = |i: usize| i as f64 * side;
    for (low, high) in [
        ([0, 0, 0], [10, 2, 2]),
        ([0, 0, 3], [8, 2, 5]),
        ([0, 0, 2], [2, 2, 3]),
    ] {
        grid.fill_box(low.map(n), high.map(n), 1);
    }
    let mesh = mesh_of(&grid);
    let end = |z: f64| {
        vertices_where(&mesh, |x| {
            (x[0] - n(8)).abs() < 1e-9 && (x[2] - z).abs() < 1e-9
        })
    };
    let clamps = || {
        vec![
            Clamp::fixed(vertices_where(&mesh, |x| x[2] < 1e-9)),
            moved(end(n(5)), [false, false, true], [0.0, 0.0, -1.2 * side]),
        ]
    };
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let surfaces = vec![Surface::of_voxels(body.voxels(), 2)];
    let problem = touching(&mesh, clamps(), vec![], surfaces, vec![vec![0.0]], side);
    let answer = settle(&problem);
    let [pair] = pairs_at(&problem, &answer).try_into().unwrap();
    assert!(pair.gap > 0.0 && pair.gap < 1e-3 * side, "{pair:?}");
    assert!(pair.pressed > 0.0 && norm(pair.force) == 0.0, "{pair:?}");
    // Without contact the lips pass through each other with less force.
    let through = Problem::new(body, clamps(), vec![], None).unwrap();
    let passed = settle(&through);
    let force =
        |problem: &Problem, answer: &Answer| -reaction(problem, &answer.positions, &end(n(5)))[2];
    assert!(force(&problem, &answer) > 1.5 * force(&through, &passed));
}
