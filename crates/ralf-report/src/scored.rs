//! All detections of a run with what the method and the truth say of them.

use crate::ReportError;
use ralf::config::Config;
use ralf::label::{flag, truth_of};
use ralf::sensors::Rig;
use ralf_data::result::LabelledRows;
use ralf_data::{Causes, DataError, GroundTruth, ScanId};
use std::ops::Range;
use std::path::Path;

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
    /// The class that the truth gives it, and whether that is a plausible one; `None` where the truth is silent.
    pub(crate) truth: Option<(u16, bool)>,
    /// Index into [`Detections::causes`]; `None` where the scan tells no causes.
    pub(crate) cause: Option<usize>,
}

impl Scored {
    /// Whether it may be plausible at all: floor detections and unobserved ones are artifacts at any `w`.
    pub(crate) fn may_be_plausible(&self) -> bool {
        self.flags & (flag::GROUND | flag::UNOBSERVED) == 0
    }
}

/// Where a sequence's rows come from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Origin<'a> {
    /// The dataset's folder.
    pub(crate) dataset: &'a Path,
    /// The sequence's name.
    pub(crate) sequence: &'a str,
    /// Its sensors with the settings of the run.
    pub(crate) rig: &'a Rig,
    /// What people say.
    pub(crate) truth: Option<&'a GroundTruth>,
}

/// The detections of all sequences.
#[derive(Debug, Default)]
pub(crate) struct Detections {
    /// In the order of sequence, radar, scan, point.
    pub(crate) all: Vec<Scored>,
    /// Names of the causes of artifacts; several sequences may share some.
    pub(crate) causes: Vec<String>,
}

impl Detections {
    /// Those that the truth says something of, and whether they are plausible.
    pub(crate) fn with_truth(&self) -> impl Iterator<Item = (&Scored, bool)> {
        self.all.iter().filter_map(|scored| Some((scored, scored.truth?.1)))
    }

    /// Adds a sequence's rows.
    pub(crate) fn add(&mut self, origin: Origin, rows: &LabelledRows) -> Result<(), ReportError> {
        let causes = Causes::find(origin.dataset, origin.sequence)?;
        let names = causes.as_ref().map_or(&[][..], Causes::names);
        let index_of_code: Vec<usize> = names.iter().map(|name| self.index_of_cause(name)).collect();
        for scan_rows in scans(rows) {
            let scan = ScanId {
                sequence: origin.sequence.to_owned(),
                radar: rows.radars[rows.radar[scan_rows.start]].clone(),
                scan: u32::try_from(rows.scan[scan_rows.start]).unwrap_or(u32::MAX),
            };
            let truths = truths(origin, &scan, scan_rows.len())?;
            let codes = causes.as_ref().map(|causes| causes.of_scan(&scan, scan_rows.len())).transpose()?;
            let gamma = origin.rig.radars.iter().find(|radar| radar.name == scan.radar);
            for (point, row) in scan_rows.enumerate() {
                let azimuth = rows.azimuth[row];
                let known = truths.as_ref().map(|truths| truths[point]);
                self.all.push(Scored {
                    range: rows.range[row],
                    azimuth,
                    w_opt: rows.w_opt[row],
                    w_tr: rows.w_tr[row],
                    w: rows.w[row],
                    gamma: gamma.map_or(1.0, |radar| radar.reliability.at(azimuth.into()) as f32),
                    plausible: rows.label[row] == 1,
                    flags: rows.flags[row],
                    truth: known.and_then(|class| Some((class, truth_of(class)?))),
                    cause: codes
                        .iter()
                        .flatten()
                        .next()
                        .map(|codes| index_of_code[usize::from(codes[point])]),
                });
            }
        }
        Ok(())
    }

    fn index_of_cause(&mut self, name: &str) -> usize {
        let known = self.causes.iter().position(|known| known == name);
        known.unwrap_or_else(|| {
            self.causes.push(name.to_owned());
            self.causes.len() - 1
        })
    }
}

/// The rows of each scan, in order.
fn scans(rows: &LabelledRows) -> Vec<Range<usize>> {
    let starts = (0..rows.scan.len()).filter(|row| {
        *row == 0 || rows.scan[*row] != rows.scan[row - 1] || rows.radar[*row] != rows.radar[row - 1]
    });
    let starts: Vec<usize> = starts.chain([rows.scan.len()]).collect();
    starts.windows(2).map(|pair| pair[0]..pair[1]).collect()
}

/// The classes that the truth gives a scan's detections; `None` where it has no such scan.
fn truths(origin: Origin, scan: &ScanId, detections: usize) -> Result<Option<Vec<u16>>, ReportError> {
    let Some(truth) = origin.truth.filter(|truth| truth.scans().binary_search(scan).is_ok()) else {
        return Ok(None);
    };
    let labels = truth.labels(scan)?;
    if labels.len() != detections {
        let file = scan.truth_file(origin.dataset);
        let expected = format!("{detections} as in the result");
        let found = labels.len().to_string();
        return Err(DataError::content(&file, "number of labels", expected, found).into());
    }
    Ok(Some(labels.iter().map(|label| label.id).collect()))
}

/// The sensors of a recording with the settings of a run.
pub(crate) fn rig_of_run(
    dataset: &Path,
    sequence: &str,
    rig: &Rig,
    config: &Config,
) -> Result<Rig, ReportError> {
    let mut rig = rig.clone();
    config.apply_to(&mut rig).map_err(|error| {
        let place = format!("sequence {sequence}");
        DataError::Unsuitable { file: dataset.to_owned(), place, reason: error.to_string() }
    })?;
    Ok(rig)
}
