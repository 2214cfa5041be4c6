//! Everything that the page tells, gathered.

use crate::classes::{self, Classes};
use crate::evidence::{self, EvidenceColumn};
use crate::findings::Findings;
use crate::pictures::first_with_scans;
use crate::reasons::{self, Weight};
use crate::scored::{COLUMNS, Origin, Scored};
use crate::told::{self, Told};
use crate::truth::Truth;
use crate::{AsFarAsRead, Detections, Pictures, Report, ReportError};
use ralf::metrics::Separation;
use ralf_data::judge::Certainty;
use ralf_data::result::{LabelledRun, LabelledSequence, RunRecord};
use ralf_data::{Balance, Causes, Comparison, DataError, SequenceReader};
use ralf_plot::Extent;
use std::collections::BTreeSet;

/// Widths of the pictures, pixels: an overview's half, a scan.
const WIDTHS: [u32; 2] = [760, 760];
/// One in so many of the scans that are drawn is an uncertain one.
const UNCERTAIN: usize = 3;
/// Sequences that are drawn at most: a page of thousands of pictures opens in no browser.
const MOST_DRAWN: usize = 20;

/// What the page tells.
pub(crate) struct Content {
    /// The recording's folder, without those above it.
    pub(crate) dataset: String,
    /// Of the run.
    pub(crate) record: RunRecord,
    /// What is counted over the detections of all sequences.
    pub(crate) findings: Findings,
    /// What each column of evidence says, where evidence was gathered.
    pub(crate) evidence: Vec<EvidenceColumn>,
    /// What a model tells in words, where one was asked.
    pub(crate) told: Vec<Told>,
    /// What weighs most in its answers.
    pub(crate) reasons: Vec<Weight>,
    /// Of sequences in which a sensor tells classes.
    pub(crate) classes: Option<Classes>,
    /// Labels against truth, where there is some.
    pub(crate) comparison: Option<Comparison>,
    /// Of all sequences together.
    pub(crate) balance: Balance,
    /// In the recording's order.
    pub(crate) sequences: Vec<SequenceContent>,
    /// Sequences of the recording that are not labelled.
    pub(crate) without_labels: Vec<String>,
    /// What labels are compared with.
    pub(crate) truth: Truth,
    /// LiDAR scans that the pictures lack, a sentence each.
    pub(crate) drawn_without: Vec<String>,
}

/// One sequence.
pub(crate) struct SequenceContent {
    /// Its name.
    pub(crate) name: String,
    /// How its labels are spread.
    pub(crate) balance: Balance,
    /// What it looks like; `None` where others stand for it.
    pub(crate) drawn: Option<DrawnSequence>,
}

/// The pictures of one sequence.
pub(crate) struct DrawnSequence {
    /// Its name.
    pub(crate) name: String,
    /// Its title for people.
    pub(crate) title: String,
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
    /// Reads and draws everything. Sequences that are not labelled are named and left out.
    pub(crate) fn gather(report: &Report, progress: &dyn Fn(&str)) -> Result<Self, ReportError> {
        let dataset = &report.recording.path;
        let run = LabelledRun::open(report.out)?;
        let readers = report.recording.sequences.iter().map(AsRef::as_ref);
        let (readers, others): (Vec<&dyn SequenceReader>, Vec<_>) =
            readers.partition(|reader| run.holds(&reader.sequence().name));
        let names: Vec<&str> = readers.iter().map(|reader| reader.sequence().name.as_str()).collect();
        let without_labels: Vec<String> =
            others.iter().map(|reader| reader.sequence().name.clone()).collect();
        if names.is_empty() {
            let found = format!("none of them (the recording holds {})", without_labels.join(", "));
            let place = "run.json, sequences";
            return Err(DataError::content(report.out, place, "labels of the recording", found).into());
        }
        let mut record = run.record().clone();
        record.retain(|sequence| names.contains(&sequence.name.as_str()));
        let truth = Truth::gather(report, &names)?;
        let comparison = truth.comparison(report)?;
        let (mut findings, mut overall) = (Findings::default(), Separation::default());
        let (mut sequences, mut evidence, mut classes) = (Vec::new(), Vec::new(), None);
        let (mut told, mut reasons, mut drawn_without) = (Vec::new(), Vec::new(), Vec::new());
        let drawn = evenly(readers.len(), MOST_DRAWN);
        for (index, reader) in readers.iter().enumerate() {
            progress(&format!("sequence {}", reader.sequence().name));
            let labelled = run.sequence(*reader)?;
            let counted = Counted::gather(report, *reader, &labelled, &truth, &mut findings, &mut overall)?;
            evidence::add(&mut evidence, &labelled.tables)?;
            told::add(&mut told, &labelled.tables)?;
            reasons::add(&mut reasons, &labelled.tables)?;
            classes::add(&mut classes, &labelled.tables)?;
            let wanted = drawn.contains(&index).then_some(report.scans_per_sequence);
            let as_read = AsFarAsRead::new(*reader);
            let draw = |wanted| DrawnSequence::draw(&as_read, &labelled, &counted.uncertain, wanted);
            let drawn = wanted.map(draw).transpose()?;
            drawn_without.extend(as_read.drawn_without());
            let name = reader.sequence().name.clone();
            sequences.push(SequenceContent { name, balance: counted.balance, drawn });
        }
        let name = dataset.canonicalize().ok();
        let name = name.as_ref().unwrap_or(dataset).file_name().unwrap_or_default();
        let dataset = name.to_string_lossy().into_owned();
        Ok(Self {
            dataset,
            record,
            findings,
            evidence,
            told,
            reasons,
            classes,
            comparison,
            balance: overall.into(),
            sequences,
            without_labels,
            truth,
            drawn_without,
        })
    }

