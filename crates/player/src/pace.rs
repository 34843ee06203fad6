//! Pace of time: real time, or slow motion in which a stiff body is seen to move.

use std::collections::VecDeque;

use crate::sentences::slowed;

/// Selectable paces: simulated seconds for each second of the clock.
pub const PACES: [f64; 6] = [
    1.0,
    1.0 / 2.0,
    1.0 / 5.0,
    1.0 / 10.0,
    1.0 / 50.0,
    1.0 / 200.0,
];

/// Shortest duration on the screen of a motion that is to be seen, s.
const SEEN: f64 = 1.0;

/// Averaging window of the real-time factor, s.
const SPAN: f64 = 1.0;

/// Fastest pace at which a motion of this duration (s) lasts long enough on the screen.
pub fn pace_for(seconds: f64) -> f64 {
    let slow_enough = |pace: &f64| seconds / pace >= SEEN;
    let found = PACES.into_iter().find(slow_enough);
    found.unwrap_or(PACES[PACES.len() - 1])
}

/// Pace in force: the user's, else one derived from the duration of the motion.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pace {
    /// Pace chosen by the user.
    pub chosen: Option<f64>,
    /// Number of choices by the user.
    pub choices: u32,
    /// Time in which the body comes to rest without grabs or load changes, if known, in s.
    pub rest_in: Option<f64>,
}

impl Pace {
    /// Simulated seconds for each second of the clock.
    pub fn factor(&self) -> f64 {
        self.chosen
            .or_else(|| self.rest_in.map(pace_for))
            .unwrap_or(1.0)
    }

    /// Sentence on the pace; empty in real time.
    pub fn words(&self) -> String {
        let rest_in = self.rest_in.filter(|_| self.chosen.is_none());
        match self.factor() {
            1.0 => String::new(),
            factor => slowed(factor, rest_in),
        }
    }
}

/// Real-time factor: simulated over clock time, over about the last second.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RealTimeFactor(VecDeque<[f64; 2]>);

impl RealTimeFactor {
    /// Discards the measurement, when time starts to run or the pace changes.
    pub fn restart(&mut self) {
        self.0.clear();
    }

    /// Adds a pair of simulated and clock time in s.
    pub fn mark(&mut self, simulated: f64, clock: f64) {
        self.0.push_back([simulated, clock]);
        while self.0.front().is_some_and(|first| clock - first[1] > SPAN) {
            self.0.pop_front();
        }
    }

    /// Real-time factor; 0 before any measurement.
    pub fn value(&self) -> f64 {
        match (self.0.front(), self.0.back()) {
            (Some([begun, start]), Some([reached, now])) if now > start => {
                (reached - begun) / (now - start)
            }
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_motion_plays_in_real_time_and_short_motion_slower() {
        let paces = [3.0, 0.6, 0.05, 1e-6].map(pace_for);
        assert_eq!(paces, [1.0, 0.5, 0.02, 0.005]);
    }

    #[test]
    fn user_pace_takes_precedence() {
        let mut pace = Pace::default();
        assert_eq!((pace.factor(), pace.words().as_str()), (1.0, ""));
        pace.rest_in = Some(0.0497);
        let because = "Shown 50 times slower than real time, as it comes to rest within 49.7 ms.";
        assert_eq!((pace.factor(), pace.words().as_str()), (0.02, because));
        pace.chosen = Some(0.5);
        let sentence = "Shown 2 times slower than real time.";
        assert_eq!((pace.factor(), pace.words().as_str()), (0.5, sentence));
    }

    #[test]
    fn real_time_factor_is_measured_against_the_clock() {
        let mut factor = RealTimeFactor::default();
        assert_eq!(factor.value(), 0.0);
        for tick in 0..200 {
            let clock = f64::from(tick) / 60.0;
            factor.mark(0.02 * clock, clock);
        }
        assert!((factor.value() - 0.02).abs() < 1e-12);
        // A jump older than the window does not count.
        factor.mark(100.0, 10.0);
        factor.mark(100.1, 10.5);
        assert!((factor.value() - 0.2).abs() < 1e-9);
        factor.restart();
        assert_eq!(factor.value(), 0.0);
    }
}
