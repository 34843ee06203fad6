//! Samples of contact surfaces.

use std::collections::BTreeMap;

use voxsoft_solid::vector::Vec3;

use crate::gap::area;
use crate::surface::Surface;

/// Contact sample: a point or an edge of a surface, at which the gap is measured.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sample {
    /// Points at its ends, as numbered over all surfaces; a point is both.
    pub ends: [u32; 2],
    /// Area that it stands for in the unloaded body, m²; none for an edge, whose ends have it.
    pub area: f64,
    /// Surface of the sample.
    pub surface: u32,
    /// Triangles that contain it, as numbered over all surfaces.
    pub triangles: Vec<u32>,
}

impl Sample {
    /// Tests whether it is an edge, not a point.
    pub fn is_edge(&self) -> bool {
        self.ends[0] != self.ends[1]
    }
}

/// Points of a surface as samples, each with a third of the area of the triangles around it; `first` are the numbers of
/// its first point and triangle.
pub(super) fn samples(
    surface: &Surface,
    number: u32,
    first: (u32, u32),
    rest: &[Vec3],
) -> Vec<Sample> {
    let sample = |point: u32| Sample {
        ends: [first.0 + point; 2],
        area: 0.0,
        surface: number,
        triangles: Vec::new(),
    };
    let mut samples: Vec<Sample> = (0..surface.points.len() as u32).map(sample).collect();
    for (t, triangle) in surface.triangles.iter().enumerate() {
        let corners = triangle.map(|p| surface.points[p as usize].at(rest));
        for point in triangle {
            let sample = &mut samples[*point as usize];
            sample.area += area(corners) / 3.0;
            sample.triangles.push(first.1 + t as u32);
        }
    }
    samples
}

/// Edges of the triangles of all surfaces as samples, in the order of their ends.
pub(super) fn edges(triangles: &[[u32; 3]], surface_of: &[u32]) -> Vec<Sample> {
    let mut edges: BTreeMap<[u32; 2], Sample> = BTreeMap::new();
    for (t, [a, b, c]) in triangles.iter().copied().enumerate() {
        let sides = [(a, b), (b, c), (c, a)];
        // A triangle of a damaged file may have a corner twice.
        for (from, to) in sides.into_iter().filter(|(from, to)| from != to) {
            let ends = [from.min(to), from.max(to)];
            let edge = edges.entry(ends).or_insert_with(|| Sample {
                ends,
                area: 0.0,
                surface: surface_of[t],
                triangles: Vec::new(),
            });
            edge.triangles.push(t as u32);
        }
    }
    edges.into_values().collect()
}
