//! The energy, its gradient and its Hessian by the generalized coordinates, one voxel in each lane; the formulas stand in
//! [`crate::element::coordinates`], [`crate::element::warping_modes`] and [`crate::hyperelastic`].
//!
//! Long because gradient and Hessian are one derivation, part by part of the energy.

use pulp::Simd;

use super::frame::{Constants, turned};
use super::number::{Nine, Number, Six, Three, cofactors, cross, dot, to_matrix, to_sym};
use crate::element::coordinates::{AXES, Axes, OFF, STRAIN_COMPONENTS};
use crate::hyperelastic::Model;

const HALF_ROOT: f64 = std::f64::consts::FRAC_1_SQRT_2;
const SQRT_2: f64 = std::f64::consts::SQRT_2;

/// Volume ratios for which [`inverse_cube_root`] converges; outside them the scalar code answers.
const VOLUMES: [f64; 2] = [0.1, 10.0];
/// Newton's method squares an error of a quarter to rounding.
const ROOT_ITERATIONS: usize = 6;
/// Stretch below which the scalar code continues the thickness ratios ([`crate::element::thickness`]).
pub(super) const LEAST_STRETCH: f64 = 0.2;

/// A row of generalized coordinates, or of derivatives by them.
pub(super) type Row<S> = [Number<S>; STRAIN_COMPONENTS];
/// A matrix of such rows, as a Hessian.
pub(super) type Square<S> = [Row<S>; STRAIN_COMPONENTS];

/// The coordinates that an energy depends on.
#[derive(Clone, Copy)]
pub(super) struct Shape<S: Simd> {
    pub stretch: Six<S>,
    pub hourglass: [Three<S>; 3],
}

/// Index of the hourglass coordinate `axis` of a mode.
const fn place(mode: usize, axis: usize) -> usize {
    6 + 3 * mode + axis
}

impl<S: Simd> Shape<S> {
    #[inline(always)]
    pub fn row(&self) -> Row<S> {
        let mut row = [self.stretch[0]; STRAIN_COMPONENTS];
        row[..6].copy_from_slice(&self.stretch);
        row[6..].copy_from_slice(self.hourglass.as_flattened());
        row
    }

    #[inline(always)]
    pub fn of_row(row: &Row<S>) -> Self {
        let mut shape = Self {
            stretch: [row[0]; 6],
            hourglass: [[row[0]; 3]; 3],
        };
        shape.stretch.copy_from_slice(&row[..6]);
        shape
            .hourglass
            .as_flattened_mut()
            .copy_from_slice(&row[6..]);
        shape
    }
}

/// `x^(−1/3)`.
#[inline(always)]
fn inverse_cube_root<S: Simd>(x: Number<S>) -> Number<S> {
    let mut y = (x + 2.0) * (x * 2.0 + 1.0).inverse();
    for _ in 0..ROOT_ITERATIONS {
        let cube = x * y * y * y;
        y = y * (-cube + 4.0) * (1.0 / 3.0);
    }
    y
}

/// `∂²det S/∂S²` of a tensor, times `factor`, added to the upper half of a matrix.
#[inline(always)]
fn add_second_determinant<S: Simd>(matrix: &mut [Six<S>; 6], s: &Six<S>, factor: Number<S>) {
    for (i, j, k) in AXES {
        let entry = factor * s[k];
        matrix[i.min(j)][i.max(j)] += entry;
        matrix[3 + i][3 + i] -= factor * s[i];
        matrix[i][3 + i] -= factor * s[3 + i];
        matrix[3 + i.min(j)][3 + i.max(j)] += factor * s[3 + k] * HALF_ROOT;
    }
}

#[inline(always)]
fn mirror<S: Simd>(matrix: &mut [Six<S>; 6]) {
    for k in 1..6 {
        for l in 0..k {
            matrix[k][l] = matrix[l][k];
        }
    }
}

