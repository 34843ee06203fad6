//! Interval arithmetic in float64 that also bounds the error of an f32 evaluation.
//!
//! Over a block of cells each intermediate result v lies in [low, high], and an evaluation in f32
//! gives v' with |v' − v| ≤ error. The rules follow from f(a') − f(a) ≈ f'(ξ)(a' − a) plus one
//! rounding of relative size [`ROUNDING`]. Where a function jumps, or f32 overflows, the error is
//! infinite and the caller evaluates in float64 instead.
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::expr::{Binary, Unary};

/// Relative error of one f32 operation: half an ulp is 2⁻²⁴; library functions stay within two
/// ulps.
const ROUNDING: f64 = 1.2e-7;
/// Absolute floor, where f32 loses relative accuracy (subnormal numbers).
const SUBNORMAL: f64 = 1e-38;
/// Relative widening of library functions, whose float64 results need not be monotonic to the last
/// bit.
const SLACK: f64 = 1e-15;

/// Values of an expression over a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower bound of the values
    pub low: f64,
    /// Upper bound of the values
    pub high: f64,
    /// Bound on the error of an f32 evaluation
    pub error: f64,
}

impl Range {
    /// The unbounded range.
    pub const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
        error: f64::INFINITY,
    };

    /// Values within [low, high], stored in f32 with one rounding.
    pub fn new(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            error: 0.0,
        }
        .rounded()
    }

    /// True where nothing can be concluded.
    pub fn is_unknown(&self) -> bool {
        self.low.is_nan() || self.high.is_nan()
    }

    fn magnitude(&self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Adds the rounding of one f32 operation.
    fn rounded(self) -> Self {
        let magnitude = self.magnitude() + self.error;
        if magnitude >= f64::from(f32::MAX) || magnitude.is_nan() || self.error.is_nan() {
            return Self {
                error: f64::INFINITY,
                ..self
            };
        }
        Self {
            error: self.error + ROUNDING * magnitude + SUBNORMAL,
            ..self
        }
    }

    fn from(low: f64, high: f64, error: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::ALL;
        }
        Self { low, high, error }.rounded()
    }

    /// The range of a function of one value.
    pub fn unary(op: Unary, a: Self) -> Self {
        let (low, high, e) = (a.low, a.high, a.error);
        match op {
            Unary::Neg => Self {
                low: -high,
                high: -low,
                error: e,
            },
            Unary::Abs => {
                let least = if low <= 0.0 && high >= 0.0 {
                    0.0
                } else {
                    low.abs().min(high.abs())
                };
                Self {
                    low: least,
                    high: a.magnitude(),
                    error: e,
                }
            }
            Unary::Square => {
                let root = Self::unary(Unary::Abs, a);
                Self::from(
                    root.low * root.low,
                    root.high * root.high,
                    e * (2.0 * root.high + e),
                )
            }
            Unary::Sqrt => sqrt(a),
            Unary::Floor => {
                let steady = (low - e).floor() == (high + e).floor();
                let error = if steady { 0.0 } else { f64::INFINITY };
                Self::from(low.floor(), high.floor(), error)
            }
            Unary::Triangle => triangle(a),
            Unary::Sin => wave(low - FRAC_PI_2, high - FRAC_PI_2, f64::sin, low, high, e),
            Unary::Cos => wave(low, high, f64::cos, low, high, e),
            Unary::Tan => tan(a),
            Unary::Asin => inverse_sine(a, f64::asin(low), f64::asin(high)),
            Unary::Acos => inverse_sine(a, f64::acos(high), f64::acos(low)),
            Unary::Atan => widened(low.atan(), high.atan(), e),
            Unary::Exp => widened(low.exp(), high.exp(), (high + e).exp() * e),
            Unary::Log => {
                let error = if low > e {
                    e / (low - e)
                } else {
                    f64::INFINITY
                };
                if high < 0.0 {
                    Self::ALL
                } else {
                    widened(low.max(0.0).ln(), high.ln(), error)
                }
            }
        }
    }

    /// The range of a function of two values.
    pub fn binary(op: Binary, a: Self, b: Self) -> Self {
        let e = a.error + b.error;
        match op {
            Binary::Add => Self::from(a.low + b.low, a.high + b.high, e),
            Binary::Sub => Self::from(a.low - b.high, a.high - b.low, e),
            Binary::Mul => {
                let error = a.error * b.magnitude() + b.error * a.magnitude() + a.error * b.error;
                corners(a, b, |x, y| x * y, error)
            }
            Binary::Div => divide(a, b),
            // f32 intervals enclose f32 values, because rounding is monotonic, so pruning a branch
            // changes no value; library functions may be an ulp off, for which one rounding is
            // added.
            Binary::Min => Self::from(a.low.min(b.low), a.high.min(b.high), a.error.max(b.error)),
            Binary::Max => Self::from(a.low.max(b.low), a.high.max(b.high), a.error.max(b.error)),
            Binary::Hypot => hypot(a, b),
            Binary::Atan2 => atan2(a, b),
        }
    }
}

