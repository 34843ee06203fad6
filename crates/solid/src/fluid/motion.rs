//! Steps of a fluid from one accepted state to the next: along a path of equilibria, or over time.

use serde::{Deserialize, Serialize};

use super::network::{Network, Step};
use super::{Fluid, Instant};
use crate::vector::Vec3;

/// Memory of a fluid between steps and iterations.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FluidMemory {
    pub(super) step: Option<Step>,
    /// Pressures carried by Newton's method.
    pub(super) carried: Option<Vec<f64>>,
    /// Masses exchanged since the start, now and one step ago, kg.
    pub(super) exchanged: Vec<f64>,
    pub(super) before: Vec<f64>,
    pub(super) last: Option<Last>,
    /// The largest absolute value of a pressure so far, Pa.
    pub(super) largest: f64,
    /// Work on the walls and energy supplied so far, J, for each chamber.
    pub(super) work: Vec<f64>,
    pub(super) energy: Vec<f64>,
}

/// The last accepted state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Last {
    pub volumes: Vec<f64>,
    pub pressures: Vec<f64>,
    pub part: f64,
    pub time: f64,
    pub power: Vec<f64>,
    pub masses: Vec<f64>,
}

/// The state of a chamber, as reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Gauge pressure, Pa.
    pub pressure: f64,
    /// Volume of its cavities, m³.
    pub volume: f64,
    /// Mass including that in lines and syringes, kg.
    pub mass: f64,
    /// Mass flow into it, kg/s.
    pub flow: f64,
    /// Work on the walls, J.
    pub work: f64,
    /// Energy supplied to it, J.
    pub energy: f64,
}

impl Reading {
    /// All numbers in the order above.
    pub fn numbers(self) -> [f64; 6] {
        let Self {
            pressure,
            volume,
            mass,
            flow,
            work,
            energy,
        } = self;
        [pressure, volume, mass, flow, work, energy]
    }
}

impl Fluid {
    /// Starts a path from rest, or a motion: exchanged masses are zero.
    pub fn start(&mut self, positions: &[Vec3], time: Option<f64>) {
        let volumes = self.volumes(positions);
        let network = &self.network;
        let (part, instant) = time.map_or((0.0, f64::INFINITY), |time| (1.0, time));
        let n = volumes.len();
        // Before any flow, each chamber has the pressure of its own contents.
        let alone = Network {
            branches: Vec::new(),
            pumps: Vec::new(),
            ..(**network).clone()
        };
        let found = if time.is_some() {
            alone.at_rest(&volumes, part, instant)
        } else {
            network.at_rest(&volumes, part, instant)
        };
        let pressures = found.map_or(vec![f64::NAN; n], |found| found.pressures);
        let power = match time {
            Some(time) => network.power(&pressures, time),
            None => vec![0.0; n],
        };
        let masses = network.masses(&volumes, &pressures, part, instant);
        self.state = FluidMemory {
            step: None,
            carried: None,
            largest: 0.0,
            exchanged: vec![0.0; n],
            before: vec![0.0; n],
            work: vec![0.0; n],
            energy: vec![0.0; n],
            last: Some(Last {
                volumes,
                pressures,
                part,
                time: instant,
                power,
                masses,
            }),
        };
        if let Some(time) = time {
            self.begin(time, f64::INFINITY, [1.0, 0.0]);
        }
    }

    /// Begins a step of a motion to `time`, at whose end the derivative of the masses is `rate` times their difference
    /// from a mean of the masses now and one step ago, with these weights.
    pub fn begin(&mut self, time: f64, rate: f64, [now, ago]: [f64; 2]) {
        let state = &self.state;
        let pairs = state.exchanged.iter().zip(&state.before);
        let exchanged = pairs.map(|(a, b)| now * a + ago * b).collect();
        let (from, guess) = match &state.last {
            Some(last) => (last.volumes.clone(), last.pressures.clone()),
            None => return,
        };
        self.state.step = Some(Step {
            time,
            rate,
            exchanged,
            from,
            guess,
        });
    }

    /// Accepts a state as the end of a step of a motion.
    pub fn take_step(&mut self, positions: &[Vec3]) {
        let before = self.state.exchanged.clone();
        self.take_stage(positions);
        self.state.before = before;
    }

    /// Accepts a state as the end of a later stage of a step: the masses of one step ago are kept.
    pub fn take_stage(&mut self, positions: &[Vec3]) {
        let volumes = self.volumes(positions);
        let Some(step) = self.state.step.clone() else {
            return;
        };
        let Some(found) = self.network.at_end_of(&step, &volumes) else {
            return;
        };
        let flows = self.network.flows_at(&found.pressures, step.time);
        let masses = self
            .network
            .masses(&volumes, &found.pressures, 1.0, step.time);
        let put_in = self.network.put_in(step.time);
        let exchanged = (0..volumes.len())
            .map(|chamber| {
                if self.network.is_held(chamber) {
                    masses[chamber] - put_in[chamber]
                } else {
                    step.exchanged[chamber] + flows[chamber] / step.rate
                }
            })
            .collect();
        self.state.exchanged = exchanged;
        let power = self.network.power(&found.pressures, step.time);
        self.state.count(
            &self.network,
            Last {
                volumes,
                pressures: found.pressures,
                part: 1.0,
                time: step.time,
                power,
                masses,
            },
        );
    }

