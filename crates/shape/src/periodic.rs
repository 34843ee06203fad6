//! Triply periodic surfaces and strut lattices.
//!
//! A surface g = 0 is turned into a distance. All functions here solve ∇²g = −(κk)²g, or are sums
//! of two that do; on a normal at the distance d that reads g'' = −(κk)²g − 2Hg', with the mean
//! curvature H. Without the last term g runs as a sine, and the distance is s = asin(q)/(κk) with q
//! = κg/√(|∇g|²/k² + κ²g²) and k = 2π/period. The last term shifts both faces of a wall the same
//! way by Hd², so a wall's thickness is right up to a relative error of second order in
//! thickness/period. The inverse sine is cut after its fifth power, which keeps its slope finite.
use std::f64::consts::TAU;

use crate::bounds::Bounds;
use crate::check;
use crate::error::BuildError;
use crate::expr::{Expr, length};
use crate::shape::Shape;

/// The triply periodic surfaces, by their leading Fourier terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// sin x cos y + sin y cos z + sin z cos x
    Gyroid,
    /// cos x + cos y + cos z
    SchwarzP,
    /// cos x cos y cos z − sin x sin y sin z
    SchwarzD,
    /// 3(cos x + cos y + cos z) + 4 cos x cos y cos z
    Neovius,
    /// 2(cos x cos y + cos y cos z + cos z cos x) − (cos 2x + cos 2y + cos 2z)
    Iwp,
}

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

/// A function of space used as a number: a length in m that may be graded.
fn check_positive(name: &'static str, value: &Expr) -> Result<(), BuildError> {
    value
        .as_constant()
        .map_or(Ok(()), |v| check::positive(name, v).map(|_| ()))
}

impl Surface {
    /// −∇²g/(k²g) as κ; for Neovius and I-WP, sums of two waves, the value of the slower one.
    fn wave_number(self) -> f64 {
        match self {
            Self::Gyroid | Self::Iwp => 2.0_f64.sqrt(),
            Self::SchwarzP | Self::Neovius => 1.0,
            Self::SchwarzD => 3.0_f64.sqrt(),
        }
    }

    /// g and ∇g/k from the sines and cosines of the three phases.
    fn value_and_slope(self, s: &[Expr; 3], c: &[Expr; 3]) -> (Expr, [Expr; 3]) {
        let (s, c) = (|i: usize| s[i % 3].clone(), |i: usize| c[i % 3].clone());
        let sum = |f: &dyn Fn(usize) -> Expr| f(0) + f(1) + f(2);
        let each = |f: &dyn Fn(usize) -> Expr| [f(0), f(1), f(2)];
        match self {
            Self::Gyroid => (
                sum(&|i| s(i) * c(i + 1)),
                each(&|i| c(i) * c(i + 1) - s(i + 2) * s(i)),
            ),
            Self::SchwarzP => (sum(&c), each(&s)),
            Self::SchwarzD => (
                c(0) * c(1) * c(2) - s(0) * s(1) * s(2),
                each(&|i| s(i) * c(i + 1) * c(i + 2) + c(i) * s(i + 1) * s(i + 2)),
            ),
            Self::Neovius => (
                sum(&c) * 3.0 + c(0) * c(1) * c(2) * 4.0,
                each(&|i| s(i) * (3.0 + c(i + 1) * c(i + 2) * 4.0)),
            ),
            // cos 2a = 2cos²a − 1 and sin 2a = 2 sin a cos a
            Self::Iwp => (
                (sum(&|i| c(i) * c(i + 1)) - sum(&|i| c(i).square())) * 2.0 + 3.0,
                each(&|i| s(i) * (c(i + 1) + c(i + 2) - c(i) * 2.0) * 2.0),
            ),
        }
    }

    /// Lowest and highest value of g, the limits of a useful level.
    fn limits(self) -> [f64; 2] {
        match self {
            Self::Gyroid => [-1.5, 1.5],
            Self::SchwarzP => [-3.0, 3.0],
            Self::SchwarzD => [-1.0, 1.0],
            Self::Neovius => [-13.0, 13.0],
            Self::Iwp => [-5.0, 3.0],
        }
    }

    /// Half the least value of |∇g|²/k² + κ²g² in a period, found by sampling it.
    fn least_squared_size(self) -> f64 {
        match self {
            Self::Gyroid => 1.0,
            Self::SchwarzP | Self::SchwarzD => 0.5,
            Self::Neovius => 0.28,
            Self::Iwp => 5.0,
        }
    }

    fn distance(self, period: &Expr, level: f64) -> Result<Expr, BuildError> {
        check_positive("period", period)?;
        check::finite("level", level)?;
        let [low, high] = self.limits();
        if level <= low || level >= high {
            let allowed = "outside its limits nothing or everything is solid \
                (gyroid ±1.5, P ±3, D ±1, Neovius ±13, I-WP −5 to 3)";
            return Err(BuildError::OutOfRange {
                name: "level",
                value: level,
                allowed,
            });
        }
        let k = TAU / period.clone();
        let phases = Expr::axes().map(|axis| axis * k.clone());
        let (sines, cosines) = (
            phases.each_ref().map(Expr::sin),
            phases.each_ref().map(Expr::cos),
        );
        let (value, slope) = self.value_and_slope(&sines, &cosines);
        let kappa = self.wave_number();
        let wave = (value - level) * kappa;
        let squared = slope
            .iter()
            .fold(wave.square(), |sum, part| sum + part.square());
        // Both limits hold anyway, except at a singular point of a leveled surface; interval
        // arithmetic cannot know that numerator and denominator go together.
        let q = (wave / squared.max(self.least_squared_size()).sqrt()).clamp(-1.0, 1.0);
        let q2 = q.square();
        let arc = q * (1.0 + q2.clone() * (1.0 / 6.0 + q2 * (3.0 / 40.0)));
        Ok(arc / (k * kappa))
    }

    /// The wall of `thickness` (m) around the surface g = level.
    pub fn sheet(self, period: &Expr, thickness: &Expr, level: f64) -> Result<Shape, BuildError> {
        check_positive("thickness", thickness)?;
        let distance = self.distance(period, level)?;
        Ok(periodic(distance.abs() - thickness.clone() / 2.0))
    }

    /// The side g < level of the surface.
    pub fn solid(self, period: &Expr, level: f64) -> Result<Shape, BuildError> {
        Ok(periodic(self.distance(period, level)?))
    }
}

impl Struts {
    /// Bars of diameter `thickness` (m); a corner of a cell lies at the origin.
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

/// From the corner to the centers of the three faces that meet there.
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

fn periodic(expr: Expr) -> Shape {
    Shape {
        expr,
        bounds: Bounds::ALL,
        growth: 1.0,
    }
}
