//! The distance to a triply periodic surface, by its closest point.
//!
//! A grid over one period stores the closest surface point of each node. A query takes those of the eight nodes around
//! it as starting points and slides each along the surface until the offset to the query is normal to the surface; the
//! shortest of these offsets is the distance. It is never too short, as each ends on the surface. It is too long only
//! where none of the eight nodes has its closest point on the same sheet as the query: there two sheets are equally far
//! except for the curvature of their distances over one cell of the grid, an error of second order in the cell, for
//! which [`SLACK`] is a generous bound (`tests/unit/shapes/test_shapes_periodic.py` measures it).
use std::collections::VecDeque;
use std::f64::consts::TAU;
use std::sync::{Arc, LazyLock, Mutex};

use super::waves::{Surface, Wave};
use crate::error::FieldError;
use crate::field::{Field, distance_range};
use crate::frame::dot;
use crate::range::Range;

/// Nodes of the grid along each edge of a period.
const NODES: usize = 32;
const CELL: f64 = TAU / NODES as f64;
/// Cells per period of the grid that is searched for surface points, finer than that of the nodes. A multiple of eight,
/// so that the maxima and minima of g are nodes and no closed pocket is missed.
const FINE: usize = 64;
/// Largest excess of a distance, in phase.
const SLACK: f64 = 0.03;
/// Distance below which two starting points slide to the same surface point.
const NEAR: f64 = 1.5 * CELL;
/// Most Newton steps, each of which doubles the digits: four are enough except near a center of curvature.
const MOST_JUMPS: usize = 6;
const MOST_STEPS: usize = 24;
const MOST_HALVINGS: usize = 8;
/// Squared step size at which a search ends: the distance then has all its digits.
const STILL: f64 = 1e-13;
/// Squared gradient below which a point counts as singular, such as those of P at level 1.
const FLAT: f64 = 1e-12;
/// Number of cached surfaces: a study changes a thickness more often than a level.
const KEPT: usize = 8;

static MADE: LazyLock<Mutex<Vec<Arc<Closest>>>> = LazyLock::new(Mutex::default);

/// Distance field of g = level, cached for all shapes that share it.
pub(super) fn shared(surface: Surface, level: f64) -> Arc<dyn Field> {
    let mut made = MADE.lock().unwrap_or_else(|broken| broken.into_inner());
    let known = |c: &Arc<Closest>| c.surface == surface && c.level.to_bits() == level.to_bits();
    let found = match made.iter().position(known) {
        Some(index) => made.remove(index),
        None => Arc::new(Closest::new(surface, level)),
    };
    made.truncate(KEPT - 1);
    made.insert(0, found.clone());
    found
}

/// Signed distance in phase to g = level, as a function of the three phases of a point.
#[derive(Debug)]
struct Closest {
    surface: Surface,
    level: f64,
    /// Offset from each node to its closest surface point, in C order.
    ways: Vec<[f64; 3]>,
}

impl Field for Closest {
    fn sample(&self, points: &[[f64; 3]], values: &mut [f64]) -> Result<(), FieldError> {
        for (value, &point) in values.iter_mut().zip(points) {
            *value = self.signed(point);
        }
        Ok(())
    }

    fn range(&self, at: &[Range; 3]) -> Result<Range, FieldError> {
        let exact = distance_range(at, |middle| Ok::<_, FieldError>(self.signed(middle)))?;
        // The sign is exact, so the slack matters only away from zero; both ends are computed values.
        Ok(Range {
            low: exact.low - SLACK,
            high: exact.high + SLACK,
            ..exact
        })
    }
}

impl Closest {
    fn new(surface: Surface, level: f64) -> Self {
        let mut field = Self {
            surface,
            level,
            ways: Vec::new(),
        };
        field.ways = spread(field.points());
        for (index, way) in field.ways.iter_mut().enumerate() {
            let node = node(index);
            let end = closest(surface, level, node, add(node, *way));
            *way = subtract(end, node);
        }
        field.ways = settle(std::mem::take(&mut field.ways));
        field
    }

    /// Surface points where it crosses the edges of the fine grid.
    fn points(&self) -> Vec<[f64; 3]> {
        let step = TAU / FINE as f64;
        let axis: Vec<_> = (0..FINE).map(|i| (i as f64 * step).sin_cos()).collect();
        let values: Vec<f64> = (0..FINE * FINE * FINE)
            .map(|index| {
                let parts = split(index, FINE).map(|i| axis[i]);
                self.surface.of(parts).value() - self.level
            })
            .collect();
        let mut found = Vec::new();
        for index in 0..values.len() {
            let corner = split(index, FINE);
            for axis in 0..3 {
                let mut next = corner;
                next[axis] = (next[axis] + 1) % FINE;
                let (first, last) = (values[index], values[flat(next, FINE)]);
                if (first < 0.0) != (last < 0.0) {
                    let mut start = corner.map(|i| i as f64 * step);
                    start[axis] += step * first / (first - last);
                    found.push(onto(self.surface, self.level, start));
                }
            }
        }
        found
    }

