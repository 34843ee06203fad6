//! Conformance of relaxation, dynamics and live runs to the laws of solvers and steppers.

mod common;

use common::{GRAVITY, block, problem, where_};
use voxsoft_solid::conformance::{check_solver, check_stepper};
use voxsoft_solid::{Attachment, Body, Clamp, Floor, HyperelasticMaterial, Load, Problem};
use voxsoft_solid::{Spring, Springs, Stepper};
use voxsoft_xpbd::{Dynamics, Live, Relaxation};

fn rubber() -> Problem {
    let mesh = block([6, 2, 2], 5e-3);
    let rubber = HyperelasticMaterial::neo_hookean(60e3, 0.4, 1070.0).unwrap();
    let body = Body::new(&mesh, &[rubber]).unwrap();
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    Problem::new(body, vec![clamp], vec![Load::gravity(GRAVITY)], None).unwrap()
}

/// Short beam, which swings fast and is soon at rest.
fn lattice() -> Problem {
    let mesh = block([6, 2, 2], 5e-3);
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    let gravity = vec![Load::gravity(GRAVITY)];
    problem(&mesh, 60e3, 400e3, vec![clamp], gravity, None)
}

/// Block that lies on a floor.
fn lying() -> Problem {
    let mesh = block([4, 4, 3], 5e-3);
    let mut clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    clamp.axes = [true, true, false];
    let floor = Some(Floor { z: 0.0 });
    problem(
        &mesh,
        60e3,
        400e3,
        vec![clamp],
        vec![Load::gravity(GRAVITY)],
        floor,
    )
}

/// Short beam with a spring to a fixed point, which is 25 mm from the beam's end at rest.
fn sprung(length: f64, loads: Vec<Load>) -> Problem {
    let mut mesh = block([6, 2, 2], 5e-3);
    let vertices = where_(&mesh, |p| p[0] > 30e-3 - 1e-9);
    let spring = Spring {
        weights: vec![1.0 / vertices.len() as f64; vertices.len()],
        vertices,
        anchor: [50e-3, 20e-3, 5e-3],
        length,
        stiffness: 2.0,
    };
    mesh.attachments = vec![Attachment::Springs(Springs(vec![spring]))];
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    problem(&mesh, 60e3, 400e3, vec![clamp], loads, None)
}

#[test]
fn relaxation_conforms_to_solver() {
    let settings = Relaxation::default();
    for problem in [lattice(), lying(), rubber(), sprung(10e-3, vec![])] {
        check_solver(&settings, &problem, settings.tolerance).unwrap();
    }
}

#[test]
fn dynamics_conforms_to_solver() {
    let settings = Dynamics::default();
    for problem in [lattice(), lying(), rubber(), sprung(10e-3, vec![])] {
        check_solver(&settings, &problem, settings.tolerance).unwrap();
    }
}

#[test]
fn live_runs_conform_to_stepper() {
    // Bodies with hyperelastic voxels take the plain loops anyway.
    for (problem, deterministic) in [
        (lattice(), false),
        (lattice(), true),
        (rubber(), false),
        (sprung(25e-3, vec![Load::gravity(GRAVITY)]), false),
    ] {
        let settings = Dynamics {
            deterministic,
            ..Dynamics::default()
        };
        let make =
            || -> Box<dyn Stepper> { Box::new(Live::new(problem.clone(), settings.clone())) };
        check_stepper(&make, settings.tolerance).unwrap();
    }
}
