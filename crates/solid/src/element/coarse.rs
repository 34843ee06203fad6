//! Coarse elements: cubes of eight voxels that are one element, where refinement is not needed.
//!
//! The mesh is that of the small voxels, so that searches for places need not change. A cube of `2 × 2 × 2` full ones
//! of one material is one element with the eight outer corners; the vertices between these are hanging nodes, tied to
//! them ([`crate::element::ties`]), in the cube and where it meets small voxels. Masses go from tied vertices to their
//! masters: the mass and its center are kept.

use std::collections::HashSet;

use crate::element::faces::FaceConditions;
use crate::element::free_faces::is_full;
use crate::element::reentrant_edges::ReentrantEdges;
use crate::element::ties::Ties;
use crate::{Filling, Hex8, ProblemError};

/// Sum of the numbers of opposite corners.
const ACROSS: usize = 7;

/// All small voxels, and their grouping into elements.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Coarse {
    /// The small voxels; empty where each is an element of its own.
    pub small: Vec<Hex8>,
    /// The element of each small voxel.
    pub element: Vec<u32>,
    /// Members of each element: one small voxel, or eight in the order of corners.
    members: Vec<Members>,
}

#[derive(Debug, Clone, PartialEq)]
enum Members {
    One(u32),
    Eight([u32; 8]),
}

impl Coarse {
    /// Builds elements and ties from small voxels, those of each group forming one cube.
    pub fn of(
        small: Vec<Hex8>,
        groups: &[[u32; 8]],
        vertices: usize,
    ) -> Result<(Self, Vec<Hex8>, Ties), ProblemError> {
        let mut group_of: Vec<Option<usize>> = vec![None; small.len()];
        let mut cubes = Vec::with_capacity(groups.len());
        for (index, group) in groups.iter().enumerate() {
            let members = in_order(&small, group).ok_or(ProblemError::NotOneCube { index })?;
            for member in members {
                if group_of[member as usize].replace(index).is_some() {
                    return Err(ProblemError::NotOneCube { index });
                }
            }
            cubes.push(members);
        }
        let each = |members: &[u32; 8]| ties_of(members.map(|member| small[member as usize]));
        let ties = Ties::new(vertices, cubes.iter().flat_map(each));
        let outer = |members: &[u32; 8]| {
            std::array::from_fn(|corner| small[members[corner] as usize].vertices[corner])
        };
        // Cubes that are not on one grid of large voxels would have tied corners.
        let hangs = |members: &[u32; 8]| {
            let outer: [u32; 8] = outer(members);
            outer.iter().any(|vertex| ties.has(*vertex))
        };
        if let Some(index) = cubes.iter().position(hangs) {
            return Err(ProblemError::NotOneCube { index });
        }
        let (mut elements, mut members) = (Vec::new(), Vec::new());
        let mut element = vec![u32::MAX; small.len()];
        for (index, hex8) in small.iter().enumerate() {
            if element[index] != u32::MAX {
                continue;
            }
            let own = elements.len() as u32;
            if let Some(group) = group_of[index] {
                let cube = cubes[group];
                cube.iter()
                    .for_each(|member| element[*member as usize] = own);
                let fraction = cube.map(|member| small[member as usize].fraction);
                elements.push(Hex8 {
                    vertices: outer(&cube),
                    side: 2.0 * hex8.side,
                    fraction: fraction.iter().sum::<f64>() / 8.0,
                    filling: Filling::FULL,
                    ..*hex8
                });
                members.push(Members::Eight(cube));
            } else {
                element[index] = own;
                elements.push(*hex8);
                members.push(Members::One(index as u32));
            }
        }
        let own = Self {
            small,
            element,
            members,
        };
        Ok((own, elements, ties))
    }

    /// Tests whether there is no coarse element.
    pub fn is_empty(&self) -> bool {
        self.small.is_empty()
    }

