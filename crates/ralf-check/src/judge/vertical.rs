//! Roll and pitch of a radar that measures elevation: its detections are as high as what they lie on.

use super::case::Case;
use super::places::{PLACE, PLACES, by_place};
use crate::change::SensorChange;
use crate::overlap::Measure;
use crate::remedy::Remedy;
use crate::verdict::{Question, Verdict};
use ralf::sensors::Elevation;

/// Degrees that are tried.
const TILTS: [f64; 6] = [-6.0, -4.0, -2.0, 2.0, 4.0, 6.0];

/// Judges each radar that measures elevation; nothing is said of those in order. From one place it sees the same few
/// low things in every scan, and how high their strongest spots are is theirs: several places are needed.
pub(super) fn judge(case: &Case) -> Vec<Verdict> {
    let places = by_place(case.lidars.iter().copied().filter(|look| look.lidar == 0), &case.motion).len();
    case.radars().filter_map(|radar| one(case, radar, places)).collect()
}

fn one(case: &Case, radar: usize, places: usize) -> Option<Verdict> {
    let sensor = &case.sequence.rig.radars[radar];
    if sensor.elevation == Elevation::None {
        return None;
    }
    if places < PLACES {
        let missing = format!(
            "its roll and pitch are judged by low things seen from {PLACES} places: {:.0} m of driving are needed",
            PLACE * PLACES as f64
        );
        return Some(Verdict::cannot_judge(&sensor.name, Question::Lidar, missing));
    }
    let tally = |change: &SensorChange| case.overlap(radar, change, Measure::AsHigh);
    let now = tally(&SensorChange::default());
    let tilts =
        TILTS.into_iter().flat_map(|tilt| [SensorChange::tilt(tilt, 0.0), SensorChange::tilt(0.0, tilt)]);
    let (found, then) = super::alternatives::best(&now, tilts, super::alternatives::gain_of_one, tally)?;
    let evidence = format!(
        "{:.0} % of the detections are as high as the LiDAR points beside them, and {:.0} % otherwise",
        now.share() * 100.0,
        then.share() * 100.0
    );
    Some(Verdict::doubt(&sensor.name, Question::Lidar, evidence, Some(Remedy::Sensor(found))))
}
