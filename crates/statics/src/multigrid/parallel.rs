//! Loops over rows on all threads that give the same bits for any number of them.

#[cfg(feature = "threads")]
use rayon::prelude::*;

/// Rows that one task handles.
const CHUNK: usize = 512;

/// Calls `each(index, item)` for all items.
pub(crate) fn for_each<T: Send>(items: &mut [T], each: impl Fn(usize, &mut T) + Sync) {
    let run = |(chunk, items): (usize, &mut [T])| {
        for (place, item) in items.iter_mut().enumerate() {
            each(chunk * CHUNK + place, item);
        }
    };
    #[cfg(feature = "threads")]
    if items.len() > CHUNK {
        items.par_chunks_mut(CHUNK).enumerate().for_each(run);
        return;
    }
    items.chunks_mut(CHUNK).enumerate().for_each(run);
}

/// Calls `each(index, array)` for all arrays of `N` that follow each other in `items`.
pub(crate) fn for_each_chunk<T: Send, const N: usize>(
    items: &mut [T],
    each: impl Fn(usize, &mut [T; N]) + Sync,
) {
    let (arrays, _) = items.as_chunks_mut::<N>();
    for_each(arrays, each);
}

/// The sum of `each(index)` over `0..count`, always added in the same order.
pub(crate) fn sum(count: usize, each: impl Fn(usize) -> f64 + Sync) -> f64 {
    let chunks = count.div_ceil(CHUNK);
    let part = |chunk: usize| -> f64 {
        (chunk * CHUNK..((chunk + 1) * CHUNK).min(count))
            .map(&each)
            .sum()
    };
    #[cfg(feature = "threads")]
    let parts: Vec<f64> = (0..chunks).into_par_iter().map(part).collect();
    #[cfg(not(feature = "threads"))]
    let parts: Vec<f64> = (0..chunks).map(part).collect();
    parts.into_iter().sum()
}
