//! Sums of blocks times vectors over a row, the inner loops of all iterative solutions.
//!
//! The nine numbers of a block are nine lanes, `3 j + i` for row `i` and column `j`, each with a sum of its own over the
//! blocks of a row; three lanes make a coordinate at the end. A block's numbers lie one after the other, so that eight
//! lanes are one register of AVX2, which is found at run time. The order of the sums and their roundings are the same
//! everywhere (no product is fused with a sum), so that every processor, and a page, gives the same bits.
//!
//! Blocks are fetched some rows ahead: a processor's own prefetching stops at the end of each page of memory.

use std::ops::Range;

use pulp::NullaryFnOnce;
use voxsoft_solid::vector::Vec3;

/// Vector on a node; the fourth place fills a register, and is zero.
pub(crate) type Single = [f32; 4];

/// Numbers of a block.
pub(crate) const BLOCK: usize = 9;

/// Coordinate of the vector that each of the first eight lanes is multiplied with.
const COORDINATES: [usize; 8] = [0, 0, 0, 1, 1, 1, 2, 2];
/// Blocks from one to the one that is fetched meanwhile: two rows of a full grid, or four halves.
const AHEAD: usize = 54;

/// Places of the blocks of each row that are summed: all but the first `skip`.
#[derive(Clone, Copy)]
pub(crate) struct Span<'a> {
    pub starts: &'a [usize],
    pub skip: usize,
}

impl Span<'_> {
    /// Places in a row.
    #[inline(always)]
    fn places(&self, row: usize) -> Range<usize> {
        self.starts[row] + self.skip..self.starts[row + 1]
    }
}

/// Sums of the rows from `first` on, of rounded blocks.
pub(crate) struct Rounded<'a> {
    pub blocks: &'a [[f32; BLOCK]],
    /// Column of each block.
    pub columns: &'a [u32],
    pub span: Span<'a>,
    /// Vectors of the columns from `from` on.
    pub x: &'a [Single],
    pub from: usize,
}

/// Sums of the rows from `first` on, of blocks that are each the sum of two.
pub(crate) struct Whole<'a> {
    pub high: &'a [[f32; BLOCK]],
    pub low: &'a [[f32; BLOCK]],
    /// Column of each block.
    pub columns: &'a [u32],
    pub span: Span<'a>,
    pub x: &'a [Vec3],
}

/// Sums over rows of one kind.
trait Sums {
    type Sum;

    /// Sum over the blocks at `places`.
    fn sum<L: Lanes>(&self, lanes: L, places: Range<usize>) -> Self::Sum;

    fn span(&self) -> Span<'_>;
}

impl Sums for Rounded<'_> {
    type Sum = Single;

    #[inline(always)]
    fn sum<L: Lanes>(&self, lanes: L, places: Range<usize>) -> Single {
        let columns = &self.columns[places.clone()];
        lanes.rounded(&self.blocks[places], columns, self.from, self.x)
    }

    #[inline(always)]
    fn span(&self) -> Span<'_> {
        self.span
    }
}

impl Sums for Whole<'_> {
    type Sum = Vec3;

    #[inline(always)]
    fn sum<L: Lanes>(&self, lanes: L, places: Range<usize>) -> Vec3 {
        let columns = &self.columns[places.clone()];
        let (high, low) = (&self.high[places.clone()], &self.low[places]);
        lanes.whole(high, low, columns, self.x)
    }

    #[inline(always)]
    fn span(&self) -> Span<'_> {
        self.span
    }
}

impl Rounded<'_> {
    /// Sets the sums of the rows from `first` on.
    pub fn set(&self, first: usize, sums: &mut [Single]) {
        set(self, first, sums);
    }
}

impl Whole<'_> {
    /// Sets the sums of the rows from `first` on.
    pub fn set(&self, first: usize, sums: &mut [Vec3]) {
        set(self, first, sums);
    }
}

/// Loop over rows, compiled for the lanes it is given.
struct Loop<'a, L, S: Sums> {
    lanes: L,
    of: &'a S,
    first: usize,
    sums: &'a mut [S::Sum],
}

