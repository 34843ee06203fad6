use voxsoft_solid::{Load, LoadKind};

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
            let factor = match load.kind {
                LoadKind::Pressure { .. } => self.pressure,
                LoadKind::Gravity(_) | LoadKind::Forces { .. } => self.dead,
            };
            factor * load.history.at(f64::INFINITY)
        }
    }
}
