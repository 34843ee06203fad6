//! Implicit steps of large bodies, solved iteratively: choice of the solver, agreement with the direct one, memory.

mod common;

use common::{block, cantilever, rubber, settled};
use voxsoft_solid::vector::{Vec3, norm, sub};
use voxsoft_solid::{Body, Damping, Floor, LiveStatus, Load, Problem, Stepper};
use voxsoft_statics::{Implicit, ImplicitSettings, LinearSolver, Settings};

/// Part of the motion of a step that its last move may have at most (`MOVE_OF_STEP` of the search).
const LAST_MOVE: f64 = 1e-2;

fn with(linear: LinearSolver) -> ImplicitSettings {
    ImplicitSettings {
        damping: Damping::Rate(0.0),
        tolerance: 1e-30,
        linear,
        ..ImplicitSettings::default()
    }
}

fn farthest(a: &[Vec3], b: &[Vec3]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| norm(sub(*a, *b))).fold(0.0, f64::max)
}

/// Positions after some steps, and a bound on the error that all searches have left there: the last move of each, which
/// goes on as an error of the velocity in every later step.
fn moved(problem: &Problem, settings: ImplicitSettings, steps: u32) -> (Vec<Vec3>, f64) {
    let mut run = Implicit::new(problem.clone(), settings);
    let mut left = 0.0;
    for later in (0..steps).rev() {
        let before = run.state().positions.clone();
        let look = run.advance(1);
        assert_eq!((look.status, look.back_offs), (LiveStatus::Moving, 0));
        left += LAST_MOVE * farthest(&run.state().positions, &before) * f64::from(1 + later);
    }
    (run.state().positions.clone(), left)
}

#[test]
fn large_bodies_are_solved_iteratively_and_agree_with_a_factor() {
    // More vertices than the threshold.
    let problem = cantilever([24, 13, 13], 0.002, rubber());
    let ways = [
        LinearSolver::Auto,
        LinearSolver::Iterative,
        LinearSolver::Direct,
    ];
    let [auto, iterative, direct] = ways.map(|way| moved(&problem, with(way), 8));
    assert_eq!(auto.0, iterative.0);
    assert_ne!(auto.0, direct.0);
    let allowed = iterative.1 + direct.1;
    let apart = farthest(&iterative.0, &direct.0);
    assert!(apart < allowed, "{apart:e} m of {allowed:e} m");
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let problem = cantilever([24, 13, 13], 0.002, rubber());
    let [one, two] = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let moved = || moved(&problem, with(LinearSolver::Iterative), 3);
        pool.build().unwrap().install(moved)
    });
    assert_eq!(one, two);
}

#[test]
fn small_bodies_keep_the_factor() {
    let problem = cantilever([8, 4, 4], 0.005, rubber());
    let [auto, direct] =
        [LinearSolver::Auto, LinearSolver::Direct].map(|way| moved(&problem, with(way), 3));
    assert_eq!(auto, direct);
}

#[test]
fn iterative_steps_come_to_rest_in_equilibrium() {
    let problem = cantilever([12, 4, 4], 0.005, rubber());
    let settings = ImplicitSettings {
        linear: LinearSolver::Iterative,
        ..ImplicitSettings::default()
    };
    let mut run = Implicit::new(problem.clone(), settings);
    assert_eq!(run.advance(600).status, LiveStatus::AtRest);
    let answer = settled(&problem, &Settings::default());
    let apart = farthest(&run.state().positions, &answer.positions);
    let sag = farthest(&answer.positions, problem.body().rest());
    // A residual of 1e-4 of the load is that much of the displacement of a linear body, some ten times as much bent.
    assert!(apart < 2e-3 * sag, "{apart:e} m of {sag:e} m");
}

#[test]
fn hands_and_the_floor_work_with_both_solvers() {
    // A block falls on the floor, where a hand pulls at a corner of its top: springs come and go.
    let side = 0.01;
    let mesh = block([4, 4, 4], side);
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let loads = vec![Load::gravity([0.0, 0.0, -9.81])];
    let floor = Some(Floor { z: -0.5 * side });
    let problem = Problem::new(body, Vec::new(), loads, floor).unwrap();
    let top = problem.body().rest().len() as u32 - 1;
    let [direct, iterative] = [LinearSolver::Direct, LinearSolver::Iterative].map(|linear| {
        let settings = ImplicitSettings {
            linear,
            ..ImplicitSettings::default()
        };
        let mut run = Implicit::new(problem.clone(), settings);
        run.advance(30);
        let corner = run.state().positions[top as usize];
        let anchor = [corner[0] + side, corner[1], corner[2] + side];
        run.grab(1, top, anchor, 20.0).unwrap();
        run.advance(20);
        assert_eq!(
            run.state()
                .positions
                .iter()
                .filter(|x| x[2] < -0.5 * side)
                .count(),
            0
        );
        let pulled = run.state().positions.clone();
        run.release(1);
        assert_eq!(run.advance(600).status, LiveStatus::AtRest);
        (pulled, run.state().positions.clone())
    });
    // Without friction the block may glide by the error of each step: shapes are compared by heights.
    let heights = |positions: &[Vec3]| {
        positions
            .iter()
            .map(|x| [0.0, 0.0, x[2]])
            .collect::<Vec<_>>()
    };
    let sag = farthest(&heights(&direct.1), &heights(problem.body().rest())) - 0.5 * side;
    let apart = farthest(&heights(&direct.1), &heights(&iterative.1));
    assert!(
        apart < 2e-3 * sag.abs().max(side * 1e-2),
        "{apart:e} m of {sag:e} m"
    );
    let lifted = farthest(&heights(&direct.0), &heights(&direct.1));
    let apart = farthest(&heights(&direct.0), &heights(&iterative.0));
    assert!(
        apart < 2.0 * LAST_MOVE * lifted,
        "{apart:e} m of {lifted:e} m"
    );
}

#[test]
fn steps_are_refused_where_their_tangent_exceeds_the_memory() {
    let problem = cantilever([8, 4, 4], 0.005, rubber());
    for linear in [LinearSolver::Direct, LinearSolver::Iterative] {
        let settings = ImplicitSettings {
            memory: 10_000,
            ..with(linear)
        };
        let mut run = Implicit::new(problem.clone(), settings);
        let LiveStatus::OutOfMemory(bytes) = run.advance(1).status else {
            panic!("{linear:?} was not refused");
        };
        // With 225 vertices the factor has about as many entries as the tangent, 27 blocks a vertex at most.
        assert!((100_000..2_000_000).contains(&bytes), "{linear:?}: {bytes}");
        assert_eq!(run.state().positions, problem.body().rest());
    }
}
