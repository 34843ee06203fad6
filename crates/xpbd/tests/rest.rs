//! Equilibrium of the energies, independent of solver, step and start.

mod common;

use common::{beam, block, problem, relax, simulate, tip, where_};
use voxsoft_solid::balance::{balance, total_load};
use voxsoft_solid::vector::{norm, sub};
use voxsoft_solid::{Clamp, Floor, History, Load, Motion, Pressure, State};
use voxsoft_xpbd::{Damping, Dynamics, Relaxation, Status};

/// Required agreement of 0.1 %; the tolerance on the residual (1e-4) bounds the error of the softest mode by about that
/// much of the displacement.
const SAME: f64 = 1e-3;

#[test]
fn equilibrium_is_independent_of_step_substeps_sweeps_and_damping() {
    let problem = beam(20e3, 100e3);
    let reference = relax(
        &problem,
        &Relaxation {
            tolerance: 1e-7,
            ..Relaxation::default()
        },
    );
    assert_eq!(reference.status, Status::AtRest);
    let expected = tip(&problem, &reference);
    assert!(expected[2] < -0.05, "the beam sags: {expected:?}");

    let base = Dynamics {
        time_step: 0.02,
        substeps: Some(150),
        ..Dynamics::default()
    };
    let mut variants = Vec::new();
    for divisor in [2u32, 8] {
        let time_step = base.time_step / f64::from(divisor);
        variants.push(Dynamics {
            time_step,
            ..base.clone()
        });
    }
    for iterations in [1, 2, 5, 8] {
        variants.push(Dynamics {
            iterations,
            ..base.clone()
        });
    }
    variants.push(Dynamics {
        substeps: Some(75),
        iterations: 4,
        ..base.clone()
    });
    variants.push(Dynamics {
        substeps: None,
        ..base.clone()
    });
    variants.push(Dynamics {
        damping: Damping::Rate(15.0),
        ..base.clone()
    });
    variants.push(Dynamics {
        retardation: 1e-3,
        ..base.clone()
    });
    for settings in variants {
        let answer = simulate(&problem, &settings);
        assert_eq!(answer.status, Status::AtRest, "{settings:?}");
        let error = norm(sub(tip(&problem, &answer), expected)) / norm(expected);
        assert!(error < SAME, "{error:.1e} with {settings:?}");
    }
}

#[test]
fn too_long_step_is_halved_and_ends_at_the_same_rest() {
    let problem = beam(20e3, 1e6);
    let expected = tip(&problem, &relax(&problem, &Relaxation::default()));
    let coarse = Dynamics {
        time_step: 0.02,
        substeps: Some(10),
        ..Dynamics::default()
    };
    let answer = simulate(&problem, &coarse);
    assert_eq!(answer.status, Status::AtRest);
    assert!(answer.back_offs > 0, "2 ms substeps are far beyond stable");
    assert!(norm(sub(tip(&problem, &answer), expected)) / norm(expected) < SAME);
}

#[test]
fn reactions_balance_the_loads() {
    let problem = beam(20e3, 100e3);
    let answer = relax(
        &problem,
        &Relaxation {
            tolerance: 1e-5,
            ..Relaxation::default()
        },
    );
    let positions = &answer.state.positions;
    let (load, moment) = total_load(&problem, positions, f64::INFINITY);
    let support = balance(&problem, positions, f64::INFINITY);
    let weight = 9.81 * problem.body().total_mass();
    assert!((norm(load) / weight - 1.0).abs() < 1e-12);
    // Sum of residual forces: at most the residual times the root of the number of vertices.
    let force_error = norm(voxsoft_solid::vector::add(support.total_reaction(), load));
    assert!(force_error / weight < 1e-3, "{force_error}");
    let turn = voxsoft_solid::vector::add(support.total_moment(positions), moment);
    assert!(norm(turn) / norm(moment) < 1e-3, "{turn:?}");
}

#[test]
fn floor_carries_weight_without_friction() {
    let h = 5e-3;
    let mesh = block([4, 4, 4], h);
    let gravity = vec![Load::gravity(common::GRAVITY)];
    let problem = problem(&mesh, 20e3, 100e3, vec![], gravity, Some(Floor { z: 0.0 }));
    let by_relaxation = relax(&problem, &Relaxation::default());
    let by_dynamics = simulate(&problem, &Dynamics::default());
    for answer in [by_relaxation, by_dynamics] {
        assert_eq!(answer.status, Status::AtRest);
        let positions = &answer.state.positions;
        assert!(positions.iter().all(|p| p[2] >= 0.0));
        let support = balance(&problem, positions, f64::INFINITY).total_reaction();
        let weight = 9.81 * problem.body().total_mass();
        assert!((support[2] / weight - 1.0).abs() < 1e-3, "{support:?}");
        // Without friction no sideways force acts on the sole, and it spreads.
        assert!(support[0].abs() < 1e-9 && support[1].abs() < 1e-9);
        let sole = where_(&mesh, |p| p[2] < 1e-9);
        let spread = |axis: usize| {
            let at = |v: &u32| positions[*v as usize][axis];
            sole.iter().map(at).fold(f64::NEG_INFINITY, f64::max)
                - sole.iter().map(at).fold(f64::INFINITY, f64::min)
        };
        assert!(spread(0) > 4.0 * h && spread(1) > 4.0 * h);
    }
}

