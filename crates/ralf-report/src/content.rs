//! Everything that the page tells, gathered.

use crate::scored::{Detections, Origin, rig_of_run};
use crate::{Pictures, Report, ReportError, pictures};
use ralf::metrics::Separation;
use ralf_data::result::{LabelledRows, LabelledRun, RunRecord, read_labelled_rows};
use ralf_data::{Balance, Comparison, Corrections, GroundTruth, SequenceReader};
use ralf_plot::Extent;

/// Widths of the pictures, pixels: an overview's half, a scan.
const WIDTHS: [u32; 2] = [760, 760];
/// One in so many of the scans that are drawn is an uncertain one.
const UNCERTAIN: usize = 3;

/// What the page tells.
pub(crate) struct Content {
    /// The recording's folder, without those above it.
    pub(crate) dataset: String,
    /// Of the run.
    pub(crate) record: RunRecord,
    /// The detections of all sequences.
    pub(crate) detections: Detections,
    /// Labels against truth, where there is some.
    pub(crate) comparison: Option<Comparison>,
    /// Of all sequences together.
    pub(crate) balance: Balance,
    /// In the recording's order.
    pub(crate) sequences: Vec<SequenceContent>,
}

/// One sequence.
pub(crate) struct SequenceContent {
    /// Its name.
    pub(crate) name: String,
    /// Its title for people.
    pub(crate) title: String,
    /// How its labels are spread.
    pub(crate) balance: Balance,
    /// All its scans; PNG.
    pub(crate) overview: Vec<u8>,
    /// The radar that numbers the scans below.
    pub(crate) radar: String,
    /// Some of its scans.
    pub(crate) scans: Vec<ScanContent>,
}

/// One scan that is drawn.
pub(crate) struct ScanContent {
    /// Its number.
    pub(crate) scan: usize,
    /// Whether it is shown for its uncertainty.
    pub(crate) uncertain: bool,
    /// Raw, then labelled; PNG.
    pub(crate) pictures: [Vec<u8>; 2],
}

impl Content {
    /// Reads and draws everything.
    pub(crate) fn gather(report: &Report, progress: &dyn Fn(&str)) -> Result<Self, ReportError> {
        let dataset = &report.recording.path;
        let run = LabelledRun::open(report.out)?;
        let mut record = run.record().clone();
        let names: Vec<&str> =
            report.recording.sequences.iter().map(|reader| reader.sequence().name.as_str()).collect();
        record.sequences.retain(|sequence| names.contains(&sequence.name.as_str()));
        let corrections = Corrections::of_recording(report.out, report.recording)?;
        let orphaned: Vec<String> = corrections.orphaned().iter().map(ToString::to_string).collect();
        let truth =
            GroundTruth::find_merged(dataset, corrections)?.and_then(|truth| truth.of_sequences(&names));
        let comparison = truth.as_ref().map(|truth| Comparison::new(report.out, truth)).transpose()?;
        let mut detections = Detections::default();
        let (mut sequences, mut overall) = (Vec::new(), Separation::default());
        for reader in &report.recording.sequences {
            let sequence = reader.sequence();
            progress(&format!("sequence {}", sequence.name));
            let labelled = run.sequence(reader.as_ref())?;
            let rows = read_labelled_rows(labelled.tables.file())?;
            let rig = labelled.rig;
            let origin = Origin { dataset, sequence: &sequence.name, rig: &rig, truth: truth.as_ref() };
            detections.add(origin, &rows)?;
            answers(&rows).for_each(|(w, plausible)| overall.add(w, plausible));
            let threshold = record.settings.method.fusion.threshold;
            sequences.push(SequenceContent::draw(
                reader.as_ref(),
                &rows,
                report.scans_per_sequence,
                threshold,
            )?);
        }
        let name = dataset.canonicalize().ok();
        let name = name.as_ref().unwrap_or(dataset).file_name().unwrap_or_default();
        let dataset = name.to_string_lossy().into_owned();
        Ok(Self { dataset, record, detections, comparison, balance: overall.into(), sequences })
    }
}

