//! Drivers of the modes at a clamp: strains of the voxel, faded out where these are large
//! ([`crate::element::clamp_modes`]).

use crate::element::coordinates::{STRAIN_COMPONENTS, StrainFunction};
use crate::element::rotated::Rotated;
use crate::element::thickness::positive;

/// All `d`, and `φ` with two derivatives by `ρ²`, the sum of their squares, and the derivatives of `ρ²`.
pub(crate) struct GeneralizedStrains {
    each: [GeneralizedStrain; STRAIN_COMPONENTS],
    fading: [f64; 3],
    square: [f64; STRAIN_COMPONENTS],
}

/// One of the `d`: its value, and its derivatives by its own coordinate and by the stretch (index, along an axis) that
/// normalizes it.
struct GeneralizedStrain {
    value: f64,
    by_own: f64,
    by_stretch: Option<(usize, f64)>,
    own_own: f64,
    own_stretch: f64,
    stretch_stretch: f64,
}

impl GeneralizedStrains {
    pub(crate) fn of(state: &Rotated) -> Self {
        let each = std::array::from_fn(|place| GeneralizedStrain::of(state, place));
        let square = each
            .iter()
            .map(|d: &GeneralizedStrain| d.value * d.value)
            .sum::<f64>();
        let mut own = Self {
            fading: fading(square),
            square: [0.0; STRAIN_COMPONENTS],
            each,
        };
        let twice = own.values().map(|d| 2.0 * d);
        own.square = own.slopes(&twice);
        own
    }

    pub(crate) fn values(&self) -> [f64; STRAIN_COMPONENTS] {
        std::array::from_fn(|place| self.each[place].value)
    }

    /// The derivatives of a linear combination of the `d` with these coefficients.
    pub(crate) fn slopes(
        &self,
        coefficients: &[f64; STRAIN_COMPONENTS],
    ) -> [f64; STRAIN_COMPONENTS] {
        let mut slopes = [0.0; STRAIN_COMPONENTS];
        for (place, (strain, factor)) in self.each.iter().zip(coefficients).enumerate() {
            slopes[place] += factor * strain.by_own;
            if let Some((stretch, by)) = strain.by_stretch {
                slopes[stretch] += factor * by;
            }
        }
        slopes
    }

    /// Adds the second derivatives of a linear combination of the `d`.
    pub(crate) fn add_curvatures(
        &self,
        coefficients: &[f64; STRAIN_COMPONENTS],
        hessian: &mut [[f64; STRAIN_COMPONENTS]; STRAIN_COMPONENTS],
    ) {
        for (place, (strain, factor)) in self.each.iter().zip(coefficients).enumerate() {
            hessian[place][place] += factor * strain.own_own;
            if let Some((stretch, _)) = strain.by_stretch {
                hessian[place][stretch] += factor * strain.own_stretch;
                hessian[stretch][place] += factor * strain.own_stretch;
                hessian[stretch][stretch] += factor * strain.stretch_stretch;
            }
        }
    }

    /// A linear combination of the `φ d`, and its derivatives.
    pub(crate) fn faded(
        &self,
        coefficients: &[f64; STRAIN_COMPONENTS],
    ) -> (f64, [f64; STRAIN_COMPONENTS]) {
        let [factor, first, _] = self.fading;
        let whole = dot_all(coefficients, &self.values());
        let mut slopes = self.slopes(coefficients);
        for (slope, square) in slopes.iter_mut().zip(&self.square) {
            *slope = factor * *slope + first * whole * square;
        }
        (factor * whole, slopes)
    }

    /// Adds the second derivatives of a linear combination of the `φ d`.
    pub(crate) fn add_faded_curvatures(
        &self,
        coefficients: &[f64; STRAIN_COMPONENTS],
        hessian: &mut [[f64; STRAIN_COMPONENTS]; STRAIN_COMPONENTS],
    ) {
        let [factor, first, second] = self.fading;
        let whole = dot_all(coefficients, &self.values());
        let slopes = self.slopes(coefficients);
        // With ρ² = Σ d²: those of `φ` are φ″ ∂ρ² ⊗ ∂ρ² + 2φ′ Σ (∂d ⊗ ∂d + d ∂²d).
        let twice = 2.0 * first * whole;
        let combined: [f64; STRAIN_COMPONENTS] =
            std::array::from_fn(|k| factor * coefficients[k] + twice * self.each[k].value);
        self.add_curvatures(&combined, hessian);
        self.add_squares(twice, hessian);
        for row in 0..STRAIN_COMPONENTS {
            for column in 0..STRAIN_COMPONENTS {
                let (a, b) = (self.square[row], self.square[column]);
                hessian[row][column] +=
                    first * (a * slopes[column] + slopes[row] * b) + second * whole * a * b;
            }
        }
    }
}

