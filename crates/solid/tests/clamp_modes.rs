//! Voxels at a clamp: faces that draw in, the patch test under uniform pulls, and freedom from locking.

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{FaceConditions, Filling, Hex8, HyperelasticMaterial, WarpingModes};

/// A voxel of edge 1 with these free faces (axis, side), held at its low face along x or not.
fn voxel(free: &[(usize, usize)], held: bool) -> Hex8 {
    let mut faces = FaceConditions::default();
    for &(axis, side) in free {
        faces.free[axis][side] = true;
    }
    faces.held[0][0] = held;
    faces.stiff[0][0] = held;
    Hex8 {
        vertices: std::array::from_fn(|corner| corner as u32),
        material: 0,
        side: 1.0,
        fraction: 1.0,
        filling: Filling::FULL,
        warping: WarpingModes::of(&faces),
        peak: 0.0,
    }
}

fn rubber(poisson: f64) -> HyperelasticMaterial {
    HyperelasticMaterial::neo_hookean(1.0, poisson, 1.0).unwrap()
}

fn corners(place: impl Fn(Vec3) -> Vec3) -> Vec<Vec3> {
    let corner = |c: usize| [c >> 2 & 1, c >> 1 & 1, c & 1].map(|bit| bit as f64);
    (0..8).map(|c| place(corner(c))).collect()
}

/// One free face, two that are opposite or adjacent, and a rod.
const FREE: [&[(usize, usize)]; 4] = [
    &[(1, 1)],
    &[(1, 0), (1, 1)],
    &[(1, 1), (2, 0)],
    &[(1, 0), (1, 1), (2, 0), (2, 1)],
];