impl SequenceContent {
    fn draw(
        reader: &dyn SequenceReader,
        rows: &LabelledRows,
        wanted: usize,
        threshold: f64,
    ) -> Result<Self, ReportError> {
        let pictures = Pictures { reader, rows, radar: None, extent: Extent::Fit };
        let sequence = reader.sequence();
        let radar = sequence.rig.radars.first().map_or(String::new(), |radar| radar.name.clone());
        let draw = |(scan, uncertain)| {
            use pictures::Detections::{Labelled, Raw};
            let pictures = [pictures.scan(scan, Raw, WIDTHS[1])?, pictures.scan(scan, Labelled, WIDTHS[1])?];
            Ok(ScanContent { scan, uncertain, pictures })
        };
        let count = sequence.times.radars.first().map_or(0, Vec::len);
        let chosen = choose(count, wanted, &uncertain_scans(rows, &radar, threshold));
        Ok(Self {
            name: sequence.name.clone(),
            title: sequence.title.clone(),
            balance: answers(rows).collect::<Separation>().into(),
            overview: pictures.overview(WIDTHS[0])?,
            radar,
            scans: chosen.into_iter().map(draw).collect::<Result<_, ReportError>>()?,
        })
    }
}

fn answers(rows: &LabelledRows) -> impl Iterator<Item = (f64, bool)> {
    rows.w.iter().zip(&rows.label).map(|(w, label)| (f64::from(*w), *label == 1))
}

/// The scans of a radar, those first whose plausibilities are on average closest to the threshold.
fn uncertain_scans(rows: &LabelledRows, radar: &str, threshold: f64) -> Vec<usize> {
    let of_radar = (0..rows.scan.len()).filter(|row| rows.radars[rows.radar[*row]] == radar);
    let mut sums: Vec<(usize, f64, u32)> = Vec::new();
    for row in of_radar {
        let distance = (f64::from(rows.w[row]) - threshold).abs();
        match sums.last_mut() {
            Some((scan, sum, count)) if *scan == rows.scan[row] => {
                (*sum, *count) = (*sum + distance, *count + 1)
            }
            _ => sums.push((rows.scan[row], distance, 1)),
        }
    }
    let mut means: Vec<(f64, usize)> =
        sums.into_iter().map(|(scan, sum, count)| (sum / f64::from(count), scan)).collect();
    means.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    means.into_iter().map(|(_, scan)| scan).collect()
}

/// Some scans of so many, in order: a third of them the most uncertain, the others evenly spread. The flag tells which.
fn choose(count: usize, wanted: usize, uncertain_first: &[usize]) -> Vec<(usize, bool)> {
    let wanted = wanted.min(count);
    let even = wanted - wanted / UNCERTAIN;
    let mut chosen: Vec<(usize, bool)> =
        (0..even).map(|i| (i * (count - 1) / even.saturating_sub(1).max(1), false)).collect();
    for scan in uncertain_first {
        if chosen.len() < wanted && chosen.iter().all(|(known, _)| known != scan) {
            chosen.push((*scan, true));
        }
    }
    chosen.sort_unstable();
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scans_are_spread_and_the_uncertain_among_them() {
        let chosen = choose(100, 6, &[99, 41, 7, 3]);
        assert_eq!(chosen, [(0, false), (7, true), (33, false), (41, true), (66, false), (99, false)]);
        assert_eq!(choose(2, 6, &[1, 0]), [(0, false), (1, false)]);
        assert_eq!(choose(5, 1, &[]), [(0, false)]);
        assert_eq!(choose(0, 6, &[]), []);
        assert_eq!(choose(9, 0, &[4]), []);
    }

    #[test]
    fn closeness_to_the_threshold_makes_a_scan_uncertain() {
        let rows = LabelledRows {
            radars: vec!["front".into(), "rear".into()],
            radar: vec![0, 0, 0, 1],
            scan: vec![0, 1, 1, 2],
            w: vec![0.9, 0.4, 0.6, 0.5],
            ..LabelledRows::default()
        };
        assert_eq!(uncertain_scans(&rows, "front", 0.5), [1, 0]);
    }
}
