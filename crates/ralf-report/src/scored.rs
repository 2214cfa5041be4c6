//! The detections of a scan with what the method and the truth say of them.

use crate::ReportError;
use ralf::label::{flag, truth_of};
use ralf::sensors::{Radar, Rig};
use ralf::space::{Point, Spherical};
use ralf_data::judge::Certainty;
use ralf_data::result::{RadarScanKey, Table};
use ralf_data::{Causes, Corrections, DataError, GroundTruth, ScanId};

/// The columns that are needed.
pub(crate) const COLUMNS: [&str; 10] =
    ["x", "y", "z", "range", "azimuth", "w_opt", "w_tr", "w", "label", "flags"];

/// One detection.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scored {
    /// From the radar, m; NaN where absent.
    pub(crate) range: f32,
    /// In the radar's frame, rad; NaN where absent.
    pub(crate) azimuth: f32,
    /// NaN where absent.
    pub(crate) w_opt: f32,
    /// NaN where absent.
    pub(crate) w_tr: f32,
    /// The plausibility.
    pub(crate) w: f32,
    /// `gamma_s` at its azimuth.
    pub(crate) gamma: f32,
    /// The label of the run.
    pub(crate) plausible: bool,
    /// Bits of [`flag`].
    pub(crate) flags: u16,
    /// Whether its label is an artifact's at any `w`: see [`Certainty::never_passes`].
    pub(crate) never_passes: bool,
    /// The class that the truth gives it, and whether that is a plausible one; `None` where the truth is silent.
    pub(crate) truth: Option<(u16, bool)>,
    /// The code of its cause; `None` where the scan tells no causes.
    pub(crate) cause: Option<u8>,
}

impl Scored {
    /// Whether the paper's method may call it plausible: floor detections and unobserved ones are artifacts at any `w`.
    pub(crate) fn may_be_papers(&self) -> bool {
        self.flags & (flag::GROUND | flag::UNOBSERVED) == 0
    }
}

/// Where a sequence's tables come from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Origin<'a> {
    /// The sequence's name.
    pub(crate) sequence: &'a str,
    /// Its sensors with the settings of the run.
    pub(crate) rig: &'a Rig,
    /// What the run is sure by.
    pub(crate) certainty: Certainty,
    /// What people say.
    pub(crate) truth: Option<&'a GroundTruth>,
    /// Why artifacts are such.
    pub(crate) causes: Option<&'a Causes>,
    /// What people said in a review.
    pub(crate) corrections: &'a Corrections,
}

impl Origin<'_> {
    /// The detections of a scan, by its table with [`COLUMNS`].
    ///
    /// # Errors
    /// Truth or causes of another size, or that can't be read.
    pub(crate) fn scored(&self, key: &RadarScanKey, table: &Table) -> Result<Vec<Scored>, ReportError> {
        let scan = self.scan_of(key);
        let truths = self.truths(&scan, table.len())?;
        let codes = self.causes.map(|causes| causes.of_scan(&scan, table.len())).transpose()?.flatten();
        let radar = self.rig.radars.iter().find(|radar| *radar.name == *key.radar);
        let decimals = |name| table.get::<f32>(name);
        let (places, w) = (places(radar, table)?, decimals("w")?);
        let (w_opt, w_tr) = (decimals("w_opt")?, decimals("w_tr")?);
        let (label, flags) = (table.get::<u8>("label")?, table.get::<u16>("flags")?);
        let scored = |row: usize| {
            let class = truths.as_ref().map(|truths| truths[row]);
            let [range, azimuth] = places[row];
            Scored {
                range,
                azimuth,
                w_opt: w_opt[row],
                w_tr: w_tr[row],
                w: w[row],
                gamma: radar.map_or(1.0, |radar| radar.reliability.at(azimuth.into()) as f32),
                plausible: label[row] == 1,
                flags: flags[row],
                never_passes: self.certainty.never_passes(flags[row]),
                truth: class.and_then(|class| Some((class, truth_of(class)?))),
                cause: codes.as_ref().map(|codes| codes[row]),
            }
        };
        Ok((0..table.len()).map(scored).collect())
    }

    /// Why detections of a scan are artifacts, where people said it: by their places in the scan, ascending.
    ///
    /// # Errors
    /// Corrections of several contents of the scan.
    pub(crate) fn said_causes(&self, key: &RadarScanKey) -> Result<&[(u32, String)], ReportError> {
        Ok(self.corrections.causes(&self.scan_of(key))?)
    }

    fn scan_of(&self, key: &RadarScanKey) -> ScanId {
        ScanId {
            sequence: self.sequence.to_owned(),
            radar: key.radar.to_string(),
            scan: u32::try_from(key.scan).unwrap_or(u32::MAX),
        }
    }

    /// The classes that the truth gives a scan's detections; `None` where it has no such scan.
    fn truths(&self, scan: &ScanId, detections: usize) -> Result<Option<Vec<u16>>, ReportError> {
        let Some(truth) = self.truth.filter(|truth| truth.scans().binary_search(scan).is_ok()) else {
            return Ok(None);
        };
        let labels = truth.labels(scan)?;
        if labels.len() != detections {
            let file = truth.file(scan);
            let expected = format!("{detections} as in the result");
            let found = labels.len().to_string();
            return Err(DataError::content(&file, "number of labels", expected, found).into());
        }
        Ok(Some(labels.iter().map(|label| label.id).collect()))
    }
}

/// Range and azimuth of each detection, by which the method goes: a field of such a name beside x, y, z is kept as it
/// is, in whatever unit, and says nothing.
fn places(radar: Option<&Radar>, table: &Table) -> Result<Vec<[f32; 2]>, ReportError> {
    let column = |name| table.get::<f32>(name);
    let (range, azimuth) = (column("range")?, column("azimuth")?);
    let is_told =
        |radar: &&Radar| ["range", "azimuth"].iter().any(|name| radar.told_beside_place(name).is_some());
    let Some(radar) = radar.filter(is_told) else {
        return Ok(range.iter().zip(azimuth).map(|(range, azimuth)| [*range, *azimuth]).collect());
    };
    let radar_from_vehicle = radar.vehicle_from_radar.inverse();
    let (x, y, z) = (column("x")?, column("y")?, column("z")?);
    let place = |row: usize| {
        let place = Spherical::from_cartesian(
            &(radar_from_vehicle * Point::new(x[row].into(), y[row].into(), z[row].into())),
        );
        [place.range, place.azimuth].map(|value| value as f32)
    };
    Ok((0..table.len()).map(place).collect())
}

#[cfg(test)]
impl Scored {
    /// One with this plausibility by every branch, of which nothing else is known.
    pub(crate) fn with(w: f32) -> Self {
        Self {
            range: 1.0,
            azimuth: 0.0,
            w_opt: w,
            w_tr: w,
            w,
            gamma: 1.0,
            plausible: false,
            flags: 0,
            never_passes: false,
            truth: None,
            cause: None,
        }
    }
}
