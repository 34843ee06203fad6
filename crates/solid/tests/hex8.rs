//! The hyperelastic voxel: derivatives, rigid motion, spectrum, exact bending, inversion.

use proptest::prelude::*;
use voxsoft_solid::matrix::{apply, polar};
use voxsoft_solid::vector::{Vec3, add};
use voxsoft_solid::{
    CutSurface, FaceConditions, Fiber, Filling, Hex8, HyperelasticMaterial, Model, WarpingModes,
};

const SIDE: f64 = 0.5;

fn cube() -> (Hex8, Vec<Vec3>) {
    let corner = |c: usize| [c >> 2 & 1, c >> 1 & 1, c & 1].map(|bit| SIDE * bit as f64);
    let hex8 = Hex8 {
        vertices: std::array::from_fn(|c| c as u32),
        material: 0,
        side: SIDE,
        fraction: 0.7,
        filling: Filling::FULL,
        warping: WarpingModes::NONE,
        peak: 0.0,
    };
    (hex8, (0..8).map(corner).collect())
}

/// Filling with material in one corner, some of it outside the cube.
fn cut() -> Filling {
    Filling {
        shift: [0.4, -0.7, 1.1],
        spread: [0.6, 0.3, 1.2],
        products: [-0.7, 0.5, -0.2],
        ..Filling::FULL
    }
}

/// Warping with any faces free, and any of them held; or at a clamp; with any re-entrant edges.
fn warping() -> impl Strategy<Value = WarpingModes> {
    let faces = any::<[[[bool; 2]; 3]; 3]>().prop_map(|[free, stiff, held]| FaceConditions {
        free,
        stiff,
        held,
        ..FaceConditions::default()
    });
    let whole = prop_oneof![faces, clamped()].prop_map(|faces| WarpingModes::of(&faces));
    let surface = (
        prop::array::uniform3(-2.0..2.0f64),
        prop::array::uniform3(prop::array::uniform2(0.0..1.0f64)),
    );
    let cut = surface.prop_map(|(turn, areas)| {
        let surface = CutSurface::of(turn, areas);
        WarpingModes::of_cut(&FaceConditions::default(), &Filling { surface, ..cut() })
    });
    let edges = any::<[bool; 3]>();
    (prop_oneof![whole, cut], edges)
        .prop_map(|(warping, edges)| warping.with_reentrant_edges(&edges, 0.4))
}

/// Faces of a voxel with a clamp on one side of an axis, free faces across it, some of them under pressure.
fn clamped() -> impl Strategy<Value = FaceConditions> {
    any::<([[bool; 2]; 3], [[bool; 2]; 3], bool)>()
        .prop_flat_map(|faces| (0..3usize).prop_map(move |axis| (faces, axis)))
        .prop_map(|((free, pressed, high), axis)| {
            let mut faces = FaceConditions {
                free,
                pressed,
                ..FaceConditions::default()
            };
            faces.free[axis] = [false; 2];
            faces.held[axis] = [!high, high];
            faces.stiff[axis] = faces.held[axis];
            faces
        })
}

fn materials() -> Vec<HyperelasticMaterial> {
    let ogden = Model::Ogden {
        terms: [(1.2, 1.7), (0.1, 7.0), (0.2, -3.4)],
    };
    let fiber = Fiber {
        direction: [0.6, 0.0, 0.8],
        modulus: 5.0,
        compression: true,
        free: 1.0,
    };
    vec![
        HyperelasticMaterial::neo_hookean(1.0, 0.49, 1.0).unwrap(),
        HyperelasticMaterial::neo_hookean(1.0, 0.2, 1.0)
            .unwrap()
            .with_fibers(vec![fiber])
            .unwrap(),
        HyperelasticMaterial::new(ogden, 30.0, 1.0).unwrap(),
    ]
}

/// Fibers that are shorter by themselves, so that there is stress at rest.
fn muscle() -> HyperelasticMaterial {
    let fiber = Fiber {
        direction: [0.0, 0.6, 0.8],
        modulus: 5.0,
        compression: true,
        free: 0.8,
    };
    let rubber = HyperelasticMaterial::neo_hookean(1.0, 0.4, 1.0).unwrap();
    rubber.with_fibers(vec![fiber]).unwrap()
}

