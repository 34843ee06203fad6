//! Free faces of rubber voxels and their warping: closed forms of the derivation in `src/warping.rs`.

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Body, Clamp, FaceConditions, Fiber, Filling, Hex8, HyperelasticMaterial, Material, Membrane,
    MembraneMaterial, Mesh, Model, Problem, WarpingModes,
};
use voxsoft_voxel::{Grid, tet_mesh};

/// A box of voxels of edge 1, all of part 0.
fn boxed(shape: [usize; 3]) -> Mesh {
    let mut grid = Grid::empty(shape, [0.0; 3], 1.0, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], shape.map(|n| n as f64), 1);
    mesh_of(&grid)
}

/// The mesh of all filled voxels.
fn mesh_of(grid: &Grid) -> Mesh {
    let tets = tet_mesh(grid, u64::MAX).unwrap();
    let count = tets.tets.len();
    Mesh {
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        tet_part: vec![0; count],
        tet_block: (0..count as u32).map(|t| t / 5).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    }
}

fn rubber() -> HyperelasticMaterial {
    HyperelasticMaterial::neo_hookean(1.0, 0.49, 1.0).unwrap()
}

/// The bar of 4 × 2 × 2 voxels.
fn bar() -> Mesh {
    boxed([4, 2, 2])
}

fn body(mesh: &Mesh) -> Body {
    Body::new(mesh, &[rubber(), rubber()]).unwrap()
}

/// A clamp of all vertices at a place.
fn clamp(mesh: &Mesh, axes: [bool; 3], at: impl Fn(Vec3) -> bool) -> Clamp {
    let vertices = (0..mesh.vertices.len() as u32).filter(|&v| at(mesh.vertices[v as usize]));
    Clamp {
        vertices: vertices.collect(),
        axes,
        motion: None,
    }
}

/// The voxel whose lowest corner is at a place.
fn voxel(body: &Body, at: Vec3) -> Hex8 {
    let mut hex8s = body.hex8s().iter();
    *hex8s
        .find(|b| body.rest()[b.vertices[0] as usize] == at)
        .unwrap()
}

/// The warping of a voxel whose only free faces (axis, side) are these, with these stiff ones.
fn with(free: &[(usize, usize)], stiff: &[(usize, usize)]) -> WarpingModes {
    let mut faces = FaceConditions::default();
    for &(axis, side) in free {
        faces.free[axis][side] = true;
    }
    for &(axis, side) in stiff {
        faces.stiff[axis][side] = true;
    }
    WarpingModes::of(&faces)
}

/// The remaining fraction of shear stiffness for a small mean shear of the pair of axes other than `b`.
fn left(warping: WarpingModes, b: usize) -> f64 {
    let hex8 = Hex8 {
        warping,
        ..body(&boxed([1; 3])).hex8s()[0]
    };
    let rest: Vec<Vec3> = body(&boxed([1; 3])).rest().to_vec();
    let (j, k) = ((b + 1) % 3, (b + 2) % 3);
    let shear = 1e-3;
    let place = |x: &Vec3| {
        let mut x = *x;
        (x[j], x[k]) = (x[j] + shear / 2.0 * x[k], x[k] + shear / 2.0 * x[j]);
        x
    };
    let sheared: Vec<Vec3> = rest.iter().map(place).collect();
    let material = rubber();
    2.0 * hex8.energy(&material, &sheared) / (material.model().shear() * shear * shear)
}

