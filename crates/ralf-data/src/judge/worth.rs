//! What a run's plausibilities are worth beyond its labels: against the truth.

use crate::disk::files;
use crate::error::DataError;
use crate::judge::{Certainty, Comparison};
use crate::result::LabelledRun;
use crate::tree::RECORD;
use crate::truth::{GroundTruth, ScanId};
use ralf::metrics::{Evaluation, ScoredDetections};
use std::collections::BTreeSet;
use std::path::Path;

impl Comparison {
    /// The metrics of all scans, and what the plausibilities are worth where the folder `out` has a table of them:
    /// label files that others have made have none.
    ///
    /// # Errors
    /// Tables or truth that can't be read.
    pub fn evaluation_of(&self, out: &Path, truth: &GroundTruth) -> Result<Evaluation, DataError> {
        let seen = match files::exists(&out.join(RECORD))? {
            true => Some(self.scored(&LabelledRun::open(out)?, truth)?),
            false => None,
        };
        Ok(Evaluation { plausibility: seen.map(|seen| seen.worth()), ..self.evaluation() })
    }

    /// The detections with truth of all scans that were compared.
    fn scored(&self, run: &LabelledRun, truth: &GroundTruth) -> Result<ScoredDetections, DataError> {
        let certainty = Certainty::of(&run.settings().method);
        let compared: BTreeSet<&ScanId> = self.scans.iter().map(|(scan, _)| scan).collect();
        let mut seen = ScoredDetections::default();
        for record in &run.record().sequences {
            if !self.scans.iter().any(|(scan, _)| scan.sequence == record.name) {
                continue;
            }
            run.table(record)?.each(&["w", "flags"], |key, table| {
                let (sequence, radar) = (record.name.clone(), key.radar.to_string());
                let scan = ScanId { sequence, radar, scan: u32::try_from(key.scan).unwrap_or(u32::MAX) };
                if !compared.contains(&scan) {
                    return Ok(());
                }
                let (w, flags) = (table.get::<f32>("w")?, table.get::<u16>("flags")?);
                for (truth, (w, flags)) in truth.labels(&scan)?.iter().zip(w.iter().zip(flags)) {
                    if let Some(plausible) = ralf::label::truth_of(truth.id) {
                        seen.add(f64::from(*w), certainty.never_passes(*flags), plausible);
                    }
                }
                Ok::<_, DataError>(())
            })?;
        }
        Ok(seen)
    }
}
