//! Dynamics of rubber with a part of plastic, ten thousand times as stiff.

mod common;

use std::ops::ControlFlow;

use common::{GRAVITY, block, simulate, tip, where_};
use voxsoft_solid::vector::{Vec3, add, axpy, cross, norm, scale, sub};
use voxsoft_solid::{
    Body, Clamp, HyperelasticMaterial, Load, Material, Mesh, Problem, State, elastic,
};
use voxsoft_xpbd::{Answer, Damping, Dynamics, Status};

const SIDE: f64 = 5e-3;
const SOFT: f64 = 200e3;

fn rubber(young: f64) -> Material {
    HyperelasticMaterial::neo_hookean(young, 0.45, 1000.0)
        .unwrap()
        .into()
}

/// Voxels of which those in `stiff` (m) are `ratio` times as stiff as the others.
fn bonded(cells: [usize; 3], ratio: f64, stiff: impl Fn(&Vec3) -> bool) -> (Mesh, Body) {
    let mut mesh = block(cells, SIDE);
    let middle = |tets: &[[u32; 4]]| {
        let corners = tets.iter().flatten().map(|&v| mesh.vertices[v as usize]);
        let sum = corners.fold([0.0; 3], add);
        scale(1.0 / (4 * tets.len()) as f64, sum)
    };
    let parts = mesh
        .tets
        .chunks(5)
        .flat_map(|tets| [u8::from(stiff(&middle(tets))); 5]);
    mesh.tet_part = parts.collect();
    let body = Body::new(&mesh, &[rubber(SOFT), rubber(ratio * SOFT)]).unwrap();
    (mesh, body)
}

/// Cantilever under its weight.
fn cantilever(cells: [usize; 3], ratio: f64, stiff: impl Fn(&Vec3) -> bool) -> Problem {
    let (mesh, body) = bonded(cells, ratio, stiff);
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    Problem::new(body, vec![clamp], vec![Load::gravity(GRAVITY)], None).unwrap()
}

fn undamped(end: f64) -> Dynamics {
    Dynamics {
        damping: Damping::Rate(0.0),
        end_time: Some(end),
        time_step: 2e-3,
        ..Dynamics::default()
    }
}

/// Places of the stiff part: at the tip, in a strip within, at the clamp.
fn shapes() -> [fn(&Vec3) -> bool; 3] {
    [
        |p| p[0] > 5.0 * SIDE,
        |p| p[2] < SIDE && p[0] > 2.0 * SIDE,
        |p| p[0] < 3.0 * SIDE,
    ]
}

#[test]
fn stiff_part_takes_the_substeps_of_its_rubber() {
    for stiff in shapes() {
        let substep =
            |ratio| simulate(&cantilever([8, 2, 2], ratio, stiff), &undamped(2e-3)).substep;
        let (alone, bonded) = (substep(1.0), substep(1e4));
        assert!(bonded > 0.6 * alone, "{bonded:.2e} {alone:.2e}");
    }
}

#[test]
fn motion_is_that_of_substeps_that_resolve_the_stiff_part() {
    for stiff in shapes() {
        let problem = cantilever([8, 1, 1], 1e4, stiff);
        let own = simulate(&problem, &undamped(0.04));
        let resolved = Dynamics {
            substeps: Some(4000),
            ..undamped(0.04)
        };
        let reference = simulate(&problem, &resolved);
        assert!(reference.substep < 0.02 * own.substep, "{}", own.substep);
        let (own, expected) = (tip(&problem, &own), tip(&problem, &reference));
        let off = norm(sub(own, expected)) / norm(expected);
        assert!(off < 5e-3, "{own:?} {expected:?} {off}");
    }
}

#[test]
fn part_that_is_practically_rigid_moves_alike_whatever_its_stiffness() {
    for stiff in shapes() {
        let at = |ratio| {
            let problem = cantilever([8, 2, 2], ratio, stiff);
            let start = State::at_rest(problem.body());
            let mut farthest = 0.0;
            let answer: Answer =
                voxsoft_xpbd::simulate(&problem, start, &undamped(0.06), &mut |now| {
                    let pairs = now.positions.iter().zip(problem.body().rest());
                    farthest = pairs
                        .map(|(x, rest)| norm(sub(*x, *rest)))
                        .fold(farthest, f64::max);
                    ControlFlow::Continue(())
                });
            (tip(&problem, &answer), farthest)
        };
        let ((less, _), (more, farthest)) = (at(1e3), at(1e4));
        // Swings end near rest for two of the shapes, and the tip is compared with the largest motion. Substeps of 3 µs
        // have the two stiffnesses differ by 5e-4 likewise.
        let off = norm(sub(less, more)) / farthest;
        assert!(off < 1e-3, "{less:?} {more:?} {off}");
    }
}

