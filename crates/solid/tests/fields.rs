//! Fields of affine deformations against closed forms.

use std::f64::consts::SQRT_2;

use voxsoft_solid::fields::{Field, Fields};
use voxsoft_solid::matrix::{Mat3, apply, multiply};
use voxsoft_solid::vector::{Vec3, rotate};
use voxsoft_solid::{
    Body, Clamp, Filling, HyperelasticMaterial, LatticeMaterial, Material, Mesh, Model, Problem,
    State,
};
use voxsoft_voxel::{Grid, tet_mesh};

const SIDE: f64 = 4e-3;
const EDGE: f64 = 30e3;
const BULK: f64 = 110e3;
const C10: f64 = 12e3;

fn body(material: Material) -> Body {
    let mut grid = Grid::empty([3, 3, 2], [0.0; 3], SIDE, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [3.0 * SIDE, 3.0 * SIDE, 2.0 * SIDE], 1);
    body_of(&grid, material)
}

fn body_of(grid: &Grid, material: Material) -> Body {
    let tets = tet_mesh(grid, u64::MAX).unwrap();
    let count = tets.tets.len();
    let mesh = Mesh {
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        tet_part: vec![0; count],
        tet_block: (0..count as u32).map(|t| t / 5).collect(),
        vertices: tets.vertices,
        block_fraction: vec![1.0; count / 5],
        block_filling: vec![Filling::FULL; count / 5],
        ..Mesh::default()
    };
    Body::new(&mesh, &[material]).unwrap()
}

fn lattice() -> Body {
    body(
        LatticeMaterial::from_moduli(EDGE, BULK, 1000.0)
            .unwrap()
            .into(),
    )
}

/// Rubber with all vertices held: a uniform shear needs tractions that free faces do not have.
fn rubber() -> Body {
    let model = Model::NeoHookean { c10: C10 };
    let body = body(
        HyperelasticMaterial::new(model, BULK, 1000.0)
            .unwrap()
            .into(),
    );
    let held = Clamp::fixed((0..body.rest().len() as u32).collect());
    let problem = Problem::new(body, vec![held], vec![], None).unwrap();
    problem.body().clone()
}

/// All values of a field where every vertex is moved by `F`, rotated and translated.
fn values(body: &Body, f: &Mat3, field: Field) -> Vec<f64> {
    let place = |x: &Vec3| {
        let [a, b, c] = rotate(apply(f, *x), [0.6, 0.0, 0.8], 0.9);
        [a + 0.1, b, c - 0.2]
    };
    let state = State {
        positions: body.rest().iter().map(place).collect(),
        velocities: vec![[0.0; 3]; body.rest().len()],
        time: 0.0,
    };
    let all = (0..body.rest().len() as u32).collect();
    Fields::new(body, all).evaluate(body, &state, field)
}

fn check(body: &Body, f: &Mat3, field: Field, expected: f64, scale: f64) {
    for value in values(body, f, field) {
        // Rounding: sums of some dozen terms.
        let error = (value - expected).abs() / scale;
        assert!(error < 1e-12, "{field:?}: {value} instead of {expected}");
    }
}

fn diagonal(d: Vec3) -> Mat3 {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { d[i] } else { 0.0 }))
}

/// The energy density of a lattice voxel: a spring along each axis and two along the diagonals of each face
/// orientation, half of them in each voxel.
fn lattice_energy(f: &Mat3, diagonals: &[Vec3]) -> f64 {
    let spring = |direction: Vec3, length: f64, stiffness: f64| {
        let [x, y, z] = apply(f, direction);
        stiffness * ((x * x + y * y + z * z).sqrt() - length).powi(2) / 2.0
    };
    let along: f64 = (0..3)
        .map(|i| {
            spring(
                std::array::from_fn(|j| f64::from(u8::from(i == j))),
                1.0,
                EDGE,
            )
        })
        .sum();
    let across: f64 = diagonals
        .iter()
        .map(|d| spring(*d, SQRT_2, EDGE * SQRT_2 / 2.0))
        .sum();
    let volume = f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1])
        - f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0])
        + f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
    along + across + BULK * (volume - 1.0).powi(2) / 2.0
}

const DIAGONALS: [Vec3; 6] = [
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
];

