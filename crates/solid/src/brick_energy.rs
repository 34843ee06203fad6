//! The energy of a voxel in its rotated frame, with gradient and Hessian; the formula stands in
//! [`crate::brick`].
//!
//! Long because energy, gradient and Hessian are one derivation, term by term.

use crate::brick_thickness::Thickness;
use crate::hyperelastic::symmetric::{
    Sym, determinant_response, isochoric, isochoric_stress, to_matrix, to_sym,
};
use crate::hyperelastic::{HyperelasticMaterial, Response, fiber};
use crate::matrix::{Mat3, apply_transposed, determinant, polar};
use crate::vector::{Vec3, axpy};
use crate::warping::Warping;

const SQRT_2: f64 = std::f64::consts::SQRT_2;

/// The three axes `n` with the other two.
pub(crate) const AXES: [(usize, usize, usize); 3] = [(0, 1, 2), (1, 2, 0), (2, 0, 1)];

/// Offset of the off-diagonal entries of a [`Sym`]: entry `OFF + n` couples the two axes other than `n`.
pub(crate) const OFF: usize = 3;

/// The columns of the mean gradient and the four hourglass vectors.
pub(crate) type Modes = [Vec3; 7];

/// The generalized coordinates that the energy depends on: `S` (Mandel) and `p̂₁ … p̂₃`.
pub(crate) const SHAPE: usize = 15;

/// Distribution of the material in a voxel, along each axis, in units of half an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filling {
    /// The center of the material, the means of ξ, η, ζ over it; 0 is that of the voxel.
    pub shift: Vec3,
    /// √3 times the standard deviation of the material from its center; 1 for a full voxel.
    pub spread: Vec3,
    /// The means of ηζ, ζξ, ξη over the material.
    pub products: Vec3,
}

impl Filling {
    /// A full voxel.
    pub const FULL: Self = Self {
        shift: [0.0; 3],
        spread: [1.0; 3],
        products: [0.0; 3],
    };

    /// Turns the mean gradient over the voxel into that over the material.
    ///
    /// The gradient of the trilinear motion is `∂x/∂ξ = f₁ + p₂ζ + p₃η + p₄ηζ`, and so on around.
    pub(crate) fn average(&self, modes: &mut Modes) {
        for (n, i, j) in AXES {
            let parts = [
                (3 + i, self.shift[j]),
                (3 + j, self.shift[i]),
                (6, self.products[n]),
            ];
            for (mode, part) in parts {
                let vector = modes[mode];
                axpy(&mut modes[n], part, vector);
            }
        }
    }

    /// The transpose of [`Filling::average`]: turns derivatives by the averaged modes into those by the modes
    /// themselves.
    ///
    /// `add(to, part, from)` adds `part` times the derivative `from` to the derivative `to`.
    pub(crate) fn distribute(&self, mut add: impl FnMut(usize, f64, usize)) {
        for (n, i, j) in AXES {
            add(3 + i, self.shift[j], n);
            add(3 + j, self.shift[i], n);
            add(6, self.products[n], n);
        }
    }
}

/// Arguments of the energy of one voxel: its modes in the rotated frame.
pub(crate) struct Rotated {
    pub filling: Filling,
    pub warping: Warping,
    pub rotation: Mat3,
    pub stretch: Sym,
    pub hourglass: [Vec3; 3],
    /// Stress-free bending: half the difference of its free stretches at the two sides of each axis, over their mean.
    pub bent: Vec3,
    pub bilinear: Vec3,
    /// The largest isochoric energy so far, in J/m³.
    pub peak: f64,
}

/// The stress of a voxel in its rotated frame: the gradient of the energy by the generalized coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrickStress {
    pub(crate) stress: Sym,
    pub(crate) hourglass: [Vec3; 3],
}

/// The strain of a voxel in its rotated frame: the generalized coordinates themselves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrickStrain {
    pub(crate) stretch: Sym,
    pub(crate) hourglass: [Vec3; 3],
}

/// Pressure law of a voxel for its change of volume: `k (J − 1 + shift)`, positive in tension.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    pub deviatoric: BrickStress,
    /// Energy of the mean change of volume and of the bilinear mode; `other` leaves out the latter's gradient.
    pub other_energy: f64,
    pub other: BrickStress,
    /// The pressure in Pa, positive in tension.
    pub pressure: f64,
}