#[test]
fn prescribed_stretch_matches_closed_form() {
    // Bar pulled along x by the strain 1e-4 with free sides: F = E ε A, and its sides shrink by ν ε.
    let (h, edge, bulk, strain) = (2e-3, 20e3, 50e3, 1e-4);
    let mesh = block([12, 4, 4], h);
    let length = 12.0 * h;
    let along_x = [true, false, false];
    let motion = Motion {
        displacement: [strain * length, 0.0, 0.0],
        axis: [1.0, 0.0, 0.0],
        angle: 0.0,
        center: [0.0; 3],
        history: History::constant(),
        courses: None,
    };
    let left = where_(&mesh, |p| p[0] < 1e-9);
    let right = where_(&mesh, |p| p[0] > length - 1e-9);
    let pinned = vec![left[0]];
    let clamps = vec![
        Clamp {
            vertices: left,
            axes: along_x,
            motion: None,
        },
        Clamp {
            vertices: pinned,
            axes: [true; 3],
            motion: None,
        },
        Clamp {
            vertices: right.clone(),
            axes: along_x,
            motion: Some(motion),
        },
    ];
    let problem = problem(&mesh, edge, bulk, clamps, vec![], None);
    let answer = relax(
        &problem,
        &Relaxation {
            tolerance: 1e-6,
            ..Relaxation::default()
        },
    );
    assert_eq!(answer.status, Status::AtRest);
    let reactions = balance(&problem, &answer.state.positions, f64::INFINITY).reactions;
    let pull: f64 = right.iter().map(|&v| reactions[v as usize][0]).sum();
    let material = voxsoft_solid::LatticeMaterial::from_moduli(edge, bulk, 1.0).unwrap();
    let area = (4.0 * h) * (4.0 * h);
    let modulus = pull / area / strain;
    // The lattice is centrosymmetric inside; at its surface corners relax, which the share keeps
    // small: 1 % at four voxels through the thickness, shrinking with their number.
    assert!(
        (modulus / material.young(h) - 1.0).abs() < 0.02,
        "{modulus} {}",
        material.young(h)
    );
}

#[test]
fn excessive_pressure_diverges_with_place_and_time() {
    let mut grid = voxsoft_voxel::Grid::empty([5, 5, 5], [0.0; 3], 5e-3, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [25e-3; 3], 1);
    grid.fill_box([5e-3; 3], [20e-3; 3], 0);
    let tets = voxsoft_voxel::tet_mesh(&grid, u64::MAX).unwrap();
    let mesh = voxsoft_solid::Mesh {
        vertices: tets.vertices.clone(),
        tets: tets.tets.iter().map(|tet| tet.map(|v| v as u32)).collect(),
        tet_part: vec![0; tets.tets.len()],
        tet_block: (0..tets.tets.len() as u32).map(|tet| tet / 5).collect(),
        ..voxsoft_solid::Mesh::default()
    };
    let triangles: Vec<[u32; 3]> = tets.cavities[0]
        .triangles
        .iter()
        .map(|t| t.map(|v| v as u32))
        .collect();
    let clamp = Clamp::fixed(where_(&mesh, |p| p[2] < 1e-9));
    let inflate = |pressure| {
        let load = Pressure {
            voids: Vec::new(),
            triangles: triangles.clone(),
            pressure,
            closed: false,
        };
        problem(
            &mesh,
            10e3,
            20e3,
            vec![clamp.clone()],
            vec![Load::constant(load)],
            None,
        )
    };
    let gentle = inflate(1e3);
    assert_eq!(
        relax(&gentle, &Relaxation::default()).status,
        Status::AtRest
    );
    let brutal = inflate(100e3);
    for answer in [
        relax(&brutal, &Relaxation::default()),
        simulate(
            &brutal,
            &Dynamics {
                max_time: 5.0,
                ..Dynamics::default()
            },
        ),
    ] {
        assert_eq!(
            answer.status,
            Status::Diverged,
            "residual {} steps {} back-offs {}",
            answer.residual,
            answer.steps,
            answer.back_offs
        );
        let breakdown = answer.breakdown.unwrap();
        assert!(breakdown.when >= 0.0 && breakdown.rest[2] > 0.0);
        assert!(
            answer
                .state
                .positions
                .iter()
                .flatten()
                .all(|x| x.is_finite())
        );
    }
}

#[test]
fn crumpled_body_unfolds() {
    // Vertices displaced by up to 0.6 of a voxel invert many of the tetrahedra.
    let h = 5e-3;
    let mesh = block([4, 2, 2], h);
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    let problem = problem(&mesh, 20e3, 200e3, vec![clamp], vec![], None);
    let body = problem.body();
    let mut crumpled = State::at_rest(body);
    for (vertex, position) in crumpled.positions.iter_mut().enumerate() {
        let free = body.rest()[vertex][0] > 1e-9;
        for axis in 0..3 {
            let noise = ((vertex * 3 + axis) as f64 * 0.754_877_666).fract() - 0.5;
            position[axis] += if free { 1.2 * h * noise } else { 0.0 };
        }
    }
    let inverted = |state: &State| {
        let volume = |tet: &voxsoft_solid::Tet| tet.evaluate(&state.positions).0 + tet.volume;
        body.tets().iter().filter(|tet| volume(tet) <= 0.0).count()
    };
    assert!(
        inverted(&crumpled) > 5,
        "{} inside out",
        inverted(&crumpled)
    );
    let watch = &mut |_: &voxsoft_solid::Progress<'_>| std::ops::ControlFlow::Continue(());
    let unfolded = [
        voxsoft_xpbd::relax(&problem, crumpled.clone(), &Relaxation::default(), watch),
        voxsoft_xpbd::simulate(&problem, crumpled, &Dynamics::default(), watch),
    ];
    for answer in unfolded {
        assert_eq!(answer.status, Status::AtRest);
        assert_eq!(inverted(&answer.state), 0);
        for (position, rest) in answer.state.positions.iter().zip(body.rest()) {
            assert!(norm(sub(*position, *rest)) < 1e-4 * h);
        }
    }
}