#[test]
fn a_lattice_under_uniaxial_and_biaxial_stretch() {
    let body = lattice();
    for d in [[1.4, 1.0, 1.0], [0.8, 1.0, 1.0], [1.3, 0.9, 1.2]] {
        let f = diagonal(d);
        check(
            &body,
            &f,
            Field::Stretch,
            d.into_iter().fold(0.0, f64::max),
            1.0,
        );
        let energy = lattice_energy(&f, &DIAGONALS);
        check(&body, &f, Field::EnergyDensity, energy, EDGE);
        // σ = λ ∂W/∂λ / J along each axis, by hand.
        let volume = d[0] * d[1] * d[2];
        let sigma: [f64; 3] = std::array::from_fn(|i| {
            let mut slope = EDGE * (d[i] - 1.0) + BULK * (volume - 1.0) * volume / d[i];
            for j in (0..3).filter(|&j| j != i) {
                let length = d[i].hypot(d[j]);
                slope += EDGE * SQRT_2 * (length - SQRT_2) * d[i] / length;
            }
            slope * d[i] / volume
        });
        let mean = sigma.iter().sum::<f64>() / 3.0;
        let deviator: f64 = sigma.iter().map(|s| (s - mean).powi(2)).sum();
        check(&body, &f, Field::Pressure, -mean, EDGE);
        check(&body, &f, Field::VonMises, (1.5 * deviator).sqrt(), EDGE);
    }
}

#[test]
fn rubber_under_uniaxial_stretch_and_pressure() {
    let body = rubber();
    for stretch in [0.7, 1.5, 2.0_f64] {
        let side = stretch.powf(-0.5);
        let f = diagonal([stretch, side, side]);
        // An incompressible neo-Hookean bar: σ = 2 C₁₀ (λ² − 1/λ), and no mean stress without a change of
        // volume.
        let sigma = 2.0 * C10 * (stretch * stretch - 1.0 / stretch);
        check(&body, &f, Field::VonMises, sigma.abs(), BULK);
        check(&body, &f, Field::Pressure, 0.0, BULK);
        check(&body, &f, Field::Stretch, stretch.max(side), 1.0);
        let invariant = stretch * stretch + 2.0 / stretch - 3.0;
        check(&body, &f, Field::EnergyDensity, C10 * invariant, BULK);
    }
    let squeezed = diagonal([0.95; 3]);
    let volume = 0.95_f64.powi(3);
    check(
        &body,
        &squeezed,
        Field::Pressure,
        BULK * (1.0 - volume),
        BULK,
    );
    check(&body, &squeezed, Field::VonMises, 0.0, BULK);
}