impl BrickStrain {
    /// All coordinates in one row.
    pub(crate) fn row(&self) -> [f64; SHAPE] {
        let mut row = [0.0; SHAPE];
        row[..6].copy_from_slice(&self.stretch);
        row[6..].copy_from_slice(self.hourglass.as_flattened());
        row
    }
}

impl BrickStress {
    /// No stress.
    pub const ZERO: Self = Self {
        stress: [0.0; 6],
        hourglass: [[0.0; 3]; 3],
    };

    /// The work per rest volume (J/m³) done along a strain.
    pub(crate) fn along(&self, stretch: &Sym, hourglass: &[Vec3; 3]) -> f64 {
        let own = self.hourglass.as_flattened().iter();
        let bent: f64 = own.zip(hourglass.as_flattened()).map(|(s, p)| s * p).sum();
        dot6(&self.stress, stretch) + bent
    }

    /// `self + factor other`.
    #[must_use]
    pub fn plus_scaled(mut self, factor: f64, other: &Self) -> Self {
        for (t, o) in self.stress.iter_mut().zip(other.stress) {
            *t += factor * o;
        }
        for m in 0..3 {
            axpy(&mut self.hourglass[m], factor, other.hourglass[m]);
        }
        self
    }

    /// Adds a row of increments.
    pub(crate) fn plus(mut self, row: &[f64; SHAPE]) -> Self {
        for k in 0..6 {
            self.stress[k] += row[k];
        }
        for (value, change) in self.hourglass.as_flattened_mut().iter_mut().zip(&row[6..]) {
            *value += change;
        }
        self
    }
}

impl Rotated {
    pub fn strain(&self) -> BrickStrain {
        BrickStrain {
            stretch: self.stretch,
            hourglass: self.hourglass,
        }
    }

    /// This state with another strain in the same frame.
    pub fn with_strain(&self, strain: &BrickStrain) -> Self {
        Self {
            filling: self.filling,
            warping: self.warping,
            rotation: self.rotation,
            stretch: strain.stretch,
            hourglass: strain.hourglass,
            bent: self.bent,
            bilinear: self.bilinear,
            peak: self.peak,
        }
    }

    pub fn of(modes: &Modes, filling: Filling, warping: Warping, bent: Vec3, peak: f64) -> Self {
        let gradient: Mat3 = std::array::from_fn(|i| std::array::from_fn(|k| modes[k][i]));
        let (rotation, stretch) = polar(&gradient);
        Self {
            filling,
            warping,
            stretch: to_sym(&stretch),
            hourglass: std::array::from_fn(|m| apply_transposed(&rotation, modes[3 + m])),
            bent,
            bilinear: modes[6],
            peak,
            rotation,
        }
    }

    /// The elastic part of a coordinate of an hourglass mode: without its stress-free part.
    #[inline(always)]
    pub(crate) fn elastic_hourglass(&self, mode: usize, axis: usize) -> f64 {
        let free = if mode == axis {
            0.0
        } else {
            self.bent[3 - mode - axis]
        };
        self.hourglass[mode][axis] - free
    }

    /// `Ĥₙ` for the axis `n` with the others `i, j`.
    #[inline(always)]
    pub(crate) fn variation(&self, axes: Axes, thinning: f64) -> Variation {
        let (n, i, j) = axes;
        let p = &self.hourglass;
        let (first, second) = (self.elastic_hourglass(j, i), self.elastic_hourglass(i, j));
        let thickness = Thickness::of(&self.stretch, axes);
        let mut h = [0.0; 6];
        h[i] = first;
        h[j] = second;
        h[n] = -thinning * (thickness.first * first + thickness.second * second);
        h[OFF + n] = (p[i][i] + p[j][j]) / SQRT_2;
        Variation {
            h,
            thickness,
            bending: [first, second],
        }
    }

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

    /// The two points of an axis: the face centers of a full voxel.
    #[inline(always)]
    fn ends(&self, h: &Sym, reach: f64) -> [Sym; 2] {
        [reach, -reach].map(|reach| std::array::from_fn(|k| self.stretch[k] + reach * h[k]))
    }

