//! Interactive runs: the equilibrium of `simulate`, and immediate response to loads and grabs.

mod common;

use common::{GRAVITY, beam, block, problem, simulate, where_};
use voxsoft_solid::balance::balance;
use voxsoft_solid::vector::{norm, sub};
use voxsoft_solid::{
    Body, Clamp, Filling, Floor, History, HyperelasticMaterial, LiveStatus, Load, Look, Mesh,
    Model, PointForces, Problem, Stepper,
};
use voxsoft_xpbd::{Damping, Dynamics, Live, Status};

/// Short beam of lattice voxels that sags.
fn stub() -> Problem {
    let mesh = block([6, 2, 2], 5e-3);
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    problem(
        &mesh,
        30e3,
        100e3,
        vec![clamp],
        vec![Load::gravity(GRAVITY)],
        None,
    )
}

/// Short beam of hyperelastic voxels that sags.
fn rubber_stub() -> Problem {
    let mesh = Mesh {
        block_fraction: vec![1.0; 24],
        block_filling: vec![Filling::FULL; 24],
        ..block([6, 2, 2], 5e-3)
    };
    let material =
        HyperelasticMaterial::new(Model::NeoHookean { c10: 10e3 }, 200e3, 1070.0).unwrap();
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    let body = Body::new(&mesh, &[material]).unwrap();
    Problem::new(body, vec![clamp], vec![Load::gravity(GRAVITY)], None).unwrap()
}

/// A corner of the free end.
fn corner(problem: &Problem) -> u32 {
    let rest = problem.body().rest();
    let far = |v: &usize| rest[*v][0] + rest[*v][1] + rest[*v][2];
    (0..rest.len())
        .max_by(|a, b| far(a).total_cmp(&far(b)))
        .unwrap() as u32
}

fn settle(live: &mut Live) -> Look {
    for _ in 0..2000 {
        let look = live.advance(500);
        if look.status != LiveStatus::Moving {
            return look;
        }
    }
    panic!("not at rest: {:?}", live.advance(0));
}

/// Largest distance between two sets of positions over the largest displacement of the second.
fn apart(problem: &Problem, a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let largest = |pairs: &mut dyn Iterator<Item = ([f64; 3], [f64; 3])>| {
        pairs.map(|(a, b)| norm(sub(a, b))).fold(0.0, f64::max)
    };
    let rest = problem.body().rest().iter().copied();
    largest(&mut a.iter().copied().zip(b.iter().copied()))
        / largest(&mut b.iter().copied().zip(rest))
}

#[test]
fn live_run_reaches_equilibrium_of_simulate() {
    for (case, problem) in [stub(), rubber_stub()].into_iter().enumerate() {
        let settings = Dynamics {
            tolerance: 1e-5,
            ..Dynamics::default()
        };
        let expected = simulate(&problem, &settings);
        assert_eq!(expected.status, Status::AtRest);
        let mut live = Live::new(problem.clone(), settings);
        let look = settle(&mut live);
        assert_eq!(look.status, LiveStatus::AtRest);
        // Both residuals are below 1e-5 of the load.
        let error = apart(&problem, &live.state().positions, &expected.state.positions);
        assert!(error < 1e-3, "case {case}: {error:.1e}");
        assert!(look.elastic > 0.0 && look.kinetic < 1e-5 * look.elastic);
        let asleep = live.advance(1000);
        assert_eq!(
            asleep.substeps, look.substeps,
            "a body at rest costs nothing"
        );
    }
}

