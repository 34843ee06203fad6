//! Lane kernels against the scalar code.

use proptest::prelude::*;

use super::{TOGETHER, Together};
use crate::element::cut_surface::CutSurface;
use crate::element::hex8::{
    FaceConditions, Filling, Hex8, Hex8AssumedStrain, Hex8Matrix, WarpingModes,
};
use crate::hyperelastic::{Fiber, HyperelasticMaterial, Model};
use crate::vector::Vec3;

/// Rounding of some 10⁴ operations, of which few add up along one path, on moduli that differ by 10³.
const ROUNDING: f64 = 1e-10;

fn materials() -> Vec<HyperelasticMaterial> {
    let of = |model, bulk| HyperelasticMaterial::new(model, bulk, 1000.0).unwrap();
    let soft = Model::NeoHookean { c10: 1.0 };
    let fiber = Fiber {
        direction: [0.6, 0.8, 0.0],
        modulus: 5.0,
        compression: true,
        free: 0.95,
    };
    vec![
        of(soft, 40.0),
        of(soft, 2000.0),
        of(
            Model::Yeoh {
                c: [1.0, -0.05, 0.01],
            },
            100.0,
        ),
        of(
            Model::Gent {
                shear: 2.0,
                limit: 30.0,
            },
            100.0,
        ),
        of(
            Model::Ogden {
                terms: [(1.2, 1.7), (0.1, 7.0), (0.0, 0.0)],
            },
            100.0,
        ),
        of(soft, 50.0).with_fibers(vec![fiber]).unwrap(),
    ]
}

/// A voxel of a kind, with its corners displaced from those of a cube.
fn voxel() -> impl Strategy<Value = (usize, bool, WarpingModes, f64, [Vec3; 8], [Vec3; 8])> {
    let corners = |size: f64| prop::array::uniform8(prop::array::uniform3(-size..size));
    (
        0..6usize,
        any::<bool>(),
        prop::sample::select(warpings()),
        prop::sample::select(vec![0.05, 0.2, 1.0]),
        corners(1.0),
        corners(0.2),
    )
}

/// Warping of voxels inside the body, at its surface, at an edge, and at a clamp.
fn warpings() -> Vec<WarpingModes> {
    let free = FaceConditions {
        free: [[true, false], [false, true], [false, false]],
        ..FaceConditions::default()
    };
    let held = [[false; 2], [false; 2], [true, false]];
    let clamped = FaceConditions {
        stiff: held,
        held,
        ..free
    };
    let oblique = Filling {
        shift: [0.2, -0.3, 0.1],
        surface: CutSurface::of([0.4, -0.3, 0.9], [[0.0, 0.7], [0.2, 0.1], [0.0, 0.4]]),
        ..Filling::FULL
    };
    vec![
        WarpingModes::NONE,
        WarpingModes::of(&free),
        WarpingModes::of(&free).with_reentrant_edges(&[false, true, true], 0.49),
        WarpingModes::of(&clamped),
        WarpingModes::of_cut(&FaceConditions::default(), &oblique),
    ]
}

fn hex8(first: u32, material: u32, cut: bool, warping: WarpingModes) -> Hex8 {
    let filling = Filling {
        shift: [0.3, -0.1, 0.0],
        spread: [0.6, 0.9, 1.0],
        products: [0.05, -0.1, 0.02],
        ..Filling::FULL
    };
    Hex8 {
        vertices: std::array::from_fn(|corner| first + corner as u32),
        material,
        side: 0.01,
        fraction: if cut { 0.6 } else { 1.0 },
        filling: if cut { filling } else { Filling::FULL },
        warping,
        peak: 0.0,
    }
}

fn near(ours: &[f64], plain: &[f64], what: &str) -> Result<(), TestCaseError> {
    let size = plain.iter().fold(1e-9f64, |m, x| m.max(x.abs()));
    for (a, b) in ours.iter().zip(plain) {
        prop_assert!((a - b).abs() <= ROUNDING * size, "{what}: {a} {b}");
    }
    Ok(())
}

proptest! {
    #[test]
    fn lanes_match_scalar_code(voxels in prop::collection::vec(voxel(), 1..=TOGETHER)) {
        let materials = materials();
        let (mut hex8s, mut positions, mut moves) = (Vec::new(), Vec::new(), Vec::new());
        for (kind, cut, warping, size, corners, steps) in voxels {
            hex8s.push(hex8(positions.len() as u32, kind as u32, cut, warping));
            for corner in 0..8 {
                let at = |axis: usize| 0.01 * ((corner >> (2 - axis) & 1) as f64);
                positions.push(std::array::from_fn(|k| at(k) + 0.01 * size * corners[corner][k]));
                moves.push(steps[corner].map(|x| 0.01 * x));
            }
        }
        let all = |carried| Together { hex8s: &hex8s, materials: &materials, positions: &positions, carried };
        let mut before = vec![Hex8AssumedStrain::NOTHING; hex8s.len()];
        all(None).update(&moves, &mut before);
        let mut after = before.clone();
        all(Some(&before)).update(&moves, &mut after);
        let mut energies = vec![0.0; hex8s.len()];
        all(None).energies(&mut energies);
        for (hex8, ours) in hex8s.iter().zip(energies) {
            let material = &materials[hex8.material as usize];
            // Each is a difference from the unloaded state, near which it is rounded to that of its parts.
            let part = material.young() * hex8.volume(material);
            near(&[part + ours], &[part + hex8.energy(material, &positions)], "energy")?;
        }
        for carried in [None, Some(&before[..])] {
            let mut matrices: Vec<Hex8Matrix> = vec![[[0.0; 24]; 24]; hex8s.len()];
            let mut forces = vec![[[0.0; 3]; 8]; hex8s.len()];
            all(carried).stiffness(&mut matrices);
            all(carried).forces(&mut forces);
            for (index, hex8) in hex8s.iter().enumerate() {
                let material = &materials[hex8.material as usize];
                let own = carried.map(|states| &states[index]);
                let plain = hex8.stiffness(material, &positions, own);
                near(matrices[index].as_flattened(), plain.as_flattened(), "stiffness")?;
                let plain = match own {
                    Some(own) => hex8.predicted_forces(material, own, &positions),
                    None => hex8.forces(material, &positions),
                };
                near(forces[index].as_flattened(), plain.as_flattened(), "forces")?;
                let plain = hex8.update(material, own, &positions, &moves);
                let ours = if own.is_some() { &after[index] } else { &before[index] };
                near(&ours.strain.row(), &plain.strain.row(), "strain")?;
                // A difference of volume ratios near one.
                near(&[1.0 + ours.pressure.shift], &[1.0 + plain.pressure.shift], "pressure")?;
            }
        }
    }
}
