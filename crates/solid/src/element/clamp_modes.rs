//! Lateral contraction of a voxel at a clamp, which its eight nodes cannot follow beside a held face. Long because
//! modes, their condensation at small strain and the energy at large strain are of one derivation.
//!
//! # The modes
//!
//! A clamp keeps rubber from drawing in across the pull, and a free side gets over that within a fraction of the body's
//! thickness. The row of voxels at the clamp can only draw in linearly from the held face `ξ_c = ∓1` to the face
//! across, and as the volume of a voxel must be kept, the contraction that is missing there is missing along the pull
//! as well: beams and walls are too stiff at their roots, the more the less they can be compressed. A quadratic row (27
//! nodes and a linear pressure) takes most of that error away. Its gain comes from the motions of its middle layer, and
//! of those from the ones of free sides, so that none of its nodes is needed. For each free face with the normal `n`
//! (at `ξₙ = s`) beside a held face, with `t` the third axis, these are
//!
//! `b eₙ`,  `b ξₜ eₙ`,  `b eₜ`  with  `b = (1 − ξ_c²)(1 + s ξₙ)/2` .
//!
//! They vanish on the held face, on the one across and on the one opposite to the free one. On the faces of `t` they
//! move along `n` and `t`: a uniform stress that leaves the face `n` free has only a part along `t` there, and meets it
//! in `b eₜ` alone, which does not change along `t`, so that its work on both faces cancels. As their mean along `c`
//! vanishes as well, uniform stress does no work on them except that of the lateral stress, which is zero: the patch
//! test holds. The last one is that of [`crate::element::warping_modes`] with `b` the axis of the clamp, and takes its
//! place.
//!
//! # Small strain
//!
//! The strain at the eight Gauss points is `ε = S − 1 + Σ ξₙ Ĥₙ + Σ mᵢ qᵢ`, and the `q` are those of least energy,
//!
//! `(A + k b bᵀ) q = −(B + k b cᵀ) s` ,  `k = K/2G` ,
//!
//! with `A` and `B` the mean products of the deviators of modes with modes and with the voxel's strains `s`, and `b`
//! and `c` the mean changes of volume: one pressure for each voxel, as in [`crate::element::hex8`]. So `q = Q s`, and
//! with `P = A⁻¹B`, `r = A⁻¹b`, `β = bᵀr`,
//!
//! `Q = −P − ζ r (cᵀ − bᵀP)` ,  `ζ = k/(1 + k β)` .
//!
//! `Q` depends on which faces are free and on ν alone.
//!
//! # Large strain
//!
//! There are no unknowns: the `q` remain a function of the voxel's strains, and the energy is that of the stretches
//!
//! `S + Σ ξₙ Ĥₙ + Σ Sₐₐ mᵢ qᵢ` ,  `a` the axis along which a mode moves.
//!
//! A body that is drawn to several times its length becomes thinner in proportion, so the `q` follow `dᵢ = ln Sᵢᵢ` and
//! `p̂ₘ·eₖ/Sₖₖ`, which are the strains when they are small. `Q` is derived for small strain, and beyond it the modes
//! fade by `φ = (1 + (ρ/ρ₀)⁴)^(−1/4)` with `ρ² = Σ d²`: followed at any strain, blocks that are drawn by half and
//! sheared between two clamps took up to 270 iterations, and drew in by 14 % too little. Without compression `Q d`
//! keeps the volume to first order whatever `s` is, so that no motion of the nodes could undo its second-order change,
//! and the voxel would lock. A pressure moves the `q` along `r`; this relief is continued with the part of the volume
//! `J₁` at `φ Q d` that the linear one, `θ = (cᵀ + φ bᵀQ) d`, does not cover:
//!
//! `q = φ Q d + r y` ,  `y = −φ ζ g(J₁ − 1 − θ)` ,  `J = J₁ + β y` ,
//!
//! with `g` the identity up to a half, where it levels off: a voxel that a wild step has swollen is pressed back as
//! others are. The isochoric energy is that of the stretches with these `q`, and `U` is that of `J`, of which little is
//! left as `K` grows. Both are bounded below as the material is. They depend on `S` and `p̂` only, so rigid motion
//! costs nothing. Drawn out uniformly, an incompressible voxel has `Q d = 0` and `J₁ = 1` at any stretch: the patch
//! test holds there at large strain too. The neglected terms are of second order in the strain, as the energy is
//! stationary in `q`.
//!
//! The modes take no load. As a pressure works on those that move along its face's normal, a free face under pressure
//! has `b eₜ` alone.

