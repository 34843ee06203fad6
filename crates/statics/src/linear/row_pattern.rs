//! Block sparsity pattern of the tangent of a large body.

use voxsoft_solid::{Problem, Term};

use crate::linear::multigrid::BlockMatrix;

/// Vertices of elements, one after the other.
#[derive(Default)]
struct Pieces {
    vertices: Vec<u32>,
    ends: Vec<usize>,
}

impl Pieces {
    fn push(&mut self, vertices: &[u32]) {
        self.vertices.extend_from_slice(vertices);
        self.ends.push(self.vertices.len());
    }

    fn get(&self, index: usize) -> &[u32] {
        let start = index.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.vertices[start..self.ends[index]]
    }
}

/// Columns of each vertex: the corners of its voxels, and the vertices coupled by membranes and pressures. All vertices
/// of one of the `objects` have the same ones.
pub(crate) fn pattern(problem: &Problem, objects: &[Vec<u32>]) -> BlockMatrix {
    let body = problem.body();
    let count = body.rest().len();
    let mut object_of: Vec<Option<&[u32]>> = vec![None; count];
    for object in objects {
        for &vertex in object {
            object_of[vertex as usize] = Some(object);
        }
    }
    let mut whole = Vec::new();
    let mut elements = Pieces::default();
    if body.ties().is_empty() {
        body.voxels().iter().for_each(|v| elements.push(v));
    } else {
        let hex8s = body.hex8_term();
        hex8s.visit_pattern(&mut |vertices| elements.push(vertices));
    }
    for term in body.terms_beyond_voxels() {
        term.visit_pattern(&mut |vertices| {
            whole.clear();
            whole.extend_from_slice(vertices);
            let touched = vertices.iter().filter_map(|&v| object_of[v as usize]);
            touched.for_each(|object| whole.extend_from_slice(object));
            whole.sort_unstable();
            whole.dedup();
            elements.push(&whole);
        });
    }
    problem.visit_load_pattern(&mut |vertices| elements.push(vertices));
    // Elements at each vertex, then the vertices of those elements.
    let mut starts = vec![0u32; count + 1];
    for &vertex in &elements.vertices {
        starts[vertex as usize + 1] += 1;
    }
    for vertex in 0..count {
        starts[vertex + 1] += starts[vertex];
    }
    let mut next = starts.clone();
    let mut at = vec![0u32; starts[count] as usize];
    for index in 0..elements.ends.len() {
        for &vertex in elements.get(index) {
            at[next[vertex as usize] as usize] = index as u32;
            next[vertex as usize] += 1;
        }
    }
    let mut row_starts = Vec::with_capacity(count + 1);
    row_starts.push(0);
    let mut columns = Vec::with_capacity(27 * count);
    let mut row: Vec<u32> = Vec::new();
    for vertex in 0..count {
        row.clear();
        row.push(vertex as u32);
        for &index in &at[starts[vertex] as usize..starts[vertex + 1] as usize] {
            row.extend_from_slice(elements.get(index as usize));
        }
        row.sort_unstable();
        row.dedup();
        columns.extend_from_slice(&row);
        row_starts.push(columns.len());
    }
    BlockMatrix::with_pattern(&row_starts, &columns)
}
