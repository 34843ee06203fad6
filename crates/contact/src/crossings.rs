//! Intersecting triangles of a body.
use std::collections::HashMap;

use crate::incidence::Incidence;
use crate::predicates::Point;
use crate::shells::{bounds_of, covering, shells};
use crate::tetrahedra;
use crate::tree::Tree;
use crate::triangles::{Meeting, meeting};

/// Intersecting triangles, and triangles of shells that lie wholly within other material.
pub(crate) struct Crossings {
    /// Pairs, ascending, each once, the smaller number first.
    pub(crate) pairs: Vec<[u32; 2]>,
    /// Triangles of shells within other material.
    pub(crate) swallowed: Vec<u32>,
}

impl Crossings {
    /// Tests a closed `surface` of tetrahedra, and membranes whose triangles follow it in `all`.
    pub(crate) fn of(
        points: &[Point],
        all: &[[i32; 3]],
        surface: usize,
        tets: &[[i32; 4]],
    ) -> Self {
        let tree = Tree::new(&bounds_of(points, all));
        let mut met = tree.pairs(&|i, j| {
            let found = meeting(points, all[i as usize], all[j as usize]);
            (found != Meeting::Apart).then_some(([i, j], found))
        });
        met.sort_unstable_by_key(|(pair, _)| *pair);
        let touching = met.iter().any(|(_, found)| *found == Meeting::Touch);
        let pairs = if touching {
            decided(points, all, surface, tets, met)
        } else {
            met.into_iter().map(|(pair, _)| pair).collect()
        };
        let swallowed = swallowed(points, &all[..surface], &tree, &pairs);
        Self { pairs, swallowed }
    }
}

/// Pairs that cross, and pairs of which only edges and vertices meet while the material behind them overlaps.
///
/// If surfaces meet along edges, or lie in one plane, the triangles alone do not decide between touching and
/// overlapping bodies: the tetrahedra at their vertices do.
fn decided(
    points: &[Point],
    all: &[[i32; 3]],
    surface: usize,
    tets: &[[i32; 4]],
    met: Vec<([u32; 2], Meeting)>,
) -> Vec<[u32; 2]> {
    let stars = Incidence::new(points.len(), tets);
    let at = |tet: u32| tets[tet as usize].map(|v| points[v as usize]);
    let mut known: HashMap<[u32; 2], bool> = HashMap::new();
    let mut overlap = |a: u32, b: u32| {
        let key = [a.min(b), a.max(b)];
        *known
            .entry(key)
            .or_insert_with(|| a != b && tetrahedra::overlap(at(a), at(b)))
    };
    let star = |triangle: u32| {
        let corners = all[triangle as usize];
        let mut star = corners.map(|v| stars.of(v)).concat();
        star.sort_unstable();
        star.dedup();
        star
    };
    let mut counts = |[i, j]: [u32; 2], found: Meeting| match found {
        Meeting::Apart => false,
        Meeting::Cross => true,
        // A membrane has no inside.
        Meeting::Touch if i.max(j) as usize >= surface => false,
        Meeting::Touch => {
            let others = star(j);
            star(i)
                .into_iter()
                .any(|a| others.iter().any(|&b| overlap(a, b)))
        }
    };
    met.into_iter()
        .filter(|&(pair, found)| counts(pair, found))
        .map(|(pair, _)| pair)
        .collect()
}

/// Triangles of shells that cross nothing and lie in foreign material.
fn swallowed(points: &[Point], surface: &[[i32; 3]], tree: &Tree, pairs: &[[u32; 2]]) -> Vec<u32> {
    let (shells, of_triangle) = shells(points, surface);
    if shells.len() < 2 {
        return Vec::new();
    }
    let mut crosses = vec![false; shells.len()];
    for &triangle in pairs.as_flattened() {
        if let Some(&shell) = of_triangle.get(triangle as usize) {
            crosses[shell as usize] = true;
        }
    }
    let mut found = Vec::new();
    for (number, shell) in shells.iter().enumerate() {
        if crosses[number] {
            continue;
        }
        let is_own = |t: u32| of_triangle[t as usize] == number as u32;
        let corners = shell.triangles.iter().flat_map(|&t| surface[t as usize]);
        // A vertex on another shell is undecided and is skipped.
        let count = corners
            .filter_map(|v| covering(points, surface, tree, points[v as usize], is_own))
            .next();
        // A cavity lies in the material that it is cut out of.
        let due = i64::from(shell.volume < 0.0);
        if count.is_some_and(|count| count > due) {
            found.extend(&shell.triangles);
        }
    }
    found
}
