//! Valves, tubes and pumps: mass flow between two pressures.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::medium::Medium;

/// The density of air at 100 kPa and 20 °C, 65 % humid, to which ISO 6358-1:2013 refers conductances, kg/m³; and that
/// temperature, K.
const REFERENCE_DENSITY: f64 = 1.185;
const REFERENCE_TEMPERATURE: f64 = 293.15;
/// Pressure ratio above which the flow through a valve is linear in the pressure difference: the ellipse of ISO 6358
/// has no finite slope at equal pressures.
const LAMINAR: f64 = 0.999;
/// Pressure difference (Pa) below which the flow of a liquid through a valve becomes linear in it.
const LAMINAR_DIFFERENCE: f64 = 10.0;
/// Most bisections and Newton steps for the pressure between a valve and a tube.
const ITERATIONS: u32 = 100;

/// A restriction that flow goes through.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Valve {
    /// A valve for gas by ISO 6358-1.
    Gas {
        /// Sonic conductance `C` in m³/(s Pa).
        conductance: f64,
        /// Critical ratio of pressures `b`, 0 to 1.
        critical_ratio: f64,
    },
    /// An orifice for liquid.
    Liquid {
        /// Its area times its coefficient of discharge, m².
        area: f64,
    },
}

/// A tube with laminar flow, by Hagen and Poiseuille.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tube {
    /// Length, m.
    pub length: f64,
    /// Inner diameter, m.
    pub diameter: f64,
    /// Dynamic viscosity, Pa s.
    pub viscosity: f64,
}

/// A valve, a tube, or both in series.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// The valve at its beginning.
    pub valve: Option<Valve>,
    /// The tube at its end.
    pub tube: Option<Tube>,
    /// The gas or liquid that flows in it.
    pub medium: Medium,
    /// Temperature, K.
    pub temperature: f64,
}

/// A mass flow (kg/s) with its derivatives by the pressures at both ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flow {
    /// Mass flow from the first end to the second.
    pub mass: f64,
    /// Derivatives by the pressures at the first end and at the second.
    pub slopes: [f64; 2],
}

impl Flow {
    fn reversed(self) -> Self {
        let [a, b] = self.slopes;
        Self {
            mass: -self.mass,
            slopes: [-b, -a],
        }
    }
}

impl Line {
    /// This line with its valve opened to a fraction.
    #[must_use]
    pub fn opened(mut self, part: f64) -> Self {
        match &mut self.valve {
            Some(Valve::Gas { conductance, .. }) => *conductance *= part,
            Some(Valve::Liquid { area }) => *area *= part,
            None => {}
        }
        self
    }

    /// The flow between two absolute pressures (Pa).
    pub fn flow(&self, from: f64, to: f64) -> Flow {
        match (self.valve, self.tube) {
            (Some(_), Some(_)) => self.through_both(from, to),
            (Some(valve), None) => self.through_valve(valve, from, to),
            (None, Some(tube)) => self.through_tube(tube, from, to),
            (None, None) => Flow {
                mass: 0.0,
                slopes: [0.0; 2],
            },
        }
    }