fn moved() -> impl Strategy<Value = Vec<Vec3>> {
    let (_, rest) = cube();
    prop::collection::vec(prop::array::uniform3(-0.1..0.1f64), 8)
        .prop_map(move |u| rest.iter().zip(u).map(|(x, u)| add(*x, u)).collect())
}

fn forces(hex8: &Hex8, material: &HyperelasticMaterial, positions: &[Vec3]) -> Vec<Vec3> {
    let mut forces = vec![[0.0; 3]; 8];
    hex8.add_to(&hex8.forces(material, positions), &mut forces);
    forces
}

proptest! {
    // Central differences with h = 1e-6 (a strain of 2e-6) err by about h² × 1e3 + 1e-16/h.
    #[test]
    fn forces_and_stiffness_are_derivatives(is_cut in any::<bool>(), warping in warping(), positions in moved(), direction in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 8)) {
        let filling = if is_cut { cut() } else { Filling::FULL };
        let hex8 = Hex8 { filling, warping, ..cube().0 };
        let step = 1e-6;
        let at = |t: f64| -> Vec<Vec3> {
            positions.iter().zip(&direction).map(|(x, d)| std::array::from_fn(|i| x[i] + t * d[i])).collect()
        };
        for material in materials().into_iter().chain([muscle()]) {
            let here = forces(&hex8, &material, &positions);
            let power: f64 = here.iter().zip(&direction).map(|(f, d)| f[0] * d[0] + f[1] * d[1] + f[2] * d[2]).sum();
            let change = (hex8.energy(&material, &at(step)) - hex8.energy(&material, &at(-step))) / (2.0 * step);
            prop_assert!((change + power).abs() < 1e-6, "{change} {power}");
            let stiffness = hex8.stiffness(&material, &positions, None);
            let (high, low) = (forces(&hex8, &material, &at(step)), forces(&hex8, &material, &at(-step)));
            for row in 0..24 {
                let (vertex, axis) = (row / 3, row % 3);
                let product: f64 = (0..24).map(|c| stiffness[row][c] * direction[c / 3][c % 3]).sum();
                let slope = (high[vertex][axis] - low[vertex][axis]) / (2.0 * step);
                prop_assert!((slope + product).abs() < 2e-5, "row {row}: {slope} {product}");
                for column in 0..24 {
                    prop_assert!((stiffness[row][column] - stiffness[column][row]).abs() < 1e-10 * 30.0);
                }
            }
        }
    }

    #[test]
    fn cut_voxel_has_the_mean_gradient_over_its_material(positions in moved(), points in prop::collection::vec(prop::array::uniform3(-1.5..1.5f64), 1..5)) {
        let mean = |value: &dyn Fn(&Vec3) -> f64| points.iter().map(value).sum::<f64>() / points.len() as f64;
        let filling = Filling {
            shift: std::array::from_fn(|k| mean(&|p| p[k])),
            products: [mean(&|p| p[1] * p[2]), mean(&|p| p[2] * p[0]), mean(&|p| p[0] * p[1])],
            ..cut()
        };
        let found = Hex8 { filling, ..cube().0 }.deformation(&materials()[0], &positions);
        // The slopes of the trilinear functions of the corners, ∂N/∂X = ±(1 ± η)(1 ± ζ)/(4h).
        for column in 0..3 {
            for row in 0..3 {
                let expected = mean(&|point| (0..8).map(|c| {
                    let sign: Vec3 = [c >> 2 & 1, c >> 1 & 1, c & 1].map(|bit| 2.0 * f64::from(bit) - 1.0);
                    let factor = |k: usize| if k == column { sign[k] } else { 1.0 + sign[k] * point[k] };
                    positions[c as usize][row] * factor(0) * factor(1) * factor(2) / (4.0 * SIDE)
                }).sum());
                prop_assert!((found[row][column] - expected).abs() < 1e-13, "{found:?}");
            }
        }
    }

    #[test]
    fn rigid_motion_costs_nothing(is_cut in any::<bool>(), warping in warping(), turn in prop::array::uniform3(prop::array::uniform3(-1.0..1.0f64)), shift in prop::array::uniform3(-9.0..9.0f64)) {
        let (full, rest) = cube();
        let hex8 = Hex8 { filling: if is_cut { cut() } else { full.filling }, warping, ..full };
        let (rotation, _) = polar(&turn);
        let turned: Vec<Vec3> = rest.iter().map(|x| add(apply(&rotation, *x), shift)).collect();
        for material in materials() {
            prop_assert!(hex8.energy(&material, &turned).abs() < 1e-13);
            // Rounding of coordinates of size 10 over the side, times the bulk modulus.
            prop_assert!(forces(&hex8, &material, &turned).iter().flatten().all(|f| f.abs() < 1e-12));
        }
    }

    #[test]
    fn response_is_finite_when_inside_out(warping in warping(), positions in prop::collection::vec(prop::array::uniform3(-0.5..1.0f64), 8)) {
        let hex8 = Hex8 { warping, ..cube().0 };
        for material in materials() {
            prop_assert!(hex8.energy(&material, &positions).is_finite());
            prop_assert!(forces(&hex8, &material, &positions).iter().flatten().all(|f| f.is_finite()));
            prop_assert!(hex8.stiffness(&material, &positions, None).as_flattened().iter().all(|f| f.is_finite()));
        }
    }
}

