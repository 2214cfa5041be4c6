//! Which rows are left out together, so that what corrections bring is judged by what was not heard.

use super::super::table::TrainingTable;

/// Sequences are dealt to so many parts at most: each costs a forest.
const MOST: usize = 10;
/// A sequence that is alone is cut into so many.
const OF_ONE: usize = 4;

/// The parts of a table.
pub(super) struct Folds {
    /// How many.
    pub(super) count: usize,
    /// The part of each row; without meaning where there are none.
    pub(super) of_row: Vec<usize>,
}

impl Folds {
    /// By sequence, of which somebody said something in two or more; else stretches of scans of the only one, whose
    /// parts lie near each other. None where one scan is all.
    pub(super) fn new(table: &TrainingTable) -> Self {
        let mut said: Vec<u16> =
            table.known.iter().filter(|known| known.said).map(|known| known.world).collect();
        said.sort_unstable();
        said.dedup();
        let of_world = |world: u16| said.partition_point(|other| *other < world) % MOST;
        if said.len() > 1 {
            let of_row = table.known.iter().map(|known| of_world(known.world)).collect();
            return Self { count: said.len().min(MOST), of_row };
        }
        let mut scans: Vec<u32> =
            table.known.iter().filter(|known| known.said).map(|known| known.scan).collect();
        scans.sort_unstable();
        scans.dedup();
        let count = if scans.len() > 1 { scans.len().min(OF_ONE) } else { 0 };
        let of_scan = |scan: u32| scans.partition_point(|other| *other < scan) * count / scans.len();
        Self { count, of_row: table.known.iter().map(|known| of_scan(known.scan)).collect() }
    }
}
