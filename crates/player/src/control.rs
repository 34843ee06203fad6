use serde::{Deserialize, Serialize};

use crate::event::Refusal;

/// A slider: one number for some loads of the problem, such as the pressure of all cavities.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// Final value in the design, in SI units.
    pub value: f64,
    /// Indices of the loads that it scales.
    pub loads: Vec<u32>,
}

impl Control {
    /// Load factor (over the final value) for a requested value or factor.
    pub(crate) fn factor(&self, value: Option<f64>, factor: Option<f64>) -> Result<f64, Refusal> {
        let refuse = |what, hint| Err(Refusal::new("load", what, hint));
        match (value, factor) {
            (None, Some(factor)) => Ok(factor),
            (Some(0.0), None) => Ok(0.0),
            (Some(_), None) if self.value == 0.0 => refuse(
                "is zero in the design, which leaves its direction open",
                "set it there",
            ),
            (Some(value), None) => Ok(value / self.value),
            _ => refuse("needs one of value and factor", ""),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_takes_one_of_value_and_factor() {
        let of = |value| Control {
            value,
            loads: vec![0],
        };
        assert_eq!(of(4.0).factor(Some(1.0), None), Ok(0.25));
        assert_eq!(of(4.0).factor(None, Some(3.0)), Ok(3.0));
        assert_eq!(of(0.0).factor(Some(0.0), None), Ok(0.0));
        for (value, given, factor) in [
            (4.0, None, None),
            (4.0, Some(1.0), Some(1.0)),
            (0.0, Some(1.0), None),
        ] {
            assert!(of(value).factor(given, factor).is_err());
        }
    }
}
