//! Several voxels at once, one in each SIMD lane: energies, forces, stiffness and carried strains.
//!
//! The formulas are those of [`crate::element::hex8`], whose scalar code is the reference and handles the rare cases:
//! materials without a form in invariants, softening, fibers, voxels at clamps ([`crate::element::clamp_modes`]),
//! voxels that are inside out, pressed flat or blown up tenfold. Groups follow the list of voxels, whatever the number
//! of threads. As in [`crate::lattice::lanes`] everything is inlined by force into the one function that the processor
//! was chosen for.

mod energy;
mod frame;
mod number;
mod spread;
#[cfg(test)]
mod tests;

use pulp::{Arch, Simd, WithSimd};

use crate::element::coordinates::STRAIN_COMPONENTS;
use crate::element::hex8::{Hex8, Hex8AssumedStrain, Hex8Matrix, Hex8Strain, Pressure};
use crate::hyperelastic::HyperelasticMaterial;
use crate::vector::Vec3;
use energy::{Row, Shape, Square, Volume, add_deviatoric};
use frame::{Constants, Frame, Spin, has_lanes};
use number::{
    MOST_LANES, Number, apply_transposed, axial, cross, cross_columns, dot, to_matrix, to_sym,
};
use spread::{ENTRIES, times};

/// Voxels that share one call: a multiple of the lanes of any processor.
pub(crate) const TOGETHER: usize = 8;

/// Voxels that are evaluated together, with their positions.
#[derive(Clone, Copy)]
pub(crate) struct Together<'a> {
    pub hex8s: &'a [Hex8],
    pub materials: &'a [HyperelasticMaterial],
    pub positions: &'a [Vec3],
    /// Strain and pressure of each voxel as unknowns of their own.
    pub carried: Option<&'a [Hex8AssumedStrain]>,
}

impl<'a> Together<'a> {
    fn material(&self, hex8: &Hex8) -> &'a HyperelasticMaterial {
        &self.materials[hex8.material as usize]
    }

    fn has_lanes(&self, hex8: &Hex8) -> bool {
        hex8.warping.clamped.is_none()
            && !hex8.warping.has_edges()
            && has_lanes(self.material(hex8))
    }

    /// Sets the stiffness matrix of each voxel, see [`Hex8::stiffness`].
    pub fn stiffness(self, out: &mut [Hex8Matrix]) {
        Arch::new().dispatch(Run(self, Stiffness(out)));
    }

    /// Sets the forces on the corners of each voxel, see [`Hex8::forces`] and [`Hex8::predicted_forces`].
    pub fn forces(self, out: &mut [[Vec3; 8]]) {
        Arch::new().dispatch(Run(self, Forces(out)));
    }

    /// Sets the elastic energy of each voxel in J, see [`Hex8::energy`].
    pub fn energies(self, out: &mut [f64]) {
        Arch::new().dispatch(Run(self, Energies(out)));
    }

    /// Sets the carried strain and pressure of each voxel after a step `moves`, see [`Hex8::update`].
    pub fn update(self, moves: &[Vec3], out: &mut [Hex8AssumedStrain]) {
        Arch::new().dispatch(Run(self, Carry(moves, out)));
    }
}

/// A quantity that is computed for a group of voxels.
trait Question {
    /// Computes it in the lanes of a group whose first voxel is `first`; `sound` becomes positive in lanes that are
    /// valid.
    fn in_lanes<S: Simd>(
        &mut self,
        group: &Group<'_, S>,
        first: usize,
        count: usize,
        sound: &mut [f64; MOST_LANES],
    );

    /// Computes it for one voxel with the scalar code.
    fn plainly(&mut self, together: &Together<'_>, index: usize);
}

/// The voxels of one pass, one in each lane.
struct Group<'a, S: Simd> {
    simd: S,
    together: &'a Together<'a>,
    hex8s: [&'a Hex8; MOST_LANES],
    constants: Constants<S>,
    frame: Frame<S>,
}

struct Run<'a, Q>(Together<'a>, Q);