#[test]
fn remaining_shear_stiffness_matches_the_derivation() {
    for (free, part) in [
        (&[][..], 0.0),
        (&[(0, 0)][..], 5.0 / 26.0),
        (&[(0, 1), (1, 0)], 10.0 / 32.0),
        // One voxel thick: a plate, and with one free face at its end the ends of a bar's section.
        (&[(0, 0), (0, 1)], 1.0 / 6.0),
        (&[(0, 0), (0, 1), (2, 0)], 10.0 / 22.0),
        (&[(0, 0), (0, 1), (1, 0), (2, 0)], 0.5),
        (&[(0, 0), (0, 1), (1, 0), (1, 1), (2, 1)], 10.0 / 17.0),
        // A rod: there is no relief of its shear.
        (&[(0, 0), (0, 1), (1, 0), (1, 1)], 0.0),
    ] {
        // Terms of fourth order in the shear are 1e-6 of those of second order, rounding is 1e-15/1e-6.
        let found = 1.0 - left(with(free, &[]), 2);
        assert!((found - part).abs() < 1e-5, "{free:?} {found} {part}");
    }
}

/// The second derivative of the energy by the shear `S_xy` at the stretch `(along, across, across)`, halved.
fn shear_stiffness(hex8: &Hex8, material: &HyperelasticMaterial, along: f64, across: f64) -> f64 {
    let rest: Vec<Vec3> = body(&boxed([1; 3])).rest().to_vec();
    let energy = |shear: f64| {
        let place = |x: &Vec3| {
            [
                along * x[0] + shear * x[1],
                shear * x[0] + across * x[1],
                across * x[2],
            ]
        };
        hex8.energy(material, &rest.iter().map(place).collect::<Vec<_>>())
    };
    let step = 1e-3;
    (energy(step) + energy(-step) - 2.0 * energy(0.0)) / (2.0 * step * step)
}

#[test]
fn relief_of_shear_stiffness_is_the_same_at_any_stretch() {
    let gent = Model::Gent {
        shear: 1.0,
        limit: 30.0,
    };
    let still = body(&boxed([1; 3])).hex8s()[0];
    let still = Hex8 {
        warping: WarpingModes::NONE,
        ..still
    };
    let warping = Hex8 {
        warping: with(&[(1, 0)], &[]),
        ..still
    };
    for material in [
        rubber(),
        HyperelasticMaterial::new(gent, 100.0, 1.0).unwrap(),
    ] {
        for along in [0.4, 0.7, 1.5, 2.5, 4.0_f64] {
            // The width at which the sides are free of stress has the least energy.
            let energy = |across: f64| {
                let place = |x: &Vec3| [along * x[0], across * x[1], across * x[2]];
                let rest: Vec<Vec3> = body(&boxed([1; 3])).rest().to_vec();
                still.energy(&material, &rest.iter().map(place).collect::<Vec<_>>())
            };
            let (mut low, mut high) = (0.3 / along.sqrt(), 2.0 / along.sqrt());
            for _ in 0..200 {
                let thirds = [low + (high - low) / 3.0, high - (high - low) / 3.0];
                if energy(thirds[0]) < energy(thirds[1]) {
                    high = thirds[1];
                } else {
                    low = thirds[0];
                }
            }
            let [whole, left] =
                [&still, &warping].map(|hex8| shear_stiffness(hex8, &material, along, low));
            assert!(whole > 0.0);
            // The least energy gives the width to 1e-8; terms of fourth order in the shear are 1e-6, times the limit of
            // the rubber and the bulk modulus 1e-4.
            assert!(
                (left / whole - 21.0 / 26.0).abs() < 1e-3,
                "{along}: {}",
                left / whole
            );
        }
    }
}

#[test]
fn surface_voxels_of_a_bar_warp() {
    let body = body(&bar());
    let inside = voxel(&body, [1.0, 0.0, 1.0]).warping;
    assert_eq!(inside, with(&[(1, 0), (2, 1)], &[]));
    assert_ne!(inside, WarpingModes::NONE);
    let end = voxel(&body, [0.0, 0.0, 1.0]).warping;
    assert_eq!(end, with(&[(0, 0), (1, 0), (2, 1)], &[]));
    let heart = voxel(&self::body(&boxed([3; 3])), [1.0; 3]).warping;
    assert_eq!(heart, WarpingModes::NONE);
}