#[test]
fn simple_shear_has_its_stretch_and_shear_stress() {
    let shear = 0.6_f64;
    let f = multiply(
        &diagonal([1.0; 3]),
        &[[1.0, shear, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    );
    let body = rubber();
    // λ − 1/λ = γ.
    let stretch = shear / 2.0 + (1.0 + shear * shear / 4.0).sqrt();
    check(&body, &f, Field::Stretch, stretch, 1.0);
    // σ = 2 C₁₀ dev(b): τ = 2 C₁₀ γ and a normal difference 2 C₁₀ γ².
    let deviator = (2.0 * C10).powi(2) * (2.0 * shear.powi(2) + (2.0 / 3.0 * shear.powi(4)));
    check(&body, &f, Field::VonMises, (1.5 * deviator).sqrt(), BULK);
}

#[test]
fn displacement_and_speed_are_those_of_vertices() {
    let body = lattice();
    let mut state = State::at_rest(&body);
    state.positions[5][0] += 3e-3;
    state.positions[5][2] -= 4e-3;
    state.velocities[5] = [0.0, 2.0, 0.0];
    let fields = Fields::new(&body, vec![5, 2]);
    let expected = [(0, 5e-3), (1, 3e-3), (2, 0.0), (3, -4e-3), (8, 2.0)];
    for (id, value) in expected {
        let got = fields.evaluate(&body, &state, Field::from_id(id).unwrap());
        assert!(
            (got[0] - value).abs() < 1e-15 && got[1] == 0.0,
            "{id}: {got:?}"
        );
    }
    assert_eq!(Field::from_id(9), None);
}

/// A voxel's stress is that of its own deformation: voxels beyond the neighbors do not count.
#[test]
fn vertices_average_their_own_voxels_only() {
    let body = rubber();
    let mut state = State::at_rest(&body);
    let far: Vec<usize> = (0..body.rest().len())
        .filter(|&v| body.rest()[v][0] > 2.5 * SIDE)
        .collect();
    for &v in &far {
        state.positions[v][0] += 1e-3;
    }
    let near = (0..body.rest().len() as u32).filter(|&v| body.rest()[v as usize][0] < 1.5 * SIDE);
    let fields = Fields::new(&body, near.collect());
    let values = fields.evaluate(&body, &state, Field::VonMises);
    assert!(values.iter().all(|&v| v < 1e-9 * C10));
    let fields = Fields::new(&body, far.iter().map(|&v| v as u32).collect());
    let values = fields.evaluate(&body, &state, Field::VonMises);
    assert!(values.iter().all(|&v| v > 0.1 * C10));
}

/// A lattice voxel turned inside out at a finite energy: it has no stress, and its volume ratio shows it.
#[test]
fn an_inverted_voxel_has_no_stress() {
    for body in [lattice(), rubber()] {
        // The vertex in the middle of the layer is pushed through the face of a voxel beyond it.
        let mut state = State::at_rest(&body);
        let inside = |x: &Vec3| (0..3).all(|i| (x[i] - [1.0, 1.0, 1.0][i] * SIDE).abs() < 1e-9);
        let middle = body.rest().iter().position(inside).unwrap();
        let fields = Fields::of_all(&body);
        let upright = fields.measure(&body, &state.positions);
        assert!(
            upright
                .iter()
                .all(|m| m.volume_ratio > 0.999 && m.stress[0][0].abs() < 1e-6)
        );
        for i in 0..3 {
            state.positions[middle][i] += 3.0 * SIDE;
        }
        let measures = fields.measure(&body, &state.positions);
        let inverted = measures.iter().filter(|m| m.volume_ratio <= 0.0).count();
        assert!(inverted > 0);
        assert_eq!(fields.inverted(&body, &state.positions), inverted);
        assert_eq!(fields.inverted(&body, body.rest()), 0);
        for measure in &measures {
            let is_none = measure.von_mises.is_nan() && measure.stress[1][2].is_nan();
            assert_eq!(is_none, measure.volume_ratio <= 0.0);
            assert!(measure.energy_density.is_finite() && measure.stretches[0].is_finite());
        }
        // A vertex shared with other voxels has their mean; nothing is divided by a vanishing volume.
        let smooth = fields.evaluate(&body, &state, Field::VonMises);
        let most = measures.iter().map(|m| m.von_mises).fold(0.0, f64::max);
        assert!(smooth.iter().all(|v| v.is_nan() || *v <= most));
    }
}

/// Nearly flat voxels: the stress is that of the formula until the volume is zero, and NaN beyond.
#[test]
fn stress_is_continuous_until_a_voxel_is_flat() {
    for body in [lattice(), rubber()] {
        let stress = |squash: f64| values(&body, &diagonal([1.0, 1.0, squash]), Field::VonMises)[0];
        let (near, nearer) = (stress(0.011), stress(0.010));
        assert!(near.is_finite() && (nearer / near - 1.0).abs() < 0.2);
        assert!(stress(-0.01).is_nan());
    }
}

#[test]
fn volume_ratio_and_stretches_of_an_affine_deformation() {
    for body in [lattice(), rubber()] {
        let d = [1.3, 0.9, 0.7];
        let f = diagonal(d);
        let positions: Vec<Vec3> = body
            .rest()
            .iter()
            .map(|x| rotate(apply(&f, *x), [0.6, 0.0, 0.8], 0.9))
            .collect();
        for measure in Fields::of_all(&body).measure(&body, &positions) {
            assert!((measure.volume_ratio - d.iter().product::<f64>()).abs() < 1e-12);
            for k in 0..3 {
                assert!((measure.stretches[k] - d[k]).abs() < 1e-12);
            }
        }
    }
}

/// Strain and stress of a rigid motion are rounding errors.
#[test]
fn rounding_is_reported_as_zero() {
    for body in [lattice(), rubber()] {
        let rigid = diagonal([1.0; 3]);
        for (field, zero) in [
            (Field::VonMises, 0.0),
            (Field::Pressure, 0.0),
            (Field::EnergyDensity, 0.0),
            (Field::Stretch, 1.0),
        ] {
            assert!(
                values(&body, &rigid, field).iter().all(|&v| v == zero),
                "{field:?}"
            );
        }
    }
}

#[test]
fn stretch_slope_matches_differences() {
    for body in [lattice(), rubber()] {
        let fields = Fields::of_all(&body);
        let mut positions: Vec<Vec3> = body.rest().to_vec();
        for (index, x) in positions.iter_mut().enumerate() {
            x[index % 3] += 0.1 * SIDE * (index as f64).sin();
        }
        let slope = fields.stretch_slope(&body, &positions, 4);
        let step = 1e-5 * SIDE;
        for vertex in 0..positions.len() {
            for axis in 0..3 {
                let mut at = |offset: f64| {
                    let before = positions[vertex][axis];
                    positions[vertex][axis] += offset;
                    let stretch = fields.measure(&body, &positions)[4].stretches[0];
                    positions[vertex][axis] = before;
                    stretch
                };
                let difference = (at(step) - at(-step)) / (2.0 * step);
                // Second differences of a stretch times the step squared: 1e-10 of 1/SIDE.
                assert!((slope[vertex][axis] - difference).abs() < 1e-8 / SIDE);
            }
        }
    }
}

#[test]
fn blocks_of_elements_are_those_of_the_mesh() {
    for material in [0, 1] {
        let body = if material == 0 { lattice() } else { rubber() };
        let mut grid = Grid::empty([3, 3, 2], [0.0; 3], SIDE, u64::MAX).unwrap();
        grid.fill_box([0.0; 3], [3.0 * SIDE, 3.0 * SIDE, 2.0 * SIDE], 1);
        let tets = tet_mesh(&grid, u64::MAX).unwrap();
        let mesh = Mesh {
            tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
            tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
            ..Mesh::default()
        };
        let mut blocks = Fields::of_all(&body).blocks(&body, &mesh);
        blocks.sort_unstable();
        assert!(blocks.into_iter().eq(0..18));
    }
}

#[cfg(feature = "threads")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let mut grid = Grid::empty([12, 12, 8], [0.0; 3], SIDE, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [12.0 * SIDE, 12.0 * SIDE, 8.0 * SIDE], 1);
    let material = LatticeMaterial::from_moduli(EDGE, BULK, 1000.0).unwrap();
    let body = body_of(&grid, material.into());
    let positions: Vec<Vec3> = body
        .rest()
        .iter()
        .map(|x| [x[0] + 0.1 * x[1] * x[2] / SIDE, x[1] * 1.1, x[2]])
        .collect();
    let fields = Fields::of_all(&body);
    let all = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build()
            .unwrap()
            .install(|| fields.measure(&body, &positions))
    };
    let state = |threads: usize| {
        let state = State {
            positions: positions.clone(),
            ..State::at_rest(&body)
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| fields.evaluate(&body, &state, Field::VonMises))
    };
    assert_eq!(all(1), all(4));
    assert_eq!(state(1), state(3));
}

