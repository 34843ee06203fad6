//! Loops over rows on all threads that give the same bits for any number of them.

#[cfg(feature = "threads")]
use rayon::prelude::*;

/// Rows per task.
pub(crate) const CHUNK: usize = 512;

/// Calls `each(index, item)` for all items.
pub(crate) fn for_each<T: Send>(items: &mut [T], each: impl Fn(usize, &mut T) + Sync) {
    for_each_chunk(items, |first, items| {
        for (place, item) in items.iter_mut().enumerate() {
            each(first + place, item);
        }
    });
}

/// Calls `each(first, items)` for at most [`CHUNK`] items at a time, those from `first` on.
pub(crate) fn for_each_chunk<T: Send>(items: &mut [T], each: impl Fn(usize, &mut [T]) + Sync) {
    let run = |(chunk, items): (usize, &mut [T])| each(chunk * CHUNK, items);
    #[cfg(feature = "threads")]
    if items.len() > CHUNK {
        items.par_chunks_mut(CHUNK).enumerate().for_each(run);
        return;
    }
    items.chunks_mut(CHUNK).enumerate().for_each(run);
}

/// Calls `each(own, index, item)` for all items, with a buffer made by `scratch` for each chunk of items.
pub(crate) fn for_each_with<T: Send, W>(
    items: &mut [T],
    scratch: impl Fn() -> W + Sync,
    each: impl Fn(&mut W, usize, &mut T) + Sync,
) {
    let run = |(chunk, items): (usize, &mut [T])| {
        let mut own = scratch();
        for (place, item) in items.iter_mut().enumerate() {
            each(&mut own, chunk * CHUNK + place, item);
        }
    };
    #[cfg(feature = "threads")]
    if items.len() > CHUNK {
        items.par_chunks_mut(CHUNK).enumerate().for_each(run);
        return;
    }
    items.chunks_mut(CHUNK).enumerate().for_each(run);
}

/// Calls `each(index, item)` for few items with much work each.
pub(crate) fn for_each_large<T: Send>(items: &mut [T], each: impl Fn(usize, &mut T) + Sync) {
    #[cfg(feature = "threads")]
    items
        .par_iter_mut()
        .enumerate()
        .for_each(|(index, item)| each(index, item));
    #[cfg(not(feature = "threads"))]
    items
        .iter_mut()
        .enumerate()
        .for_each(|(index, item)| each(index, item));
}

/// Sum of `each(index)` over `0..count`, always added in the same order.
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
