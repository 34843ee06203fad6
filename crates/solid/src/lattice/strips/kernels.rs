//! Forces, row sums and stiffness products, strip by strip.

use std::ops::Range;

use pulp::{Simd, WithSimd};

use super::{Columns, Kind, Strip, Strips, slabs};
use crate::lattice::lanes::{Lanes, Spans, Volumes};

/// Pointers shared by threads: the slabs that run at the same time touch different slots and places.
#[derive(Clone, Copy)]
pub(super) struct Shared<T>(pub T);

// SAFETY: `slabs::run` never runs two slabs at a time that share a slot, and no two strips share a place.
unsafe impl<T> Send for Shared<T> {}
unsafe impl<T> Sync for Shared<T> {}

/// Operation on a constraint in each lane, the first one being number `n` of the strip.
pub(super) trait Kernel: Copy {
    /// # Safety
    ///
    /// The slots of all corners and the places of the strip from `n` on, as many as there are lanes, exist
    /// and no one else uses them.
    unsafe fn edges<S: Simd>(self, lanes: Lanes<S>, strip: &Strip, length: f64, n: usize);

    /// # Safety
    ///
    /// The conditions of [`Kernel::edges`] hold.
    unsafe fn tets<S: Simd>(self, lanes: Lanes<S>, strip: &Strip, volume: f64, n: usize);
}

struct OnStrips<'a, K>(&'a [Strip], K);

impl<K: Kernel> WithSimd for OnStrips<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let lanes = Lanes(simd);
        for strip in self.0 {
            let count = strip.count as usize;
            let mut n = 0;
            // SAFETY: strips are padded to a multiple of any number of lanes, which `Strips::check` has
            // seen to fit; callers of `Strips::run` bring arrays of the right lengths.
            match strip.kind {
                Kind::Edge(length) => {
                    while n < count {
                        unsafe { self.1.edges(lanes, strip, length, n) };
                        n += Lanes::<S>::COUNT;
                    }
                }
                Kind::Tet(volume) => {
                    while n < count {
                        unsafe { self.1.tets(lanes, strip, volume, n) };
                        n += Lanes::<S>::COUNT;
                    }
                }
            }
        }
    }
}

impl Strip {
    /// The slots of the corners of constraint `n`.
    #[inline(always)]
    pub(super) fn slots(&self, n: usize) -> [usize; 4] {
        [
            self.corners[0] as usize + n,
            self.corners[1] as usize + n,
            self.corners[2] as usize + n,
            self.corners[3] as usize + n,
        ]
    }
}

impl Strips {
    /// Runs a kernel on all strips.
    ///
    /// # Safety
    ///
    /// The pointers of the kernel lead to arrays of [`Strips::slots`] and [`Strips::places`] numbers, and nothing else
    /// accesses the arrays that it writes.
    pub(super) unsafe fn run<K: Kernel>(&self, kernel: K) {
        let kernel = Shared(kernel);
        let task = |range: Range<usize>| {
            let Shared(kernel) = { &kernel };
            self.arch.dispatch(OnStrips(&self.strips[range], *kernel));
        };
        slabs::run(self, task);
    }

    pub(super) fn check_slots(&self, columns: &[&Columns]) {
        for axis in columns.iter().flat_map(|c| &c.axes) {
            assert_eq!(axis.len(), self.slots, "columns of another body");
        }
    }

    pub(super) fn check_places(&self, multipliers: &[f64]) {
        assert_eq!(
            multipliers.len(),
            self.places(),
            "multipliers of another body"
        );
    }

    /// Adds the elastic forces in N, as [`crate::elastic::add_forces`] does.
    pub fn add_forces(&self, positions: &Columns, forces: &mut Columns) {
        self.check_slots(&[positions, forces]);
        let kernel = Forces::<false> {
            positions: positions.pointers(),
            forces: forces.pointers_mut(),
            stiffness: self.stiffness.as_ptr(),
            multipliers: std::ptr::null_mut(),
        };
        // SAFETY: lengths were checked, and the forces are borrowed alone.
        unsafe { self.run(kernel) }
    }

