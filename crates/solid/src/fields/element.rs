//! Elements for the evaluation of fields: voxels, or single tetrahedra where a lattice is not made of voxels.

use std::collections::HashMap;

use crate::Body;
use crate::body::{TET_EDGES, dihedral};

/// A tetrahedron of a lattice, with its six edges and its share in each.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub tet: u32,
    pub edges: [(u32, f64); 6],
}

#[derive(Debug, Clone)]
pub(super) enum Element {
    /// A hyperelastic element of the body, and the voxel of the mesh that it is or contains.
    Hex8(u32, u32),
    Lattice(Vec<Piece>),
}

impl Element {
    /// Calls `found` with the corners, the rest volume in m³ and the element, for all of a body: first hyperelastic
    /// voxels, then those of lattices, then tetrahedra that are no part of a voxel.
    pub fn for_each(body: &Body, mut found: impl FnMut(&[u32], f64, &dyn Fn() -> Self)) {
        for (index, hex8) in body.small_hex8s().iter().enumerate() {
            let element = body.element_of(index) as u32;
            found(&hex8.vertices, hex8.volume(body.material_of(hex8)), &|| {
                Self::Hex8(element, index as u32)
            });
        }
        if body.tets().is_empty() {
            return;
        }
        let pieces = pieces(body);
        let mut left: HashMap<[u32; 4], usize> = body
            .tets()
            .iter()
            .enumerate()
            .map(|(index, tet)| (sorted(tet.vertices), index))
            .collect();
        let volume = |tets: &[usize]| tets.iter().map(|&t| body.tets()[t].volume).sum();
        let element = |tets: &[usize]| {
            let pieces = tets.iter().map(|&t| pieces[t].clone());
            Self::Lattice(pieces.collect())
        };
        for voxel in body.voxels() {
            let tets: Vec<usize> = tets_of(voxel)
                .filter_map(|tet| left.remove(&sorted(tet)))
                .collect();
            if !tets.is_empty() {
                found(voxel, volume(&tets), &|| element(&tets));
            }
        }
        let mut rest: Vec<usize> = left.into_values().collect();
        rest.sort_unstable();
        for tet in rest {
            let corners = body.tets()[tet].vertices;
            found(&corners, volume(&[tet]), &|| element(&[tet]));
        }
    }
}

/// The corners of all tetrahedra of both splits of a voxel: one at each corner, two in the middle.
pub(super) fn tets_of(voxel: &[u32; 8]) -> impl Iterator<Item = [u32; 4]> + '_ {
    let at_corners = (0..8).map(|c| [c, c ^ 1, c ^ 2, c ^ 4]);
    let tets = at_corners.chain([[0, 3, 5, 6], [1, 2, 4, 7]]);
    tets.map(|tet: [usize; 4]| tet.map(|corner| voxel[corner]))
}

pub(super) fn sorted(mut corners: [u32; 4]) -> [u32; 4] {
    corners.sort_unstable();
    corners
}

fn pieces(body: &Body) -> Vec<Piece> {
    let edges: HashMap<[u32; 2], usize> = body
        .edges()
        .iter()
        .enumerate()
        .map(|(index, edge)| (edge.vertices, index))
        .collect();
    let mut turns = vec![0.0; body.edges().len()];
    let mut pieces: Vec<Piece> = Vec::with_capacity(body.tets().len());
    for (index, tet) in body.tets().iter().enumerate() {
        let edges = TET_EDGES.map(|(pair, opposite)| {
            let [a, b] = pair.map(|corner| tet.vertices[corner]);
            let ends = [a.min(b), a.max(b)];
            let apexes = opposite.map(|corner| tet.vertices[corner]);
            let edge = edges[&ends];
            let angle = dihedral(body.rest(), ends, apexes);
            turns[edge] += angle;
            (edge as u32, angle)
        });
        pieces.push(Piece {
            tet: index as u32,
            edges,
        });
    }
    for piece in &mut pieces {
        for (edge, part) in &mut piece.edges {
            *part /= turns[*edge as usize];
        }
    }
    pieces
}
