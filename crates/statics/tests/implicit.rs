//! Implicit steps: agreement with statics, closed forms of vibrations, momentum, free fall, hands and sudden loads. The
//! file is long because each of these is a closed form with its derivation beside it.

mod common;

use std::f64::consts::PI;

use common::{block, cantilever, mesh_of, rubber, settled, vertices_where};
use voxsoft_solid::balance::balance;
use voxsoft_solid::matrix::determinant;
use voxsoft_solid::vector::{Vec3, add, norm, scale, sub};
use voxsoft_solid::{
    Ask, Body, Clamp, Damping, Floor, HyperelasticMaterial, LatticeMaterial, LiveStatus, Load,
    Look, Material, Model, PointForces, Pressure, Problem, Stepper,
};
use voxsoft_statics::{Implicit, ImplicitSettings, LinearSolver, Settings};
use voxsoft_voxel::Grid;

/// Relative tolerance of positions. At rest the residual is below 1e-4 of the load; slender bodies turn that into about
/// as much of the displacement, and some ten times as much if the load changes with it.
const SAME: f64 = 2e-3;

const SWING: ImplicitSettings = ImplicitSettings {
    step: 1.0 / 60.0,
    damping: Damping::Rate(0.0),
    retardation: 0.0,
    tolerance: 1e-30,
    accuracy: f64::INFINITY,
    linear: LinearSolver::Auto,
    memory: u64::MAX,
};

fn run_of(problem: &Problem) -> Implicit {
    Implicit::new(problem.clone(), ImplicitSettings::default())
}

fn settle(run: &mut Implicit) -> Look {
    let look = run.advance(600);
    assert_eq!(look.status, LiveStatus::AtRest, "{look:?}");
    look
}

/// Largest distance between two sets of positions over the largest motion from rest.
fn apart(problem: &Problem, a: &[Vec3], b: &[Vec3]) -> f64 {
    let largest = |a: &[Vec3], b: &[Vec3]| {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| norm(sub(*a, *b))).fold(0.0, f64::max)
    };
    largest(a, b) / largest(b, problem.body().rest())
}

fn yeoh() -> HyperelasticMaterial {
    // Constants of the card ecoflex-00-30-tensile.
    let c = [8107.74, 82.3095, -0.0336932];
    HyperelasticMaterial::new(Model::Yeoh { c }, 8.1e6, 1070.0).unwrap()
}

/// Closed chamber with walls of one voxel, held at one end, on a firmer layer.
fn chamber(soft: impl Into<Material>, firm: impl Into<Material>, pressure: f64) -> Problem {
    let side = 2.5e-3;
    let cells = [8, 4, 5];
    let mut grid = Grid::empty(cells, [0.0; 3], side, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], cells.map(|n| n as f64 * side), 2);
    grid.fill_box([0.0; 3], [8.0 * side, 4.0 * side, side], 1);
    grid.fill_box(
        [side, side, 2.0 * side],
        [7.0 * side, 3.0 * side, 4.0 * side],
        0,
    );
    let mesh = mesh_of(&grid);
    let body = Body::new(&mesh, &[firm.into(), soft.into()]).unwrap();
    let triangles = inner_faces(&grid, &mesh.vertices, side);
    let load = Load::constant(Pressure {
        triangles,
        voids: Vec::new(),
        pressure,
        closed: false,
    });
    let wall = vertices_where(&mesh, |x| x[0] < 1e-9);
    Problem::new(body, vec![Clamp::fixed(wall)], vec![load], None).unwrap()
}