#[test]
fn turned_voxels_measure_along_their_own_edges() {
    let (axis, angle) = ([0.6, 0.0, 0.8], 0.9);
    let turn = |x: Vec3| rotate(x, axis, angle);
    let model = Model::NeoHookean { c10: C10 };
    let stiff = voxsoft_solid::Fiber {
        direction: [1.0, 0.0, 0.0],
        modulus: 4.0 * C10,
        compression: true,
        free: 1.0,
    };
    let rubber = HyperelasticMaterial::new(model, BULK, 1000.0).unwrap();
    let material: Material = rubber.with_fibers(vec![stiff]).unwrap().into();
    let mut grid = Grid::empty([3, 3, 2], [0.0; 3], SIDE, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [3.0 * SIDE, 3.0 * SIDE, 2.0 * SIDE], 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let blocks = tets.tets.len() / 5;
    let cut = Filling {
        shift: [0.2, 0.0, -0.1],
        spread: [0.9, 1.0, 0.8],
        products: [0.02, -0.05, 0.01],
        ..Filling::FULL
    };
    let upright = Mesh {
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        tet_part: vec![0; 5 * blocks],
        tet_block: (0..5 * blocks as u32).map(|t| t / 5).collect(),
        vertices: tets.vertices,
        block_fraction: vec![0.8; blocks],
        block_filling: vec![cut; blocks],
        ..Mesh::default()
    };
    let turned = Mesh {
        vertices: upright.vertices.iter().map(|x| turn(*x)).collect(),
        // The rows are the directions of x, y and z of the body.
        block_axes: vec![[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(turn); blocks],
        ..upright.clone()
    };
    let [first, second] =
        [&upright, &turned].map(|mesh| Body::new(mesh, std::slice::from_ref(&material)).unwrap());
    // Not affine, and far from small.
    let moved: Vec<Vec3> = first
        .rest()
        .iter()
        .map(|[x, y, z]| [x + 20.0 * x * z, 1.1 * y + 0.2 * x, z - 30.0 * x * x])
        .collect();
    let also: Vec<Vec3> = moved.iter().map(|x| turn(*x)).collect();
    let energy =
        |body: &Body, at: &[Vec3]| -> f64 { body.terms().map(|term| term.energy(at)).sum() };
    let (one, other) = (energy(&first, &moved), energy(&second, &also));
    assert!((one / other - 1.0).abs() < 1e-12, "{one} {other}");
    let forces = |body: &Body, at: &[Vec3]| {
        let mut forces = vec![[0.0; 3]; at.len()];
        body.terms()
            .for_each(|term| term.add_forces(at, &mut forces));
        forces
    };
    let (one, other) = (forces(&first, &moved), forces(&second, &also));
    let largest = one.iter().flatten().fold(0.0f64, |m, f| m.max(f.abs()));
    for (a, b) in one.iter().zip(&other) {
        // Rounding: sums of some dozen terms.
        let off = (0..3)
            .map(|i| (turn(*a)[i] - b[i]).abs())
            .fold(0.0, f64::max);
        assert!(off < 1e-12 * largest, "{a:?} {b:?}");
    }
    // Without its axes a turned voxel is no voxel.
    let lost = Mesh {
        block_axes: vec![],
        ..turned
    };
    assert!(Body::new(&lost, &[material]).is_err());
}
