//! Vertex updates of a step, axis by axis on columns, with SIMD dispatch at run time.

use pulp::{Simd, WithSimd};
use voxsoft_solid::lattice::strips::Columns;

/// Number of parallel partial sums: the order of a sum does not depend on the processor. Columns are padded to a
/// multiple.
const STRANDS: usize = 8;

/// Runs a loop of plain arithmetic with the SIMD instructions found at run time.
fn dispatch<Op: WithSimd>(op: Op) -> Op::Output {
    pulp::Arch::new().dispatch(op)
}

/// Estimates the frequency of the present motion on columns, see [`crate::damping::frequency`].
pub(crate) fn frequency(
    velocities: &Columns,
    before: &Columns,
    now: &Columns,
    masses: &[f64],
    time_step: f64,
) -> f64 {
    let (mut stiffness, mut inertia) = (0.0, 0.0);
    let columns = velocities
        .axes()
        .into_iter()
        .zip(before.axes())
        .zip(now.axes());
    for ((velocity, before), now) in columns {
        let sums = stiffness_and_inertia(velocity, before, now, masses);
        stiffness += sums.0;
        inertia += sums.1;
    }
    if inertia > 0.0 {
        (stiffness / (time_step * inertia)).max(0.0).sqrt()
    } else {
        0.0
    }
}

/// Kinetic energy.
pub(crate) fn kinetic_energy(velocities: &Columns, masses: &[f64]) -> f64 {
    let twice = velocities
        .axes()
        .into_iter()
        .map(|v| stiffness_and_inertia(v, v, v, masses).1);
    twice.sum::<f64>() / 2.0
}

/// Sets `out` to `factor · (a − b)`.
pub(crate) fn difference(a: &Columns, b: &Columns, factor: f64, out: &mut Columns) {
    for ((out, a), b) in out.axes_mut().into_iter().zip(a.axes()).zip(b.axes()) {
        dispatch(Difference { a, b, factor, out });
    }
}

struct Difference<'a> {
    a: &'a [f64],
    b: &'a [f64],
    factor: f64,
    out: &'a mut [f64],
}

impl WithSimd for Difference<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for ((out, a), b) in self.out.iter_mut().zip(self.a).zip(self.b) {
            *out = self.factor * (a - b);
        }
    }
}

/// Sums `v·(f_before − f_now)` and `v·M v` for one axis.
fn stiffness_and_inertia(
    velocity: &[f64],
    before: &[f64],
    now: &[f64],
    masses: &[f64],
) -> (f64, f64) {
    dispatch(Quotient {
        velocity,
        before,
        now,
        masses,
    })
}

struct Quotient<'a> {
    velocity: &'a [f64],
    before: &'a [f64],
    now: &'a [f64],
    masses: &'a [f64],
}

impl WithSimd for Quotient<'_> {
    type Output = (f64, f64);

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> (f64, f64) {
        let (mut stiffness, mut inertia) = ([0.0; STRANDS], [0.0; STRANDS]);
        let velocity = self.velocity.as_chunks::<STRANDS>().0;
        let before = self.before.as_chunks::<STRANDS>().0;
        let now = self.now.as_chunks::<STRANDS>().0;
        let masses = self.masses.as_chunks::<STRANDS>().0;
        for (((v, b), n), m) in velocity.iter().zip(before).zip(now).zip(masses) {
            for i in 0..STRANDS {
                stiffness[i] += v[i] * (b[i] - n[i]);
                inertia[i] += m[i] * v[i] * v[i];
            }
        }
        (stiffness.iter().sum(), inertia.iter().sum())
    }
}

/// Advances one axis: `v ← keep v + gain f/m` where it is free, zero where it is held, and
/// `x ← x + step v`.
pub(crate) struct Advance<'a> {
    pub position: &'a mut [f64],
    pub velocity: &'a mut [f64],
    pub force: &'a [f64],
    pub inverse_masses: &'a [f64],
    /// Bit mask: all bits set where the axis is free, none where it is held; it also clears a NaN velocity.
    pub free: &'a [u64],
    pub keep: f64,
    pub gain: f64,
    pub step: f64,
}

impl Advance<'_> {
    pub fn run(self) {
        dispatch(self);
    }
}

impl WithSimd for Advance<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let count = self.position.len();
        let (position, velocity) = (&mut self.position[..count], &mut self.velocity[..count]);
        let (force, inverse) = (&self.force[..count], &self.inverse_masses[..count]);
        let free = &self.free[..count];
        for i in 0..count {
            let change = self.gain * force[i] * inverse[i];
            let moved = self.keep * velocity[i] + change;
            velocity[i] = f64::from_bits(moved.to_bits() & free[i]);
            position[i] += self.step * velocity[i];
        }
    }
}