impl GeneralizedStrains {
    /// Adds `factor Σ ∂d ⊗ ∂d`.
    fn add_squares(
        &self,
        factor: f64,
        hessian: &mut [[f64; STRAIN_COMPONENTS]; STRAIN_COMPONENTS],
    ) {
        for (place, strain) in self.each.iter().enumerate() {
            let (stretch, by) = strain.by_stretch.unwrap_or((place, 0.0));
            hessian[place][place] += factor * strain.by_own * strain.by_own;
            hessian[place][stretch] += factor * strain.by_own * by;
            hessian[stretch][place] += factor * strain.by_own * by;
            hessian[stretch][stretch] += factor * by * by;
        }
    }

    /// Multiplies a function of the coordinates by `φ`, including its second derivatives if `second`.
    pub(crate) fn fade(&self, of: &mut StrainFunction, second: bool) {
        let [factor, slope, turn] = self.fading;
        if second {
            let twice = 2.0 * slope * of.value;
            for row in 0..STRAIN_COMPONENTS {
                for column in 0..STRAIN_COMPONENTS {
                    let (a, b) = (self.square[row], self.square[column]);
                    let entry = &mut of.hessian[row][column];
                    *entry = factor * *entry
                        + slope * (a * of.gradient[column] + of.gradient[row] * b)
                        + turn * of.value * a * b;
                }
            }
            let combined = self.values().map(|d| twice * d);
            self.add_curvatures(&combined, &mut of.hessian);
            self.add_squares(twice, &mut of.hessian);
        }
        for (own, square) in of.gradient.iter_mut().zip(&self.square) {
            *own = factor * *own + slope * of.value * square;
        }
        of.value *= factor;
    }
}

pub(crate) fn dot_all(a: &[f64; STRAIN_COMPONENTS], b: &[f64; STRAIN_COMPONENTS]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Largest `ρ`, the root of the sum of the squares of the `d`, before the `q` level off.
const MOST_STRAIN: f64 = 0.3;

/// `φ = (1 + (ρ/ρ₀)⁴)^(−1/4)` with two derivatives by `ρ²`.
fn fading(square: f64) -> [f64; 3] {
    let scale = MOST_STRAIN.powi(-4);
    let base = 1.0 + scale * square * square;
    let factor = base.powf(-0.25);
    // φ⁴ = 1/base: 4 φ³ φ′ = −2 s ρ²/base².
    let first = -0.5 * scale * square * factor / base;
    let second = -0.5 * scale * factor / base * (1.0 - 2.5 * scale * square * square / base);
    [factor, first, second]
}

impl GeneralizedStrain {
    fn of(state: &Rotated, place: usize) -> Self {
        if place < 3 {
            let [stretch, slope, turn] = positive(state.stretch[place]);
            return Self {
                value: stretch.ln(),
                by_own: slope / stretch,
                own_own: turn / stretch - (slope / stretch).powi(2),
                ..Self::itself(0.0)
            };
        }
        if place < 6 {
            return Self::itself(state.stretch[place]);
        }
        let axis = (place - 6) % 3;
        let own = state.elastic_hourglass((place - 6) / 3, axis);
        let [stretch, slope, turn] = positive(state.stretch[axis]);
        Self {
            value: own / stretch,
            by_own: 1.0 / stretch,
            by_stretch: Some((axis, -own * slope / stretch.powi(2))),
            own_own: 0.0,
            own_stretch: -slope / stretch.powi(2),
            stretch_stretch: own * (2.0 * slope * slope / stretch.powi(3) - turn / stretch.powi(2)),
        }
    }

    fn itself(value: f64) -> Self {
        Self {
            value,
            by_own: 1.0,
            by_stretch: None,
            own_own: 0.0,
            own_stretch: 0.0,
            stretch_stretch: 0.0,
        }
    }
}
