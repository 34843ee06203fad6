use voxsoft_solid::Load;

/// Where on the path: factors on pressures and on everything else.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    pub dead: f64,
    pub pressure: f64,
}

impl Point {
    pub fn all(factor: f64) -> Self {
        Self {
            dead: factor,
            pressure: factor,
        }
    }

    pub fn factor_of(self) -> impl Fn(&Load) -> f64 {
        move |load| {
            let factor = if load.kind.is_pressure() {
                self.pressure
            } else {
                self.dead
            };
            factor * load.history.at(f64::INFINITY)
        }
    }
}