impl<Q: Question> WithSimd for Run<'_, Q> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(together, mut question) = self;
        let hex8s = together.hex8s;
        for first in (0..hex8s.len()).step_by(S::F64_LANES) {
            let count = S::F64_LANES.min(hex8s.len() - first);
            let mut sound = [0.0; MOST_LANES];
            let own = &hex8s[first..first + count];
            if own.iter().any(|hex8| together.has_lanes(hex8)) {
                // The last group repeats its last voxel.
                let mut lanes = [&own[count - 1]; MOST_LANES];
                for (lane, hex8) in lanes.iter_mut().zip(own) {
                    *lane = hex8;
                }
                let constants = Constants::of(simd, &lanes, together.materials);
                let modes = constants.modes(simd, &lanes, together.positions);
                let group = Group {
                    simd,
                    together: &together,
                    hex8s: lanes,
                    constants,
                    frame: Frame::of(&modes),
                };
                question.in_lanes(&group, first, count, &mut sound);
            }
            for lane in 0..count {
                let right = sound[lane] > 0.0 && together.has_lanes(&own[lane]);
                if !right {
                    question.plainly(&together, first + lane);
                }
            }
        }
    }
}

impl<S: Simd> Group<'_, S> {
    /// The strain at which the stress is evaluated, and the shift of its pressure.
    #[inline(always)]
    fn strain(&self, first: usize, count: usize) -> (Shape<S>, Number<S>) {
        let zero = Number::splat(self.simd, 0.0);
        let Some(carried) = self.together.carried else {
            let shape = Shape {
                stretch: self.frame.stretch,
                hourglass: self.frame.hourglass,
            };
            return (shape, zero);
        };
        let mut lanes = [[0.0; MOST_LANES]; STRAIN_COMPONENTS + 1];
        for lane in 0..S::F64_LANES {
            let state = &carried[first + lane.min(count - 1)];
            let row = state.strain.row();
            for k in 0..STRAIN_COMPONENTS {
                lanes[k][lane] = row[k];
            }
            lanes[STRAIN_COMPONENTS][lane] = state.pressure.shift;
        }
        let mut row = [zero; STRAIN_COMPONENTS];
        for k in 0..STRAIN_COMPONENTS {
            row[k] = Number::load(self.simd, &lanes[k]);
        }
        (
            Shape::of_row(&row),
            Number::load(self.simd, &lanes[STRAIN_COMPONENTS]),
        )
    }

    /// The gradient without that of the mean change of volume, the volume ratio, and the Hessian at a shift of the
    /// pressure.
    #[inline(always)]
    fn moduli(
        &self,
        shape: &Shape<S>,
        shift: Number<S>,
        hessian: &mut Square<S>,
        sound: &mut Number<S>,
    ) -> (Row<S>, Volume<S>, Number<S>) {
        let constants = &self.constants;
        let volume = Volume::of(constants, shape);
        let pressure = constants.bulk * (volume.value + shift + -1.0);
        let mut gradient = [Number::splat(self.simd, 0.0); STRAIN_COMPONENTS];
        add_deviatoric(constants, shape, &mut gradient, Some(hessian), sound);
        Volume::add_hessian(constants, shape, pressure, hessian);
        for k in 0..STRAIN_COMPONENTS {
            let slope = constants.bulk * volume.gradient[k];
            for l in 0..STRAIN_COMPONENTS {
                hessian[k][l] = slope.times_plus(volume.gradient[l], hessian[k][l]);
            }
        }
        (gradient, volume, pressure)
    }
}

/// Adds `factor` times a row.
#[inline(always)]
fn add_scaled<S: Simd>(sum: &mut Row<S>, factor: Number<S>, row: &Row<S>) {
    for k in 0..STRAIN_COMPONENTS {
        sum[k] = factor.times_plus(row[k], sum[k]);
    }
}

struct Stiffness<'a>(&'a mut [Hex8Matrix]);

