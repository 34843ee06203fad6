//! How the tension falls along a tendon: Coulomb friction at every bend, with a memory of what it was.
//!
//! At a bend of angle `θ` the tensions on both sides have a ratio between `e^{−μθ}` and `e^{μθ}` (Euler and Eytelwein).
//! As long as the line sticks at a bend, what is beyond it is a line of its own that stretches from the state that was
//! accepted last. The tension that this gives is the tension after the bend unless it leaves the cone; then the line
//! slides over the bend, and the tension is on the side of the cone that is nearest: a return mapping, from the pulled
//! end on. So a line that is pulled, or whose way becomes shorter, has `T₁ e^{−μΣθ}` along it; one that is let go
//! afterwards first loses its tension near the pulled end; and one whose way becomes longer has `T₁ e^{μΣθ}`.

/// What the tension after a bend follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Hold {
    /// The line slides: it is so many times the one before.
    Slides(f64),
    /// The line sticks: it follows what is beyond.
    Sticks,
    /// It differs from the one before by what changes with the length beyond by so many N/m.
    Differs(f64),
}

/// Tensions along a tendon, and what keeps each.
#[derive(Debug)]
pub(super) struct Tensions {
    /// Of each segment, from the pulled end on, in N.
    pub values: Vec<f64>,
    /// What happens at each bend.
    pub holds: Vec<Hold>,
    /// The derivative of each value by the first one.
    pub by_first: Vec<f64>,
}

impl Tensions {
    /// From the tension at the pulled end, the tension that each segment would have if its bend stuck, and `e^{−μθ}` for
    /// each bend.
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

    /// From how much longer than without tension all segments together are, in m, where each stretches by its
    /// `compliance` (m/N): none if that is nothing.
    ///
    /// All tensions grow with the first one, at the least as much as the first does, so that the stretch is a function
    /// that grows and is linear between kinks: Newton's method, kept between bounds, ends between two of them.
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
            // As near as numbers are to each other.
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
    /// The same as if the line could push: the tensions go on as they are where it becomes slack.
    pub fn taut(self, stretch: f64, compliances: &[f64], sticking: &[f64], decays: &[f64]) -> Self {
        // Which way it slides there is seen at a tension of nearly nothing.
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

    /// Of four bends of 30 degrees with a friction of 0.3.
    fn decays() -> Vec<f64> {
        vec![libm::exp(-0.3 * std::f64::consts::FRAC_PI_6); 4]
    }

    #[test]
    fn a_line_that_is_pulled_has_the_tension_of_the_capstan() {
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
    fn what_is_let_go_a_little_keeps_its_tension_far_from_the_pulled_end() {
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
    fn the_stretch_is_that_which_was_asked_for() {
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