    /// Adds the elastic forces in N and writes the multipliers that give them: `λ = −C/α`, in N and Pa.
    pub fn add_forces_keeping(
        &self,
        positions: &Columns,
        forces: &mut Columns,
        multipliers: &mut [f64],
    ) {
        self.check_slots(&[positions, forces]);
        self.check_places(multipliers);
        let kernel = Forces::<true> {
            positions: positions.pointers(),
            forces: forces.pointers_mut(),
            stiffness: self.stiffness.as_ptr(),
            multipliers: multipliers.as_mut_ptr(),
        };
        // SAFETY: lengths were checked, and the outputs are borrowed exclusively.
        unsafe { self.run(kernel) }
    }

    /// Adds to `sums`, slot by slot, the bounds on row sums of the stiffness matrix (N/m) of
    /// [`crate::elastic::row_sums`].
    pub fn add_row_sums(&self, positions: &Columns, sums: &mut [f64]) {
        self.check_slots(&[positions]);
        assert_eq!(sums.len(), self.slots, "sums of another body");
        let kernel = RowSums {
            positions: positions.pointers(),
            sums: sums.as_mut_ptr(),
            stiffness: self.stiffness.as_ptr(),
        };
        // SAFETY: lengths were checked, and the sums are borrowed alone.
        unsafe { self.run(kernel) }
    }

    /// Adds the product of the material part of the stiffness matrix with `direction`, as
    /// [`crate::elastic::add_stiffness_product`] does.
    pub fn add_stiffness_product(
        &self,
        positions: &Columns,
        direction: &Columns,
        product: &mut Columns,
    ) {
        self.check_slots(&[positions, direction, product]);
        let kernel = Product {
            positions: positions.pointers(),
            direction: direction.pointers(),
            product: product.pointers_mut(),
            stiffness: self.stiffness.as_ptr(),
        };
        // SAFETY: lengths were checked, and the product is borrowed alone.
        unsafe { self.run(kernel) }
    }
}

impl<S: Simd> Volumes<S> {
    /// The tetrahedra of a strip from number `n` on.
    ///
    /// # Safety
    ///
    /// The conditions of [`Kernel::edges`] hold.
    #[inline(always)]
    pub(super) unsafe fn new(
        lanes: Lanes<S>,
        from: [*const f64; 3],
        strip: &Strip,
        n: usize,
    ) -> Self {
        let slots = strip.slots(n);
        let corners = unsafe {
            [
                lanes.load3(from, slots[0]),
                lanes.load3(from, slots[1]),
                lanes.load3(from, slots[2]),
                lanes.load3(from, slots[3]),
            ]
        };
        Self::of(lanes, corners)
    }
}

impl<S: Simd> Spans<S> {
    /// The edges of a strip from number `n` on.
    ///
    /// # Safety
    ///
    /// The conditions of [`Kernel::edges`] hold.
    #[inline(always)]
    pub(super) unsafe fn new(
        lanes: Lanes<S>,
        from: [*const f64; 3],
        strip: &Strip,
        n: usize,
    ) -> Self {
        let slots = strip.slots(n);
        let ends = unsafe { [lanes.load3(from, slots[0]), lanes.load3(from, slots[1])] };
        Self::of(lanes, ends)
    }
}

#[derive(Clone, Copy)]
struct Forces<const KEEP: bool> {
    positions: [*const f64; 3],
    forces: [*mut f64; 3],
    stiffness: *const f64,
    multipliers: *mut f64,
}

impl<const KEEP: bool> Kernel for Forces<KEEP> {
    #[inline(always)]
    unsafe fn edges<S: Simd>(self, lanes: Lanes<S>, strip: &Strip, length: f64, n: usize) {
        unsafe {
            let place = strip.first as usize + n;
            let stiffness = lanes.load(self.stiffness.add(place));
            let span = Spans::new(lanes, self.positions, strip, n);
            let now = lanes.sqrt(span.square);
            let stretch = lanes.minus(now, lanes.splat(length));
            let multiplier = lanes.neg(lanes.mul(stiffness, stretch));
            if KEEP {
                lanes.store(self.multipliers.add(place), multiplier);
            }
            let pull = lanes.div(multiplier, now);
            let [a, b, ..] = strip.slots(n);
            lanes.accumulate(self.forces, a, pull, span.along);
            lanes.accumulate(self.forces, b, lanes.neg(pull), span.along);
        }
    }

