//! The detections of a scan with what the method and the truth say of them.

use crate::ReportError;
use ralf::label::{flag, truth_of};
use ralf::sensors::Rig;
use ralf_data::judge::Certainty;
use ralf_data::result::{RadarScanKey, Table};
use ralf_data::{Causes, Corrections, DataError, GroundTruth, ScanId};

/// The columns that are needed.
pub(crate) const COLUMNS: [&str; 7] = ["range", "azimuth", "w_opt", "w_tr", "w", "label", "flags"];

/// One detection.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scored {
    /// As measured, m; NaN where absent.
    pub(crate) range: f32,
    /// As measured, rad; NaN where absent.
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
        let (range, azimuth, w) = (decimals("range")?, decimals("azimuth")?, decimals("w")?);
        let (w_opt, w_tr) = (decimals("w_opt")?, decimals("w_tr")?);
        let (label, flags) = (table.get::<u8>("label")?, table.get::<u16>("flags")?);
        let scored = |row: usize| {
            let class = truths.as_ref().map(|truths| truths[row]);
            Scored {
                range: range[row],
                azimuth: azimuth[row],
                w_opt: w_opt[row],
                w_tr: w_tr[row],
                w: w[row],
                gamma: radar.map_or(1.0, |radar| radar.reliability.at(azimuth[row].into()) as f32),
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