/// `Ĥₙ` of an axis and its derivatives.
struct Variation<S: Simd> {
    /// Along `i`, `j`, `n`, and the twist.
    h: [Number<S>; 4],
    bending: [Number<S>; 2],
    /// `Sₙₙ` and the inverses of `Sᵢᵢ`, `Sⱼⱼ`.
    n: Number<S>,
    inverse: [Number<S>; 2],
    /// The slopes of the thickness strain by `a, b, Sₙₙ, Sᵢᵢ, Sⱼⱼ`.
    slopes: [Number<S>; 5],
}

impl<S: Simd> Variation<S> {
    #[inline(always)]
    fn of(shape: &Shape<S>, (n, i, j): Axes, thinning: Number<S>) -> Self {
        let p = &shape.hourglass;
        let (a, b) = (p[j][i], p[i][j]);
        let along = shape.stretch[n];
        let (by_i, by_j) = (shape.stretch[i].inverse(), shape.stretch[j].inverse());
        let minus = -thinning;
        let (first, second) = (minus * along * by_i, minus * along * by_j);
        Self {
            h: [
                a,
                b,
                first.times_plus(a, second * b),
                (p[i][i] + p[j][j]) * HALF_ROOT,
            ],
            bending: [a, b],
            n: along,
            inverse: [by_i, by_j],
            slopes: [
                first,
                second,
                minus * (a * by_i + b * by_j),
                -(first * a * by_i),
                -(second * b * by_j),
            ],
        }
    }

    /// The components of a [`Six`] in which `h` is not zero.
    const fn places((n, i, j): Axes) -> [usize; 4] {
        [i, j, n, OFF + n]
    }

    /// `Ĥₙ` as a tensor.
    #[inline(always)]
    fn tensor(&self, axes: Axes) -> Six<S> {
        let mut tensor = [self.n.all(0.0); 6];
        let places = Self::places(axes);
        for k in 0..4 {
            tensor[places[k]] = self.h[k];
        }
        tensor
    }

    /// The coordinates that `Ĥₙ` depends on.
    const fn coordinates((n, i, j): Axes) -> [usize; 7] {
        [place(j, i), place(i, j), place(i, i), place(j, j), n, i, j]
    }

    /// The chain rule: derivatives by these coordinates, from those by the four components of `Ĥₙ`.
    #[inline(always)]
    fn through(&self, values: &[Number<S>; 4]) -> [Number<S>; 7] {
        let twist = values[3] * HALF_ROOT;
        [
            self.slopes[0].times_plus(values[2], values[0]),
            self.slopes[1].times_plus(values[2], values[1]),
            twist,
            twist,
            self.slopes[2] * values[2],
            self.slopes[3] * values[2],
            self.slopes[4] * values[2],
        ]
    }

    /// Adds the derivatives of a function of `S` and `Ĥₙ`: `moment` is its gradient by `Ĥₙ`, `mixed` its second
    /// derivatives by `S` and `Ĥₙ`, `square` those by `Ĥₙ` alone.
    #[inline(always)]
    fn add_hessian(
        &self,
        axes: Axes,
        thinning: Number<S>,
        moment: Number<S>,
        mixed: &[Six<S>; 6],
        square: &[Six<S>; 6],
        hessian: &mut Square<S>,
    ) {
        let places = Self::places(axes);
        let coordinates = Self::coordinates(axes);
        for k in 0..6 {
            let row = &mixed[k];
            let values = self.through(&[
                row[places[0]],
                row[places[1]],
                row[places[2]],
                row[places[3]],
            ]);
            for u in 0..7 {
                hessian[k][coordinates[u]] += values[u];
                hessian[coordinates[u]][k] += values[u];
            }
        }
        // Rows by component, columns by coordinate; then the rows likewise.
        let mut half = [[moment; 7]; 4];
        for k in 0..4 {
            let row = &square[places[k]];
            half[k] = self.through(&[
                row[places[0]],
                row[places[1]],
                row[places[2]],
                row[places[3]],
            ]);
        }
        for u in 0..7 {
            let values = self.through(&[half[0][u], half[1][u], half[2][u], half[3][u]]);
            for v in 0..7 {
                hessian[coordinates[v]][coordinates[u]] += values[v];
            }
        }
        self.add_curvature(axes, -(thinning * moment), hessian);
    }

