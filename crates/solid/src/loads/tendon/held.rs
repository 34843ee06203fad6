//! Friction during a step over time: with bounds from the state before, it has a potential.
//!
//! At bend `i` friction takes `q_i = T_i − T_{i+1}`, and the line slides toward the motor by `s_i = −Σ_{j>i} (l_j − l_jⁿ)`,
//! by what is beyond has become shorter. Coulomb's law with the bounds of the state before is the derivative of
//! `φ(s)`, `φ' = min(max(qⁿ + k s, low), high)`, which is convex: the return mapping of a step and its energy.

/// A bend during a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct HeldBend {
    /// What friction took before, in N.
    before: f64,
    /// What it can take, in N.
    low: f64,
    high: f64,
    /// By which it takes more where the line sticks, in N/m.
    stiffness: f64,
}

impl HeldBend {
    /// From the tensions on both sides of it before, `e^{−μθ}`, and the stiffness of what sticks.
    pub fn new([ahead, beyond]: [f64; 2], decay: f64, stiffness: f64) -> Self {
        let low = ahead * (1.0 - 1.0 / decay);
        let high = ahead * (1.0 - decay);
        Self {
            before: (ahead - beyond).clamp(low, high),
            low,
            high,
            stiffness,
        }
    }

    /// What friction takes (N) where the line has slid by `slip` (m), and the derivative of that.
    pub fn force(&self, slip: f64) -> (f64, f64) {
        let sticking = self.before + self.stiffness * slip;
        if sticking <= self.low {
            (self.low, 0.0)
        } else if sticking >= self.high {
            (self.high, 0.0)
        } else {
            (sticking, self.stiffness)
        }
    }

    /// The integral of that from no slip on, J.
    pub fn potential(&self, slip: f64) -> f64 {
        let (force, slope) = self.force(slip);
        if slope > 0.0 || self.stiffness == 0.0 {
            return 0.5 * (self.before + force) * slip;
        }
        // It slides from where it reaches its bound.
        let until = (force - self.before) / self.stiffness;
        0.5 * (self.before + force) * until + force * (slip - until)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_force_is_the_slope_of_the_potential() {
        let bend = HeldBend::new([5.0, 4.6], 0.8, 1e3);
        for slip in [-5e-3, -1e-3, -1e-4, 0.0, 2e-4, 5e-4, 4e-3] {
            let step = 1e-8;
            let slope = (bend.potential(slip + step) - bend.potential(slip - step)) / (2.0 * step);
            assert!((slope - bend.force(slip).0).abs() < 1e-5, "{slip}");
        }
        assert_eq!(bend.force(1.0), (5.0 * (1.0 - 0.8), 0.0));
        assert_eq!(bend.force(-1.0), (5.0 * (1.0 - 1.0 / 0.8), 0.0));
        assert_eq!(bend.potential(0.0), 0.0);
    }
}
