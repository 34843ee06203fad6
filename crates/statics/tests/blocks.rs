//! Slopes by the fractions of blocks against differences of whole solutions, and their sum.

mod common;

use common::{block, rubber, settled, vertices_where};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Blocks, Body, Clamp, HyperelasticMaterial, LatticeMaterial, Load, Material, Mesh, PerBlock,
    Problem, ProblemError, elastic,
};
use voxsoft_statics::{Settings, block_slopes};

const CELLS: [usize; 3] = [6, 2, 2];
const SIDE: f64 = 5e-3;
/// Four points err by the fourth power of the step, 1e-12, and the tolerance of solutions over the step, 1e-9.
const STEP: f64 = 1e-3;
const STENCIL: [(f64, f64); 4] = [
    (-2.0, 1.0 / 12.0),
    (-1.0, -2.0 / 3.0),
    (1.0, 2.0 / 3.0),
    (2.0, -1.0 / 12.0),
];

/// Beam under its weight, fixed at its first vertices, with the blocks of its mesh.
struct Beam {
    problem: Problem,
    blocks: Blocks,
    /// Weights of all vertices in the measured number: the sag of the free end, and a little of its twist.
    gradient: Vec<Vec3>,
}

impl Beam {
    fn of(material: impl Into<Material>, change: impl Fn(&mut Mesh)) -> Self {
        let mut mesh = block(CELLS, SIDE);
        change(&mut mesh);
        let materials = [material.into()];
        let body = Body::new(&mesh, &materials).unwrap();
        let blocks = Blocks::of(&body, &mesh, &materials).unwrap();
        let wall = Clamp::fixed(vertices_where(&mesh, |x| x[0] < 1e-9));
        let loads = vec![Load::gravity([0.0, 2.0, -9.81])];
        let problem = Problem::new(body, vec![wall], loads, None).unwrap();
        let mut gradient = vec![[0.0; 3]; mesh.vertices.len()];
        let end = CELLS[0] as f64 * SIDE - 1e-9;
        for vertex in vertices_where(&mesh, |x| x[0] > end) {
            gradient[vertex as usize] = [0.1, 0.3, -1.0];
        }
        // A hanging vertex is read through the corners that it follows.
        problem.body().ties().hand_over(&mut gradient);
        Self {
            problem,
            blocks,
            gradient,
        }
    }

    fn positions(&self, problem: &Problem) -> Vec<Vec3> {
        let settings = Settings {
            tolerance: 1e-12,
            ..Settings::default()
        };
        settled(problem, &settings).positions
    }

    fn measured(&self, fractions: &PerBlock) -> f64 {
        let problem = self
            .problem
            .with_fractions(&self.blocks, fractions)
            .unwrap();
        let moved = self.positions(&problem);
        let pairs = moved
            .as_flattened()
            .iter()
            .zip(self.gradient.as_flattened());
        pairs.map(|(x, g)| x * g).sum()
    }

    fn slopes(&self, fractions: &PerBlock) -> PerBlock {
        let problem = self
            .problem
            .with_fractions(&self.blocks, fractions)
            .unwrap();
        let positions = self.positions(&problem);
        let gradients = [self.gradient.clone()];
        let all = block_slopes(
            &problem,
            &self.blocks,
            &positions,
            &gradients,
            u64::MAX,
            &mut || false,
        );
        all.unwrap().remove(0)
    }

    /// Difference of whole solutions, for fractions that `vary` shifts.
    fn difference(&self, fractions: &PerBlock, vary: impl Fn(&mut PerBlock, f64)) -> f64 {
        let at = |multiple: f64| {
            let mut varied = fractions.clone();
            vary(&mut varied, multiple * STEP);
            self.measured(&varied)
        };
        let parts = STENCIL.map(|(multiple, weight)| weight * at(multiple));
        parts.iter().sum::<f64>() / STEP
    }
}

fn beams() -> Vec<Beam> {
    let lattice = || LatticeMaterial::from_moduli(60e3, 400e3, 1070.0).unwrap();
    let cut = |mesh: &mut Mesh| {
        mesh.block_fraction = (0..24)
            .map(|b| 0.3 + 0.7 * f64::from(b % 5) / 4.0)
            .collect();
    };
    vec![
        Beam::of(lattice(), |_| {}),
        Beam::of(lattice(), cut),
        Beam::of(rubber(), |_| {}),
        Beam::of(rubber(), cut),
        Beam::of(rubber(), coarse),
    ]
}

/// Makes the eight voxels at the end one element.
fn coarse(mesh: &mut Mesh) {
    let far = 4.0 * SIDE - 1e-9;
    let inside = |&block: &u32| {
        let mut tets = mesh.tets.iter().zip(&mesh.tet_block);
        tets.all(|(tet, own)| {
            *own != block || tet.iter().all(|v| mesh.vertices[*v as usize][0] > far)
        })
    };
    let members: Vec<u32> = (0..24).filter(inside).collect();
    mesh.coarse = vec![members.try_into().unwrap()];
}

