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
    /// By sequence, of which somebody said something in two or more; else stretches of time of the only one, which lie
    /// near each other. None where all was measured at one time.
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
        let mut times: Vec<i64> =
            table.known.iter().filter(|known| known.said).map(|known| known.t_ns).collect();
        times.sort_unstable();
        times.dedup();
        let count = if times.len() > 1 { times.len().min(OF_ONE) } else { 0 };
        let of_time = |t_ns: i64| times.partition_point(|other| *other < t_ns) * count / times.len();
        Self { count, of_row: table.known.iter().map(|known| of_time(known.t_ns)).collect() }
    }
}