use std::sync::OnceLock;

use crate::element::coordinates::{AXES, OFF, STRAIN_COMPONENTS, StrainFunction};
use crate::element::faces::{ClampModes, across};
use crate::element::generalized_strain::{GeneralizedStrains, dot_all};
use crate::element::rotated::Rotated;
use crate::hyperelastic::Response;
use crate::hyperelastic::symmetric::{Sym, determinant_response};

const SQRT_2: f64 = std::f64::consts::SQRT_2;

/// Gauss points of a voxel.
const POINTS: usize = 8;

/// Largest number of modes: four for each of the two axes across the clamp's.
const MODES: usize = 8;

/// Mode data that depend on the faces alone.
struct Table {
    modes: Vec<Mode>,
    /// `P` at zero thinning, and its derivative by the thinning.
    plain: Vec<[f64; STRAIN_COMPONENTS]>,
    thinned: Vec<[f64; STRAIN_COMPONENTS]>,
    /// `r`.
    spread: Vec<f64>,
    /// `b` and `β`.
    volume: Vec<f64>,
    yielding: f64,
}

/// A mode: the axis along which it moves, and its strain at the Gauss points.
struct Mode {
    along: usize,
    strain: [Sym; POINTS],
}

/// Condensation at a given ν: `Q`, `ζ` and the coefficients of `θ`.
struct Follow {
    rows: [[f64; STRAIN_COMPONENTS]; MODES],
    relief: f64,
    volume: [f64; STRAIN_COMPONENTS],
}

/// The amplitudes `q` with their derivatives by the voxel's coordinates.
struct Amplitudes<'a> {
    table: &'a Table,
    follow: &'a Follow,
    strains: &'a GeneralizedStrains,
    value: [f64; MODES],
    slope: [[f64; STRAIN_COMPONENTS]; MODES],
    /// `y`, if it is part of them.
    relief: Option<&'a StrainFunction>,
}

