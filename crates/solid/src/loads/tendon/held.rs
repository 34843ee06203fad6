//! Friction during a time step: with bounds from the state before, it has a potential.
//!
//! At bend `i` the friction force is `q_i = T_i − T_{i+1}`, and the line slides toward the motor by
//! `s_i = −Σ_{j>i} (l_j − l_jⁿ)`, the shortening of the path beyond. Coulomb's law with the bounds of the state before
//! is the derivative of `φ(s)`, `φ' = min(max(qⁿ + k s, low), high)`, which is convex: the return mapping of a step and
//! its energy.

use super::capstan::{Hold, Tensions};
use super::polyline::Polyline;
use super::{Drive, Tendon, dot_of};

/// A bend during a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct HeldBend {
    /// Friction force at zero slip, its lower and its upper bound, N.
    before: f64,
    low: f64,
    high: f64,
    /// The derivatives of these three by the tension at the pulled end.
    by_first: [f64; 3],
    /// Sticking stiffness: slope of the friction force by the slip, N/m.
    stiffness: f64,
}

/// Friction force at a bend, in N, and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Taken {
    pub force: f64,
    /// Derivative by the slip, N/m.
    pub by_slip: f64,
    /// Derivative by the tension at the pulled end.
    pub by_first: f64,
}

impl HeldBend {
    /// A bend from the tensions ahead of it and beyond before the step, their derivatives by the first one, `e^{−μθ}`,
    /// and the sticking stiffness.
    pub fn new(
        [ahead, beyond]: [f64; 2],
        [by_ahead, by_beyond]: [f64; 2],
        decay: f64,
        stiffness: f64,
    ) -> Self {
        let (least, most) = (1.0 - 1.0 / decay, 1.0 - decay);
        Self {
            before: (ahead - beyond).clamp(ahead * least, ahead * most),
            low: ahead * least,
            high: ahead * most,
            by_first: [by_ahead - by_beyond, by_ahead * least, by_ahead * most],
            stiffness,
        }
    }

    /// The friction force at a slip (m).
    pub fn taken(&self, slip: f64) -> Taken {
        let sticking = self.before + self.stiffness * slip;
        let [before, low, high] = self.by_first;
        let (force, by_slip, by_first) = if sticking <= self.low {
            (self.low, 0.0, low)
        } else if sticking >= self.high {
            (self.high, 0.0, high)
        } else {
            (sticking, self.stiffness, before)
        };
        Taken {
            force,
            by_slip,
            by_first,
        }
    }

    /// The integral of the friction force over the slip, J.
    pub fn potential(&self, slip: f64) -> f64 {
        let Taken { force, by_slip, .. } = self.taken(slip);
        if by_slip > 0.0 || self.stiffness == 0.0 {
            return 0.5 * (self.before + force) * slip;
        }
        // Sliding starts where the friction force reaches its bound.
        let until = (force - self.before) / self.stiffness;
        0.5 * (self.before + force) * until + force * (slip - until)
    }
}

impl Tendon {
    /// Tensions with held friction, and the compliance by the first one. The first tension of a line that is drawn in
    /// is `(L − M)/Σ c_j r_j`, with the tension ratios `r` of the last accepted state.
    pub(super) fn held_tensions(&self, line: &Polyline, factor: f64) -> (Tensions, Option<f64>) {
        let kept = &self.memory;
        let first_before = kept.as_ref().map_or(0.0, |kept| kept.tensions[0]);
        let (first, compliance) = match self.drive {
            Drive::Tension(tension) => ((factor * tension).max(0.0), None),
            Drive::Shortening { by, stiffness } => {
                let compliances = self.compliances(stiffness);
                let compliance = match kept {
                    Some(kept) if first_before > 0.0 => {
                        dot_of(&kept.tensions, &compliances) / first_before
                    }
                    _ => compliances.iter().sum(),
                };
                let stretch = (line.length() - self.material(by, factor)).max(0.0);
                (stretch / compliance, (stretch > 0.0).then_some(compliance))
            }
        };
        let mut found = Tensions {
            values: vec![first],
            holds: Vec::new(),
            by_first: vec![1.0],
        };
        for (bend, (held, slip)) in self.held_bends(line, first).iter().enumerate() {
            let taken = held.taken(*slip);
            found.values.push(found.values[bend] - taken.force);
            found.by_first.push(found.by_first[bend] - taken.by_first);
            found.holds.push(Hold::Differs(taken.by_slip));
        }
        let segments = self.lengths.len();
        found.values.resize(segments, first);
        found.by_first.resize(segments, 1.0);
        found.holds.resize(segments - 1, Hold::Differs(0.0));
        (found, compliance)
    }

    /// Bends during a step, each with its slip; none in the first step.
    pub(super) fn held_bends(&self, line: &Polyline, first: f64) -> Vec<(HeldBend, f64)> {
        let Some(kept) = &self.memory else {
            return Vec::new();
        };
        // A prescribed tension is that of this step, at the last accepted path; that of a line that is drawn in is
        // found in the step.
        let (before, slopes) = match self.drive {
            Drive::Tension(_) => {
                let now = Tensions::from_first(first, &kept.tensions, &kept.decays);
                (now.values, now.by_first)
            }
            Drive::Shortening { .. } => (kept.tensions.clone(), vec![0.0; kept.tensions.len()]),
        };
        let stick = self.stick_stiffness(Some(kept.tensions[0]));
        let (mut longer, mut material) = (0.0, 0.0);
        let mut bends = Vec::with_capacity(kept.decays.len());
        for (bend, decay) in kept.decays.iter().enumerate().rev() {
            longer += line.lengths[bend + 1] - kept.lengths[bend + 1];
            material += self.lengths[bend + 1];
            let sides = [before[bend], before[bend + 1]];
            let by_first = [slopes[bend], slopes[bend + 1]];
            let held = HeldBend::new(sides, by_first, *decay, stick / material);
            bends.push((held, -longer));
        }
        bends.reverse();
        bends
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_force_is_the_slope_of_the_potential() {
        let bend = HeldBend::new([5.0, 4.6], [0.0; 2], 0.8, 1e3);
        for slip in [-5e-3, -1e-3, -1e-4, 0.0, 2e-4, 5e-4, 4e-3] {
            let step = 1e-8;
            let slope = (bend.potential(slip + step) - bend.potential(slip - step)) / (2.0 * step);
            assert!((slope - bend.taken(slip).force).abs() < 1e-5, "{slip}");
        }
        assert_eq!(bend.taken(1.0).force, 5.0 * (1.0 - 0.8));
        assert_eq!(bend.taken(-1.0).force, 5.0 * (1.0 - 1.0 / 0.8));
        assert_eq!(bend.potential(0.0), 0.0);
    }
}
