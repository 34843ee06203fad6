//! Where a vertex is in a short list.

/// Lists up to this length are counted through, which takes no branches; longer ones are searched.
const SHORT: usize = 64;

/// How many of a rising list are less than `vertex`: the place of a vertex that it has.
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
    fn every_vertex_has_its_place_in_short_and_long_lists() {
        for length in [1, 8, 27, SHORT, SHORT + 1, 200] {
            let list: Vec<u32> = (0..length as u32).map(|n| 3 * n + 1).collect();
            for (place, &vertex) in list.iter().enumerate() {
                assert_eq!(rank(&list, vertex), place);
            }
        }
    }
}
