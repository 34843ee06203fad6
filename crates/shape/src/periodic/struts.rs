//! Strut lattices as true distances.
use super::{check_positive, periodic};
use crate::error::BuildError;
use crate::expr::{Expr, length};
use crate::shape::Shape;

/// Strut lattices: round bars between points of a cubic cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Struts {
    /// Along the cell's edges
    Cubic,
    /// From the cell's center to its corners
    Bcc,
    /// From the corners to the centers of the faces
    Fcc,
    /// The face-centered lattice and the octahedron between its face centers
    Octet,
}

impl Struts {
    /// Makes bars of diameter `thickness` (m); a corner of a cell lies at the origin.
    pub fn lattice(self, period: &Expr, thickness: &Expr) -> Result<Shape, BuildError> {
        check_positive("period", period)?;
        check_positive("thickness", thickness)?;
        // Mirror symmetry about every cell face and middle plane folds space into an eighth of a
        // cell: each coordinate becomes its distance to the nearest cell corner plane, in [0, 1/2]
        // periods.
        let folded = Expr::axes().map(|axis| (axis / period.clone()).triangle());
        let bars: Vec<Expr> = match self {
            Self::Cubic => (0..3)
                .map(|i| length(&[f(&folded, i + 1), f(&folded, i + 2)]))
                .collect(),
            Self::Bcc => vec![segment(&folded, [0.0; 3], [0.5; 3])],
            Self::Fcc => face_bars(&folded),
            Self::Octet => {
                let mut bars = face_bars(&folded);
                let half = |i: usize| [0, 1, 2].map(|j| if i == j { 0.0 } else { 0.5 });
                bars.extend((0..3).map(|i| segment(&folded, half(i), half((i + 1) % 3))));
                bars
            }
        };
        let nearest = bars
            .into_iter()
            .reduce(|a, b| a.min(b))
            .unwrap_or_else(|| 0.0.into());
        Ok(periodic(nearest * period.clone() - thickness.clone() / 2.0))
    }
}

fn f(folded: &[Expr; 3], axis: usize) -> Expr {
    folded[axis % 3].clone()
}

/// Distances to the bars from the corner to the centers of the three faces that meet there.
fn face_bars(folded: &[Expr; 3]) -> Vec<Expr> {
    (0..3)
        .map(|i| {
            segment(
                folded,
                [0.0; 3],
                [0, 1, 2].map(|j| if i == j { 0.0 } else { 0.5 }),
            )
        })
        .collect()
}

/// Distance to the segment from `a` to `b` in folded coordinates.
fn segment(p: &[Expr; 3], a: [f64; 3], b: [f64; 3]) -> Expr {
    let d = [0, 1, 2].map(|i| b[i] - a[i]);
    let squared: f64 = d.iter().map(|v| v * v).sum();
    let local = [0, 1, 2].map(|i| p[i].clone() - a[i]);
    let along = (0..3)
        .filter(|&i| d[i] != 0.0)
        .map(|i| local[i].clone() * (d[i] / squared))
        .reduce(|a, b| a + b)
        .unwrap_or_else(|| 0.0.into())
        .clamp(0.0, 1.0);
    length(&[0, 1, 2].map(|i| local[i].clone() - along.clone() * d[i]))
}
