//! Local frame of a primitive: position and orientation of its axes u, v, w.
use crate::bounds::Bounds;
use crate::check;
use crate::error::BuildError;
use crate::expr::Expr;

/// Orthonormal, right-handed axes at an origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Origin, m
    pub origin: [f64; 3],
    /// Unit vectors u, v, w
    pub axes: [[f64; 3]; 3],
}

impl Frame {
    /// A frame whose w axis points along `axis`. For the coordinate axes u and v are coordinate
    /// axes too (z gives x, y; x gives y, z; y gives z, x), so that nothing is rounded.
    pub fn along(origin: [f64; 3], axis: [f64; 3]) -> Result<Self, BuildError> {
        let w = check::direction("axis", axis)?;
        // The coordinate axis least parallel to w comes after the most parallel one in cyclic order
        // for coordinate axes, which keeps them exact.
        let main = (0..3)
            .max_by(|&a, &b| w[a].abs().total_cmp(&w[b].abs()))
            .unwrap_or(2);
        let mut start = [0.0; 3];
        start[(main + 1) % 3] = 1.0;
        let along = dot(start, w);
        let u = check::direction("axis", [0, 1, 2].map(|i| start[i] - along * w[i]))?;
        Ok(Self {
            origin: check::point("base", origin)?,
            axes: [u, cross(w, u), w],
        })
    }

    /// Local coordinates as expressions of x, y, z.
    pub fn coordinates(&self) -> [Expr; 3] {
        let from_origin = crate::operators::shifted_axes(self.origin);
        self.axes.map(|axis| {
            let terms = from_origin.iter().cloned().zip(axis);
            let products = terms.filter(|(_, c)| *c != 0.0).map(|(t, c)| t * c);
            products.reduce(|a, b| a + b).unwrap_or_else(|| 0.0.into())
        })
    }

    /// Coordinates in space of a local point.
    pub fn place(&self, local: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|i| self.origin[i] + (0..3).map(|a| local[a] * self.axes[a][i]).sum::<f64>())
    }

    /// The box around a solid of revolution about w: rings of radius r at height w.
    pub fn ring_bounds(&self, rings: &[(f64, f64)]) -> Bounds {
        // A ring of radius r reaches r·√(1 − wᵢ²) along coordinate i.
        let reach = self.axes[2].map(|w| (1.0 - w * w).max(0.0).sqrt());
        rings
            .iter()
            .fold(Bounds::EMPTY, |bounds, &(radius, height)| {
                let center = self.place([0.0, 0.0, height]);
                let ring = Bounds {
                    low: [0, 1, 2].map(|i| center[i] - radius * reach[i]),
                    high: [0, 1, 2].map(|i| center[i] + radius * reach[i]),
                };
                bounds.hull(&ring)
            })
    }
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