    /// The mean volume ratio over the six points, with its Hessian if `second`.
    fn volume(&self, thinning: f64, second: bool) -> Shaped {
        match self.warping.clamped {
            Some(clamped) => self.clamped_volume(clamped, thinning, second),
            None => self.mean(thinning, second, |at| determinant_response(at, second)),
        }
    }

    /// The mean volume ratio and its gradient by the generalized coordinates.
    pub fn volume_slope(&self, material: &HyperelasticMaterial) -> (f64, [f64; SHAPE]) {
        let volume = self.volume(material.thinning(), false);
        (volume.value, volume.gradient)
    }

    /// The mean over the six points of a function of the stretch there.
    pub(crate) fn mean(
        &self,
        thinning: f64,
        second: bool,
        function: impl Fn(&Sym) -> Response,
    ) -> Shaped {
        let mut mean = Shaped::zero();
        for axes in AXES {
            let variation = self.variation(axes, thinning);
            let reach = self.filling.spread[axes.0];
            let [high, low] = self.ends(&variation.h, reach).map(|at| function(&at));
            mean.value += (high.value + low.value) / 6.0;
            let mut moment = [0.0; 6];
            for k in 0..6 {
                mean.gradient[k] += (high.stress[k] + low.stress[k]) / 6.0;
                moment[k] = reach * (high.stress[k] - low.stress[k]) / 6.0;
            }
            let slopes = variation.slopes(axes, thinning);
            for (place, direction) in &slopes {
                mean.gradient[*place] += dot6(direction, &moment);
            }
            if second {
                for k in 0..6 {
                    for l in 0..6 {
                        mean.hessian[k][l] += (high.tangent[k][l] + low.tangent[k][l]) / 6.0;
                    }
                }
                for (place, direction) in &slopes {
                    let mut twice = [0.0; 6];
                    for k in 0..6 {
                        let mut mixed = 0.0;
                        for l in 0..6 {
                            mixed += (high.tangent[k][l] - low.tangent[k][l]) / 6.0 * direction[l];
                            twice[k] +=
                                (high.tangent[k][l] + low.tangent[k][l]) / 6.0 * direction[l];
                        }
                        mean.hessian[k][*place] += reach * mixed;
                        mean.hessian[*place][k] += reach * mixed;
                    }
                    for (other, across) in &slopes {
                        mean.hessian[*other][*place] += reach * reach * dot6(across, &twice);
                    }
                }
                variation.add_curvature(axes, thinning, moment[axes.0], &mut mean.hessian);
            }
        }
        mean
    }

    /// The isochoric energy with its gradient, softened if the material softens.
    fn isochoric(&self, material: &HyperelasticMaterial) -> Shaped {
        let mut mean = self.virgin(material);
        self.soften(material, false, &mut mean);
        mean
    }

    /// The isochoric energy of virgin material, with its gradient.
    pub fn virgin(&self, material: &HyperelasticMaterial) -> Shaped {
        let thinning = material.thinning();
        self.warped_mean(thinning, None, |at| stress_only(material, at))
    }

    /// The factor `η` by which softening reduces the isochoric stress.
    pub fn softness(&self, material: &HyperelasticMaterial) -> f64 {
        material.mullins().map_or(1.0, |mullins| {
            mullins.soften(self.virgin(material).value, self.peak)[1]
        })
    }

