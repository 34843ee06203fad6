//! Dynamics of bodies with membranes: equilibrium and motion.

mod common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::{GRAVITY, block, relax, simulate, tip, where_};
use voxsoft_solid::vector::{Vec3, axpy, cross, dot, norm, sub};
use voxsoft_solid::{
    Body, Clamp, HyperelasticMaterial, LatticeMaterial, Load, Material, Membrane, MembraneMaterial,
    Mesh, PointForces, Problem, State, Stepper, elastic,
};
use voxsoft_xpbd::{Damping, Dynamics, Live, Relaxation, Status};

/// Fabric of 3,000 N/m; a layer of voxels of the bodies below has 300.
const FABRIC: MembraneMaterial = MembraneMaterial {
    young: 30e6,
    poisson: 0.3,
    thickness: 0.1e-3,
    density: 800.0,
};

fn rubber() -> Material {
    HyperelasticMaterial::neo_hookean(60e3, 0.45, 1000.0)
        .unwrap()
        .into()
}

fn lattice() -> Material {
    LatticeMaterial::from_moduli(30e3, 100e3, 1000.0)
        .unwrap()
        .into()
}

/// Bonds a membrane to all faces of voxels of the side `h` in a plane across z: two triangles each.
fn bond(mesh: &mut Mesh, h: f64, z: f64, material: MembraneMaterial) {
    let at = |x: f64, y: f64| {
        let here = |p: &Vec3| norm(sub(*p, [x, y, z])) < 1e-6 * h;
        mesh.vertices.iter().position(here).map(|v| v as u32)
    };
    let mut membrane = Vec::new();
    for [x, y, _] in mesh.vertices.iter().filter(|p| (p[2] - z).abs() < 1e-6 * h) {
        let corners = [at(*x, *y), at(x + h, *y), at(x + h, y + h), at(*x, y + h)];
        if let [Some(a), Some(b), Some(c), Some(d)] = corners {
            for triangle in [[a, b, c], [a, c, d]] {
                let corners = triangle.map(|v| mesh.vertices[v as usize]);
                membrane.push(Membrane::new(triangle, corners, material).unwrap());
            }
        }
    }
    mesh.membranes.extend(membrane);
}

/// Cantilever of 8 × 2 × 2 voxels that sags, its upper side or its lower one bonded to a membrane.
fn cantilever(material: Material, upper: bool, fabric: MembraneMaterial) -> Problem {
    let h = 5e-3;
    let mut mesh = block([8, 2, 2], h);
    bond(&mut mesh, h, if upper { 2.0 * h } else { 0.0 }, fabric);
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    let body = Body::new(&mesh, &[material]).unwrap();
    Problem::new(body, vec![clamp], vec![Load::gravity(GRAVITY)], None).unwrap()
}

#[test]
fn equilibrium_is_that_of_the_energies_for_any_step() {
    for (case, material) in [rubber(), lattice()].into_iter().enumerate() {
        for upper in [true, false] {
            let problem = cantilever(material.clone(), upper, FABRIC);
            let reference = relax(
                &problem,
                &Relaxation {
                    tolerance: 1e-7,
                    ..Relaxation::default()
                },
            );
            assert_eq!(reference.status, Status::AtRest);
            let expected = tip(&problem, &reference);
            let own = simulate(&problem, &Dynamics::default());
            let step = own.substep;
            for divisor in [1.0, 2.0, 4.0] {
                let settings = Dynamics {
                    time_step: 64.0 * step / divisor,
                    substeps: Some(64),
                    tolerance: 1e-5,
                    ..Dynamics::default()
                };
                let answer = simulate(&problem, &settings);
                assert_eq!(answer.status, Status::AtRest, "{case} {upper} {divisor}");
                assert_eq!(answer.back_offs, 0, "{case} {upper} {divisor}");
                let error = norm(sub(tip(&problem, &answer), expected)) / norm(expected);
                assert!(error < 1e-3, "{error:.1e} {case} {upper} {divisor}");
            }
        }
    }
}