    fn signed(&self, place: [f64; 3]) -> f64 {
        if place.iter().any(|v| !v.is_finite()) {
            return f64::NAN;
        }
        let place = place.map(|v| v - (v / TAU).floor() * TAU);
        let distance = self.distance(place);
        if self.surface.at(place).value() < self.level {
            -distance
        } else {
            distance
        }
    }

    /// Distance from a point in the first period to the surface.
    fn distance(&self, place: [f64; 3]) -> f64 {
        let lowest = place.map(|v| ((v / CELL) as usize).min(NODES - 1));
        let mut starts = [([0.0; 3], f64::INFINITY); 8];
        for (corner, start) in starts.iter_mut().enumerate() {
            let index = [0, 1, 2].map(|axis| lowest[axis] + (corner >> axis & 1));
            let way = self.ways[flat(index.map(|i| i % NODES), NODES)];
            let end = add(index.map(|i| i as f64 * CELL), way);
            *start = (end, length(subtract(end, place)));
        }
        starts.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut best = f64::INFINITY;
        for (i, &(start, _)) in starts.iter().enumerate() {
            let is_new = |&(other, _): &([f64; 3], f64)| length(subtract(start, other)) > NEAR;
            if starts[..i].iter().all(is_new) {
                let end = closest(self.surface, self.level, place, start);
                best = best.min(length(subtract(end, place)));
            }
        }
        best
    }
}

/// Finds the closest of `points` to every node, propagated from node to node.
fn spread(points: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    let mut ways = vec![[f64::INFINITY; 3]; NODES * NODES * NODES];
    for point in points {
        let index = point.map(|v| (v / CELL).round());
        let way = subtract(point, index.map(|i| i * CELL));
        let known = &mut ways[flat(
            index.map(|i| i.rem_euclid(NODES as f64) as usize % NODES),
            NODES,
        )];
        if square(way) < square(*known) {
            *known = way;
        }
    }
    settle(ways)
}

/// Propagates the closest point of each node to its neighbors while it is closer than theirs.
fn settle(mut ways: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    let steps: Vec<[usize; 3]> = (0..27).map(|i| split(i, 3)).collect();
    let mut queue: VecDeque<usize> = (0..ways.len())
        .filter(|&index| ways[index][0].is_finite())
        .collect();
    let mut is_queued: Vec<bool> = ways.iter().map(|way| way[0].is_finite()).collect();
    while let Some(index) = queue.pop_front() {
        is_queued[index] = false;
        let (here, way) = (split(index, NODES), ways[index]);
        for step in &steps {
            let neighbor = flat(
                [0, 1, 2].map(|a| (here[a] + step[a] + NODES - 1) % NODES),
                NODES,
            );
            let from_there = [0, 1, 2].map(|a| way[a] - (step[a] as f64 - 1.0) * CELL);
            // Requires a gain beyond rounding, or two equally close points would be exchanged forever.
            if square(from_there) < square(ways[neighbor]) * (1.0 - 1e-12) {
                ways[neighbor] = from_there;
                if !is_queued[neighbor] {
                    is_queued[neighbor] = true;
                    queue.push_back(neighbor);
                }
            }
        }
    }
    ways
}

/// Projects `start` onto g = level along the gradient.
fn onto(surface: Surface, level: f64, start: [f64; 3]) -> [f64; 3] {
    let mut point = start;
    for _ in 0..4 {
        let wave = surface.at(point);
        let (excess, slope) = (wave.value() - level, wave.slope());
        let steep = square(slope);
        if steep < FLAT || excess.abs() < 1e-14 {
            break;
        }
        point = [0, 1, 2].map(|i| point[i] - excess / steep * slope[i]);
    }
    point
}

/// Finds the point of g = level closest to `place`, searched from `start` on the surface.
fn closest(surface: Surface, level: f64, place: [f64; 3], start: [f64; 3]) -> [f64; 3] {
    jump(surface, level, place, start).unwrap_or_else(|| slide(surface, level, place, start))
}

/// Newton's method for point − place + λ∇g = 0 and g = level, from `start`; `None` if it does not converge in a few
/// steps, or to a point that is farther than `start`.
fn jump(surface: Surface, level: f64, place: [f64; 3], start: [f64; 3]) -> Option<[f64; 3]> {
    let mut point = start;
    let mut multiplier = f64::NAN;
    for _ in 0..MOST_JUMPS {
        let wave = surface.at(point);
        let (excess, slope) = (wave.value() - level, wave.slope());
        let steep = square(slope);
        if steep < FLAT {
            return None;
        }
        let way = subtract(place, point);
        if multiplier.is_nan() {
            multiplier = dot(way, slope) / steep;
        }
        let plane = Plane::new(&wave, slope, steep, multiplier);
        // The normal step onto the surface changes the gradient as well.
        let along = -excess / steep;
        let normal = slope.map(|v| along * v);
        let turned = wave.bend_along(normal);
        let pull = [0, 1, 2].map(|i| way[i] - multiplier * turned[i]);
        let across = plane.newton(pull)?;
        let step = add(normal, across);
        let size = square(step);
        if size > CELL * CELL {
            return None;
        }
        point = add(point, step);
        if size < STILL {
            // One more step would change the distance by far less than rounding.
            return (square(subtract(point, place))
                <= square(subtract(start, place)) * (1.0 + 1e-9))
                .then_some(point);
        }
        let bent = wave.bend_along(step);
        multiplier += dot(
            slope,
            [0, 1, 2].map(|i| way[i] - step[i] - multiplier * (slope[i] + bent[i])),
        ) / steep;
    }
    None
}