/// Momentum, angular momentum and energy of a state.
fn kept(body: &Body, state: &State) -> (Vec3, Vec3, f64) {
    let (mut momentum, mut turning) = ([0.0; 3], [0.0; 3]);
    for ((x, v), &mass) in state
        .positions
        .iter()
        .zip(&state.velocities)
        .zip(body.masses())
    {
        axpy(&mut momentum, mass, *v);
        axpy(&mut turning, mass, cross(*x, *v));
    }
    let energy = elastic::energy(body, &state.positions) + state.kinetic_energy(body.masses());
    (momentum, turning, energy)
}

/// Checks a free body that turns at `rate` (rad/s) for some turns: the largest changes of its angular momentum and of its
/// energy are `bounds` parts.
fn check_free(stiff: fn(&Vec3) -> bool, rate: f64, bounds: [f64; 2]) {
    let (_, body) = bonded([8, 2, 2], 1e4, stiff);
    let problem = Problem::new(body.clone(), vec![], vec![], None).unwrap();
    let mut start = State::at_rest(&body);
    let turn = [0.22 * rate, 0.87 * rate, 0.44 * rate];
    for (v, x) in start.velocities.iter_mut().zip(body.rest()) {
        let from_middle = sub(*x, [4.0 * SIDE, SIDE, SIDE]);
        *v = add([0.3, -0.1, 0.2], cross(turn, from_middle));
    }
    let (momentum, turning, energy) = kept(&body, &start);
    let mut largest = [0.0_f64; 3];
    let answer: Answer = voxsoft_xpbd::simulate(&problem, start, &undamped(0.3), &mut |now| {
        let state = State {
            positions: now.positions.to_vec(),
            velocities: now.velocities.to_vec(),
            time: now.time,
        };
        let after = kept(&body, &state);
        let off = [
            norm(sub(after.0, momentum)) / norm(momentum),
            norm(sub(after.1, turning)) / norm(turning),
            (after.2 / energy - 1.0).abs(),
        ];
        largest = std::array::from_fn(|i| largest[i].max(off[i]));
        ControlFlow::Continue(())
    });
    assert_eq!((answer.status, answer.back_offs), (Status::EndTime, 0));
    let [momentum, turning, energy] = largest;
    assert!(momentum < 1e-9, "momentum {momentum:.1e}");
    assert!(turning < bounds[0], "angular momentum {turning:.1e}");
    assert!(energy < bounds[1], "energy {energy:.1e}");
}

#[test]
fn free_body_keeps_momentum_and_energy() {
    // Without a clamp the third is the first from the other end.
    for stiff in &shapes()[..2] {
        // Turning parts have inertia against their centripetal strain, which falls with the square of the rate: measured are
        // 2.5e-4 and 5e-4 here, 8e-3 and 3e-2 below.
        check_free(*stiff, 23.0, [5e-4, 1e-3]);
        check_free(*stiff, 115.0, [0.02, 0.05]);
    }
}

#[test]
fn rest_is_that_of_the_energies() {
    for stiff in shapes() {
        let problem = cantilever([8, 2, 2], 1e4, stiff);
        let settings = Dynamics::default();
        let own = simulate(&problem, &settings);
        assert_eq!(own.status, Status::AtRest, "{}", own.residual);
        let finer = simulate(
            &problem,
            &Dynamics {
                time_step: 2e-3,
                substeps: Some(400),
                ..settings
            },
        );
        assert!(finer.substep < 0.5 * own.substep);
        let (own, finer) = (tip(&problem, &own), tip(&problem, &finer));
        assert!(
            norm(sub(own, finer)) < 3e-3 * norm(finer),
            "{own:?} {finer:?}"
        );
    }
}