/// Faces of the cells of a cavity, their normals out of the solid, into it.
fn inner_faces(grid: &Grid, vertices: &[Vec3], side: f64) -> Vec<[u32; 3]> {
    let key = |x: Vec3| x.map(|c| (c / side).round() as i64);
    let number: std::collections::HashMap<[i64; 3], u32> = vertices
        .iter()
        .enumerate()
        .map(|(v, x)| (key(*x), v as u32))
        .collect();
    let _ = grid;
    let inside =
        |c: [i64; 3]| (1..7).contains(&c[0]) && (1..3).contains(&c[1]) && (2..4).contains(&c[2]);
    let mut triangles = Vec::new();
    for i in 1..7 {
        for j in 1..3 {
            for k in 2..4 {
                let cell = [i, j, k];
                for axis in 0..3 {
                    for out in [0i64, 1] {
                        let mut next = cell;
                        next[axis] += 2 * out - 1;
                        if inside(next) {
                            continue;
                        }
                        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                        let corner = |a: i64, b: i64| {
                            let mut c = cell;
                            c[axis] += out;
                            c[u] += a;
                            c[v] += b;
                            number[&c]
                        };
                        let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                        // Counter-clockwise as seen from within the cavity: the normal points into it.
                        if out == 1 {
                            triangles.extend([[a, c, b], [a, d, c]]);
                        } else {
                            triangles.extend([[a, b, c], [a, c, d]]);
                        }
                    }
                }
            }
        }
    }
    triangles
}

#[test]
fn rest_agrees_with_statics() {
    let firm = HyperelasticMaterial::neo_hookean(300e3, 0.49, 1070.0).unwrap();
    let lattice = LatticeMaterial::from_moduli(200e3, 1e6, 1070.0).unwrap();
    for (name, problem) in [
        ("a beam", cantilever([12, 2, 2], 5e-3, rubber())),
        ("a chamber", chamber(yeoh(), firm, 1500.0)),
        ("a chamber on a lattice", chamber(yeoh(), lattice, 1500.0)),
    ] {
        let expected = settled(&problem, &Settings::default());
        let mut run = run_of(&problem);
        let look = settle(&mut run);
        assert!(look.residual < 1e-4);
        let off = apart(&problem, &run.state().positions, &expected.positions);
        assert!(off < SAME, "{name}: {off:.1e}");
    }
}