#[test]
fn stiffness_has_six_zero_eigenvalues() {
    let (hex8, rest) = cube();
    let all_free = FaceConditions {
        free: [[true; 2]; 3],
        ..FaceConditions::default()
    };
    let each = [WarpingModes::NONE, WarpingModes::of(&all_free)]
        .map(|w| materials().into_iter().map(move |m| (m, w)));
    for (material, warping) in each.into_iter().flatten() {
        let hex8 = Hex8 { warping, ..hex8 };
        let values = eigenvalues(&hex8.stiffness(&material, &rest, None));
        assert!(values[5].abs() < 1e-13, "{values:?}");
        // The softest true mode: 1/20 of E h would be a near mechanism.
        assert!(
            values[6] > 0.01 * material.young() * hex8.volume(&material) / SIDE.powi(2),
            "{values:?}"
        );
    }
}

/// All eigenvalues of a symmetric matrix in rising order, by Jacobi rotations.
fn eigenvalues(matrix: &[[f64; 24]; 24]) -> Vec<f64> {
    let mut a = *matrix;
    for _ in 0..30 {
        for p in 0..24 {
            for q in p + 1..24 {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for k in 0..24 {
                    let (x, y) = (a[k][p], a[k][q]);
                    a[k][p] = c * x - s * y;
                    a[k][q] = s * x + c * y;
                }
                for k in 0..24 {
                    let (x, y) = (a[p][k], a[q][k]);
                    a[p][k] = c * x - s * y;
                    a[q][k] = s * x + c * y;
                }
            }
        }
    }
    let mut values: Vec<f64> = (0..24).map(|i| a[i][i]).collect();
    values.sort_by(f64::total_cmp);
    values
}

#[test]
fn bending_has_the_energy_of_plate_and_beam() {
    // Plane sections: u₁ = κ x z, and u₃ = −κ x²/2 has no share in one voxel's nodes but its mean, so
    // the energy is that of the bending strain ε₁₁ = κ z alone: ½ E/(1 − ν²) κ² h²/12 per volume with
    // the width held flat, and ½ E κ² h²/12 with ε₂₂ = −ν κ z (anticlastic).
    let (hex8, rest) = cube();
    let curvature = 1e-4;
    for material in [
        HyperelasticMaterial::neo_hookean(1.0, 0.3, 1.0).unwrap(),
        HyperelasticMaterial::neo_hookean(1.0, 0.499, 1.0).unwrap(),
    ] {
        let poisson = material.poisson();
        for (across, modulus) in [(0.0, 1.0 / (1.0 - poisson * poisson)), (poisson, 1.0)] {
            let bent: Vec<Vec3> = rest
                .iter()
                .map(|x| {
                    let from_middle = x.map(|value| value - SIDE / 2.0);
                    let strain = curvature * from_middle[2];
                    [
                        x[0] + strain * from_middle[0],
                        x[1] - across * strain * from_middle[1],
                        x[2],
                    ]
                })
                .collect();
            let expected =
                0.5 * modulus * (curvature * SIDE).powi(2) / 12.0 * hex8.volume(&material);
            let ratio = hex8.energy(&material, &bent) / expected;
            // Terms of third order in the strain are 1e-4 of it.
            assert!((ratio - 1.0).abs() < 1e-3, "{poisson} {across}: {ratio}");
        }
    }
}
