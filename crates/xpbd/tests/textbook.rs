//! Sweep on strips against the textbook loop, with constraints in the same order.

#[path = "../examples/textbook/mod.rs"]
mod textbook;

mod common;

use common::{beam, block, problem, where_};
use textbook::Textbook;
use voxsoft_solid::lattice::strips::{Columns, Strips, Sweep};
use voxsoft_solid::vector::{Vec3, axpy, norm, scale, sub};
use voxsoft_solid::{Clamp, Problem};

const GRAVITY: Vec3 = [0.0, 0.0, -9.81];

/// Takes the textbook's substeps on strips.
fn on_strips(problem: &Problem, strips: &Strips, substeps: usize, h: f64) -> Vec<Vec3> {
    let body = problem.body();
    let mut positions = Columns::zeros(strips.slots());
    let (mut start, mut inverse_masses) = (positions.clone(), positions.clone());
    let weight = |(mass, held): (&f64, &[bool; 3])| held.map(|h| if h { 0.0 } else { 1.0 / mass });
    let weights: Vec<Vec3> = body
        .masses()
        .iter()
        .zip(problem.held())
        .map(weight)
        .collect();
    strips.load(&weights, &mut inverse_masses);
    let mut rows = body.rest().to_vec();
    let mut before = rows.clone();
    let mut velocities = vec![[0.0; 3]; rows.len()];
    for _ in 0..substeps {
        before.copy_from_slice(&rows);
        for (vertex, row) in rows.iter_mut().enumerate() {
            if weights[vertex][0] > 0.0 {
                axpy(&mut velocities[vertex], h, GRAVITY);
                axpy(row, h, velocities[vertex]);
            }
        }
        strips.load(&rows, &mut positions);
        strips.load(&before, &mut start);
        strips.sweep(Sweep {
            positions: &mut positions,
            start: &start,
            inverse_masses: &inverse_masses,
            isotropic: true,
            multipliers: &mut vec![0.0; strips.places()],
            keep: false,
            substep: h,
            retardation: 0.0,
        });
        strips.store(&positions, &mut rows);
        for (vertex, row) in rows.iter().enumerate() {
            velocities[vertex] = scale(1.0 / h, sub(*row, before[vertex]));
        }
    }
    rows
}

#[test]
fn sweep_on_strips_matches_textbook() {
    let mesh = block([13, 12, 14], 5e-3);
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    let block = problem(&mesh, 27e3, 100e3, vec![clamp], vec![], None);
    for problem in [beam(27e3, 100e3), block] {
        let strips = Strips::of(problem.body()).unwrap();
        let mut oracle = Textbook::in_order(&problem, GRAVITY, strips.order().collect());
        for _ in 0..50 {
            oracle.substep(5e-4, 0.0);
        }
        let rows = on_strips(&problem, &strips, 50, 5e-4);
        let rest = problem.body().rest();
        let (mut apart, mut moved) = (0.0, 0.0);
        for (vertex, row) in rows.iter().enumerate() {
            let expected = oracle.state.positions[vertex];
            apart = f64::max(apart, norm(sub(*row, expected)));
            moved = f64::max(moved, norm(sub(expected, rest[vertex])));
        }
        // Positions of 0.1 m are rounded to 1e-17 m, fifty times, and forces propagate the error.
        assert!(moved > 1e-3, "the body sinks by {moved} m");
        assert!(apart / moved < 1e-11, "{:.1e}", apart / moved);
    }
}

#[test]
fn mesh_order_takes_each_constraint_once() {
    let problem = beam(27e3, 100e3);
    let mut listed = Textbook::new(&problem, GRAVITY);
    let mut sorted = Textbook::new(&problem, GRAVITY);
    sorted.sort();
    for _ in 0..10 {
        listed.substep(5e-4, 1.0);
        sorted.substep(5e-4, 1.0);
    }
    assert_eq!(listed.state, sorted.state);
}