#[test]
fn open_follower_pressure_comes_to_rest() {
    let mesh = block([12, 2, 2], 5e-3);
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let wall = vertices_where(&mesh, |x| x[0] < 1e-9);
    let number = |x: Vec3| vertices_where(&mesh, |y| norm(sub(x, y)) < 1e-9)[0];
    let mut triangles = Vec::new();
    for i in 4..12 {
        for j in 0..2 {
            let at =
                |a: i32, b: i32| number([5e-3 * f64::from(i + a), 5e-3 * f64::from(j + b), 1e-2]);
            let [a, b, c, d] = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let load = Load::constant(Pressure {
        triangles,
        voids: Vec::new(),
        pressure: 150.0,
        closed: false,
    });
    let problem = Problem::new(body, vec![Clamp::fixed(wall)], vec![load], None).unwrap();
    assert!(!problem.is_conservative());
    let expected = settled(&problem, &Settings::default());
    let mut run = run_of(&problem);
    settle(&mut run);
    let off = apart(&problem, &run.state().positions, &expected.positions);
    assert!(off < SAME, "{off:.1e}");
}

/// Bar along x that slides on its symmetry planes, so that it stays uniaxial.
fn bar(material: HyperelasticMaterial) -> Problem {
    let mesh = block([10, 1, 1], 0.02);
    let slide = |axis: usize| Clamp {
        vertices: vertices_where(&mesh, |x| x[axis] < 1e-9),
        axes: [axis == 0, axis == 1, axis == 2],
        motion: None,
    };
    let body = Body::new(&mesh, &[material]).unwrap();
    Problem::new(body, (0..3).map(slide).collect(), vec![], None).unwrap()
}

/// Amplitude of the lowest mode of the bar after each step, released from it.
fn swing(material: HyperelasticMaterial, settings: ImplicitSettings, steps: usize) -> Vec<f64> {
    let problem = bar(material);
    let rest = problem.body().rest().to_vec();
    let shape: Vec<f64> = rest.iter().map(|x| (PI * x[0] / 0.4).sin()).collect();
    let moved = rest.iter().zip(&shape);
    let start = moved.map(|(x, s)| add(*x, [1e-4 * s, 0.0, 0.0])).collect();
    let mut run = Implicit::new(problem, settings);
    run.seek(start, 0.0).unwrap();
    let weight: f64 = shape.iter().map(|s| s * s).sum();
    let size = |run: &Implicit| {
        let moved = run.state().positions.iter().zip(&rest).zip(&shape);
        moved.map(|((x, r), s)| (x[0] - r[0]) * s).sum::<f64>() / weight
    };
    (0..steps)
        .map(|_| {
            run.advance(1);
            size(&run)
        })
        .collect()
}

/// Amplitude of an oscillator of one mass with `omega` times its frequency, by the formula alone.
fn oscillator(z: f64, omega: f64, steps: usize) -> Vec<f64> {
    let (mut x, mut v) = (vec![1e-4, 1e-4], vec![0.0, 0.0]);
    let part = 1.0 - 0.5f64.sqrt();
    for step in 0..=steps {
        // The two stages of the first step come first: there is no previous state.
        let (rate, first, second) = match step {
            0 => (1.0 / (part * z), 1.0, 0.0),
            1 => (1.0 / (part * z), 1.0 / part - 1.0, 2.0 - 1.0 / part),
            _ => (1.5 / z, 4.0 / 3.0, -1.0 / 3.0),
        };
        let mix = |a: &[f64]| first * a[a.len() - 1] + second * a[a.len() - 2];
        let (from, speed) = (mix(&x), mix(&v));
        let next = (rate * rate * from + rate * speed) / (rate * rate + omega * omega);
        v.push(rate * (next - from));
        x.push(next);
        if step == 1 {
            // A state between its stages does not count as a step.
            x.remove(x.len() - 2);
            v.remove(v.len() - 2);
        }
    }
    x.split_off(2)
}

/// Amplitude of the last extremum, between steps, over the start.
fn last_extremum(seen: &[f64]) -> f64 {
    let extremum = |w: &&[f64; 3]| (w[1] - w[0]) * (w[2] - w[1]) <= 0.0;
    let [a, b, c] = *seen.array_windows::<3>().rfind(extremum).unwrap();
    let (slope, curve) = ((c - a) / 2.0, a - 2.0 * b + c);
    (b - slope * slope / (2.0 * curve)).abs() / 1e-4
}

/// Approximation of `exp(iz)` by the formula: `ζ = (2 + √(1 + 2iz))/(3 − 2iz)`, as an angle and a magnitude.
fn formula(z: f64) -> (f64, f64) {
    let size = (1.0 + 4.0 * z * z).sqrt().sqrt();
    let half = (2.0 * z).atan() / 2.0;
    let (re, im) = (2.0 + size * half.cos(), size * half.sin());
    let below = 9.0 + 4.0 * z * z;
    let zeta = [
        (3.0 * re - 2.0 * z * im) / below,
        (3.0 * im + 2.0 * z * re) / below,
    ];
    (zeta[1].atan2(zeta[0]), zeta[0].hypot(zeta[1]))
}

#[test]
fn bar_vibration_agrees_with_closed_form() {
    // Masses at the ends of ten elements make the lowest mode (π/20)²/24 = 0.1 % slow, masses at the edges that thin by
    // ν, r² = a²/2 from the axis, another (πνr/2L)²/2 = 0.12 %.
    let slow = 1.0 - 0.0022;
    let young = 60e3;
    let material = HyperelasticMaterial::neo_hookean(young, 0.45, 1000.0).unwrap();
    let frequency = PI / 0.4 * (young / 1000.0f64).sqrt();
    for z in [0.2, 0.5, 1.0] {
        let step = z / frequency;
        let steps = (4.0 * PI / z) as usize;
        let seen = swing(material.clone(), ImplicitSettings { step, ..SWING }, steps);
        let expected = oscillator(z, slow, steps);
        let off = seen.iter().zip(&expected).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f64::max) / 1e-4;
        // The start neglects that the bar thins, which takes 0.5 % of its energy elsewhere; an error of the frequency
        // of 0.05 % makes 0.6 % after two periods.
        assert!(off < 0.012, "{z}: {off}");
        // Errors of the formula in the guide: the period is longer by z²/3, and z⁴/4 is lost per step.
        let (angle, size) = formula(z);
        if z < 0.3 {
            assert!((1.0 - angle / z - z * z / 3.0).abs() < 0.1 * z * z);
            assert!((1.0 - size - z.powi(4) / 4.0).abs() < 0.1 * z.powi(4));
        }
    }
}

/// Logarithmic decrement of an oscillator of one mass at its fourth extremum, released from rest with a relaxed branch
/// of this stiffness and `ωτ = 1`: by the rule of Runge and Kutta, whose error is the fourth power of a step.
fn released_decay(branch: f64) -> f64 {
    let rate = |y: [f64; 3]| [y[1], -y[0] - branch * y[2], y[1] - y[2]];
    let step = 1e-3;
    let moved = |y: [f64; 3], k: [f64; 3], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
    let (mut y, mut extrema) = ([1.0, 0.0, 0.0], 0);
    loop {
        let a = rate(y);
        let b = rate(moved(y, a, step / 2.0));
        let c = rate(moved(y, b, step / 2.0));
        let d = rate(moved(y, c, step));
        let next: [f64; 3] =
            std::array::from_fn(|i| y[i] + step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        extrema += u32::from(y[1] * next[1] < 0.0);
        if extrema == 4 {
            return -next[0].abs().ln();
        }
        y = next;
    }
}

#[test]
fn viscous_damping_agrees_with_closed_form() {
    let young = 60e3;
    // A uniaxial stretch at ν near ½ is deviatoric, so that the loss factor is τω: the amplitude decays as exp(−loss
    // ωt/2).
    let plain = HyperelasticMaterial::neo_hookean(young, 0.49, 1000.0).unwrap();
    let frequency = PI / 0.4 * (young / 1000.0f64).sqrt();
    let z = 0.1;
    let settings = ImplicitSettings {
        step: z / frequency,
        ..SWING
    };
    // Steps to the fourth extremum, ωt = 4π.
    let steps = (4.2 * PI / z) as usize;
    let own = last_extremum(&swing(plain.clone(), settings, steps)).ln();
    let kelvin = ImplicitSettings {
        retardation: 0.1 / frequency,
        ..settings
    };
    let decay = own - last_extremum(&swing(plain.clone(), kelvin, steps)).ln();
    // The rate of the stress is that of the middle of a step, z/2 of it late: second order.
    assert!((decay / (0.05 * 4.0 * PI) - 1.0).abs() < 0.05, "{decay}");
    let branch = 0.1 / 0.9;
    let relaxing = plain.with_prony(vec![(0.1, 1.0 / frequency)]).unwrap();
    let decay = own - last_extremum(&swing(relaxing, settings, steps)).ln();
    // Storage and loss are equal at ωτ = 1: a delay by z/2 loses that fraction of the loss. The rest is of second
    // order, and the bar 0.2 % slow.
    let expected = released_decay(branch) * (1.0 - z / 2.0);
    assert!((decay / expected - 1.0).abs() < 0.02, "{decay} {expected}");
}

#[test]
fn free_body_takes_all_momentum() {
    let mesh = block([6, 2, 2], 5e-3);
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let push = Load::constant(PointForces {
        vertices: vec![0, 5],
        forces: vec![[0.0, 0.0, 2e-3], [1e-3, 0.0, 0.0]],
    });
    let problem = Problem::new(body, vec![], vec![push], None).unwrap();
    let mut run = Implicit::new(problem, SWING);
    for _ in 0..6 {
        let look = run.advance(1);
        let masses = run.problem().body().masses();
        let moving = run.state().velocities.iter().zip(masses);
        let momentum = moving.fold([0.0; 3], |sum, (v, m)| add(sum, scale(*m, *v)));
        let expected = scale(look.time, [1e-3, 0.0, 2e-3]);
        // After the first move of a search the sum of the forces is zero, whatever the tangent.
        let off = norm(sub(momentum, expected)) / norm(expected);
        assert!(off < 1e-9, "{off:.1e}");
        assert!(look.kinetic > 0.0 && look.elastic > 0.0);
    }
}

#[test]
fn free_fall_is_exact_from_the_first_step() {
    let mesh = block([2, 2, 2], 5e-3);
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let weight = Load::gravity([0.0, 0.0, -9.81]);
    let problem = Problem::new(body, vec![], vec![weight], None).unwrap();
    let mut run = Implicit::new(problem, SWING);
    let step = run.step();
    for count in 1..=6 {
        let look = run.advance(1);
        // Steps end at multiples of their length, for any stages of the first one.
        assert!((look.time - f64::from(count) * step).abs() < 1e-12);
        let masses = run.problem().body().masses();
        let (mut fallen, mut speed) = (0.0, 0.0);
        let moved = run
            .state()
            .positions
            .iter()
            .zip(run.problem().body().rest());
        for ((x, rest), (v, m)) in moved.zip(run.state().velocities.iter().zip(masses)) {
            fallen += m * (rest[2] - x[2]);
            speed -= m * v[2];
        }
        let mass: f64 = masses.iter().sum();
        // Both formulas are exact for a constant acceleration, and momentum is kept to rounding.
        let expected = [9.81 * look.time.powi(2) / 2.0, 9.81 * look.time];
        assert!((fallen / mass / expected[0] - 1.0).abs() < 1e-9, "{fallen}");
        assert!((speed / mass / expected[1] - 1.0).abs() < 1e-9, "{speed}");
    }
}

/// Nothing bounds the way of a body that nothing holds: it falls by more than ten times its size.
#[test]
fn a_free_body_falls_as_far_as_it_may() {
    let body = Body::new(&block([2, 2, 2], 5e-3), &[rubber()]).unwrap();
    let weight = Load::gravity([0.0, 0.0, -9.81]);
    let problem = Problem::new(body, vec![], vec![weight], None).unwrap();
    let settings = ImplicitSettings {
        step: 0.02,
        ..SWING
    };
    let mut run = Implicit::new(problem, settings);
    let look = run.advance_to(0.5, &mut |_| true);
    assert_eq!((look.status, look.time), (LiveStatus::Moving, 0.5));
    let (body, positions) = (run.problem().body(), &run.state().positions);
    let fallen = positions.iter().zip(body.rest()).zip(body.masses());
    let moment: f64 = fallen.map(|((x, rest), m)| m * (rest[2] - x[2])).sum();
    let fallen = moment / body.masses().iter().sum::<f64>();
    assert!((fallen / (9.81 * 0.125) - 1.0).abs() < 1e-9, "{fallen}");
}

/// Smallest volume ratio among all voxels.
fn flattest(run: &Implicit) -> f64 {
    let positions = &run.state().positions;
    let body = run.problem().body();
    let hex8s = body.hex8s().iter();
    hex8s
        .map(|hex8| determinant(&hex8.deformation(body.material_of(hex8), positions)))
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn sudden_loads_and_strong_pulls_invert_no_voxel() {
    let firm = HyperelasticMaterial::neo_hookean(300e3, 0.49, 1070.0).unwrap();
    let problem = chamber(yeoh(), firm, 1000.0);
    let vertex = problem.body().rest().len() as u32 - 1;
    for damping in [Damping::Critical, Damping::Rate(0.0)] {
        let settings = ImplicitSettings {
            damping,
            ..ImplicitSettings::default()
        };
        let mut run = Implicit::new(problem.clone(), settings);
        for (factor, pull) in [
            (0.0, 0.0),
            (4.0, 0.0),
            (-3.0, 0.0),
            (0.0, 0.03),
            (4.0, -0.03),
            (1.0, 0.0),
        ] {
            run.set_load(0, Some(factor)).unwrap();
            if pull != 0.0 {
                let target = add(run.state().positions[vertex as usize], [0.0, pull, pull]);
                run.grab(1, vertex, target, 50.0).unwrap();
            } else {
                run.release(1);
            }
            for _ in 0..12 {
                let look = run.advance(1);
                assert_ne!(
                    look.status,
                    LiveStatus::Diverged,
                    "{factor} {pull} {look:?}"
                );
                assert!(flattest(&run) > 0.0, "{factor} {pull} {look:?}");
            }
        }
    }
}

#[test]
fn hand_is_balanced_and_releases() {
    let problem = cantilever([12, 2, 2], 5e-3, rubber());
    let mut run = run_of(&problem);
    settle(&mut run);
    let before = run.state().positions.clone();
    let vertex = before.len() as u32 - 1;
    let target = add(before[vertex as usize], [0.0, 8e-3, 0.0]);
    run.grab(4, vertex, target, 100.0).unwrap();
    settle(&mut run);
    let [(4, grab)] = run.grabs() else {
        panic!("{:?}", run.grabs());
    };
    assert_eq!(grab.anchor, target);
    let state = run.state();
    let net = balance(&problem, &state.positions, state.time).net[vertex as usize];
    let force = grab.force(state.positions[vertex as usize]);
    assert!(norm(add(net, force)) < 1e-3 * norm(force));
    assert!(run.release(4) && !run.release(4));
    settle(&mut run);
    assert!(apart(&problem, &run.state().positions, &before) < SAME);
    assert!(run.grab(0, vertex, target, -1.0).is_err());
    assert!(run.set_load(3, None).is_err());
}

#[test]
fn reset_and_seek_repeat_the_motion() {
    let problem = cantilever([12, 2, 2], 5e-3, rubber());
    let mut run = run_of(&problem);
    run.advance(9);
    let first = run.state().clone();
    let look = settle(&mut run);
    let rest = run.state().positions.clone();
    run.reset();
    assert!(run.state().positions == problem.body().rest());
    run.advance(9);
    assert!(*run.state() == first, "{:?}", run.state().time);
    run.seek(rest.clone(), look.time).unwrap();
    assert_eq!(run.advance(3).status, LiveStatus::AtRest);
    assert!(apart(&problem, &run.state().positions, &rest) < SAME);
    assert!(run.seek(rest[1..].to_vec(), 0.0).is_err());
}

#[test]
fn bits_are_independent_of_threads() {
    let problem = cantilever([20, 6, 6], 5e-3, yeoh());
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let mut run = run_of(&problem);
            run.grab(0, 700, [0.1, 0.05, 0.0], 30.0).unwrap();
            run.advance(6);
            run.state().clone()
        })
    };
    assert!(on(1) == on(3));
}

