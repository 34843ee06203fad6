//! Softening of voxels that were stretched more before (Mullins effect).

use proptest::prelude::*;
use voxsoft_solid::conformance::check_term;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Body, HyperelasticMaterial, Mesh, Model, Mullins, Problem, Softening, elastic,
};
use voxsoft_voxel::{Grid, tet_mesh};

/// A bar of 2 × 1 × 1 voxels of edge 1.
fn bar() -> Mesh {
    let mut grid = Grid::empty([2, 1, 1], [0.0; 3], 1.0, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [2.0, 1.0, 1.0], 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let count = tets.tets.len();
    Mesh {
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        tet_part: vec![0; count],
        tet_block: (0..count as u32).map(|t| t / 5).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    }
}

fn rubber(model: Model) -> HyperelasticMaterial {
    HyperelasticMaterial::new(model, 100.0, 1.0).unwrap()
}

const YEOH: Model = Model::Yeoh {
    c: [1.0, 0.1, 0.01],
};
const OGDEN: Model = Model::Ogden {
    terms: [(1.5, 2.2), (0.2, -1.8), (0.0, 0.0)],
};

fn soft(model: Model, first: f64) -> HyperelasticMaterial {
    rubber(model).with_softening(Softening::Mullins(
        Mullins::new(1.6, 0.02, 0.2, first).unwrap(),
    ))
}

fn problem(material: HyperelasticMaterial) -> Problem {
    let body = Body::new(&bar(), &[material]).unwrap();
    Problem::new(body, vec![], vec![], None).unwrap()
}

/// Positions of a bar drawn along x at constant volume, and bent.
fn drawn(problem: &Problem, stretch: f64, bend: f64) -> Vec<Vec3> {
    let thin = stretch.powf(-0.5);
    let place = |x: &Vec3| {
        let up = thin * x[2] + bend * x[0] * x[0];
        [stretch * x[0] - 2.0 * bend * x[0] * x[2], thin * x[1], up]
    };
    problem.body().rest().iter().map(place).collect()
}

fn accept(problem: &mut Problem, positions: &[Vec3]) {
    problem.accept_loads(positions, &|_| 1.0);
}

fn forces(problem: &Problem, positions: &[Vec3]) -> Vec<Vec3> {
    let mut forces = vec![[0.0; 3]; positions.len()];
    elastic::add_forces(problem.body(), positions, &mut forces);
    forces
}

fn largest_difference(a: &[Vec3], b: &[Vec3]) -> f64 {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Derivatives, rigid motion, pattern, bounds and threads on both sides of the peak, near enough to it for `ψ''` to
    /// matter.
    #[test]
    fn softened_voxels_are_a_term(
        moves in prop::collection::vec(prop::array::uniform3(-0.08..0.08), 12),
        stretch in prop_oneof![Just(1.0), Just(1.4)],
        ogden in any::<bool>(),
    ) {
        let mullins = Mullins::new(1.6, 0.02, 1.0, 0.0).unwrap();
        let mut problem = problem(rubber(if ogden { OGDEN } else { YEOH }).with_softening(Softening::Mullins(mullins)));
        let there = drawn(&problem, stretch, 0.05);
        accept(&mut problem, &there);
        let rest = problem.body().rest();
        let places: Vec<Vec3> = rest
            .iter()
            .zip(&moves)
            .map(|(x, m)| std::array::from_fn(|k| 1.1 * x[k] + m[k]))
            .collect();
        check_term(problem.body().hex8_term(), rest, &places).unwrap();
    }
}

#[test]
fn first_loading_is_virgin_and_unloading_is_softer() {
    for model in [YEOH, OGDEN] {
        let (mut soft, hard) = (problem(soft(model, 0.0)), problem(rubber(model)));
        let mut virgin = Vec::new();
        for stretch in [1.1, 1.3, 1.5] {
            let there = drawn(&soft, stretch, 0.05);
            let (found, plain) = (forces(&soft, &there), forces(&hard, &there));
            // Scalar code and lanes round differently.
            assert!(largest_difference(&found, &plain) < 1e-12);
            accept(&mut soft, &there);
            assert!(largest_difference(&forces(&soft, &there), &plain) < 1e-12);
            virgin.push(plain);
        }
        let back = drawn(&soft, 1.3, 0.05);
        let softer = forces(&soft, &back);
        assert!(largest_difference(&softer, &virgin[1]) > 0.1);
        // The second loading follows the unloading of the first.
        let unloaded = drawn(&soft, 1.0, 0.0);
        accept(&mut soft, &unloaded);
        assert_eq!(forces(&soft, &back), softer);
        let (own, memory) = (soft.clone(), soft.memory());
        soft.start_loads();
        assert!(largest_difference(&forces(&soft, &back), &virgin[1]) < 1e-12);
        assert_eq!(forces(&own, &back), softer);
        soft.remember(&memory);
        assert_eq!(forces(&soft, &back), softer);
        assert_eq!(soft.memory(), own.memory());
    }
}

#[test]
fn initial_peak_softens_from_the_beginning() {
    let mut before = problem(soft(YEOH, 0.0));
    let far = drawn(&before, 1.5, 0.0);
    accept(&mut before, &far);
    let peaks = before.body().hex8_term().peaks().unwrap();
    assert!((peaks[0] - peaks[1]).abs() < 1e-12);
    let conditioned = problem(soft(YEOH, peaks[0]));
    let there = drawn(&before, 1.2, 0.03);
    let pair = [&before, &conditioned].map(|problem| forces(problem, &there));
    assert!(largest_difference(&pair[0], &pair[1]) < 1e-12);
    assert!(problem(rubber(YEOH)).body().hex8_term().peaks().is_none());
    assert!(before.depends_on_way() && !problem(rubber(YEOH)).depends_on_way());
}
