//! A table, scan by scan: whoever looks around needs all detections of a scan together.

use super::super::blanking::blank;
use super::super::table::{TrainingTable, places, scans_of};
use ralf::evidence::GROUPS;
use ralf::learned::Rows;
use ralf::learned::net::Around;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use std::ops::Range;

/// A table's scans. One that is seen in two ways is two.
pub(in super::super) struct Scans<'a> {
    pub(super) table: &'a TrainingTable,
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
}

impl<'a> Scans<'a> {
    /// The scans of a table.
    pub(in super::super) fn new(table: &'a TrainingTable) -> Self {
        let mut of_worlds = vec![Vec::new(); table.worlds.len()];
        for scan in scans_of(&table.known) {
            of_worlds[usize::from(table.known[scan.start].world)].push(scan);
        }
        Self { table, of_worlds, group_of: table.group_of() }
    }

    /// The rows of each scan of a world.
    pub(in super::super) fn of_world(&self, world: u16) -> &[Range<usize>] {
        &self.of_worlds[usize::from(world)]
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
        let filled: Vec<&[Range<usize>]> =
            worlds.iter().map(|world| self.of_world(*world)).filter(|scans| !scans.is_empty()).collect();
        let mut batch = Batch {
            rows: Rows::absent(0, self.table.features.len()),
            around: Around::default(),
            plausible: Vec::new(),
        };
        let mut around = Vec::new();
        while batch.plausible.len() < rows && !filled.is_empty() {
            let scans = filled[random.random_range(0..filled.len())];
            let scan = &scans[random.random_range(0..scans.len())];
            let lacking = GROUPS.map(|_| random.random_bool(blanked));
            batch.rows.append(&self.seen_without(scan, &lacking));
            let known = &self.table.known[scan.clone()];
            around.push(Around::of(&places(known), nearest));
            batch.plausible.extend(known.iter().map(|known| known.plausible));
        }
        batch.around = Around::joined(&around, nearest);
        batch
    }

    /// The rows of a scan without some groups of evidence.
    fn seen_without(&self, scan: &Range<usize>, lacking: &[bool; GROUPS.len()]) -> Rows {
        let mut rows = self.table.rows.pick(scan.clone());
        for row in 0..rows.len() {
            blank(rows.row_mut(row), &self.group_of, lacking);
        }
        rows
    }
}
