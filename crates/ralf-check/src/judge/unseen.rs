//! A radar before which the LiDAR sees plenty, and hardly any of whose detections lies beside that. No turn, shift or
//! clock that is tried brings more there: its fields may be others, or its mounting far off.

use super::case::Case;
use super::lidar::APART;
use crate::change::SensorChange;
use crate::overlap::{Measure, Tally, obstacles_in_view};
use crate::remedy::Remedy;
use crate::verdict::{Question, Verdict};

/// Obstacles in a radar's view, of some that are kept of a LiDAR's scan, in the mean over scans.
const PLENTY: f64 = 20.0;

/// Where all radars are apart from the LiDAR's points, that is told of the LiDAR, and of none of them.
pub(super) fn judge(case: &Case, radar: usize, now: &Tally) -> Option<Verdict> {
    if now.share() >= APART {
        return None;
    }
    let of_all = case.radars().map(|radar| case.overlap(radar, &SensorChange::default(), Measure::Beside));
    let of_all = of_all.fold(Tally::default(), Tally::joined);
    let seen = obstacles_in_view(&case.setup(), radar, &case.radar_changes[radar]);
    if of_all.share() < APART || seen < PLENTY {
        return None;
    }
    let evidence = format!(
        "{:.0} % of {:.0} detections lie beside LiDAR points, though the LiDAR sees things before it",
        now.share() * 100.0,
        now.points()
    );
    let what = "are its fields, mounting and clock what is said?";
    Some(Verdict::doubt(case.name(radar), Question::Lidar, evidence, Some(Remedy::LookInto(what))))
}
