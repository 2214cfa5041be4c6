//! What stands above each place.

use super::super::cells::Cells;
use super::super::standing::VOXEL;
use super::{LOWEST, REACH};

/// Edge of a column, m.
const CELL: f32 = 0.25;
pub(super) const GRID: Cells = Cells::new(REACH, CELL);
/// Columns along an edge.
const CELLS: usize = GRID.along;
/// Words of a row of bits.
const WORDS: usize = CELLS.div_ceil(64);

/// Columns along the edge of a block, which is a metre long.
const BLOCK: usize = 4;
/// Blocks along an edge.
const BLOCKS: usize = CELLS / BLOCK;

/// A place is told to be in a cell that it is at most so far beside, m.
const ROUNDING: f64 = 1e-3;

/// What fills a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Height of the lowest filled voxel's middle above the ground, m.
    pub bottom: f64,
    /// Height of the highest filled voxel's middle above the ground, m.
    pub top: f64,
    /// How many voxels are filled.
    pub voxels: u32,
}

/// Columns of 0.25 m over the horizontal plane of a frame.
#[derive(Debug)]
pub struct ColumnGrid {
    /// A bit for each voxel above a place, row by row.
    voxels: Vec<u64>,
    /// A bit for each column that has any.
    filled: Vec<u64>,
    /// Of each block: how many blocks away, in row or column, the next is in which something stands.
    away: Vec<u8>,
}

impl ColumnGrid {
    /// Edge of a column, m.
    pub const CELL: f64 = CELL as f64;
    /// Edge of a block, m.
    const BLOCK: f64 = BLOCK as f64 * Self::CELL;

    pub(super) fn empty() -> Self {
        Self {
            voxels: vec![0; CELLS * CELLS],
            filled: vec![0; CELLS * WORDS],
            away: vec![0; BLOCKS * BLOCKS],
        }
    }

    /// Fills the voxel of a column at a level.
    pub(super) fn add(&mut self, cell: usize, level: i32) {
        self.voxels[cell] |= 1 << level;
        let (word, bit) = bit_of(cell);
        self.filled[word] |= bit;
    }

    /// Empties a column.
    pub(super) fn clear(&mut self, cell: usize) {
        self.voxels[cell] = 0;
        let (word, bit) = bit_of(cell);
        self.filled[word] &= !bit;
    }

    /// To be called when nothing more is filled or emptied, before [`Self::at`].
    pub(super) fn finish(&mut self) {
        self.away = vec![u8::MAX; BLOCKS * BLOCKS];
        for row in 0..CELLS {
            for column in Bits::of(&self.filled[row * WORDS..][..WORDS], 0, CELLS) {
                self.away[row / BLOCK * BLOCKS + column / BLOCK] = 0;
            }
        }
        // There and back, as ways lead from block to block: backward is forward where the last block is the first.
        for _ in 0..2 {
            spread(&mut self.away);
            self.away.reverse();
        }
    }

    /// Whether anything stands in a column.
    pub(super) fn is_filled(&self, cell: usize) -> bool {
        let (word, bit) = bit_of(cell);
        self.filled[word] & bit != 0
    }

    /// What stands at a place, `None` beyond the map and where nothing stands; and how far a way goes on from there,
    /// m, through nothing at all, and perhaps farther. 0 beyond the map. `lengths` tell where the way leads: how long
    /// it is for each metre along x and along y, infinite where it leads nowhere along one of them.
    pub fn at(&self, x: f64, y: f64, lengths: [f64; 2]) -> (Option<Column>, f64) {
        let Some(cell) = GRID.at(x as f32, y as f32) else { return (None, 0.0) };
        let (row, place) = (cell / CELLS, cell % CELLS);
        let block = [place / BLOCK, row / BLOCK];
        let away = self.away[block[1] * BLOCKS + block[0]];
        if away == 0 {
            return (self.in_cell(cell), 0.0);
        }
        // The square of empty blocks around this one ends at that border to which the way comes first.
        let to_border = |v: f64, block: usize, length: f64| {
            let [before, behind] = [f64::from(away - 1), f64::from(away)];
            let border = block as f64 + if length > 0.0 { behind } else { -before };
            (border * Self::BLOCK - f64::from(REACH) - v) * length
        };
        let free = to_border(x, block[0], lengths[0]).min(to_border(y, block[1], lengths[1]));
        // Places are rounded to cells by less than this.
        (None, (free - ROUNDING).max(0.0))
    }

