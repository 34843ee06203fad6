//! Implicit dynamics with contact: closed forms, and conservation of momentum and energy.

mod common;

use std::ops::ControlFlow;
use std::sync::Arc;

use common::touching::{NONE, YOUNG, add_box, add_rigid, corners_of, join, touching};
use common::{block, rubber, vertices_where};
use voxsoft_contact::surface::Surface;
use voxsoft_contact::surface_contact::rigid::Frame;
use voxsoft_solid::matrix::IDENTITY;
use voxsoft_solid::vector::{Vec3, add, cross, norm, scale, sub};
use voxsoft_solid::{
    Body, Clamp, Damping, History, Load, Mesh, Motion, Problem, Solution, Springs, State, Status,
    elastic,
};
use voxsoft_statics::{LinearSolver, Transient};

const GRAVITY: f64 = 9.81;

fn undamped(step: f64, end_time: f64) -> Transient {
    Transient {
        step,
        damping: Damping::Rate(0.0),
        end_time: Some(end_time),
        ..Transient::default()
    }
}

/// Runs to the end and calls `see` with every state on the way.
fn run(
    settings: &Transient,
    problem: &Problem,
    start: State,
    mut see: impl FnMut(f64, &[Vec3], &[Vec3]),
) -> Solution {
    let mut last = -1.0;
    let solution = settings.follow(problem, start, &mut |now| {
        if now.time > last && !now.velocities.is_empty() {
            last = now.time;
            see(now.time, now.positions, now.velocities);
        }
        ControlFlow::Continue(())
    });
    assert_eq!(solution.status, Status::EndTime, "{:?}", solution.breakdown);
    solution
}

fn mean(vectors: &[Vec3], masses: &[f64]) -> Vec3 {
    let total: f64 = masses.iter().sum();
    let pairs = vectors.iter().zip(masses);
    pairs.fold([0.0; 3], |sum, (v, m)| add(sum, scale(m / total, *v)))
}

/// Kinetic energy plus that of the body and its weight, in J.
fn energy(problem: &Problem, positions: &[Vec3], velocities: &[Vec3]) -> f64 {
    let state = State {
        positions: positions.to_vec(),
        velocities: velocities.to_vec(),
        time: 0.0,
    };
    let body = problem.body();
    let stored = elastic::energy(body, positions);
    let touching = problem
        .contact()
        .map_or(0.0, |contact| contact.energy(positions));
    let weight = problem.load_potential(positions, &|_| 1.0);
    state.kinetic_energy(body.masses()) + stored - touching + weight
}

/// Block of 12 mm on a rigid plate, with gravity tilted by `tangent` times its normal part.
fn on_a_slope(tangent: f64, friction: f64) -> Problem {
    let mut mesh = block([2, 2, 2], 6e-3);
    let count = mesh.vertices.len() as u32;
    let plate = add_box(&mut mesh, [-0.02, -0.02, -4e-3], [0.1, 0.04, 0.0]);
    let angle = f64::atan(tangent);
    let pull = [GRAVITY * angle.sin(), 0.0, -GRAVITY * angle.cos()];
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let surfaces = vec![Surface::of_voxels(body.voxels(), 2), plate];
    let table = vec![vec![NONE, friction], vec![friction, NONE]];
    let hold = Clamp::fixed((count..count + 4).collect());
    touching(
        &mesh,
        vec![hold],
        vec![Load::gravity(pull)],
        surfaces,
        table,
        6e-3,
    )
}

#[test]
fn block_slides_down_a_slope_by_coulomb() {
    let friction = 0.5;
    for tangent in [0.7, 1.0] {
        let problem = on_a_slope(tangent, friction);
        let masses = problem.body().masses();
        let mut velocities = vec![];
        run(
            &undamped(5e-3, 0.15),
            &problem,
            State::at_rest(problem.body()),
            |t, _, v| {
                velocities.push((t, mean(v, masses)[0]));
            },
        );
        let angle = f64::atan(tangent);
        let expected = GRAVITY * (angle.sin() - friction * angle.cos());
        let &(late, fast) = velocities.last().unwrap();
        let &(early, slow) = velocities.iter().find(|(t, _)| *t >= 0.05).unwrap();
        let found = (fast - slow) / (late - early);
        // The block still vibrates after a fall through its own sag of 10 µm at the start, with 15 mm/s, of which a few
        // percent are left after 50 ms.
        assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
    }
}

