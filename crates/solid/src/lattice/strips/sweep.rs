//! One Gauss–Seidel pass of extended position-based dynamics over all constraints.

use pulp::Simd;

use super::kernels::Kernel;
use super::{Columns, Strip, Strips};
use crate::lattice::lanes::{Lanes, Spans, Volumes, Wide};

/// Data of a sweep.
///
/// Each constraint in turn takes
/// `Δλ = −(k (C + τ/h ∇C·Δx) + λ) / (k (1 + τ/h) h² ∇C·M⁻¹∇C + 1)` and `Δx = h² M⁻¹ ∇C Δλ`, with the
/// stiffness `k`, which is one over the compliance: zero stiffness moves nothing.
#[derive(Debug)]
pub struct Sweep<'a> {
    /// Positions in m, which are changed.
    pub positions: &'a mut Columns,
    /// Positions in m at the start of the substep.
    pub start: &'a Columns,
    /// One over the mass (1/kg) for each axis, zero where it is held.
    pub inverse_masses: &'a Columns,
    /// Set if the inverse masses are the same for all axes: the first is then taken for all.
    pub isotropic: bool,
    /// Multipliers in N and Pa.
    pub multipliers: &'a mut [f64],
    /// Set if multipliers are written back, for a later sweep.
    pub keep: bool,
    /// Length of the substep `h` in s.
    pub substep: f64,
    /// Retardation time `τ` in s.
    pub retardation: f64,
}

impl Strips {
    /// Sweeps over all constraints in the order of [`Strips::order`].
    pub fn sweep(&self, sweep: Sweep<'_>) {
        self.check_slots(&[sweep.positions, sweep.start, sweep.inverse_masses]);
        self.check_places(sweep.multipliers);
        match (sweep.isotropic, sweep.retardation > 0.0) {
            (true, false) => self.project::<true, false>(sweep),
            (true, true) => self.project::<true, true>(sweep),
            (false, false) => self.project::<false, false>(sweep),
            (false, true) => self.project::<false, true>(sweep),
        }
    }

    fn project<const ISOTROPIC: bool, const LAG: bool>(&self, sweep: Sweep<'_>) {
        let lag = sweep.retardation / sweep.substep;
        let kernel = Projection::<ISOTROPIC, LAG> {
            positions: sweep.positions.pointers_mut(),
            start: sweep.start.pointers(),
            inverse_masses: sweep.inverse_masses.pointers(),
            stiffness: self.stiffness.as_ptr(),
            multipliers: sweep.multipliers.as_mut_ptr(),
            keep: sweep.keep,
            square: sweep.substep * sweep.substep,
            lag,
        };
        // SAFETY: `sweep` has checked the lengths, and the outputs are borrowed exclusively.
        unsafe { self.run(kernel) }
    }
}

#[derive(Clone, Copy)]
struct Projection<const ISOTROPIC: bool, const LAG: bool> {
    positions: [*mut f64; 3],
    start: [*const f64; 3],
    inverse_masses: [*const f64; 3],
    stiffness: *const f64,
    multipliers: *mut f64,
    keep: bool,
    /// The square of the substep in s².
    square: f64,
    /// The retardation time over the substep.
    lag: f64,
}

impl<const ISOTROPIC: bool, const LAG: bool> Projection<ISOTROPIC, LAG> {
    #[inline(always)]
    fn now(self) -> [*const f64; 3] {
        [self.positions[0], self.positions[1], self.positions[2]]
    }

    /// # Safety
    ///
    /// The conditions of [`Kernel::edges`] hold.
    #[inline(always)]
    unsafe fn weights<S: Simd>(self, lanes: Lanes<S>, slot: usize) -> Wide<S> {
        unsafe {
            if ISOTROPIC {
                [lanes.load(self.inverse_masses[0].add(slot)); 3]
            } else {
                lanes.load3(self.inverse_masses, slot)
            }
        }
    }

    /// `∇C·M⁻¹∇C` of one vertex, added to `sum`.
    #[inline(always)]
    fn inertia<S: Simd>(
        self,
        lanes: Lanes<S>,
        weights: Wide<S>,
        gradient: Wide<S>,
        sum: S::f64s,
    ) -> S::f64s {
        if ISOTROPIC {
            return lanes.fma(weights[0], lanes.dot(gradient, gradient), sum);
        }
        let mut sum = sum;
        for axis in 0..3 {
            sum = lanes.fma(
                lanes.mul(weights[axis], gradient[axis]),
                gradient[axis],
                sum,
            );
        }
        sum
    }

    /// Moves vertices by `factor M⁻¹∇C`.
    ///
    /// # Safety
    ///
    /// The conditions of [`Kernel::edges`] hold.
    #[inline(always)]
    unsafe fn push<S: Simd>(
        self,
        lanes: Lanes<S>,
        slot: usize,
        position: Wide<S>,
        factor: S::f64s,
        weights: Wide<S>,
        gradient: Wide<S>,
    ) {
        for axis in 0..3 {
            let along = lanes.mul(factor, weights[axis]);
            let moved = lanes.fma(along, gradient[axis], position[axis]);
            unsafe { lanes.store(self.positions[axis].add(slot), moved) }
        }
    }
}

