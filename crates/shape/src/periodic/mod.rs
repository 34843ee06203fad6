//! Triply periodic surfaces and strut lattices.
//!
//! Both are true distances if period and thickness are numbers. If the period is a function of space, space is
//! stretched: the distance is then that of a lattice with the local period.
mod closest;
mod struts;
mod waves;

use std::f64::consts::TAU;

use crate::bounds::Bounds;
use crate::check;
use crate::error::BuildError;
use crate::expr::Expr;
use crate::shape::Shape;

pub use struts::Struts;
pub use waves::Surface;

/// Checks a length in m that may be graded: a constant must be positive.
fn check_positive(name: &'static str, value: &Expr) -> Result<(), BuildError> {
    value
        .as_constant()
        .map_or(Ok(()), |v| check::positive(name, v).map(|_| ()))
}

impl Surface {
    /// Signed distance to g = level in m, negative where g is lower.
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
        let phases = Expr::axes().map(|axis| axis * (TAU / period.clone()));
        Ok(Expr::field(closest::shared(self, level), phases) * (period.clone() / TAU))
    }

    /// Sheet of `thickness` (m) around the surface g = level: all points within half of it.
    pub fn sheet(self, period: &Expr, thickness: &Expr, level: f64) -> Result<Shape, BuildError> {
        check_positive("thickness", thickness)?;
        let distance = self.distance(period, level)?;
        Ok(periodic(distance.abs() - thickness.clone() / 2.0))
    }

    /// Solid on the side g < level of the surface.
    pub fn solid(self, period: &Expr, level: f64) -> Result<Shape, BuildError> {
        Ok(periodic(self.distance(period, level)?))
    }
}

fn periodic(expr: Expr) -> Shape {
    Shape {
        expr,
        bounds: Bounds::ALL,
        growth: 1.0,
    }
}
