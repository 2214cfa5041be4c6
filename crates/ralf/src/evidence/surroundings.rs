//! A frame with what several pieces of evidence need of it, each worked out once.

use super::probe::{Probe, probes};
use super::rates::Rates;
use super::recurrence::{Recurrence, recurrences};
use super::way::{Way, ways};
use crate::config::Config;
use crate::scene::{Detection, Frame, NeighbouringDetections};
use crate::space::NeighborIndex;
use std::cell::OnceCell;

/// A frame, the settings, and what several pieces of evidence need: worked out where a piece first asks for it.
pub struct Surroundings<'a> {
    /// One radar scan with what is known around it.
    pub frame: &'a Frame<'a>,
    /// All settings.
    pub config: &'a Config,
    neighbours: OnceCell<NeighbouringDetections>,
    probes: OnceCell<Vec<Option<Probe>>>,
    joint_probes: OnceCell<Vec<Option<Probe>>>,
    ways: OnceCell<Vec<Option<Way>>>,
    rates: OnceCell<Option<Rates>>,
    recurrences: OnceCell<Vec<Recurrence>>,
    own_index: OnceCell<NeighborIndex>,
}

impl<'a> Surroundings<'a> {
    /// What can be told of a frame.
    pub fn new(frame: &'a Frame<'a>, config: &'a Config) -> Self {
        Self {
            frame,
            config,
            neighbours: OnceCell::new(),
            probes: OnceCell::new(),
            joint_probes: OnceCell::new(),
            ways: OnceCell::new(),
            rates: OnceCell::new(),
            recurrences: OnceCell::new(),
            own_index: OnceCell::new(),
        }
    }

    /// The detections of all radars around the scan, in its frame.
    pub fn neighbours(&self) -> &NeighbouringDetections {
        self.neighbours.get_or_init(|| NeighbouringDetections::around(self.frame))
    }

    /// The scan's detections in the vehicle frame of its LiDAR window, `None` for those without a position; no entry
    /// at all without a window.
    pub fn probes(&self) -> &[Option<Probe>] {
        self.probes.get_or_init(|| probes(self.frame, self.frame.scan.detections.iter().map(Option::as_ref)))
    }

    /// The same where the radar's own scans around together place what stands still ([`Joint`](super::joint::Joint)).
    pub(super) fn joint_probes(&self) -> &[Option<Probe>] {
        self.joint_probes.get_or_init(|| {
            let of_several = self.recurrences().iter().map(|known| {
                let joint = known.joint.as_ref().filter(|joint| joint.is_of_several());
                joint.map(|joint| &joint.detection)
            });
            let joint = probes(self.frame, of_several);
            self.probes().iter().zip(joint).map(|(alone, joint)| joint.or(*alone)).collect()
        })
    }

    /// Whether other scans have a say in where a detection of the scan lies, so that its joint probe is another one.
    pub(super) fn is_placed_jointly(&self, row: usize) -> bool {
        self.recurrences()[row].joint.is_some_and(|joint| joint.is_of_several())
    }

    /// What stands in the radar's way to each detection, as far as the LiDAR window's map reaches; no entry at all
    /// without a window.
    pub(super) fn ways(&self) -> &[Option<Way>] {
        self.ways.get_or_init(|| ways(self.frame, self.probes(), self.rows_by_place().map(|(row, _)| row)))
    }

    /// The compensated range rates of the scan; `None` where the radar measures none.
    pub(super) fn rates(&self) -> Option<&Rates> {
        self.rates
            .get_or_init(|| self.frame.doppler().map(|doppler| Rates::new(doppler.compensated.clone())))
            .as_ref()
    }

    /// Of each detection of the scan, in which scans around it could have been seen again, and whether it was.
    pub(super) fn recurrences(&self) -> &[Recurrence] {
        self.recurrences
            .get_or_init(|| recurrences(self.frame, self.neighbours(), self.rates(), self.rows_by_place()))
    }

    /// The scan's detections that have a place, with their rows, in an order in which neighbours mostly follow each
    /// other: whoever searches around each of them finds what is needed still at hand.
    pub(super) fn rows_by_place(&self) -> impl Iterator<Item = (usize, &Detection)> {
        let rows = self.own_index().ids().iter().map(|row| *row as usize);
        rows.filter_map(|row| Some((row, self.frame.scan.detections[row].as_ref()?)))
    }

    /// Finds the scan's own detections at most `radius`, m, from one, seen from above.
    pub(super) fn beside(&self, detection: &Detection, radius: f64, found: &mut Vec<u32>) {
        self.own_index().beside(detection.in_plan(), radius as f32, found);
    }

    /// How many [`Self::beside`] finds.
    pub(super) fn count_beside(&self, detection: &Detection, radius: f64) -> usize {
        self.own_index().count_beside(detection.in_plan(), radius as f32)
    }

    fn own_index(&self) -> &NeighborIndex {
        self.own_index.get_or_init(|| {
            let (mut places, mut rows) = (Vec::new(), Vec::new());
            for (row, detection) in (0u32..).zip(&self.frame.scan.detections) {
                if let Some(detection) = detection {
                    let [x, y] = detection.in_plan();
                    places.push([x, y, 0.0]);
                    rows.push(row);
                }
            }
            NeighborIndex::new(&places, &rows)
        })
    }
}
