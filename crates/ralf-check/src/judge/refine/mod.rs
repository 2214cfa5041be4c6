//! Corrections made exact: yaw, place in plan and clock of each radar, jointly from range rates and the LiDAR, and from
//! all drives of a vehicle, with standard deviations.
//!
//! What is maximised is a log-likelihood: detections lie beside LiDAR points, velocities are those of the vehicle,
//! and small corrections are likelier than large ones.

mod behind;
mod beside;
mod common;
mod evidence;
mod fronts;
mod proposal;
mod quantity;
mod radar;
mod search;

use super::case::Case;
use crate::change::SensorChange;
use crate::overlap::Measure;
use behind::Behind;
use common::common;
use radar::Radar;
use serde::Serialize;

/// The correction of one sensor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Refinement {
    /// The sensor's name.
    pub name: String,
    /// What is likeliest to be added.
    pub change: SensorChange,
    /// Standard deviations of yaw (degrees), of the place forward and to the left (m) and of the clock (ms), each with
    /// the others unknown, and with what more measurements would not take away. NaN of a sensor whose change was found
    /// and not refined.
    pub deviations: [f64; 4],
    /// What is proposed: quantities that are three standard deviations of chance, two of [`Self::deviations`], and more
    /// than labels notice, and the likeliest of these with all others left alone.
    pub proposed: SensorChange,
    /// The sequences that it is of, by name, where not all have the sensor mounted alike.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub only_of: Option<Vec<String>>,
}

impl Refinement {
    /// A sensor's change as it was found.
    fn as_found(name: &str, change: SensorChange) -> Self {
        Self { name: name.to_owned(), change, deviations: [f64::NAN; 4], proposed: change, only_of: None }
    }
}

/// The corrections of all LiDARs, as they were found in more drives than not, and with these in place of all radars.
pub(super) fn refine(cases: &mut [Case]) -> Vec<Refinement> {
    let mut refined = Vec::new();
    for name in names(cases, |case| case.sequence.rig.lidars.iter().map(|lidar| &lidar.name).collect()) {
        let number = |case: &Case| case.sequence.rig.lidars.iter().position(|lidar| lidar.name == name);
        let judged = cases.iter().filter(|case| is_seen(case));
        let found = judged.filter_map(|case| Some(case.lidar_changes[number(case)?]));
        let change = common(&found.collect::<Vec<_>>());
        for case in &mut *cases {
            number(case).into_iter().for_each(|lidar| case.lidar_changes[lidar] = change);
        }
        refined.push(Refinement::as_found(&name, change));
    }
    let radars =
        names(cases, |case| case.radars().map(|radar| &case.sequence.rig.radars[radar].name).collect());
    let radars: Vec<Radar> = radars.iter().map(|name| Radar::of(cases, name)).collect();
    let behind = Behind::of(&radars.iter().filter_map(Radar::way).collect::<Vec<_>>());
    refined.extend(radars.into_iter().map(|radar| radar.refined(behind)));
    refined
}

/// Whether LiDARs and radars see so much together that LiDARs can be judged.
fn is_seen(case: &Case) -> bool {
    let mut seen = case.radars().map(|radar| case.overlap(radar, &SensorChange::default(), Measure::Beside));
    seen.any(|tally| tally.is_enough())
}

/// Names of sensors, each once, in the order of the rigs.
fn names<'a>(cases: &'a [Case], of: impl Fn(&'a Case<'a>) -> Vec<&'a String>) -> Vec<String> {
    let mut names = Vec::new();
    for name in cases.iter().flat_map(of) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}