    /// Adds `factor` times the second derivatives of `a N/I + b N/J`.
    #[inline(always)]
    fn add_curvature(&self, (n, i, j): Axes, factor: Number<S>, hessian: &mut Square<S>) {
        for (side, axis, mode) in [(0, i, place(j, i)), (1, j, place(i, j))] {
            let inverse = self.inverse[side];
            let bending = factor * self.bending[side];
            let slope = -(inverse * inverse);
            hessian[axis][axis] += bending * self.n * (inverse * inverse * inverse) * 2.0;
            let by_n_axis = bending * slope;
            hessian[n][axis] += by_n_axis;
            hessian[axis][n] += by_n_axis;
            let by_mode_n = factor * inverse;
            hessian[mode][n] += by_mode_n;
            hessian[n][mode] += by_mode_n;
            let by_mode_axis = factor * self.n * slope;
            hessian[mode][axis] += by_mode_axis;
            hessian[axis][mode] += by_mode_axis;
        }
    }
}

/// The volume ratio and its gradient ([`crate::element::volume`]).
pub(super) struct Volume<S: Simd> {
    pub value: Number<S>,
    pub gradient: Row<S>,
}

impl<S: Simd> Volume<S> {
    #[inline(always)]
    pub fn of(constants: &Constants<S>, shape: &Shape<S>) -> Self {
        let seen = Self::seen(constants, shape);
        let mut volume = match (constants.has_inside, constants.has_surface) {
            (_, false) => Self::nodal_of(constants, &seen),
            (false, true) => Self::mean_of(constants, &seen),
            (true, true) => {
                let mut own = Self::nodal_of(constants, &seen);
                let mean = Self::mean_of(constants, &seen);
                let part = constants.surface;
                own.value = part.times_plus(mean.value - own.value, own.value);
                for (own, mean) in own.gradient.iter_mut().zip(mean.gradient) {
                    *own = part.times_plus(mean - *own, *own);
                }
                own
            }
        };
        for axis in 0..3 {
            let entry = &mut volume.gradient[OFF + axis];
            *entry = *entry * constants.volume_shears[axis];
        }
        volume
    }

    /// The shape whose volume counts, with the shears that free faces leave.
    #[inline(always)]
    fn seen(constants: &Constants<S>, shape: &Shape<S>) -> Shape<S> {
        let mut seen = *shape;
        for axis in 0..3 {
            let entry = &mut seen.stretch[OFF + axis];
            *entry = *entry * constants.volume_shears[axis];
        }
        seen
    }

    /// Adds `factor` times the second derivatives.
    #[inline(always)]
    pub fn add_hessian(
        constants: &Constants<S>,
        shape: &Shape<S>,
        factor: Number<S>,
        hessian: &mut Square<S>,
    ) {
        let seen = Self::seen(constants, shape);
        if !constants.is_warped {
            Self::add_either_hessian(constants, &seen, factor, hessian);
            return;
        }
        let mut own = [[constants.bulk.all(0.0); STRAIN_COMPONENTS]; STRAIN_COMPONENTS];
        Self::add_either_hessian(constants, &seen, factor, &mut own);
        for axis in 0..3 {
            let left = constants.volume_shears[axis];
            for other in 0..STRAIN_COMPONENTS {
                own[OFF + axis][other] = own[OFF + axis][other] * left;
                own[other][OFF + axis] = own[other][OFF + axis] * left;
            }
        }
        for k in 0..STRAIN_COMPONENTS {
            for l in 0..STRAIN_COMPONENTS {
                hessian[k][l] += own[k][l];
            }
        }
    }

    #[inline(always)]
    fn add_either_hessian(
        constants: &Constants<S>,
        seen: &Shape<S>,
        factor: Number<S>,
        hessian: &mut Square<S>,
    ) {
        if constants.has_inside {
            let part = factor * (-constants.surface + 1.0);
            Self::add_nodal_hessian(constants, seen, part, hessian);
        }
        if constants.has_surface {
            let part = factor * constants.surface;
            Self::add_mean_hessian(constants, seen, part, hessian);
        }
    }

