//! The energy of a voxel in its rotated frame, with gradient and Hessian; the formula stands in
//! [`crate::element::hex8`].

use serde::{Deserialize, Serialize};

use crate::element::coordinates::{AXES, Hex8Stress, STRAIN_COMPONENTS, StrainFunction, place};
use crate::element::rotated::Rotated;
use crate::hyperelastic::symmetric::{Sym, isochoric, isochoric_stress, to_matrix};
use crate::hyperelastic::{HyperelasticMaterial, Response, fiber};
use crate::matrix::determinant;

/// Pressure law of a voxel for its change of volume: `k (J − 1 + shift)`, positive in tension.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pressure {
    /// `k` in Pa: the bulk modulus, or less.
    pub stiffness: f64,
    /// The shift, zero for the material itself.
    pub shift: f64,
}

impl Pressure {
    /// The pressure law of a material.
    pub fn of(material: &HyperelasticMaterial) -> Self {
        Self {
            stiffness: material.bulk(),
            shift: 0.0,
        }
    }

    /// The pressure (Pa) at a volume ratio.
    pub fn at(self, volume: f64) -> f64 {
        self.stiffness * (volume - 1.0 + self.shift)
    }
}

/// The energy per rest volume and its gradient, in two parts: the deviatoric one, which viscous stress follows, and the
/// rest.
pub(crate) struct Parted {
    /// The elastic energy of the material at that pressure.
    pub elastic: f64,
    pub deviatoric_energy: f64,
    pub deviatoric: Hex8Stress,
    /// Energy of the mean change of volume and of the bilinear mode; `other` leaves out the latter's gradient.
    pub other_energy: f64,
    pub other: Hex8Stress,
    /// The pressure in Pa, positive in tension.
    pub pressure: f64,
}

impl Rotated {
    /// The smallest volume ratio among the points over which the energy is the mean.
    pub fn smallest_volume(&self, thinning: f64) -> f64 {
        if let Some(clamped) = self.warping.clamped {
            return self.smallest_clamped_volume(clamped, thinning);
        }
        let ends = |n: usize| {
            let h = self.variation(AXES[n], thinning).h;
            self.ends(&h, self.filling.spread[n])
        };
        [0, 1, 2]
            .map(ends)
            .as_flattened()
            .iter()
            .map(|stretch| determinant(&to_matrix(stretch)))
            .fold(f64::INFINITY, f64::min)
    }

    /// The volume ratio, with its Hessian if `second` ([`crate::element::volume`]).
    fn volume(&self, thinning: f64, second: bool) -> StrainFunction {
        match self.warping.clamped {
            Some(clamped) => self.clamped_volume(clamped, thinning, second),
            None => self.relieved_volume(thinning, second),
        }
    }

    /// The volume ratio and its gradient by the generalized coordinates.
    pub fn volume_slope(&self, material: &HyperelasticMaterial) -> (f64, [f64; STRAIN_COMPONENTS]) {
        let volume = self.volume(material.thinning(), false);
        (volume.value, volume.gradient)
    }

    /// The isochoric energy with its gradient, softened if the material softens.
    fn isochoric(&self, material: &HyperelasticMaterial) -> StrainFunction {
        let mut mean = self.virgin(material);
        self.soften(material, false, &mut mean);
        mean
    }

    /// The isochoric energy of virgin material, with its gradient.
    pub fn virgin(&self, material: &HyperelasticMaterial) -> StrainFunction {
        let thinning = material.thinning();
        self.warped_mean(thinning, None, |at| stress_only(material, at))
    }

    /// The factor `η` by which softening reduces the isochoric stress.
    pub fn softness(&self, material: &HyperelasticMaterial) -> f64 {
        material.softening().map_or(1.0, |law| {
            law.soften(self.virgin(material).value, self.peak)[1]
        })
    }

    /// Softens the mean isochoric energy, with one peak for the whole voxel.
    ///
    /// Strain that grows and falls in proportion has the same `W/P` everywhere, and with it the same `η`, up to `m`:
    /// for a voxel that bends, a peak at each of its points would change the result in second order only.
    fn soften(&self, material: &HyperelasticMaterial, second: bool, mean: &mut StrainFunction) {
        let Some(law) = material.softening() else {
            return;
        };
        let [value, slope, turn] = law.soften(mean.value, self.peak);
        if second {
            for (row, own) in mean.hessian.iter_mut().zip(&mean.gradient) {
                for (entry, other) in row.iter_mut().zip(&mean.gradient) {
                    *entry = slope * *entry + turn * own * other;
                }
            }
        }
        mean.value = value;
        mean.gradient = mean.gradient.map(|x| slope * x);
    }

    pub fn energy(&self, material: &HyperelasticMaterial) -> f64 {
        let thinning = material.thinning();
        let change = self.volume(thinning, false).value - 1.0;
        let mut value = 0.5 * material.bulk() * change * change
            + material.young() / 18.0 * self.bilinear.iter().map(|x| x * x).sum::<f64>()
            + self.isochoric(material).value;
        for fiber in material.fibers_now() {
            value += fiber::energy(&fiber, &self.stretch);
        }
        for axes in AXES {
            let [first, second] = self.variation(axes, thinning).bending;
            let trace = (1.0 - thinning) * self.filling.spread[axes.0] * (first + second);
            value += material.bulk() * trace * trace / 6.0;
        }
        value
    }

