//! Ties of hanging nodes: vertices that follow others, so that voxels of two sizes fit together.
//!
//! A voxel that meets four of half its size leaves vertices of these on its face and edges. They would move on their
//! own and the body would gape. They are tied instead: the position of each is the mean of the two or four corners
//! between which it lies, as it is in the large voxel. All that acts on positions then does so through `x = T q`, with
//! `q` the free coordinates, the positions of the vertices that are not tied: an energy `E(T q)` has the forces `Tᵀ f`
//! and the stiffness `Tᵀ K T`. Tied vertices carry neither force nor mass of their own.
//!
//! Weights are positive and add up to one, and the leaders of a tie are never tied themselves. So uniform strains and
//! rigid motions are exact, and forces and their moments are kept.

use std::borrow::Cow;

use crate::ProblemError;
use crate::assembly::{Elements, ElementsVisitor, Visitor};
use crate::vector::{Vec3, axpy};

/// All ties of a body: tied vertices and their leaders.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ties {
    /// For each vertex of the body, the index of its tie; empty where nothing is tied.
    place: Vec<u32>,
    tied: Vec<Tie>,
}

/// A vertex that is the mean of others.
#[derive(Debug, Clone, PartialEq)]
struct Tie {
    vertex: u32,
    leaders: Vec<u32>,
}

const FREE: u32 = u32::MAX;

impl Ties {
    /// Ties of vertices, each the mean of its leaders, among `count`; if a vertex comes again its first tie counts.
    pub(crate) fn new(count: usize, ties: impl Iterator<Item = (u32, Vec<u32>)>) -> Self {
        let mut own = Self {
            place: vec![FREE; count],
            tied: Vec::new(),
        };
        for (vertex, leaders) in ties {
            let place = &mut own.place[vertex as usize];
            if *place == FREE {
                *place = own.tied.len() as u32;
                own.tied.push(Tie { vertex, leaders });
            }
        }
        if own.tied.is_empty() {
            own.place.clear();
        }
        own
    }

    /// Tests whether nothing is tied.
    pub fn is_empty(&self) -> bool {
        self.tied.is_empty()
    }

