//! Functions of the triply periodic surfaces, with their derivatives.

/// Triply periodic surfaces, approximated by their leading Fourier terms.
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

/// The function g at a point, given by its phases in rad.
pub(super) struct Wave {
    surface: Surface,
    s: [f64; 3],
    c: [f64; 3],
}

impl Surface {
    /// Lowest and highest value of g, the limits of a useful level.
    pub(super) fn limits(self) -> [f64; 2] {
        match self {
            Self::Gyroid => [-1.5, 1.5],
            Self::SchwarzP => [-3.0, 3.0],
            Self::SchwarzD => [-1.0, 1.0],
            Self::Neovius => [-13.0, 13.0],
            Self::Iwp => [-5.0, 3.0],
        }
    }

    pub(super) fn at(self, phases: [f64; 3]) -> Wave {
        self.of(phases.map(f64::sin_cos))
    }

    /// The function at a point, from the sine and cosine of each phase.
    pub(super) fn of(self, parts: [(f64, f64); 3]) -> Wave {
        Wave {
            surface: self,
            s: parts.map(|(sine, _)| sine),
            c: parts.map(|(_, cosine)| cosine),
        }
    }
}

impl Wave {
    /// Value of g.
    pub fn value(&self) -> f64 {
        let ([a, b, d], [p, q, r]) = (self.s, self.c);
        match self.surface {
            Surface::Gyroid => a * q + b * r + d * p,
            Surface::SchwarzP => p + q + r,
            Surface::SchwarzD => p * q * r - a * b * d,
            Surface::Neovius => 3.0 * (p + q + r) + 4.0 * p * q * r,
            // cos 2x = 2cos²x − 1
            Surface::Iwp => 2.0 * (p * q + q * r + r * p) - 2.0 * (p * p + q * q + r * r) + 3.0,
        }
    }

    /// Gradient ∇g.
    pub fn slope(&self) -> [f64; 3] {
        let (s, c) = (self.s, self.c);
        [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            match self.surface {
                Surface::Gyroid => c[i] * c[j] - s[k] * s[i],
                Surface::SchwarzP => -s[i],
                Surface::SchwarzD => -s[i] * c[j] * c[k] - c[i] * s[j] * s[k],
                Surface::Neovius => -s[i] * (3.0 + 4.0 * c[j] * c[k]),
                Surface::Iwp => -2.0 * s[i] * (c[j] + c[k] - 2.0 * c[i]),
            }
        })
    }

    /// Product of the Hessian ∇∇g with a direction.
    pub fn bend_along(&self, t: [f64; 3]) -> [f64; 3] {
        let (diagonal, mixed) = self.bend();
        [
            diagonal[0] * t[0] + mixed[2] * t[1] + mixed[1] * t[2],
            mixed[2] * t[0] + diagonal[1] * t[1] + mixed[0] * t[2],
            mixed[1] * t[0] + mixed[0] * t[1] + diagonal[2] * t[2],
        ]
    }

    /// Hessian ∇∇g: the diagonal, then the entries yz, zx, xy.
    pub fn bend(&self) -> ([f64; 3], [f64; 3]) {
        let (s, c) = (self.s, self.c);
        let each = |f: &dyn Fn(usize, usize, usize) -> f64| {
            [0, 1, 2].map(|i| f(i, (i + 1) % 3, (i + 2) % 3))
        };
        match self.surface {
            Surface::Gyroid => (
                each(&|i, j, k| -s[i] * c[j] - s[k] * c[i]),
                each(&|_, j, k| -c[j] * s[k]),
            ),
            Surface::SchwarzP => (c.map(|v| -v), [0.0; 3]),
            Surface::SchwarzD => (
                each(&|i, j, k| s[i] * s[j] * s[k] - c[i] * c[j] * c[k]),
                each(&|i, j, k| s[j] * s[k] * c[i] - c[j] * c[k] * s[i]),
            ),
            Surface::Neovius => (
                each(&|i, j, k| -c[i] * (3.0 + 4.0 * c[j] * c[k])),
                each(&|i, j, k| 4.0 * s[j] * s[k] * c[i]),
            ),
            Surface::Iwp => (
                each(&|i, j, k| -2.0 * c[i] * (c[j] + c[k]) + 4.0 * (2.0 * c[i] * c[i] - 1.0)),
                each(&|_, j, k| 2.0 * s[j] * s[k]),
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Surface; 5] = [
        Surface::Gyroid,
        Surface::SchwarzP,
        Surface::SchwarzD,
        Surface::Neovius,
        Surface::Iwp,
    ];

    /// Central differences of step h are off by h²/6 times the third derivative, which is at most
    /// 8·13 here, and by rounding of 13·2⁻⁵²/h: together under 2e-8 for h = 1e-5.
    #[test]
    fn derivatives_match_central_differences() {
        let (h, place) = (1e-5, [0.3, 1.1, -2.2]);
        let moved = |axis: usize, by: f64| {
            let mut p = place;
            p[axis] += by;
            p
        };
        for surface in ALL {
            let (diagonal, mixed) = surface.at(place).bend();
            for axis in 0..3 {
                let (up, down) = (surface.at(moved(axis, h)), surface.at(moved(axis, -h)));
                let slope = (up.value() - down.value()) / (2.0 * h);
                assert!(
                    (slope - surface.at(place).slope()[axis]).abs() < 2e-8,
                    "{surface:?}"
                );
                for other in 0..3 {
                    let bend = (up.slope()[other] - down.slope()[other]) / (2.0 * h);
                    let expected = if axis == other {
                        diagonal[axis]
                    } else {
                        mixed[3 - axis - other]
                    };
                    assert!((bend - expected).abs() < 2e-8, "{surface:?} {axis}{other}");
                }
            }
        }
    }
}