    /// The volume between the nodes.
    #[inline(always)]
    fn nodal_of(constants: &Constants<S>, shape: &Shape<S>) -> Self {
        let matrix = to_matrix(&shape.stretch);
        let mut slope = cofactors(&matrix);
        let mut value = dot(&matrix[0], &slope[0]);
        let mut gradient = [constants.bulk.all(0.0); STRAIN_COMPONENTS];
        for (k, i, j) in AXES {
            let share = constants.volume_share(k);
            let (first, second) = (&shape.hourglass[i], &shape.hourglass[j]);
            let across = cross(first, second);
            let (by_first, by_second) = (cross(second, &matrix[k]), cross(&matrix[k], first));
            value = share.times_plus(dot(&matrix[k], &across), value);
            for axis in 0..3 {
                slope[axis][k] = share.times_plus(across[axis], slope[axis][k]);
                let entry = &mut gradient[place(i, axis)];
                *entry = share.times_plus(by_first[axis], *entry);
                let entry = &mut gradient[place(j, axis)];
                *entry = share.times_plus(by_second[axis], *entry);
            }
        }
        for axis in 0..3 {
            gradient[axis] = slope[axis][axis];
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            gradient[OFF + axis] = (slope[j][k] + slope[k][j]) * HALF_ROOT;
        }
        Self { value, gradient }
    }

    /// Adds `factor` times the second derivatives of [`Self::nodal_of`].
    #[inline(always)]
    fn add_nodal_hessian(
        constants: &Constants<S>,
        shape: &Shape<S>,
        factor: Number<S>,
        hessian: &mut Square<S>,
    ) {
        let zero = constants.bulk.all(0.0);
        let matrix = to_matrix(&shape.stretch);
        let mut second = [[zero; 6]; 6];
        add_second_determinant(&mut second, &shape.stretch, factor);
        mirror(&mut second);
        add_square(hessian, &second);
        for (k, i, j) in AXES {
            let share = constants.volume_share(k) * factor;
            for (a, b, c) in AXES {
                let twist = share * matrix[k][c];
                add_both(hessian, place(i, a), place(j, b), twist);
                add_both(hessian, place(i, b), place(j, a), -twist);
                let (of_stretch, part) = if a == k {
                    (a, share)
                } else {
                    (OFF + 3 - a - k, share * HALF_ROOT)
                };
                for (mode, other, sign) in [(i, j, part), (j, i, -part)] {
                    let q = &shape.hourglass[other];
                    add_both(hessian, of_stretch, place(mode, b), sign * q[c]);
                    add_both(hessian, of_stretch, place(mode, c), -(sign * q[b]));
                }
            }
        }
    }

    /// The mean of `det (S ± Ĥ)`; over two points `S ± r Ĥ` it is `det S + r² S : cof Ĥ` without remainder, so that it
    /// needs no points.
    #[inline(always)]
    fn mean_of(constants: &Constants<S>, shape: &Shape<S>) -> Self {
        let zero = constants.bulk.all(0.0);
        let matrix = to_matrix(&shape.stretch);
        let cofactor = cofactors(&matrix);
        let mut value = dot(&matrix[0], &cofactor[0]);
        let mut gradient = [zero; STRAIN_COMPONENTS];
        gradient[..6].copy_from_slice(&to_sym(&cofactor));
        for axes in AXES {
            let variation = Variation::of(shape, axes, constants.thinning);
            let reach = constants.spread[axes.0];
            let share = reach * reach * (1.0 / 3.0);
            let tensor = variation.tensor(axes);
            let across = to_sym(&cofactors(&to_matrix(&tensor)));
            value = share.times_plus(dot(&shape.stretch, &across), value);
            for k in 0..6 {
                gradient[k] = share.times_plus(across[k], gradient[k]);
            }
            let moment = Self::moment(shape, &tensor);
            let slopes = variation.through(&pick(&moment, Variation::<S>::places(axes)));
            let coordinates = Variation::<S>::coordinates(axes);
            for u in 0..7 {
                let entry = &mut gradient[coordinates[u]];
                *entry = share.times_plus(slopes[u], *entry);
            }
        }
        Self { value, gradient }
    }