    /// The sequences that the truth says nothing of, while it does of others.
    pub(crate) fn without_truth(&self) -> Vec<String> {
        let without = self.comparison.as_ref().map_or(&[][..], |comparison| &comparison.without_truth);
        let names = self.sequences.iter().map(|sequence| &sequence.name);
        names.filter(|name| without.contains(name)).cloned().collect()
    }
}

/// What is counted over the detections of one sequence.
struct Counted {
    balance: Balance,
    /// The scans of [`first_radar`] with uncertain detections ([`Certainty::is_uncertain`]), those first that have the
    /// largest share of them.
    uncertain: Vec<usize>,
}

impl Counted {
    /// Goes through the sequence's tables once.
    fn gather(
        report: &Report,
        reader: &dyn SequenceReader,
        labelled: &LabelledSequence,
        truth: &Truth,
        findings: &mut Findings,
        overall: &mut Separation,
    ) -> Result<Self, ReportError> {
        let (dataset, sequence) = (&report.recording.path, &reader.sequence().name);
        let Truth { labels: truth, corrections, .. } = truth;
        let truth = truth.as_ref();
        let causes = truth.map_or_else(|| Causes::find(dataset, sequence), |truth| truth.causes(sequence))?;
        findings.groups.name_causes(causes.as_ref().map_or(&[], Causes::names));
        let certainty = Certainty::of(&labelled.settings);
        let origin =
            Origin { sequence, rig: &labelled.rig, certainty, truth, causes: causes.as_ref(), corrections };
        let radar = first_radar(reader);
        let (mut balance, mut shares) = (Separation::default(), Vec::new());
        labelled.tables.each(&COLUMNS, |key, table| {
            let scan = origin.scored(key, table)?;
            findings.add(&scan, causes.as_ref(), origin.said_causes(key)?);
            for scored in &scan {
                balance.add(scored.w.into(), scored.plausible);
                overall.add(scored.w.into(), scored.plausible);
            }
            if *key.radar == *radar {
                shares.push((uncertain_share(&scan, &certainty), key.scan));
            }
            Ok::<_, ReportError>(())
        })?;
        Ok(Self { balance: balance.into(), uncertain: in_order(shares) })
    }
}

impl DrawnSequence {
    fn draw(
        reader: &dyn SequenceReader,
        labelled: &LabelledSequence,
        uncertain: &[usize],
        wanted: usize,
    ) -> Result<Self, ReportError> {
        let pictures = Pictures { reader, tables: &labelled.tables, radar: None, extent: Extent::Fit };
        let sequence = reader.sequence();
        let radar = first_radar(reader);
        // One without labels would look as if it held no detections.
        let not_labelled = labelled.record.not_labelled.iter().filter(|scan| scan.radar == radar);
        let not_labelled: BTreeSet<usize> = not_labelled.map(|scan| scan.scan).collect();
        let count = first_with_scans(sequence).map_or(0, |radar| sequence.times.radars[radar].len());
        let with_labels: Vec<usize> = (0..count).filter(|scan| !not_labelled.contains(scan)).collect();
        let mut scans = Vec::new();
        for (scan, uncertain) in choose(&with_labels, wanted, uncertain) {
            let raw = pictures.scan(scan, Detections::Raw, WIDTHS[1])?;
            let pictures = [raw, pictures.scan(scan, Detections::Labelled, WIDTHS[1])?];
            scans.push(ScanContent { scan, uncertain, pictures });
        }
        Ok(Self {
            name: sequence.name.clone(),
            title: sequence.title.clone(),
            overview: pictures.overview(WIDTHS[0])?,
            radar,
            scans,
        })
    }
}

