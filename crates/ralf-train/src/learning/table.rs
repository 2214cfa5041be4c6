//! Evidence and truth of many detections: what a model is fitted to.

use super::view::View;
use ralf::evidence::Feature;
use ralf::learned::Rows;
use std::ops::Range;

/// Evidence and truth, a row per detection.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingTable {
    /// What the features are, in the order of the rows.
    pub features: Vec<&'static Feature>,
    /// Names of the worlds: recordings of one kind. A model is judged in worlds that it was not fitted to.
    pub worlds: Vec<String>,
    /// What was observed.
    pub rows: Rows,
    /// What is known of each row beside it.
    pub known: Vec<Known>,
}

/// What is known of a detection beside its evidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// Its place in [`TrainingTable::worlds`].
    pub world: u16,
    /// The scan that it belongs to: rows of one number share what could be observed.
    pub scan: u32,
    /// When that was measured, ns.
    pub t_ns: i64,
    /// How much of the scan's surroundings could be observed.
    pub view: View,
    /// Whether somebody knows what it is; what nobody knows is only heard of by those around it.
    pub said: bool,
    /// Whether it is truly plausible; of no meaning where nobody knows.
    pub plausible: bool,
    /// How it was labelled when somebody spoke of its scan, where that is known.
    pub shown: Option<bool>,
    /// Why it is an artifact, as a number of [`Cause`](ralf::label::Cause); 0 where it is none or nobody knows.
    pub cause: u8,
    /// `w` of the paper's method.
    pub paper: f32,
    /// Whether the paper's method calls it plausible.
    pub paper_label: bool,
    /// Where it lies in the vehicle frame at the scan's time, m.
    pub place: [f32; 3],
}

/// The places of the rows of each scan, seen in one way: they lie side by side.
pub(super) fn scans_of(known: &[Known]) -> impl Iterator<Item = Range<usize>> {
    let mut begin = 0;
    known.chunk_by(|a, b| (a.scan, a.view) == (b.scan, b.view)).map(move |scan| {
        begin += scan.len();
        begin - scan.len()..begin
    })
}

/// Where the detections of some rows lie.
pub(super) fn places(known: &[Known]) -> Vec<[f32; 3]> {
    known.iter().map(|known| known.place).collect()
}

impl TrainingTable {
    /// A table of these features, without rows.
    pub fn new(features: Vec<&'static Feature>) -> Self {
        let rows = Rows::absent(0, features.len());
        Self { features, worlds: Vec::new(), rows, known: Vec::new() }
    }

    /// The number of a world, which is new or known.
    pub fn world(&mut self, name: &str) -> u16 {
        let known = self.worlds.iter().position(|world| world == name);
        let place = known.unwrap_or_else(|| {
            self.worlds.push(name.to_owned());
            self.worlds.len() - 1
        });
        place as u16
    }

    /// Adds detections.
    pub fn append(&mut self, rows: &Rows, known: impl IntoIterator<Item = Known>) {
        self.rows.append(rows);
        self.known.extend(known);
    }

    /// A table of the same detections without the features of some groups.
    pub fn without_groups(&self, groups: &[String]) -> Self {
        let is_kept = |feature: &Feature| groups.iter().all(|group| group != feature.group);
        let kept: Vec<usize> =
            (0..self.features.len()).filter(|place| is_kept(self.features[*place])).collect();
        Self {
            features: kept.iter().map(|place| self.features[*place]).collect(),
            worlds: self.worlds.clone(),
            rows: self.rows.pick_columns(&kept),
            known: self.known.clone(),
        }
    }

    /// How many rows.
    pub fn len(&self) -> usize {
        self.known.len()
    }

    /// Whether it has no row.
    pub fn is_empty(&self) -> bool {
        self.known.is_empty()
    }
}