    /// Accepts a state as a point of a path of equilibria.
    pub fn take_rest(&mut self, positions: &[Vec3], instant: Instant) {
        let volumes = self.volumes(positions);
        let Instant { part, time } = instant;
        if let Some(found) = self.network.at_rest(&volumes, part, time) {
            let power = vec![0.0; volumes.len()];
            let masses = self.network.masses(&volumes, &found.pressures, part, time);
            self.state.count(
                &self.network,
                Last {
                    volumes,
                    pressures: found.pressures,
                    part,
                    time,
                    power,
                    masses,
                },
            );
        }
    }

    /// The instant of the last accepted state; that of the unloaded body if there is none.
    pub fn last_instant(&self) -> Instant {
        let state = &self.state;
        let last = state.last.as_ref();
        last.map_or(Instant::at_the_end(0.0), |last| Instant {
            part: last.part,
            time: last.time,
        })
    }

    /// Pressures of the last accepted state, Pa.
    pub fn last_pressures(&self) -> Vec<f64> {
        let state = &self.state;
        let last = state.last.as_ref();
        last.map_or(vec![0.0; self.walls.len()], |last| last.pressures.clone())
    }

    /// Tests whether pressures are at rest at the present volumes, to a tolerance relative to the largest pressure so
    /// far.
    pub fn is_at_rest(&self, tolerance: f64) -> bool {
        let state = &self.state;
        let (Some(last), Some(step)) = (&state.last, &state.step) else {
            return true;
        };
        let settled = self
            .network
            .settled(&last.volumes, &state.exchanged, step.time);
        let Some(settled) = settled else { return false };
        let pairs = settled.iter().zip(&last.pressures);
        let off = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        off <= tolerance * state.largest
    }

    /// The state of every chamber with the vertices at `positions`.
    pub fn read(&self, positions: &[Vec3], instant: Instant) -> Vec<Reading> {
        let volumes = self.volumes(positions);
        let (found, _) = self.answer(&volumes, instant);
        let part = instant.part;
        let state = &self.state;
        let time = state.step.as_ref().map_or(instant.time, |step| step.time);
        let masses = self.network.masses(&volumes, &found.pressures, part, time);
        let flows: Vec<f64> = match &state.step {
            Some(step) if step.rate.is_finite() => {
                let flows = self.network.flows_at(&found.pressures, step.time);
                let put_in = self.network.put_in(step.time);
                (0..volumes.len())
                    .map(|chamber| {
                        if self.network.is_held(chamber) {
                            let gained = masses[chamber] - put_in[chamber];
                            step.rate * (gained - step.exchanged[chamber])
                        } else {
                            flows[chamber]
                        }
                    })
                    .collect()
            }
            Some(step) => self.network.flows_at(&found.pressures, step.time),
            None => vec![0.0; volumes.len()],
        };
        (0..volumes.len())
            .map(|chamber| Reading {
                pressure: found.pressures[chamber],
                volume: volumes[chamber],
                mass: masses[chamber],
                flow: flows[chamber],
                work: state.work[chamber],
                energy: state.energy[chamber],
            })
            .collect()
    }
}

impl FluidMemory {
    /// Accumulates work and energy up to a new state, by the trapezoidal rule.
    fn count(&mut self, network: &Network, now: Last) {
        if let Some(last) = &self.last {
            let step = if now.time.is_finite() && last.time.is_finite() {
                now.time - last.time
            } else {
                0.0
            };
            let pairs = last.pressures.iter().zip(&now.pressures);
            let mean: Vec<f64> = pairs.map(|(a, b)| 0.5 * (a + b)).collect();
            let moments = [(last.part, last.time), (now.part, now.time)];
            let put_in = network.energy_put_in(&mean, moments);
            let pairs = now.masses.iter().zip(&last.masses);
            let gained: Vec<f64> = pairs.map(|(now, last)| now - last).collect();
            let held = network.energy_held(&mean, &gained, now.time);
            for chamber in 0..mean.len() {
                self.work[chamber] +=
                    mean[chamber] * (now.volumes[chamber] - last.volumes[chamber]);
                let power = 0.5 * (last.power[chamber] + now.power[chamber]);
                self.energy[chamber] += put_in[chamber] + held[chamber] + step * power;
            }
        }
        let sizes = now.pressures.iter().map(|p| p.abs());
        self.largest = sizes.fold(self.largest, f64::max);
        self.last = Some(now);
    }
}