/// The width at which a voxel that is drawn along x has no lateral stress.
fn width(voxel: &Hex8, material: &HyperelasticMaterial, along: f64) -> f64 {
    let force = |across: f64| {
        let drawn = corners(|x| [along * x[0], across * x[1], across * x[2]]);
        let forces = voxel.forces(material, &drawn);
        (0..8)
            .filter(|c| c >> 1 & 1 == 1)
            .map(|c| forces[c][1])
            .sum::<f64>()
    };
    let (mut low, mut high) = (0.3 / along.sqrt(), 2.0 / along.sqrt());
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if force(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// The patch test. With a small strain it holds for any material, and without compression at any stretch; the remaining
/// error is then of the order of G/K, 2e-4. At large strain each voxel has the width that frees it: pressures follow
/// widths that differ by as little.
#[test]
fn uniform_stretch_has_the_forces_of_a_voxel_without_clamp() {
    let cases = [
        // Errors of second order in the strain.
        (0.0, 1.001, 1e-5),
        (0.3, 1.001, 1e-5),
        (0.49, 1.001, 1e-5),
        (0.4999, 0.6, 3e-4),
        (0.4999, 1.6, 3e-4),
        (0.4999, 2.0, 5e-4),
        // G/K times the strain is 6e-3.
        (0.49, 1.3, 8e-3),
    ];
    for free in FREE {
        for (poisson, along, tolerance) in cases {
            let material = rubber(poisson);
            let (plain, clamped) = (voxel(&[], false), voxel(free, true));
            assert_ne!(clamped.warping, WarpingModes::NONE);
            let [expected, found] = [plain, clamped].map(|hex8| {
                let freed = if f64::abs(along - 1.0) > 0.1 {
                    &hex8
                } else {
                    &plain
                };
                let across = width(freed, &material, along);
                let drawn = corners(|x| [along * x[0], across * x[1], across * x[2]]);
                hex8.forces(&material, &drawn)
            });
            let pull: f64 = expected[4..].iter().map(|force| force[0]).sum();
            for (a, b) in expected.iter().zip(&found) {
                for axis in 0..3 {
                    let off = (a[axis] - b[axis]) / (pull / 4.0);
                    assert!(off.abs() < tolerance, "{free:?} {poisson} {along}: {off}");
                }
            }
        }
    }
}

/// Simple shear of the held face against the one across, and of the free face along the third axis: the states in which
/// a uniform stress leaves the face `y` free.
#[test]
fn shear_without_traction_on_the_free_face_is_not_relieved() {
    let material = rubber(0.49);
    let sheared = corners(|x| [x[0] + 1e-4 * x[2], x[1], x[2] + 1e-4 * x[0]]);
    let [expected, found] =
        [voxel(&[], false), voxel(&[(1, 1)], true)].map(|hex8| hex8.forces(&material, &sheared));
    for (a, b) in expected.as_flattened().iter().zip(found.as_flattened()) {
        // Forces are some 1e-5, terms of second order 1e-4 of them, times K/G.
        assert!((a - b).abs() < 1e-7, "{a} {b}");
    }
}

/// With the low face along x held: no motion of the other one is stiffer than in the plain voxel, and none has zero
/// stiffness.
#[test]
fn clamped_voxel_is_softer_and_positive_definite() {
    for free in FREE {
        for poisson in [0.3, 0.49, 0.4999] {
            let stiffness =
                |hex8: Hex8, poisson| hex8.stiffness(&rubber(poisson), &corners(|x| x), None);
            let clamped = stiffness(voxel(free, true), poisson);
            let combined = |of_plain: f64, plain: [[f64; 24]; 24], of_clamped: f64| {
                std::array::from_fn(|i| {
                    std::array::from_fn(|j| {
                        let (i, j) = (12 + i, 12 + j);
                        of_plain * plain[i][j] + of_clamped * clamped[i][j]
                    })
                })
            };
            // Some motions are not relieved at all; the margin covers rounding.
            let plain = stiffness(voxel(&[], false), poisson);
            let softer = is_positive(combined(1.0 + 1e-6, plain, -1.0));
            // The modes relieve pressure, so that the stiffness is of the order of G and not of K.
            let soft = stiffness(voxel(&[], false), 0.3);
            let firm = is_positive(combined(-0.3, soft, 1.0));
            assert!(softer && firm, "{free:?} {poisson}: {softer} {firm}");
        }
    }
}

/// Tests whether a symmetric matrix is positive definite: whether elimination finds positive pivots alone.
fn is_positive(mut matrix: [[f64; 12]; 12]) -> bool {
    (0..12).all(|pivot| {
        let own = matrix[pivot];
        for row in pivot + 1..12 {
            let part = matrix[row][pivot] / own[pivot];
            for column in pivot..12 {
                matrix[row][column] -= part * own[column];
            }
        }
        own[pivot] > 0.0
    })
}

/// A face that bends out of plane and turns by 0.1: with a linear relief of the volume the energy grows with the bulk
/// modulus. Larger strains fade the modes, and the voxel keeps its volume as others do.
#[test]
fn bending_does_not_lock_without_compression() {
    let bent = corners(|x| {
        let (sin, cos) = (0.1 * x[0]).sin_cos();
        let (z, y) = (x[2] - 0.5, x[1] - 0.5);
        let narrow = 1.0 - 0.05 * z * x[0];
        [x[0] + z * sin, y * narrow, z * cos + 0.017 * (y * y) * x[0]]
    });
    for free in FREE {
        let energy = |poisson| voxel(free, true).energy(&rubber(poisson), &bent);
        let (soft, firm) = (energy(0.49), energy(0.49999));
        assert!(firm < 1.1 * soft, "{free:?}: {soft} {firm}");
    }
}

#[test]
fn only_faces_beside_a_clamp_draw_in() {
    let plain = |free: &[(usize, usize)]| voxel(free, false).warping;
    // Voxels without a face to draw in, and a stub whose end is free.
    for free in [&[][..], &[(0, 1), (1, 1)]] {
        let mut faces = FaceConditions::default();
        for &(axis, side) in free {
            faces.free[axis][side] = true;
        }
        faces.stiff[0][0] = true;
        assert_eq!(voxel(free, true).warping, WarpingModes::of(&faces));
    }
    assert_ne!(voxel(&[(1, 1)], true).warping, plain(&[(1, 1)]));
    // All free faces under pressure, and a stiff face beside the free one.
    for change in [true, false] {
        let mut faces = FaceConditions::default();
        faces.free[1][1] = true;
        faces.stiff[0][0] = true;
        if change {
            faces.pressed[1][1] = true;
        } else {
            faces.stiff[2][0] = true;
        }
        let expected = WarpingModes::of(&faces);
        faces.held[0][0] = true;
        assert_eq!(WarpingModes::of(&faces), expected);
    }
}
