//! Vertex-to-cell incidence.

/// Numbers of the cells at each vertex, ascending.
pub(crate) struct Incidence {
    starts: Vec<u32>,
    cells: Vec<u32>,
}

impl Incidence {
    pub(crate) fn new<const N: usize>(vertices: usize, cells: &[[i32; N]]) -> Self {
        let mut starts = vec![0_u32; vertices + 1];
        for &vertex in cells.as_flattened() {
            starts[vertex as usize + 1] += 1;
        }
        for vertex in 0..vertices {
            starts[vertex + 1] += starts[vertex];
        }
        let mut next = starts.clone();
        let mut listed = vec![0; cells.len() * N];
        for (number, corners) in cells.iter().enumerate() {
            for &vertex in corners {
                let place = &mut next[vertex as usize];
                listed[*place as usize] = number as u32;
                *place += 1;
            }
        }
        Self {
            starts,
            cells: listed,
        }
    }

    /// Cells at a vertex.
    pub(crate) fn of(&self, vertex: i32) -> &[u32] {
        let vertex = vertex as usize;
        &self.cells[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }
}