#[test]
fn block_sticks_on_a_slope() {
    let problem = on_a_slope(0.45, 0.5);
    let settings = Transient {
        damping: Damping::Critical,
        ..undamped(10e-3, 1.0)
    };
    let masses = problem.body().masses();
    let mut places = vec![];
    run(
        &settings,
        &problem,
        State::at_rest(problem.body()),
        |t, x, _| {
            places.push((t, mean(x, masses)[0]));
        },
    );
    let &(_, end) = places.last().unwrap();
    let &(_, before) = places.iter().find(|(t, _)| *t >= 0.5).unwrap();
    // Only the remaining vibration moves the block in half a second.
    assert!((end - before).abs() < 1e-10, "{:e}", end - before);
}

#[test]
fn bouncing_cube_gains_no_energy() {
    let mut mesh = block([2, 2, 2], 6e-3);
    let count = mesh.vertices.len() as u32;
    let height = 10e-3;
    let plate = add_box(
        &mut mesh,
        [-0.02, -0.02, -height - 4e-3],
        [0.04, 0.04, -height],
    );
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let surfaces = vec![Surface::of_voxels(body.voxels(), 2), plate];
    let table = vec![vec![NONE, 0.3], vec![0.3, NONE]];
    let hold = Clamp::fixed((count..count + 4).collect());
    let loads = vec![Load::gravity([0.0, 0.0, -GRAVITY])];
    let problem = touching(&mesh, vec![hold], loads, surfaces, table, 6e-3);
    let fall = problem.body().total_mass() * GRAVITY * height;
    for step in [1e-3, 5e-3] {
        let (mut lowest, mut grown) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut heights = vec![];
        let masses = problem.body().masses();
        run(
            &undamped(step, 0.2),
            &problem,
            State::at_rest(problem.body()),
            |_, x, v| {
                let now = energy(&problem, x, v);
                grown = f64::max(grown, now - lowest);
                lowest = f64::min(lowest, now);
                heights.push(mean(x, masses)[2]);
            },
        );
        // A step may gain a hundredth of the energy that it converts, which the check of every step allows.
        assert!(grown < 1e-2 * fall, "{step}: {:e}", grown / fall);
        let deepest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(
            deepest < 6e-3 - height + 0.3e-3,
            "it met the plate: {deepest}"
        );
    }
}

#[test]
fn colliding_blocks_keep_momentum() {
    let mut mesh = block([2, 2, 2], 6e-3);
    let second = join(&mut mesh, block([3, 3, 3], 4e-3), [14e-3, 1e-3, 2e-3]);
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let (one, other): (Vec<_>, Vec<_>) = body.voxels().iter().partition(|v| v[0] < second);
    let surfaces = vec![Surface::of_voxels(&one, 2), Surface::of_voxels(&other, 2)];
    let table = vec![vec![NONE, 0.4], vec![0.4, NONE]];
    let problem = touching(&mesh, vec![], vec![], surfaces, table, 4e-3);
    let mut start = State::at_rest(problem.body());
    for velocity in &mut start.velocities[..second as usize] {
        *velocity = [0.5, 0.0, 0.1];
    }
    let masses = problem.body().masses();
    let before = mean(&start.velocities, masses);
    let mut first = energy(&problem, &start.positions, &start.velocities);
    let solution = run(&undamped(1e-3, 0.02), &problem, start, |_, x, v| {
        let off = norm(sub(mean(v, masses), before));
        assert!(off < 1e-6 * norm(before), "{off:e}");
        let now = energy(&problem, x, v);
        assert!(now < first * (1.0 + 1e-2), "{now:e} {first:e}");
        first = f64::min(now, first);
    });
    let mean_of = |range: std::ops::Range<usize>| {
        mean(&solution.state.velocities[range.clone()], &masses[range])[0]
    };
    let last = masses.len();
    assert!(mean_of(second as usize..last) > mean_of(0..second as usize));
}

/// Rigid box without a body that could touch it, and its frame.
fn lonely_box(size: Vec3) -> (Problem, Frame, State) {
    let mut mesh = block([1, 1, 1], 4e-3);
    let count = mesh.vertices.len() as u32;
    let (low, high) = ([0.1; 3], add([0.1; 3], size));
    let radii = size.map(|side| side / f64::sqrt(12.0));
    let frame = Frame::of_mass(scale(0.5, add(low, high)), IDENTITY, radii).unwrap();
    let corners = corners_of(low, high);
    let surface = add_rigid(&mut mesh, &corners, &frame);
    mesh.point_masses = (count..count + 4)
        .map(|vertex| (vertex, 0.05 / 4.0))
        .collect();
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let surfaces = vec![Surface::of_voxels(body.voxels(), 1), surface];
    let table = vec![vec![NONE, 0.0], vec![0.0, NONE]];
    let hold = Clamp::fixed((0..count).collect());
    let problem = touching(&mesh, vec![hold], vec![], surfaces, table, 4e-3);
    let springs = frame.springs(count, frame.stiffness(&corners, YOUNG, 4e-3));
    let problem = problem
        .with_term(Arc::new(Springs(springs.to_vec())))
        .unwrap();
    let start = State::at_rest(problem.body());
    (problem, frame, start)
}

