//! Axis-aligned boxes that contain a shape.

/// An axis-aligned box in m; infinite where a shape has no end, reversed when it is empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lowest corner
    pub low: [f64; 3],
    /// Highest corner
    pub high: [f64; 3],
}

impl Bounds {
    /// The whole space.
    pub const ALL: Self = Self {
        low: [f64::NEG_INFINITY; 3],
        high: [f64::INFINITY; 3],
    };
    /// The empty box.
    pub const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// A box from two corners.
    pub fn new(low: [f64; 3], high: [f64; 3]) -> Self {
        Self { low, high }
    }

    /// Smallest box around `points`.
    pub fn around(points: impl IntoIterator<Item = [f64; 3]>) -> Self {
        points
            .into_iter()
            .fold(Self::EMPTY, |bounds, p| bounds.hull(&Self::new(p, p)))
    }

    /// True when no side is infinite.
    pub fn is_finite(&self) -> bool {
        self.low.iter().chain(&self.high).all(|v| v.is_finite())
    }

    /// True when nothing is inside.
    pub fn is_empty(&self) -> bool {
        (0..3).any(|axis| self.low[axis] > self.high[axis])
    }

    /// Smallest box around both.
    pub fn hull(&self, other: &Self) -> Self {
        if self.is_empty() {
            return *other;
        }
        if other.is_empty() {
            return *self;
        }
        Self {
            low: [0, 1, 2].map(|i| self.low[i].min(other.low[i])),
            high: [0, 1, 2].map(|i| self.high[i].max(other.high[i])),
        }
    }

    /// Intersection of two boxes.
    pub fn intersection(&self, other: &Self) -> Self {
        let both = Self {
            low: [0, 1, 2].map(|i| self.low[i].max(other.low[i])),
            high: [0, 1, 2].map(|i| self.high[i].min(other.high[i])),
        };
        if both.is_empty() { Self::EMPTY } else { both }
    }

    /// Box with every side moved outward by `distance` (inward when negative).
    pub fn grown(&self, distance: f64) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let grown = Self {
            low: self.low.map(|v| v - distance),
            high: self.high.map(|v| v + distance),
        };
        if grown.is_empty() { Self::EMPTY } else { grown }
    }

    /// The eight corners.
    pub fn corners(&self) -> [[f64; 3]; 8] {
        std::array::from_fn(|corner| {
            [0, 1, 2].map(|i| {
                if corner >> i & 1 == 0 {
                    self.low[i]
                } else {
                    self.high[i]
                }
            })
        })
    }
}