impl ClampModes {
    fn table(self) -> &'static Table {
        static TABLES: [OnceLock<Table>; 3 << 8] = [const { OnceLock::new() }; 3 << 8];
        let place = across(self.axis)
            .iter()
            .flat_map(|&(n, _)| [self.free[n], self.pressed[n]])
            .flatten()
            .fold(self.axis, |bits, has| 2 * bits + usize::from(has));
        TABLES[place].get_or_init(|| self.tabulate())
    }

    fn tabulate(self) -> Table {
        let modes = self.modes();
        let count = modes.len();
        let mean = |a: &dyn Fn(usize) -> Sym, b: &dyn Fn(usize) -> Sym| {
            let each = |g| deviators(&a(g), &b(g));
            (0..POINTS).map(each).sum::<f64>() / POINTS as f64
        };
        let volume: Vec<f64> = modes
            .iter()
            .map(|mode| mode.strain.iter().map(trace).sum::<f64>() / POINTS as f64)
            .collect();
        let strain = |thinning: f64, place: usize| move |g: usize| strain_at(g, thinning, place);
        let mut system: Vec<Vec<f64>> = modes
            .iter()
            .map(|mode| {
                let own = |g: usize| mode.strain[g];
                let with = modes.iter().map(|other| mean(&own, &|g| other.strain[g]));
                let plain = (0..STRAIN_COMPONENTS).map(|k| mean(&own, &strain(0.0, k)));
                let whole = (0..STRAIN_COMPONENTS).map(|k| mean(&own, &strain(1.0, k)));
                with.chain(plain).chain(whole).collect()
            })
            .collect();
        for (row, volume) in system.iter_mut().zip(&volume) {
            row.push(*volume);
        }
        eliminate(&mut system);
        let part = |row: &Vec<f64>, start: usize| std::array::from_fn(|k| row[start + k]);
        let plain: Vec<[f64; STRAIN_COMPONENTS]> =
            system.iter().map(|row| part(row, count)).collect();
        let thinned = system.iter().zip(&plain).map(|(row, plain)| {
            let whole: [f64; STRAIN_COMPONENTS] = part(row, count + STRAIN_COMPONENTS);
            std::array::from_fn(|k| whole[k] - plain[k])
        });
        let spread: Vec<f64> = system
            .iter()
            .map(|row| row[count + 2 * STRAIN_COMPONENTS])
            .collect();
        Table {
            thinned: thinned.collect(),
            yielding: volume.iter().zip(&spread).map(|(b, r)| b * r).sum(),
            plain,
            spread,
            volume,
            modes,
        }
    }

    /// The modes of all free faces; several faces share some.
    fn modes(self) -> Vec<Mode> {
        let mut modes = Vec::new();
        for (along, other) in across(self.axis) {
            // Functions of the two coordinates across, in the basis 1, ξ along, ξ of the other, and their product.
            let mut found: Vec<[f64; 4]> = Vec::new();
            for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
                if self.free[along][side] && !self.pressed[along][side] {
                    found.push([0.5, 0.5 * sign, 0.0, 0.0]);
                    found.push([0.0, 0.0, 0.5, 0.5 * sign]);
                }
                if self.free[other][side] {
                    found.push([0.5, 0.0, 0.5 * sign, 0.0]);
                }
            }
            let independent = independent(found);
            modes.extend(independent.iter().map(|f| self.mode(along, other, f)));
        }
        modes
    }

    /// The mode `(1 − ξ_c²) f`, moving along an axis.
    fn mode(self, along: usize, other: usize, f: &[f64; 4]) -> Mode {
        let strain = std::array::from_fn(|g| {
            let at = gauss_point(g);
            let (x, y, z) = (at[along], at[other], at[self.axis]);
            let bubble = 1.0 - z * z;
            let mut gradient = [0.0; 3];
            gradient[along] = bubble * (f[1] + f[3] * y);
            gradient[other] = bubble * (f[2] + f[3] * x);
            gradient[self.axis] = -2.0 * z * (f[0] + f[1] * x + f[2] * y + f[3] * x * y);
            let mut strain = [0.0; 6];
            strain[along] = gradient[along];
            for axis in [other, self.axis] {
                strain[OFF + 3 - along - axis] = gradient[axis] / SQRT_2;
            }
            strain
        });
        Mode { along, strain }
    }
}

fn gauss_point(g: usize) -> [f64; 3] {
    let place = 1.0 / f64::sqrt(3.0);
    std::array::from_fn(|axis| if g >> axis & 1 == 1 { place } else { -place })
}

fn trace(a: &Sym) -> f64 {
    a[0] + a[1] + a[2]
}

/// The scalar product of two deviators.
fn deviators(a: &Sym, b: &Sym) -> f64 {
    dot(a, b) - trace(a) * trace(b) / 3.0
}

fn dot(a: &Sym, b: &Sym) -> f64 {
    (0..6).map(|k| a[k] * b[k]).sum()
}

/// The small strain at a Gauss point due to one of the voxel's coordinates.
fn strain_at(g: usize, thinning: f64, place: usize) -> Sym {
    let mut strain = [0.0; 6];
    if place < 6 {
        strain[place] = 1.0;
        return strain;
    }
    let at = gauss_point(g);
    let (mode, axis) = ((place - 6) / 3, (place - 6) % 3);
    for (n, i, j) in AXES {
        if (mode, axis) == (j, i) || (mode, axis) == (i, j) {
            strain[axis] += at[n];
            strain[n] -= thinning * at[n];
        } else if mode == axis && mode != n {
            strain[OFF + n] += at[n] / SQRT_2;
        }
    }
    strain
}