#[test]
fn clamped_face_is_held_and_does_not_warp() {
    let mesh = bar();
    let clamps = vec![clamp(&mesh, [true; 3], |x| x[0] == 0.0)];
    let problem = Problem::new(body(&mesh), clamps, vec![], None).unwrap();
    let at_clamp = voxel(problem.body(), [0.0, 0.0, 1.0]).warping;
    let faces = FaceConditions {
        free: [[false; 2], [true, false], [false, true]],
        stiff: [[true, false], [false; 2], [false; 2]],
        held: [[true, false], [false; 2], [false; 2]],
        ..FaceConditions::default()
    };
    assert_eq!(at_clamp, WarpingModes::of(&faces));
    assert_ne!(at_clamp, with(&[(1, 0), (2, 1)], &[]));
    let beyond = voxel(problem.body(), [1.0, 0.0, 1.0]).warping;
    assert_eq!(beyond, with(&[(1, 0), (2, 1)], &[]));
}

#[test]
fn half_of_a_body_warps_like_the_whole() {
    let whole = body(&bar());
    let mesh = boxed([4, 1, 2]);
    let slides = vec![clamp(&mesh, [false, true, false], |x| x[1] == 1.0)];
    let half = Problem::new(body(&mesh), slides, vec![], None).unwrap();
    for x in 0..4 {
        for z in 0..2 {
            let at = [f64::from(x), 0.0, f64::from(z)];
            assert_eq!(
                voxel(half.body(), at).warping,
                voxel(&whole, at).warping,
                "{at:?}"
            );
        }
    }
}

#[test]
fn face_to_another_material_is_stiff() {
    let mut mesh = bar();
    for (part, tet) in mesh.tet_part.iter_mut().zip(&mesh.tets) {
        let x: f64 = tet.iter().map(|&v| mesh.vertices[v as usize][0]).sum();
        *part = u8::from(x > 8.0);
    }
    let body = body(&mesh);
    let beside = voxel(&body, [1.0, 0.0, 1.0]).warping;
    assert_eq!(beside, with(&[(1, 0), (2, 1)], &[(0, 1)]));
    assert_eq!(
        voxel(&body, [2.0, 0.0, 1.0]).warping,
        with(&[(1, 0), (2, 1)], &[(0, 0)])
    );
}

#[test]
fn a_face_below_a_membrane_does_not_warp() {
    let mut mesh = bar();
    let material = MembraneMaterial {
        young: 1.0,
        poisson: 0.3,
        thickness: 1.0,
        density: 1.0,
    };
    let at = |place: Vec3| mesh.vertices.iter().position(|x| *x == place).unwrap() as u32;
    let triangle = [
        at([1.0, 0.0, 2.0]),
        at([2.0, 0.0, 2.0]),
        at([1.0, 1.0, 2.0]),
    ];
    let corners = triangle.map(|v| mesh.vertices[v as usize]);
    mesh.membranes = vec![Membrane::new(triangle, corners, material).unwrap()];
    let body = body(&mesh);
    assert_eq!(voxel(&body, [1.0, 0.0, 1.0]).warping, with(&[(1, 0)], &[]));
    assert_eq!(
        voxel(&body, [2.0, 0.0, 1.0]).warping,
        with(&[(1, 0), (2, 1)], &[])
    );
}

#[test]
fn cut_voxels_and_fibers_do_not_warp() {
    let cut = Filling {
        shift: [0.0, 0.0, -0.2],
        spread: [1.0, 1.0, 0.8],
        ..Filling::FULL
    };
    let mesh = bar();
    for (fraction, filling, warps) in [
        (1.0 - 1.0 / 3072.0, Filling::FULL, true),
        (0.9, Filling::FULL, false),
        (1.0, cut, false),
    ] {
        let blocks = mesh.tets.len() / 5;
        let mesh = Mesh {
            block_fraction: vec![fraction; blocks],
            block_filling: vec![filling; blocks],
            ..mesh.clone()
        };
        let all_still = body(&mesh)
            .hex8s()
            .iter()
            .all(|b| b.warping == WarpingModes::SURFACE);
        assert_eq!(all_still, !warps, "{fraction} {filling:?}");
    }
    let fiber = Fiber {
        direction: [1.0, 0.0, 0.0],
        modulus: 1.0,
        compression: true,
        free: 1.0,
    };
    let wound: Material = rubber().with_fibers(vec![fiber]).unwrap().into();
    let body = Body::new(&mesh, &[wound]).unwrap();
    assert!(
        body.hex8s()
            .iter()
            .all(|b| b.warping == WarpingModes::SURFACE)
    );
}

