//! The things of a sequence that is labelled.

use super::{Sighting, group};
use crate::error::DataError;
use crate::frames::ScanIndex;
use crate::judge::Certainty;
use crate::read::SequenceReader;
use crate::result::{PlausibilityReader, RadarScanKey, Table};
use ralf::scene::Doppler;
use ralf::sensors::Rig;
use std::collections::BTreeMap;
use std::ops::Range;

/// The detections of a sequence, and what belongs together.
#[derive(Debug, Clone)]
pub struct SequenceThings {
    /// The scan of each run of detections, in their order.
    scans: Vec<ScanIndex>,
    rows: BTreeMap<ScanIndex, Range<usize>>,
    /// Which of `scans` a detection belongs to.
    scan_of: Vec<u32>,
    sightings: Vec<Sighting>,
    doubt: Vec<f32>,
    things: Vec<u32>,
    count: usize,
}

/// The columns of the result that are needed.
const COLUMNS: [&str; 3] = ["w", "label", "flags"];

impl SequenceThings {
    /// Gathers the things of a recording's sequence from its labels; `rig` is that with which it was labelled.
    ///
    /// # Errors
    /// A scan that can't be read, or labels of another number of detections than it has.
    pub fn of(
        reader: &dyn SequenceReader,
        rig: &Rig,
        certainty: &Certainty,
        tables: &PlausibilityReader,
    ) -> Result<Self, DataError> {
        let mut found = Self {
            scans: Vec::new(),
            rows: BTreeMap::new(),
            scan_of: Vec::new(),
            sightings: Vec::new(),
            doubt: Vec::new(),
            things: Vec::new(),
            count: 0,
        };
        tables.each(&COLUMNS, |key, table| found.add(reader, rig, certainty, key, table))?;
        found.things = group(&found.sightings);
        found.count = found.things.iter().max().map_or(0, |last| *last as usize + 1);
        Ok(found)
    }

    fn add(
        &mut self,
        reader: &dyn SequenceReader,
        rig: &Rig,
        certainty: &Certainty,
        key: &RadarScanKey,
        table: &Table,
    ) -> Result<(), DataError> {
        let Some(radar) = rig.radars.iter().position(|radar| radar.name == *key.radar) else { return Ok(()) };
        let failed = |error| DataError::Measurement { sensor: key.radar.to_string(), index: key.scan, error };
        let scan = reader.radar_scan(radar, key.scan).map_err(failed)?;
        if scan.len() != table.len() {
            let expected = format!("{} detections as it was labelled with", table.len());
            return Err(failed(format!("expected {expected}, found {}", scan.len()).into()));
        }
        let motion = &reader.sequence().motion;
        let odom_from_radar = motion.odom_from_vehicle(scan.t_ns) * rig.radars[radar].vehicle_from_radar;
        let rates = Doppler::new(&rig.radars[radar], &scan, motion).map(|doppler| doppler.compensated);
        let (w, label) = (table.get::<f32>("w")?, table.get::<u8>("label")?);
        let flags = table.get::<u16>("flags")?;
        let begin = self.sightings.len();
        for (row, position) in scan.positions.iter().enumerate() {
            let place = (odom_from_radar * position).coords.into();
            let rate = rates.as_ref().map_or(f64::NAN, |rates| rates[row]);
            let plausible = label[row] == 1;
            self.sightings.push(Sighting { t_ns: scan.t_ns, place, rate, w: w[row], plausible });
            self.doubt.push(certainty.expected_error(w[row], flags[row]));
            self.scan_of.push(self.scans.len() as u32);
        }
        let at = ScanIndex { radar, scan: key.scan };
        self.scans.push(at);
        self.rows.insert(at, begin..self.sightings.len());
        Ok(())
    }

    /// The thing of each detection, scan by scan.
    pub fn things(&self) -> &[u32] {
        &self.things
    }

    /// How many things there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// What is known of each detection.
    pub fn sightings(&self) -> &[Sighting] {
        &self.sightings
    }

    /// How much the machine itself expects each label to be wrong: [`Certainty::expected_error`].
    pub fn own_doubt(&self) -> &[f32] {
        &self.doubt
    }

    /// Which of the detections are those of a scan; none of one without labels.
    pub fn rows_of(&self, scan: ScanIndex) -> Range<usize> {
        self.rows.get(&scan).cloned().unwrap_or_default()
    }

    /// The scan of a detection, and its place in it.
    pub fn place_of(&self, row: usize) -> (ScanIndex, usize) {
        let scan = self.scan_of(row);
        (scan, row - self.rows_of(scan).start)
    }

    /// The detections of a thing, in rising order.
    pub fn rows_of_thing(&self, thing: u32) -> impl Iterator<Item = usize> {
        (0..self.things.len()).filter(move |row| self.things[*row] == thing)
    }

    /// The scan of a detection.
    pub fn scan_of(&self, row: usize) -> ScanIndex {
        self.scans[self.scan_of[row] as usize]
    }

    /// The scans that have detections, in their order.
    pub fn scans(&self) -> &[ScanIndex] {
        &self.scans
    }
}
