//! Rows that are asked together: feature by feature, so that a question is one pass over numbers that lie side by side.

use super::rows::Rows;
use super::tree::Split;

/// Rows of a block.
pub(super) const BLOCK: usize = 64;

/// The features of up to [`BLOCK`] rows. What lies behind the last row is absent.
pub(super) struct Block {
    columns: Vec<[f32; BLOCK]>,
}

impl Block {
    /// The rows from `begin` on.
    pub(super) fn of(rows: &Rows, begin: usize) -> Self {
        let mut columns = vec![[f32::NAN; BLOCK]; rows.width()];
        for at in begin..rows.len().min(begin + BLOCK) {
            for (column, value) in columns.iter_mut().zip(rows.row(at)) {
                column[at - begin] = *value;
            }
        }
        Self { columns }
    }

    /// Whether each row gets a yes to a question; as [`Split::is_yes`] says, without a branch per row.
    pub(super) fn answers(&self, split: &Split) -> [bool; BLOCK] {
        let column = &self.columns[usize::from(split.feature)];
        let mut yes = [false; BLOCK];
        for (yes, value) in yes.iter_mut().zip(column) {
            *yes = (*value <= split.threshold) | (value.is_nan() & split.absent_is_yes);
        }
        yes
    }
}
