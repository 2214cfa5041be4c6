//! What stands above each place.

use super::super::standing::VOXEL;
use super::{LOWEST, REACH};

/// Edge of a column, m.
const CELL: f32 = 0.25;
/// Columns along an edge.
const CELLS: usize = (2.0 * REACH / CELL) as usize;
/// Words of a row of bits.
const WORDS: usize = CELLS.div_ceil(64);

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
}

impl ColumnGrid {
    /// Edge of a column, m.
    pub const CELL: f64 = CELL as f64;

    pub(super) fn empty() -> Self {
        Self { voxels: vec![0; CELLS * CELLS], filled: vec![0; CELLS * WORDS] }
    }

    /// Fills the voxel of a column at a level.
    pub(super) fn add(&mut self, cell: usize, level: u32) {
        self.voxels[cell] |= 1 << level;
        self.filled[cell / CELLS * WORDS + cell % CELLS / 64] |= 1 << (cell % 64);
    }

    /// Empties a column.
    pub(super) fn clear(&mut self, cell: usize) {
        self.voxels[cell] = 0;
        self.filled[cell / CELLS * WORDS + cell % CELLS / 64] &= !(1 << (cell % 64));
    }

    /// What stands at a place; `None` beyond the map, and where nothing stands.
    pub fn at(&self, x: f64, y: f64) -> Option<Column> {
        let cell = cell_of(x as f32, y as f32)?;
        let filled = self.filled[cell / CELLS * WORDS + cell % CELLS / 64] >> (cell % 64) & 1;
        (filled != 0).then(|| column(self.voxels[cell]))
    }

    /// Whether the map reaches to a place.
    pub fn covers(x: f64, y: f64) -> bool {
        cell_of(x as f32, y as f32).is_some()
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

/// The column at a place; `None` beyond the map.
pub(super) fn cell_of(x: f32, y: f32) -> Option<usize> {
    let [column, row] = [x, y].map(|v| (v + REACH) / CELL);
    let inside = |v: f32| (0.0..CELLS as f32).contains(&v);
    (inside(column) && inside(row)).then(|| row as usize * CELLS + column as usize)
}

/// How many columns there are.
pub(super) const COLUMNS: usize = CELLS * CELLS;
