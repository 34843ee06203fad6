//! Homogeneous states: a voxel is stable where its material is.

use voxsoft_solid::matrix::{Mat3, apply, multiply};
use voxsoft_solid::vector::{Vec3, norm, rotate, scale};
use voxsoft_solid::{FaceConditions, Filling, Hex8, HyperelasticMaterial, Model, WarpingModes};

const STATES: usize = 50;

/// Least eigenvalue of the Hessian of W, over the shear modulus, from which a state counts: central differences with
/// steps of 1e-4 err by about 1e-4 at a bulk modulus of 5000.
const CLEAR: f64 = 1e-3;

const STEP: f64 = 1e-4;

fn cube() -> Hex8 {
    Hex8 {
        vertices: std::array::from_fn(|c| c as u32),
        material: 0,
        side: 1.0,
        fraction: 1.0,
        filling: Filling::FULL,
        warping: WarpingModes::NONE,
        peak: 0.0,
    }
}

fn corners(gradient: &Mat3) -> Vec<Vec3> {
    let corner = |c: usize| [c >> 2 & 1, c >> 1 & 1, c & 1].map(|bit| bit as f64);
    (0..8).map(corner).map(|x| apply(gradient, x)).collect()
}

/// Reproducible numbers in [0, 1) (Lehmer's generator).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0 * 48271 % 0x7fff_ffff;
        self.0 as f64 / f64::from(0x7fff_ffff)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// Materials of shear modulus 1.
fn materials() -> Vec<HyperelasticMaterial> {
    let neo_hookean = Model::NeoHookean { c10: 0.5 };
    let yeoh = Model::Yeoh {
        c: [0.5, -0.02, 0.01],
    };
    let ogden = Model::Ogden {
        terms: [(0.7, 1.7), (0.1, 7.0), (0.2, -3.4)],
    };
    // Bulk moduli at ν = 0.3, 0.45, 0.499 and 0.4999.
    let bulk = |poisson: f64| 2.0 * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson));
    let of = |model: &Model, poisson: f64| {
        HyperelasticMaterial::new(*model, bulk(poisson), 1.0).unwrap()
    };
    let mut all: Vec<_> = [0.3, 0.45, 0.499, 0.4999]
        .map(|poisson| of(&neo_hookean, poisson))
        .into();
    all.extend([of(&yeoh, 0.45), of(&ogden, 0.45), of(&ogden, 0.499)]);
    all
}

/// Stretches about 1 with a pressure in tension below three shear moduli.
fn stretches(numbers: &mut Numbers, bulk: f64) -> Vec3 {
    let shape: Vec3 = std::array::from_fn(|_| numbers.between(-0.6, 0.6).exp());
    let volume = 1.0 + numbers.between(0.0, 3.0).min(bulk) / bulk;
    let scale = (volume / shape.iter().product::<f64>()).cbrt();
    shape.map(|s| scale * s)
}

/// A rotation.
fn turn(numbers: &mut Numbers) -> Mat3 {
    let axis: Vec3 = std::array::from_fn(|_| numbers.between(-1.0, 1.0));
    let (axis, angle) = (scale(1.0 / norm(axis), axis), numbers.between(0.0, 3.0));
    let unit = |k: usize| std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 });
    let columns = [0, 1, 2].map(|k| rotate(unit(k), axis, angle));
    std::array::from_fn(|i| columns.map(|column| column[i]))
}