    fn in_cell(&self, cell: usize) -> Option<Column> {
        self.is_filled(cell).then(|| column(self.voxels[cell]))
    }

    /// Whether the map reaches to a place.
    pub fn covers(x: f64, y: f64) -> bool {
        GRID.at(x as f32, y as f32).is_some()
    }

    /// The filled columns whose middle is at most a distance from a place along each axis, m, with the way there.
    pub fn around(&self, x: f64, y: f64, distance: f64) -> impl Iterator<Item = ([f64; 2], Column)> {
        let [columns, rows] = [x, y].map(|v| {
            let place = |v: f64| ((v + f64::from(REACH)) / Self::CELL - 0.5).clamp(-1.0, CELLS as f64);
            let end = (place(v + distance).floor() + 1.0).min(CELLS as f64);
            place(v - distance).ceil().max(0.0) as usize..end.max(0.0) as usize
        });
        rows.flat_map(move |row| {
            let filled = Bits::of(&self.filled[row * WORDS..][..WORDS], columns.start, columns.end);
            filled.map(move |place| {
                ([middle(place) - x, middle(row) - y], column(self.voxels[row * CELLS + place]))
            })
        })
    }
}

/// The word and the bit of a column in rows of bits.
fn bit_of(cell: usize) -> (usize, u64) {
    let (row, place) = (cell / CELLS, cell % CELLS);
    (row * WORDS + place / 64, 1 << (place % 64))
}

/// Every block is at most one farther away than those before and above it.
fn spread(away: &mut [u8]) {
    // With a border from which nothing comes.
    let mut above = [u8::MAX; BLOCKS + 2];
    for row in away.chunks_exact_mut(BLOCKS) {
        for (away, above) in row.iter_mut().zip(above.windows(3)) {
            let next = above[0].min(above[1]).min(above[2]).saturating_add(1);
            *away = next.min(*away);
        }
        let mut next = u8::MAX;
        for away in row.iter_mut() {
            *away = next.min(*away);
            next = away.saturating_add(1);
        }
        above[1..=BLOCKS].copy_from_slice(row);
    }
}

/// The places of the bits that are set from a first to before an end.
struct Bits<'a> {
    words: &'a [u64],
    /// What is left of the word at hand.
    left: u64,
    word: usize,
    end: usize,
}

impl<'a> Bits<'a> {
    fn of(words: &'a [u64], begin: usize, end: usize) -> Self {
        let word = (begin / 64).min(words.len() - 1);
        let left = if begin < end { words[word] & (u64::MAX << (begin % 64)) } else { 0 };
        Self { words, left, word, end: if begin < end { end } else { 0 } }
    }
}

impl Iterator for Bits<'_> {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        while self.left == 0 {
            self.word += 1;
            if self.word * 64 >= self.end {
                return None;
            }
            self.left = self.words[self.word];
        }
        let place = self.word * 64 + self.left.trailing_zeros() as usize;
        self.left &= self.left - 1;
        (place < self.end).then_some(place)
    }
}

/// What bits of voxels say; at least one is set.
fn column(voxels: u64) -> Column {
    let height = |level: u32| f64::from(LOWEST + (level as f32 + 0.5) * VOXEL);
    Column {
        bottom: height(voxels.trailing_zeros()),
        top: height(63 - voxels.leading_zeros()),
        voxels: voxels.count_ones(),
    }
}

/// The middle of a row or column of cells, m.
fn middle(cell: usize) -> f64 {
    (cell as f64 + 0.5) * ColumnGrid::CELL - f64::from(REACH)
}
