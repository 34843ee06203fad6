//! Thinning of the layers of a bent voxel, in proportion to their present shape.

use crate::element::coordinates::Axes;
use crate::hyperelastic::symmetric::Sym;

/// A stretch along a voxel's axis below which thickness ratios are continued smoothly: a voxel pressed flat must not
/// ask for infinite thinning.
const LEAST_STRETCH: f64 = 0.2;

/// Positive substitute for a stretch along an axis, with derivatives: `x` itself, and a parabola that joins it below
/// [`LEAST_STRETCH`].
pub(crate) fn positive(x: f64) -> [f64; 3] {
    if x >= LEAST_STRETCH {
        [x, 1.0, 0.0]
    } else {
        [
            (LEAST_STRETCH + x * x / LEAST_STRETCH) / 2.0,
            x / LEAST_STRETCH,
            1.0 / LEAST_STRETCH,
        ]
    }
}

/// The ratios `Sₙₙ/Sᵢᵢ` and `Sₙₙ/Sⱼⱼ`: a stretched voxel thins in proportion to its present shape.
pub(crate) struct Thickness {
    pub first: f64,
    pub second: f64,
    pub n: [f64; 3],
    pub i: [f64; 3],
    pub j: [f64; 3],
}

impl Thickness {
    pub fn of(stretch: &Sym, (n, i, j): Axes) -> Self {
        let [n, i, j] = [n, i, j].map(|axis| positive(stretch[axis]));
        Self {
            first: n[0] / i[0],
            second: n[0] / j[0],
            n,
            i,
            j,
        }
    }
}