/// The least eigenvalue of the Hessian of W by the nine entries of F, and the principal nominal stresses `T`.
///
/// In the frame of the stretches `λ` the Hessian falls into that by the three stretches, and for each pair of them into
/// `(Tᵢ − Tⱼ)/(λᵢ − λⱼ)` for shear and `(Tᵢ + Tⱼ)/(λᵢ + λⱼ)` for spin (Ogden 1984, Non-linear elastic deformations, 6.1.4).
fn material_response(material: &HyperelasticMaterial, stretches: Vec3) -> (f64, Vec3) {
    let energy = |moves: &[(usize, f64)]| {
        let mut here = stretches;
        for &(axis, by) in moves {
            here[axis] += by;
        }
        cube().energy(material, &corners(&diagonal(here)))
    };
    let second = |a: usize, b: usize| {
        let signs = [(1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)];
        let each = signs.map(|(s, t)| s * t * energy(&[(a, s * STEP), (b, t * STEP)]));
        each.iter().sum::<f64>() / (4.0 * STEP * STEP)
    };
    let hessian: Mat3 = std::array::from_fn(|a| std::array::from_fn(|b| second(a, b)));
    let stress: Vec3 =
        std::array::from_fn(|k| (energy(&[(k, STEP)]) - energy(&[(k, -STEP)])) / (2.0 * STEP));
    let mut least = eigenvalues(hessian)[0];
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let shear = (stress[i] - stress[j]) / (stretches[i] - stretches[j]);
        let spin = (stress[i] + stress[j]) / (stretches[i] + stretches[j]);
        least = least.min(shear).min(spin);
    }
    (least, stress)
}

fn diagonal(stretches: Vec3) -> Mat3 {
    let entry = |i: usize, k: usize| if i == k { stretches[k] } else { 0.0 };
    std::array::from_fn(|i| std::array::from_fn(|k| entry(i, k)))
}

/// All eigenvalues of a symmetric matrix in rising order, by Jacobi rotations.
fn eigenvalues<const N: usize>(mut a: [[f64; N]; N]) -> Vec<f64> {
    for _ in 0..30 {
        for p in 0..N {
            for q in p + 1..N {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for k in 0..N {
                    let (x, y) = (a[k][p], a[k][q]);
                    a[k][p] = c * x - s * y;
                    a[k][q] = s * x + c * y;
                }
                for k in 0..N {
                    let (x, y) = (a[p][k], a[q][k]);
                    a[p][k] = c * x - s * y;
                    a[q][k] = s * x + c * y;
                }
            }
        }
    }
    let mut values: Vec<f64> = (0..N).map(|i| a[i][i]).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Free faces at the sides of each axis.
fn warping(free: [[bool; 2]; 3]) -> WarpingModes {
    WarpingModes::of(&FaceConditions {
        free,
        ..FaceConditions::default()
    })
}

/// Tests that the tangent of a voxel at stretches is positive beside three translations: under tension a rotation costs
/// energy too.
fn assert_stable(voxel: &Hex8, material: &HyperelasticMaterial, stretches: Vec3, turn: &Mat3) {
    let positions = corners(&multiply(turn, &diagonal(stretches)));
    let values = eigenvalues(voxel.stiffness(material, &positions, None));
    // Rounding of entries as large as the bulk modulus.
    let rounding = 1e-12 * material.bulk();
    assert!(
        values[2].abs() < rounding && values[0].abs() < rounding && values[3] > rounding,
        "{stretches:?} of ν = {}: {values:?}",
        material.poisson()
    );
}

#[test]
fn voxel_is_stable_where_its_material_is() {
    let mut numbers = Numbers(20_261);
    for material in materials() {
        let mut seen = 0;
        while seen < STATES {
            let stretches = stretches(&mut numbers, material.bulk());
            let turn = turn(&mut numbers);
            let (least, stress) = material_response(&material, stretches);
            if least < CLEAR {
                continue;
            }
            seen += 1;
            assert_stable(&cube(), &material, stretches, &turn);
            // A free face is not pushed, and relief of the shear leaves the voxel stable.
            if stress.iter().all(|&t| t >= 0.0) {
                for free in [
                    [[true, false], [false; 2], [false; 2]],
                    [[true, false], [false, true], [false; 2]],
                    [[true, false], [true, false], [false, true]],
                    [[true, true], [false; 2], [true, false]],
                ] {
                    let voxel = Hex8 {
                        warping: warping(free),
                        ..cube()
                    };
                    assert_stable(&voxel, &material, stretches, &turn);
                }
            }
        }
    }
}