impl Question for Stiffness<'_> {
    #[inline(always)]
    fn in_lanes<S: Simd>(
        &mut self,
        group: &Group<'_, S>,
        first: usize,
        count: usize,
        right: &mut [f64; MOST_LANES],
    ) {
        let mut sound = group.frame.sound;
        let (shape, shift) = group.strain(first, count);
        let mut hessian = [[Number::splat(group.simd, 0.0); STRAIN_COMPONENTS]; STRAIN_COMPONENTS];
        let (mut gradient, volume, pressure) =
            group.moduli(&shape, shift, &mut hessian, &mut sound);
        add_scaled(&mut gradient, pressure, &volume.gradient);
        let mut entries = [[0.0; MOST_LANES]; ENTRIES];
        spread::stiffness(
            &group.constants,
            &group.frame,
            &gradient,
            &hessian,
            &mut sound,
            &mut entries,
        );
        for lane in 0..count {
            let matrix = self.0[first + lane].as_flattened_mut();
            for (entry, lanes) in matrix.iter_mut().zip(&entries) {
                *entry = lanes[lane];
            }
        }
        sound.store(right);
    }

    #[inline(never)]
    fn plainly(&mut self, together: &Together<'_>, index: usize) {
        let hex8 = &together.hex8s[index];
        let carried = together.carried.map(|states| &states[index]);
        self.0[index] = hex8.stiffness(together.material(hex8), together.positions, carried);
    }
}

struct Forces<'a>(&'a mut [[Vec3; 8]]);

impl Question for Forces<'_> {
    #[inline(always)]
    fn in_lanes<S: Simd>(
        &mut self,
        group: &Group<'_, S>,
        first: usize,
        count: usize,
        right: &mut [f64; MOST_LANES],
    ) {
        let mut sound = group.frame.sound;
        let constants = &group.constants;
        let zero = Number::splat(group.simd, 0.0);
        let (shape, shift) = group.strain(first, count);
        let gradient = if group.together.carried.is_some() {
            let mut hessian = [[zero; STRAIN_COMPONENTS]; STRAIN_COMPONENTS];
            let (mut gradient, volume, _) = group.moduli(&shape, shift, &mut hessian, &mut sound);
            let pressure = constants.bulk * (volume.value + -1.0);
            add_scaled(&mut gradient, pressure, &volume.gradient);
            let now = Shape {
                stretch: group.frame.stretch,
                hourglass: group.frame.hourglass,
            };
            let (now, then) = (now.row(), shape.row());
            let mut change = now;
            for k in 0..STRAIN_COMPONENTS {
                change[k] = now[k] - then[k];
            }
            let response = times(&hessian, &change);
            add_scaled(&mut gradient, zero.all(1.0), &response);
            gradient
        } else {
            let volume = Volume::of(constants, &shape);
            let mut gradient = [zero; STRAIN_COMPONENTS];
            add_deviatoric(constants, &shape, &mut gradient, None, &mut sound);
            let pressure = constants.bulk * (volume.value + -1.0);
            add_scaled(&mut gradient, pressure, &volume.gradient);
            gradient
        };
        let mut entries = [[0.0; MOST_LANES]; 24];
        spread::forces(constants, &group.frame, &gradient, &mut sound, &mut entries);
        for lane in 0..count {
            let corners = self.0[first + lane].as_flattened_mut();
            for (entry, lanes) in corners.iter_mut().zip(&entries) {
                *entry = lanes[lane];
            }
        }
        sound.store(right);
    }

    #[inline(never)]
    fn plainly(&mut self, together: &Together<'_>, index: usize) {
        let hex8 = &together.hex8s[index];
        let (material, positions) = (together.material(hex8), together.positions);
        self.0[index] = match together.carried {
            Some(states) => hex8.predicted_forces(material, &states[index], positions),
            None => hex8.forces(material, positions),
        };
    }
}

struct Energies<'a>(&'a mut [f64]);

