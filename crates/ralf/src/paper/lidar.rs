//! LiDAR matching: is there a surface where the radar saw something? (paper, algorithm 1; docs/method.md, section 4)

use crate::config::LidarConfig;
use crate::label::UNLABELED;
use crate::scene::{Frame, LidarCloud, LidarSearch};

/// What the LiDAR says of one detection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LidarMatch {
    /// Mean mismatch with the `K` nearest points, at most `lidar.max_mismatch`.
    pub d: f64,
    /// The class that most of these carry, where they carry any (docs/method.md, section 11).
    pub semantic: Option<u16>,
}

/// The mismatch of each detection with its `K` nearest LiDAR points above the ground. `None` for all where the branch
/// is off or there is no such point, and for detections without a position.
///
/// Two things the paper doesn't have. With `lidar.scans` these are points of several scans; what moves by its Doppler
/// velocity was elsewhere in all but the nearest, so that it is compared with that one alone. With `lidar.dynamic` what
/// moves is also compared with each point of all of them where its Doppler velocity takes it at the time of the point;
/// the smaller mismatch counts. A detection that moves less in that time than its own range is uncertain by stands.
pub fn match_detections(frame: &Frame, config: &LidarConfig) -> Vec<Option<LidarMatch>> {
    let mut matches = vec![None; frame.scan.len()];
    let clouds = if config.enabled { frame.lidar_clouds() } else { Vec::new() };
    if clouds.iter().all(LidarCloud::is_empty) {
        return matches;
    }
    let (t_ns, sigma_range) = (frame.scan.t_ns(), frame.radar.sigma_range);
    let mut search = LidarSearch::new(&clouds, config.neighbours);
    let movers = if config.dynamic || clouds.len() > 1 { frame.movers() } else { Vec::new() };
    for (i, detection) in frame.scan.detections.iter().enumerate() {
        let Some(detection) = detection else { continue };
        let mover = movers.get(i).and_then(Option::as_ref);
        let mover = mover.filter(|mover| search.farthest_move(mover, t_ns) > sigma_range);
        let as_standing = if mover.is_some() { 1 } else { clouds.len() };
        let d = search.mean_mismatch(detection, as_standing, config.max_mismatch);
        let d = d.map_or(config.max_mismatch, |d| d.min(config.max_mismatch));
        let mut found = LidarMatch { d, semantic: majority(search.classes()) };
        if let Some(mover) = mover.filter(|_| config.dynamic) {
            let d = search.mean_mismatch_of_mover(mover, t_ns);
            if let Some(d) = d.filter(|d| *d < found.d) {
                found = LidarMatch { d, semantic: majority(search.classes()) };
            }
        }
        matches[i] = Some(found);
    }
    matches
}

/// The class of most neighbours; of equally frequent ones the one that comes nearer. Unlabeled points don't vote.
fn majority(classes: impl Iterator<Item = u16>) -> Option<u16> {
    let mut votes: Vec<(u16, usize)> = Vec::new();
    for class in classes.filter(|class| *class != UNLABELED) {
        match votes.iter_mut().find(|(voted, _)| *voted == class) {
            Some((_, count)) => *count += 1,
            None => votes.push((class, 1)),
        }
    }
    votes.iter().rev().max_by_key(|(_, count)| *count).map(|(class, _)| *class)
}
