//! A number in each SIMD lane, with operators, so that formulas read as they stand on paper.

use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use pulp::Simd;

/// The most lanes that any processor has.
pub(super) const MOST_LANES: usize = 8;

/// A number in each lane.
#[derive(Clone, Copy)]
pub(super) struct Number<S: Simd> {
    simd: S,
    lanes: S::f64s,
}

/// Vectors of three, symmetric tensors (see [`crate::hyperelastic::symmetric::Sym`]) and matrices in each lane.
pub(super) type Three<S> = [Number<S>; 3];
pub(super) type Six<S> = [Number<S>; 6];
pub(super) type Nine<S> = [[Number<S>; 3]; 3];

impl<S: Simd> Number<S> {
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self {
            simd,
            lanes: simd.splat_f64s(value),
        }
    }

    #[inline(always)]
    pub fn load(simd: S, values: &[f64; MOST_LANES]) -> Self {
        Self {
            simd,
            lanes: simd.partial_load_f64s(&values[..S::F64_LANES]),
        }
    }

    #[inline(always)]
    pub fn store(self, values: &mut [f64; MOST_LANES]) {
        self.simd
            .partial_store_f64s(&mut values[..S::F64_LANES], self.lanes);
    }

    /// Broadcasts a number to all lanes.
    #[inline(always)]
    pub fn all(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }

    /// `self a + b`, fused where the processor can.
    #[inline(always)]
    pub fn times_plus(self, a: Self, b: Self) -> Self {
        Self {
            simd: self.simd,
            lanes: self.simd.mul_add_e_f64s(self.lanes, a.lanes, b.lanes),
        }
    }

    #[inline(always)]
    pub fn inverse(self) -> Self {
        let one = self.simd.splat_f64s(1.0);
        Self {
            simd: self.simd,
            lanes: self.simd.div_f64s(one, self.lanes),
        }
    }

    #[inline(always)]
    pub fn root(self) -> Self {
        Self {
            simd: self.simd,
            lanes: self.simd.sqrt_f64s(self.lanes),
        }
    }

    /// Natural logarithm, lane by lane: processors have none.
    #[inline(always)]
    pub fn logarithm(self) -> Self {
        let mut lanes = [1.0; MOST_LANES];
        self.store(&mut lanes);
        Self::load(self.simd, &lanes.map(f64::ln))
    }

    #[inline(always)]
    pub fn least(self, other: Self) -> Self {
        Self {
            simd: self.simd,
            lanes: self.simd.min_f64s(self.lanes, other.lanes),
        }
    }
}

impl<S: Simd> Add for Number<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            simd: self.simd,
            lanes: self.simd.add_f64s(self.lanes, other.lanes),
        }
    }
}

impl<S: Simd> Sub for Number<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            simd: self.simd,
            lanes: self.simd.sub_f64s(self.lanes, other.lanes),
        }
    }
}

impl<S: Simd> Mul for Number<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            simd: self.simd,
            lanes: self.simd.mul_f64s(self.lanes, other.lanes),
        }
    }
}

impl<S: Simd> Mul<f64> for Number<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self * self.all(other)
    }
}

impl<S: Simd> Add<f64> for Number<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: f64) -> Self {
        self + self.all(other)
    }
}

impl<S: Simd> Neg for Number<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            simd: self.simd,
            lanes: self.simd.neg_f64s(self.lanes),
        }
    }
}

impl<S: Simd> AddAssign for Number<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> SubAssign for Number<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// `Σ a b`.
#[inline(always)]
pub(super) fn dot<S: Simd, const K: usize>(a: &[Number<S>; K], b: &[Number<S>; K]) -> Number<S> {
    let mut sum = a[0] * b[0];
    for k in 1..K {
        sum = a[k].times_plus(b[k], sum);
    }
    sum
}

/// `A B`.
#[inline(always)]
pub(super) fn multiply<S: Simd>(a: &Nine<S>, b: &Nine<S>) -> Nine<S> {
    let mut product = *a;
    for i in 0..3 {
        for j in 0..3 {
            product[i][j] =
                a[i][2].times_plus(b[2][j], a[i][1].times_plus(b[1][j], a[i][0] * b[0][j]));
        }
    }
    product
}

/// `A x`.
#[inline(always)]
pub(super) fn apply<S: Simd>(a: &Nine<S>, x: &Three<S>) -> Three<S> {
    [dot(&a[0], x), dot(&a[1], x), dot(&a[2], x)]
}

/// `Aᵀ x`.
#[inline(always)]
pub(super) fn apply_transposed<S: Simd>(a: &Nine<S>, x: &Three<S>) -> Three<S> {
    let mut image = *x;
    for i in 0..3 {
        image[i] = a[2][i].times_plus(x[2], a[1][i].times_plus(x[1], a[0][i] * x[0]));
    }
    image
}

/// `a × b`.
#[inline(always)]
pub(super) fn cross<S: Simd>(a: &Three<S>, b: &Three<S>) -> Three<S> {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `[a]× B`.
#[inline(always)]
pub(super) fn cross_columns<S: Simd>(a: &Three<S>, b: &Nine<S>) -> Nine<S> {
    let mut product = *b;
    for k in 0..3 {
        let column = cross(a, &[b[0][k], b[1][k], b[2][k]]);
        for i in 0..3 {
            product[i][k] = column[i];
        }
    }
    product
}

/// The matrix of cofactors.
#[inline(always)]
pub(super) fn cofactors<S: Simd>(a: &Nine<S>) -> Nine<S> {
    let first = cross(&a[1], &a[2]);
    let second = cross(&a[2], &a[0]);
    let third = cross(&a[0], &a[1]);
    [first, second, third]
}

/// The vector `v` with `[v]× = A − Aᵀ`.
#[inline(always)]
pub(super) fn axial<S: Simd>(a: &Nine<S>) -> Three<S> {
    [a[2][1] - a[1][2], a[0][2] - a[2][0], a[1][0] - a[0][1]]
}

/// A symmetric tensor as a matrix.
#[inline(always)]
pub(super) fn to_matrix<S: Simd>(s: &Six<S>) -> Nine<S> {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let (yz, xz, xy) = (s[3] * half, s[4] * half, s[5] * half);
    [[s[0], xy, xz], [xy, s[1], yz], [xz, yz, s[2]]]
}

/// The symmetric part of a matrix as a vector.
#[inline(always)]
pub(super) fn to_sym<S: Simd>(a: &Nine<S>) -> Six<S> {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    [
        a[0][0],
        a[1][1],
        a[2][2],
        (a[1][2] + a[2][1]) * half,
        (a[0][2] + a[2][0]) * half,
        (a[0][1] + a[1][0]) * half,
    ]
}
