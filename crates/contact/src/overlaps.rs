//! Overlaps of a body with itself and their depths, from intersecting triangles.
use std::collections::{BTreeMap, VecDeque};

use crate::crossings::Crossings;
use crate::groups::Groups;
use crate::incidence::Incidence;
use crate::material::Material;
use crate::predicates::{Point, is_positive, side};
use crate::triangles::reaches;
use crate::vectors::{axpy, cross, distance, dot, sub};
use crate::{Body, Covered, Overlap};

/// Relative depth, in lengths of the edge that it is measured on, below which it is rounding.
const ROUNDING: f64 = 1e-12;

/// Finds the overlaps, the deepest first, and all vertices covered by foreign material.
pub(crate) fn overlaps(
    body: &Body<'_>,
    all: &[[i32; 3]],
    crossings: &Crossings,
) -> (Vec<Overlap>, Vec<Covered>) {
    let mut search = Search {
        body,
        all,
        material: Material::new(body.positions, body.tets),
        around: Incidence::new(body.positions.len(), body.triangles),
        groups: Groups::new(body.positions.len(), body.tets),
        deepest: BTreeMap::new(),
    };
    for &[i, j] in &crossings.pairs {
        let (of_i, of_j) = (search.component(i), search.component(j));
        search.groups.join((i, of_j), (j, of_i));
    }
    let vertices = search.flood(crossings);
    search.measure_vertices(&vertices);
    search.measure_edges(&crossings.pairs);
    let found = search.overlaps(crossings, &vertices);
    let place: BTreeMap<usize, u32> = found.iter().map(|&(group, _)| group).zip(0..).collect();
    let covered = vertices.iter().map(|each| Covered {
        vertex: each.vertex,
        tet: each.tets[0] as i32,
        overlap: place[&search.group_of(each)],
    });
    let covered = covered.collect();
    let overlaps = found.into_iter().map(|(_, overlap)| overlap).collect();
    (overlaps, covered)
}

/// Vertex in foreign material: the component of that material, and its tetrahedra that contain the vertex.
struct Vertex {
    vertex: i32,
    component: u32,
    tets: Vec<u32>,
}

/// Point of the surface in foreign material.
#[derive(Clone, Copy)]
struct Sample {
    depth: f64,
    /// Ends of its edge, and its parameter along the edge.
    ends: [i32; 2],
    along: f64,
    /// Tetrahedron that contains it.
    within: u32,
}

/// Edges that pass through triangles of a component: one of the edge's own triangles, and the parameters of the cuts.
type Pierced = BTreeMap<([i32; 2], u32), (u32, Vec<f64>)>;

struct Search<'a> {
    body: &'a Body<'a>,
    all: &'a [[i32; 3]],
    material: Material<'a>,
    /// Triangles at each vertex.
    around: Incidence,
    groups: Groups,
    /// Deepest sample of each group.
    deepest: BTreeMap<usize, Sample>,
}