    /// The tied vertices.
    pub fn vertices(&self) -> impl Iterator<Item = u32> + '_ {
        self.tied.iter().map(|tie| tie.vertex)
    }

    /// Tests whether a vertex is tied.
    pub fn has(&self, vertex: u32) -> bool {
        self.tie(vertex).is_some()
    }

    /// The leaders of a vertex, itself if it is free.
    pub(crate) fn leaders<'a>(&'a self, vertex: &'a u32) -> &'a [u32] {
        self.tie(*vertex)
            .map_or(std::slice::from_ref(vertex), |tie| &tie.leaders)
    }

    fn tie(&self, vertex: u32) -> Option<&Tie> {
        let place = *self.place.get(vertex as usize)?;
        (place != FREE).then(|| &self.tied[place as usize])
    }

    /// Applies `T` in place: sets tied vertices to the means of their leaders; displacements likewise.
    pub fn follow(&self, vectors: &mut [Vec3]) {
        for tie in &self.tied {
            let mut mean = [0.0; 3];
            for &leader in &tie.leaders {
                axpy(&mut mean, tie.weight(), vectors[leader as usize]);
            }
            vectors[tie.vertex as usize] = mean;
        }
    }

    /// Vectors with those of tied vertices set to the means of their leaders.
    pub fn seen<'a>(&self, vectors: &'a [Vec3]) -> Cow<'a, [Vec3]> {
        if self.is_empty() {
            return Cow::Borrowed(vectors);
        }
        let mut followed = vectors.to_vec();
        self.follow(&mut followed);
        Cow::Owned(followed)
    }

    /// Applies `Tᵀ` in place: moves forces or derivatives from tied vertices to their leaders.
    pub fn hand_over(&self, vectors: &mut [Vec3]) {
        for tie in &self.tied {
            let own = std::mem::take(&mut vectors[tie.vertex as usize]);
            for &leader in &tie.leaders {
                axpy(&mut vectors[leader as usize], tie.weight(), own);
            }
        }
    }

    /// Applies `Tᵀ` in place to numbers such as masses.
    pub(crate) fn hand_over_numbers(&self, numbers: &mut [f64]) {
        for tie in &self.tied {
            let own = std::mem::take(&mut numbers[tie.vertex as usize]);
            for &leader in &tie.leaders {
                numbers[leader as usize] += tie.weight() * own;
            }
        }
    }

    /// Refuses a term or load on tied vertices that does not handle ties.
    pub(crate) fn check_free(
        &self,
        what: &'static str,
        visit_pattern: impl FnOnce(&mut dyn FnMut(&[u32])),
    ) -> Result<(), ProblemError> {
        let mut found = None;
        if !self.is_empty() {
            visit_pattern(&mut |vertices| {
                found = found.or_else(|| vertices.iter().copied().find(|v| self.has(*v)));
            });
        }
        match found {
            Some(vertex) => Err(ProblemError::OnTied { what, vertex }),
            None => Ok(()),
        }
    }

    /// Visits the free vertices that an element couples.
    pub(crate) fn visit_pattern(&self, corners: &[u32], visit: &mut dyn FnMut(&[u32])) {
        if corners.iter().any(|corner| self.has(*corner)) {
            visit(&self.joined(corners));
        } else {
            visit(corners);
        }
    }

    /// Visits an element matrix, as `Tᵀ K T` if it has tied vertices.
    pub(crate) fn visit(&self, corners: &[u32], matrix: &[f64], visit: Visitor<'_>) {
        if !corners.iter().any(|corner| self.has(*corner)) {
            visit(corners, matrix);
            return;
        }
        let vertices = self.joined(corners);
        // For each corner, the indices of its leaders.
        let places: Vec<(Vec<usize>, f64)> = corners
            .iter()
            .map(|corner| {
                let leaders = self.leaders(corner);
                let found = leaders
                    .iter()
                    .map(|leader| vertices.partition_point(|vertex| vertex < leader));
                (found.collect(), 1.0 / leaders.len() as f64)
            })
            .collect();
        let (size, own) = (3 * corners.len(), 3 * vertices.len());
        let mut found = vec![0.0; own * own];
        for (at, value) in matrix.iter().enumerate() {
            let (row, column) = (at / size, at % size);
            let ((rows, by_row), (columns, by_column)) = (&places[row / 3], &places[column / 3]);
            let part = by_row * by_column * value;
            for r in rows {
                for c in columns {
                    found[(3 * r + row % 3) * own + 3 * c + column % 3] += part;
                }
            }
        }
        visit(&vertices, &found);
    }

    /// Visits many element matrices: those without tied vertices stay together, as many as there are.
    pub(crate) fn visit_elements(&self, elements: Elements<'_>, visit: ElementsVisitor<'_>) {
        if self.is_empty() {
            visit(elements);
            return;
        }
        let width = elements.width;
        let (mut vertices, mut matrices) = (Vec::new(), Vec::new());
        for (corners, matrix) in elements.iter() {
            if corners.iter().any(|corner| self.has(*corner)) {
                self.visit(corners, matrix, &mut |vertices, matrices| {
                    visit(Elements {
                        width: vertices.len(),
                        vertices,
                        matrices,
                    });
                });
            } else {
                vertices.extend_from_slice(corners);
                matrices.extend_from_slice(matrix);
            }
        }
        visit(Elements {
            width,
            vertices: &vertices,
            matrices: &matrices,
        });
    }

    /// The leaders of some vertices, each once, in order.
    fn joined(&self, corners: &[u32]) -> Vec<u32> {
        let each = corners.iter().flat_map(|corner| self.leaders(corner));
        let mut vertices: Vec<u32> = each.copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }
}

impl Tie {
    fn weight(&self) -> f64 {
        1.0 / self.leaders.len() as f64
    }
}
