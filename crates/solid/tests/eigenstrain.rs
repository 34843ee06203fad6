//! Voxels with growth, each with its share of the free stretch.

use proptest::prelude::*;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Body, Eigenstrain, EigenstrainFactor, History, HyperelasticMaterial, Mesh, Model, Problem,
    Share, Term, elastic,
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

fn problem(model: Model, strain: f64, power: f64, shares: [[f64; 4]; 2]) -> Problem {
    let factor = EigenstrainFactor {
        history: History::new(vec![0.0], vec![1.0 + strain]).unwrap(),
        power,
        share: Share::Field(shares.into()),
        number: 0,
    };
    let eigenstrain = Eigenstrain::new(vec![factor]).unwrap();
    let material = HyperelasticMaterial::new(model, 20.0, 1.0).unwrap();
    let grown = material.with_eigenstrain(eigenstrain, Eigenstrain::none());
    let body = Body::new(&bar(), &[grown]).unwrap();
    Problem::new(body, vec![], vec![], None).unwrap()
}

const YEOH: Model = Model::Yeoh {
    c: [1.0, 0.1, 0.01],
};
const OGDEN: Model = Model::Ogden {
    terms: [(1.5, 2.2), (0.2, -1.8), (0.0, 0.0)],
};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Derivatives only, not all laws of a term: grown voxels have stress at rest.
    #[test]
    fn forces_and_stiffness_of_grown_voxels_are_derivatives(
        moves in prop::collection::vec(prop::array::uniform3(-0.08..0.08), 12),
        ways in prop::collection::vec(prop::array::uniform3(-1.0..1.0), 12),
        slopes in prop::array::uniform3(-0.5..0.5),
        power in prop_oneof![Just(1.0), Just(1.0 / 3.0)],
        ogden in any::<bool>(),
    ) {
        let [x, y, z] = slopes;
        let model = if ogden { OGDEN } else { YEOH };
        let problem = problem(model, 0.2, power, [[-0.4, x, y, z], [1.2, z, x, y]]);
        let along = |part: f64| -> Vec<Vec3> {
            let rest = problem.body().rest().iter().zip(&moves).zip(&ways);
            rest.map(|((r, m), w)| std::array::from_fn(|k| r[k] + m[k] + part * w[k])).collect()
        };
        let energy = |part: f64| elastic::energy(problem.body(), &along(part));
        let forces = |part: f64| {
            let mut forces = vec![[0.0; 3]; ways.len()];
            elastic::add_forces(problem.body(), &along(part), &mut forces);
            forces
        };
        let inner = |a: &[Vec3]| -> f64 {
            a.as_flattened().iter().zip(ways.as_flattened()).map(|(a, b)| a * b).sum()
        };
        let mut bent = 0.0;
        problem.body().hex8_term().visit_stiffness(&along(0.0), &mut |vertices, matrix| {
            for (i, entry) in matrix.iter().enumerate() {
                let [row, column] = [i / 24, i % 24];
                let way = |place: usize| ways[vertices[place / 3] as usize][place % 3];
                bent += way(row) * entry * way(column);
            }
        });
        // A central difference has an error of the square of its step; energies and forces are of the order of one.
        let step = 1e-5;
        let slope = (energy(step) - energy(-step)) / (2.0 * step);
        let turn = (inner(&forces(-step)) - inner(&forces(step))) / (2.0 * step);
        prop_assert!((slope + inner(&forces(0.0))).abs() < 1e-6 * (1.0 + slope.abs()));
        prop_assert!((turn - bent).abs() < 1e-6 * (1.0 + bent.abs()), "{turn} {bent}");
    }
}

#[test]
fn share_gradient_across_the_bar_bends_it() {
    // Free of stress a strain of s z is the arc u = s (x z, y z, (z² − x² − y²)/2), to first order.
    let slope = 1e-4;
    let share = [1.0, 0.0, 0.0, 0.5 * slope / 0.1];
    let bent = problem(YEOH, 0.1, 1.0, [share; 2]);
    let place = |x: &Vec3| {
        let [a, b, c] = [x[0], x[1] - 0.5, x[2] - 0.5];
        [
            a + 0.1 * a + slope * a * c,
            b + 0.1 * b + slope * b * c,
            c + 0.1 * c + slope * (c * c - a * a - b * b) / 2.0,
        ]
    };
    let rest = bent.body().rest();
    let energy = |positions: &[Vec3]| elastic::energy(bent.body(), positions);
    let arc: Vec<Vec3> = rest.iter().map(place).collect();
    let straight: Vec<Vec3> = rest.iter().map(|x| x.map(|c| 1.1 * c)).collect();
    assert!(
        energy(&arc) < 1e-3 * energy(&straight),
        "{} {}",
        energy(&arc),
        energy(&straight)
    );
}
