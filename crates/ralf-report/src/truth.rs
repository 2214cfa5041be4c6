//! The truth that the page compares with, and where it comes from.

use crate::Report;
use crate::number::grouped;
use ralf_data::{Comparison, Corrections, DataError, GroundTruth, partly_corrected, told_partly_corrected};

/// How much was said in a review, and what becomes of it: a sentence without the last dot.
pub fn told_corrections(corrections: &Corrections, are: &str) -> String {
    let detections = grouped(corrections.corrected_detections() as u64);
    let scans = grouped(corrections.reviewed_scans() as u64);
    format!("{detections} corrected detections and {scans} reviewed scans are {are}")
}

/// The truth about the sequences that the page is about.
pub(crate) struct Truth {
    /// `None` where nobody says anything.
    pub(crate) labels: Option<GroundTruth>,
    /// What of it people said in a review.
    pub(crate) corrections: Corrections,
    /// Where it comes from, where that isn't the recording alone; a sentence each, without the last dot.
    pub(crate) told: Vec<String>,
}

impl Truth {
    /// What the recording and a review say of the sequences of these names.
    ///
    /// # Errors
    /// Truth or corrections that are damaged or can't be read.
    pub(crate) fn gather(report: &Report, names: &[&str]) -> Result<Self, DataError> {
        let corrections = Corrections::of_recording(report.out, report.recording)?;
        let labels = GroundTruth::find_merged(&report.recording.path, corrections.clone())?;
        let labels = labels.and_then(|truth| truth.of_sequences(names));
        let concerned = corrections.clone().of_scans(|scan| names.contains(&scan.sequence.as_str()));
        let mut told = Vec::new();
        if !concerned.is_empty() {
            told.push(told_corrections(&concerned, "merged into the truth"));
        }
        let partly = labels.as_ref().map_or(0, partly_corrected);
        told.extend(told_partly_corrected(partly));
        Ok(Self { labels, corrections, told })
    }

    /// A sentence for each scan whose corrections belong to another content, or to what can't be read.
    pub(crate) fn orphaned(&self) -> Vec<String> {
        self.corrections.told_orphaned()
    }

    /// Labels against it, where there is some.
    pub(crate) fn comparison(&self, report: &Report) -> Result<Option<Comparison>, DataError> {
        self.labels.as_ref().map(|truth| Comparison::new(report.out, truth)).transpose()
    }

    /// [`Self::told`] as lines that name the file.
    pub(crate) fn lines(&self) -> Vec<String> {
        let file = self.corrections.file().display();
        self.told.iter().map(|sentence| format!("{file}: {sentence}")).collect()
    }
}