/// Some fractions, all different.
fn some(blocks: usize) -> PerBlock {
    let number = |b: usize, scale: f64| 1.0 + scale * (2.7 * b as f64).sin();
    PerBlock {
        stiffness: (0..blocks).map(|b| number(b, 0.3)).collect(),
        mass: (0..blocks).map(|b| number(b, -0.2)).collect(),
    }
}

#[test]
fn slopes_are_those_of_whole_solutions() {
    for beam in beams() {
        let fractions = some(beam.blocks.count());
        let slopes = beam.slopes(&fractions);
        let largest = |all: &[f64]| all.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        for block in [0, 9, 15, 23] {
            let found = beam.difference(&fractions, |f, step| f.stiffness[block] += step);
            let off = (slopes.stiffness[block] - found).abs();
            let allowed = 1e-6 * found.abs() + 1e-8 * largest(&slopes.stiffness);
            assert!(off <= allowed, "{} {found}", slopes.stiffness[block]);
            let found = beam.difference(&fractions, |f, step| f.mass[block] += step);
            let off = (slopes.mass[block] - found).abs();
            let allowed = 1e-6 * found.abs() + 1e-8 * largest(&slopes.mass);
            assert!(off <= allowed, "{} {found}", slopes.mass[block]);
        }
    }
}

#[test]
fn slopes_add_up_to_that_by_the_modulus() {
    let slopes = |beam: &Beam| beam.slopes(&PerBlock::uniform(beam.blocks.count(), 1.0));
    let sums =
        |slopes: PerBlock| [slopes.stiffness, slopes.mass].map(|all| all.iter().sum::<f64>());
    let found = sums(slopes(&Beam::of(rubber(), |_| {})));
    let measured = |young: f64, density: f64| {
        let material = HyperelasticMaterial::neo_hookean(young, 0.49, density).unwrap();
        let beam = Beam::of(material, |_| {});
        beam.measured(&PerBlock::uniform(beam.blocks.count(), 1.0))
    };
    let slope = |of: &dyn Fn(f64) -> f64| {
        let parts = STENCIL.map(|(multiple, weight)| weight * of(1.0 + multiple * STEP));
        parts.iter().sum::<f64>() / STEP
    };
    let by_modulus = slope(&|part| measured(part * 60e3, 1070.0));
    let by_density = slope(&|part| measured(60e3, part * 1070.0));
    for (found, expected) in found.into_iter().zip([by_modulus, by_density]) {
        assert!(
            (found - expected).abs() < 1e-6 * expected.abs(),
            "{found} {expected}"
        );
    }
    // Twice the stiffness and twice the weight change nothing.
    assert!(
        (found[0] + found[1]).abs() < 1e-7 * found[0].abs(),
        "{found:?}"
    );
}

#[test]
fn fractions_of_one_change_nothing_and_others_what_they_name() {
    for beam in beams() {
        let count = beam.blocks.count();
        let body = beam.problem.body();
        let with = |fractions: &PerBlock| beam.problem.with_fractions(&beam.blocks, fractions);
        let same = with(&PerBlock::uniform(count, 1.0)).unwrap();
        // Rounding of sums of a dozen.
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-13 * b.abs();
        let pairs = same.body().masses().iter().zip(body.masses());
        assert!(pairs.into_iter().all(|(a, b)| near(*a, *b)));
        let pairs = same.body().edges().iter().zip(body.edges());
        assert!(
            pairs
                .into_iter()
                .all(|(a, b)| near(a.stiffness, b.stiffness))
        );
        assert_eq!(same.body().hex8s(), body.hex8s());
        assert!(near(beam.blocks.masses().iter().sum(), body.total_mass()));
        let moved = beam.positions(&beam.problem);
        let energies: f64 = beam.blocks.energies(body, &moved).iter().sum();
        let energy = elastic::energy(body, &moved);
        assert!(
            (energies / energy - 1.0).abs() < 1e-12,
            "{energies} {energy}"
        );
        let mut fractions = PerBlock::uniform(count, 1.0);
        fractions.mass[3] = 2.0;
        let heavier = with(&fractions).unwrap().body().total_mass() - body.total_mass();
        assert!((heavier / beam.blocks.masses()[3] - 1.0).abs() < 1e-9);
    }
    let beam = beams().remove(0);
    let mut wrong = PerBlock::uniform(beam.blocks.count(), 1.0);
    wrong.stiffness[2] = 0.0;
    let refused = beam.problem.with_fractions(&beam.blocks, &wrong);
    assert!(matches!(refused, Err(ProblemError::NotPositive { .. })));
    wrong.stiffness.pop();
    let refused = beam.problem.with_fractions(&beam.blocks, &wrong);
    assert!(matches!(refused, Err(ProblemError::Length { .. })));
}