    fn through_valve(&self, valve: Valve, from: f64, to: f64) -> Flow {
        if from < to {
            return self.through_valve(valve, to, from).reversed();
        }
        match valve {
            Valve::Gas {
                conductance,
                critical_ratio: b,
            } => {
                let unit = conductance
                    * REFERENCE_DENSITY
                    * (REFERENCE_TEMPERATURE / self.temperature).sqrt();
                let ratio = if from > 0.0 { to / from } else { 1.0 };
                let part = |ratio: f64| (1.0 - ((ratio - b) / (1.0 - b)).powi(2)).sqrt();
                if ratio <= b {
                    return Flow {
                        mass: unit * from,
                        slopes: [unit, 0.0],
                    };
                }
                if ratio > LAMINAR.max(b) {
                    let edge = LAMINAR.max(b);
                    let slope = unit * part(edge) / (1.0 - edge);
                    return Flow {
                        mass: slope * (from - to),
                        slopes: [slope, -slope],
                    };
                }
                let share = part(ratio);
                let by_ratio = -(ratio - b) / ((1.0 - b) * (1.0 - b) * share);
                Flow {
                    mass: unit * from * share,
                    slopes: [unit * (share - ratio * by_ratio), unit * by_ratio],
                }
            }
            Valve::Liquid { area } => {
                let Medium::Liquid { density, .. } = self.medium else {
                    return Flow {
                        mass: f64::NAN,
                        slopes: [f64::NAN; 2],
                    };
                };
                // A √(2 ρ Δ) with a finite slope at Δ = 0.
                let difference = from - to;
                let size = f64::hypot(difference, LAMINAR_DIFFERENCE);
                let unit = area * (2.0 * density / size).sqrt();
                let slope = unit * (1.0 - 0.5 * (difference / size).powi(2));
                Flow {
                    mass: unit * difference,
                    slopes: [slope, -slope],
                }
            }
        }
    }

    fn through_tube(&self, tube: Tube, from: f64, to: f64) -> Flow {
        let unit = PI * tube.diameter.powi(4) / (128.0 * tube.viscosity * tube.length);
        match self.medium {
            // Mass flow is the same along the tube and density is proportional to pressure: the integral of p dp.
            Medium::Gas { constant } => {
                let unit = unit / (2.0 * constant * self.temperature);
                Flow {
                    mass: unit * (from - to) * (from + to),
                    slopes: [2.0 * unit * from, -2.0 * unit * to],
                }
            }
            Medium::Liquid { density, .. } => Flow {
                mass: unit * density * (from - to),
                slopes: [unit * density, -unit * density],
            },
        }
    }

    /// Solves for the pressure between valve and tube at which both carry the same flow.
    fn through_both(&self, from: f64, to: f64) -> Flow {
        let (Some(valve), Some(tube)) = (self.valve, self.tube) else {
            unreachable!("asked for with both alone");
        };
        let (mut low, mut high) = (from.min(to), from.max(to));
        let mut between = 0.5 * (low + high);
        let mut step = high - low;
        let (mut first, mut second);
        let mut iteration = 0;
        loop {
            first = self.through_valve(valve, from, between);
            second = self.through_tube(tube, between, to);
            let excess = first.mass - second.mass;
            if iteration == ITERATIONS || step.abs() <= f64::EPSILON * high.abs() || excess == 0.0 {
                break;
            }
            if excess > 0.0 {
                low = between;
            } else {
                high = between;
            }
            let newton = between - excess / (first.slopes[1] - second.slopes[0]);
            let next = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            step = next - between;
            between = next;
            iteration += 1;
        }
        let (after, before) = (first.slopes[1], second.slopes[0]);
        let both = before - after;
        Flow {
            mass: first.mass,
            slopes: if both > 0.0 {
                [
                    first.slopes[0] * before / both,
                    -second.slopes[1] * after / both,
                ]
            } else {
                [0.0; 2]
            },
        }
    }
}

/// The volume flow (m³/s) of a pump against a pressure difference (Pa), falling and piecewise linear; there is no
/// backflow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Pressure differences, rising from 0.
    pub pressures: Vec<f64>,
    /// Volume flows, falling to 0.
    pub flows: Vec<f64>,
}

impl Curve {
    /// The flow and its slope at a fraction of full speed, to which both flow and pressure are proportional.
    pub fn flow(&self, pressure: f64, speed: f64) -> (f64, f64) {
        let stall = self.stall();
        if speed <= 0.0 || pressure >= stall * speed {
            return (0.0, 0.0);
        }
        let at = pressure / speed;
        let next = self
            .pressures
            .partition_point(|p| *p <= at)
            .clamp(1, self.pressures.len() - 1);
        let (p0, p1) = (self.pressures[next - 1], self.pressures[next]);
        let (q0, q1) = (self.flows[next - 1], self.flows[next]);
        let slope = (q1 - q0) / (p1 - p0);
        (speed * (q0 + slope * (at - p0)), slope)
    }