#[test]
fn rigid_box_keeps_its_rotation() {
    let (problem, frame, mut start) = lonely_box([40e-3, 20e-3, 10e-3]);
    let count = start.positions.len() - 4;
    let spin = [10.0, 0.0, 0.0];
    let at = |state: &State| -> [Vec3; 4] { std::array::from_fn(|i| state.positions[count + i]) };
    let (middle, _) = frame.pose(&at(&start));
    for vertex in count..count + 4 {
        start.velocities[vertex] = cross(spin, sub(start.positions[vertex], middle));
    }
    let time = 0.1;
    let solution = run(&undamped(2e-3, time), &problem, start, |_, _, _| {});
    let (end, rotation) = frame.pose(&at(&solution.state));
    assert!(norm(sub(end, middle)) < 1e-9);
    // Second order in the angle of a step: (ω h)²/2 of the rate, and as much for the first step alone.
    let angle = f64::atan2(rotation[2][1], rotation[1][1]);
    assert!((angle / (10.0 * time) - 1.0).abs() < 5e-3, "{angle}");
}

#[test]
fn free_fall_is_exact_from_the_first_step() {
    let mesh = block([2, 2, 2], 5e-3);
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let weight = Load::gravity([0.0, 0.0, -GRAVITY]);
    let problem = Problem::new(body, vec![], vec![weight], None).unwrap();
    let masses = problem.body().masses();
    let from = mean(problem.body().rest(), masses)[2];
    let mut seen = 0;
    let settings = Transient {
        record_interval: Some(0.02),
        ..undamped(1e-2, 0.1)
    };
    run(
        &settings,
        &problem,
        State::at_rest(problem.body()),
        |t, x, v| {
            if t < 0.01 - 1e-9 {
                return; // between the two stages of the first step
            }
            // Both formulas are exact for a constant acceleration; a step is found to 1e-7 of the weight.
            let fallen = from - mean(x, masses)[2];
            assert!(
                (fallen - GRAVITY * t * t / 2.0).abs() < 1e-6 * GRAVITY * 0.01,
                "{t} {fallen}"
            );
            assert!((mean(v, masses)[2] + GRAVITY * t).abs() < 1e-6, "{t}");
            seen += 1;
        },
    );
    assert_eq!(seen, 10);
}

#[test]
fn damped_fall_converges_at_second_order() {
    let mesh = block([2, 2, 2], 5e-3);
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let weight = Load::gravity([0.0, 0.0, -GRAVITY]);
    let problem = Problem::new(body, vec![], vec![weight], None).unwrap();
    let masses = problem.body().masses();
    let (rate, end) = (8.0, 0.2);
    let speed = GRAVITY / rate * (1.0 - f64::exp(-rate * end));
    let errors = [10e-3, 5e-3].map(|step| {
        let settings = Transient {
            damping: Damping::Rate(rate),
            ..undamped(step, end)
        };
        let start = State::at_rest(problem.body());
        let state = run(&settings, &problem, start, |_, _, _| {}).state;
        (mean(&state.velocities, masses)[2] + speed).abs()
    });
    // The formula adds the error h² v‴/3 per time, with v‴ = g c² e^(−ct), of which e^(−c(end − t)) is left at the end;
    // steps of a tenth of the time constant add terms of the next order, a tenth of it.
    let [coarse, fine] = errors;
    let leading = 10e-3f64.powi(2) / 3.0 * GRAVITY * rate.powi(2) * f64::exp(-rate * end) * end;
    assert!(
        (coarse / leading - 1.0).abs() < 0.2,
        "{coarse:e} beside {leading:e}"
    );
    let ratio = coarse / fine;
    assert!((3.0..6.0).contains(&ratio), "{ratio} of {errors:?}");
}

#[test]
fn vibration_converges_at_second_order() {
    let mesh: Mesh = block([4, 1, 1], 5e-3);
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let wall = vertices_where(&mesh, |x| x[0] < 1e-9);
    let tip = vertices_where(&mesh, |x| x[0] > 20e-3 - 1e-9)[0] as usize;
    let history = voxsoft_solid::History::new(vec![0.0, 0.1], vec![0.0, 1.0]).unwrap();
    let load = Load {
        history,
        ..Load::gravity([0.0, 0.0, -GRAVITY])
    };
    let problem = Problem::new(body, vec![Clamp::fixed(wall)], vec![load], None).unwrap();
    let tip_at = |step: f64| {
        let start = State::at_rest(problem.body());
        run(&undamped(step, 0.1), &problem, start, |_, _, _| {})
            .state
            .positions[tip][2]
    };
    let finest = tip_at(0.25e-3);
    let errors = [2e-3, 1e-3].map(|step| (tip_at(step) - finest).abs());
    // Ratio of four for an exact reference; that of a step four times shorter has a 16th of the error itself.
    let ratio = errors[0] / errors[1];
    assert!((3.0..6.0).contains(&ratio), "{ratio} of {errors:?}");
}