#[test]
fn grab_balances_the_body_and_release_restores_it() {
    for (case, problem) in [stub(), rubber_stub()].into_iter().enumerate() {
        let vertex = corner(&problem) as usize;
        let settings = Dynamics {
            tolerance: 1e-6,
            ..Dynamics::default()
        };
        let mut live = Live::new(problem, settings);
        settle(&mut live);
        let before = live.state().positions.clone();
        for stiffness in [0.5, 50.0, 1e5] {
            let target = [
                before[vertex][0],
                before[vertex][1] + 4e-3,
                before[vertex][2],
            ];
            live.grab(7, vertex as u32, target, stiffness).unwrap();
            assert_eq!(settle(&mut live).status, LiveStatus::AtRest);
            let state = live.state();
            let force = live.grabs()[0].1.force(state.positions[vertex]);
            let body = balance(live.problem(), &state.positions, state.time).net[vertex];
            for axis in 0..3 {
                // The residual is below 1e-6 of the loads, the largest of which is the pull.
                let error = (force[axis] + body[axis]).abs();
                assert!(
                    error < 1e-5 * norm(force).max(1e-2),
                    "case {case}, {stiffness} N/m: {error:.1e} N"
                );
            }
            let left = norm(sub(target, state.positions[vertex]));
            assert!((norm(force) - stiffness * left).abs() < 1e-9 * norm(force));
            assert!(left < 4e-3);
        }
        assert!(live.release(7) && !live.release(7));
        settle(&mut live);
        let error = apart(live.problem(), &live.state().positions, &before);
        assert!(
            error < 1e-3,
            "case {case}: {error:.1e} off after letting go"
        );
    }
}

#[test]
fn any_grab_stiffness_is_stable() {
    for damping in [Damping::Critical, Damping::Rate(20.0)] {
        let problem = stub();
        let vertex = corner(&problem);
        let settings = Dynamics {
            damping,
            ..Dynamics::default()
        };
        let mut live = Live::new(problem, settings);
        let mut target = live.state().positions[vertex as usize];
        // The target is farther away than the body is thick.
        target[2] += 15e-3;
        live.grab(0, vertex, target, 1e12).unwrap();
        let look = settle(&mut live);
        assert_eq!((look.status, look.back_offs), (LiveStatus::AtRest, 0));
        let miss = norm(sub(live.state().positions[vertex as usize], target));
        assert!(miss < 1e-9, "{miss:.1e} m from the target");
    }
}

#[test]
fn grab_moves_and_two_may_hold_one_vertex() {
    let problem = stub();
    let vertex = corner(&problem);
    let mut live = Live::new(
        problem,
        Dynamics {
            tolerance: 1e-6,
            ..Dynamics::default()
        },
    );
    let at = live.state().positions[vertex as usize];
    let up = [at[0], at[1], at[2] + 3e-3];
    live.grab(0, vertex, up, 20.0).unwrap();
    live.grab(1, vertex, up, 30.0).unwrap();
    settle(&mut live);
    let by_two = live.state().positions.clone();
    live.reset();
    assert!(live.grabs().is_empty());
    live.grab(0, vertex, at, 50.0).unwrap();
    live.advance(100);
    live.grab(0, vertex, up, 50.0).unwrap();
    settle(&mut live);
    let error = apart(live.problem(), &live.state().positions, &by_two);
    assert!(error < 1e-3, "{error:.1e}");
}

#[test]
fn loads_change_at_once_and_restore_their_histories() {
    let mesh = block([6, 2, 2], 5e-3);
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    let end = where_(&mesh, |p| p[0] > 29e-3);
    let ramp = History::new(vec![0.0, 0.1], vec![0.0, 2.0]).unwrap();
    let push = |force: f64, history: History| Load {
        kind: PointForces {
            forces: vec![[0.0, force, 0.0]; end.len()],
            vertices: end.clone(),
        }
        .into(),
        history,
    };
    let loads = |load: Load| problem(&mesh, 30e3, 100e3, vec![clamp.clone()], vec![load], None);
    let settings = Dynamics {
        tolerance: 1e-5,
        ..Dynamics::default()
    };
    let plain = |force| {
        simulate(&loads(push(force, History::constant())), &settings)
            .state
            .positions
    };
    let (full, half) = (plain(2e-3), plain(1e-3));
    let mut live = Live::new(loads(push(1e-3, ramp)), settings.clone());
    let mut check = |factor: Option<Option<f64>>, expected: &[[f64; 3]]| {
        if let Some(factor) = factor {
            live.set_load(0, factor).unwrap();
        }
        assert_eq!(settle(&mut live).status, LiveStatus::AtRest);
        let error = apart(live.problem(), &live.state().positions, expected);
        assert!(error < 1e-3, "factor {factor:?}: {error:.1e}");
    };
    check(None, &full);
    check(Some(Some(0.5)), &half);
    check(Some(None), &full);
    assert!(live.set_load(1, None).is_err());
    assert!(live.set_load(0, Some(f64::NAN)).is_err());
}

