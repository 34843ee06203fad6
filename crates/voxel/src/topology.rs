//! Faces and edges of tetrahedra, found by sorting.

/// A face with its corners ascending, and its origin: 4 × tet + index in [`FACES`].
pub(crate) type KeyedFace = ([i32; 3], u32);

/// Corners of the faces of a tet of positive volume, outward; face f lies opposite corner f.
pub(crate) const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// All faces of the tets, sorted, so that shared ones are neighbors in the list.
pub(crate) fn sorted_faces(tets: &[[i32; 4]]) -> Vec<KeyedFace> {
    let mut faces: Vec<KeyedFace> = Vec::with_capacity(4 * tets.len());
    for (t, tet) in tets.iter().enumerate() {
        for (f, corners) in FACES.iter().enumerate() {
            let mut key = corners.map(|c| tet[c]);
            key.sort_unstable();
            faces.push((key, 4 * t as u32 + f as u32));
        }
    }
    sort(&mut faces);
    faces
}

/// Face in the outward orientation of its tet.
pub(crate) fn outward_face(tets: &[[i32; 4]], from: u32) -> [i32; 3] {
    let tet = tets[from as usize / 4];
    FACES[from as usize % 4].map(|c| tet[c])
}

/// The edges of the tets, each once, ascending, sorted.
pub(crate) fn unique_edges(tets: &[[i32; 4]]) -> Vec<[i32; 2]> {
    let mut edges = Vec::with_capacity(6 * tets.len());
    for [a, b, c, d] in tets {
        for (&p, &q) in [(a, b), (a, c), (a, d), (b, c), (b, d), (c, d)] {
            edges.push([p.min(q), p.max(q)]);
        }
    }
    sort(&mut edges);
    edges.dedup();
    edges
}

/// The three edges of each triangle as (sorted ends, triangle), sorted.
pub(crate) fn sorted_triangle_edges(triangles: &[[i32; 3]]) -> Vec<([i32; 2], u32)> {
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            edges.push(([p.min(q), p.max(q)], t as u32));
        }
    }
    sort(&mut edges);
    edges
}

/// Sorts on all cores if threads are available; equal keys are ordered by their origin, so the result does not depend
/// on the number of threads.
fn sort<T: Ord + Send>(items: &mut [T]) {
    #[cfg(feature = "threads")]
    rayon::slice::ParallelSliceMut::par_sort_unstable(items);
    #[cfg(not(feature = "threads"))]
    items.sort_unstable();
}