/// The radar that numbers the scans that are drawn.
fn first_radar(reader: &dyn SequenceReader) -> String {
    let sequence = reader.sequence();
    first_with_scans(sequence).map_or(String::new(), |radar| sequence.rig.radars[radar].name.clone())
}

/// The share of a scan's detections that are uncertain.
fn uncertain_share(scan: &[Scored], certainty: &Certainty) -> f64 {
    let uncertain = scan.iter().filter(|scored| certainty.is_uncertain(scored.w, scored.flags)).count();
    uncertain as f64 / scan.len().max(1) as f64
}

/// The scans with a share at all, the largest first.
fn in_order(mut shares: Vec<(f64, usize)>) -> Vec<usize> {
    shares.retain(|(share, _)| *share > 0.0);
    shares.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    shares.into_iter().map(|(_, scan)| scan).collect()
}

/// So many of `count`, or all of them where these are fewer: both ends, and the others evenly between them.
fn evenly(count: usize, wanted: usize) -> Vec<usize> {
    let wanted = wanted.min(count);
    (0..wanted).map(|i| i * (count - 1) / wanted.saturating_sub(1).max(1)).collect()
}

/// Some of these scans, in order: a third of them the most uncertain, the others evenly spread. The flag tells which.
fn choose(scans: &[usize], wanted: usize, uncertain_first: &[usize]) -> Vec<(usize, bool)> {
    let wanted = wanted.min(scans.len());
    let even = wanted - (wanted / UNCERTAIN).min(uncertain_first.len());
    let spread = evenly(scans.len(), even).into_iter().map(|place| (scans[place], false));
    let mut chosen: Vec<(usize, bool)> = spread.collect();
    // Where uncertain ones are among the others already, the next ones stand in.
    let others = scans.iter().map(|scan| (*scan, false));
    for (scan, uncertain) in uncertain_first.iter().map(|scan| (*scan, true)).chain(others) {
        if chosen.len() < wanted && chosen.iter().all(|(known, _)| *known != scan) {
            chosen.push((scan, uncertain));
        }
    }
    chosen.sort_unstable();
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::label::flag;

    #[test]
    fn scans_are_spread_and_the_uncertain_among_them() {
        let choose = |scans: std::ops::Range<usize>, wanted, uncertain: &[usize]| {
            super::choose(&scans.collect::<Vec<_>>(), wanted, uncertain)
        };
        let chosen = choose(0..100, 6, &[99, 41, 7, 3]);
        assert_eq!(chosen, [(0, false), (7, true), (33, false), (41, true), (66, false), (99, false)]);
        assert_eq!(choose(0..2, 6, &[1, 0]), [(0, false), (1, false)]);
        assert_eq!(choose(0..5, 1, &[]), [(0, false)]);
        assert_eq!(choose(0..0, 6, &[]), []);
        assert_eq!(choose(0..9, 0, &[4]), []);
        assert_eq!(super::choose(&[2, 5], 6, &[5]), [(2, false), (5, false)], "the others have no labels");
    }

    #[test]
    fn no_more_sequences_are_drawn_than_a_page_can_hold() {
        assert_eq!(evenly(3, MOST_DRAWN), [0, 1, 2]);
        assert_eq!(evenly(10, MOST_DRAWN), (0..10).collect::<Vec<_>>());
        let many = evenly(150, MOST_DRAWN);
        assert_eq!((many.len(), many[0], many[MOST_DRAWN - 1]), (MOST_DRAWN, 0, 149));
        assert!(evenly(0, MOST_DRAWN).is_empty());
    }

    /// A floor detection is decided, however near to the threshold.
    #[test]
    fn doubtful_detections_make_a_scan_uncertain() {
        let scored = |w, flags| Scored { flags, ..Scored::with(w) };
        let scans = [
            vec![scored(0.9, 0), scored(0.55, 0)],
            vec![scored(0.45, 0), scored(0.55, 0)],
            vec![scored(0.5, flag::GROUND)],
            vec![],
        ];
        let order = |calibrated| {
            let certainty = Certainty { threshold: 0.5, calibrated };
            let shares = scans.iter().enumerate();
            in_order(shares.map(|(scan, scored)| (uncertain_share(scored, &certainty), scan)).collect())
        };
        assert_eq!(order(false), [1, 0]);
        assert_eq!(order(true), [1, 2, 0], "a model isn't sure because something lies on the floor");
    }
}
