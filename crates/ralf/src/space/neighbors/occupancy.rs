//! Where a search may begin: how many rings of cells around each cell are surely empty.

/// Shifts that make of what lies within 0 cells what lies within 1, 2, 4, 8 and 16, each from the one before.
const SHIFTS: [usize; 5] = [1, 1, 2, 4, 8];

/// The first ring that may hold a point, by how many of these distances hold one.
const FIRST_RINGS: [usize; SHIFTS.len() + 1] = [17, 9, 5, 3, 2, 0];

/// For each cell of a grid, whether anything lies within 1, 2, 4, 8 and 16 cells in row and column.
#[derive(Debug, Clone)]
pub(super) struct Occupancy {
    /// Words of a row.
    words: usize,
    /// Words of a distance.
    size: usize,
    /// A bit for each cell, row by row, for each distance, nearest first.
    within: Vec<u64>,
}

impl Occupancy {
    /// Of a grid of cells, numbered row by row, of which some are filled.
    pub(super) fn new(columns: usize, rows: usize, is_filled: impl Fn(usize) -> bool) -> Self {
        let words = columns.div_ceil(64);
        let size = words * rows;
        let mut bits = vec![0; size];
        for row in 0..rows {
            for column in 0..columns {
                bits[row * words + column / 64] |=
                    u64::from(is_filled(row * columns + column)) << (column % 64);
            }
        }
        let mut within = Vec::with_capacity(size * SHIFTS.len());
        for shift in SHIFTS {
            spread_along(&mut bits, words, shift);
            let away = (shift * words).min(size);
            let begin = within.len();
            within.extend_from_slice(&bits);
            within[begin + away..].iter_mut().zip(&bits).for_each(|(word, below)| *word |= below);
            within[begin..].iter_mut().zip(&bits[away..]).for_each(|(word, above)| *word |= above);
            bits.copy_from_slice(&within[begin..]);
        }
        Self { words, size, within }
    }

    /// No ring of cells before this one around a cell holds any point.
    pub(super) fn first_ring(&self, [column, row]: [usize; 2]) -> usize {
        let (word, bit) = (row * self.words + column / 64, column % 64);
        // What lies within one distance lies within the larger ones, too, so that counting tells the first.
        let is_near = |distance: usize| self.within[distance * self.size + word] >> bit & 1;
        FIRST_RINGS[(0..SHIFTS.len()).map(is_near).sum::<u64>() as usize]
    }
}

/// Joins bits with those so many columns away, rows of so many words.
fn spread_along(bits: &mut [u64], words: usize, shift: usize) {
    for row in bits.chunks_mut(words) {
        let mut before = 0;
        for at in 0..row.len() {
            let here = row[at];
            let after = row.get(at + 1).copied().unwrap_or(0);
            row[at] |= here << shift | before >> (64 - shift) | here >> shift | after << (64 - shift);
            before = here;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn rings_before_the_first_are_empty_and_few_are_left_over(
            columns in 1usize..150, rows in 1usize..40, filled in prop::collection::vec((0usize..150, 0usize..40), 0..6),
        ) {
            let filled: Vec<[usize; 2]> =
                filled.into_iter().filter(|(x, y)| *x < columns && *y < rows).map(|(x, y)| [x, y]).collect();
            let is_filled = |cell: usize| filled.contains(&[cell % columns, cell / columns]);
            let occupancy = Occupancy::new(columns, rows, is_filled);
            for cell in 0..columns * rows {
                let [column, row] = [cell % columns, cell / columns];
                let ring = |[x, y]: &[usize; 2]| x.abs_diff(column).max(y.abs_diff(row));
                let nearest = filled.iter().map(ring).min().unwrap_or(usize::MAX);
                let expected = match nearest {
                    0 | 1 => 0,
                    2 => 2,
                    3 | 4 => 3,
                    5..=8 => 5,
                    9..=16 => 9,
                    _ => 17,
                };
                prop_assert_eq!(occupancy.first_ring([column, row]), expected);
            }
        }
    }
}