    /// The stall pressure, at which nothing flows, at full speed.
    pub fn stall(&self) -> f64 {
        self.pressures.last().copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AIR: Medium = Medium::Gas { constant: 287.05 };
    const WATER: Medium = Medium::Liquid {
        density: 998.2,
        bulk: 2.2e9,
    };

    fn line(valve: bool, tube: bool, medium: Medium) -> Line {
        let gas = Valve::Gas {
            conductance: 1e-9,
            critical_ratio: 0.3,
        };
        let liquid = Valve::Liquid { area: 1e-6 };
        Line {
            valve: valve.then_some(match medium {
                Medium::Gas { .. } => gas,
                Medium::Liquid { .. } => liquid,
            }),
            tube: tube.then_some(Tube {
                length: 1.0,
                diameter: 2e-3,
                viscosity: 1.8e-5,
            }),
            medium,
            temperature: 293.15,
        }
    }

    #[test]
    fn flow_slopes_match_differences_and_flow_reverses_with_pressures() {
        for medium in [AIR, WATER] {
            for (valve, tube) in [(true, false), (false, true), (true, true)] {
                let line = line(valve, tube, medium);
                for (from, to) in [(2e5, 1e5), (1.5e5, 1.3e5), (1.3e5, 1.5e5), (1e5, 99_990.0)] {
                    let flow = line.flow(from, to);
                    assert_eq!(flow.mass > 0.0, from > to);
                    let step = 1.0;
                    let by_from =
                        (line.flow(from + step, to).mass - line.flow(from - step, to).mass) / 2.0;
                    let by_to =
                        (line.flow(from, to + step).mass - line.flow(from, to - step).mass) / 2.0;
                    // Differences over 2 Pa are accurate to the square of that over the smallest pressure difference.
                    for (slope, expected) in flow.slopes.into_iter().zip([by_from, by_to]) {
                        let size = flow.slopes[0].abs().max(flow.slopes[1].abs());
                        assert!(
                            (slope - expected).abs() < 2e-2 * size,
                            "{line:?} {from} {to}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn choked_flow_does_not_depend_on_downstream_pressure() {
        let line = line(true, false, AIR);
        let (a, b) = (line.flow(4e5, 1e5), line.flow(4e5, 0.5e5));
        assert_eq!(a.mass, b.mass);
        assert!((a.mass - 1e-9 * 1.185 * 4e5).abs() < 1e-18);
    }

    #[test]
    fn half_open_valve_halves_its_own_conductance_only() {
        for medium in [AIR, WATER] {
            let valve = line(true, false, medium);
            let (half, full) = (valve.opened(0.5).flow(2e5, 1e5), valve.flow(2e5, 1e5));
            assert!((half.mass / full.mass - 0.5).abs() < 1e-12);
            let both = line(true, true, medium);
            let part = both.opened(0.5).flow(2e5, 1e5).mass / both.flow(2e5, 1e5).mass;
            assert!(part > 0.5 && part < 1.0, "{part}");
            assert_eq!(both.opened(0.0).flow(2e5, 1e5).mass, 0.0);
        }
    }

    #[test]
    fn pump_stops_at_stall_pressure_without_backflow() {
        let curve = Curve {
            pressures: vec![0.0, 2e4, 5e4],
            flows: vec![1e-5, 6e-6, 0.0],
        };
        assert_eq!(curve.flow(0.0, 1.0).0, 1e-5);
        assert!((curve.flow(1e4, 1.0).0 - 8e-6).abs() < 1e-18);
        assert!((curve.flow(1e4, 0.5).0 - 3e-6).abs() < 1e-18);
        assert_eq!(curve.flow(6e4, 1.0), (0.0, 0.0));
        assert_eq!(curve.flow(1e4, 0.0), (0.0, 0.0));
    }
}
