//! Recording of the displayed frames, up to a number of bytes.

use std::collections::VecDeque;
use std::sync::Arc;

use voxsoft_solid::State;
use voxsoft_solid::vector::Vec3;

use crate::event::GrabState;

/// Memory limit of all frames of a body, in bytes.
const ROOM: usize = 128 * 1024 * 1024;

/// A recorded frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// Number of the frame.
    pub number: u64,
    /// Time of the frame in s.
    pub time: f64,
    /// The value of each control then.
    pub loads: Vec<f64>,
    /// Grabs then.
    pub grabs: Vec<GrabState>,
    positions: Vec<[f32; 3]>,
}

impl Recorded {
    /// State in single precision, with zero velocities.
    pub fn state(&self) -> State {
        let positions: Vec<Vec3> = self.positions.iter().map(|x| x.map(f64::from)).collect();
        State {
            velocities: vec![[0.0; 3]; positions.len()],
            positions,
            time: self.time,
        }
    }

    fn bytes(&self) -> usize {
        size_of_val(self.positions.as_slice())
    }
}

/// Recording of the newest frames of a body; the oldest are dropped.
#[derive(Debug)]
pub struct Recording {
    room: usize,
    frames: VecDeque<Arc<Recorded>>,
    bytes: usize,
}

impl Default for Recording {
    fn default() -> Self {
        Self::of_room(ROOM)
    }
}

impl Recording {
    /// Makes a recording of at most `room` bytes, or one frame.
    pub fn of_room(room: usize) -> Self {
        Self {
            room,
            frames: VecDeque::new(),
            bytes: 0,
        }
    }

    /// Adds a frame; numbers must grow by one.
    pub fn keep(&mut self, number: u64, state: &State, loads: Vec<f64>, grabs: Vec<GrabState>) {
        let frame = Recorded {
            number,
            time: state.time,
            loads,
            grabs,
            positions: state
                .positions
                .iter()
                .map(|x| x.map(|x| x as f32))
                .collect(),
        };
        self.bytes += frame.bytes();
        self.frames.push_back(Arc::new(frame));
        while self.bytes > self.room && self.frames.len() > 1 {
            let oldest = self.frames.pop_front();
            self.bytes -= oldest.map_or(0, |frame| frame.bytes());
        }
    }

    /// Removes all frames.
    pub fn clear(&mut self) {
        self.frames.clear();
        self.bytes = 0;
    }

    /// Frame of a number, or the nearest that is still recorded.
    pub fn at(&self, number: u64) -> Option<Arc<Recorded>> {
        let last = self.frames.len().checked_sub(1)?;
        let place = number.saturating_sub(self.first()) as usize;
        self.frames.get(place.min(last)).cloned()
    }

    /// Frame nearest to a time in s.
    pub fn at_time(&self, time: f64) -> Option<Arc<Recorded>> {
        let apart = |frame: &Recorded| (frame.time - time).abs();
        let nearest = |a: &&Arc<Recorded>, b: &&Arc<Recorded>| apart(a).total_cmp(&apart(b));
        self.frames.iter().min_by(nearest).cloned()
    }

    /// Number of the oldest frame, 0 if there is none.
    pub fn first(&self) -> u64 {
        self.frames.front().map_or(0, |frame| frame.number)
    }

    /// Number of the newest frame, 0 if there is none.
    pub fn last(&self) -> u64 {
        self.frames.back().map_or(0, |frame| frame.number)
    }

    /// Number of recorded frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Memory of the recorded frames in bytes.
    pub fn bytes(&self) -> usize {
        self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn oldest_frames_are_dropped_and_nearest_is_found() {
        let mut recording = Recording::of_room(100);
        assert!(recording.at(3).is_none() && recording.at_time(0.0).is_none());
        for number in 0..5 {
            let state = State {
                positions: vec![[0.1; 3]; 4],
                velocities: vec![[1.0; 3]; 4],
                time: 0.1 * number as f64,
            };
            recording.keep(number, &state, vec![], vec![]);
        }
        let kept = (recording.first(), recording.last(), recording.len());
        assert_eq!((kept, recording.bytes()), ((3, 4, 2), 96));
        let numbers = [0, 4, 99].map(|number| recording.at(number).unwrap().number);
        assert_eq!(numbers, [3, 4, 4]);
        let found = recording.at_time(0.34).unwrap();
        assert_eq!((found.number, found.state().velocities[0]), (3, [0.0; 3]));
        assert!((found.state().positions[0][0] - 0.1).abs() < 1e-8);
        recording.clear();
        assert_eq!((recording.len(), recording.bytes()), (0, 0));
    }
}
