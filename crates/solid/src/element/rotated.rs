//! A voxel in its rotated frame: its generalized coordinates, the stretch at its points, and means over these.

use crate::element::coordinates::{
    AXES, Axes, Hex8Strain, Modes, OFF, STRAIN_COMPONENTS, StrainFunction, dot6, place,
};
use crate::element::cut_surface::CutSurface;
use crate::element::faces::WarpingModes;
use crate::element::thickness::Thickness;
use crate::hyperelastic::Response;
use crate::hyperelastic::symmetric::{Sym, to_sym};
use crate::matrix::{Mat3, apply_transposed, polar};
use crate::vector::{Vec3, axpy};

const SQRT_2: f64 = std::f64::consts::SQRT_2;

/// Distribution of the material in a voxel, along each axis, in units of half an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filling {
    /// The center of the material, the means of ξ, η, ζ over it; 0 is that of the voxel.
    pub shift: Vec3,
    /// √3 times the standard deviation of the material from its center; 1 for a full voxel.
    pub spread: Vec3,
    /// The means of ηζ, ζξ, ξη over the material.
    pub products: Vec3,
    /// The surface in the voxel.
    pub surface: CutSurface,
}

impl Filling {
    /// A full voxel.
    pub const FULL: Self = Self {
        shift: [0.0; 3],
        spread: [1.0; 3],
        products: [0.0; 3],
        surface: CutSurface::NONE,
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
    pub warping: WarpingModes,
    pub rotation: Mat3,
    pub stretch: Sym,
    pub hourglass: [Vec3; 3],
    /// Stress-free bending: half the difference of its free stretches at the two sides of each axis, over their mean.
    pub bent: Vec3,
    pub bilinear: Vec3,
    /// The largest isochoric energy so far, in J/m³.
    pub peak: f64,
}

impl Rotated {
    pub fn strain(&self) -> Hex8Strain {
        Hex8Strain {
            stretch: self.stretch,
            hourglass: self.hourglass,
        }
    }

    /// This state with another strain in the same frame.
    pub fn with_strain(&self, strain: &Hex8Strain) -> Self {
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

    pub fn of(
        modes: &Modes,
        filling: Filling,
        warping: WarpingModes,
        bent: Vec3,
        peak: f64,
    ) -> Self {
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

    /// The two points of an axis: the face centers of a full voxel.
    #[inline(always)]
    pub(crate) fn ends(&self, h: &Sym, reach: f64) -> [Sym; 2] {
        [reach, -reach].map(|reach| std::array::from_fn(|k| self.stretch[k] + reach * h[k]))
    }

    /// The mean over the six points of a function of the stretch there.
    pub(crate) fn mean(
        &self,
        thinning: f64,
        second: bool,
        function: impl Fn(&Sym) -> Response,
    ) -> StrainFunction {
        let mut mean = StrainFunction::zero();
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
}

pub(crate) struct Variation {
    pub(crate) h: Sym,
    thickness: Thickness,
    pub(crate) bending: [f64; 2],
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
        hessian: &mut [[f64; STRAIN_COMPONENTS]; STRAIN_COMPONENTS],
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
