//! Tetrahedra of a deformed body: point location, and depth below the surface.
use std::collections::{BinaryHeap, HashMap};

use crate::bounds::Bounds;
use crate::incidence::Incidence;
use crate::predicates::{Point, faces_touched, is_positive, side};
use crate::tree::Tree;
use crate::vectors::distance_to_triangle;

/// Faces of a tetrahedron; face f lies across from corner f.
const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// Tetrahedra at their deformed positions.
pub(crate) struct Material<'a> {
    points: &'a [Point],
    tets: &'a [[i32; 4]],
    /// Tetrahedra at each vertex.
    pub(crate) stars: Incidence,
    tree: Tree,
    /// Cached neighbors across faces: -1 at the surface.
    neighbors: HashMap<u32, [i64; 4]>,
}

impl<'a> Material<'a> {
    pub(crate) fn new(points: &'a [Point], tets: &'a [[i32; 4]]) -> Self {
        let bounds: Vec<Bounds> = tets
            .iter()
            .map(|tet| Bounds::of(tet.map(|v| points[v as usize])))
            .collect();
        Self {
            points,
            tets,
            stars: Incidence::new(points.len(), tets),
            tree: Tree::new(&bounds),
            neighbors: HashMap::new(),
        }
    }

    /// Deformed corners of a tetrahedron.
    pub(crate) fn corners(&self, tet: u32) -> [Point; 4] {
        self.tets[tet as usize].map(|v| self.points[v as usize])
    }

    /// Tetrahedra of positive volume that contain a point, without those at all `own` vertices; empty unless foreign
    /// material covers the point. Inverted tetrahedra cancel others, and if all tetrahedra at the first `own` vertex
    /// are inverted, one more has to contain the point, for the surface itself.
    pub(crate) fn covering(&self, point: Point, own: &[i32]) -> Vec<u32> {
        let mut holding = Vec::new();
        let (mut inner, mut inverted) = (0_usize, 0_usize);
        self.tree.around(point, |t| {
            let tet = self.tets[t as usize];
            if own.iter().all(|vertex| tet.contains(vertex)) {
                return;
            }
            let corners = self.corners(t);
            if is_positive(corners) {
                if let Some(touched) = faces_touched(corners, point) {
                    holding.push(t);
                    inner += usize::from(touched == 0);
                }
            } else {
                let [a, b, c, d] = corners;
                let turned = [a, b, d, c];
                let strictly = is_positive(turned) && faces_touched(turned, point) == Some(0);
                inverted += usize::from(strictly);
            }
        });
        let mut at_own = self.stars.of(own[0]).iter();
        let upright = at_own.any(|&t| is_positive(self.corners(t)));
        holding.sort_unstable();
        let count = inner.max(usize::from(!holding.is_empty())) + usize::from(upright);
        if count < 2 + inverted {
            holding.clear();
        }
        holding
    }

    /// Depth of a point in a tetrahedron: the distance to the nearest surface face reached through the material, from
    /// tetrahedron to tetrahedron. Other places of the body that happen to be there do not count.
    pub(crate) fn depth(&mut self, point: Point, tet: u32) -> f64 {
        let mut nearest = f64::INFINITY;
        let mut open = BinaryHeap::from([Entry { distance: 0.0, tet }]);
        let mut seen = std::collections::HashSet::from([tet]);
        while let Some(Entry { distance, tet }) = open.pop() {
            if distance >= nearest {
                break;
            }
            let corners = self.corners(tet);
            let beyond = self.across(tet);
            for (face, neighbor) in FACES.iter().zip(beyond) {
                let next = u32::try_from(neighbor);
                if next.is_ok_and(|next| seen.contains(&next)) {
                    continue;
                }
                let distance = distance_to_triangle(point, face.map(|i| corners[i]));
                match next {
                    Ok(next) if distance < nearest => {
                        seen.insert(next);
                        open.push(Entry {
                            distance,
                            tet: next,
                        });
                    }
                    Ok(_) => {}
                    Err(_) => nearest = nearest.min(distance),
                }
            }
        }
        nearest
    }

    /// Tetrahedra across the faces of one, -1 at the surface.
    fn across(&mut self, tet: u32) -> [i64; 4] {
        if let Some(known) = self.neighbors.get(&tet) {
            return *known;
        }
        let corners = self.tets[tet as usize];
        let found = FACES.map(|face| {
            let [a, b, c] = face.map(|i| corners[i]);
            let other = self.stars.of(a).iter().find(|&&t| {
                let tet_there = self.tets[t as usize];
                t != tet && tet_there.contains(&b) && tet_there.contains(&c)
            });
            other.map_or(-1, |&t| i64::from(t))
        });
        self.neighbors.insert(tet, found);
        found
    }

    /// The tetrahedron behind a triangle of the surface.
    pub(crate) fn behind(&self, [a, b, c]: [i32; 3]) -> Option<u32> {
        let holds = |t: &&u32| {
            let tet = self.tets[**t as usize];
            tet.contains(&b) && tet.contains(&c)
        };
        self.stars.of(a).iter().find(holds).copied()
    }

    /// Barycentric weights of the corners of a tetrahedron at a point in it.
    pub(crate) fn weights(&self, tet: u32, point: Point) -> [f64; 4] {
        let corners = self.corners(tet);
        let volumes = FACES.map(|[i, j, k]| side(corners[i], corners[j], corners[k], point).abs());
        let total: f64 = volumes.iter().sum();
        if total > 0.0 {
            volumes.map(|volume| volume / total)
        } else {
            [0.25; 4]
        }
    }
}

/// Tetrahedron in the search queue, the nearest first; equal ones in order of their number.
#[derive(PartialEq)]
struct Entry {
    distance: f64,
    tet: u32,
}

impl Eq for Entry {}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let nearer = other.distance.total_cmp(&self.distance);
        nearer.then(other.tet.cmp(&self.tet))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