    /// Softens the mean isochoric energy, with one peak for the whole voxel.
    ///
    /// Strain that grows and falls in proportion has the same `W/P` everywhere, and with it the same `η`, up to `m`:
    /// for a voxel that bends, a peak at each of its points would change the result in second order only.
    fn soften(&self, material: &HyperelasticMaterial, second: bool, mean: &mut Shaped) {
        let Some(mullins) = material.mullins() else {
            return;
        };
        let [value, slope, turn] = mullins.soften(mean.value, self.peak);
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
        let mut deviatoric = BrickStress::ZERO.plus(&mean.gradient);
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
            other: BrickStress::ZERO.plus(&volume.gradient.map(|slope| value * slope)),
            pressure: value,
        }
    }

    pub fn gradient(&self, material: &HyperelasticMaterial) -> BrickStress {
        self.gradient_of(material, &self.isochoric(material))
    }

    /// The gradient with a given isochoric part.
    pub fn gradient_of(&self, material: &HyperelasticMaterial, mean: &Shaped) -> BrickStress {
        let volume = self.volume(material.thinning(), false);
        let pressure = material.bulk() * (volume.value - 1.0);
        self.deviatoric_of(material, mean)
            .plus(&volume.gradient.map(|slope| pressure * slope))
    }

    /// The gradient without the part of the mean change of volume.
    pub fn deviatoric(&self, material: &HyperelasticMaterial) -> BrickStress {
        self.deviatoric_of(material, &self.isochoric(material))
    }

    fn deviatoric_of(&self, material: &HyperelasticMaterial, mean: &Shaped) -> BrickStress {
        let thinning = material.thinning();
        let mut gradient = BrickStress::ZERO.plus(&mean.gradient);
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
    ) -> [[f64; SHAPE]; SHAPE] {
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

/// An axis and the other two.
pub(crate) type Axes = (usize, usize, usize);

/// Index of the hourglass coordinate `axis` of a mode.
fn place(mode: usize, axis: usize) -> usize {
    6 + 3 * mode + axis
}

fn dot6(a: &Sym, b: &Sym) -> f64 {
    (0..6).map(|k| a[k] * b[k]).sum()
}

/// A function of all generalized coordinates.
pub(crate) struct Shaped {
    pub value: f64,
    pub gradient: [f64; SHAPE],
    pub hessian: [[f64; SHAPE]; SHAPE],
}

impl Shaped {
    pub(crate) fn zero() -> Self {
        Self {
            value: 0.0,
            gradient: [0.0; SHAPE],
            hessian: [[0.0; SHAPE]; SHAPE],
        }
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

pub(crate) struct Variation {
    pub(crate) h: Sym,
    thickness: Thickness,
    bending: [f64; 2],
}

impl Variation {
    /// The derivatives of `Ĥₙ` by the coordinates that it depends on.
    pub(crate) fn slopes(&self, (n, i, j): Axes, thinning: f64) -> [(usize, Sym); 7] {
        let along = |axis: usize, value: f64| {
            let mut h = [0.0; 6];
            h[axis] = value;
            h
        };
        let t = &self.thickness;
        let [a, b] = self.bending;
        let mut first = along(i, 1.0);
        first[n] = -thinning * t.first;
        let mut second = along(j, 1.0);
        second[n] = -thinning * t.second;
        let twist = along(OFF + n, 1.0 / SQRT_2);
        let by_n = -thinning * t.n[1] * (a / t.i[0] + b / t.j[0]);
        let by_i = thinning * a * t.first * t.i[1] / t.i[0];
        let by_j = thinning * b * t.second * t.j[1] / t.j[0];
        [
            (place(j, i), first),
            (place(i, j), second),
            (place(i, i), twist),
            (place(j, j), twist),
            (n, along(n, by_n)),
            (i, along(n, by_i)),
            (j, along(n, by_j)),
        ]
    }

    /// Adds `moment` times the second derivatives of the thickness strain
    /// `−thinning (a N/I + b N/J)`.
    pub(crate) fn add_curvature(
        &self,
        (n, i, j): Axes,
        thinning: f64,
        moment: f64,
        hessian: &mut [[f64; SHAPE]; SHAPE],
    ) {
        let t = &self.thickness;
        let factor = -thinning * moment;
        let [a, b] = self.bending;
        hessian[n][n] += factor * t.n[2] * (a / t.i[0] + b / t.j[0]);
        for (axis, other, mode, bending) in [(i, &t.i, place(j, i), a), (j, &t.j, place(i, j), b)] {
            let inverse = 1.0 / other[0];
            let slope = -other[1] * inverse * inverse;
            let curvature = (2.0 * other[1] * other[1] * inverse - other[2]) * inverse * inverse;
            hessian[axis][axis] += factor * bending * t.n[0] * curvature;
            let mut both = |row: usize, column: usize, value: f64| {
                hessian[row][column] += factor * value;
                hessian[column][row] += factor * value;
            };
            both(n, axis, bending * t.n[1] * slope);
            both(mode, n, t.n[1] * inverse);
            both(mode, axis, t.n[0] * slope);
        }
    }
}
