//! Pressure of nearly incompressible voxels, an independent unknown that converges within a few steps.
//!
//! Rubber is some hundred times as stiff against a change of volume as against one of shape. A long step rotates
//! voxels, and a rotation by `θ` along straight lines swells by `θ²`: with the bulk modulus `K` itself, a search for
//! the minimum would creep along a narrow valley. So a step uses, with the ratio of volumes `J`,
//!
//! ```text
//! p = k (J − 1 + pₙ/r),   1/k = 1/K + 1/r,
//! ```
//!
//! which maximizes `p (J − 1) − p²/2K − (p − pₙ)²/2r`: the pressure of the material with a penalty on its change from
//! the step before (the method of multipliers in its proximal form, Rockafellar 1976, doi 10.1287/moor.1.2.97). Where
//! nothing changes, `p = pₙ` and therefore `p = K (J − 1)`: the rest is that of the material. On the way the volume is
//! off by `(p − pₙ)/r`, and the remainder shrinks by about `μ/r` in each step.

use voxsoft_solid::element::hex8::{Pressure, Within};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Body, Hex8};

/// Ratio of `r` to the initial shear modulus: the stiffest bulk that does not slow the search down.
const BULK_OVER_SHEAR: f64 = 20.0;

/// Pressures of all voxels in Pa, positive in tension.
pub(super) struct Pressures {
    values: Vec<f64>,
}

impl Pressures {
    /// Zero pressures.
    pub fn new(body: &Body) -> Self {
        Self {
            values: vec![0.0; body.hex8s().len()],
        }
    }

    /// Pressures of the material at `positions`.
    pub fn at(body: &Body, positions: &[Vec3]) -> Self {
        let pressure = |hex8: &Hex8| {
            let material = body.material_of(hex8);
            let within = Within::elastic(material);
            hex8.respond(material, positions, &within).pressure
        };
        Self {
            values: body.hex8s().iter().map(pressure).collect(),
        }
    }

    /// Sets the pressures at the end of a step.
    pub fn take(&mut self, values: &[f64]) {
        self.values.copy_from_slice(values);
    }

    /// Pressure law of every voxel over a step, without viscous stress.
    pub fn start(&self, body: &Body) -> Vec<Within> {
        let hex8s = body.hex8s().iter().zip(&self.values);
        hex8s
            .map(|(hex8, &before)| {
                let material = body.material_of(hex8);
                let mut within = Within::elastic(material);
                let limit = BULK_OVER_SHEAR * material.model().shear();
                if material.bulk() > limit {
                    within.pressure = Pressure {
                        stiffness: 1.0 / (1.0 / material.bulk() + 1.0 / limit),
                        shift: before / limit,
                    };
                }
                within
            })
            .collect()
    }
}
