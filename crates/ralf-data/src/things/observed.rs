//! All evidence on the detections of a sequence that is labelled.

use super::SequenceThings;
use crate::frames::{Frames, ScanIndex};
use crate::read::SequenceReader;
use ralf::config::Config;
use ralf::evidence::{features, observe};
use ralf::learned::{Model, Rows, UseError};
use ralf::scene::FrameWindow;
use ralf::sensors::Rig;
use ralf_train::learning::direction;
use std::convert::Infallible;

/// What was observed of every detection of a sequence, in the order of its [`SequenceThings`].
#[derive(Debug, Clone)]
pub struct Observed {
    /// [`features`], what a model makes of them (log odds), and the plausibility that the run found.
    pub(super) rows: Rows,
    /// By column: 1 where more of it never makes a detection less plausible, -1 where never more, else 0.
    pub(super) monotone: Vec<i8>,
}

impl Observed {
    /// Gathers it from a recording; `rig` and `config` are those with which it was labelled. Of a scan that can't be
    /// read nothing is observed. The result is the same for any `jobs`.
    ///
    /// # Errors
    /// A model that this program can't use.
    pub fn of(
        reader: &dyn SequenceReader,
        (rig, config): (&Rig, &Config),
        model: &Model,
        things: &SequenceThings,
        jobs: usize,
    ) -> Result<Self, UseError> {
        model.check()?;
        let columns = model.places_among(features().map(|feature| feature.name))?;
        let scans: Vec<ScanIndex> =
            things.scans().iter().map(|(radar, scan)| ScanIndex { radar: *radar, scan: *scan }).collect();
        let frames = Frames { reader, rig, config, evidence: true, jobs };
        let gathered = frames.each(&scans, |window, at| {
            let ScanIndex { radar, scan } = scans[at];
            Ok::<_, Infallible>(observed(window, (radar, scan), things.rows_of(radar, scan).len(), config))
        });
        let gathered = gathered.unwrap_or_else(|never| match never {});
        let width = features().count();
        let mut evidence = Rows::absent(0, width);
        for rows in &gathered {
            evidence.append(rows);
        }
        let log_odds = model.plausible.log_odds(&evidence.pick_columns(&columns));
        let mut rows = Rows::absent(evidence.len(), width + 2);
        for (row, (log_odds, sighting)) in log_odds.into_iter().zip(things.sightings()).enumerate() {
            let to = rows.row_mut(row);
            to[..width].copy_from_slice(evidence.row(row));
            (to[width], to[width + 1]) = (log_odds as f32, sighting.w);
        }
        let monotone = features().map(|feature| direction(feature.name)).chain([1, 0]).collect();
        Ok(Self { rows, monotone })
    }
}

/// The evidence on one scan; nothing where it can't be gathered.
fn observed(
    window: &mut FrameWindow,
    (radar, scan): (usize, usize),
    detections: usize,
    config: &Config,
) -> Rows {
    let mut rows = Rows::absent(detections, features().count());
    if let Ok(frame) = window.frame(radar, scan) {
        for (place, column) in observe(&frame, config).iter().enumerate() {
            rows.set_column(place, &column.values);
        }
    }
    rows
}
