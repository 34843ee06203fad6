//! Softening of rubber that was stretched before: the Mullins effect.
//!
//! Ogden and Roxburgh (doi 10.1098/rspa.1999.0431) reduce the isochoric stress of a material by a factor `η` where the
//! isochoric energy `W` is below the largest `P` that it has had, with Abaqus's constants
//!
//! `η = 1 − 1/r erf((P − W)/(m + β P))` ,   `η = 1` where `W ≥ P` .
//!
//! At a constant peak `P`, stress comes from a potential, `ψ' = η`: with `s = m + β P`, `x = (P − W)/s` and
//! `G(x) = x erf x + exp(−x²)/√π`, whose derivative is `erf`,
//!
//! `ψ(W) = W − s/r (G(P/s) − G(x))` ,   `ψ'' = 2/(r s √π) exp(−x²)` .
//!
//! It is the recoverable energy; `W − ψ` at `W = P` is the energy dissipated on the way there.

use std::f64::consts::FRAC_2_SQRT_PI;

use super::principal::Jet;
use crate::ProblemError;

/// The constants of the softening.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mullins {
    r: f64,
    m: f64,
    beta: f64,
    first: f64,
}

impl Mullins {
    /// Softening with `r` (above 1), `m` in J/m³ and `β` (not negative, and not both zero), and the initial peak
    /// (J/m³), the energy that all of the material has had before.
    pub fn new(r: f64, m: f64, beta: f64, first: f64) -> Result<Self, ProblemError> {
        for (what, value) in [
            ("r of softening, less 1", r - 1.0),
            ("m + beta of softening", m + beta),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ProblemError::NotPositive { what, value });
            }
        }
        for (what, value) in [
            ("m of softening (J/m³)", m),
            ("beta of softening", beta),
            ("earlier energy of softening (J/m³)", first),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(ProblemError::NotPositive { what, value });
            }
        }
        Ok(Self { r, m, beta, first })
    }

    /// The initial peak (J/m³): the energy that all of the material has had before.
    pub fn first(&self) -> f64 {
        self.first
    }

    /// `ψ`, `η` and `ψ''` at an energy, with the largest so far `peak` (J/m³).
    pub(crate) fn soften(&self, energy: f64, peak: f64) -> Jet {
        let scale = self.m + self.beta * peak;
        let lost = |x: f64| x * libm::erf(x) + 0.5 * FRAC_2_SQRT_PI * libm::exp(-x * x);
        if energy >= peak {
            let all = if peak > 0.0 {
                scale / self.r * (lost(peak / scale) - lost(0.0))
            } else {
                0.0
            };
            return [energy - all, 1.0, 0.0];
        }
        let x = (peak - energy) / scale;
        [
            energy - scale / self.r * (lost(peak / scale) - lost(x)),
            1.0 - libm::erf(x) / self.r,
            FRAC_2_SQRT_PI / (self.r * scale) * libm::exp(-x * x),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_the_derivatives_and_meet_at_the_peak() {
        let soft = Mullins::new(1.5, 20.0, 0.1, 0.0).unwrap();
        for energy in [0.0, 30.0, 99.0, 101.0] {
            let [_, slope, curvature] = soft.soften(energy, 100.0);
            let step = 1e-4;
            let [high, low] = [step, -step].map(|by| soft.soften(energy + by, 100.0));
            // Central differences are wrong by the square of a step of 3e-6 of the scale.
            assert!((slope - (high[0] - low[0]) / (2.0 * step)).abs() < 1e-8);
            assert!((curvature - (high[1] - low[1]) / (2.0 * step)).abs() < 1e-8);
        }
        let [below, above] = [99.999_999_9, 100.0].map(|energy| soft.soften(energy, 100.0));
        assert!((below[0] - above[0]).abs() < 1e-6 && (below[1] - above[1]).abs() < 1e-8);
        // At rest the recoverable energy vanishes.
        assert!(soft.soften(0.0, 100.0)[0].abs() < 1e-12);
        assert_eq!(soft.soften(5.0, 0.0), [5.0, 1.0, 0.0]);
    }

    #[test]
    fn invalid_constants_are_refused() {
        assert!(Mullins::new(1.0, 1.0, 0.1, 0.0).is_err());
        assert!(Mullins::new(2.0, 0.0, 0.0, 0.0).is_err());
        assert!(Mullins::new(2.0, -1.0, 2.0, 0.0).is_err());
        assert!(Mullins::new(2.0, 1.0, 0.0, f64::NAN).is_err());
    }
}