impl Search<'_> {
    fn component(&self, triangle: u32) -> u32 {
        self.groups.component(self.all[triangle as usize][0])
    }

    /// Finds the covered vertices by a flood fill from the crossing triangles inward, in the order of finding;
    /// triangles at a covered vertex are of one group.
    fn flood(&mut self, crossings: &Crossings) -> Vec<Vertex> {
        let mut seen = vec![false; self.body.positions.len()];
        let mut open: VecDeque<i32> = VecDeque::new();
        let mut reach = |triangle: u32, open: &mut VecDeque<i32>| {
            for vertex in self.all[triangle as usize] {
                if !std::mem::replace(&mut seen[vertex as usize], true) {
                    open.push_back(vertex);
                }
            }
        };
        let crossing = crossings.pairs.as_flattened().iter();
        for &triangle in crossing.chain(&crossings.swallowed) {
            reach(triangle, &mut open);
        }
        let mut found = Vec::new();
        while let Some(vertex) = open.pop_front() {
            let point = self.body.positions[vertex as usize];
            let mut holding: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
            for tet in self.material.covering(point, &[vertex]) {
                let component = self.groups.component(self.body.tets[tet as usize][0]);
                holding.entry(component).or_default().push(tet);
            }
            let triangles = self.around.of(vertex);
            for (component, tets) in holding {
                for &triangle in triangles {
                    let pair = ((triangles[0], component), (triangle, component));
                    self.groups.join(pair.0, pair.1);
                    reach(triangle, &mut open);
                }
                found.push(Vertex {
                    vertex,
                    component,
                    tets,
                });
            }
        }
        found
    }

    fn group_of(&mut self, covered: &Vertex) -> usize {
        let triangle = self.around.of(covered.vertex)[0];
        self.groups.of(triangle, covered.component)
    }

    /// Measures covered vertices in reverse order of finding: the last lie deepest, and spare the others, because from
    /// a vertex to the next the depth grows by no more than their distance.
    fn measure_vertices(&mut self, vertices: &[Vertex]) {
        let points = self.body.positions;
        let mut limit: BTreeMap<(i32, u32), f64> = BTreeMap::new();
        for each in vertices.iter().rev() {
            let (vertex, component) = (each.vertex, each.component);
            let point = points[vertex as usize];
            let group = self.group_of(each);
            let triangles = self.around.of(vertex).iter();
            let bound = triangles
                .flat_map(|&t| self.body.triangles[t as usize])
                .filter_map(|n| {
                    let depth = limit.get(&(n, component))?;
                    Some(depth + distance(points[n as usize], point))
                })
                .fold(f64::INFINITY, f64::min);
            if bound <= self.deepest_of(group) {
                limit.insert((vertex, component), bound);
                continue;
            }
            let (depth, within) = self.depth(point, &each.tets);
            limit.insert((vertex, component), depth);
            let sample = Sample {
                depth,
                ends: [vertex; 2],
                along: 0.0,
                within,
            };
            self.keep(group, sample);
        }
    }

    /// Measures the midpoint of every segment between the cuts of an edge.
    fn measure_edges(&mut self, pairs: &[[u32; 2]]) {
        let points = self.body.positions;
        for ((ends, component), (triangle, mut cuts)) in self.pierced(pairs) {
            cuts.extend([0.0, 1.0]);
            cuts.sort_unstable_by(f64::total_cmp);
            let [p, q] = ends.map(|end| points[end as usize]);
            let least = ROUNDING * distance(p, q);
            let group = self.groups.of(triangle, component);
            for stretch in cuts.windows(2) {
                let along = 0.5 * (stretch[0] + stretch[1]);
                let middle = between(p, q, along);
                // At least one end lies on the other surface.
                let bound = (stretch[1] - along) * distance(p, q);
                if bound <= self.deepest_of(group).max(least) {
                    continue;
                }
                let mut tets = self.material.covering(middle, &ends);
                tets.retain(|&tet| {
                    self.groups.component(self.body.tets[tet as usize][0]) == component
                });
                let (depth, within) = self.depth(middle, &tets);
                if depth > least {
                    let sample = Sample {
                        depth,
                        ends,
                        along,
                        within,
                    };
                    self.keep(group, sample);
                }
            }
        }
    }

    fn pierced(&self, pairs: &[[u32; 2]]) -> Pierced {
        let mut edges = Pierced::new();
        for &[i, j] in pairs {
            for (own, other) in [(i, j), (j, i)] {
                let component = self.component(other);
                for (ends, along) in self.cuts(own, other) {
                    let entry = edges.entry((ends, component));
                    entry.or_insert((own, Vec::new())).1.push(along);
                }
            }
        }
        edges
    }

    /// Largest depth of a group so far; negative without a sample.
    fn deepest_of(&self, group: usize) -> f64 {
        self.deepest.get(&group).map_or(-1.0, |best| best.depth)
    }

    /// Edges of one triangle that pass through another, and the parameter of the cut along each.
    fn cuts(&self, own: u32, other: u32) -> impl Iterator<Item = ([i32; 2], f64)> {
        let points = self.body.positions;
        let [u, v, w] = self.all[own as usize];
        let plane = self.all[other as usize].map(|c| points[c as usize]);
        [[u, v], [v, w], [w, u]]
            .into_iter()
            .filter_map(move |edge| {
                let ends = [edge[0].min(edge[1]), edge[0].max(edge[1])];
                let line = ends.map(|end| points[end as usize]);
                let [a, b, c] = plane;
                let [from, to] = line.map(|p| side(a, b, c, p));
                (from * to < 0.0 && reaches(line, plane)).then(|| (ends, from / (from - to)))
            })
    }

    fn depth(&mut self, point: Point, tets: &[u32]) -> (f64, u32) {
        let mut deepest = (0.0, tets.first().copied().unwrap_or(0));
        for &tet in tets {
            let depth = self.material.depth(point, tet);
            if depth > deepest.0 {
                deepest = (depth, tet);
            }
        }
        deepest
    }

    fn keep(&mut self, group: usize, sample: Sample) {
        let best = self.deepest.entry(group).or_insert(sample);
        if sample.depth > best.depth {
            *best = sample;
        }
    }

    /// Overlaps, the deepest first, each with its group.
    fn overlaps(&mut self, crossings: &Crossings, vertices: &[Vertex]) -> Vec<(usize, Overlap)> {
        let mut first: BTreeMap<usize, [u32; 2]> = BTreeMap::new();
        for &[i, j] in &crossings.pairs {
            let group = self.groups.of(i, self.component(j));
            first.entry(group).or_insert([i, j]);
        }
        // Without intersecting surfaces: a component wholly within another, and others that it crosses besides.
        for each in vertices {
            let triangle = self.around.of(each.vertex)[0];
            first.entry(self.group_of(each)).or_insert([triangle; 2]);
        }
        let membranes = self.membrane_depths(&crossings.pairs);
        let mut found: Vec<(usize, Overlap)> = first
            .into_iter()
            .map(|(group, pair)| match self.deepest.get(&group) {
                Some(sample) if sample.depth > 0.0 => (group, self.at_sample(*sample)),
                _ => (
                    group,
                    self.at_pair(pair, membranes.get(&group).copied().unwrap_or(0.0)),
                ),
            })
            .collect();
        // Stable sort: of equal depths the one with the first triangle comes first.
        found.sort_by(|(_, a), (_, b)| b.depth.total_cmp(&a.depth));
        found
    }

    /// Lower bounds, by overlap, of the distance by which edges reach beyond membranes, which have no inside.
    fn membrane_depths(&mut self, pairs: &[[u32; 2]]) -> BTreeMap<usize, f64> {
        let mut depths: BTreeMap<usize, f64> = BTreeMap::new();
        for &[i, j] in pairs {
            if (j as usize) < self.body.triangles.len() {
                continue;
            }
            let group = self.groups.of(i, self.component(j));
            let [a, b, c] = self.all[j as usize].map(|v| self.body.positions[v as usize]);
            let normal = cross(sub(b, a), sub(c, a));
            let length = dot(normal, normal).sqrt();
            for (ends, _) in self.cuts(i, j) {
                let height = |end: i32| {
                    let to = sub(self.body.positions[end as usize], a);
                    (dot(normal, to) / length).abs()
                };
                let beyond = height(ends[0]).min(height(ends[1]));
                let depth = depths.entry(group).or_default();
                *depth = depth.max(beyond);
            }
        }
        depths
    }

    fn at_sample(&self, sample: Sample) -> Overlap {
        let [p, q] = sample.ends;
        let place =
            |points: &[Point]| between(points[p as usize], points[q as usize], sample.along);
        let now = place(self.body.positions);
        let weights = self.material.weights(sample.within, now);
        let mut other = [0.0; 3];
        for (weight, &vertex) in weights.iter().zip(&self.body.tets[sample.within as usize]) {
            axpy(&mut other, *weight, self.body.rest[vertex as usize]);
        }
        let at_ends = self.material.stars.of(p).iter();
        let own = at_ends
            .copied()
            .find(|&tet| self.body.tets[tet as usize].contains(&q));
        Overlap {
            depth: sample.depth,
            now,
            rest: [place(self.body.rest), other],
            tets: [own.map_or(-1, |tet| tet as i32), sample.within as i32],
            inverted: false,
        }
    }

    /// Overlap without a deep sample: at the centroids of two crossing triangles.
    fn at_pair(&self, pair: [u32; 2], depth: f64) -> Overlap {
        let center = |points: &[Point], triangle: u32| {
            let mut center = [0.0; 3];
            for vertex in self.all[triangle as usize] {
                axpy(&mut center, 1.0 / 3.0, points[vertex as usize]);
            }
            center
        };
        let tets = pair.map(|t| self.material.behind(self.all[t as usize]));
        let at_corners = pair.iter().flat_map(|&t| self.all[t as usize]);
        let inverted = at_corners
            .flat_map(|v| self.material.stars.of(v))
            .any(|&tet| !is_positive(self.material.corners(tet)));
        Overlap {
            depth,
            now: center(self.body.positions, pair[0]),
            rest: pair.map(|t| center(self.body.rest, t)),
            tets: tets.map(|tet| tet.map_or(-1, |tet| tet as i32)),
            inverted: inverted && depth == 0.0,
        }
    }
}

fn between(p: Point, q: Point, along: f64) -> Point {
    std::array::from_fn(|i| p[i] + along * (q[i] - p[i]))
}
