//! Doppler-consistent tracking, which the paper leaves out: what moves is sought where its own range rate takes it,
//! among detections with the same range rate, in the scans that could have seen it there (docs/method.md, section 7).

use super::mismatches::Mismatches;
use super::moved_cloud::{MovedCloud, scans_of};
use crate::config::TrackingConfig;
use crate::scene::{Association, Doppler, Frame, NeighbouringScan, Reach, ScanStep, Sight};
use crate::space::Point;

/// The mismatch of each detection with the nearest agreeing ones of each neighbouring scan that could have seen it.
pub(super) fn with_agreeing(frame: &Frame, config: &TrackingConfig) -> Mismatches {
    let steps = if config.enabled { frame.steps_within(config.scans) } else { &[] };
    let movers = frame.movers();
    let reaches = reaches(frame, steps);
    let mut mismatches = Mismatches::new(frame.scan.len(), steps.len());
    for step in steps {
        let seen = Seen::new(frame, step, config, &reaches);
        let cloud = &seen.cloud;
        let mut association = Association::new(&cloud.index, frame.radar.elevation, config.neighbours);
        let dt = (step.t_ns - frame.scan.t_ns()) as f64 * 1e-9;
        for (i, mover) in movers.iter().enumerate() {
            let Some(mover) = mover else { continue };
            let expected = mover.after(dt);
            if !seen.covers(&expected.position) {
                continue;
            }
            let offset = |id: u32| {
                let agrees = mover.agrees_with(seen.rates[id as usize], config.doppler_tolerance);
                agrees.then(|| expected.position - cloud.points[id as usize].position)
            };
            let reach = cloud.reach(&expected, config.absence);
            let found = association.nearest_by(&expected.position, reach, offset).len();
            // Beyond the reach every mismatch is above the cap: it counts only in the mean with one that isn't.
            if (1..config.neighbours).contains(&found) {
                association.nearest_by(&expected.position, f64::INFINITY, offset);
            }
            let d = association.mean_over_found(|id| association.mismatch(&expected, &cloud.reference(id)));
            mismatches.push(i, d.map_or(config.absence, |d| d.min(config.absence)));
        }
    }
    mismatches
}

/// What the radars saw at the time of a neighbouring scan, and what they could have seen.
struct Seen<'a> {
    cloud: MovedCloud,
    /// Compensated range rates of the cloud's points, m/s; NaN where none was measured.
    rates: Vec<f64>,
    sights: Vec<Sight<'a>>,
}

impl<'a> Seen<'a> {
    fn new(frame: &Frame, step: &ScanStep, config: &TrackingConfig, reaches: &'a [Reach]) -> Self {
        let (mut rates, mut sights) = (Vec::new(), Vec::new());
        for scan in scans_of(step, config.sources) {
            rates.extend(rates_of(frame, scan));
            sights.push(Sight::new(&frame.rig.radars[scan.radar], scan, &reaches[scan.radar]));
        }
        Self { cloud: MovedCloud::new(step, frame.radar.elevation, config.sources), rates, sights }
    }

    /// Whether any of the radars could have seen a place.
    fn covers(&self, place: &Point) -> bool {
        self.sights.iter().any(|sight| sight.covers(place))
    }
}

/// The compensated range rates of a neighbouring scan's detections that have a place.
fn rates_of(frame: &Frame, neighbour: &NeighbouringScan) -> impl Iterator<Item = f64> {
    let NeighbouringScan { radar, scan, .. } = neighbour;
    let doppler = Doppler::new(&frame.rig.radars[*radar], &scan.measured, frame.motion);
    let rates = doppler.map_or_else(|| vec![f64::NAN; scan.len()], |doppler| doppler.compensated);
    scan.detections.iter().zip(rates).filter(|(detection, _)| detection.is_some()).map(|(_, rate)| rate)
}

/// How far each radar of the rig reaches, by the reference scan and its neighbours.
fn reaches(frame: &Frame, steps: &[ScanStep]) -> Vec<Reach> {
    let mut reaches = Vec::with_capacity(frame.rig.radars.len());
    for (i, radar) in frame.rig.radars.iter().enumerate() {
        let own = (radar.name == frame.radar.name).then_some(&*frame.scan);
        let all = steps.iter().flat_map(|step| [&step.own].into_iter().chain(&step.others));
        let around = all.filter(|scan| scan.radar == i).map(|scan| &*scan.scan);
        reaches.push(Reach::of_scans(radar, own.into_iter().chain(around)));
    }
    reaches
}
