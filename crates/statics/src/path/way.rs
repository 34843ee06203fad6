//! Longest step along a path that depends on the way: with friction, bonds that may break, or loads with a memory.
//!
//! Friction of a step is that of its end, from anchors at its start (return mapping). This is exact where friction
//! changes linearly along the step, as under loads that grow together and press the places that they rub, and wrong in
//! the second order of the step elsewhere. So steps lengthen where friction follows the line through the last two states
//! ([`Contact::deviation`]).

use voxsoft_solid::{Contact, Problem};

use crate::path::load_control::LAST;

/// Longest step whatever friction does, as a part of the path.
const SHORT: f64 = 0.05;
/// First step with friction, which has no past to judge it by.
const FIRST: f64 = 0.25;
/// Longest step if only loads are path-dependent: the contact of a tendon is found from one state to the next, and
/// slides on in the same sense under loads that grow together.
const OF_LOADS: f64 = 0.25;
/// Deviation of friction up to which the next step is longer, and that up to which a step is kept.
const STRAIGHT: f64 = 0.05;
const CROOKED: f64 = 0.2;
/// Largest growth and cut of a step.
const LONGER: f64 = 4.0;
const SHORTER: f64 = 0.25;
/// Relative rounding of a step.
const ROUNDING: f64 = 1e-9;

/// Longest step along the path of a problem, whatever friction does, as a part of all of it.
pub(crate) fn longest_step(problem: &Problem) -> f64 {
    match problem.contact() {
        Some(contact) if contact.depends_on_way() => SHORT,
        _ if problem.depends_on_way() => OF_LOADS,
        _ => 1.0,
    }
}

/// Longest step that friction allows, as the path goes on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Way(Option<f64>);

impl Way {
    /// Begins the path of a problem.
    pub fn new(problem: &Problem) -> Self {
        let rubs = |contact: &&dyn Contact| contact.depends_on_way();
        let contact = problem.contact().filter(rubs);
        Self(
            contact
                .and_then(|contact| contact.deviation(problem.body().rest(), 0.0))
                .map(|_| FIRST),
        )
    }

    /// Path whose steps are given.
    pub fn given() -> Self {
        Self(None)
    }

    /// Longest next step; `None` if friction sets none.
    pub fn longest(self) -> Option<f64> {
        self.0
    }

    /// Judges a step by the deviation of friction at its end, if there is a past to tell it; returns `false` if it has to
    /// be taken again, shorter.
    pub fn judge(&mut self, step: f64, deviation: Option<f64>) -> bool {
        let Some(longest) = &mut self.0 else {
            return true;
        };
        let Some(deviation) = deviation else {
            *longest = FIRST;
            return step <= LAST * FIRST * (1.0 + ROUNDING);
        };
        if deviation <= STRAIGHT {
            *longest = longest.max(LONGER * step).min(1.0);
        } else if deviation > CROOKED {
            *longest = (SHORTER * step).max(SHORT);
        }
        deviation <= CROOKED || step <= LAST * SHORT * (1.0 + ROUNDING)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_lengthen_on_a_straight_path() {
        let mut way = Way(Some(FIRST));
        assert!(way.judge(FIRST, None), "nothing is known of a first step");
        assert_eq!(way.longest(), Some(FIRST));
        assert!(way.judge(FIRST, Some(STRAIGHT)));
        assert_eq!(way.longest(), Some(1.0));
        assert!(!way.judge(1.0, None), "friction that begins in a long step");
        assert_eq!(way.longest(), Some(FIRST));
    }

    #[test]
    fn crooked_steps_are_taken_again_until_they_are_short() {
        let mut way = Way(Some(1.0));
        assert!(!way.judge(1.0, Some(2.0 * CROOKED)));
        assert_eq!(way.longest(), Some(0.25));
        assert!(!way.judge(0.25, Some(2.0 * CROOKED)));
        assert_eq!(way.longest(), Some(0.0625));
        assert!(!way.judge(0.0625, Some(2.0 * CROOKED)));
        // The last step of a path may be longer by a tenth.
        assert!(way.judge(LAST * SHORT, Some(2.0 * CROOKED)));
        assert_eq!(way.longest(), Some(SHORT));
        assert!(
            way.judge(SHORT, Some(0.9 * CROOKED)),
            "neither straight nor crooked"
        );
        assert_eq!(way.longest(), Some(SHORT));
    }

    #[test]
    fn given_steps_are_kept() {
        let mut way = Way::given();
        assert!(way.judge(1.0, Some(1.0)) && way.longest().is_none());
    }
}