    /// Sets the filled fractions of the small voxels, and those of the elements to their means.
    pub fn fill(&mut self, fractions: &[f64], elements: &mut [Hex8]) {
        for (hex8, fraction) in self.small.iter_mut().zip(fractions) {
            hex8.fraction = *fraction;
        }
        for (element, members) in elements.iter_mut().zip(&self.members) {
            let fraction = |index: &u32| self.small[*index as usize].fraction;
            element.fraction = match members {
                Members::One(index) => fraction(index),
                Members::Eight(cube) => cube.iter().map(fraction).sum::<f64>() / 8.0,
            };
        }
    }

    /// The faces and re-entrant edges of each element, merged from those of the small voxels.
    pub fn merged(
        &self,
        faces: &[Option<FaceConditions>],
        edges: &[ReentrantEdges],
    ) -> (Vec<Option<FaceConditions>>, Vec<ReentrantEdges>) {
        let each = self.members.iter().map(|members| match members {
            Members::One(index) => (faces[*index as usize], edges[*index as usize]),
            Members::Eight(cube) => {
                let all: Option<Vec<FaceConditions>> =
                    cube.iter().map(|index| faces[*index as usize]).collect();
                let has = |axis: usize| cube.iter().any(|index| edges[*index as usize][axis]);
                (all.map(|all| face_of_cube(&all)), [0, 1, 2].map(has))
            }
        });
        each.unzip()
    }
}

/// Merges the faces of a cube: a face is free, or held in full, where its four parts are; it is stiff or under pressure
/// where one of them is.
fn face_of_cube(all: &[FaceConditions]) -> FaceConditions {
    let mut own = FaceConditions::default();
    for axis in 0..3 {
        for side in 0..2 {
            let on_face = |corner: &usize| corner >> (2 - axis) & 1 == side;
            let parts = || (0..8).filter(on_face).map(|corner| &all[corner]);
            own.free[axis][side] = parts().all(|faces| faces.free[axis][side]);
            own.held[axis][side] = parts().all(|faces| faces.held[axis][side]);
            own.covered[axis][side] = parts().any(|faces| faces.covered[axis][side]);
            own.stiff[axis][side] = parts().any(|faces| faces.stiff[axis][side]);
            own.pressed[axis][side] = parts().any(|faces| faces.pressed[axis][side]);
        }
    }
    own
}

/// The voxels of a group in the order of the corners of their cube; `None` if they do not form one, full and of one
/// material.
fn in_order(small: &[Hex8], group: &[u32; 8]) -> Option<[u32; 8]> {
    let first = small.get(group[0] as usize)?;
    let hex8s = group.map(|index| small.get(index as usize));
    let alike = |hex8: &&Hex8| hex8.material == first.material && is_full(hex8);
    if !hex8s.iter().all(|hex8| hex8.as_ref().is_some_and(alike)) {
        return None;
    }
    let each = || hex8s.iter().flatten();
    // The vertex in the middle is a corner of all of them.
    let is_middle = |vertex: &u32| each().all(|hex8| hex8.vertices.contains(vertex));
    let middle = *first.vertices.iter().find(|vertex| is_middle(vertex))?;
    let mut found = [u32::MAX; 8];
    for (hex8, index) in each().zip(group) {
        let at_middle = hex8.vertices.iter().position(|v| *v == middle)?;
        found[ACROSS - at_middle] = *index;
    }
    let nodes: HashSet<u32> = each().flat_map(|hex8| hex8.vertices).collect();
    (!found.contains(&u32::MAX) && nodes.len() == 27).then_some(found)
}

/// The ties of the vertices of a cube that are not its corners.
fn ties_of(members: [Hex8; 8]) -> Vec<(u32, Vec<u32>)> {
    let corner = |c: usize| members[c].vertices[c];
    let mut found = Vec::with_capacity(19);
    let mut seen = HashSet::new();
    for (at, member) in members.iter().enumerate() {
        for (own, &vertex) in member.vertices.iter().enumerate() {
            // Along an axis where the two differ the vertex is half way, elsewhere at the side of both.
            let between = at ^ own;
            if between != 0 && seen.insert(vertex) {
                let fixed = at & !between;
                let leads = |c: &usize| c & !between == fixed;
                found.push((vertex, (0..8).filter(leads).map(corner).collect()));
            }
        }
    }
    found
}