#[test]
fn stiff_membrane_rests_with_substeps_beyond_its_explicit_limit() {
    let stiff = MembraneMaterial {
        young: 3e9,
        ..FABRIC
    };
    let problem = cantilever(rubber(), true, stiff);
    let body = problem.body();
    // Mode of membrane rows in antiphase: its Rayleigh quotient is at most the square of the highest frequency;
    // explicit forces are stable up to a substep of two over it.
    let h = 5e-3;
    let zigzag: Vec<Vec3> = body
        .rest()
        .iter()
        .map(|p| {
            let side = if (p[0] / h).round() as i64 % 2 == 0 {
                1.0
            } else {
                -1.0
            };
            if p[2] > 1.9 * h {
                [side, 0.0, 0.0]
            } else {
                [0.0; 3]
            }
        })
        .collect();
    let mut forces = vec![[0.0; 3]; zigzag.len()];
    elastic::add_taut_product(body, body.rest(), &zigzag, &mut forces);
    let sum = |other: &[Vec3], weights: &dyn Fn(usize) -> f64| -> f64 {
        (0..other.len())
            .map(|v| weights(v) * dot(zigzag[v], other[v]))
            .sum()
    };
    let square = sum(&forces, &|_| 1.0) / sum(&zigzag, &|v| body.masses()[v]);
    let answer = simulate(&problem, &Dynamics::default());
    assert_eq!((answer.status, answer.back_offs), (Status::AtRest, 0));
    let limit = 2.0 / square.sqrt();
    assert!(answer.substep > 1.2 * limit, "{} {limit}", answer.substep);
}

#[test]
fn free_body_keeps_its_momenta() {
    let h = 5e-3;
    let bodies = [
        (rubber(), 30e6, 0.05),
        (rubber(), 300e6, 0.05),
        // Sweeps of a lattice dissipate energy.
        (lattice(), 30e6, 0.15),
    ];
    for (case, (material, young, sway)) in bodies.into_iter().enumerate() {
        let mut mesh = block([6, 3, 2], h);
        bond(&mut mesh, h, 0.0, MembraneMaterial { young, ..FABRIC });
        let body = Body::new(&mesh, &[material]).unwrap();
        let problem = Problem::new(body, vec![], vec![Load::gravity(GRAVITY)], None).unwrap();
        let masses = problem.body().masses();
        let total = problem.body().total_mass();
        let mut start = State::at_rest(problem.body());
        for (v, x) in start.velocities.iter_mut().zip(problem.body().rest()) {
            *v = cross([3.0, 5.0, -8.0], *x);
            v[2] += 0.01 * x[0] * x[0] / (h * h);
        }
        // Momentum without that of free fall, and angular momentum about the center of mass.
        let momenta = |state: &State| {
            let (mut center, mut linear, mut angular) = ([0.0; 3], [0.0; 3], [0.0; 3]);
            for ((x, v), m) in state.positions.iter().zip(&state.velocities).zip(masses) {
                axpy(&mut center, m / total, *x);
                axpy(&mut linear, *m, *v);
                axpy(&mut angular, *m, cross(*x, *v));
            }
            axpy(&mut angular, -1.0, cross(center, linear));
            axpy(&mut linear, -total * state.time, GRAVITY);
            (linear, angular)
        };
        // Energy in the frame that falls with the body.
        let energy = |state: &State| {
            let mut falling = state.clone();
            for v in &mut falling.velocities {
                axpy(v, -state.time, GRAVITY);
            }
            elastic::energy(problem.body(), &state.positions) + falling.kinetic_energy(masses)
        };
        let settings = Dynamics {
            damping: Damping::Rate(0.0),
            // A longer fall would exceed the travel limit of a sound run.
            end_time: Some(0.2),
            ..Dynamics::default()
        };
        let ((linear, angular), before) = (momenta(&start), energy(&start));
        let mut worst = [0.0; 3];
        let answer = voxsoft_xpbd::simulate(&problem, start.clone(), &settings, &mut |now| {
            let state = State {
                positions: now.positions.to_vec(),
                velocities: now.velocities.to_vec(),
                time: now.time,
            };
            let (l, a) = momenta(&state);
            let changes = [
                norm(sub(l, linear)) / norm(linear),
                norm(sub(a, angular)) / norm(angular),
                (energy(&state) / before - 1.0).abs(),
            ];
            worst = std::array::from_fn(|i| f64::max(worst[i], changes[i]));
            ControlFlow::Continue(())
        });
        assert_eq!((answer.status, answer.back_offs), (Status::EndTime, 0));
        // Linear momentum is kept up to rounding. Angular momentum is kept with the scaled inertia of membranes (h⁴
        // beyond the masses: 2 % of it here, 0.1 % with half the substep); energy up to the oscillation of explicit
        // steps and the gain where membranes change between taut and slack.
        assert!(worst[0] < 1e-10, "{case}: {worst:?}");
        assert!(worst[1] < 0.03, "{case}: {worst:?}");
        assert!(worst[2] < sway, "{case}: {worst:?}");
    }
}

