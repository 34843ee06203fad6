use voxsoft_solid::Load;

/// Point of a load path: factors on pressures and on everything else, and the time of all histories.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LoadParameter {
    pub dead: f64,
    pub pressure: f64,
    /// Time in s; infinite for equilibria.
    pub time: f64,
}

impl LoadParameter {
    pub fn all(factor: f64) -> Self {
        Self::of(factor, factor)
    }

    pub fn of(dead: f64, pressure: f64) -> Self {
        Self {
            dead,
            pressure,
            time: f64::INFINITY,
        }
    }

    pub fn at(time: f64) -> Self {
        Self {
            time,
            ..Self::all(1.0)
        }
    }

    /// Progress along the path: the time, or without one the factor.
    pub fn progress(self) -> f64 {
        if self.time.is_finite() {
            self.time
        } else {
            self.pressure
        }
    }

    pub fn factor_of(self) -> impl Fn(&Load) -> f64 {
        move |load| {
            let factor = if load.kind.is_pressure() {
                self.pressure
            } else {
                self.dead
            };
            factor * load.history.at(self.time)
        }
    }
}
