//! Work on many items on all threads, whose results are taken in the order of the items, so that sums have the same
//! bits for any number of threads.

#[cfg(feature = "threads")]
use rayon::prelude::*;

/// Bodies of fewer items than this are quicker on one thread.
#[cfg(feature = "threads")]
const WORTHWHILE: usize = 512;

/// Calls `take(index, each(index))` for all indices in order; `each` runs on all threads, `batch` items at a time,
/// whose results are kept in between.
pub(crate) fn in_order<U: Send>(
    count: usize,
    #[cfg_attr(not(feature = "threads"), expect(unused_variables))] batch: usize,
    each: impl Fn(usize) -> U + Sync,
    mut take: impl FnMut(usize, U),
) {
    #[cfg(feature = "threads")]
    if count >= WORTHWHILE && rayon::current_num_threads() > 1 {
        for start in (0..count).step_by(batch) {
            let end = (start + batch).min(count);
            let results: Vec<U> = (start..end).into_par_iter().map(&each).collect();
            for (index, result) in (start..end).zip(results) {
                take(index, result);
            }
        }
        return;
    }
    for index in 0..count {
        take(index, each(index));
    }
}

/// Variant of [`in_order`] for work on `group` items at a time: `fill(first, results)` sets those of the items from
/// `first` on, and `take(first, results)` gets those of one or more groups.
pub(crate) fn groups_in_order<U: Clone + Send>(
    count: usize,
    #[cfg_attr(not(feature = "threads"), expect(unused_variables))] batch: usize,
    group: usize,
    empty: &U,
    fill: impl Fn(usize, &mut [U]) + Sync,
    mut take: impl FnMut(usize, &[U]),
) {
    #[cfg(feature = "threads")]
    if count >= WORTHWHILE && rayon::current_num_threads() > 1 {
        let mut results = vec![empty.clone(); batch.min(count)];
        for start in (0..count).step_by(batch) {
            let results = &mut results[..batch.min(count - start)];
            results
                .par_chunks_mut(group)
                .enumerate()
                .for_each(|(place, results)| fill(start + place * group, results));
            take(start, results);
        }
        return;
    }
    let mut results = vec![empty.clone(); group];
    for start in (0..count).step_by(group) {
        let results = &mut results[..group.min(count - start)];
        fill(start, results);
        take(start, results);
    }
}
