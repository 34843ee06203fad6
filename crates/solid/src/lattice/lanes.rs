//! Vectors of three in several lanes at once, and edges and tetrahedra in them.
//!
//! The caller chooses the meaning of a lane: the next constraint along the grid ([`crate::lattice::strips`]), or the
//! same constraint of another body of the same mesh.
//!
//! Everything here and in the kernels is inlined by force and free of closures: code outside the one function that the
//! processor was chosen for is compiled for the oldest processor, and calls of it would take ten times as long.

use pulp::Simd;

/// A vector in each lane.
pub type Wide<S> = [<S as Simd>::f64s; 3];

/// The operations of the kernels on a given processor.
#[derive(Clone, Copy)]
pub struct Lanes<S: Simd>(pub S);

impl<S: Simd> Lanes<S> {
    /// The number of lanes.
    pub const COUNT: usize = S::F64_LANES;

    /// Broadcasts a number to all lanes.
    #[inline(always)]
    pub fn splat(self, value: f64) -> S::f64s {
        self.0.splat_f64s(value)
    }

    /// Loads the numbers from an address on.
    ///
    /// # Safety
    ///
    /// `from` and the numbers after it, as many as there are lanes, can be read.
    #[inline(always)]
    pub unsafe fn load(self, from: *const f64) -> S::f64s {
        unsafe { from.cast::<S::f64s>().read_unaligned() }
    }

    /// Stores the numbers from an address on.
    ///
    /// # Safety
    ///
    /// `to` and the numbers after it, as many as there are lanes, can be written.
    #[inline(always)]
    pub unsafe fn store(self, to: *mut f64, value: S::f64s) {
        unsafe { to.cast::<S::f64s>().write_unaligned(value) }
    }

    /// Loads the vectors whose coordinates stand from `at` on.
    ///
    /// # Safety
    ///
    /// The conditions of [`Lanes::load`] hold for each axis from `at` on.
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

    /// Adds `factor · value` to the stored values.
    ///
    /// # Safety
    ///
    /// The conditions of [`Lanes::load`] and [`Lanes::store`] hold for each axis from `at` on.
    #[inline(always)]
    pub unsafe fn accumulate(self, to: [*mut f64; 3], at: usize, factor: S::f64s, value: Wide<S>) {
        for axis in 0..3 {
            unsafe {
                let place = to[axis].add(at);
                self.store(place, self.fma(factor, value[axis], self.load(place)));
            }
        }
    }

    /// `a + b`.
    #[inline(always)]
    pub fn add(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.add_f64s(a, b)
    }

    /// `a − b`.
    #[inline(always)]
    pub fn minus(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.sub_f64s(a, b)
    }

    /// `a b`.
    #[inline(always)]
    pub fn mul(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.mul_f64s(a, b)
    }

    /// `a / b`.
    #[inline(always)]
    pub fn div(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.div_f64s(a, b)
    }

    /// The square root.
    #[inline(always)]
    pub fn sqrt(self, a: S::f64s) -> S::f64s {
        self.0.sqrt_f64s(a)
    }

    /// The larger one.
    #[inline(always)]
    pub fn max(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.max_f64s(a, b)
    }

    /// `−a`.
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

    /// `a − b`.
    #[inline(always)]
    pub fn sub(self, a: Wide<S>, b: Wide<S>) -> Wide<S> {
        [
            self.minus(a[0], b[0]),
            self.minus(a[1], b[1]),
            self.minus(a[2], b[2]),
        ]
    }

    /// The scalar product.
    #[inline(always)]
    pub fn dot(self, a: Wide<S>, b: Wide<S>) -> S::f64s {
        self.fma(a[2], b[2], self.fma(a[1], b[1], self.mul(a[0], b[0])))
    }

    /// The vector product.
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

    /// `a` where `condition` is above zero, else `b`.
    #[inline(always)]
    pub fn choose(self, condition: S::f64s, a: S::f64s, b: S::f64s) -> S::f64s {
        let mask = self.0.greater_than_f64s(condition, self.splat(0.0));
        self.0.select_f64s(mask, a, b)
    }
}

/// Squared length (m²) below which an edge has no direction: it keeps divisions finite where two vertices coincide, and
/// is far below the square of any length that rounding can separate from zero.
const NO_LENGTH: f64 = 1e-200;

/// Tetrahedra: the positions of their vertices, and six times the gradients of their volumes.
#[derive(Clone, Copy)]
pub struct Volumes<S: Simd> {
    /// The vertices in m.
    pub corners: [Wide<S>; 4],
    /// Six times the gradients by the vertices in m².
    pub gradients: [Wide<S>; 4],
    /// Six times the volumes in m³.
    pub six_volumes: S::f64s,
}

impl<S: Simd> Volumes<S> {
    /// Volumes and gradients of tetrahedra with these vertices.
    #[inline(always)]
    pub fn of(lanes: Lanes<S>, corners: [Wide<S>; 4]) -> Self {
        let [a, b, c, d] = corners;
        let (u, v, w) = (lanes.sub(b, a), lanes.sub(c, a), lanes.sub(d, a));
        let (by_b, by_c, by_d) = (lanes.cross(v, w), lanes.cross(w, u), lanes.cross(u, v));
        Self {
            corners,
            gradients: [lanes.minus_sum(by_b, by_c, by_d), by_b, by_c, by_d],
            six_volumes: lanes.dot(u, by_b),
        }
    }
}

/// Edges: the vectors from the second vertex to the first, and their squared lengths.
#[derive(Clone, Copy)]
pub struct Spans<S: Simd> {
    /// The vertices in m.
    pub ends: [Wide<S>; 2],
    /// Vector from the second end to the first in m.
    pub along: Wide<S>,
    /// The square of the length in m², never zero.
    pub square: S::f64s,
}

impl<S: Simd> Spans<S> {
    /// Vectors and squared lengths of edges with these ends.
    #[inline(always)]
    pub fn of(lanes: Lanes<S>, ends: [Wide<S>; 2]) -> Self {
        let along = lanes.sub(ends[0], ends[1]);
        let square = lanes.max(lanes.dot(along, along), lanes.splat(NO_LENGTH));
        Self {
            ends,
            along,
            square,
        }
    }
}
