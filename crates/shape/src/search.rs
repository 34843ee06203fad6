//! Search by interval arithmetic for the bounds of a shape given by its function alone.
use crate::bounds::Bounds;
use crate::error::FieldError;
use crate::range::Range;
use crate::shape::Shape;
use crate::tape::Tape;

/// Half edge of the search region about the origin, m; a shape that reaches its border counts as unbounded.
pub const HORIZON: f64 = 10.0;

/// Bisections per round: a box is tested in up to 2⁴ parts along each axis.
const LEVELS: usize = 4;
const MOST_ROUNDS: usize = 20;
/// Shrink factor of edges at which the rounds end: in the last one no edge becomes shorter than this part of it.
const PROGRESS: f64 = 0.98;

impl Shape {
    /// Bounds with as few infinite sides as can be proved: the known ones, or else those of the
    /// region within [`HORIZON`] that interval arithmetic cannot prove empty.
    pub fn find_bounds(&self) -> Result<Bounds, FieldError> {
        if self.bounds.is_finite() || self.bounds.is_empty() {
            return Ok(self.bounds);
        }
        let horizon = Bounds::new([-HORIZON; 3], [HORIZON; 3]);
        let start = self.bounds.intersection(&horizon);
        let mut search = Search {
            tape: Tape::new(&self.expr),
            work: Vec::new(),
        };
        let mut found = start;
        for _ in 0..MOST_ROUNDS {
            let before = found;
            found = search.occupied(&before, LEVELS)?;
            if found.is_empty() {
                return Ok(Bounds::EMPTY);
            }
            let shrink =
                |i: usize| (found.high[i] - found.low[i]) / (before.high[i] - before.low[i]);
            if (0..3).all(|i| shrink(i) >= PROGRESS) {
                break;
            }
        }
        let open = |found: f64, start: f64, known: f64| if found == start { known } else { found };
        Ok(Bounds {
            low: [0, 1, 2].map(|i| open(found.low[i], start.low[i], self.bounds.low[i])),
            high: [0, 1, 2].map(|i| open(found.high[i], start.high[i], self.bounds.high[i])),
        })
    }
}

struct Search {
    tape: Tape,
    work: Vec<Range>,
}

impl Search {
    /// Hull of the parts of `region` that may contain a point with s < 0.
    fn occupied(&mut self, region: &Bounds, levels: usize) -> Result<Bounds, FieldError> {
        let at = [0, 1, 2].map(|i| Range::new(region.low[i], region.high[i]));
        let range = self.tape.range(&at, &mut self.work)?;
        if range.low >= 0.0 {
            return Ok(Bounds::EMPTY);
        }
        // Splitting a region that is entirely inside cannot shrink the hull.
        if levels == 0 || range.high < 0.0 {
            return Ok(*region);
        }
        let middle = [0, 1, 2].map(|i| 0.5 * (region.low[i] + region.high[i]));
        region
            .corners()
            .iter()
            .try_fold(Bounds::EMPTY, |hull, &corner| {
                let part = Bounds::around([corner, middle]);
                Ok(hull.hull(&self.occupied(&part, levels - 1)?))
            })
    }
}

#[cfg(test)]
mod tests {
    use crate::{Bounds, Shape, parse};

    fn bounds(text: &str) -> Bounds {
        Shape::unknown(parse(text).unwrap()).find_bounds().unwrap()
    }

    #[test]
    fn ball_is_bounded_tightly() {
        let found = bounds("(x - 1)^2 + y^2 + z^2 - 0.02^2");
        for axis in 0..3 {
            let center = if axis == 0 { 1.0 } else { 0.0 };
            assert!(found.low[axis] <= center - 0.02 && found.low[axis] > center - 0.03);
            assert!(found.high[axis] >= center + 0.02 && found.high[axis] < center + 0.03);
        }
    }

    #[test]
    fn unbounded_side_stays_unbounded() {
        let found = bounds("x^2 + y^2 - 0.02^2");
        assert_eq!(found.low[2], f64::NEG_INFINITY);
        assert_eq!(found.high[2], f64::INFINITY);
        assert!(found.high[0] < 0.03);
        assert!(!bounds("sin(x)").is_finite());
    }

    #[test]
    fn shape_without_inside_is_empty() {
        assert!(bounds("x^2 + 1").is_empty());
    }
}