/// A step far too long blows up and is halved until it is stable; one that no halving stabilizes is reported.
#[test]
fn too_long_step_is_halved_and_hopeless_step_is_reported() {
    let long = |substeps| Dynamics {
        time_step: 0.02,
        substeps: Some(substeps),
        ..Dynamics::default()
    };
    let mesh = block([6, 2, 2], 5e-3);
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    let stiff = problem(
        &mesh,
        30e3,
        3e6,
        vec![clamp],
        vec![Load::gravity(GRAVITY)],
        None,
    );
    let expected = simulate(&stiff, &Dynamics::default());
    let mut live = Live::new(stiff.clone(), long(8));
    let look = settle(&mut live);
    assert!(look.status == LiveStatus::AtRest && look.back_offs > 0);
    let error = apart(&stiff, &live.state().positions, &expected.state.positions);
    assert!(error < 1e-2, "{error:.1e}");

    let mut live = Live::new(
        stiff,
        Dynamics {
            time_step: 1e3,
            substeps: Some(1),
            ..Dynamics::default()
        },
    );
    let look = settle(&mut live);
    assert_eq!(look.status, LiveStatus::Diverged);
    assert!(look.breakdown.is_some());
    assert!(
        live.state()
            .positions
            .iter()
            .flatten()
            .all(|x| x.is_finite())
    );
    live.reset();
    assert_eq!(live.advance(0).status, LiveStatus::Moving);
}

#[test]
fn seek_continues_from_given_positions() {
    let problem = beam(20e3, 100e3);
    let mut live = Live::new(problem, Dynamics::default());
    settle(&mut live);
    let (rest, time) = (live.state().positions.clone(), live.state().time);
    live.reset();
    assert_eq!((live.state().time, live.advance(0).substeps), (0.0, 0));
    live.advance(50);
    live.seek(rest.clone(), time).unwrap();
    // The body was at rest there, and is so again at the first check.
    let look = live.advance(64);
    assert_eq!(look.status, LiveStatus::AtRest);
    assert!(apart(live.problem(), &live.state().positions, &rest) < 1e-3);
    assert!(live.seek(vec![[0.0; 3]], 0.0).is_err());
    assert!(live.seek(vec![[f64::NAN; 3]; rest.len()], 0.0).is_err());
    assert!(live.grab(0, rest.len() as u32, [0.0; 3], 1.0).is_err());
    assert!(live.grab(0, 0, [0.0; 3], 0.0).is_err());
}

/// Identical bits for any number of threads and any split into calls, on strips and with a grab; the deterministic mode
/// differs from the fast one by rounding alone.
#[test]
fn bits_are_independent_of_threads_and_calls() {
    // Sixteen layers make four slabs and more.
    let mesh = block([16, 4, 4], 5e-3);
    let clamp = Clamp::fixed(where_(&mesh, |p| p[0] < 1e-9));
    let floor = Some(Floor { z: -0.01 });
    let run = |threads: usize, piece: u32, deterministic: bool| {
        let problem = problem(
            &mesh,
            30e3,
            100e3,
            vec![clamp.clone()],
            vec![Load::gravity(GRAVITY)],
            floor,
        );
        let vertex = corner(&problem);
        let settings = Dynamics {
            damping: Damping::Rate(5.0),
            deterministic,
            ..Dynamics::default()
        };
        let mut live = Live::new(problem, settings);
        let mut target = live.state().positions[vertex as usize];
        target[1] += 5e-3;
        live.grab(0, vertex, target, 40.0).unwrap();
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            for _ in 0..240 / piece {
                live.advance(piece);
            }
        });
        live.state().positions.clone()
    };
    for deterministic in [false, true] {
        let one = run(1, 240, deterministic);
        for (threads, piece) in [(1, 3), (2, 240), (4, 60), (7, 240)] {
            assert!(
                one == run(threads, piece, deterministic),
                "{threads} threads, {piece} at a time"
            );
        }
    }
    let problem = problem(&mesh, 30e3, 100e3, vec![], vec![], None);
    // 240 substeps of rounding 1e-16 to 1e-12, as in `strips_and_vertices_agree_in_motion`.
    let error = apart(&problem, &run(1, 240, true), &run(1, 240, false));
    assert!(error < 1e-10, "{error:.1e}");
}
