//! Faces of a voxel, and the corrections of its element that follow from them.

use crate::element::coordinates::AXES;
use crate::matrix::{IDENTITY, Mat3};

/// `c` of a plate: the rest of Reissner's factor 5/6.
pub(crate) const PLATE: f64 = 1.0 / 6.0;

/// The parts `cⱼ, cₖ` of the shear of each pair of axes by which free faces soften a voxel. Pairs are named by the axis
/// that is not in them, `j` and `k` come after it in turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WarpingModes {
    parts: [[f64; 2]; 3],
    /// The share of faces under pressure in these parts.
    pressed: [[f64; 2]; 3],
    /// Relief by re-entrant edges: the part of each remaining shear.
    pub(crate) edges: [f64; 3],
    /// Shears whose relief by edges thins the voxel and leaves its volume as it is.
    pub(crate) thins: [bool; 3],
    /// At the surface: a face is free, or the surface cuts the voxel.
    pub(crate) surface: bool,
    /// Lateral contraction at a clamp, in place of the parts.
    pub(crate) clamped: Option<ClampModes>,
    /// The axes of the pairs, as columns: those of the voxel, or the normals of the surface that cuts it.
    pub(crate) frame: Mat3,
}

/// Classification of the faces of a voxel at the two sides of each axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FaceConditions {
    /// Free faces: nothing is joined to them, and nothing holds them.
    pub free: [[bool; 2]; 3],
    /// Stiff faces, which must not move along their axis except with their corners.
    pub stiff: [[bool; 2]; 3],
    /// Faces held in full by a clamp or a stiffer material.
    pub held: [[bool; 2]; 3],
    /// Faces under pressure.
    pub pressed: [[bool; 2]; 3],
    /// Faces with nothing behind them that a clamp or a layer holds.
    pub covered: [[bool; 2]; 3],
}

impl WarpingModes {
    /// No warping: no free face.
    pub const NONE: Self = Self {
        parts: [[0.0; 2]; 3],
        pressed: [[0.0; 2]; 3],
        edges: [0.0; 3],
        thins: [false; 3],
        surface: false,
        clamped: None,
        frame: IDENTITY,
    };

    /// No warping of a voxel at the surface.
    pub const SURFACE: Self = Self {
        surface: true,
        ..Self::NONE
    };

    /// Tests whether free faces or edges take a part of a shear.
    pub(crate) fn has_parts(&self) -> bool {
        self.parts != Self::NONE.parts || self.has_edges()
    }

    /// Tests whether re-entrant edges take a part of a shear.
    pub(crate) fn has_edges(&self) -> bool {
        self.edges != [0.0; 3]
    }

    /// The part of each shear that faces relieve.
    pub(crate) fn of_faces(&self) -> [f64; 3] {
        self.parts.map(|[j, k]| j + k)
    }

    /// Tests whether the axes of the pairs are others than those of the voxel.
    pub(crate) fn is_turned(&self) -> bool {
        self.frame != IDENTITY
    }

    /// The roots of the remaining fractions `1 − cⱼ − cₖ` of each shear.
    pub(crate) fn shears(&self) -> [f64; 3] {
        self.parts.map(|[j, k]| (1.0 - j - k).sqrt())
    }

    /// The roots for the volume, which faces under pressure leave as it is.
    pub(crate) fn volume_shears(&self) -> [f64; 3] {
        std::array::from_fn(|b| {
            let ([j, k], [on_j, on_k]) = (self.parts[b], self.pressed[b]);
            (1.0 - (j - on_j) - (k - on_k)).sqrt()
        })
    }

    /// The parts of each pair of axes that thin the voxel, by faces under pressure.
    pub(crate) fn thinning_parts(&self) -> [[f64; 2]; 3] {
        self.pressed
    }

    /// Parts in a frame, which thin the voxel as under pressure.
    pub(crate) fn in_frame(frame: Mat3, parts: [[f64; 2]; 3]) -> Self {
        Self {
            parts,
            pressed: parts,
            frame,
            ..Self::SURFACE
        }
    }

    /// The warping of a full voxel of isotropic rubber.
    pub fn of(faces: &FaceConditions) -> Self {
        let clamped = ClampModes::of(faces);
        if clamped.is_some() {
            return Self {
                clamped,
                ..Self::SURFACE
            };
        }
        let free: [u8; 3] = faces.free.map(|sides| sides.map(u8::from).iter().sum());
        let stiff = faces.stiff.map(|[low, high]| low || high);
        let parts = AXES.map(|(b, j, k)| {
            // Modes of the faces of one axis move those of the other.
            let counts = [(j, k), (k, j)].map(|(n, t)| if stiff[t] { 0 } else { free[n] });
            let thin = [free[j], free[k]].map(|count| count == 2);
            match thin {
                [false, false] => condensed(counts.map(f64::from)),
                _ if free[b] == 1 => condensed(counts.map(f64::from)),
                [true, true] => [0.0; 2],
                _ => std::array::from_fn(|side| {
                    if thin[side] && counts[side] == 2 {
                        PLATE
                    } else {
                        0.0
                    }
                }),
            }
        });
        let is_pressed =
            |axis: usize| (0..2).any(|s| faces.free[axis][s] && faces.pressed[axis][s]);
        let mut pressed = parts;
        for (own, (_, j, k)) in pressed.iter_mut().zip(AXES) {
            for (part, axis) in own.iter_mut().zip([j, k]) {
                *part *= f64::from(u8::from(is_pressed(axis)));
            }
        }
        Self {
            parts,
            pressed,
            surface: faces.free.as_flattened().contains(&true),
            ..Self::NONE
        }
    }
}

/// `cⱼ, cₖ` for numbers of free faces.
pub(crate) fn condensed([j, k]: [f64; 2]) -> [f64; 2] {
    let determinant = (30.0 - 4.0 * j) * (30.0 - 4.0 * k) - 36.0 * j * k;
    [(j, k), (k, j)].map(|(own, other)| own * 5.0 * (30.0 - 10.0 * other) / determinant)
}

/// A voxel at a clamp: the axis of its held faces, its free faces across, and those of them under pressure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ClampModes {
    pub(crate) axis: usize,
    pub(crate) free: [[bool; 2]; 3],
    pub(crate) pressed: [[bool; 2]; 3],
}

impl ClampModes {
    /// Classifies a voxel with held faces on one axis; `None` if no face is free to draw in.
    pub fn of(faces: &FaceConditions) -> Option<Self> {
        let has = |sides: [bool; 2]| sides.contains(&true);
        let mut axes = (0..3).filter(|&axis| has(faces.held[axis]));
        let (axis, further) = (axes.next()?, axes.next());
        // A voxel whose face across the clamp is free, the end of a stub, warps as other free faces do.
        if further.is_some() || has(faces.free[axis]) {
            return None;
        }
        let mut own = Self {
            axis,
            free: [[false; 2]; 3],
            pressed: [[false; 2]; 3],
        };
        for (n, t) in across(axis) {
            // Modes of the faces `n` move the faces of `t`.
            if !has(faces.stiff[t]) {
                own.free[n] = faces.free[n];
                own.pressed[n] = [0, 1].map(|side| faces.free[n][side] && faces.pressed[n][side]);
            }
        }
        (own.free != own.pressed).then_some(own)
    }
}

/// The two axes across an axis, each with the other of them.
pub(crate) fn across(axis: usize) -> [(usize, usize); 2] {
    let (_, j, k) = AXES[axis];
    [(j, k), (k, j)]
}
