//! How much longer a material is by itself, over time.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::{History, ProblemError};

/// A free stretch that changes over time: the product of powers of histories, such as the cube root of a change of volume.
///
/// What evaluates a body at an instant calls [`Growth::begin`] first; until then it is that of the end.
#[derive(Debug)]
pub struct Growth {
    factors: Vec<(History, f64)>,
    /// The bits of the stretch now.
    now: AtomicU64,
}

impl Growth {
    /// That of a material that stays as long as it is.
    pub fn none() -> Self {
        Self::of(Vec::new())
    }

    /// From histories, which stay above zero, each with its power.
    pub fn new(factors: Vec<(History, f64)>) -> Result<Self, ProblemError> {
        for (history, power) in &factors {
            let what = "stretch of a material over time";
            if let Some(&value) = history.factors().iter().find(|value| !(**value > 0.0)) {
                return Err(ProblemError::NotPositive { what, value });
            }
            if !power.is_finite() {
                return Err(ProblemError::NotFinite { what });
            }
        }
        Ok(Self::of(factors))
    }

    fn of(factors: Vec<(History, f64)>) -> Self {
        let growth = Self {
            factors,
            now: AtomicU64::new(1.0f64.to_bits()),
        };
        growth.begin(f64::INFINITY);
        growth
    }

    /// The stretch at a time in s; `f64::INFINITY` gives the last.
    pub fn at(&self, time: f64) -> f64 {
        let power = |(history, power): &(History, f64)| {
            let base = history.at(time);
            if *power == 1.0 {
                base
            } else {
                libm::pow(base, *power)
            }
        };
        self.factors.iter().map(power).product()
    }

    /// Makes it that of a time in s.
    pub fn begin(&self, time: f64) {
        self.now.store(self.at(time).to_bits(), Ordering::Relaxed);
    }

    /// The stretch now.
    #[inline(always)]
    pub fn now(&self) -> f64 {
        f64::from_bits(self.now.load(Ordering::Relaxed))
    }

    /// The time in s after which it stays the same.
    pub fn end(&self) -> f64 {
        let ends = self.factors.iter().map(|(history, _)| history.end());
        ends.fold(0.0, f64::max)
    }
}

impl Clone for Growth {
    fn clone(&self) -> Self {
        Self {
            factors: self.factors.clone(),
            now: AtomicU64::new(self.now.load(Ordering::Relaxed)),
        }
    }
}

impl PartialEq for Growth {
    fn eq(&self, other: &Self) -> bool {
        self.factors == other.factors && self.now() == other.now()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_the_product_of_powers() {
        let ramp = |end: f64| History::new(vec![0.0, 2.0], vec![1.0, end]).unwrap();
        let growth = Growth::new(vec![(ramp(1.2), 1.0), (ramp(8.0), 1.0 / 3.0)]).unwrap();
        // Where nobody has begun it is that of the end.
        assert!((growth.now() - 2.4).abs() < 1e-15);
        growth.begin(1.0);
        assert_eq!(growth.now(), 1.1 * libm::pow(4.5, 1.0 / 3.0));
        let copy = growth.clone();
        growth.begin(0.0);
        assert_eq!([growth.now(), copy.now()], [1.0, copy.at(1.0)]);
        assert_eq!(growth.end(), 2.0);
        assert_eq!(Growth::none().now(), 1.0);
    }

    #[test]
    fn nothing_shrinks_to_nothing() {
        let gone = History::new(vec![0.0, 1.0], vec![1.0, 0.0]).unwrap();
        assert!(Growth::new(vec![(gone, 1.0)]).is_err());
    }
}
