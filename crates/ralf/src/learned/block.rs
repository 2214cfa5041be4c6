//! Rows that are asked together: feature by feature, so that a question is one pass over numbers that lie side by side.

use super::rows::Rows;
use super::tree::Split;
use wide::u8x64;

/// Rows of a block.
pub(super) const BLOCK: usize = 64;

/// Of each row of a block all bits, or none.
pub(super) type Mask = u8x64;

/// A bit for each row of a block.
pub(super) type Bits = u64;

/// A table of features in blocks, for all that are asked about it.
#[derive(Debug, Clone)]
pub struct Blocks {
    pub(super) rows: usize,
    pub(super) blocks: Vec<Block>,
}

impl Blocks {
    /// The rows of a table.
    pub fn of(rows: &Rows) -> Self {
        let blocks = (0..rows.len()).step_by(BLOCK).map(|begin| Block::of(rows, begin));
        Self { rows: rows.len(), blocks: blocks.collect() }
    }
}

/// The features of up to [`BLOCK`] rows. What lies behind the last row is absent.
#[derive(Debug, Clone)]
pub(super) struct Block {
    columns: Vec<[f32; BLOCK]>,
}

impl Block {
    /// The rows from `begin` on.
    fn of(rows: &Rows, begin: usize) -> Self {
        let mut columns = vec![[f32::NAN; BLOCK]; rows.width()];
        for at in begin..rows.len().min(begin + BLOCK) {
            for (column, value) in columns.iter_mut().zip(rows.row(at)) {
                column[at - begin] = *value;
            }
        }
        Self { columns }
    }

    /// The rows that get a yes to a question; as [`Split::is_yes`] says, without a branch per row.
    pub(super) fn answers(&self, split: &Split) -> Mask {
        let column = &self.columns[usize::from(split.feature)];
        // What is absent is neither above the threshold nor not.
        let answers: [u8; BLOCK] = if split.absent_is_yes {
            std::array::from_fn(|row| if column[row] > split.threshold { 0 } else { u8::MAX })
        } else {
            std::array::from_fn(|row| if column[row] <= split.threshold { u8::MAX } else { 0 })
        };
        answers.into()
    }
}
