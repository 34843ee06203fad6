//! Observer of a run: records, progress reports to Python and Ctrl-C.
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use voxsoft_solid::Progress;
use voxsoft_solid::vector::Vec3;

/// Shortest period between calls of a Python progress callback.
const PROGRESS_PERIOD: Duration = Duration::from_millis(100);

pub(crate) fn collect_sensors(
    sensors: &[(PyReadonlyArray1<'_, u32>, PyReadonlyArray1<'_, f64>)],
) -> Vec<Sensor> {
    sensors
        .iter()
        .map(|(vertices, weights)| Sensor {
            vertices: vertices.as_array().to_vec(),
            weights: weights.as_array().to_vec(),
        })
        .collect()
}

/// A weighted mean of vertices whose position is recorded.
pub(crate) struct Sensor {
    vertices: Vec<u32>,
    weights: Vec<f64>,
}

/// Observer of a run: records, reports progress to Python and passes on Ctrl-C.
pub(crate) struct Watch {
    progress: Option<Py<PyAny>>,
    /// The first step is reported at once, so that short runs are seen too.
    last_call: Option<Instant>,
    pub(crate) sensors: Vec<Sensor>,
    pub(crate) keep_frames: bool,
    pub(crate) recorded: usize,
    pub(crate) times: Vec<f64>,
    pub(crate) records: Vec<f64>,
    pub(crate) frames: Vec<f64>,
    /// Load factor of the last equilibrium, for a search that tries others.
    reached: Option<f64>,
    /// Readings of each chamber at every record.
    pub(crate) chambers: Vec<f64>,
    pub(crate) raised: Option<PyErr>,
}

impl Watch {
    pub(crate) fn new(
        progress: Option<Py<PyAny>>,
        sensors: Vec<Sensor>,
        keep_frames: bool,
    ) -> Self {
        Self {
            progress,
            last_call: None,
            sensors,
            keep_frames,
            recorded: 0,
            times: Vec::new(),
            records: Vec::new(),
            frames: Vec::new(),
            reached: None,
            chambers: Vec::new(),
            raised: None,
        }
    }

    /// Reports the load factor reached, instead of the one being tried.
    pub(crate) fn of_loads(self) -> Self {
        Self {
            reached: Some(0.0),
            ..self
        }
    }

    pub(crate) fn see(&mut self, now: &Progress<'_>, cancel: &AtomicBool) -> ControlFlow<()> {
        if now.record {
            self.record(now.positions, now.time);
            if let Some(fluid) = now.problem.fluid() {
                // Progress without velocities is a point of a path of equilibria, whose instant the fluid has kept.
                let instant = if now.velocities.is_empty() {
                    fluid.last_instant()
                } else {
                    voxsoft_solid::fluid::Instant::at_the_end(1.0)
                };
                let readings = fluid.read(now.positions, instant);
                self.chambers
                    .extend(readings.iter().flat_map(|reading| reading.numbers()));
            }
        }
        let time = match &mut self.reached {
            Some(reached) => {
                if now.record {
                    *reached = now.time;
                }
                *reached
            }
            None => now.time,
        };
        self.report((now.steps, time, now.residual), cancel)
    }

    fn report(&mut self, arguments: (u64, f64, f64), cancel: &AtomicBool) -> ControlFlow<()> {
        if cancel.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        if let Some(progress) = &self.progress
            && self
                .last_call
                .is_none_or(|last| last.elapsed() >= PROGRESS_PERIOD)
        {
            self.last_call = Some(Instant::now());
            if let Err(raised) = Python::attach(|py| progress.call1(py, arguments)) {
                self.raised = Some(raised);
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    }

    fn record(&mut self, positions: &[Vec3], time: f64) {
        self.recorded += 1;
        self.times.push(time);
        for sensor in &self.sensors {
            let mut mean = [0.0; 3];
            for (&vertex, weight) in sensor.vertices.iter().zip(&sensor.weights) {
                for axis in 0..3 {
                    mean[axis] += weight * positions[vertex as usize][axis];
                }
            }
            self.records.extend(mean);
        }
        if self.keep_frames {
            self.frames.extend(positions.as_flattened());
        }
    }
}
