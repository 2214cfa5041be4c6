//! A table, scan by scan: whoever looks around needs all detections of a scan together.

use super::super::table::TrainingTable;
use ralf::evidence::GROUPS;
use ralf::learned::Rows;
use ralf::learned::net::Around;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use std::ops::Range;

/// A table's scans. One that is seen in two ways is two.
pub(in super::super) struct Scans<'a> {
    pub(super) table: &'a TrainingTable,
    weights: &'a [f32],
    /// The rows of each scan, world by world.
    of_worlds: Vec<Vec<Range<usize>>>,
    /// The group of each feature.
    group_of: Vec<usize>,
}

/// Some scans, one after the other.
pub(super) struct Batch {
    pub(super) rows: Rows,
    pub(super) around: Around,
    pub(super) plausible: Vec<bool>,
    pub(super) weights: Vec<f32>,
}

impl<'a> Scans<'a> {
    /// The scans of a table, with how much each of its rows counts.
    pub(in super::super) fn new(table: &'a TrainingTable, weights: &'a [f32]) -> Self {
        let mut of_worlds = vec![Vec::new(); table.worlds.len()];
        let mut begin = 0;
        for scan in table.known.chunk_by(|a, b| (a.scan, a.view) == (b.scan, b.view)) {
            of_worlds[usize::from(scan[0].world)].push(begin..begin + scan.len());
            begin += scan.len();
        }
        Self { table, weights, of_worlds, group_of: table.group_of() }
    }

    /// The rows of each scan of a world.
    pub(in super::super) fn of_world(&self, world: u16) -> &[Range<usize>] {
        &self.of_worlds[usize::from(world)]
    }

    /// Where the detections of a scan lie.
    pub(super) fn places(&self, scan: &Range<usize>) -> Vec<[f32; 3]> {
        self.table.known[scan.clone()].iter().map(|known| known.place).collect()
    }

    /// Scans of about so many rows: worlds that have any are as likely as each other, and so are a world's scans. Each
    /// group of evidence lacks in a share of them.
    pub(super) fn draw(
        &self,
        worlds: &[u16],
        rows: usize,
        blanked: f64,
        nearest: usize,
        random: &mut Pcg64Mcg,
    ) -> Batch {
        let filled: Vec<&Vec<Range<usize>>> =
            worlds.iter().map(|world| &self.of_worlds[usize::from(*world)]).collect();
        let filled: Vec<&Vec<Range<usize>>> = filled.into_iter().filter(|scans| !scans.is_empty()).collect();
        let mut batch = Batch {
            rows: Rows::absent(0, self.table.features.len()),
            around: Around::default(),
            plausible: Vec::new(),
            weights: Vec::new(),
        };
        let mut around = Vec::new();
        while batch.plausible.len() < rows && !filled.is_empty() {
            let scans = filled[random.random_range(0..filled.len())];
            let scan = &scans[random.random_range(0..scans.len())];
            let lacking = GROUPS.map(|_| random.random_bool(blanked));
            batch.rows.append(&self.seen_without(scan, &lacking));
            around.push(Around::of(&self.places(scan), nearest));
            batch.plausible.extend(self.table.known[scan.clone()].iter().map(|known| known.plausible));
            batch.weights.extend_from_slice(&self.weights[scan.clone()]);
        }
        batch.around = Around::joined(&around, nearest);
        batch
    }

    /// The rows of a scan without some groups of evidence.
    fn seen_without(&self, scan: &Range<usize>, lacking: &[bool; GROUPS.len()]) -> Rows {
        let mut rows = self.table.rows.pick(scan.clone());
        for row in 0..rows.len() {
            for (value, group) in rows.row_mut(row).iter_mut().zip(&self.group_of) {
                if lacking[*group] {
                    *value = f32::NAN;
                }
            }
        }
        rows
    }
}