/// Finds the closest point by descent steps along the surface. They converge everywhere, also where a whole circle of
/// the surface is nearly as close.
fn slide(surface: Surface, level: f64, place: [f64; 3], start: [f64; 3]) -> [f64; 3] {
    let mut point = start;
    let mut far = square(subtract(point, place));
    for _ in 0..MOST_STEPS {
        let wave = surface.at(point);
        let slope = wave.slope();
        let steep = square(slope);
        if steep < FLAT {
            break;
        }
        let way = subtract(place, point);
        let plane = Plane::new(&wave, slope, steep, dot(way, slope) / steep);
        let whole = plane.newton(way).unwrap_or_else(|| plane.part(way));
        let size = length(whole);
        if square(whole) < STILL {
            break;
        }
        // Beyond a cell the quadratic model of the surface is invalid.
        let mut share = (CELL / size).min(1.0);
        let mut moved = false;
        for _ in 0..MOST_HALVINGS {
            let next = onto(surface, level, add(point, whole.map(|v| share * v)));
            let distance = square(subtract(next, place));
            if distance < far {
                (point, far, moved) = (next, distance, true);
                break;
            }
            share *= 0.5;
        }
        if !moved {
            break;
        }
    }
    point
}

/// Tangent plane of the surface at a point, with the second derivative of |point − place|²/2 + λg in it.
struct Plane {
    u: [f64; 3],
    v: [f64; 3],
    uu: f64,
    uv: f64,
    vv: f64,
}

impl Plane {
    fn new(wave: &Wave, slope: [f64; 3], steep: f64, multiplier: f64) -> Self {
        let [u, v] = tangents(slope, steep);
        let (bent_u, bent_v) = (wave.bend_along(u), wave.bend_along(v));
        Self {
            u,
            v,
            uu: 1.0 + multiplier * dot(u, bent_u),
            uv: multiplier * dot(u, bent_v),
            vv: 1.0 + multiplier * dot(v, bent_v),
        }
    }

    /// Newton step for a residual vector; `None` if the distance has no minimum.
    fn newton(&self, pull: [f64; 3]) -> Option<[f64; 3]> {
        let determinant = self.uu * self.vv - self.uv * self.uv;
        if self.uu <= 0.0 || determinant < 1e-3 * self.uu * self.vv {
            return None;
        }
        let (a, b) = (dot(pull, self.u), dot(pull, self.v));
        let along_u = (self.vv * a - self.uv * b) / determinant;
        let along_v = (self.uu * b - self.uv * a) / determinant;
        Some(self.at(along_u, along_v))
    }

    /// Projection of a vector onto the plane.
    fn part(&self, vector: [f64; 3]) -> [f64; 3] {
        self.at(dot(vector, self.u), dot(vector, self.v))
    }

    fn at(&self, a: f64, b: f64) -> [f64; 3] {
        [0, 1, 2].map(|i| a * self.u[i] + b * self.v[i])
    }
}

/// Two orthogonal unit vectors normal to `normal`, whose squared length is given.
fn tangents(normal: [f64; 3], squared: f64) -> [[f64; 3]; 2] {
    let scale = 1.0 / squared.sqrt();
    let unit = normal.map(|v| v * scale);
    // Duff et al. 2017 (JCGT 6, 1): no root, and no direction in which it fails.
    let sign = 1.0_f64.copysign(unit[2]);
    let a = -1.0 / (sign + unit[2]);
    let b = unit[0] * unit[1] * a;
    [
        [
            1.0 + sign * unit[0] * unit[0] * a,
            sign * b,
            -sign * unit[0],
        ],
        [b, sign + unit[1] * unit[1] * a, -unit[1]],
    ]
}

fn node(index: usize) -> [f64; 3] {
    split(index, NODES).map(|i| i as f64 * CELL)
}

/// Splits an index in C order into three, with `n` along each axis.
fn split(index: usize, n: usize) -> [usize; 3] {
    [index / (n * n), index / n % n, index % n]
}

fn flat(index: [usize; 3], n: usize) -> usize {
    (index[0] * n + index[1]) * n + index[2]
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + b[i])
}

fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn square(a: [f64; 3]) -> f64 {
    dot(a, a)
}

fn length(a: [f64; 3]) -> f64 {
    square(a).sqrt()
}