impl<L: Lanes, S: Sums> NullaryFnOnce for Loop<'_, L, S> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let span = self.of.span();
        for (row, sum) in self.sums.iter_mut().enumerate() {
            *sum = self.of.sum(self.lanes, span.places(self.first + row));
        }
    }
}

/// Sets sums on the widest lanes of the processor.
fn set<S: Sums>(of: &S, first: usize, sums: &mut [S::Sum]) {
    #[cfg(target_arch = "x86_64")]
    if let Some(lanes) = pulp::x86::V3::try_new() {
        return pulp::Simd::vectorize(
            lanes,
            Loop {
                lanes,
                of,
                first,
                sums,
            },
        );
    }
    let lanes = Portable;
    Loop {
        lanes,
        of,
        first,
        sums,
    }
    .call();
}

/// Lanes of a processor.
trait Lanes: Copy {
    /// Sum of `blocks` times the vectors of `columns`, of which `x` holds those from `from` on.
    fn rounded(self, blocks: &[[f32; BLOCK]], columns: &[u32], from: usize, x: &[Single])
    -> Single;

    /// Sum of blocks, each the sum of two, times the vectors of `columns`.
    fn whole(
        self,
        high: &[[f32; BLOCK]],
        low: &[[f32; BLOCK]],
        columns: &[u32],
        x: &[Vec3],
    ) -> Vec3;
}

/// Runs a loop that is compiled for the widest registers of the processor.
pub(crate) fn vectorized<F: NullaryFnOnce>(run: F) -> F::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(lanes) = pulp::x86::V3::try_new() {
        return pulp::Simd::vectorize(lanes, run);
    }
    run.call()
}