#[test]
fn bits_are_independent_of_threads() {
    let run = |threads: usize| {
        let mut live = Live::new(cantilever(rubber(), true, FABRIC), Dynamics::default());
        live.grab(0, 3, [0.0, 0.0, 0.03], 20.0).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| live.advance(300));
        live.state().positions.clone()
    };
    let one = run(1);
    for threads in 2..=4 {
        assert!(one == run(threads), "{threads} threads");
    }
}

/// Bar of rubber between two membranes, pulled a little so that they stay taut, released from its lowest mode: measured
/// and closed-form frequency in rad/s.
fn bar_between_membranes(fabric: MembraneMaterial, step: f64) -> (f64, f64) {
    let (h, cells) = (0.02, 10);
    let length = h * cells as f64;
    let mut mesh = block([cells, 1, 1], h);
    for z in [0.0, h] {
        bond(&mut mesh, h, z, fabric);
    }
    let sides = (0..3).map(|axis| Clamp {
        vertices: where_(&mesh, |p| p[axis] < 1e-9),
        axes: [axis == 0, axis == 1, axis == 2],
        motion: None,
    });
    // Young's moduli times areas, masses per length.
    let stiffness = 60e3 * h * h + 2.0 * fabric.young * fabric.thickness * h;
    let line = 1000.0 * h * h + 2.0 * fabric.density * fabric.thickness * h;
    let strain = 1e-3;
    let end = where_(&mesh, |p| p[0] > length - 1e-9);
    let pull = Load::constant(PointForces {
        forces: vec![[strain * stiffness / end.len() as f64, 0.0, 0.0]; end.len()],
        vertices: end,
    });
    let body = Body::new(&mesh, &[rubber()]).unwrap();
    let problem = Problem::new(body, sides.collect(), vec![pull], None).unwrap();
    let stretched = relax(
        &problem,
        &Relaxation {
            tolerance: 1e-7,
            ..Relaxation::default()
        },
    );
    assert_eq!(stretched.status, Status::AtRest);
    let still = stretched.state.positions.clone();
    let rest = problem.body().rest();
    let wave = PI / (2.0 * length);
    let mut start = State {
        positions: still.clone(),
        ..State::at_rest(problem.body())
    };
    for (x, rest) in start.positions.iter_mut().zip(rest) {
        x[0] += 0.1 * strain * length * (wave * rest[0]).sin();
    }
    let settings = Dynamics {
        time_step: step,
        damping: Damping::Rate(0.0),
        end_time: Some(0.5),
        ..Dynamics::default()
    };
    let mut seen: Vec<(f64, f64)> = Vec::new();
    let masses = problem.body().masses();
    let answer = voxsoft_xpbd::simulate(&problem, start, &settings, &mut |now| {
        let moved =
            |v: usize| masses[v] * (wave * rest[v][0]).sin() * (now.positions[v][0] - still[v][0]);
        seen.push((now.time, (0..rest.len()).map(moved).sum()));
        ControlFlow::Continue(())
    });
    assert_eq!((answer.status, answer.back_offs), (Status::EndTime, 0));
    let crossings: Vec<f64> = seen
        .windows(2)
        .filter(|w| w[0].1 * w[1].1 < 0.0)
        .map(|w| w[0].0 + (w[1].0 - w[0].0) * w[0].1 / (w[0].1 - w[1].1))
        .collect();
    let span = crossings[crossings.len() - 1] - crossings[0];
    let frequency = PI * (crossings.len() - 1) as f64 / span;
    (frequency, wave * (stiffness / line).sqrt())
}

#[test]
fn frequency_of_bar_between_membranes_matches_closed_form() {
    // Ten voxels with lumped masses are 0.1 % slow and the lateral inertia of ν = 0.45 adds less (see
    // `hyperelastic.rs`); a strain of 10⁻³ stiffens a membrane by 0.3 %. The third has 2,000 times the stiffness of the
    // bar, and its substep, 4 over the highest frequency, makes it 1.1 % slow. (With a hundredth of its stiffness left
    // across the wrinkles it would be faster by ν²/(1 − ν²)/200 = 0.13 %.)
    for (young, step, slack) in [(3e6, 2e-3, 5e-3), (18e6, 1e-3, 5e-3), (2e9, 1e-3, 1.2e-2)] {
        let fabric = MembraneMaterial {
            young,
            poisson: 0.45,
            ..FABRIC
        };
        let (frequency, expected) = bar_between_membranes(fabric, step);
        let error = (frequency / expected - 1.0).abs();
        assert!(error < slack, "{young:.0e} {step}: {frequency} {expected}");
    }
}
