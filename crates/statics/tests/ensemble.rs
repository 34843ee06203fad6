//! Many candidates at a time: same results as one by one, independent of the other lanes.

mod common;

use common::{block, cantilever, settled, vertices_where};
use proptest::prelude::*;
use voxsoft_solid::vector::{norm, sub};
use voxsoft_solid::{Body, Clamp, LatticeMaterial, Load, PointForces, Pressure, Problem};
use voxsoft_statics::{Ensemble, Settings, Status, Variant};

const EDGE: f64 = 25e3;
const BULK: f64 = 100e3;

fn lattice(edge: f64, bulk: f64) -> LatticeMaterial {
    LatticeMaterial::from_moduli(edge, bulk, 1070.0).unwrap()
}

fn variant(edge: f64, bulk: f64) -> Variant {
    Variant {
        edge,
        bulk,
        weight: 1.0,
        forces: 1.0,
    }
}

/// Variants from beams that hardly bend to ropes, more than one for each lane of any processor.
fn variants() -> Vec<Variant> {
    let edges = [40.0, 11.0, 3.0, 1.0, 0.4, 0.2, 0.08, 0.05];
    let bulks = [9.0, 1.0, 0.02];
    let pair = |bulk: f64| edges.map(|edge| variant(edge, bulk));
    bulks.into_iter().flat_map(pair).collect()
}

#[test]
fn lanes_agree_with_the_single_solver() {
    let problem = cantilever([20, 2, 2], 5e-3, lattice(EDGE, BULK));
    let ensemble = Ensemble::of(&problem).unwrap();
    let variants = variants();
    let found = ensemble.settle(&variants, 1e-8, &|| false);
    for (variant, found) in variants.iter().zip(&found) {
        assert_eq!(found.status, Status::AtRest, "{variant:?}");
        let material = lattice(variant.edge * EDGE, variant.bulk * BULK);
        let alone = settled(
            &cantilever([20, 2, 2], 5e-3, material),
            &Settings::default(),
        );
        assert_eq!(alone.status, Status::AtRest);
        let rest = problem.body().rest();
        let tip = |positions: &[[f64; 3]]| sub(positions[rest.len() - 1], rest[rest.len() - 1]);
        let off = norm(sub(tip(&found.positions), tip(&alone.positions)));
        // Both leave 1e-8 of the load; the softest mode of a beam turns that into no more of its sag.
        assert!(
            off <= 1e-6 * norm(tip(&alone.positions)),
            "{variant:?}: {off}"
        );
    }
}

#[test]
fn bits_are_independent_of_lanes_and_threads() {
    let problem = cantilever([12, 2, 1], 5e-3, lattice(EDGE, BULK));
    let ensemble = Ensemble::of(&problem).unwrap();
    let variants = variants();
    let pool = |threads: usize| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let run = |threads: usize, variants: &[Variant]| {
        let pool = pool(threads).unwrap();
        pool.install(|| ensemble.settle(variants, 1e-6, &|| false))
    };
    let together = run(1, &variants);
    assert_eq!(run(3, &variants), together);
    let backwards: Vec<Variant> = variants.iter().rev().copied().collect();
    let mut turned = run(2, &backwards);
    turned.reverse();
    assert_eq!(turned, together);
    for (variant, found) in variants.iter().zip(&together) {
        assert_eq!(run(1, &[*variant])[0], *found);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Clamps that hold some axes only, forces on vertices, other densities: compared with separate problems.
    #[test]
    fn loads_and_clamps_agree_with_separate_problems(
        held in prop::array::uniform3(any::<bool>()),
        (edge, bulk, weight, forces) in (0.5..2.0, 0.5..2.0, 0.5..2.0, -2.0..2.0),
        pull in prop::array::uniform3(-2e-3..2e-3),
    ) {
        let mesh = block([6, 2, 2], 5e-3);
        let wall = Clamp::fixed(vertices_where(&mesh, |x| x[0] < 1e-9));
        let far = vertices_where(&mesh, |x| x[0] > 0.0299);
        let guide = Clamp { vertices: far.clone(), axes: held, motion: None };
        let problem = |edge: f64, bulk: f64, weight: f64, forces: f64| {
            let body = Body::new(&mesh, &[lattice(edge * EDGE, bulk * BULK)]).unwrap();
            let loads = vec![
                Load::gravity([0.0, 0.0, -9.81 * weight]),
                Load::constant(PointForces {
                    vertices: far.clone(),
                    forces: vec![pull.map(|f| f * forces); far.len()],
                }),
            ];
            Problem::new(body, vec![wall.clone(), guide.clone()], loads, None).unwrap()
        };
        let shared = problem(1.0, 1.0, 1.0, 1.0);
        let ensemble = Ensemble::of(&shared).unwrap();
        let variant = Variant { edge, bulk, weight, forces };
        let found = &ensemble.settle(&[variant], 1e-9, &|| false)[0];
        let alone = settled(&problem(edge, bulk, weight, forces), &Settings::default());
        prop_assert_eq!(found.status, alone.status);
        for (a, b) in found.positions.iter().zip(&alone.positions) {
            // Positions of a body of 30 mm; residual forces are a millionth of those that move it by a micrometer.
            prop_assert!(norm(sub(*a, *b)) < 1e-9, "{:?} {:?}", a, b);
        }
    }
}

#[test]
fn unsupported_problems_are_refused() {
    let mesh = block([2, 1, 1], 5e-3);
    let wall = Clamp::fixed(vertices_where(&mesh, |x| x[0] < 1e-9));
    let body = || Body::new(&mesh, &[lattice(EDGE, BULK)]).unwrap();
    let pressure = Load::constant(Pressure {
        triangles: vec![[0, 1, 2]],
        voids: vec![],
        pressure: 1.0,
        closed: false,
    });
    let floor = Some(voxsoft_solid::Floor { z: -1.0 });
    let problem = |loads, floor| Problem::new(body(), vec![wall.clone()], loads, floor).unwrap();
    assert!(Ensemble::of(&problem(vec![], None)).is_some());
    assert!(Ensemble::of(&problem(vec![pressure], None)).is_none());
    assert!(Ensemble::of(&problem(vec![], floor)).is_none());
    let rubber = cantilever([2, 1, 1], 5e-3, common::rubber());
    assert!(Ensemble::of(&rubber).is_none());
}

#[test]
fn stop_cancels_remaining_candidates() {
    let problem = cantilever([6, 1, 1], 5e-3, lattice(EDGE, BULK));
    let ensemble = Ensemble::of(&problem).unwrap();
    let found = ensemble.settle(&variants(), 1e-6, &|| true);
    assert!(found.iter().all(|f| f.status == Status::Cancelled));
    assert!(ensemble.settle(&[], 1e-6, &|| false).is_empty());
}

#[test]
fn mechanism_is_left_to_the_single_solver() {
    // A single voxel held at one vertex is a mechanism.
    let mesh = block([1, 1, 1], 5e-3);
    let body = Body::new(&mesh, &[lattice(EDGE, BULK)]).unwrap();
    let loads = vec![Load::gravity([0.0, 0.0, -9.81])];
    let problem = Problem::new(body, vec![Clamp::fixed(vec![0])], loads, None).unwrap();
    let found = Ensemble::of(&problem)
        .unwrap()
        .settle(&[variant(1.0, 1.0)], 1e-6, &|| false);
    assert_eq!(found[0].status, Status::NotConverged);
}