/// Keeps the functions that are linearly independent of the ones before them.
fn independent(functions: Vec<[f64; 4]>) -> Vec<[f64; 4]> {
    let dot = |a: &[f64; 4], b: &[f64; 4]| (0..4).map(|k| a[k] * b[k]).sum::<f64>();
    let (mut kept, mut basis) = (Vec::new(), Vec::<[f64; 4]>::new());
    for function in functions {
        let mut rest = function;
        for own in &basis {
            let part = dot(&rest, own) / dot(own, own);
            rest = std::array::from_fn(|k| rest[k] - part * own[k]);
        }
        // The remainder of entries of one half is a simple fraction of them, or rounding.
        if dot(&rest, &rest) > 1e-9 {
            basis.push(rest);
            kept.push(function);
        }
    }
    kept
}

/// Solves a positive definite system by elimination: the columns beyond the square become the solutions.
fn eliminate(system: &mut [Vec<f64>]) {
    for pivot in 0..system.len() {
        let scale = 1.0 / system[pivot][pivot];
        system[pivot].iter_mut().for_each(|x| *x *= scale);
        let row = system[pivot].clone();
        for (index, other) in system.iter_mut().enumerate() {
            if index != pivot {
                let part = other[pivot];
                for (x, own) in other.iter_mut().zip(&row) {
                    *x -= part * own;
                }
            }
        }
    }
}

impl Table {
    fn follow(&self, thinning: f64) -> Follow {
        // k = (1 + 2κ)/3(1 − κ) with κ = ν/(1 − ν).
        let stiff = 1.0 + 2.0 * thinning;
        let relief = stiff / (3.0 * (1.0 - thinning) + stiff * self.yielding);
        let mut rows = [[0.0; STRAIN_COMPONENTS]; MODES];
        for ((row, plain), thinned) in rows.iter_mut().zip(&self.plain).zip(&self.thinned) {
            *row = std::array::from_fn(|k| -(plain[k] + thinning * thinned[k]));
        }
        let missing = self.volume_of(&rows);
        for (row, spread) in rows.iter_mut().zip(&self.spread) {
            for k in 0..STRAIN_COMPONENTS {
                row[k] -= relief * spread * missing[k];
            }
        }
        Follow {
            volume: self.volume_of(&rows),
            rows,
            relief,
        }
    }

    /// `cᵀ + bᵀQ`.
    fn volume_of(&self, rows: &[[f64; STRAIN_COMPONENTS]; MODES]) -> [f64; STRAIN_COMPONENTS] {
        std::array::from_fn(|k| {
            let own = if k < 3 { 1.0 } else { 0.0 };
            let theirs = rows.iter().zip(&self.volume);
            own + theirs.map(|(row, b)| b * row[k]).sum::<f64>()
        })
    }
}

/// Relief of volume at which `g` levels off.
const MOST_RELIEF: f64 = 0.5;

/// `g` with two derivatives.
fn levelling(x: f64) -> [f64; 3] {
    let part = x / MOST_RELIEF;
    let root = 1.0 + part.powi(4);
    let first = root.powf(-1.25);
    [
        x * root.powf(-0.25),
        first,
        -5.0 * part.powi(3) * first / root / MOST_RELIEF,
    ]
}

impl<'a> Amplitudes<'a> {
    fn of(
        table: &'a Table,
        follow: &'a Follow,
        strains: &'a GeneralizedStrains,
        relief: Option<&'a StrainFunction>,
    ) -> Self {
        let (mut value, mut slope) = ([0.0; MODES], [[0.0; STRAIN_COMPONENTS]; MODES]);
        for m in 0..table.modes.len() {
            let row = &follow.rows[m];
            (value[m], slope[m]) = strains.faded(row);
            if let Some(relief) = relief {
                value[m] += table.spread[m] * relief.value;
                for (sum, own) in slope[m].iter_mut().zip(&relief.gradient) {
                    *sum += table.spread[m] * own;
                }
            }
        }
        Self {
            table,
            follow,
            strains,
            value,
            slope,
            relief,
        }
    }

