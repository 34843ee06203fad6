use crate::ProblemError;

/// Load history of a load or a motion: a factor over time, linear between the given times and constant before the first
/// and after the last.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    times: Vec<f64>,
    factors: Vec<f64>,
}

impl History {
    /// A factor of one at all times.
    pub fn constant() -> Self {
        Self::always(1.0)
    }

    /// A finite factor that never changes.
    pub fn always(factor: f64) -> Self {
        Self {
            times: vec![0.0],
            factors: vec![factor],
        }
    }

    /// A history through the points (`times[i]` in s, `factors[i]`).
    pub fn new(times: Vec<f64>, factors: Vec<f64>) -> Result<Self, ProblemError> {
        if times.len() != factors.len() {
            return Err(ProblemError::Length {
                what: "factors of a history",
                got: factors.len(),
                expected: times.len(),
            });
        }
        if times.iter().chain(&factors).any(|value| !value.is_finite()) {
            return Err(ProblemError::NotFinite { what: "a history" });
        }
        if times.is_empty() {
            return Err(ProblemError::History { entry: 0 });
        }
        if let Some(entry) = (1..times.len()).find(|&i| times[i] <= times[i - 1]) {
            return Err(ProblemError::History { entry });
        }
        Ok(Self { times, factors })
    }

    /// The times in s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The factors at these times.
    pub fn factors(&self) -> &[f64] {
        &self.factors
    }

    /// Tests whether the factor is the same at all times.
    pub fn is_constant(&self) -> bool {
        self.factors.iter().all(|factor| *factor == self.factors[0])
    }

    /// The time in s after which the factor is constant: zero if it always is.
    pub fn end(&self) -> f64 {
        if self.is_constant() {
            0.0
        } else {
            self.times[self.times.len() - 1]
        }
    }

    /// The factor at `time` (s); `f64::INFINITY` gives the final factor.
    pub fn at(&self, time: f64) -> f64 {
        let after = self.times.partition_point(|&t| t <= time);
        if after == 0 {
            return self.factors[0];
        }
        if after == self.times.len() {
            return self.factors[after - 1];
        }
        let (t0, t1) = (self.times[after - 1], self.times[after]);
        let (f0, f1) = (self.factors[after - 1], self.factors[after]);
        f0 + (f1 - f0) * (time - t0) / (t1 - t0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_linear_between_and_constant_outside() {
        let history = History::new(vec![1.0, 3.0], vec![0.0, 4.0]).unwrap();
        for (time, expected) in [(0.0, 0.0), (1.0, 0.0), (1.5, 1.0), (3.0, 4.0), (9.0, 4.0)] {
            assert_eq!(history.at(time), expected);
        }
        assert_eq!(history.at(f64::INFINITY), 4.0);
    }

    #[test]
    fn refuses_times_that_do_not_increase() {
        let error = History::new(vec![0.0, 1.0, 1.0], vec![0.0; 3]).unwrap_err();
        assert_eq!(error, ProblemError::History { entry: 2 });
        assert!(History::new(vec![0.0], vec![f64::NAN]).is_err());
        assert!(History::new(vec![], vec![]).is_err());
    }
}