fn widened(low: f64, high: f64, error: f64) -> Range {
    let slack = SLACK * low.abs().max(high.abs());
    Range::from(low - slack, high + slack, error)
}

fn corners(a: Range, b: Range, f: impl Fn(f64, f64) -> f64, error: f64) -> Range {
    let values = [
        f(a.low, b.low),
        f(a.low, b.high),
        f(a.high, b.low),
        f(a.high, b.high),
    ];
    if values.iter().any(|v| v.is_nan()) {
        return Range::ALL;
    }
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Range::from(low, high, error)
}

/// Range of the length of (a, b), which changes by at most the length of the change.
fn hypot(a: Range, b: Range) -> Range {
    let (a, b) = (Range::unary(Unary::Abs, a), Range::unary(Unary::Abs, b));
    let (low, high) = (
        Binary::Hypot.apply(a.low, b.low),
        Binary::Hypot.apply(a.high, b.high),
    );
    // Three roundings: two squares, their sum, and half of that through the root; squares underflow
    // early.
    let error = a.error.hypot(b.error) + 2.0 * ROUNDING * high + SUBNORMAL.sqrt();
    Range::from(low, high, error)
}

/// √a' − √a = (a' − a)/(√a' + √a): at most e/√low, and at most √e near zero.
fn sqrt(a: Range) -> Range {
    if a.low < 0.0 || a.high < 0.0 {
        // Part of the block may be NaN: the cells are evaluated one by one.
        return Range::ALL;
    }
    let error = if a.low > a.error {
        (a.error / (a.low - a.error).sqrt()).min(a.error.sqrt())
    } else if a.low == 0.0 || a.error > 0.0 {
        a.error.sqrt() + if a.low > 0.0 { 0.0 } else { f64::MIN_POSITIVE }
    } else {
        0.0
    };
    Range::from(a.low.sqrt(), a.high.sqrt(), error)
}

fn triangle(a: Range) -> Range {
    if a.is_unknown() || a.high - a.low >= 1.0 {
        return Range::from(0.0, 0.5, a.error);
    }
    let (first, last) = (Unary::Triangle.apply(a.low), Unary::Triangle.apply(a.high));
    let (mut low, mut high) = (first.min(last), first.max(last));
    if a.low.ceil() <= a.high {
        low = 0.0; // an integer lies inside
    }
    if (a.low - 0.5).ceil() <= a.high - 0.5 {
        high = 0.5; // a half-integer lies inside
    }
    // f32 subtracts the integer from a rounded argument: one more rounding of the argument's size.
    Range::from(low, high, a.error + ROUNDING * a.magnitude())
}

/// Range of a sine or cosine: `from` and `to` are the ends as cosine arguments, so that maxima lie
/// at even and minima at odd multiples of π.
fn wave(from: f64, to: f64, f: fn(f64) -> f64, low: f64, high: f64, e: f64) -> Range {
    // Far from zero the phase itself is rounded; also where a bound is not a number.
    if from.is_nan() || to.is_nan() || to - from >= TAU || from.abs() > 1e6 {
        return Range::from(-1.0, 1.0, e);
    }
    let (first, last) = (f(low), f(high));
    let holds = |phase: f64| ((from - phase) / TAU).ceil() * TAU + phase <= to;
    let least = if holds(PI) {
        -1.0
    } else {
        first.min(last) - 1e-15
    };
    let most = if holds(0.0) {
        1.0
    } else {
        first.max(last) + 1e-15
    };
    Range::from(least, most, e)
}

fn tan(a: Range) -> Range {
    let branch = |angle: f64| ((angle + FRAC_PI_2) / PI).floor();
    if branch(a.low - a.error) != branch(a.high + a.error) || a.high - a.low >= PI {
        return Range::ALL;
    }
    let (low, high) = (a.low.tan(), a.high.tan());
    let steepest = low.abs().max(high.abs());
    // |tan'| = 1 + tan²; doubled because the error itself may lead to a steeper place.
    let error = 2.0 * (1.0 + steepest * steepest) * a.error;
    if error > 0.1 * (1.0 + steepest) {
        Range {
            error: f64::INFINITY,
            ..widened(low, high, 0.0)
        }
    } else {
        widened(low, high, error)
    }
}

fn inverse_sine(a: Range, low: f64, high: f64) -> Range {
    if a.magnitude() > 1.0 {
        return Range::ALL;
    }
    // Steepest at ±1, where asin behaves as √: |Δ| ≤ π/2 · √(2e) for any pair in [−1, 1].
    let room = 1.0 - a.magnitude() - a.error;
    let error = if room > 0.0 {
        a.error / (room * (2.0 - room)).sqrt()
    } else {
        f64::INFINITY // f32 may leave the domain and give NaN
    };
    widened(low, high, error)
}