    /// `cof′(S) Ĥ`.
    #[inline(always)]
    fn moment(shape: &Shape<S>, tensor: &Six<S>) -> Six<S> {
        let zero = tensor[0].all(0.0);
        let mut second = [[zero; 6]; 6];
        add_second_determinant(&mut second, &shape.stretch, zero.all(1.0));
        mirror(&mut second);
        let mut moment = *tensor;
        for k in 0..6 {
            moment[k] = dot(&second[k], tensor);
        }
        moment
    }

    /// Adds `factor` times the second derivatives of [`Self::mean_of`].
    #[inline(always)]
    fn add_mean_hessian(
        constants: &Constants<S>,
        shape: &Shape<S>,
        factor: Number<S>,
        hessian: &mut Square<S>,
    ) {
        let zero = constants.bulk.all(0.0);
        let mut second = [[zero; 6]; 6];
        add_second_determinant(&mut second, &shape.stretch, factor);
        mirror(&mut second);
        add_square(hessian, &second);
        for axes in AXES {
            let variation = Variation::of(shape, axes, constants.thinning);
            let reach = constants.spread[axes.0];
            let share = reach * reach * (1.0 / 3.0);
            let tensor = variation.tensor(axes);
            let mut mixed = [[zero; 6]; 6];
            add_second_determinant(&mut mixed, &tensor, factor * share);
            mirror(&mut mixed);
            let mut square = second;
            for row in &mut square {
                for entry in row {
                    *entry = *entry * share;
                }
            }
            let moment = dot(&square[axes.0], &tensor);
            variation.add_hessian(axes, constants.thinning, moment, &mixed, &square, hessian);
        }
    }
}

/// Adds a value to an entry off the diagonal, and to its mirror image.
#[inline(always)]
fn add_both<S: Simd>(hessian: &mut Square<S>, row: usize, column: usize, value: Number<S>) {
    hessian[row][column] += value;
    hessian[column][row] += value;
}

#[inline(always)]
fn pick<S: Simd>(values: &Six<S>, places: [usize; 4]) -> [Number<S>; 4] {
    [
        values[places[0]],
        values[places[1]],
        values[places[2]],
        values[places[3]],
    ]
}

#[inline(always)]
fn add_square<S: Simd>(hessian: &mut Square<S>, square: &[Six<S>; 6]) {
    for k in 0..6 {
        for l in 0..6 {
            hessian[k][l] += square[k][l];
        }
    }
}

