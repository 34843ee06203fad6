//! Free faces of hyperelastic voxels, which may warp ([`crate::element::warping_modes`]).
//!
//! A face is free if no other voxel has it, no membrane lies on it, and no clamp holds it on any axis (held along its
//! normal, it is a plane of symmetry with material behind). As warping moves the adjacent faces too, those must not be
//! held in full, and material behind them must be the same. Voxels that are cut have their surface elsewhere, and
//! fibers keep a face from warping as the rubber around them would: neither warps.
//!
//! At faces that a clamp holds in full, or another material that is much stiffer, the free ones beside them draw in as
//! well ([`crate::element::clamp_modes`]), except those under pressure.

use std::collections::HashSet;

use crate::element::faces::FaceConditions;
use crate::element::reentrant_edges::{ReentrantEdges, reentrant_edges_of};
use crate::hyperelastic::HyperelasticMaterial;
use crate::{Filling, Hex8, Membrane};

/// Tolerance for fraction and distribution of the material of a full voxel: a voxel at the edge of a box whose faces
/// are on the grid loses 1/3072 where its fill is measured.
pub(crate) const FULL_SLACK: f64 = 4e-4;

/// The neighbor behind a face.
#[derive(Clone, Copy, PartialEq)]
enum Behind {
    Nothing,
    Same,
    Other,
    /// Another material, stiff enough to hold this one as a clamp does.
    Stiff,
}

/// Ratio of Young's moduli from which another material counts as a clamp.
const HOLDS: f64 = 2.0;

/// The faces of each voxel, `None` for voxels that do not warp, and its re-entrant edges. `voxels` are all cubes of the body, `held` the axes of
/// each vertex that clamps hold, `pressed` the triangles under pressure.
pub(crate) fn faces_of(
    hex8s: &[Hex8],
    materials: &[HyperelasticMaterial],
    voxels: &[[u32; 8]],
    membranes: &[Membrane],
    held: &[[bool; 3]],
    pressed: &[[u32; 3]],
) -> (Vec<Option<FaceConditions>>, Vec<ReentrantEdges>) {
    let Neighbors { behind, alike } = neighbors(hex8s, materials, voxels, held.len());
    let pressed: HashSet<[u32; 3]> = pressed.iter().map(|&triangle| sorted(triangle)).collect();
    let layers: HashSet<[u32; 3]> = membranes.iter().map(|m| sorted(m.vertices())).collect();
    let each = |(hex8, behind): (&Hex8, &[[Behind; 2]; 3])| {
        let fibers = !materials[hex8.material as usize].fibers().is_empty();
        if fibers {
            return None;
        }
        let mut faces = FaceConditions::default();
        for axis in 0..3 {
            for side in 0..2 {
                let corners = face(hex8.vertices, axis, side);
                let axes = corners.map(|v| held[v as usize]);
                let all = |axis: usize| axes.iter().all(|held| held[axis]);
                let held = [0, 1, 2].map(all);
                let what = behind[axis][side];
                faces.free[axis][side] = what == Behind::Nothing
                    && !held.contains(&true)
                    && !is_covered(corners, &layers);
                // Held along its normal alone it is in a plane of symmetry, and has the rest of the voxel behind it.
                let sticks = (0..3).any(|k| k != axis && held[k]);
                faces.covered[axis][side] =
                    what == Behind::Nothing && (sticks || is_covered(corners, &layers));
                faces.pressed[axis][side] = is_covered(corners, &pressed);
                let held = !held.contains(&false);
                faces.held[axis][side] = held || what == Behind::Stiff;
                faces.stiff[axis][side] = held || matches!(what, Behind::Other | Behind::Stiff);
            }
        }
        Some(faces)
    };
    let faces: Vec<Option<FaceConditions>> = hex8s.iter().zip(&behind).map(each).collect();
    let edges = reentrant_edges_of(hex8s, &faces, &alike);
    (faces, edges)
}

/// The number of a voxel that is not there.
pub(crate) const NO_VOXEL: u32 = u32::MAX;