    /// The strain of all modes at a Gauss point, and its derivatives (rows) by the coordinates.
    fn strain(&self, state: &Rotated, g: usize) -> (Sym, [Sym; STRAIN_COMPONENTS]) {
        let (mut strain, mut slopes) = ([0.0; 6], [[0.0; 6]; STRAIN_COMPONENTS]);
        for (m, mode) in self.table.modes.iter().enumerate() {
            let scale = state.stretch[mode.along];
            for (k, &own) in mode.strain[g].iter().enumerate() {
                if own == 0.0 {
                    continue;
                }
                strain[k] += scale * self.value[m] * own;
                slopes[mode.along][k] += self.value[m] * own;
                for (row, slope) in slopes.iter_mut().zip(&self.slope[m]) {
                    row[k] += scale * slope * own;
                }
            }
        }
        (strain, slopes)
    }

    /// Adds the second derivatives of the strains of the modes, each times its `force`.
    fn add_curvature(
        &self,
        state: &Rotated,
        force: &[f64; MODES],
        hessian: &mut [[f64; STRAIN_COMPONENTS]; STRAIN_COMPONENTS],
    ) {
        // Forces on the `d`, and on `y`.
        let (mut pull, mut press) = ([0.0; STRAIN_COMPONENTS], 0.0);
        for (m, mode) in self.table.modes.iter().enumerate() {
            let scaled = force[m] * state.stretch[mode.along];
            press += scaled * self.table.spread[m];
            for k in 0..STRAIN_COMPONENTS {
                let both = force[m] * self.slope[m][k];
                hessian[mode.along][k] += both;
                hessian[k][mode.along] += both;
                pull[k] += scaled * self.follow.rows[m][k];
            }
        }
        self.strains.add_faded_curvatures(&pull, hessian);
        if let Some(relief) = self.relief {
            let own = relief.hessian.as_flattened();
            for (sum, own) in hessian.as_flattened_mut().iter_mut().zip(own) {
                *sum += press * own;
            }
        }
    }
}

impl Rotated {
    /// [`Rotated::mean`] for the stretches at a clamp; `second` asks for the Hessian, with its geometric part weighed
    /// by that factor.
    pub(crate) fn clamped_mean(
        &self,
        clamped: ClampModes,
        thinning: f64,
        second: Option<f64>,
        function: impl Fn(&Sym) -> Response,
    ) -> StrainFunction {
        let table = clamped.table();
        let (follow, strains) = (table.follow(thinning), GeneralizedStrains::of(self));
        let plain = Amplitudes::of(table, &follow, &strains, None);
        let relief = self.relief(&plain, thinning, second.is_some()).1;
        let amplitudes = Amplitudes::of(table, &follow, &strains, Some(&relief));
        self.mean_with(&amplitudes, thinning, second, function)
    }

    /// `J`, with its Hessian if `second`.
    pub(crate) fn clamped_volume(
        &self,
        clamped: ClampModes,
        thinning: f64,
        second: bool,
    ) -> StrainFunction {
        let table = clamped.table();
        let (follow, strains) = (table.follow(thinning), GeneralizedStrains::of(self));
        let plain = Amplitudes::of(table, &follow, &strains, None);
        let (mut volume, relief) = self.relief(&plain, thinning, second);
        let beta = table.yielding;
        volume.value += beta * relief.value;
        for (row, own) in volume.gradient.iter_mut().zip(&relief.gradient) {
            *row += beta * own;
        }
        let own = relief.hessian.as_flattened();
        for (sum, own) in volume.hessian.as_flattened_mut().iter_mut().zip(own) {
            *sum += beta * own;
        }
        volume
    }

