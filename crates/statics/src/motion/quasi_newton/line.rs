//! Line search along a descent direction of the potential of a time step.
//!
//! A move that decreases the potential too little is halved. Where contact may close that is not enough: on the way the
//! slope jumps from that of free flight to that of contact, and a move that ends before the jump gains no information.
//! There the secant of the slopes finds the end, the upper slope being halved whenever the lower end has moved (the
//! Illinois variant of the false position, Dowell and Jarratt 1971, doi 10.1007/BF01934364), until at most [`FLAT`] of
//! the first slope is left.

/// Most changes of the end of a move, without contact and with it.
const CHANGES: u32 = 8;
const CHANGES_IN_CONTACT: u32 = 16;
/// Fraction of the initial slope that may remain at the end of a move which contact has shortened.
const FLAT: f64 = 0.5;
/// Smallest distance of a trial from both ends, as a part of the way between them.
const LEAST_PART: f64 = 1.0 / 16.0;

/// Outcome of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outcome {
    /// A voxel is inverted, or its material unstable.
    Unsound,
    /// The potential is too high.
    TooFar,
    /// The potential is low enough.
    Lower,
}

/// Action after a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Then {
    Take,
    TryAgain,
    GiveUp,
}

/// Search for the end of a move.
pub(super) struct Line {
    /// Part of the move to try.
    pub part: f64,
    /// Slope of the potential at the start, in J.
    start: f64,
    /// Parts with the slopes of the potential there, in J: of the last trial that was low enough, and of the last one
    /// that was too high in contact.
    low: (f64, f64),
    high: Option<(f64, f64)>,
    in_contact: bool,
    changes: u32,
}

impl Line {
    /// Begins with the part `part` of a move along which the potential decreases by `gain` (J) at first.
    pub fn new(part: f64, gain: f64, in_contact: bool) -> Self {
        Self {
            part,
            start: -gain,
            low: (0.0, -gain),
            high: None,
            in_contact,
            changes: 0,
        }
    }

    /// Tests that no trial had to be changed.
    pub fn is_whole(&self) -> bool {
        self.changes == 0
    }

    /// Continues after a trial of `part` with its outcome and the slope there.
    pub fn after(&mut self, outcome: Outcome, slope: impl FnOnce() -> f64) -> Then {
        match (outcome, self.high) {
            (Outcome::Lower, Some(high)) if self.changes < CHANGES_IN_CONTACT => {
                let slope = slope();
                if slope >= FLAT * self.start {
                    return Then::Take;
                }
                self.low = (self.part, slope);
                self.high = Some((high.0, high.1 / 2.0));
            }
            (Outcome::Lower, _) => return Then::Take,
            (Outcome::TooFar, _) if self.in_contact => self.high = Some((self.part, slope())),
            (Outcome::TooFar | Outcome::Unsound, _) => self.high = None,
        }
        self.changes += 1;
        if self.changes <= self.most_changes() {
            self.part = self.between();
            Then::TryAgain
        } else if self.low.0 > 0.0 {
            self.part = self.low.0;
            Then::TryAgain
        } else {
            Then::GiveUp
        }
    }

    fn most_changes(&self) -> u32 {
        if self.in_contact {
            CHANGES_IN_CONTACT
        } else {
            CHANGES
        }
    }

    /// Root of the secant of the slopes, or the midpoint.
    fn between(&self) -> f64 {
        let (begin, below) = self.low;
        let (end, part) = match self.high {
            Some((end, above)) if above > 0.0 => (end, below / (below - above)),
            Some((end, _)) => (end, 0.5),
            None => (self.part, 0.5),
        };
        begin + (end - begin) * part.clamp(LEAST_PART, 1.0 - LEAST_PART)
    }
}