impl Question for Energies<'_> {
    #[inline(always)]
    fn in_lanes<S: Simd>(
        &mut self,
        group: &Group<'_, S>,
        first: usize,
        count: usize,
        right: &mut [f64; MOST_LANES],
    ) {
        let Group {
            constants, frame, ..
        } = group;
        let mut sound = frame.sound;
        let (shape, _) = group.strain(first, count);
        let change = Volume::of(constants, &shape).value + -1.0;
        let mut gradient = [Number::splat(group.simd, 0.0); STRAIN_COMPONENTS];
        let mut energy = add_deviatoric(constants, &shape, &mut gradient, None, &mut sound);
        energy += constants.bulk * change * change * 0.5;
        energy += constants.young * dot(&frame.bilinear, &frame.bilinear) * (1.0 / 18.0);
        let mut lanes = [0.0; MOST_LANES];
        (energy * constants.volume).store(&mut lanes);
        self.0[first..first + count].copy_from_slice(&lanes[..count]);
        sound.store(right);
    }

    #[inline(never)]
    fn plainly(&mut self, together: &Together<'_>, index: usize) {
        let hex8 = &together.hex8s[index];
        self.0[index] = hex8.energy(together.material(hex8), together.positions);
    }
}

struct Carry<'a>(&'a [Vec3], &'a mut [Hex8AssumedStrain]);

impl Question for Carry<'_> {
    #[inline(always)]
    fn in_lanes<S: Simd>(
        &mut self,
        group: &Group<'_, S>,
        first: usize,
        count: usize,
        right: &mut [f64; MOST_LANES],
    ) {
        let Group {
            constants, frame, ..
        } = group;
        let mut sound = frame.sound;
        let zero = Number::splat(group.simd, 0.0);
        let (from, _) = group.strain(first, count);
        let stretch = to_matrix(&frame.stretch);
        let spin = Spin::of(&stretch, &mut sound);
        let direction = constants.modes(group.simd, &group.hex8s, self.0);
        let mut b = [[zero; 3]; 3];
        for k in 0..3 {
            let column = apply_transposed(&frame.rotation, &direction[k]);
            for i in 0..3 {
                b[i][k] = column[i];
            }
        }
        let w = spin.solve(&axial(&b));
        let turned = cross_columns(&w, &stretch);
        for i in 0..3 {
            for k in 0..3 {
                b[i][k] -= turned[i][k];
            }
        }
        let change = to_sym(&b);
        let mut to = Shape {
            stretch: frame.stretch,
            hourglass: frame.hourglass,
        };
        for k in 0..6 {
            to.stretch[k] += change[k];
        }
        for m in 0..3 {
            let own = apply_transposed(&frame.rotation, &direction[3 + m]);
            let turned = cross(&w, &frame.hourglass[m]);
            for k in 0..3 {
                to.hourglass[m][k] += own[k] - turned[k];
            }
        }
        for axis in 0..3 {
            sound = sound
                .least(from.stretch[axis] + -energy::LEAST_STRETCH)
                .least(to.stretch[axis] + -energy::LEAST_STRETCH);
        }
        let (start, end) = (Volume::of(constants, &from), Volume::of(constants, &to));
        let (old, new) = (from.row(), to.row());
        let mut step = new;
        for k in 0..STRAIN_COMPONENTS {
            step[k] = new[k] - old[k];
        }
        let shift = start.value + dot(&start.gradient, &step) - end.value;
        let mut lanes = [[0.0; MOST_LANES]; STRAIN_COMPONENTS + 1];
        for k in 0..STRAIN_COMPONENTS {
            new[k].store(&mut lanes[k]);
        }
        shift.store(&mut lanes[STRAIN_COMPONENTS]);
        for lane in 0..count {
            let mut strain = Hex8Strain {
                stretch: [0.0; 6],
                hourglass: [[0.0; 3]; 3],
            };
            for k in 0..6 {
                strain.stretch[k] = lanes[k][lane];
            }
            for (k, entry) in strain.hourglass.as_flattened_mut().iter_mut().enumerate() {
                *entry = lanes[6 + k][lane];
            }
            self.1[first + lane] = Hex8AssumedStrain {
                strain,
                pressure: Pressure {
                    shift: lanes[STRAIN_COMPONENTS][lane],
                    ..Pressure::of(group.together.material(group.hex8s[lane]))
                },
            };
        }
        sound.store(right);
    }

    #[inline(never)]
    fn plainly(&mut self, together: &Together<'_>, index: usize) {
        let hex8 = &together.hex8s[index];
        let before = together.carried.map(|states| &states[index]);
        let material = together.material(hex8);
        self.1[index] = hex8.update(material, before, together.positions, self.0);
    }
}