/// Returns the energy without that of the mean change of volume and of bilinear modes; adds its gradient, and its
/// Hessian if `hessian` is given.
///
/// `sound` falls below zero where the scalar code would use continuations of the energy.
#[inline(always)]
pub(super) fn add_deviatoric<S: Simd>(
    constants: &Constants<S>,
    shape: &Shape<S>,
    gradient: &mut Row<S>,
    hessian: Option<&mut Square<S>>,
    sound: &mut Number<S>,
) -> Number<S> {
    let mut hessian = hessian;
    let mut energy = if constants.is_warped {
        let stretch = into_frame(constants, &shape.stretch);
        let (relieved, slopes) = relief(constants, &stretch);
        let seen = Shape {
            stretch: out_of_frame(constants, &relieved),
            hourglass: shape.hourglass,
        };
        let back = |values: &Six<S>| {
            let own = through_relief(&slopes, &into_frame(constants, values));
            out_of_frame(constants, &own)
        };
        let mut own = [constants.bulk.all(0.0); STRAIN_COMPONENTS];
        let energy = add_isochoric(constants, &seen, &mut own, hessian.as_deref_mut(), sound);
        let force = [own[0], own[1], own[2], own[3], own[4], own[5]];
        if let Some(hessian) = hessian.as_deref_mut() {
            // The chain rule on rows, then on columns.
            for row in hessian.iter_mut() {
                let seen = [row[0], row[1], row[2], row[3], row[4], row[5]];
                row[..6].copy_from_slice(&back(&seen));
            }
            for column in 0..STRAIN_COMPONENTS {
                let mut seen = force;
                for k in 0..6 {
                    seen[k] = hessian[k][column];
                }
                let own = back(&seen);
                for k in 0..6 {
                    hessian[k][column] = own[k];
                }
            }
            let local = into_frame(constants, &force);
            let mut curvature = [[constants.bulk.all(0.0); 6]; 6];
            add_relief_curvature(constants, &stretch, &local, &mut curvature);
            if constants.surface_frame.is_some() {
                for row in &mut curvature {
                    *row = out_of_frame(constants, row);
                }
                for column in 0..6 {
                    let mut own = force;
                    for k in 0..6 {
                        own[k] = curvature[k][column];
                    }
                    let own = out_of_frame(constants, &own);
                    for k in 0..6 {
                        curvature[k][column] = own[k];
                    }
                }
            }
            add_square(hessian, &curvature);
        }
        own[..6].copy_from_slice(&back(&force));
        for k in 0..STRAIN_COMPONENTS {
            gradient[k] += own[k];
        }
        energy
    } else {
        add_isochoric(constants, shape, gradient, hessian.as_deref_mut(), sound)
    };
    let left = -constants.thinning + 1.0;
    let trace = constants.bulk * left * left * (1.0 / 3.0);
    for (n, i, j) in AXES {
        let trace = trace * constants.spread[n] * constants.spread[n];
        let places = [place(j, i), place(i, j)];
        let sum = shape.hourglass[j][i] + shape.hourglass[i][j];
        energy += trace * sum * sum * 0.5;
        for row in places {
            gradient[row] = trace.times_plus(sum, gradient[row]);
            if let Some(hessian) = hessian.as_deref_mut() {
                for column in places {
                    hessian[row][column] += trace;
                }
            }
        }
    }
    energy
}

/// The isochoric energy, the mean over the six points, with its derivatives.
#[inline(always)]
fn add_isochoric<S: Simd>(
    constants: &Constants<S>,
    shape: &Shape<S>,
    gradient: &mut Row<S>,
    hessian: Option<&mut Square<S>>,
    sound: &mut Number<S>,
) -> Number<S> {
    let mut hessian = hessian;
    let zero = constants.bulk.all(0.0);
    let mut energy = zero;
    for axis in 0..3 {
        *sound = sound.least(shape.stretch[axis] + -LEAST_STRETCH);
    }
    for axes in AXES {
        let variation = Variation::of(shape, axes, constants.thinning);
        let reach = constants.spread[axes.0];
        let tensor = variation.tensor(axes);
        let (mut high, mut low) = (shape.stretch, shape.stretch);
        for place in Variation::<S>::places(axes) {
            high[place] = reach.times_plus(tensor[place], shape.stretch[place]);
            low[place] = (-reach).times_plus(tensor[place], shape.stretch[place]);
        }
        let with_tangent = hessian.is_some();
        let high = Point::of(constants, &high, with_tangent, sound);
        let low = Point::of(constants, &low, with_tangent, sound);
        let sixth = 1.0 / 6.0;
        let reach_sixth = reach * sixth;
        energy += (high.energy + low.energy) * sixth;
        let mut moment = high.stress;
        for k in 0..6 {
            gradient[k] += (high.stress[k] + low.stress[k]) * sixth;
            moment[k] = reach_sixth * (high.stress[k] - low.stress[k]);
        }
        let slopes = variation.through(&pick(&moment, Variation::<S>::places(axes)));
        let coordinates = Variation::<S>::coordinates(axes);
        for u in 0..7 {
            gradient[coordinates[u]] += slopes[u];
        }
        if let Some(hessian) = hessian.as_deref_mut() {
            let (mut mean, mut mixed, mut square) =
                ([[zero; 6]; 6], [[zero; 6]; 6], [[zero; 6]; 6]);
            let reach_square = reach * reach;
            for k in 0..6 {
                for l in k..6 {
                    mean[k][l] = (high.tangent[k][l] + low.tangent[k][l]) * sixth;
                    mixed[k][l] = reach_sixth * (high.tangent[k][l] - low.tangent[k][l]);
                    square[k][l] = reach_square * mean[k][l];
                }
            }
            mirror(&mut mean);
            mirror(&mut mixed);
            mirror(&mut square);
            add_square(hessian, &mean);
            let moment = moment[axes.0];
            variation.add_hessian(axes, constants.thinning, moment, &mixed, &square, hessian);
        }
    }
    energy
}