    /// `J₁` and `y`.
    fn relief(
        &self,
        plain: &Amplitudes<'_>,
        thinning: f64,
        second: bool,
    ) -> (StrainFunction, StrainFunction) {
        let volume = self.mean_with(plain, thinning, second.then_some(1.0), |at| {
            determinant_response(at, second)
        });
        // θ: the part of the voxel's own strains, and that of the `q`.
        let strains = plain.strains;
        let own: [f64; STRAIN_COMPONENTS] = std::array::from_fn(|k| if k < 3 { -1.0 } else { 0.0 });
        let theirs = std::array::from_fn(|k| -plain.follow.volume[k] - own[k]);
        let (faded, slopes) = strains.faded(&theirs);
        let by_own = strains.slopes(&own);
        let left: [f64; STRAIN_COMPONENTS] =
            std::array::from_fn(|k| volume.gradient[k] + by_own[k] + slopes[k]);
        let rest = volume.value - 1.0 + dot_all(&own, &strains.values()) + faded;
        let [value, slope, turn] = levelling(rest).map(|x| -plain.follow.relief * x);
        let mut relief = StrainFunction::zero();
        relief.value = value;
        relief.gradient = left.map(|x| slope * x);
        if second {
            relief.hessian = volume.hessian;
            strains.add_curvatures(&own, &mut relief.hessian);
            strains.add_faded_curvatures(&theirs, &mut relief.hessian);
            for (row, own) in relief.hessian.iter_mut().zip(&left) {
                for (entry, other) in row.iter_mut().zip(&left) {
                    *entry = slope * *entry + turn * own * other;
                }
            }
        }
        strains.fade(&mut relief, second);
        (volume, relief)
    }

    fn mean_with(
        &self,
        amplitudes: &Amplitudes<'_>,
        thinning: f64,
        second: Option<f64>,
        function: impl Fn(&Sym) -> Response,
    ) -> StrainFunction {
        let variations = AXES.map(|axes| self.variation(axes, thinning));
        let bent: [_; 3] = std::array::from_fn(|n| variations[n].slopes(AXES[n], thinning));
        let weight = 1.0 / POINTS as f64;
        let mut mean = StrainFunction::zero();
        let (mut moments, mut force) = ([[0.0; 6]; 3], [0.0; MODES]);
        for g in 0..POINTS {
            let at = gauss_point(g);
            let (mut stretch, mut slopes) = amplitudes.strain(self, g);
            for k in 0..6 {
                stretch[k] += self.stretch[k];
                slopes[k][k] += 1.0;
                for n in 0..3 {
                    stretch[k] += at[n] * variations[n].h[k];
                }
            }
            for n in 0..3 {
                for (place, direction) in &bent[n] {
                    for k in 0..6 {
                        slopes[*place][k] += at[n] * direction[k];
                    }
                }
            }
            let response = function(&stretch);
            mean.value += weight * response.value;
            let stress = response.stress.map(|x| weight * x);
            for (sum, slope) in mean.gradient.iter_mut().zip(&slopes) {
                *sum += dot(slope, &stress);
            }
            if second.is_none() {
                continue;
            }
            for n in 0..3 {
                for k in 0..6 {
                    moments[n][k] += at[n] * stress[k];
                }
            }
            for (sum, mode) in force.iter_mut().zip(&amplitudes.table.modes) {
                *sum += dot(&mode.strain[g], &stress);
            }
            for column in 0..STRAIN_COMPONENTS {
                let turned: Sym =
                    std::array::from_fn(|k| weight * dot(&response.tangent[k], &slopes[column]));
                for row in 0..=column {
                    mean.hessian[row][column] += dot(&slopes[row], &turned);
                }
            }
        }
        if let Some(curvature) = second {
            for column in 0..STRAIN_COMPONENTS {
                for row in 0..column {
                    mean.hessian[column][row] = mean.hessian[row][column];
                }
            }
            for n in 0..3 {
                let (variation, hessian) = (&variations[n], &mut mean.hessian);
                variation.add_curvature(AXES[n], thinning, moments[n][n], hessian);
            }
            let force = force.map(|f| curvature * f);
            amplitudes.add_curvature(self, &force, &mut mean.hessian);
        }
        mean
    }

    /// The smallest volume ratio among the Gauss points.
    pub(crate) fn smallest_clamped_volume(&self, clamped: ClampModes, thinning: f64) -> f64 {
        let smallest = std::cell::Cell::new(f64::INFINITY);
        self.clamped_mean(clamped, thinning, None, |at| {
            let response = determinant_response(at, false);
            smallest.set(smallest.get().min(response.value));
            response
        });
        smallest.get()
    }
}