    #[inline(always)]
    unsafe fn tets<S: Simd>(self, lanes: Lanes<S>, strip: &Strip, volume: f64, n: usize) {
        unsafe {
            let place = strip.first as usize + n;
            let stiffness = lanes.load(self.stiffness.add(place));
            let now = Volumes::new(lanes, self.positions, strip, n);
            let sixth = lanes.splat(1.0 / 6.0);
            // λ = k (V₀ − V)
            let missing = lanes.fnma(sixth, now.six_volumes, lanes.splat(volume));
            let multiplier = lanes.mul(stiffness, missing);
            if KEEP {
                lanes.store(self.multipliers.add(place), multiplier);
            }
            let push = lanes.mul(sixth, multiplier);
            let slots = strip.slots(n);
            for corner in 0..4 {
                lanes.accumulate(self.forces, slots[corner], push, now.gradients[corner]);
            }
        }
    }
}

#[derive(Clone, Copy)]
struct RowSums {
    positions: [*const f64; 3],
    sums: *mut f64,
    stiffness: *const f64,
}

impl RowSums {
    #[inline(always)]
    unsafe fn add<S: Simd>(self, lanes: Lanes<S>, slot: usize, value: S::f64s) {
        unsafe {
            let place = self.sums.add(slot);
            lanes.store(place, lanes.add(lanes.load(place), value));
        }
    }
}

impl Kernel for RowSums {
    #[inline(always)]
    unsafe fn edges<S: Simd>(self, lanes: Lanes<S>, strip: &Strip, _length: f64, n: usize) {
        unsafe {
            let stiffness = lanes.load(self.stiffness.add(strip.first as usize + n));
            let twice = lanes.add(stiffness, stiffness);
            let [a, b, ..] = strip.slots(n);
            self.add(lanes, a, twice);
            self.add(lanes, b, twice);
        }
    }

    #[inline(always)]
    unsafe fn tets<S: Simd>(self, lanes: Lanes<S>, strip: &Strip, _volume: f64, n: usize) {
        unsafe {
            let stiffness = lanes.load(self.stiffness.add(strip.first as usize + n));
            let now = Volumes::new(lanes, self.positions, strip, n);
            let mut lengths = [lanes.splat(0.0); 4];
            let mut total = lanes.splat(0.0);
            for corner in 0..4 {
                let gradient = now.gradients[corner];
                lengths[corner] = lanes.sqrt(lanes.dot(gradient, gradient));
                total = lanes.add(total, lengths[corner]);
            }
            let scale = lanes.mul(lanes.mul(lanes.splat(1.0 / 36.0), stiffness), total);
            let slots = strip.slots(n);
            for corner in 0..4 {
                self.add(lanes, slots[corner], lanes.mul(scale, lengths[corner]));
            }
        }
    }
}

#[derive(Clone, Copy)]
struct Product {
    positions: [*const f64; 3],
    direction: [*const f64; 3],
    product: [*mut f64; 3],
    stiffness: *const f64,
}

impl Kernel for Product {
    #[inline(always)]
    unsafe fn edges<S: Simd>(self, lanes: Lanes<S>, strip: &Strip, _length: f64, n: usize) {
        unsafe {
            let stiffness = lanes.load(self.stiffness.add(strip.first as usize + n));
            let span = Spans::new(lanes, self.positions, strip, n);
            let [a, b, ..] = strip.slots(n);
            let moved = lanes.sub(
                lanes.load3(self.direction, a),
                lanes.load3(self.direction, b),
            );
            let change = lanes.dot(span.along, moved);
            let force = lanes.div(lanes.mul(stiffness, change), span.square);
            lanes.accumulate(self.product, a, force, span.along);
            lanes.accumulate(self.product, b, lanes.neg(force), span.along);
        }
    }

    #[inline(always)]
    unsafe fn tets<S: Simd>(self, lanes: Lanes<S>, strip: &Strip, _volume: f64, n: usize) {
        unsafe {
            let stiffness = lanes.load(self.stiffness.add(strip.first as usize + n));
            let now = Volumes::new(lanes, self.positions, strip, n);
            let mut change = lanes.splat(0.0);
            let slots = strip.slots(n);
            for corner in 0..4 {
                let moved = lanes.load3(self.direction, slots[corner]);
                change = lanes.add(change, lanes.dot(now.gradients[corner], moved));
            }
            let force = lanes.mul(lanes.mul(lanes.splat(1.0 / 36.0), stiffness), change);
            for corner in 0..4 {
                lanes.accumulate(self.product, slots[corner], force, now.gradients[corner]);
            }
        }
    }
}
