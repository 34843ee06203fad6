//! Vectors of three in several lanes at once.
//!
//! Everything here and in the kernels is inlined by force and free of closures: what is not part of the
//! one function that the processor was chosen for is compiled for the oldest processor, and calls of it
//! would take ten times as long.

use pulp::Simd;

/// A vector in each lane.
pub(super) type Wide<S> = [<S as Simd>::f64s; 3];

/// The operations of the kernels on a given processor.
#[derive(Clone, Copy)]
pub(super) struct Lanes<S: Simd>(pub S);

impl<S: Simd> Lanes<S> {
    pub const COUNT: usize = S::F64_LANES;

    #[inline(always)]
    pub fn splat(self, value: f64) -> S::f64s {
        self.0.splat_f64s(value)
    }

    /// # Safety
    ///
    /// `from` and the numbers after it, as many as there are lanes, can be read.
    #[inline(always)]
    pub unsafe fn load(self, from: *const f64) -> S::f64s {
        unsafe { from.cast::<S::f64s>().read_unaligned() }
    }

    /// # Safety
    ///
    /// `to` and the numbers after it, as many as there are lanes, can be written.
    #[inline(always)]
    pub unsafe fn store(self, to: *mut f64, value: S::f64s) {
        unsafe { to.cast::<S::f64s>().write_unaligned(value) }
    }

    /// # Safety
    ///
    /// As [`Lanes::load`] for each axis from `at` on.
    #[inline(always)]
    pub unsafe fn load3(self, from: [*const f64; 3], at: usize) -> Wide<S> {
        unsafe {
            [
                self.load(from[0].add(at)),
                self.load(from[1].add(at)),
                self.load(from[2].add(at)),
            ]
        }
    }

    /// Adds `factor · value` to what is stored.
    ///
    /// # Safety
    ///
    /// As [`Lanes::load`] and [`Lanes::store`] for each axis from `at` on.
    #[inline(always)]
    pub unsafe fn accumulate(self, to: [*mut f64; 3], at: usize, factor: S::f64s, value: Wide<S>) {
        for axis in 0..3 {
            unsafe {
                let place = to[axis].add(at);
                self.store(place, self.fma(factor, value[axis], self.load(place)));
            }
        }
    }

    #[inline(always)]
    pub fn add(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.add_f64s(a, b)
    }

    #[inline(always)]
    pub fn minus(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.sub_f64s(a, b)
    }

    #[inline(always)]
    pub fn mul(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.mul_f64s(a, b)
    }

    #[inline(always)]
    pub fn div(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.div_f64s(a, b)
    }

    #[inline(always)]
    pub fn sqrt(self, a: S::f64s) -> S::f64s {
        self.0.sqrt_f64s(a)
    }

    #[inline(always)]
    pub fn max(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.max_f64s(a, b)
    }

    #[inline(always)]
    pub fn neg(self, a: S::f64s) -> S::f64s {
        self.0.neg_f64s(a)
    }

    /// `a b + c`, fused where the processor can.
    #[inline(always)]
    pub fn fma(self, a: S::f64s, b: S::f64s, c: S::f64s) -> S::f64s {
        self.0.mul_add_e_f64s(a, b, c)
    }

    /// `c − a b`, fused where the processor can.
    #[inline(always)]
    pub fn fnma(self, a: S::f64s, b: S::f64s, c: S::f64s) -> S::f64s {
        self.0.negate_mul_add_e_f64s(a, b, c)
    }

    #[inline(always)]
    pub fn sub(self, a: Wide<S>, b: Wide<S>) -> Wide<S> {
        [
            self.minus(a[0], b[0]),
            self.minus(a[1], b[1]),
            self.minus(a[2], b[2]),
        ]
    }

    #[inline(always)]
    pub fn dot(self, a: Wide<S>, b: Wide<S>) -> S::f64s {
        self.fma(a[2], b[2], self.fma(a[1], b[1], self.mul(a[0], b[0])))
    }

    #[inline(always)]
    pub fn cross(self, a: Wide<S>, b: Wide<S>) -> Wide<S> {
        [
            self.fnma(a[2], b[1], self.mul(a[1], b[2])),
            self.fnma(a[0], b[2], self.mul(a[2], b[0])),
            self.fnma(a[1], b[0], self.mul(a[0], b[1])),
        ]
    }

    /// `−(a + b + c)`.
    #[inline(always)]
    pub fn minus_sum(self, a: Wide<S>, b: Wide<S>, c: Wide<S>) -> Wide<S> {
        [
            self.minus(self.neg(a[0]), self.add(b[0], c[0])),
            self.minus(self.neg(a[1]), self.add(b[1], c[1])),
            self.minus(self.neg(a[2]), self.add(b[2], c[2])),
        ]
    }
}