/// The isochoric response at one stretch.
struct Point<S: Simd> {
    energy: Number<S>,
    stress: Six<S>,
    /// The upper half.
    tangent: [Six<S>; 6],
}

impl<S: Simd> Point<S> {
    #[inline(always)]
    fn of(constants: &Constants<S>, s: &Six<S>, tangent: bool, sound: &mut Number<S>) -> Self {
        let matrix = to_matrix(s);
        let cofactor: Nine<S> = cofactors(&matrix);
        let volume = dot(&matrix[0], &cofactor[0]);
        *sound = sound
            .least(volume + -VOLUMES[0])
            .least(-volume + VOLUMES[1]);
        let c = to_sym(&cofactor);
        let a = dot(s, s);
        let root = inverse_cube_root(volume);
        let by_volume = volume.inverse();
        // g = J^(−2/3) with derivatives.
        let g = root * root;
        let dg = g * by_volume * (-2.0 / 3.0);
        let ddg = dg * by_volume * (-5.0 / 3.0);
        let excess = a.times_plus(g, g.all(-3.0));
        let [c0, c1, c2] = constants.series;
        let mut energy = excess * excess.times_plus(excess.times_plus(c2, c1), c0);
        let mut slope = excess.times_plus(excess.times_plus(c2 * 3.0, c1 * 2.0), c0);
        let mut curvature = excess.times_plus(c2 * 6.0, c1 * 2.0);
        if let Some([shear, limit]) = constants.gent {
            let part = excess * limit.inverse();
            *sound = sound.least(-part + Model::GENT_REACH);
            let left = (-part + 1.0).inverse();
            energy -= shear * limit * (-part + 1.0).logarithm() * 0.5;
            let own = shear * left * 0.5;
            slope += own;
            curvature += own * left * limit.inverse();
        }
        let adg = a * dg;
        let (of_s, of_c) = (slope * g * 2.0, slope * adg);
        let mut stress = *s;
        for k in 0..6 {
            stress[k] = of_s.times_plus(s[k], of_c * c[k]);
        }
        let zero = a.all(0.0);
        let mut matrix = [[zero; 6]; 6];
        if tangent {
            let s_s = curvature * g * g * 4.0;
            let s_c = (slope * dg + curvature * g * adg) * 2.0;
            let c_c = slope * a * ddg + curvature * adg * adg;
            for k in 0..6 {
                let by_s = s_s.times_plus(s[k], s_c * c[k]);
                let by_c = s_c.times_plus(s[k], c_c * c[k]);
                for l in k..6 {
                    matrix[k][l] = by_s.times_plus(s[l], by_c * c[l]);
                }
                matrix[k][k] += of_s;
            }
            add_second_determinant(&mut matrix, s, of_c);
        }
        Self {
            energy,
            stress,
            tangent: matrix,
        }
    }
}

/// The reliefs of [`crate::element::warping_modes`] for each pair of axes and side: (pair, side, shear, across, along).
const RELIEFS: [(usize, usize, usize, usize, usize); 6] = [
    (0, 0, 3, 1, 2),
    (0, 1, 3, 2, 1),
    (1, 0, 4, 2, 0),
    (1, 1, 4, 0, 2),
    (2, 0, 5, 0, 1),
    (2, 1, 5, 1, 0),
];

/// The shear, the stretches across and along, and the inverse of `a b + s²`.
#[inline(always)]
fn sheared<S: Simd>(stretch: &Six<S>, shear: usize, across: usize, along: usize) -> [Number<S>; 4] {
    let s = stretch[shear] * HALF_ROOT;
    let (a, b) = (stretch[across], stretch[along]);
    [s, a, b, a.times_plus(b, s * s).inverse()]
}

