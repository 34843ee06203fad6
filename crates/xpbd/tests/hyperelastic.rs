//! Dynamics of hyperelastic voxels: frequency and decay of a bar, independent of the step.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use voxsoft_solid::{Body, Clamp, HyperelasticMaterial, Load, Mesh, PointForces, Problem, State};
use voxsoft_voxel::{Grid, tet_mesh};
use voxsoft_xpbd::{Damping, Dynamics, Status, simulate};

const YOUNG: f64 = 60e3;
const DENSITY: f64 = 1000.0;
const LENGTH: f64 = 0.2;

/// Bar of voxels held at x = 0 along x only, and on planes of symmetry along y and z, so that it stays uniaxial.
fn bar(material: HyperelasticMaterial, pull: f64) -> Problem {
    let side = 0.02;
    let mut grid = Grid::empty([10, 1, 1], [0.0; 3], side, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [LENGTH, side, side], 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let mesh = Mesh {
        tet_part: vec![0; tets.tets.len()],
        tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    };
    let chosen = |axis: usize, at: f64| -> Vec<u32> {
        let here = |v: &u32| (mesh.vertices[*v as usize][axis] - at).abs() < 1e-9;
        (0..mesh.vertices.len() as u32).filter(here).collect()
    };
    let slide = |axis: usize| Clamp {
        vertices: chosen(axis, 0.0),
        axes: [axis == 0, axis == 1, axis == 2],
        motion: None,
    };
    let end = chosen(0, LENGTH);
    let forces = vec![[pull / end.len() as f64, 0.0, 0.0]; end.len()];
    let load = Load::constant(PointForces {
        vertices: end,
        forces,
    });
    let body = Body::new(&mesh, &[material]).unwrap();
    Problem::new(body, (0..3).map(slide).collect(), vec![load], None).unwrap()
}

/// Times and amplitudes of the lowest mode of a bar released from it; the projection on the mode's shape excludes other
/// modes.
fn swing(material: HyperelasticMaterial, settings: &Dynamics) -> Vec<(f64, f64)> {
    let problem = bar(material, 0.0);
    let rest = problem.body().rest();
    let shape: Vec<f64> = rest
        .iter()
        .map(|x| (PI * x[0] / (2.0 * LENGTH)).sin())
        .collect();
    let mut start = State::at_rest(problem.body());
    for (x, s) in start.positions.iter_mut().zip(&shape) {
        x[0] += 1e-4 * s;
    }
    let mut seen = Vec::new();
    let answer = simulate(&problem, start, settings, &mut |now| {
        let moved = |v: usize| now.positions[v][0] - rest[v][0];
        let masses = problem.body().masses();
        let size = (0..rest.len())
            .map(|v| masses[v] * shape[v] * moved(v))
            .sum();
        seen.push((now.time, size));
        ControlFlow::Continue(())
    });
    assert_eq!(answer.status, Status::EndTime);
    seen
}

/// Frequency (rad/s) and decay (1/s) from the zero crossings and the peaks between them.
fn frequency_and_decay(seen: &[(f64, f64)]) -> (f64, f64) {
    let crossings: Vec<f64> = seen
        .windows(2)
        .filter(|w| w[0].1 * w[1].1 < 0.0)
        .map(|w| w[0].0 + (w[1].0 - w[0].0) * w[0].1 / (w[0].1 - w[1].1))
        .collect();
    let (first, last) = (crossings[0], crossings[crossings.len() - 1]);
    let halves = (crossings.len() - 1) as f64;
    let peak = |from: f64, to: f64| {
        seen.iter()
            .filter(|(t, _)| (from..to).contains(t))
            .map(|(_, x)| x.abs())
            .fold(0.0, f64::max)
    };
    let count = crossings.len();
    let (early, late) = (
        peak(crossings[0], crossings[1]),
        peak(crossings[count - 2], crossings[count - 1]),
    );
    let span = (count - 2) as f64 * (last - first) / halves;
    (PI * halves / (last - first), (early / late).ln() / span)
}

fn settings(step: f64, retardation: f64) -> Dynamics {
    Dynamics {
        time_step: step,
        damping: Damping::Rate(0.0),
        retardation,
        end_time: Some(0.5),
        ..Dynamics::default()
    }
}

#[test]
fn bar_frequency_matches_closed_form_for_any_step() {
    // Lowest mode of a rod: ω = π/2L √(E/ρ); ten voxels with lumped masses are 0.1 % slow, and ν = 0.45
    // adds lateral inertia (νπr/2L)²/2 with r² = side²/6: below 0.1 %.
    let expected = PI / (2.0 * LENGTH) * (YOUNG / DENSITY).sqrt();
    for substep_of in [0.004, 0.001] {
        let material = HyperelasticMaterial::neo_hookean(YOUNG, 0.45, DENSITY).unwrap();
        let (frequency, decay) = frequency_and_decay(&swing(material, &settings(substep_of, 0.0)));
        assert!(
            (frequency / expected - 1.0).abs() < 5e-3,
            "{frequency} {expected}"
        );
        assert!(decay.abs() < 0.02, "undamped, decays by {decay}/s");
    }
}

#[test]
fn kelvin_voigt_decay_is_half_the_squared_frequency() {
    // x'' + τω² x' + ω² x = 0 decays with τω²/2. For a bar the retarded part of E is the deviatoric one: all
    // but the part of the volume, E/9K = (1 − 2ν)/3 of the compliance.
    let poisson = 0.45;
    let omega = PI / (2.0 * LENGTH) * (YOUNG / DENSITY).sqrt();
    let retardation = 2e-3;
    let deviatoric = 1.0 - (1.0 - 2.0 * poisson) / 3.0;
    let expected = retardation * omega * omega / 2.0 * deviatoric;
    let decay = |step: f64| {
        let material = HyperelasticMaterial::neo_hookean(YOUNG, poisson, DENSITY).unwrap();
        frequency_and_decay(&swing(material, &settings(step, retardation))).1
    };
    let (long, short) = (decay(0.004), decay(0.001));
    assert!((long / short - 1.0).abs() < 0.02, "{long} {short}");
    assert!((short / expected - 1.0).abs() < 0.05, "{short} {expected}");
}

#[test]
fn prony_branches_creep_to_the_long_term_modulus() {
    // Bar under a sudden force: at once the strain of the instantaneous modulus E/(1 − g), in the end that of E.
    let (share, time) = (0.5, 0.05);
    let material = HyperelasticMaterial::neo_hookean(YOUNG, 0.45, DENSITY)
        .unwrap()
        .with_prony(vec![(share, time)])
        .unwrap();
    let force = 0.01 * YOUNG * 0.02 * 0.02;
    let problem = bar(material, force);
    let settings = Dynamics {
        end_time: Some(8.0 * time),
        damping: Damping::Rate(60.0),
        ..Dynamics::default()
    };
    let start = State::at_rest(problem.body());
    let mut stretch = Vec::new();
    let answer = simulate(&problem, start, &settings, &mut |now| {
        let x = now.positions.iter().map(|x| x[0]).fold(0.0, f64::max);
        stretch.push((now.time, x / LENGTH - 1.0));
        ControlFlow::Continue(())
    });
    assert_eq!(answer.status, Status::EndTime);
    let end = stretch[stretch.len() - 1].1;
    // e⁻⁸ is left of the creep; a strain of 1 % bends the stress curve by 1 %.
    assert!((end / 0.01 - 1.0).abs() < 0.03, "{end}");
    let early = stretch.iter().find(|(t, _)| *t > 0.02).unwrap().1;
    assert!(early < 0.8 * end, "{early} of {end} at once");
}