#[test]
fn falling_block_rests_on_the_floor() {
    let mut mesh = block([4, 4, 2], 5e-3);
    for x in &mut mesh.vertices {
        x[2] += 0.01;
    }
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let gravity = Load::gravity([0.0, 0.0, -9.81]);
    let floor = Some(Floor { z: 0.0 });
    let problem = Problem::new(body, vec![], vec![gravity], floor).unwrap();
    let mut run = run_of(&problem);
    settle(&mut run);
    let state = run.state();
    let lowest = state
        .positions
        .iter()
        .map(|x| x[2])
        .fold(f64::INFINITY, f64::min);
    assert!(lowest.abs() < 1e-9, "{lowest}");
    let weight = problem.body().total_mass() * 9.81;
    let carried = balance(&problem, &state.positions, state.time).total_reaction();
    assert!((carried[2] / weight - 1.0).abs() < 1e-3, "{carried:?}");
}

#[test]
fn cancelled_step_is_taken_later() {
    let problem = cantilever([12, 2, 2], 5e-3, rubber());
    let mut run = run_of(&problem);
    run.advance(3);
    let before = run.state().clone();
    let look = run.advance_while(5, &mut |ask| ask == Ask::After);
    assert!(*run.state() == before);
    assert_eq!(look.time, before.time);
    assert!(run.advance(1).time > before.time);
}

#[test]
fn steps_have_the_preferred_length() {
    let problem = cantilever([12, 2, 2], 5e-3, rubber());
    let mut run = run_of(&problem);
    run.prefer_step(1e-3);
    assert_eq!(run.step(), 1e-3);
    assert!((run.advance(3).time - 3e-3).abs() < 1e-12);
    run.prefer_step(1e-2);
    let look = run.advance(2);
    assert!((look.time - 2.3e-2).abs() < 1e-12, "{look:?}");
}