/// Turns a tensor into the frame of the surface.
#[inline(always)]
fn into_frame<S: Simd>(constants: &Constants<S>, tensor: &Six<S>) -> Six<S> {
    let Some(frame) = &constants.surface_frame else {
        return *tensor;
    };
    let mut transposed = *frame;
    for i in 0..3 {
        for j in 0..3 {
            transposed[i][j] = frame[j][i];
        }
    }
    to_sym(&turned(&transposed, &to_matrix(tensor)))
}

/// Turns a tensor back from the frame of the surface.
#[inline(always)]
fn out_of_frame<S: Simd>(constants: &Constants<S>, tensor: &Six<S>) -> Six<S> {
    match &constants.surface_frame {
        Some(frame) => to_sym(&turned(frame, &to_matrix(tensor))),
        None => *tensor,
    }
}

/// The relieved stretch at which the isochoric energy is evaluated, and its derivatives (rows).
#[inline(always)]
fn relief<S: Simd>(constants: &Constants<S>, stretch: &Six<S>) -> (Six<S>, [Six<S>; 6]) {
    let zero = constants.bulk.all(0.0);
    let mut relieved = *stretch;
    let mut slopes = [[zero; 6]; 6];
    for axis in 0..3 {
        slopes[axis][axis] = zero.all(1.0);
        let left = constants.shears[axis];
        relieved[3 + axis] = stretch[3 + axis] * left;
        slopes[3 + axis][3 + axis] = left;
    }
    for (pair, side, shear, across, along) in RELIEFS {
        let part = constants.warping[pair][side];
        let [s, a, b, inverse] = sheared(stretch, shear, across, along);
        let square = inverse * inverse;
        let (ss, as_) = (s * s, a * s);
        relieved[across] -= part * a * ss * inverse;
        slopes[across][shear] -= part * a * as_ * b * square * SQRT_2;
        slopes[across][across] -= part * ss * ss * square;
        slopes[across][along] += part * as_ * as_ * square;
    }
    (relieved, slopes)
}

/// The chain rule: `Σ slopes[k] values[k]`.
#[inline(always)]
fn through_relief<S: Simd>(slopes: &[Six<S>; 6], values: &Six<S>) -> Six<S> {
    // An axis depends on all but the shear across it, a shear on itself.
    let mut sum = *values;
    for k in 0..6 {
        sum[k] = if k < 3 {
            slopes[0][k].times_plus(
                values[0],
                slopes[1][k].times_plus(values[1], slopes[2][k] * values[2]),
            )
        } else {
            let own = slopes[k][k] * values[k];
            slopes[0][k].times_plus(
                values[0],
                slopes[1][k].times_plus(values[1], slopes[2][k].times_plus(values[2], own)),
            )
        };
    }
    sum
}

/// Adds the second derivatives of the relieved stretch, each component times its `force`.
#[inline(always)]
fn add_relief_curvature<S: Simd>(
    constants: &Constants<S>,
    stretch: &Six<S>,
    force: &Six<S>,
    hessian: &mut [Six<S>; 6],
) {
    for (pair, side, shear, across, along) in RELIEFS {
        let [s, a, b, inverse] = sheared(stretch, shear, across, along);
        let factor = -(constants.warping[pair][side] * force[across]);
        let cube = factor * inverse * inverse * inverse;
        let (ab, ss) = (a * b, s * s);
        let by_s_s = a * ab * (ab + ss * -3.0) * cube;
        let by_s_a = ab * s * ss * cube * (2.0 * SQRT_2);
        let by_s_b = -(a * a * s * (ab - ss) * cube * SQRT_2);
        let by_a_a = -(b * ss * ss * cube * 2.0);
        let by_a_b = -(a * ss * ss * cube * 2.0);
        let by_b_b = a * a * a * ss * cube * 2.0;
        let both = [
            (shear, across, by_s_a),
            (shear, along, by_s_b),
            (across, along, by_a_b),
        ];
        hessian[shear][shear] += by_s_s;
        hessian[across][across] += by_a_a;
        hessian[along][along] += by_b_b;
        for (row, column, value) in both {
            hessian[row][column] += value;
            hessian[column][row] += value;
        }
    }
}
