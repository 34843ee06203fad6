//! Position of a vertex in a short sorted list.

/// Longest list that is counted through without branches; longer ones use binary search.
const SHORT: usize = 64;

/// Number of entries of a rising list below `vertex`: its position if it is in the list.
#[inline(always)]
pub(crate) fn rank(list: &[u32], vertex: u32) -> usize {
    if list.len() > SHORT {
        return list.partition_point(|&other| other < vertex);
    }
    list.iter()
        .map(|&other| u32::from(other < vertex))
        .sum::<u32>() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rank_in_short_and_long_lists() {
        for length in [1, 8, 27, SHORT, SHORT + 1, 200] {
            let list: Vec<u32> = (0..length as u32).map(|n| 3 * n + 1).collect();
            for (place, &vertex) in list.iter().enumerate() {
                assert_eq!(rank(&list, vertex), place);
            }
        }
    }
}