/// Starts to fetch the memory at an address, which need not exist.
#[inline(always)]
pub(super) fn fetch<T>(at: *const T) {
    #[cfg(target_arch = "x86_64")]
    if let Some(sse) = pulp::core_arch::x86::Sse::try_new() {
        sse._mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(at.cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = at;
}

/// Starts to fetch the block [`AHEAD`].
#[inline(always)]
fn fetch_ahead(block: &[f32; BLOCK]) {
    fetch(std::ptr::from_ref(block).wrapping_add(AHEAD));
}

/// Lanes in a loop.
#[derive(Clone, Copy)]
struct Portable;

impl Lanes for Portable {
    #[inline(always)]
    fn rounded(
        self,
        blocks: &[[f32; BLOCK]],
        columns: &[u32],
        from: usize,
        x: &[Single],
    ) -> Single {
        let (mut sums, mut last) = ([0.0; 8], 0.0);
        for (block, &column) in blocks.iter().zip(columns) {
            fetch_ahead(block);
            let x = x[column as usize - from];
            for lane in 0..8 {
                sums[lane] += block[lane] * x[COORDINATES[lane]];
            }
            last += block[8] * x[2];
        }
        let [x, y, z] = added(sums, last);
        [x, y, z, 0.0]
    }

    #[inline(always)]
    fn whole(
        self,
        high: &[[f32; BLOCK]],
        low: &[[f32; BLOCK]],
        columns: &[u32],
        x: &[Vec3],
    ) -> Vec3 {
        let (mut sums, mut last) = ([0.0; 8], 0.0);
        for ((high, low), &column) in high.iter().zip(low).zip(columns) {
            fetch_ahead(high);
            fetch_ahead(low);
            let x = x[column as usize];
            for lane in 0..8 {
                let number = f64::from(high[lane]) + f64::from(low[lane]);
                sums[lane] += number * x[COORDINATES[lane]];
            }
            last += (f64::from(high[8]) + f64::from(low[8])) * x[2];
        }
        added(sums, last)
    }
}

/// Coordinates of the sums of nine lanes.
#[inline(always)]
fn added<T: Copy + std::ops::Add<Output = T>>(sums: [T; 8], last: T) -> [T; 3] {
    [
        sums[0] + (sums[3] + sums[6]),
        sums[1] + (sums[4] + sums[7]),
        sums[2] + (sums[5] + last),
    ]
}

/// Lanes in registers of AVX2.
#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::{__m128, __m256, __m256d};

    use pulp::cast;
    use pulp::x86::V3;

    use super::{BLOCK, COORDINATES, Lanes, Single, Vec3, added, fetch_ahead};

    impl Lanes for V3 {
        #[inline(always)]
        fn rounded(
            self,
            blocks: &[[f32; BLOCK]],
            columns: &[u32],
            from: usize,
            x: &[Single],
        ) -> Single {
            let coordinates = cast(COORDINATES.map(|coordinate| coordinate as u32));
            let mut sums: __m256 = self.avx._mm256_setzero_ps();
            let mut last = 0.0;
            let mut add = |block: &[f32; BLOCK], column: u32| {
                let x = x[column as usize - from];
                let own = self.avx._mm256_castps128_ps256(cast(x));
                let factors = self.avx2._mm256_permutevar8x32_ps(own, coordinates);
                let products = self.avx._mm256_mul_ps(cast(eight(block)), factors);
                sums = self.avx._mm256_add_ps(sums, products);
                last += block[8] * x[2];
            };
            // Two blocks are little more than a line of the cache.
            let (pairs, rest) = blocks.as_chunks::<2>();
            let (pairs_of_columns, last_column) = columns.as_chunks::<2>();
            for (pair, columns) in pairs.iter().zip(pairs_of_columns) {
                fetch_ahead(&pair[0]);
                add(&pair[0], columns[0]);
                add(&pair[1], columns[1]);
            }
            if let ([block], [column]) = (rest, last_column) {
                add(block, *column);
            }
            let [x, y, z] = added(cast::<_, [f32; 8]>(sums), last);
            [x, y, z, 0.0]
        }

        #[inline(always)]
        fn whole(
            self,
            high: &[[f32; BLOCK]],
            low: &[[f32; BLOCK]],
            columns: &[u32],
            x: &[Vec3],
        ) -> Vec3 {
            let avx = self.avx;
            let mut sums: [__m256d; 2] = [avx._mm256_setzero_pd(); 2];
            let mut last = 0.0;
            for ((high, low), &column) in high.iter().zip(low).zip(columns) {
                fetch_ahead(high);
                fetch_ahead(low);
                let x = x[column as usize];
                let of: [__m256d; 3] = x.map(|x| avx._mm256_set1_pd(x));
                let factors = [
                    avx._mm256_blend_pd::<0b1000>(of[0], of[1]),
                    avx._mm256_blend_pd::<0b1100>(of[1], of[2]),
                ];
                let [high4, low4]: [[__m128; 2]; 2] = [cast(eight(high)), cast(eight(low))];
                for half in 0..2 {
                    let numbers = avx._mm256_add_pd(
                        avx._mm256_cvtps_pd(high4[half]),
                        avx._mm256_cvtps_pd(low4[half]),
                    );
                    let products = avx._mm256_mul_pd(numbers, factors[half]);
                    sums[half] = avx._mm256_add_pd(sums[half], products);
                }
                last += (f64::from(high[8]) + f64::from(low[8])) * x[2];
            }
            added(cast::<_, [f64; 8]>(sums), last)
        }
    }

    #[inline(always)]
    fn eight(block: &[f32; BLOCK]) -> [f32; 8] {
        std::array::from_fn(|lane| block[lane])
    }
}

#[cfg(test)]
mod tests {
    use voxsoft_solid::conformance::numbers::random;

    use super::*;

    /// Rows of 0 to 108 blocks, with rising columns among as many vectors.
    struct Random {
        starts: Vec<usize>,
        columns: Vec<u32>,
        high: Vec<[f32; BLOCK]>,
        low: Vec<[f32; BLOCK]>,
        x: Vec<Vec3>,
    }

    impl Random {
        fn new() -> Self {
            let lengths = [27, 0, 1, 2, 13, 14, 108, 8, 3, 26];
            let (mut starts, mut columns) = (vec![0], Vec::new());
            for (row, &length) in lengths.iter().enumerate() {
                columns.extend((0..length).map(|place| 10 + (2 * place + row as u32) % 300));
                starts.push(columns.len());
            }
            let numbers: Vec<f64> = random(3 * columns.len(), 5).into_flattened();
            let high = |number: f64| number as f32;
            let low = |number: f64| (number - f64::from(number as f32)) as f32;
            let (blocks, _) = numbers.as_chunks::<BLOCK>();
            Self {
                high: blocks.iter().map(|block| block.map(high)).collect(),
                low: blocks.iter().map(|block| block.map(low)).collect(),
                starts,
                columns,
                x: random(310, 6),
            }
        }

        fn rounded_x(&self) -> Vec<Single> {
            let rounded = |x: &Vec3| [x[0] as f32, x[1] as f32, x[2] as f32, f32::NAN];
            self.x.iter().map(rounded).collect()
        }

        /// Sums in double precision of `number(place, entry)` times `x`, and of their absolute values.
        fn plain(
            &self,
            places: Range<usize>,
            number: impl Fn(usize, usize) -> f64,
            x: impl Fn(usize) -> Vec3,
        ) -> [(f64, f64); 3] {
            std::array::from_fn(|i| {
                let terms = places.clone().flat_map(|place| {
                    let x = x(self.columns[place] as usize);
                    let number = &number;
                    (0..3).map(move |j| number(place, 3 * j + i) * x[j])
                });
                let terms: Vec<f64> = terms.collect();
                (
                    terms.iter().sum(),
                    terms.iter().map(|term| term.abs()).sum(),
                )
            })
        }
    }

    /// Error of a sum of `count` products in any order, relative to the sum of absolute values (Higham 2002, section
    /// 3.1), for a unit roundoff `u`.
    fn allowed(count: usize, u: f64) -> f64 {
        let n = count as f64 + 2.0;
        n * u / (1.0 - n * u)
    }

    #[test]
    fn rounded_sums_are_plain_ones_on_every_processor() {
        let random = Random::new();
        let x = random.rounded_x();
        for (skip, from) in [(0, 0), (0, 10), (1, 10)] {
            // A row without blocks has no diagonal to leave out.
            let starts = if skip == 0 {
                &random.starts[..]
            } else {
                &random.starts[2..]
            };
            let of = Rounded {
                blocks: &random.high,
                columns: &random.columns,
                span: Span { starts, skip },
                x: &x[from..],
                from,
            };
            let mut sums = vec![[9.0; 4]; starts.len() - 1];
            of.set(0, &mut sums);
            for (row, sum) in sums.iter().enumerate() {
                let places = of.span.places(row);
                assert_eq!(*sum, of.sum(Portable, places.clone()));
                let wide = |column: usize| x[column].map(f64::from)[..3].try_into().unwrap();
                let number = |place: usize, k: usize| f64::from(random.high[place][k]);
                let plain = random.plain(places.clone(), number, wide);
                for (i, (exact, size)) in plain.into_iter().enumerate() {
                    let off = (f64::from(sum[i]) - exact).abs();
                    assert!(off <= allowed(3 * places.len(), f64::powi(2.0, -24)) * size);
                }
                assert_eq!(sum[3], 0.0);
            }
            // Rows further on are the same.
            let mut rest = vec![[9.0; 4]; 3];
            of.set(4, &mut rest);
            assert_eq!(rest, sums[4..7]);
        }
    }

    #[test]
    fn whole_sums_are_plain_ones_on_every_processor() {
        let random = Random::new();
        let of = Whole {
            high: &random.high,
            low: &random.low,
            columns: &random.columns,
            span: Span {
                starts: &random.starts,
                skip: 0,
            },
            x: &random.x,
        };
        let mut sums = vec![[9.0; 3]; random.starts.len() - 1];
        of.set(0, &mut sums);
        for (row, sum) in sums.iter().enumerate() {
            let places = of.span.places(row);
            assert_eq!(*sum, of.sum(Portable, places.clone()));
            let number = |place: usize, k: usize| {
                f64::from(random.high[place][k]) + f64::from(random.low[place][k])
            };
            let plain = random.plain(places.clone(), number, |column| random.x[column]);
            for (i, (exact, size)) in plain.into_iter().enumerate() {
                // Twice: the plain sum is rounded too.
                let off = (sum[i] - exact).abs();
                assert!(off <= 2.0 * allowed(3 * places.len(), f64::powi(2.0, -53)) * size);
            }
        }
    }
}