/// Mass of the bar in [`grasp`], kg.
const GRIPPED: f64 = 0.02;

/// Free bar of 10 mm between two pads of rubber, each of 4 × 6 × 6 voxels, that close by 0.5 mm within 30 ms; its weight
/// comes within 20 ms more. Both levels of multigrid have the bar, beside 490 vertices of pads.
fn grasp() -> Problem {
    let voxel = 2e-3;
    let mut mesh = block([4, 6, 6], voxel);
    join(&mut mesh, block([4, 6, 6], voxel), [18e-3, 0.0, 0.0]);
    let closing = |x: f64, way: f64| Clamp {
        vertices: vertices_where(&mesh, |p| (p[0] - x).abs() < 1e-9),
        axes: [true; 3],
        motion: Some(Motion {
            displacement: [way, 0.0, 0.0],
            axis: [0.0, 0.0, 1.0],
            angle: 0.0,
            center: [0.0; 3],
            history: History::new(vec![0.0, 0.03], vec![0.0, 1.0]).unwrap(),
            courses: None,
        }),
    };
    let clamps = vec![closing(0.0, 0.5e-3), closing(26e-3, -0.5e-3)];
    let first = mesh.vertices.len() as u32;
    let (low, high) = ([8e-3, -1e-3, -1e-3], [18e-3, 13e-3, 13e-3]);
    let corners = corners_of(low, high);
    let radii = sub(high, low).map(|side| side / f64::sqrt(12.0));
    let frame = Frame::of_mass(scale(0.5, add(low, high)), IDENTITY, radii).unwrap();
    let bar = add_rigid(&mut mesh, &corners, &frame);
    mesh.point_masses = (first..first + 4)
        .map(|vertex| (vertex, GRIPPED / 4.0))
        .collect();
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let surfaces = vec![Surface::of_voxels(body.voxels(), 2), bar];
    let table = vec![vec![NONE, 0.8], vec![0.8, NONE]];
    let weight = Load {
        history: History::new(vec![0.03, 0.05], vec![0.0, 1.0]).unwrap(),
        ..Load::gravity([0.0, 0.0, -GRAVITY])
    };
    let problem = touching(&mesh, clamps, vec![weight], surfaces, table, voxel);
    let springs = frame.springs(first, frame.stiffness(&corners, YOUNG, voxel));
    let springs = Arc::new(Springs(springs.to_vec()));
    problem.with_term(springs).unwrap()
}

/// End of the grasp with a solver.
fn grasped(linear: LinearSolver) -> Solution {
    let problem = grasp();
    let start = State::at_rest(problem.body());
    let settings = Transient {
        linear,
        ..undamped(1e-2, 0.08)
    };
    run(&settings, &problem, start, |_, _, _| {})
}

#[test]
fn a_grasp_is_the_same_by_multigrid_and_by_a_factor() {
    let [direct, iterative] =
        [LinearSolver::Direct, LinearSolver::Iterative].map(|way| grasped(way).state);
    // Pads of rubber of 60 kPa, 8 mm thick, under 0.5 mm press with half a newton; a step leaves 1e-7 of its forces
    // (`STEP_TOLERANCE`). In the softest way, against its inertia alone, that moves the bar by f h²/m, which goes on as a
    // velocity in all later ones of the 9 steps.
    let allowed = 2.0 * 1e-7 * 0.5 * 1e-4 / GRIPPED * (9.0 * 10.0 / 2.0);
    let pairs = direct.positions.iter().zip(&iterative.positions);
    let apart = pairs.map(|(a, b)| norm(sub(*a, *b))).fold(0.0, f64::max);
    assert!(apart < allowed, "{apart:e} m of {allowed:e} m");
    assert_ne!(direct.positions, iterative.positions);
    // The bar is held: friction has carried it after a fall of less than that of 20 ms.
    let sunk = 6e-3 - mean(&iterative.positions[490..494], &[0.25; 4])[2];
    assert!(sunk > 0.0 && sunk < GRAVITY * 0.02f64.powi(2), "{sunk:e}");
}

#[test]
fn a_grasp_has_the_same_bits_on_any_number_of_threads() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let run = || grasped(LinearSolver::Iterative).state.positions;
        pool.build().unwrap().install(run)
    };
    let one = on(1);
    assert_eq!(on(2), one);
    assert_eq!(on(7), one);
}
