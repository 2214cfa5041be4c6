//! The mismatches of many scans, in columns.

use super::mismatches::DetectionMismatches;
use super::{Branches, Space, TuneError, TunedSettings};
use ralf::metrics::Confusion;
use std::ops::Range;

/// Bits of [`MismatchTable::marks`].
const ON_FLOOR: u8 = 1;
const IN_BLIND_SPOT: u8 = 2;
const PLAUSIBLE: u8 = 4;

/// Mismatches and truth of all detections with a truth, some hundred bytes each. Full precision is kept, so that a
/// trial gives the labels that the labeler would give.
#[derive(Debug, Clone, PartialEq)]
pub struct MismatchTable {
    space: Space,
    /// Per `K`; NaN where absent, in the other columns, too.
    d_lm: Vec<Vec<f64>>,
    d_cm: Vec<f64>,
    /// Per `n_b`.
    d_tr: Vec<Vec<f64>>,
    gamma_s: Vec<f64>,
    marks: Vec<u8>,
    /// The row after each scan's last one.
    ends: Vec<usize>,
}

/// One detection of a table.
#[derive(Debug, Clone)]
pub(super) struct Row {
    /// Its `d_lm` and `d_tr` are not used.
    pub(super) rest: DetectionMismatches,
    /// Per `K`.
    pub(super) d_lm: Vec<Option<f64>>,
    /// Per `n_b`.
    pub(super) d_tr: Vec<Option<f64>>,
    /// The truth.
    pub(super) plausible: bool,
}

impl MismatchTable {
    /// Without scans.
    pub fn new(space: Space) -> Self {
        let (d_lm, d_tr) = (vec![Vec::new(); space.neighbours.len()], vec![Vec::new(); space.scans.len()]);
        Self { space, d_lm, d_cm: vec![], d_tr, gamma_s: vec![], marks: vec![], ends: vec![] }
    }

    /// The `K` and `n_b` for which it holds mismatches.
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// Detections.
    pub fn len(&self) -> usize {
        self.marks.len()
    }

    /// Whether it holds no detection.
    pub fn is_empty(&self) -> bool {
        self.marks.is_empty()
    }

    /// Scans.
    pub fn scans(&self) -> usize {
        self.ends.len()
    }

    /// Adds the next scan's detections.
    pub(super) fn push_scan(&mut self, rows: impl IntoIterator<Item = Row>) {
        let stored = |d: Option<f64>| d.unwrap_or(f64::NAN);
        for Row { rest, d_lm, d_tr, plausible } in rows {
            self.d_lm.iter_mut().zip(d_lm).for_each(|(column, d)| column.push(stored(d)));
            self.d_tr.iter_mut().zip(d_tr).for_each(|(column, d)| column.push(stored(d)));
            self.d_cm.push(stored(rest.d_cm));
            self.gamma_s.push(rest.gamma_s);
            let mark = |applies: bool, bit: u8| if applies { bit } else { 0 };
            self.marks.push(
                mark(rest.on_floor, ON_FLOOR)
                    | mark(rest.in_blind_spot, IN_BLIND_SPOT)
                    | mark(plausible, PLAUSIBLE),
            );
        }
        self.ends.push(self.marks.len());
    }

    /// Adds the scans of another table of the same space.
    pub fn append(&mut self, other: Self) {
        let before = self.marks.len();
        self.d_lm.iter_mut().zip(other.d_lm).for_each(|(column, more)| column.extend(more));
        self.d_tr.iter_mut().zip(other.d_tr).for_each(|(column, more)| column.extend(more));
        self.d_cm.extend(other.d_cm);
        self.gamma_s.extend(other.gamma_s);
        self.marks.extend(other.marks);
        self.ends.extend(other.ends.into_iter().map(|end| before + end));
    }

    /// Each scan's confusion matrix with these settings.
    pub fn confusions(&self, settings: &TunedSettings) -> Result<Vec<Confusion>, TuneError> {
        let view = self.view(settings)?;
        let count = |rows: Range<usize>| {
            let mut counts = Confusion::default();
            for row in rows {
                counts.add(view.truth(row), view.observed(row).is_plausible(&settings.weights));
            }
            counts
        };
        let begins = [0].iter().chain(&self.ends);
        Ok(begins.zip(&self.ends).map(|(begin, end)| count(*begin..*end)).collect())
    }

    /// The mismatches that some settings look at: one `K`, one `n_b`, and the branches that have a say.
    pub(super) fn view(&self, settings: &TunedSettings) -> Result<View<'_>, TuneError> {
        let TunedSettings { neighbours, scans, branches, .. } = *settings;
        let place = |values: &[usize], key, value| {
            let found = values.iter().position(|known| *known == value);
            found.ok_or(TuneError::NotGathered { key, value })
        };
        let lm = place(&self.space.neighbours, "lidar.neighbours", neighbours)?;
        let tr = place(&self.space.scans, "tracking.scans", scans)?;
        Ok(View { table: self, d_lm: &self.d_lm[lm], d_tr: &self.d_tr[tr], branches })
    }
}

/// A table for some settings.
#[derive(Debug, Clone, Copy)]
pub(super) struct View<'a> {
    table: &'a MismatchTable,
    d_lm: &'a [f64],
    d_tr: &'a [f64],
    branches: Branches,
}

impl View<'_> {
    /// What is known of a detection.
    pub(super) fn observed(&self, row: usize) -> DetectionMismatches {
        let present = |has_a_say: bool, d: f64| (has_a_say && !d.is_nan()).then_some(d);
        let Branches { lidar, camera, tracking } = self.branches;
        let marks = self.table.marks[row];
        DetectionMismatches {
            d_lm: present(lidar, self.d_lm[row]),
            d_cm: present(camera, self.table.d_cm[row]),
            d_tr: present(tracking, self.d_tr[row]),
            on_floor: marks & ON_FLOOR != 0,
            in_blind_spot: marks & IN_BLIND_SPOT != 0,
            gamma_s: self.table.gamma_s[row],
        }
    }

    /// Whether it is truly plausible.
    pub(super) fn truth(&self, row: usize) -> bool {
        self.table.marks[row] & PLAUSIBLE != 0
    }

    /// Evidence and truth of all detections.
    pub(super) fn rows(&self) -> impl Iterator<Item = (DetectionMismatches, bool)> {
        (0..self.table.len()).map(|row| (self.observed(row), self.truth(row)))
    }
}