/// Two arms of a voxel across and `long` voxels along x and z beside their common one, three along y.
fn angle(long: usize) -> Mesh {
    let size = long + 2;
    let mut grid = Grid::empty([size, 3, size], [0.0; 3], 1.0, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [size as f64, 3.0, 2.0], 1);
    grid.fill_box([0.0; 3], [2.0, 3.0, size as f64], 1);
    mesh_of(&grid)
}

#[test]
fn voxels_at_a_reentrant_edge_lose_shear_across_it() {
    let body = body(&angle(2));
    let relieved =
        |warping: WarpingModes| warping.with_reentrant_edges(&[false, true, false], 0.49);
    for (x, z, free) in [
        (1, 1, &[][..]),
        (1, 2, &[(0, 1)][..]),
        (2, 1, &[(2, 1)][..]),
    ] {
        let at = [f64::from(x), 1.0, f64::from(z)];
        let found = voxel(&body, at).warping;
        assert_eq!(found, relieved(with(free, &[])), "{at:?}");
        let [one, other, across] = [0, 2, 1].map(|b| left(found, b) / left(with(free, &[]), b));
        assert!(
            (one - 1.0).abs() < 1e-5 && (other - 1.0).abs() < 1e-5,
            "{at:?}"
        );
        let faces = left(with(free, &[]), 1);
        // 0.310 of the table for this Poisson's ratio, in series with the faces.
        let expected = 1.0 / (1.0 + faces * 0.31 / 0.69);
        assert!(
            (across - expected).abs() < 1e-5,
            "{at:?}: {across} {expected}"
        );
    }
    for (x, z, free) in [
        (0, 0, &[(0, 0), (2, 0)][..]),
        (0, 1, &[(0, 0)]),
        (1, 3, &[(0, 1), (2, 1)]),
        (3, 1, &[(0, 1), (2, 1)]),
    ] {
        let at = [f64::from(x), 1.0, f64::from(z)];
        assert_eq!(voxel(&body, at).warping, with(free, &[]), "{at:?}");
    }
}

#[test]
fn relief_at_an_edge_levels_off() {
    let hex8 = Hex8 {
        warping: WarpingModes::NONE.with_reentrant_edges(&[false, false, true], 0.49),
        ..body(&boxed([1; 3])).hex8s()[0]
    };
    let plain = Hex8 {
        warping: WarpingModes::NONE,
        ..hex8
    };
    let rest: Vec<Vec3> = body(&boxed([1; 3])).rest().to_vec();
    let share = |shear: f64| {
        let place = |x: &Vec3| [x[0] + shear / 2.0 * x[1], x[1] + shear / 2.0 * x[0], x[2]];
        let sheared: Vec<Vec3> = rest.iter().map(place).collect();
        let energies = [hex8, plain].map(|own| own.energy(&rubber(), &sheared));
        // The determinant of both is 1 - shear^2 / 4, whose energy is theirs alone.
        1.0 - energies[0] / energies[1]
    };
    let shares = [0.02, 0.2, 0.4, 0.8].map(share);
    assert!((shares[0] - 0.31).abs() < 0.01, "{shares:?}");
    assert!(shares.is_sorted_by(|a, b| a > b), "{shares:?}");
}

#[test]
fn stairs_of_one_voxel_have_no_reentrant_edge() {
    let body = body(&angle(1));
    assert_eq!(voxel(&body, [1.0; 3]).warping, WarpingModes::NONE);
}