    /// Energy and gradient at once, split into the deviatoric part and that of the mean change of volume.
    pub fn response(&self, material: &HyperelasticMaterial, pressure: Pressure) -> Parted {
        let thinning = material.thinning();
        let bulk = material.bulk();
        let mean = self.isochoric(material);
        let mut deviatoric = Hex8Stress::ZERO.plus(&mean.gradient);
        let mut energy = mean.value;
        for fiber in material.fibers_now() {
            energy += fiber::energy(&fiber, &self.stretch);
            fiber::add_stress(&fiber, &self.stretch, &mut deviatoric.stress);
        }
        for (n, i, j) in AXES {
            let (first, second) = (self.elastic_hourglass(j, i), self.elastic_hourglass(i, j));
            let trace = ((1.0 - thinning) * self.filling.spread[n]).powi(2) * bulk / 3.0;
            energy += trace * (first + second).powi(2) / 2.0;
            deviatoric.hourglass[j][i] += trace * (first + second);
            deviatoric.hourglass[i][j] += trace * (first + second);
        }
        let volume = self.volume(thinning, false);
        let value = pressure.at(volume.value);
        let bilinear = material.young() / 18.0 * self.bilinear.iter().map(|x| x * x).sum::<f64>();
        Parted {
            elastic: energy + bilinear + 0.5 * value * value / bulk,
            deviatoric_energy: energy,
            deviatoric,
            other_energy: bilinear + 0.5 * value * value / pressure.stiffness,
            other: Hex8Stress::ZERO.plus(&volume.gradient.map(|slope| value * slope)),
            pressure: value,
        }
    }

    pub fn gradient(&self, material: &HyperelasticMaterial) -> Hex8Stress {
        self.gradient_of(material, &self.isochoric(material))
    }

    /// The gradient with a given isochoric part.
    pub fn gradient_of(
        &self,
        material: &HyperelasticMaterial,
        mean: &StrainFunction,
    ) -> Hex8Stress {
        let volume = self.volume(material.thinning(), false);
        let pressure = material.bulk() * (volume.value - 1.0);
        self.deviatoric_of(material, mean)
            .plus(&volume.gradient.map(|slope| pressure * slope))
    }

    /// The gradient without the part of the mean change of volume.
    pub fn deviatoric(&self, material: &HyperelasticMaterial) -> Hex8Stress {
        self.deviatoric_of(material, &self.isochoric(material))
    }

    fn deviatoric_of(&self, material: &HyperelasticMaterial, mean: &StrainFunction) -> Hex8Stress {
        let thinning = material.thinning();
        let mut gradient = Hex8Stress::ZERO.plus(&mean.gradient);
        for fiber in material.fibers_now() {
            fiber::add_stress(&fiber, &self.stretch, &mut gradient.stress);
        }
        for (n, i, j) in AXES {
            let [first, second] = self.variation((n, i, j), thinning).bending;
            let trace = (1.0 - thinning) * self.filling.spread[n];
            let trace = material.bulk() * trace.powi(2) * (first + second) / 3.0;
            gradient.hourglass[j][i] += trace;
            gradient.hourglass[i][j] += trace;
        }
        gradient
    }

    /// The Hessian by `S` and `p̂` (rows 0–5 and `6 + 3 mode + axis`).
    ///
    /// The part without the mean change of volume counts `share` times. The geometric part of the mean change of
    /// volume, of the relief of free faces and of the modes at clamps counts `curvature` times.
    pub fn hessian(
        &self,
        material: &HyperelasticMaterial,
        share: f64,
        pressure: Pressure,
        curvature: f64,
    ) -> [[f64; STRAIN_COMPONENTS]; STRAIN_COMPONENTS] {
        let thinning = material.thinning();
        let bulk = material.bulk();
        let volume = self.volume(thinning, true);
        let mut mean = self.warped_mean(thinning, Some(curvature), |at| {
            isochoric(material.model(), at)
        });
        self.soften(material, true, &mut mean);
        let mut hessian = mean.hessian;
        for (k, row) in hessian.iter_mut().enumerate() {
            for (l, entry) in row.iter_mut().enumerate() {
                *entry = share * *entry
                    + pressure.stiffness * volume.gradient[k] * volume.gradient[l]
                    + curvature * pressure.at(volume.value) * volume.hessian[k][l];
            }
        }
        let mut center = [[0.0; 6]; 6];
        for fiber in material.fibers_now() {
            fiber::add_tangent(&fiber, &self.stretch, &mut center);
        }
        for k in 0..6 {
            for l in 0..6 {
                hessian[k][l] += share * center[k][l];
            }
        }
        let trace = share * bulk * (1.0 - thinning).powi(2) / 3.0;
        for (n, i, j) in AXES {
            let trace = trace * self.filling.spread[n].powi(2);
            let places = [place(j, i), place(i, j)];
            for row in places {
                for column in places {
                    hessian[row][column] += trace;
                }
            }
        }
        hessian
    }
}

fn stress_only(material: &HyperelasticMaterial, at: &Sym) -> Response {
    let (value, stress) = isochoric_stress(material.model(), at);
    Response {
        value,
        stress,
        ..Response::default()
    }
}
