//! Tension along a tendon with Coulomb friction at every bend, which depends on the last accepted tensions.
//!
//! At a bend of angle `θ` the tensions on both sides have a ratio between `e^{−μθ}` and `e^{μθ}` (Euler and Eytelwein).
//! As long as the line sticks at a bend, the rest beyond it is a line of its own that stretches from the state that was
//! accepted last. The tension that this gives is the tension after the bend unless it leaves the friction cone; then
//! the line slides over the bend, and the tension is on the side of the cone that is nearest: a return mapping, from
//! the pulled end on. So a line that is pulled, or whose path becomes shorter, has `T₁ e^{−μΣθ}` along it; one that is
//! eased afterwards first loses its tension near the pulled end; and one whose path becomes longer has `T₁ e^{μΣθ}`.

/// Law for the tension after a bend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Hold {
    /// Sliding: this multiple of the tension before the bend.
    Slides(f64),
    /// Sticking: the tension of the line beyond.
    Sticks,
    /// Held friction: the difference from the tension before changes with the length beyond at this rate, N/m.
    Differs(f64),
}

/// Tensions along a tendon, with the law of each.
#[derive(Debug)]
pub(super) struct Tensions {
    /// Tension in each segment, from the pulled end on, N.
    pub values: Vec<f64>,
    /// The law at each bend.
    pub holds: Vec<Hold>,
    /// The derivative of each value by the first one.
    pub by_first: Vec<f64>,
}

impl Tensions {
    /// Tensions from that at the pulled end, the tension that each segment would have if its bend stuck, and `e^{−μθ}`
    /// for each bend.
    pub fn from_first(first: f64, sticking: &[f64], decays: &[f64]) -> Self {
        let mut found = Self {
            values: vec![first],
            holds: Vec::with_capacity(decays.len()),
            by_first: vec![1.0],
        };
        let mut here = first;
        let mut slope = 1.0;
        for (bend, decay) in decays.iter().enumerate() {
            let (low, high) = (here * decay, here / decay);
            let kept = sticking[bend + 1];
            let hold = if kept <= low {
                Hold::Slides(*decay)
            } else if kept >= high {
                Hold::Slides(1.0 / decay)
            } else {
                Hold::Sticks
            };
            (here, slope) = match hold {
                Hold::Slides(ratio) => (ratio * here, ratio * slope),
                _ => (kept, 0.0),
            };
            found.values.push(here);
            found.by_first.push(slope);
            found.holds.push(hold);
        }
        found
    }

    /// Tensions from the total stretch of all segments over their lengths without tension, in m, where each stretches
    /// by its `compliance` (m/N); zero tensions if the stretch is not positive.
    ///
    /// No tension falls as the first one grows, so that the stretch is a growing function of it, linear between kinks:
    /// Newton's method, kept between bounds, ends between two of them.
    pub fn from_stretch(
        stretch: f64,
        compliances: &[f64],
        sticking: &[f64],
        decays: &[f64],
    ) -> Self {
        let all = |tensions: &[f64]| -> f64 {
            let pairs = tensions.iter().zip(compliances);
            pairs.map(|(a, b)| a * b).sum()
        };
        let (mut low, mut high) = (0.0, stretch.max(0.0) / compliances[0]);
        let mut first = sticking[0].clamp(low, high);
        loop {
            let found = Self::from_first(first, sticking, decays);
            let missing = stretch - all(&found.values);
            if missing > 0.0 {
                low = first;
            } else {
                high = first;
            }
            let next = first + missing / all(&found.by_first);
            // Equal to rounding.
            let near = 4.0 * f64::EPSILON * high;
            if (next - first).abs() <= near || high - low <= near {
                return found;
            }
            first = if low < next && next < high {
                next
            } else {
                0.5 * (low + high)
            };
        }
    }
}

impl Tensions {
    /// The tensions of a line that can also push: continued linearly where it becomes slack.
    pub fn taut(self, stretch: f64, compliances: &[f64], sticking: &[f64], decays: &[f64]) -> Self {
        // The directions of sliding at zero are those at a tiny tension.
        let first = self.values[0].max(f64::MIN_POSITIVE / f64::EPSILON);
        let mut found = Self::from_first(first, sticking, decays);
        let pairs = found.by_first.iter().zip(compliances);
        let compliance: f64 = pairs.map(|(a, b)| a * b).sum();
        let first = stretch / compliance;
        found.values = found.by_first.iter().map(|slope| slope * first).collect();
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Decays of four bends of 30 degrees with a friction of 0.3.
    fn decays() -> Vec<f64> {
        vec![libm::exp(-0.3 * std::f64::consts::FRAC_PI_6); 4]
    }

    #[test]
    fn pulled_line_has_the_capstan_tension() {
        let found = Tensions::from_first(8.0, &[0.0; 5], &decays());
        let expected = 8.0 * libm::exp(-0.3 * 4.0 * std::f64::consts::FRAC_PI_6);
        assert!((found.values[4] / expected - 1.0).abs() < 1e-14);
        assert!(
            found
                .holds
                .iter()
                .all(|hold| *hold == Hold::Slides(decays()[0]))
        );
    }

    #[test]
    fn eased_line_keeps_its_tension_far_from_the_pulled_end() {
        let pulled = Tensions::from_first(8.0, &[0.0; 5], &decays()).values;
        let eased = Tensions::from_first(6.0, &pulled, &decays());
        let ratio = decays()[0];
        assert_eq!(eased.holds[0], Hold::Sticks);
        assert_eq!(eased.values[1..], pulled[1..]);
        let more = Tensions::from_first(5.0, &pulled, &decays());
        assert_eq!(more.holds[..2], [Hold::Slides(1.0 / ratio), Hold::Sticks]);
        assert_eq!(more.values[2..], pulled[2..]);
        let again = Tensions::from_first(8.0, &more.values, &decays());
        for (a, b) in again.values.iter().zip(&pulled) {
            assert!(
                (a / b - 1.0).abs() < 1e-14,
                "pulled as far, it is as it was"
            );
        }
        let slack = Tensions::from_first(0.0, &pulled, &decays());
        assert_eq!(slack.values, [0.0; 5]);
    }

    #[test]
    fn tensions_match_a_prescribed_stretch() {
        let compliances = [1e-4, 2e-4, 1e-4, 3e-4, 1e-4];
        let mut before = vec![0.0; 5];
        for stretch in [2e-3, 3e-3, 2.9e-3, 2.2e-3, 0.5e-3, 2.5e-3, 0.0, -1.0, 1e-3] {
            let found = Tensions::from_stretch(stretch, &compliances, &before, &decays());
            let sum: f64 = found
                .values
                .iter()
                .zip(&compliances)
                .map(|(a, b)| a * b)
                .sum();
            assert!((sum - stretch.max(0.0)).abs() < 1e-15, "{stretch}: {sum}");
            assert!(found.values.iter().all(|t| *t >= 0.0));
            before = found.values;
        }
    }
}
