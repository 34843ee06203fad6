//! Adaptive length of the load steps of a path.

/// Consecutive successful steps at the ceiling before it rises again.
const RISES_AFTER: u32 = 4;
/// Divisors of the length of a failed step, for the next step and for the ceiling.
const CUT: f64 = 4.0;
const CEILING: f64 = 2.0;

/// Length of the next step: it doubles after easy ones and falls to a quarter after a failure.
///
/// A step of the length that has failed mostly fails again right after, and costs as much as the one that succeeds. So
/// a failed length sets a ceiling at half of it, which rises after some steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StepLength {
    now: f64,
    longest: f64,
    ceiling: f64,
    at_ceiling: u32,
}

impl StepLength {
    /// Starts with a first and a longest step.
    pub fn new(first: f64, longest: f64) -> Self {
        Self {
            now: first.min(longest),
            longest,
            ceiling: f64::INFINITY,
            at_ceiling: 0,
        }
    }

    pub fn get(self) -> f64 {
        self.now
    }

    /// Sets the length from elsewhere.
    pub fn set(&mut self, length: f64) {
        self.now = length;
    }

    /// Sets the longest step, which is also the next one unless a longer one has failed.
    pub fn limit(&mut self, longest: f64) {
        self.longest = longest;
        self.now = longest.min(self.ceiling);
    }

    /// Updates after a step that succeeded; only easy ones lead to longer ones.
    pub fn succeeded(&mut self, easy: bool) {
        if !easy {
            return;
        }
        if self.now >= self.ceiling {
            self.at_ceiling += 1;
            if self.at_ceiling == RISES_AFTER {
                (self.ceiling, self.at_ceiling) = (CEILING * self.ceiling, 0);
            }
        }
        self.now = (2.0 * self.now).min(self.longest).min(self.ceiling);
    }

    /// Updates after a step of a length that failed.
    pub fn failed(&mut self, length: f64) {
        self.now = length / CUT;
        (self.ceiling, self.at_ceiling) = (length / CEILING, 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failed_length_is_retried_after_some_steps() {
        let mut step = StepLength::new(1.0, 1.0);
        step.failed(1.0);
        let mut lengths = Vec::new();
        for _ in 0..7 {
            lengths.push(step.get());
            step.succeeded(true);
        }
        assert_eq!(lengths, [0.25, 0.5, 0.5, 0.5, 0.5, 1.0, 1.0]);
    }

    #[test]
    fn hard_steps_keep_their_length() {
        let mut step = StepLength::new(0.1, 1.0);
        step.succeeded(false);
        assert_eq!(step.get(), 0.1);
        step.succeeded(true);
        assert_eq!(step.get(), 0.2);
    }
}