fn divide(a: Range, b: Range) -> Range {
    if b.low <= 0.0 && b.high >= 0.0 {
        return Range::ALL;
    }
    let least = b.low.abs().min(b.high.abs());
    let error = if least > b.error {
        (a.error + b.error * a.magnitude() / least) / (least - b.error)
    } else {
        f64::INFINITY
    };
    corners(a, b, |x, y| x / y, error)
}

/// Range of the angle of the points (x, y) of a box.
///
/// Away from the origin the angle turns by at most Δ/r; on the negative x axis it jumps by 2π.
fn atan2(y: Range, x: Range) -> Range {
    if x.is_unknown() || y.is_unknown() {
        return Range::ALL;
    }
    let e = y.error + x.error;
    let touches_cut = x.low - e <= 0.0 && y.low - e <= 0.0 && y.high + e >= 0.0;
    if touches_cut {
        let slack = 1e-15;
        return Range {
            low: -PI - slack,
            high: PI + slack,
            error: f64::INFINITY,
        };
    }
    let gap = |r: &Range| {
        if r.low <= 0.0 && r.high >= 0.0 {
            0.0
        } else {
            r.low.abs().min(r.high.abs())
        }
    };
    let distance = gap(&x).hypot(gap(&y));
    let error = if distance > 2.0 * e {
        2.0 * e / distance
    } else {
        f64::INFINITY
    };
    let range = corners(y, x, f64::atan2, error);
    widened(range.low, range.high, range.error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const UNARY: [Unary; 14] = [
        Unary::Neg,
        Unary::Abs,
        Unary::Sqrt,
        Unary::Square,
        Unary::Floor,
        Unary::Triangle,
        Unary::Sin,
        Unary::Cos,
        Unary::Tan,
        Unary::Asin,
        Unary::Acos,
        Unary::Atan,
        Unary::Exp,
        Unary::Log,
    ];
    const BINARY: [Binary; 8] = [
        Binary::Hypot,
        Binary::Add,
        Binary::Sub,
        Binary::Mul,
        Binary::Div,
        Binary::Min,
        Binary::Max,
        Binary::Atan2,
    ];

    /// Applies a function in f32, as the compiled evaluation does.
    fn apply_f32(op: Unary, a: f32) -> f32 {
        match op {
            Unary::Neg => -a,
            Unary::Abs => a.abs(),
            Unary::Sqrt => a.sqrt(),
            Unary::Square => a * a,
            Unary::Floor => a.floor(),
            Unary::Triangle => (a - (a + 0.5).floor()).abs(),
            Unary::Sin => a.sin(),
            Unary::Cos => a.cos(),
            Unary::Tan => a.tan(),
            Unary::Asin => a.asin(),
            Unary::Acos => a.acos(),
            Unary::Atan => a.atan(),
            Unary::Exp => a.exp(),
            Unary::Log => a.ln(),
        }
    }

    fn apply2_f32(op: Binary, a: f32, b: f32) -> f32 {
        match op {
            Binary::Add => a + b,
            Binary::Sub => a - b,
            Binary::Mul => a * b,
            Binary::Div => a / b,
            Binary::Min => a.min(b),
            Binary::Max => a.max(b),
            Binary::Atan2 => a.atan2(b),
            Binary::Hypot => (a * a + b * b).sqrt(),
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn unary_functions_stay_in_range(
            op in 0..UNARY.len(), low in -8.0..8.0f64, width in 0.0..3.0f64, t in 0.0..1.0f64,
            shrink in prop::sample::select(vec![1.0, 1e-3, 1e-6]),
        ) {
            let (low, width) = (low * shrink, width * shrink);
            let range = Range::unary(UNARY[op], Range::new(low, low + width));
            let a = low + t * width;
            let value = UNARY[op].apply(a);
            if !value.is_nan() {
                prop_assert!(range.low <= value && value <= range.high, "{:?} {value} {range:?}", UNARY[op]);
            }
            let single = f64::from(apply_f32(UNARY[op], a as f32));
            let error = (single - value).abs();
            prop_assert!(error.is_nan() || error <= range.error, "{:?} at {a}: {single} {value} {range:?}", UNARY[op]);
        }

        #[test]
        fn binary_functions_stay_in_range(
            op in 0..BINARY.len(), low in prop::array::uniform2(-4.0..4.0f64),
            width in prop::array::uniform2(0.0..2.0f64), t in prop::array::uniform2(0.0..1.0f64),
        ) {
            let ranges = [0, 1].map(|i| Range::new(low[i], low[i] + width[i]));
            let range = Range::binary(BINARY[op], ranges[0], ranges[1]);
            let [a, b] = [0, 1].map(|i| low[i] + t[i] * width[i]);
            let value = BINARY[op].apply(a, b);
            prop_assert!(range.low <= value && value <= range.high, "{:?} {value} {range:?}", BINARY[op]);
            let single = f64::from(apply2_f32(BINARY[op], a as f32, b as f32));
            let error = (single - value).abs();
            prop_assert!(error.is_nan() || error <= range.error, "{:?} {a} {b}: {single} {value} {range:?}", BINARY[op]);
        }
    }
}