impl<const ISOTROPIC: bool, const LAG: bool> Kernel for Projection<ISOTROPIC, LAG> {
    #[inline(always)]
    unsafe fn edges<S: Simd>(self, lanes: Lanes<S>, strip: &Strip, length: f64, n: usize) {
        unsafe {
            let place = strip.first as usize + n;
            let stiffness = lanes.load(self.stiffness.add(place));
            let multiplier = lanes.load(self.multipliers.add(place));
            let span = Spans::new(lanes, self.now(), strip, n);
            let slots = strip.slots(n);
            let weights = [self.weights(lanes, slots[0]), self.weights(lanes, slots[1])];
            let now = lanes.sqrt(span.square);
            let mut answer = lanes.minus(now, lanes.splat(length));
            if LAG {
                let a = lanes.sub(span.ends[0], lanes.load3(self.start, slots[0]));
                let b = lanes.sub(span.ends[1], lanes.load3(self.start, slots[1]));
                let rate = lanes.dot(span.along, lanes.sub(a, b));
                let rate = lanes.mul(lanes.splat(self.lag), lanes.div(rate, now));
                answer = lanes.add(answer, rate);
            }
            let pull = lanes.fma(stiffness, answer, multiplier);
            // With the direction `along/length`: Δλ/length = −pull length / (k h² along·M⁻¹along + length²),
            // which takes one division.
            let mut both = weights[0];
            for axis in 0..3 {
                both[axis] = lanes.add(both[axis], weights[1][axis]);
            }
            let inertia = if ISOTROPIC {
                lanes.mul(both[0], span.square)
            } else {
                self.inertia(lanes, both, span.along, lanes.splat(0.0))
            };
            let square = lanes.splat(self.square * (1.0 + self.lag));
            let below = lanes.fma(lanes.mul(stiffness, square), inertia, span.square);
            let change = lanes.neg(lanes.div(lanes.mul(pull, now), below));
            if self.keep {
                let multiplier = lanes.fma(change, now, multiplier);
                lanes.store(self.multipliers.add(place), multiplier);
            }
            let factor = lanes.mul(lanes.splat(self.square), change);
            self.push(
                lanes,
                slots[0],
                span.ends[0],
                factor,
                weights[0],
                span.along,
            );
            let factor = lanes.neg(factor);
            self.push(
                lanes,
                slots[1],
                span.ends[1],
                factor,
                weights[1],
                span.along,
            );
        }
    }

    #[inline(always)]
    unsafe fn tets<S: Simd>(self, lanes: Lanes<S>, strip: &Strip, volume: f64, n: usize) {
        unsafe {
            let place = strip.first as usize + n;
            let stiffness = lanes.load(self.stiffness.add(place));
            let multiplier = lanes.load(self.multipliers.add(place));
            let now = Volumes::new(lanes, self.now(), strip, n);
            let slots = strip.slots(n);
            let weights = [
                self.weights(lanes, slots[0]),
                self.weights(lanes, slots[1]),
                self.weights(lanes, slots[2]),
                self.weights(lanes, slots[3]),
            ];
            let mut inertia = lanes.splat(0.0);
            for corner in 0..4 {
                inertia = self.inertia(lanes, weights[corner], now.gradients[corner], inertia);
            }
            let sixth = lanes.splat(1.0 / 6.0);
            let mut answer = lanes.fma(sixth, now.six_volumes, lanes.splat(-volume));
            if LAG {
                let mut rate = lanes.splat(0.0);
                for corner in 0..4 {
                    let start = lanes.load3(self.start, slots[corner]);
                    let moved = lanes.sub(now.corners[corner], start);
                    rate = lanes.add(rate, lanes.dot(now.gradients[corner], moved));
                }
                answer = lanes.fma(lanes.splat(self.lag / 6.0), rate, answer);
            }
            let push = lanes.fma(stiffness, answer, multiplier);
            let square = lanes.splat(self.square * (1.0 + self.lag) / 36.0);
            let below = lanes.fma(lanes.mul(stiffness, square), inertia, lanes.splat(1.0));
            let change = lanes.neg(lanes.div(push, below));
            if self.keep {
                lanes.store(self.multipliers.add(place), lanes.add(multiplier, change));
            }
            let factor = lanes.mul(lanes.splat(self.square / 6.0), change);
            for corner in 0..4 {
                let (position, gradient) = (now.corners[corner], now.gradients[corner]);
                self.push(
                    lanes,
                    slots[corner],
                    position,
                    factor,
                    weights[corner],
                    gradient,
                );
            }
        }
    }
}