/// Neighbors behind the faces of each voxel.
struct Neighbors {
    behind: Vec<[[Behind; 2]; 3]>,
    /// The voxels among them that are of the same material.
    alike: Vec<[[u32; 2]; 3]>,
}

/// The neighbor behind each face. A cube is found by its lowest corner, which no other has.
fn neighbors(
    hex8s: &[Hex8],
    materials: &[HyperelasticMaterial],
    voxels: &[[u32; 8]],
    vertices: usize,
) -> Neighbors {
    let mut cube_at = vec![NO_VOXEL; vertices];
    for (index, voxel) in voxels.iter().enumerate() {
        cube_at[voxel[0] as usize] = index as u32;
    }
    let mut hex8_of = vec![NO_VOXEL; voxels.len()];
    for (index, hex8) in hex8s.iter().enumerate() {
        hex8_of[cube_at[hex8.vertices[0] as usize] as usize] = index as u32;
    }
    let mut behind = vec![[[Behind::Nothing; 2]; 3]; hex8s.len()];
    let mut alike = vec![[[NO_VOXEL; 2]; 3]; hex8s.len()];
    for (cube, voxel) in voxels.iter().enumerate() {
        for axis in 0..3 {
            let next = cube_at[voxel[corner_beyond(axis)] as usize];
            if next == NO_VOXEL || face(*voxel, axis, 1) != face(voxels[next as usize], axis, 0) {
                continue;
            }
            let [low, high] = [hex8_of[cube], hex8_of[next as usize]];
            for (hex8, other, side) in [(low, high, 1), (high, low, 0)] {
                if hex8 != NO_VOXEL {
                    let material = (other != NO_VOXEL).then(|| hex8s[other as usize].material);
                    let own = hex8s[hex8 as usize].material;
                    let what = what_is(materials, own, material);
                    behind[hex8 as usize][axis][side] = what;
                    if what == Behind::Same {
                        alike[hex8 as usize][axis][side] = other;
                    }
                }
            }
        }
    }
    Neighbors { behind, alike }
}

/// Classifies the material `other` of a neighbor against `own`; a lattice has none.
fn what_is(materials: &[HyperelasticMaterial], own: u32, other: Option<u32>) -> Behind {
    let young = |material: u32| materials[material as usize].young();
    let same = |other: u32| {
        let [own, other] = [own, other].map(|number| &materials[number as usize]);
        own.differs_in_eigenstrain_alone(other)
    };
    match other {
        Some(other) if other == own || same(other) => Behind::Same,
        Some(other) if young(other) >= HOLDS * young(own) => Behind::Stiff,
        _ => Behind::Other,
    }
}

/// The corner next to the lowest along an axis.
fn corner_beyond(axis: usize) -> usize {
    4 >> axis
}

/// The corners of a face, in the order of the cube's.
fn face(vertices: [u32; 8], axis: usize, side: usize) -> [u32; 4] {
    let (b, c) = (corner_beyond((axis + 1) % 3), corner_beyond((axis + 2) % 3));
    let first = side * corner_beyond(axis);
    [first, first + b, first + c, first + b + c].map(|corner| vertices[corner])
}

/// Tests whether a voxel is full to rounding.
pub(crate) fn is_full(hex8: &Hex8) -> bool {
    let near = |value: f64, full: f64| (value - full).abs() < FULL_SLACK;
    let Filling {
        shift,
        spread,
        products,
        ..
    } = hex8.filling;
    near(hex8.fraction, 1.0)
        && [shift, products]
            .as_flattened()
            .iter()
            .all(|&value| near(value, 0.0))
        && spread.iter().all(|&value| near(value, 1.0))
}

fn is_covered(corners: [u32; 4], layers: &HashSet<[u32; 3]>) -> bool {
    let [a, b, c, d] = corners;
    let triangles = [[a, b, c], [a, b, d], [a, c, d], [b, c, d]];
    !layers.is_empty() && triangles.iter().any(|t| layers.contains(&sorted(*t)))
}

fn sorted(mut triangle: [u32; 3]) -> [u32; 3] {
    triangle.sort_unstable();
    triangle
}
