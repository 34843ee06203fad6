//! The gas or liquid in a chamber: density as a function of pressure.

use serde::{Deserialize, Serialize};

/// A gas or a liquid. Pressures are gauge pressures, over an `atmosphere` (all in Pa).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Medium {
    /// An ideal gas, `p V = m R T`.
    Gas {
        /// `R` in J/(kg K).
        constant: f64,
    },
    /// A liquid whose density grows as `ρ₀ exp(p/K)`.
    Liquid {
        /// `ρ₀` under the atmosphere in kg/m³.
        density: f64,
        /// `K` in Pa.
        bulk: f64,
    },
}

impl Medium {
    /// The density in kg/m³ and its derivative by the pressure.
    pub fn density(self, pressure: f64, temperature: f64, atmosphere: f64) -> (f64, f64) {
        match self {
            Self::Gas { constant } => {
                let slope = 1.0 / (constant * temperature);
                ((pressure + atmosphere) * slope, slope)
            }
            Self::Liquid { density, bulk } => {
                let now = density * (pressure / bulk).exp();
                (now, now / bulk)
            }
        }
    }

    /// The amount in `mass` kg, in the unit that [`Medium::pressure_of`] takes: the product of absolute pressure and
    /// volume of a gas (J), the volume of a liquid under the atmosphere (m³). Amounts in connected chambers add up.
    pub fn amount(self, mass: f64, temperature: f64) -> f64 {
        match self {
            Self::Gas { constant } => mass * constant * temperature,
            Self::Liquid { density, .. } => mass / density,
        }
    }

    /// The pressure of an amount in a volume, and minus its derivative by the volume (Pa/m³).
    pub fn pressure_of(self, amount: f64, volume: f64, atmosphere: f64) -> (f64, f64) {
        match self {
            Self::Gas { .. } => {
                let absolute = amount / volume;
                (absolute - atmosphere, absolute / volume)
            }
            Self::Liquid { bulk, .. } => (-bulk * (volume / amount).ln(), bulk / volume),
        }
    }

    /// The volume in which an amount has the given pressure.
    pub fn volume_of(self, amount: f64, pressure: f64, atmosphere: f64) -> f64 {
        match self {
            Self::Gas { .. } => amount / (pressure + atmosphere),
            Self::Liquid { bulk, .. } => amount * (-pressure / bulk).exp(),
        }
    }

    /// The work (J) that an amount does by its pressure when it expands to a volume, up to a constant.
    pub fn work(self, amount: f64, volume: f64, atmosphere: f64) -> f64 {
        match self {
            // Relative to the volume under the atmosphere, which keeps the number small.
            Self::Gas { .. } => {
                let natural = amount / atmosphere;
                amount * (volume / natural).ln() - atmosphere * (volume - natural)
            }
            Self::Liquid { bulk, .. } => {
                -bulk * (volume * (volume / amount).ln() - (volume - amount))
            }
        }
    }

    /// Tests whether its pressure follows small changes of volume so steeply that Newton's method carries the pressure
    /// as an unknown.
    pub fn is_stiff(self) -> bool {
        matches!(self, Self::Liquid { .. })
    }
}
