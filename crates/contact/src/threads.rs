//! Parallel loops with the same result for any number of threads.

#[cfg(feature = "threads")]
use rayon::prelude::*;

/// Items per task.
#[cfg(feature = "threads")]
const CHUNK: usize = 256;

/// Values of `each(index)` for `0..count`, in this order.
pub(crate) fn map<T: Send>(count: usize, each: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "threads")]
    if count > CHUNK {
        let all = (0..count).into_par_iter().with_min_len(CHUNK);
        return all.map(each).collect();
    }
    (0..count).map(each).collect()
}

/// Both results, computed in parallel if the work is `large` and threads are available.
pub(crate) fn both<T: Send>(
    large: bool,
    first: impl FnOnce() -> T + Send,
    second: impl FnOnce() -> T + Send,
) -> [T; 2] {
    #[cfg(feature = "threads")]
    if large {
        let (first, second) = rayon::join(first, second);
        return [first, second];
    }
    let _ = large;
    [first(), second()]
}
