//! Work that is done plane by plane, on all cores where there are threads.

/// Joins what `make` gives for plane 0, 1, …, in this order for any number of threads.
pub(crate) fn by_plane<T: Send>(
    planes: usize,
    make: impl Fn(usize) -> Vec<T> + Sync + Send,
) -> Vec<T> {
    #[cfg(feature = "threads")]
    let pieces: Vec<Vec<T>> = {
        use rayon::prelude::*;
        (0..planes).into_par_iter().map(make).collect()
    };
    #[cfg(not(feature = "threads"))]
    let pieces: Vec<Vec<T>> = (0..planes).map(make).collect();

    let mut joined = Vec::with_capacity(pieces.iter().map(Vec::len).sum());
    for mut piece in pieces {
        joined.append(&mut piece);
    }
    joined
}
