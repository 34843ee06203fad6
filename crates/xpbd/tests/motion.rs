//! Dynamics against closed forms.

mod common;

use std::ops::ControlFlow;

use common::{DENSITY, block, problem, simulate, where_};
use voxsoft_solid::vector::cross;
use voxsoft_solid::{
    Body, Clamp, History, HyperelasticMaterial, Load, PointForces, Problem, State,
};
use voxsoft_xpbd::{Damping, Dynamics, Status};

#[test]
fn free_body_falls_rigidly() {
    let mesh = block([3, 2, 2], 5e-3);
    let gravity = vec![Load::gravity(common::GRAVITY)];
    let problem = problem(&mesh, 20e3, 100e3, vec![], gravity, None);
    let end_time = 0.1;
    let settings = Dynamics {
        time_step: 1e-3,
        substeps: Some(10),
        damping: Damping::Rate(0.0),
        end_time: Some(end_time),
        ..Dynamics::default()
    };
    let answer = simulate(&problem, &settings);
    assert_eq!(answer.status, Status::EndTime);
    // Symplectic Euler falls g t (t + h)/2 exactly; the constraints keep the momentum, up to
    // rounding of 1000 steps.
    let fall = 9.81 * end_time * (end_time + 1e-4) / 2.0;
    for (position, rest) in answer.state.positions.iter().zip(problem.body().rest()) {
        assert!((rest[2] - position[2] - fall).abs() < 1e-9 * fall);
        assert!((position[0] - rest[0]).abs() < 1e-12);
    }
}

/// A turning body has unbalanced forces without any load: no reason for shorter substeps, which those that are too long
/// still are.
#[test]
fn free_body_turns_without_back_offs() {
    let mesh = block([8, 2, 2], 5e-3);
    let rubber = HyperelasticMaterial::neo_hookean(200e3, 0.45, 1000.0).unwrap();
    let body = Body::new(&mesh, &[rubber]).unwrap();
    let problem = Problem::new(body, vec![], vec![], None).unwrap();
    let turn = |substeps| {
        let mut start = State::at_rest(problem.body());
        for (v, x) in start.velocities.iter_mut().zip(problem.body().rest()) {
            *v = cross([5.0, 20.0, 10.0], *x);
        }
        let settings = Dynamics {
            time_step: 2e-3,
            substeps,
            damping: Damping::Rate(0.0),
            end_time: Some(0.1),
            ..Dynamics::default()
        };
        voxsoft_xpbd::simulate(&problem, start, &settings, &mut |_| {
            ControlFlow::Continue(())
        })
    };
    let own = turn(None);
    assert_eq!((own.status, own.back_offs), (Status::EndTime, 0));
    let coarse = turn(Some(10));
    assert!(coarse.back_offs > 0);
}

#[test]
fn axial_frequency_of_column_matches_closed_form() {
    // Axial vibration of a bar clamped at one end: f = c/(4 L), c² = E/ρ for a slender bar.
    let (h, edge, bulk) = (5e-3, 20e3, 20e3);
    let mesh = block([40, 2, 2], h);
    let length = 40.0 * h;
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    let end = where_(&mesh, |p| p[0] > length - 1e-9);
    let pull = vec![[1e-4, 0.0, 0.0]; end.len()];
    // Load history: pulled slowly, released at 1 s.
    let load = Load {
        kind: PointForces {
            vertices: end.clone(),
            forces: pull,
        }
        .into(),
        history: History::new(vec![0.0, 0.5, 1.0, 1.001], vec![0.0, 1.0, 1.0, 0.0]).unwrap(),
    };
    let problem = problem(&mesh, edge, bulk, vec![clamp], vec![load], None);
    let settings = Dynamics {
        time_step: 2e-3,
        damping: Damping::Rate(0.0),
        end_time: Some(2.0),
        record_interval: Some(2e-3),
        ..Dynamics::default()
    };
    let rest = problem.body().rest()[end[0] as usize][0];
    let mut track = Vec::new();
    let start = voxsoft_solid::State::at_rest(problem.body());
    voxsoft_xpbd::simulate(&problem, start, &settings, &mut |now| {
        if now.record && now.time > 1.0 {
            track.push((now.time, now.positions[end[0] as usize][0] - rest));
        }
        std::ops::ControlFlow::Continue(())
    });
    let crossings: Vec<f64> = track
        .windows(2)
        .filter(|w| w[0].1 > 0.0 && w[1].1 <= 0.0)
        .map(|w| w[0].0 + (w[1].0 - w[0].0) * w[0].1 / (w[0].1 - w[1].1))
        .collect();
    let period = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64;
    let material = voxsoft_solid::LatticeMaterial::from_moduli(edge, bulk, DENSITY).unwrap();
    let expected = 4.0 * length / (material.young(h) / DENSITY).sqrt();
    // The tolerance covers the clamp, which hinders lateral contraction, and the coarse section of two voxels.
    assert!(
        (period / expected - 1.0).abs() < 0.03,
        "{period} against {expected}"
    );
}
